//! The part of the world that pictures of a recording show.
//!
//! It holds the moving bodies in all frames and impacts with the lines that show their angles, the points from which
//! connectors and springs hang, the tips of the arrows of forces, and of the fixed bodies and rails those nearby. A
//! point that a connector or spring ties is left out if it is farther from the moving bodies than [`FARTHEST_TIE`]
//! times the size of the box that they cover, in which they would be lost; its connector is then drawn up to the edge
//! of the picture.

use super::arrows::ForceScale;
use super::scene::hand_length;
use super::ties::{place_of, rail_boxes, tied_points};
use super::view::View;
use crate::recording::{Frame, Recording};
use crate::world::World;
use glam::DVec2;
use halfgap_geometry::Aabb;

/// Distance beyond the moving bodies and tied points within which fixed bodies are shown whole, as a fraction of the
/// size of the box that the moving bodies cover.
const NEAR: f64 = 1.5;
/// Distance beyond these up to which larger fixed bodies are shown, as a fraction of that size.
const SURROUNDINGS: f64 = 0.35;
/// Largest distance from the moving bodies of a tied point that is shown, as a multiple of that size.
const FARTHEST_TIE: f64 = 40.0;
/// Largest number of frames that are looked at; of more, every second, third and so on.
const MOST_FRAMES: usize = 4000;
/// Number of times that the box is widened for arrows. Their length is fixed on the page, so that a wider box needs more
/// room for them, but each time at most a quarter of what the time before needed.
const WIDENINGS: usize = 4;

/// Returns the box of the world to show; `None` if there is nothing in it.
pub(super) fn shown_box(world: &World, recording: &Recording, forces: Option<ForceScale>) -> Option<Aabb> {
    let mut shown = box_of_bodies(world, recording)?;
    for _ in 0..WIDENINGS {
        let scale = View::of_box(Some(shown)).scale();
        let arrows = forces
            .into_iter()
            .flat_map(|forces| frames(recording).flat_map(move |frame| forces.arrows(recording, frame)));
        let tips = arrows.map(|arrow| arrow.from + arrow.along / scale).filter(|tip| tip.is_finite());
        shown = tips.fold(shown, Aabb::including);
    }
    Some(shown)
}

fn frames(recording: &Recording) -> impl Iterator<Item = &Frame> {
    let every = recording.frames.len().div_ceil(MOST_FRAMES).max(1);
    recording.frames.iter().step_by(every).chain(recording.frames.last())
}

/// Returns the box of bodies, rails, and tied points.
fn box_of_bodies(world: &World, recording: &Recording) -> Option<Aabb> {
    let posed = frames(recording).flat_map(|frame| recording.movable.iter().zip(&frame.states));
    let struck = recording.impacts.len().div_ceil(MOST_FRAMES).max(1);
    let struck = recording.impacts.iter().step_by(struck).flat_map(|impact| &impact.states);
    let struck =
        struck.map(|(body, state)| (body, state)).filter(|(body, _)| recording.place(**body).is_some());
    let moving = posed.chain(struck).map(|(&body, state)| {
        let (shape, pose) = (world.shape(body), state.pose());
        let hand = pose.point_to_world(DVec2::new(hand_length(shape), 0.0));
        shape.bounds_at(&pose).including(state.position).including(hand)
    });
    let moving = moving.reduce(Aabb::union);
    let fixed = world.bodies().filter(|&body| world.is_fixed(body));
    let fixed = fixed.map(|body| world.shape(body).bounds_at(&world.state(body).pose()));
    let moved = frames(recording).flat_map(|frame| {
        let states = frame.states.iter().skip(recording.movable.len());
        recording.moved.iter().zip(states).map(|(&body, state)| world.shape(body).bounds_at(&state.pose()))
    });
    let fixed = fixed.chain(moved).chain(rail_boxes(world));
    let (still, carried): (Vec<_>, Vec<_>) =
        tied_points(world).partition(|point| recording.place(point.body).is_none());
    let Some(moving) = moving else {
        let points = still.iter().map(|point| Aabb::around(place_of(world, recording, None, point)));
        return fixed.chain(points).reduce(Aabb::union);
    };
    let size = moving.size().max_element();
    let limit = moving.grown(FARTHEST_TIE * size);
    let still = still.iter().map(|point| place_of(world, recording, None, point));
    let carried = frames(recording)
        .flat_map(|frame| carried.iter().map(move |point| place_of(world, recording, Some(frame), point)));
    let tied = still.chain(carried).filter(|&point| limit.contains(&Aabb::around(point)));
    let wanted = tied.fold(moving, Aabb::including);
    let (around, near) = (wanted.grown(SURROUNDINGS * size), wanted.grown(NEAR * size));
    let nearby = fixed.filter(|bounds| bounds.overlaps(&around)).map(|bounds| {
        if near.contains(&bounds) {
            bounds
        } else {
            Aabb { min: bounds.min.max(around.min), max: bounds.max.min(around.max) }
        }
    });
    Some(nearby.fold(wanted, Aabb::union))
}
