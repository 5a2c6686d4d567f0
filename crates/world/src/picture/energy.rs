//! Kinetic, potential and total energy over time.

use super::axes::{Axes, FLAT, WIDTH};
use super::svg::{Svg, TextStyle, number};
use super::ticks::{exponent_below, rounded};
use crate::recording::{Frame, Recording};
use crate::world::Energy;
use std::fmt::Write;

const PLOT_HEIGHT: f64 = 320.0;
/// Largest number of points of a curve; more are thinned out.
pub(super) const MOST_POINTS: usize = 4000;

/// Distance of all values of an energy from 0, as a multiple of what changes in the run, from which on it is left out:
/// with it, an axis from 0 would have more room for what is constant than for what changes.
const FAR: f64 = 1.0;

/// A curve: name, colour, width, and the energy that it shows.
type Curve = (&'static str, &'static str, &'static str, fn(&Energy) -> f64);

const CURVES: [Curve; 3] = [
    ("kinetic", "#d9822b", "1.5", |energy| energy.kinetic),
    ("potential", "#3b6fb6", "1.5", |energy| energy.potential),
    ("total", "#22272b", "2", Energy::total),
];

/// Draws kinetic, potential and total energy of a recording over time, and returns the SVG document. Constant parts
/// that are larger than all that changes are left out, and the name of the axis says so.
#[must_use]
pub fn energy_picture(recording: &Recording) -> String {
    let frames = &recording.frames;
    let times = range(frames.iter().map(|frame| frame.time));
    let left_out = LeftOut::of(frames);
    let shown = |frame: &Frame| left_out.without(&frame.energy);
    let values = range(frames.iter().flat_map(|frame| CURVES.map(|(.., value)| value(&shown(frame)))));
    let axes = Axes::new(times, values, PLOT_HEIGHT);
    let mut svg = Svg::new(WIDTH, axes.page_height());
    let unit = axes.draw_values(&mut svg, "J");
    axes.draw(&mut svg, &recording.title, &format!("energy [{unit}]{}", left_out.told()));
    let every = frames.len().div_ceil(MOST_POINTS).max(1);
    for (index, (name, color, width, value)) in CURVES.into_iter().enumerate() {
        let mut data = String::new();
        for frame in frames.iter().step_by(every).chain(frames.last()) {
            let command = if data.is_empty() { 'M' } else { 'L' };
            let (x, y) = (axes.x(frame.time), axes.y(value(&shown(frame))));
            let _ = write!(data, "{command}{} {}", number(x), number(y));
        }
        svg.path(&data, &[("fill", "none"), ("stroke", color), ("stroke-width", width)]);
        let x = WIDTH - 330.0 + 105.0 * index as f64;
        svg.line((x, 42.0), (x + 22.0, 42.0), &[("stroke", color), ("stroke-width", width)]);
        svg.text((x + 28.0, 46.0), TextStyle { size: 12.0, anchor: "start", color: "#22272b" }, name);
    }
    svg.finish()
}

/// Constant parts of the energies, which the total lacks too.
#[derive(Clone, Copy, Debug, Default)]
struct LeftOut {
    energy: Energy,
    /// Exponent of the last digit of both.
    digit: i32,
}

impl LeftOut {
    fn of(frames: &[Frame]) -> Self {
        let ranges = CURVES.map(|(.., value)| range(frames.iter().map(|frame| value(&frame.energy))));
        let change = ranges.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
        let size = ranges.iter().map(|(low, high)| low.abs().max(high.abs())).fold(0.0, f64::max);
        // What does not change but by rounding is shown as it is.
        if !(change.is_finite() && change > FLAT * size) {
            return Self::default();
        }
        let digit = exponent_below(change) - 1;
        let part = |(low, high): (f64, f64)| {
            let is_far = low > FAR * change || high < -FAR * change;
            let step = 10f64.powi(digit);
            // Rounded down, so that what is left is positive.
            if is_far { (low / step).floor() * step } else { 0.0 }
        };
        Self { energy: Energy { kinetic: part(ranges[0]), potential: part(ranges[1]) }, digit }
    }

    fn without(&self, energy: &Energy) -> Energy {
        Energy {
            kinetic: energy.kinetic - self.energy.kinetic,
            potential: energy.potential - self.energy.potential,
        }
    }

    /// Says what is left out, as the end of the name of an axis.
    fn told(&self) -> String {
        let parts = [(self.energy.potential, "potential"), (self.energy.kinetic, "kinetic")];
        let parts = parts.into_iter().filter(|(part, _)| *part != 0.0);
        let parts: Vec<_> =
            parts.map(|(part, name)| format!("{} J of the {name}", rounded(part, self.digit))).collect();
        if parts.is_empty() { String::new() } else { format!(", without {} energy", parts.join(" and ")) }
    }
}

/// Returns the least and the largest of the finite values.
pub(super) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}
