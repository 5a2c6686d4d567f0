//! A frame with a time axis below and, if wanted, a value axis on the left.
//!
//! Where the times of a run that starts late need more digits than fit below the ticks, the axis counts from the start,
//! and its name tells from when.

use super::svg::{Svg, TextStyle, number};
use super::ticks::Ticks;

/// Width of a range of values, as a fraction of their size, below which it is drawn as a flat line.
pub(super) const FLAT: f64 = 1e-9;
/// Width of a range of times, as a fraction of their size, below which it is rounding.
const ONE_TIME: f64 = 4.0 * f64::EPSILON;

/// Width of a plot's page [px].
pub(super) const WIDTH: f64 = 900.0;
/// Width of the room for values and names left of a plot [px].
const LEFT: f64 = 130.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 56.0;
const BOTTOM: f64 = 52.0;
const GREY: &str = "#6b7278";
/// Style of a number below the time axis.
const TIME: TextStyle = TextStyle { size: 12.0, anchor: "middle", color: GREY };

/// Usual number of ticks of the time axis, and the most characters that fit below one of them.
const TIME_TICKS: (f64, usize) = (8.0, 7);
/// Usual number of ticks of the value axis, and the most characters that fit beside one of them.
const VALUE_TICKS: (f64, usize) = (6.0, 15);
/// Largest number of characters of a name that fit beside a lane.
pub(super) const LONGEST_NAME: usize = 16;

/// Ranges of time and value, and their place on the page.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    time: (f64, f64),
    value: (f64, f64),
    height: f64,
}

impl Axes {
    /// Makes axes for the given times and values, widened where they have no extent, on a plot of the given height
    /// [px].
    pub(super) fn new(times: (f64, f64), values: (f64, f64), plot_height: f64) -> Self {
        let values = widened(values, FLAT);
        let margin = 0.05 * (values.1 - values.0);
        let value = (values.0 - margin, values.1 + margin);
        Self { time: widened(times, ONE_TIME), value, height: plot_height }
    }

    /// Makes axes whose value counts lanes, from 0 at the top.
    pub(super) fn lanes(times: (f64, f64), count: usize, lane_height: f64) -> Self {
        let count = count.max(1) as f64;
        Self { time: widened(times, ONE_TIME), value: (count, 0.0), height: count * lane_height }
    }

    pub(super) fn page_height(&self) -> f64 {
        TOP + self.height + BOTTOM
    }

    pub(super) fn x(&self, time: f64) -> f64 {
        LEFT + (WIDTH - LEFT - RIGHT) * (time - self.time.0) / (self.time.1 - self.time.0)
    }

    pub(super) fn y(&self, value: f64) -> f64 {
        TOP + self.height * (self.value.1 - value) / (self.value.1 - self.value.0)
    }

    /// Draws title, frame and time axis.
    pub(super) fn draw(&self, svg: &mut Svg, title: &str, what: &str) {
        svg.title(title, WIDTH);
        svg.text((20.0, 47.0), TextStyle { size: 13.0, anchor: "start", color: GREY }, what);
        let (x, y, width, height) =
            (number(LEFT), number(TOP), number(WIDTH - LEFT - RIGHT), number(self.height));
        let frame = [("x", &*x), ("y", &*y), ("width", &*width), ("height", &*height)];
        svg.element("rect", &[&frame[..], &[("fill", "none"), ("stroke", "#c9cdc8")]].concat());
        let (ticks, zero, name) = self.time_ticks();
        let bottom = TOP + self.height;
        for (time, label) in ticks {
            let x = self.x(zero + time);
            svg.line((x, bottom), (x, bottom + 5.0), &[("stroke", GREY)]);
            svg.text((x, bottom + 19.0), TIME, &label);
        }
        svg.text((0.5 * (LEFT + WIDTH - RIGHT), bottom + 39.0), TIME, &name);
    }

    /// Returns the ticks of the time axis, the time from which they count, and the name of the axis.
    fn time_ticks(&self) -> (Vec<(f64, String)>, f64, String) {
        let (count, longest) = TIME_TICKS;
        let (start, end) = self.time;
        if let Some(ticks) = Ticks::new((start, end), count, longest) {
            let name = format!("time [{}]", ticks.unit("s"));
            return (ticks.labels, 0.0, name);
        }
        let since = Ticks::new((0.0, end - start), count, longest);
        let name = since.as_ref().map_or("s".to_owned(), |ticks| ticks.unit("s"));
        (since.map_or(Vec::new(), |ticks| ticks.labels), start, format!("time after {start} s [{name}]"))
    }

    /// Draws the value axis with a grid, and returns the unit of its numbers, which may have a power of ten.
    pub(super) fn draw_values(&self, svg: &mut Svg, unit: &str) -> String {
        let (count, longest) = VALUE_TICKS;
        let Some(ticks) = Ticks::new(self.value, count, longest) else { return unit.to_owned() };
        for (value, label) in &ticks.labels {
            let y = self.y(*value);
            svg.line((LEFT, y), (WIDTH - RIGHT, y), &[("stroke", "#e6e8e4")]);
            svg.text((LEFT - 8.0, y + 4.0), TextStyle { size: 12.0, anchor: "end", color: GREY }, label);
        }
        ticks.unit(unit)
    }

    /// Writes a name beside a lane; it has at most [`LONGEST_NAME`] characters.
    pub(super) fn draw_lane(&self, svg: &mut Svg, lane: usize, name: &str) {
        let y = self.y(lane as f64 + 0.5);
        svg.line((LEFT, y), (WIDTH - RIGHT, y), &[("stroke", "#e6e8e4")]);
        svg.text((LEFT - 8.0, y + 4.0), TextStyle { size: 12.0, anchor: "end", color: "#22272b" }, name);
    }
}

/// Returns a range with an extent that can be drawn: one that is not wider than the fraction `flat` of its values is a
/// constant, but for rounding.
fn widened((low, high): (f64, f64), flat: f64) -> (f64, f64) {
    if !(low.is_finite() && high.is_finite() && (high - low).is_finite()) {
        return (0.0, 1.0);
    }
    let size = low.abs().max(high.abs());
    if high - low > flat * size {
        (low, high)
    } else if size > f64::MIN_POSITIVE {
        (low - 0.1 * size, high + 0.1 * size)
    } else {
        (low - 0.5, high + 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The labels of the time axis, and its name.
    fn times(start: f64, end: f64) -> (Vec<String>, String) {
        let (ticks, _, name) = Axes::lanes((start, end), 1, 10.0).time_ticks();
        (ticks.into_iter().map(|(_, label)| label).collect(), name)
    }

    #[test]
    fn the_time_axis_counts_from_a_late_start_and_in_powers_of_ten() {
        assert_eq!(times(0.0, 2.0).1, "time [s]");
        assert_eq!(times(0.0, 1e-12).1, "time [10^-12 s]");
        assert_eq!(times(0.0, 3.2e7).1, "time [10^7 s]");
        assert_eq!(times(100.0, 105.0).0[1], "100.5");
        let (labels, name) = times(1_000_000.5, 1_000_005.5);
        assert_eq!(name, "time after 1000000.5 s [s]");
        assert_eq!((labels[1].as_str(), labels.len()), ("0.5", 11));
        assert_eq!(times(1e6, 1e6 + 3e-4).1, "time after 1000000 s [10^-4 s]");
    }
}
