//! The scene at one time: bodies with their true arcs, connectors, trails of centres of mass, forces, and a scale bar.

use super::arrows::ForceScale;
use super::color;
use super::outline::path_data;
use super::svg::{Svg, TextStyle, number};
use super::ticks::{label, round_step};
use super::ties::{draw_rails, draw_ties, fixed_boxes};
use super::view::{FOOT, View};
use crate::recording::{Frame, Recording};
use crate::world::World;
use halfgap_collision::{BodyId, BodyState};
use halfgap_geometry::{Aabb, Pose};

/// Fixed bodies that reach no farther than this beyond what moves are shown whole, as part of the size of that.
const NEAR: f64 = 1.5;
/// Of larger ones this much is shown.
const SURROUNDINGS: f64 = 0.35;
/// More points of a trail than this are thinned out.
const LONGEST_TRAIL: usize = 4000;
/// The time in the title is rounded to this [s].
const TITLE_TIME_STEP: f64 = 1e-3;

/// Draws the bodies of a world as they are in a frame of its recording, and the forces of its contacts and connectors;
/// the trails, and the scale of the forces, are those of the whole recording.
#[must_use]
pub fn scene_picture(world: &World, recording: &Recording, frame: &Frame) -> String {
    let view = View::of_box(shown_box(world, recording));
    let mut svg = Svg::new(view.page_width(), view.page_height());
    draw_title(&mut svg, recording, frame);
    svg.open_group(&[("stroke-linejoin", "round"), ("stroke-linecap", "round"), ("fill-rule", "evenodd")]);
    for body in world.bodies().filter(|&body| world.is_fixed(body)) {
        let data = path_data(world.shape(body), &pose(&world.state(body)), &view);
        svg.path(&data, &[("fill", "#d8dbd6"), ("stroke", "#9aa09a"), ("stroke-width", "1")]);
    }
    draw_rails(&mut svg, world, &view);
    draw_trails(&mut svg, recording, &view);
    for (place, (&body, state)) in recording.movable.iter().zip(&frame.states).enumerate() {
        draw_movable(&mut svg, world, body, (place, state), &view);
    }
    draw_ties(&mut svg, world, recording, frame, &view);
    svg.close_group();
    if let Some(forces) = ForceScale::of(recording) {
        forces.draw(&mut svg, recording, frame, &view);
        forces.draw_key(&mut svg, (view.page_width() - 20.0, view.page_height() - 0.45 * FOOT));
    }
    draw_scale_bar(&mut svg, &view);
    svg.finish()
}

fn pose(state: &BodyState) -> Pose {
    Pose::new(state.position, state.angle)
}

/// What moves, wherever it goes, and what is fixed near that.
fn shown_box(world: &World, recording: &Recording) -> Option<Aabb> {
    let every = recording.frames.len().div_ceil(LONGEST_TRAIL).max(1);
    let frames = recording.frames.iter().step_by(every).chain(recording.frames.last());
    let posed = frames.flat_map(|frame| recording.movable.iter().zip(&frame.states));
    let moving = posed.map(|(&body, state)| world.shape(body).bounds_at(&pose(state))).reduce(Aabb::union);
    let fixed = world.bodies().filter(|&body| world.is_fixed(body));
    let fixed =
        fixed.map(|body| world.shape(body).bounds_at(&pose(&world.state(body)))).chain(fixed_boxes(world));
    let Some(moving) = moving else { return fixed.reduce(Aabb::union) };
    let size = moving.size().max_element();
    let (around, near) = (moving.grown(SURROUNDINGS * size), moving.grown(NEAR * size));
    let shown = fixed.filter(|bounds| bounds.overlaps(&around)).map(|bounds| {
        if near.contains(&bounds) {
            bounds
        } else {
            Aabb { min: bounds.min.max(around.min), max: bounds.max.min(around.max) }
        }
    });
    Some(shown.fold(moving, Aabb::union))
}

fn draw_title(svg: &mut Svg, recording: &Recording, frame: &Frame) {
    let title = TextStyle { size: 18.0, anchor: "start", color: "#22272b" };
    svg.text((20.0, 28.0), title, &recording.title);
    let subtitle = TextStyle { size: 13.0, anchor: "start", color: "#6b7278" };
    svg.text((20.0, 47.0), subtitle, &format!("t = {} s", label(frame.time, TITLE_TIME_STEP)));
}

fn draw_trails(svg: &mut Svg, recording: &Recording, view: &View) {
    for (place, &body) in recording.movable.iter().enumerate() {
        let points = trail(recording, place, body);
        let every = points.len().div_ceil(LONGEST_TRAIL).max(1);
        let (mut data, mut last) = (String::new(), String::new());
        for &(_, position) in points.iter().step_by(every).chain(points.last()) {
            let point = view.to_page(position);
            let shown = format!("{} {}", number(point.0), number(point.1));
            // What stands still leaves one point, not one for each output.
            if shown != last {
                data.push(if data.is_empty() { 'M' } else { 'L' });
                data.push_str(&shown);
                last = shown;
            }
        }
        let attributes =
            [("fill", "none"), ("stroke", color(place)), ("stroke-width", "1"), ("stroke-opacity", "0.45")];
        svg.path(&data, &attributes);
    }
}

/// Where a body's centre of mass was at output times and at its impacts, where the trail has its corners.
fn trail(recording: &Recording, place: usize, body: BodyId) -> Vec<(f64, glam::DVec2)> {
    let frames = recording.frames.iter().map(|frame| (frame.time, frame.states[place].position));
    let impacts = recording.impacts.iter().flat_map(|impact| {
        let own = impact.states.iter().filter(|(taking_part, _)| *taking_part == body);
        own.map(|(_, state)| (impact.time, state.position))
    });
    let mut points: Vec<_> = frames.chain(impacts).collect();
    points.sort_by(|p, q| p.0.total_cmp(&q.0));
    points
}

/// Draws a body, its centre of mass, and a line that shows how far it has turned.
fn draw_movable(svg: &mut Svg, world: &World, body: BodyId, drawn: (usize, &BodyState), view: &View) {
    let (place, state) = drawn;
    let pose = pose(state);
    let data = path_data(world.shape(body), &pose, view);
    let attributes =
        [("fill", color(place)), ("fill-opacity", "0.55"), ("stroke", color(place)), ("stroke-width", "1.5")];
    svg.path(&data, &attributes);
    let hand = pose.point_to_world(glam::DVec2::new(0.5 * world.shape(body).reach(), 0.0));
    let center = view.to_page(state.position);
    svg.line(center, view.to_page(hand), &[("stroke", "#22272b"), ("stroke-width", "1")]);
    svg.circle(center, 2.0, &[("fill", "#22272b")]);
}

fn draw_scale_bar(svg: &mut Svg, view: &View) {
    let length = round_step(view.page_width() / view.scale(), 6.0);
    let (left, right) = (20.0, 20.0 + length * view.scale());
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
    svg.text((right + 8.0, y + 4.0), style, &format!("{} m", label(length, length)));
}
