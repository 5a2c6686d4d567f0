//! The quantities of probes over time, each in a plot of its own.

use super::axes::{Axes, WIDTH};
use super::svg::{Svg, number};
use super::{color, energy};
use crate::probe::ProbeTable;
use std::fmt::Write;

const PLOT_HEIGHT: f64 = 120.0;

/// Draws all columns of a table of probes over time, one below the other, and returns the SVG document.
#[must_use]
pub fn probes_picture(title: &str, table: &ProbeTable) -> String {
    let times = table.times();
    let range_of_times = energy::range(times.iter().copied());
    let page = Axes::new(range_of_times, (0.0, 1.0), PLOT_HEIGHT).page_height();
    let count = table.columns().len();
    let mut svg = Svg::new(WIDTH, page * count.max(1) as f64);
    for (place, (name, (quantity, unit))) in table.columns().iter().enumerate() {
        let axes = Axes::new(range_of_times, energy::range(table.column(place)), PLOT_HEIGHT);
        let transform = format!("translate(0 {})", number(page * place as f64));
        svg.open_group(&[("transform", &transform)]);
        let unit = axes.draw_values(&mut svg, unit);
        axes.draw(&mut svg, if place == 0 { title } else { "" }, &format!("{name}: {quantity} [{unit}]"));
        let every = times.len().div_ceil(energy::MOST_POINTS).max(1);
        let mut data = String::new();
        for (&time, value) in times.iter().zip(table.column(place)).step_by(every) {
            let command = if data.is_empty() { 'M' } else { 'L' };
            let _ = write!(data, "{command}{} {}", number(axes.x(time)), number(axes.y(value)));
        }
        svg.path(&data, &[("fill", "none"), ("stroke", color(place)), ("stroke-width", "1.5")]);
        svg.close_group();
    }
    svg.finish()
}
