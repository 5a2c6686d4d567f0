//! Stops of rails, whatever lies between them and their point.

use halfgap::{Event, World};
use halfgap_tests::world_of;

/// A slope, a hollow of radius 1 m and a slope back up, and a bead that starts on the first; the stop is on the last.
const RAIL: &str = r#"
format = "halfgap-scene-1"
title = "test"
run = { duration = 10.0 }
force = [{ gravity = { acceleration = [0.0, -10.0] } }]

[[body]]
name = "bead"
shape = { disc = { radius = 0.1 } }
mass = 1.0
position = [-2.1213203435596424, 2.1213203435596424]
"#;
const PATH: &str = "path = { start = [-2.7071067811865475, 2.7071067811865475], edges = [\
    { line = [-0.7071067811865476, 0.7071067811865475] }, \
    { arc = { to = [0.7071067811865476, 0.7071067811865475], center = [0.0, 1.4142135623730951] } }, \
    { line = [2.7071067811865475, 2.7071067811865475] }] }";
/// Arc length of the stop [m], and where that is.
const STOP_AT: f64 = 5.5;
const SLOPE: f64 = 2.0 * std::f64::consts::SQRT_2;

fn bead_on_rail() -> World {
    let bead = "a = { body = \"bead\", point = [0.0, 0.0] }";
    world_of(&format!(
        "{RAIL}\n[[connector]]\nrail = {{ {bead}, {PATH} }}\n\n\
         [[connector]]\nrail_stop = {{ {bead}, {PATH}, at = {STOP_AT}, upper = true }}\n"
    ))
}

#[test]
fn a_stop_beyond_the_joints_of_its_rail_turns_its_point_back() {
    let mut world = bead_on_rail();
    let bead = world.find("bead").expect("the bead");
    let on_slope = STOP_AT - SLOPE - std::f64::consts::FRAC_PI_2;
    let place = std::f64::consts::FRAC_1_SQRT_2 * (1.0 + on_slope);
    let mut hits = Vec::new();
    let mut highest = f64::NEG_INFINITY;
    for step in 1..=1000 {
        let until = 0.01 * f64::from(step);
        world
            .advance_to(until, &mut |event| {
                if let Event::Impact(impact) = event {
                    hits.extend(impact.rows.iter().map(|row| row.point.x));
                }
            })
            .expect("it goes on");
        highest = highest.max(world.state(bead).position.x);
    }
    assert!(hits.len() > 3, "{} rows of impacts", hits.len());
    assert!(hits.iter().all(|x| (x - place).abs() < 1e-7), "impacts at {hits:?} m, stop at {place} m");
    assert!(highest < place + 1e-7, "{highest} m, stop at {place} m");
}
