//! Checks of single blows: the energy that a body keeps of a blow, and that walls are not pressed apart for nothing.

use crate::generate::{Drop, drop_of_seed, struck_fit_of_seed, tight_fit_of_seed};
use halfgap::scene::{Scene, SceneFormat};
use halfgap::{BodyId, BodyState, Event, World};
use serde_json::json;
use std::ops::ControlFlow;

/// Share of the energy that a blow without loss may change by rounding.
pub const KEPT: f64 = 1e-9;
/// Error allowed in the velocity of a ball after its blow on a level floor, as a fraction of its speed.
const REBOUND: f64 = 1e-6;
/// Share of the energy of the first blow: slower ones are not looked at.
const LANDING: f64 = 1e-4;
/// Sine of the angle from the vertical up to which a row is one of a level floor, not of its ends.
const LEVEL: f64 = 1e-12;
/// Number of events after which a single blow has gone wrong.
const MOST_EVENTS: usize = 20_000;
/// Number of events in which a body with a little play must come to its end: one with a play of 1e-6 m takes some 1e5.
const MOST_EVENTS_OF_PLAY: u64 = 1_000_000;

/// The impacts of a run, and the total energy [J] at its start and end.
struct Blows {
    impacts: Vec<Blow>,
    energy: [f64; 2],
}

/// One impact.
struct Blow {
    before: f64,
    after: f64,
    states: Vec<(BodyId, BodyState)>,
    /// Whether a row points straight up or down.
    is_level: bool,
}

fn follow(text: &str) -> Result<Blows, String> {
    let scene = Scene::parse(text, SceneFormat::Json).map_err(|error| format!("illegal: {error}"))?;
    let mut world = World::from_scene(&scene).map_err(|error| format!("not built: {error}"))?;
    let start = world.energy().total();
    let mut impacts = Vec::new();
    let mut events = 0;
    let end = scene.run.end_time();
    loop {
        let mut seen = None;
        let outcome = world.advance_while(end, &mut |event| {
            events += 1;
            if let Event::Impact(impact) = event {
                let is_level = impact.rows.iter().any(|row| row.normal.x.abs() < LEVEL);
                seen = Some((impact.energy_change, impact.states.clone(), is_level));
                return ControlFlow::Break(());
            }
            if events > MOST_EVENTS { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let outcome = outcome.map_err(|error| format!("stopped: {error}"))?;
        if events > MOST_EVENTS {
            return Err("events without end".to_owned());
        }
        if let Some((change, states, is_level)) = seen {
            let after = world.energy().kinetic;
            impacts.push(Blow { before: after - change, after, states, is_level });
        }
        if outcome.is_continue() {
            break;
        }
    }
    Ok(Blows { impacts, energy: [start, world.energy().total()] })
}

/// Drops the body of a seed at a tolerance.
///
/// # Errors
/// What went wrong, in words.
pub fn check_drop(seed: u64, tolerance: f64) -> Result<(), String> {
    let Drop { mut scene, elasticity, is_level_ball } = drop_of_seed(seed);
    scene["run"]["tolerance"] = json!(tolerance);
    let blows = follow(&scene.to_string())?;
    let Some(first) = blows.impacts.first() else { return Ok(()) };
    let square = elasticity * elasticity;
    // The last of many bounces is a landing.
    for blow in blows.impacts.iter().filter(|blow| blow.before > LANDING * first.before) {
        let share = blow.after / blow.before;
        if !(share >= square - KEPT && share <= 1.0 + KEPT) {
            return Err(format!("a blow of elasticity {elasticity} leaves {share} of the energy"));
        }
    }
    if elasticity == 1.0 && (blows.energy[1] - blows.energy[0]).abs() > KEPT * first.before {
        return Err(format!("energy {} J of {} J", blows.energy[1], blows.energy[0]));
    }
    if is_level_ball && first.is_level && elasticity == 0.5 {
        let &[(_, state)] = &first.states[..] else { return Err("not one body was struck".to_owned()) };
        let along = scene["body"].as_array().and_then(|bodies| bodies.last()?["velocity"][0].as_f64());
        let along = along.unwrap_or_default();
        let down = (2.0 * first.before / mass(&scene) - along * along).sqrt();
        let off = (state.velocity.y / down - 0.5).abs().max((state.velocity.x - along).abs() / down);
        if off > REBOUND {
            return Err(format!("rebounds at {:?}, {along} and {down} before", state.velocity));
        }
    }
    Ok(())
}

fn mass(scene: &serde_json::Value) -> f64 {
    let body = scene["body"].as_array().and_then(|bodies| bodies.last());
    body.and_then(|body| body["mass"].as_f64()).unwrap_or(f64::NAN)
}

/// Strikes the body of a seed that fits exactly, under a law.
///
/// # Errors
/// What went wrong, in words.
pub fn check_fit(seed: u64, law: &str, elasticity: f64) -> Result<(), String> {
    let scene = struck_fit_of_seed(seed, law, elasticity);
    let blows = follow(&scene.to_string())?;
    if blows.impacts.is_empty() {
        return Ok(());
    }
    let share = blows.energy[1] / blows.energy[0];
    if share > 1.0 + KEPT || (elasticity == 1.0 && share < 1.0 - KEPT) {
        return Err(format!("{share} of the energy is left of {elasticity}"));
    }
    Ok(())
}

/// Strikes the body of a seed that fits with a little play, under a law, and follows it to its end; tells the number of events.
///
/// # Errors
/// What went wrong, in words.
pub fn check_tight(seed: u64, law: &str, elasticity: f64) -> Result<u64, String> {
    let scene = tight_fit_of_seed(seed, law, elasticity).to_string();
    let scene = Scene::parse(&scene, SceneFormat::Json).map_err(|error| format!("illegal: {error}"))?;
    let mut world = World::from_scene(&scene).map_err(|error| format!("not built: {error}"))?;
    let start = world.energy().total();
    let mut events = 0;
    let outcome = world.advance_for(scene.run.end_time(), MOST_EVENTS_OF_PLAY, &mut |_| events += 1);
    match outcome {
        Err(error) => Err(format!("stopped: {error}")),
        Ok(ControlFlow::Break(())) => Err(format!("{MOST_EVENTS_OF_PLAY} events by {} s", world.time())),
        Ok(ControlFlow::Continue(())) if world.energy().total() > start * (1.0 + KEPT) => {
            Err(format!("{} J become {} J", start, world.energy().total()))
        }
        Ok(ControlFlow::Continue(())) => Ok(events),
    }
}
