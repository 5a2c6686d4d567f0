//! Kinetic, potential and total energy over time.

use super::axes::{Axes, WIDTH};
use super::svg::{Svg, TextStyle, number};
use crate::recording::{Frame, Recording};
use std::fmt::Write;

const PLOT_HEIGHT: f64 = 320.0;
/// Largest number of points of a curve; more are thinned out.
const MOST_POINTS: usize = 4000;

/// A curve: name, colour, width, and the energy that it shows.
type Curve = (&'static str, &'static str, &'static str, fn(&Frame) -> f64);

const CURVES: [Curve; 3] = [
    ("kinetic", "#d9822b", "1.5", |frame| frame.energy.kinetic),
    ("potential", "#3b6fb6", "1.5", |frame| frame.energy.potential),
    ("total", "#22272b", "2", |frame| frame.energy.total()),
];

/// Draws kinetic, potential and total energy of a recording over time, and returns the SVG document.
#[must_use]
pub fn energy_picture(recording: &Recording) -> String {
    let frames = &recording.frames;
    let times = range(frames.iter().map(|frame| frame.time));
    let values = range(frames.iter().flat_map(|frame| CURVES.map(|(.., value)| value(frame))));
    let axes = Axes::new(times, values, PLOT_HEIGHT);
    let mut svg = Svg::new(WIDTH, axes.page_height());
    let unit = axes.draw_values(&mut svg, "J");
    axes.draw(&mut svg, &recording.title, &format!("energy [{unit}]"));
    let every = frames.len().div_ceil(MOST_POINTS).max(1);
    for (index, (name, color, width, value)) in CURVES.into_iter().enumerate() {
        let mut data = String::new();
        for frame in frames.iter().step_by(every).chain(frames.last()) {
            let command = if data.is_empty() { 'M' } else { 'L' };
            let _ = write!(data, "{command}{} {}", number(axes.x(frame.time)), number(axes.y(value(frame))));
        }
        svg.path(&data, &[("fill", "none"), ("stroke", color), ("stroke-width", width)]);
        let x = WIDTH - 330.0 + 105.0 * index as f64;
        svg.line((x, 42.0), (x + 22.0, 42.0), &[("stroke", color), ("stroke-width", width)]);
        svg.text((x + 28.0, 46.0), TextStyle { size: 12.0, anchor: "start", color: "#22272b" }, name);
    }
    svg.finish()
}

/// Returns the least and the largest of the finite values.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}
