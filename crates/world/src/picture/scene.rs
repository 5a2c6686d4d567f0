//! The scene at one time: bodies with their true arcs, connectors, trails of centres of mass, forces, and a scale bar.

use super::arrows::ForceScale;
use super::color;
use super::labels::draw_names;
use super::outline::path_data;
use super::shown::shown_box;
use super::svg::{Svg, TextStyle, number};
use super::ticks::{RoundStep, exponent_below, rounded};
use super::ties::{draw_rails, draw_ties};
use super::view::{FOOT, HEAD, View};
use crate::recording::{Frame, Recording};
use crate::world::World;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState};
use halfgap_geometry::{Pose, Shape};
use std::collections::BTreeMap;

/// Largest number of points of a trail; more are thinned out.
const LONGEST_TRAIL: usize = 4000;
/// Largest number of points of all trails together; more are thinned out.
const MOST_POINTS: usize = 200_000;
/// Exponent of a thousandth.
const MILLI: i32 = -3;

/// Pictures of a recording with a common view of the world, common trails and a common scale of the forces.
#[derive(Debug)]
pub struct ScenePictures<'a> {
    world: &'a World,
    recording: &'a Recording,
    view: View,
    /// The path of each movable body's trail.
    trails: Vec<String>,
    forces: Option<ForceScale>,
}

impl<'a> ScenePictures<'a> {
    /// Prepares pictures of a world at times of its recording.
    #[must_use]
    pub fn new(world: &'a World, recording: &'a Recording) -> Self {
        let forces = ForceScale::of(recording);
        let view = View::of_box(shown_box(world, recording, forces));
        let trails = trails(recording, &view);
        Self { world, recording, view, trails, forces }
    }

    /// Draws the bodies in a frame, with the forces of contacts and connectors, and returns the SVG document.
    #[must_use]
    pub fn at(&self, frame: &Frame) -> String {
        let Self { world, recording, view, trails, forces } = self;
        let mut svg = Svg::new(view.page_width(), view.page_height());
        svg.open_group(&[
            ("stroke-linejoin", "round"),
            ("stroke-linecap", "round"),
            ("fill-rule", "evenodd"),
        ]);
        let movable = recording.movable.iter().zip(&frame.states);
        let mut drawn: Vec<Drawn> = movable.map(|(&body, &state)| Drawn { body, state }).collect();
        for body in world.bodies().filter(|&body| world.is_fixed(body)) {
            let recorded = recording.place(body).and_then(|place| frame.states.get(place));
            let state = recorded.copied().unwrap_or_else(|| world.state(body));
            drawn.push(Drawn { body, state });
            let data = path_data(world.shape(body), &pose(&state), view);
            svg.path(&data, &[("fill", "#d8dbd6"), ("stroke", "#9aa09a"), ("stroke-width", "1")]);
        }
        draw_rails(&mut svg, world, view);
        for (place, data) in trails.iter().enumerate() {
            let attributes = [
                ("fill", "none"),
                ("stroke", color(place)),
                ("stroke-width", "1"),
                ("stroke-opacity", "0.45"),
            ];
            svg.path(data, &attributes);
        }
        for (place, (&body, state)) in recording.movable.iter().zip(&frame.states).enumerate() {
            draw_movable(&mut svg, world, body, (place, state), view);
        }
        draw_ties(&mut svg, world, recording, frame, view);
        svg.close_group();
        draw_names(&mut svg, world, &drawn, view);
        if let Some(forces) = forces {
            forces.draw(&mut svg, recording, frame, view);
        }
        // Bodies and connectors go on beyond the part that is shown; title and scales stand on top of them.
        svg.cover(0.0, HEAD);
        svg.cover(view.page_height() - FOOT, FOOT);
        draw_title(&mut svg, recording, frame, view);
        if let Some(forces) = forces {
            forces.draw_key(&mut svg, (view.page_width() - 20.0, view.page_height() - 0.45 * FOOT));
        }
        draw_scale_bar(&mut svg, view);
        svg.finish()
    }
}

/// Draws one picture of a recording, and returns the SVG document; for several, [`ScenePictures`] is quicker.
#[must_use]
pub fn scene_picture(world: &World, recording: &Recording, frame: &Frame) -> String {
    ScenePictures::new(world, recording).at(frame)
}

/// A body in the state in which it is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawn {
    pub(super) body: BodyId,
    pub(super) state: BodyState,
}

pub(super) fn pose(state: &BodyState) -> Pose {
    Pose::new(state.position, state.angle)
}

fn draw_title(svg: &mut Svg, recording: &Recording, frame: &Frame, view: &View) {
    svg.title(&recording.title, view.page_width());
    let subtitle = TextStyle { size: 13.0, anchor: "start", color: "#6b7278" };
    let time = rounded(frame.time, time_digit(recording));
    let texts = paths_told(recording, frame).map(|paths| format!("t = {time} s{paths}"));
    let fits = |text: &&String| subtitle.width_of(text) < view.page_width() - 40.0;
    let text = texts.iter().find(fits).unwrap_or(&texts[2]);
    svg.text((20.0, 47.0), subtitle, text);
}

/// Says which part of the paths of the bodies, if they move, a picture of a frame shows, at length, shortly and not at
/// all: they are drawn whole in each.
fn paths_told(recording: &Recording, frame: &Frame) -> [&'static str; 3] {
    let (Some(first), Some(last)) = (recording.frames.first(), recording.frames.last()) else {
        return [""; 3];
    };
    let moves = |frame: &Frame| {
        let mut states = frame.states.iter().zip(&first.states);
        states.any(|(state, start)| state.position != start.position)
    };
    if !recording.frames.iter().any(moves) {
        return [""; 3];
    }
    match frame.time {
        time if time <= first.time => {
            ["; thin lines: the paths of the centres of mass that are to come", "; paths to come", ""]
        }
        time if time >= last.time => {
            ["; thin lines: the paths of the centres of mass up to here", "; paths up to here", ""]
        }
        _ => ["; thin lines: the paths of the centres of mass in the whole run", "; whole paths", ""],
    }
}

/// Exponent of the last digit of the time in the title: milliseconds, or a thousandth of a shorter recording.
fn time_digit(recording: &Recording) -> i32 {
    let [first, last] = [recording.frames.first(), recording.frames.last()];
    let duration = last.map_or(0.0, |frame| frame.time) - first.map_or(0.0, |frame| frame.time);
    MILLI.min(exponent_below(duration) + MILLI)
}

/// Returns the paths of the centres of mass through output times and impacts, where trails have their corners.
fn trails(recording: &Recording, view: &View) -> Vec<String> {
    let mut impacts: BTreeMap<BodyId, Vec<(f64, DVec2)>> = BTreeMap::new();
    for impact in &recording.impacts {
        for (body, state) in &impact.states {
            impacts.entry(*body).or_default().push((impact.time, state.position));
        }
    }
    let longest = (MOST_POINTS / recording.movable.len().max(1)).clamp(1, LONGEST_TRAIL);
    let mut points = Vec::new();
    let mut trail = |(place, body): (usize, &BodyId)| {
        points.clear();
        points.extend(recording.frames.iter().map(|frame| (frame.time, frame.states[place].position)));
        points.extend(impacts.get(body).into_iter().flatten());
        points.sort_by(|p, q| p.0.total_cmp(&q.0));
        trail_data(&points, longest, view)
    };
    recording.movable.iter().enumerate().map(&mut trail).collect()
}

/// Returns the path data of a trail, thinned out to about `longest` points.
fn trail_data(points: &[(f64, DVec2)], longest: usize, view: &View) -> String {
    let every = points.len().div_ceil(longest).max(1);
    let (mut data, mut last) = (String::new(), String::new());
    for &(_, position) in points.iter().step_by(every).chain(points.last()) {
        let point = view.to_page(position);
        let shown = format!("{} {}", number(point.0), number(point.1));
        // A body that stands still leaves one point, not one for each output.
        if shown != last {
            data.push(if data.is_empty() { 'M' } else { 'L' });
            data.push_str(&shown);
            last = shown;
        }
    }
    data
}

/// Draws a body, its centre of mass, and a line that shows its angle.
fn draw_movable(svg: &mut Svg, world: &World, body: BodyId, drawn: (usize, &BodyState), view: &View) {
    let (place, state) = drawn;
    let pose = pose(state);
    let data = path_data(world.shape(body), &pose, view);
    let attributes =
        [("fill", color(place)), ("fill-opacity", "0.55"), ("stroke", color(place)), ("stroke-width", "1.5")];
    svg.path(&data, &attributes);
    let hand = pose.point_to_world(DVec2::new(hand_length(world.shape(body)), 0.0));
    let center = view.to_page(state.position);
    svg.line(center, view.to_page(hand), &[("stroke", "#22272b"), ("stroke-width", "1")]);
    svg.circle(center, 2.0, &[("fill", "#22272b")]);
}

/// Length of the line that shows the angle of a body [m]: half of its extent from the middle, which is less than that
/// from the centre of mass where that lies outside of the shape.
pub(super) fn hand_length(shape: &Shape) -> f64 {
    0.5 * shape.reach().min(0.5 * shape.bounds_at(&Pose::IDENTITY).size().max_element())
}

fn draw_scale_bar(svg: &mut Svg, view: &View) {
    let length = RoundStep::of(view.page_width() / view.scale(), 6.0);
    let (left, right) = (20.0, 20.0 + length.size() * view.scale());
    let y = view.page_height() - 0.45 * FOOT;
    let data = format!(
        "M{l} {top}L{l} {bottom}M{l} {y}L{r} {y}M{r} {top}L{r} {bottom}",
        l = number(left),
        r = number(right),
        y = number(y),
        top = number(y - 4.0),
        bottom = number(y + 4.0)
    );
    svg.path(&data, &[("stroke", "#6b7278"), ("stroke-width", "1.5"), ("fill", "none")]);
    let style = TextStyle { size: 12.0, anchor: "start", color: "#6b7278" };
    svg.text((right + 8.0, y + 4.0), style, &format!("{} m", length.label()));
}
