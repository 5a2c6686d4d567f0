//! Friction at its bounds, with coefficients and masses far from one, in jams and over many turns.

mod bounds;
mod jams;
mod rolling;
mod sets;
mod views;

use halfgap::{BodyState, World};

/// The world of bodies and forces, at a tolerance of 1e-10.
fn world_of(parts: &str) -> World {
    halfgap_tests::world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"friction\"\nrun = {{ duration = 1.0, tolerance = 1e-10 }}\n{parts}"
    ))
}

/// A force of gravity [m/s^2].
fn gravity(x: f64, y: f64) -> String {
    format!("[[force]]\ngravity = {{ acceleration = [{x:?}, {y:?}] }}\n")
}

/// A floor whose top is at height 0, from `-width/2` to `width/2`.
fn floor(width: f64, friction: f64) -> String {
    format!(
        "[[body]]\nname = \"floor\"\nfixed = true\nelasticity = 0.0\nfriction = {friction:?}\n\
         shape = {{ block = {{ width = {width:?}, height = 1.0 }} }}\nposition = [0.0, -0.5]\n"
    )
}

/// A body of 1 kg unless `more` says otherwise.
fn body(name: &str, shape: &str, [x, y]: [f64; 2], friction: f64, more: &str) -> String {
    let mass = if more.contains("mass") { "" } else { "mass = 1.0\n" };
    let elasticity = if more.contains("elasticity") { "" } else { "elasticity = 0.0\n" };
    format!(
        "[[body]]\nname = \"{name}\"\n{mass}{elasticity}friction = {friction:?}\nshape = {{ {shape} }}\n\
         position = [{x:?}, {y:?}]\n{more}\n"
    )
}

fn block(width: f64, height: f64) -> String {
    format!("block = {{ width = {width:?}, height = {height:?} }}")
}

fn disc(radius: f64) -> String {
    format!("disc = {{ radius = {radius:?} }}")
}

fn state(world: &World, name: &str) -> BodyState {
    world.state(world.find(name).expect("it is there"))
}

/// Change of the energy since the start [J].
fn energy_change(world: &World) -> f64 {
    world.energy().total() - world.ledger().start
}
