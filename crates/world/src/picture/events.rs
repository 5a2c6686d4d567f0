//! The impacts of a run on a time line: a lane for each movable body, a dot for each impact it takes part in,
//! the larger the greater the impulse.

use super::axes::{Axes, LONGEST_NAME, WIDTH};
use super::color;
use super::svg::{Svg, TextStyle, number};
use crate::names::short_names;
use crate::recording::Recording;
use std::collections::BTreeMap;

const LANE_HEIGHT: f64 = 26.0;
/// Largest number of lanes; more bodies share them.
const MOST_LANES: usize = 40;
/// Largest and smallest radius of a dot [px].
const RADII: (f64, f64) = (8.0, 1.5);
/// Width of a column [px], in which only the greatest impact of a lane is drawn.
const COLUMN: f64 = 0.5;

/// Draws the impacts of a recording on a time line, and returns the SVG document.
#[must_use]
pub fn events_picture(recording: &Recording) -> String {
    let ends = [recording.frames.first(), recording.frames.last()].map(|frame| frame.map(|frame| frame.time));
    let times = (ends[0].unwrap_or(0.0), ends[1].unwrap_or(0.0));
    let per_lane = recording.movable.len().div_ceil(MOST_LANES).max(1);
    let lanes = recording.movable.len().div_ceil(per_lane);
    let axes = Axes::lanes(times, lanes, LANE_HEIGHT);
    let mut svg = Svg::new(WIDTH, axes.page_height());
    let what = format!("{} impacts; the area of a dot is its impulse", recording.impacts.len());
    axes.draw(&mut svg, &recording.title, &what);
    let first = recording.movable.chunks(per_lane).map(|bodies| recording.name(bodies[0]));
    let others = per_lane - 1;
    let longest = LONGEST_NAME - if others == 0 { 0 } else { more(others).chars().count() };
    for (lane, name) in short_names(first, longest).iter().enumerate() {
        let others = recording.movable.len().min((lane + 1) * per_lane) - lane * per_lane - 1;
        let more = if others == 0 { String::new() } else { more(others) };
        axes.draw_lane(&mut svg, lane, &format!("{name}{more}"));
    }
    draw_dots(&mut svg, &axes, &dots(recording, &axes, per_lane));
    if recording.impacts.is_empty() {
        let style = TextStyle { size: 12.0, anchor: "middle", color: "#6b7278" };
        // Between the frame and the line of the first lane.
        svg.text((0.5 * WIDTH, axes.y(0.5) - 3.0), style, "no impacts");
    }
    svg.finish()
}

/// Tells how many bodies share a lane besides the one that is named.
fn more(others: usize) -> String {
    format!(" + {others}")
}

/// Returns the greatest impulse in each column of each lane, so that a million impacts still make a picture.
fn dots(recording: &Recording, axes: &Axes, per_lane: usize) -> BTreeMap<(usize, i64), f64> {
    let mut greatest = BTreeMap::new();
    for impact in &recording.impacts {
        let column = (axes.x(impact.time) / COLUMN).round() as i64;
        for row in &impact.rows {
            for place in [row.primary, row.normal_body].into_iter().filter_map(|body| recording.place(body)) {
                let impulse: &mut f64 = greatest.entry((place / per_lane, column)).or_insert(0.0);
                *impulse = impulse.max(row.impulse);
            }
        }
    }
    greatest
}

fn draw_dots(svg: &mut Svg, axes: &Axes, dots: &BTreeMap<(usize, i64), f64>) {
    let largest = dots.values().copied().fold(f64::MIN_POSITIVE, f64::max);
    svg.open_group(&[("fill-opacity", "0.6")]);
    for (&(lane, column), &impulse) in dots {
        let radius = (RADII.0 * (impulse / largest).sqrt()).max(RADII.1);
        let center = (column as f64 * COLUMN, axes.y(lane as f64 + 0.5));
        let (x, y, r) = (number(center.0), number(center.1), number(radius));
        svg.element("circle", &[("cx", &x), ("cy", &y), ("r", &r), ("fill", color(lane))]);
    }
    svg.close_group();
}
