//! A frame with a time axis below and, if wanted, a value axis on the left.

use super::svg::{Svg, TextStyle, number};
use super::ticks::{label, round_step, ticks};

/// Width of a range, as a fraction of its values, below which it is drawn as a flat line.
const FLAT: f64 = 1e-9;

/// Width of a plot's page [px].
pub(super) const WIDTH: f64 = 900.0;
const LEFT: f64 = 130.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 56.0;
const BOTTOM: f64 = 52.0;
const GREY: &str = "#6b7278";

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
        let values = widened(values);
        let margin = 0.05 * (values.1 - values.0);
        let value = (values.0 - margin, values.1 + margin);
        Self { time: widened(times), value, height: plot_height }
    }

    /// Makes axes whose value counts lanes, from 0 at the top.
    pub(super) fn lanes(times: (f64, f64), count: usize, lane_height: f64) -> Self {
        let count = count.max(1) as f64;
        Self { time: widened(times), value: (count, 0.0), height: count * lane_height }
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
        svg.text((20.0, 28.0), TextStyle { size: 18.0, anchor: "start", color: "#22272b" }, title);
        svg.text((20.0, 47.0), TextStyle { size: 13.0, anchor: "start", color: GREY }, what);
        let (x, y, width, height) =
            (number(LEFT), number(TOP), number(WIDTH - LEFT - RIGHT), number(self.height));
        let frame = [("x", &*x), ("y", &*y), ("width", &*width), ("height", &*height)];
        svg.element("rect", &[&frame[..], &[("fill", "none"), ("stroke", "#c9cdc8")]].concat());
        let step = round_step(self.time.1 - self.time.0, 8.0);
        let bottom = TOP + self.height;
        for time in ticks(self.time.0, self.time.1, 8.0) {
            let x = self.x(time);
            svg.line((x, bottom), (x, bottom + 5.0), &[("stroke", GREY)]);
            let style = TextStyle { size: 12.0, anchor: "middle", color: GREY };
            svg.text((x, bottom + 19.0), style, &label(time, step));
        }
        let style = TextStyle { size: 12.0, anchor: "middle", color: GREY };
        svg.text((0.5 * (LEFT + WIDTH - RIGHT), bottom + 39.0), style, "time [s]");
    }

    /// Draws the value axis with a grid.
    pub(super) fn draw_values(&self, svg: &mut Svg, unit: &str) {
        let step = round_step(self.value.1 - self.value.0, 6.0);
        for value in ticks(self.value.0, self.value.1, 6.0) {
            let y = self.y(value);
            svg.line((LEFT, y), (WIDTH - RIGHT, y), &[("stroke", "#e6e8e4")]);
            let text = format!("{} {unit}", label(value, step));
            svg.text((LEFT - 8.0, y + 4.0), TextStyle { size: 12.0, anchor: "end", color: GREY }, &text);
        }
    }

    /// Writes a name beside a lane.
    pub(super) fn draw_lane(&self, svg: &mut Svg, lane: usize, name: &str) {
        let y = self.y(lane as f64 + 0.5);
        svg.line((LEFT, y), (WIDTH - RIGHT, y), &[("stroke", "#e6e8e4")]);
        let short: String = if name.chars().count() > 16 {
            name.chars().take(15).chain(['…']).collect()
        } else {
            name.to_owned()
        };
        svg.text((LEFT - 8.0, y + 4.0), TextStyle { size: 12.0, anchor: "end", color: "#22272b" }, &short);
    }
}

/// Returns a range with an extent that can be drawn.
fn widened((low, high): (f64, f64)) -> (f64, f64) {
    if !(low.is_finite() && high.is_finite() && (high - low).is_finite()) {
        return (0.0, 1.0);
    }
    let size = low.abs().max(high.abs());
    // Below this the range is rounding: a constant.
    if high - low > FLAT * size {
        (low, high)
    } else if size > f64::MIN_POSITIVE {
        (low - 0.1 * size, high + 0.1 * size)
    } else {
        (low - 0.5, high + 0.5)
    }
}
