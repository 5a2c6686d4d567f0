//! Big piles at the accuracy of games: nothing is known of them but what they cost.

use super::exact;
use crate::scene::{Body, Scene, Shape};
use glam::DVec2;
use halfgap::BodyState;
use halfgap::geometry::PathSpec;
use std::f64::consts::TAU;

const GRAVITY: f64 = 9.81;

pub(super) fn discs() -> Scene {
    let (radius, across, count) = (0.25, 10, 200);
    let width = 2.2 * radius * f64::from(across);
    let mut bodies = vec![
        Body::fixed("floor", Shape::Block { width: width + 4.0, height: 1.0 }, DVec2::new(0.5 * width, -0.5)),
        Body::fixed("left", Shape::Block { width: 1.0, height: 30.0 }, DVec2::new(-0.5, 15.0)),
        Body::fixed("right", Shape::Block { width: 1.0, height: 30.0 }, DVec2::new(width + 0.5, 15.0)),
    ];
    for index in 0..count {
        let (column, row) = (f64::from(index % across), f64::from(index / across));
        // Rows alternate to the sides, so that discs do not stand on top of each other.
        let shift = if index / across % 2 == 0 { -0.04 } else { 0.04 };
        let place = DVec2::new((column + 0.5) * 2.2 * radius + shift * radius, (row + 0.5) * 2.4 * radius);
        bodies.push(Body::disc(&format!("disc {index}"), radius, 1.0, place, DVec2::ZERO));
    }
    pile("settling_discs", "200 discs settle in a box", bodies, 0.2, 2.0)
}

pub(super) fn stack() -> Scene {
    let mut bodies =
        vec![Body::fixed("floor", Shape::Block { width: 20.0, height: 1.0 }, DVec2::new(0.0, -0.5))];
    for index in 0..100 {
        let start = BodyState { position: DVec2::new(0.0, f64::from(index) + 0.5), ..BodyState::default() };
        bodies.push(Body::block(&format!("box {index}"), DVec2::ONE, 1.0, start));
    }
    pile("stack_of_boxes", "100 boxes stand on each other", bodies, 0.0, 2.0)
}

fn pile(name: &str, about: &str, bodies: Vec<Body>, elasticity: f64, duration: f64) -> Scene {
    let bodies = bodies.into_iter().map(|body| body.with_elasticity(elasticity)).collect();
    let mut scene = Scene::new(name, about, bodies);
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    (scene.duration, scene.check_grid) = (duration, 0.05);
    scene
}

/// Piles with friction, for advances by steps, by their names.
type Maker = (&'static str, fn() -> Scene);

/// Number of times a second at which piles are looked at.
const FRAMES: f64 = 60.0;
const FRICTION: f64 = 0.5;

const ROUGH: [Maker; 9] = [
    ("pile_200", || exact::read_pile("pile_200", 1.0 / FRAMES)),
    ("pyramid_20", || pyramid(20)),
    ("pyramid_50", || pyramid(50)),
    ("tower_100", tower),
    ("wall_1000", wall),
    ("hopper_2000", hopper),
    ("drum_500", drum),
    ("heaps_1000", || heaps(1000)),
    ("heaps_10000", || heaps(10_000)),
];

/// The piles with friction whose name is wanted.
#[must_use]
pub fn rough(is_wanted: impl Fn(&str) -> bool) -> Vec<Scene> {
    ROUGH.iter().filter(|(name, _)| is_wanted(name)).map(|(_, make)| make()).collect()
}

fn rough_pile(name: &str, about: &str, bodies: Vec<Body>, duration: f64) -> Scene {
    let bodies = bodies.into_iter().map(|body| body.with_friction(FRICTION)).collect();
    Scene { check_grid: 1.0 / FRAMES, ..pile(name, about, bodies, 0.0, duration) }
}

fn floor(width: f64) -> Body {
    Body::fixed("floor", Shape::Block { width, height: 1.0 }, DVec2::new(0.0, -0.5))
}

fn at(x: f64, y: f64) -> BodyState {
    BodyState { position: DVec2::new(x, y), ..BodyState::default() }
}

/// Boxes at rest, with gaps between those of a row, as in `exact__pyramid_20`.
fn pyramid(rows: u32) -> Scene {
    let mut bodies = vec![floor(4.0 * f64::from(rows))];
    for row in 0..rows {
        for column in 0..rows - row {
            let x = 1.05 * (f64::from(column) - 0.5 * f64::from(rows - row - 1));
            bodies.push(Body::block(
                &format!("b{row}.{column}"),
                DVec2::ONE,
                1.0,
                at(x, f64::from(row) + 0.5),
            ));
        }
    }
    rough_pile(&format!("pyramid_{rows}"), "a pyramid of boxes at rest", bodies, 5.0)
}

fn tower() -> Scene {
    let mut bodies = vec![floor(20.0)];
    bodies.extend(
        (0..100).map(|index| {
            Body::block(&format!("box {index}"), DVec2::ONE, 1.0, at(0.0, f64::from(index) + 0.5))
        }),
    );
    rough_pile("tower_100", "100 boxes stand on each other", bodies, 5.0)
}

/// A wall of bricks in running bond that a heavy ball strikes.
fn wall() -> Scene {
    let (across, rows, size) = (50, 20, DVec2::new(1.0, 0.5));
    let mut bodies = vec![floor(400.0)];
    for row in 0..rows {
        let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
        for column in 0..across {
            let x = f64::from(column) - 0.5 * f64::from(across) + shift;
            let start = at(x * size.x, (f64::from(row) + 0.5) * size.y);
            bodies.push(Body::block(&format!("brick {row}.{column}"), size, 1.0, start));
        }
    }
    let place = DVec2::new(-40.0, 5.0);
    bodies.push(Body::disc("ball", 1.0, 50.0, place, DVec2::new(30.0, 0.0)));
    rough_pile("wall_1000", "a wall of 1,000 bricks is struck by a ball", bodies, 5.0)
}

/// Discs above the outlet of a hopper.
fn hopper() -> Scene {
    let side = |name: &str, x: f64, angle: f64| {
        let mut wall = Body::fixed(name, Shape::Block { width: 12.0, height: 0.5 }, DVec2::new(x, 4.0));
        wall.start.angle = angle;
        wall
    };
    let mut bodies = vec![floor(60.0), side("left", -5.0, -0.8), side("right", 5.0, 0.8)];
    for index in 0..2000_u32 {
        let (column, row) = (f64::from(index % 50), f64::from(index / 50));
        let radius = 0.09 + 0.02 * f64::from(index * 7 % 11) / 11.0;
        let place = DVec2::new(0.24 * (column - 24.5) + 0.05 * (row % 2.0), 9.5 + 0.24 * row);
        bodies.push(Body::disc(
            &format!("disc {index}"),
            radius,
            radius * radius * 100.0,
            place,
            DVec2::ZERO,
        ));
    }
    rough_pile("hopper_2000", "2,000 discs run through the outlet of a hopper", bodies, 5.0)
}

/// Rounded polygons of three to six corners in a drum of 40 sides that turns by half a radian a second.
fn drum() -> Scene {
    let (inside, outside, sides) = (6.0, 7.0, 40);
    let ring = |radius: f64| -> Vec<DVec2> {
        let corner = |side: u32| radius * DVec2::from_angle(f64::from(side) * TAU / f64::from(sides));
        (0..sides).map(corner).collect()
    };
    let paths = [outside, inside].map(|radius| PathSpec::polygon(&ring(radius)));
    let mut bodies = vec![Body::fixed("drum", Shape::Outline(paths.to_vec()), DVec2::ZERO)];
    bodies[0].spin = 0.5;
    let (pitch, room) = (0.42, inside - 0.4);
    let places = (0..29_i32).flat_map(|row| (0..29_i32).map(move |column| (column - 14, row - 14)));
    let places = places.map(|(column, row)| DVec2::new(pitch * f64::from(column), pitch * f64::from(row)));
    for (index, place) in places.filter(|place| place.length() < room).take(500).enumerate() {
        let (corners, round) = (3 + index as u32 % 4, 0.03);
        let size = 0.12 + 0.01 * f64::from(index as u32 * 7 % 5);
        let corner = |side: u32| size * DVec2::from_angle(f64::from(side) * TAU / f64::from(corners));
        let corners: Vec<DVec2> = (0..corners).map(corner).collect();
        let start = BodyState { angle: 0.7 * index as f64, ..at(place.x, place.y) };
        bodies.push(Body::rounded(&format!("stone {index}"), &corners, round, 100.0, start));
    }
    rough_pile("drum_500", "500 rounded polygons in a drum that turns", bodies, 5.0)
}

/// Discs that fall into boxes of 100 each, so that heaps of any number have one depth.
#[must_use]
pub fn heaps(count: u32) -> Scene {
    let (radius, across, per_box) = (0.25, 10, 100);
    let (pitch, width) = (2.2 * radius, 2.2 * radius * 10.0);
    let boxes = count / per_box;
    let mut bodies = vec![floor(f64::from(boxes + 2) * 2.0 * width)];
    for place in 0..=boxes {
        let x = (f64::from(place) - 0.5 * f64::from(boxes)) * (width + 1.0) - 0.5;
        bodies.push(Body::fixed(
            &format!("wall {place}"),
            Shape::Block { width: 1.0, height: 12.0 },
            DVec2::new(x, 6.0),
        ));
    }
    for index in 0..count {
        let (home, own) = (index / per_box, index % per_box);
        let (column, row) = (f64::from(own % across), f64::from(own / across));
        let left = (f64::from(home) - 0.5 * f64::from(boxes)) * (width + 1.0);
        let shift = if own / across % 2 == 0 { -0.04 } else { 0.04 };
        let place = DVec2::new(left + (column + 0.5) * pitch + shift * radius, (row + 0.5) * 2.4 * radius);
        bodies.push(Body::disc(&format!("disc {index}"), radius, 1.0, place, DVec2::ZERO));
    }
    rough_pile(&format!("heaps_{count}"), "discs settle in boxes of 100", bodies, 2.0)
}
