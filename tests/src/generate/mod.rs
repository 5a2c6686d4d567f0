//! Scenes from seeds: a dozen bodies at most, of all shapes, tied and pushed in many ways, with extreme but legal
//! numbers.
//!
//! A scene is made as JSON, as a file would hold it: the scene of a seed can be written down, run by the command and
//! made smaller. `shapes` makes the shapes, `ties` the connectors and forces; `variations` changes the reference
//! scenes instead.

mod fits;
mod mechanisms;
mod rough;
mod seams;
mod shapes;
mod stacks;
mod ties;
mod variations;

pub use fits::{struck_fit_of_seed, tight_fit_of_seed};
pub use mechanisms::mechanism_of_seed;
pub use rough::{pushed_stack_of_seed, rolling_of_seed, rough_of_seed};
pub use seams::{Drop, drop_of_seed};
pub use stacks::mixed_stack_of_seed;
pub use variations::variation_of_seed;

use crate::random::Random;
use halfgap::World;
use halfgap::scene::{Scene, SceneFormat};
use serde_json::{Value, json};
use shapes::Outline;

/// Probabilities of the kinds of scenes.
const ROOM: f64 = 0.45;
const ROUND_ROOM: f64 = 0.6;
const FLOOR: f64 = 0.85;
const SCALED: f64 = 0.2;
const FAR_AWAY: f64 = 0.05;
/// Target gap of coarse scenes, as a fraction of the smallest body's radius: wide enough to be seen.
const COARSE_GAP: f64 = 5e-3;
/// Accuracy of coarse scenes, as a fraction of the target gap.
const COARSE_ACCURACY: f64 = 0.6;
/// Velocity tolerance of coarse scenes, as a fraction of an ordinary speed.
const COARSE_SPEED: f64 = 0.2;
/// Number of steps of a scene whose contacts carry impulses only.
const IMPULSE_STEPS: f64 = 400.0;
/// Impact laws: the default one, which most scenes use, thrice.
const LAWS: [&str; 8] = [
    "hybrid",
    "hybrid",
    "hybrid",
    "simultaneous",
    "serial_separate",
    "serial_grouped",
    "serial_separate_lastpass",
    "serial_grouped_lastpass",
];
/// Index in [`LAWS`] from which on every law comes once.
const ONCE_FROM: usize = 2;

/// The names of all impact laws.
#[must_use]
pub fn all_laws() -> &'static [&'static str] {
    &LAWS[ONCE_FROM..]
}

/// Number of tries to find a free place for a body.
const TRIES: usize = 60;

/// A body, as far as the rest of a scene must know it.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    name: String,
    position: [f64; 2],
    angle: f64,
    center_of_mass: [f64; 2],
    radius: f64,
    mass: f64,
}

impl Placed {
    /// Shape coordinates of a point given in world coordinates.
    fn to_shape(&self, point: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.angle.sin_cos();
        let [x, y] = [point[0] - self.position[0], point[1] - self.position[1]];
        [cos * x + sin * y + self.center_of_mass[0], cos * y - sin * x + self.center_of_mass[1]]
    }
}

/// Units of a scene: its lengths and times that stand for 1 m and 1 s of an ordinary scene, and its origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Units {
    length: f64,
    time: f64,
    origin: [f64; 2],
}

impl Units {
    /// The speed that stands for 1 m/s of an ordinary scene.
    fn speed(&self) -> f64 {
        self.length / self.time
    }
}

/// The scene of a seed.
#[must_use]
pub fn scene_of_seed(seed: u64) -> Value {
    let mut random = Random::new(seed);
    let units = units(&mut random);
    let room = random.between(2.0, 6.0);
    let mut bodies = walls(&mut random, &units, room);
    let count = 1 + random.below(12);
    let mut placed: Vec<Placed> = Vec::new();
    for index in 0..count {
        if let Some((body, place)) = body(&mut random, &units, room, index, &placed) {
            bodies.push(body);
            placed.push(place);
        }
    }
    let connectors = ties::connectors(&mut random, &units, &placed);
    // Bodies that are joined may pass through each other, and their centres through the pole of a 1/r^2 force.
    let attract = connectors.is_empty();
    let forces = ties::forces(&mut random, &units, &placed, attract);
    json!({
        "format": "halfgap-scene-1",
        "title": format!("seed {seed}"),
        "run": run(&mut random, &units),
        "body": bodies,
        "connector": connectors,
        "force": forces,
    })
}

/// The scene of a seed without forces, connectors and loss: bodies that fly and collide, and never rest on each other.
#[must_use]
pub fn billiard_of_seed(seed: u64) -> Value {
    let mut scene = scene_of_seed(seed);
    scene["connector"] = json!([]);
    scene["force"] = json!([]);
    for body in scene["body"].as_array_mut().into_iter().flatten() {
        body["elasticity"] = json!(1.0);
    }
    scene
}

/// The scene of a seed as older engines would run it: with a target zone wide enough to be seen, and in half of all
/// scenes with a velocity tolerance that is high for everything that moves.
#[must_use]
pub fn coarse_of_seed(seed: u64) -> Value {
    let mut scene = scene_of_seed(seed);
    let Some(size) = smallest_size(&scene) else { return scene };
    let mut random = Random::new(!seed);
    let target_gap = COARSE_GAP * size;
    scene["run"]["target_gap"] = json!(target_gap);
    scene["run"]["accuracy"] = json!(COARSE_ACCURACY * target_gap);
    if random.chance(0.5) {
        scene["run"]["velocity_tol"] = json!(COARSE_SPEED * units(&mut Random::new(seed)).speed());
    }
    scene
}

/// The scene of a seed with contacts that carry impulses only, in steps in which most bodies move by a small fraction
/// of their size.
#[must_use]
pub fn impulses_of_seed(seed: u64) -> Value {
    let mut scene = scene_of_seed(seed);
    let duration = scene["run"]["duration"].as_f64().unwrap_or_default();
    scene["run"]["contacts"] = json!(false);
    scene["run"]["time_step"] = json!(duration / IMPULSE_STEPS);
    scene
}

/// Bounding radius [m] of the smallest body of a scene that moves.
fn smallest_size(scene: &Value) -> Option<f64> {
    let scene = Scene::parse(&scene.to_string(), SceneFormat::Json).ok()?;
    let world = World::from_scene(&scene).ok()?;
    let moving = world.bodies().filter(|&body| !world.is_fixed(body));
    moving.map(|body| world.shape(body).reach()).min_by(f64::total_cmp)
}

fn units(random: &mut Random) -> Units {
    let scaled = random.chance(SCALED);
    let mut scale = |range: f64| if scaled { random.power_of_ten(-range, range) } else { 1.0 };
    let (length, time) = (scale(5.0), scale(3.0));
    let far = if random.chance(FAR_AWAY) { length * random.power_of_ten(1.0, 6.0) } else { 0.0 };
    Units { length, time, origin: [far, random.between(-1.0, 1.0) * far] }
}

fn run(random: &mut Random, units: &Units) -> Value {
    let law = random.one_of(&LAWS);
    let mut run = json!({
        "duration": units.time * random.between(0.5, 4.0),
        "tolerance": random.power_of_ten(-12.0, -4.0),
        "impact_law": law,
    });
    if random.chance(0.15) {
        run["seed"] = json!(random.below(1000));
    }
    if random.chance(0.05) {
        run["start_time"] = json!(units.time * random.between(-1e3, 1e3));
    }
    if random.chance(0.05) {
        run["integrator"] = json!("dormand_prince5");
    }
    run
}

/// Fixed bodies around the place of a scene.
fn walls(random: &mut Random, units: &Units, room: f64) -> Vec<Value> {
    let elasticity = 1.0;
    let wall = |name: &str, shape: Value, at: [f64; 2]| {
        json!({
            "name": name, "fixed": true, "shape": shape, "elasticity": elasticity,
            "position": [units.origin[0] + units.length * at[0], units.origin[1] + units.length * at[1]],
        })
    };
    let block = |width: f64, height: f64| json!({ "block": { "width": width * units.length, "height": height * units.length } });
    let (draw, outer) = (random.unit(), 2.0 * room + 2.0);
    if draw < ROOM {
        vec![
            wall("floor", block(outer, 1.0), [0.0, -room - 0.5]),
            wall("ceiling", block(outer, 1.0), [0.0, room + 0.5]),
            wall("left", block(1.0, outer), [-room - 0.5, 0.0]),
            wall("right", block(1.0, outer), [room + 0.5, 0.0]),
        ]
    } else if draw < ROUND_ROOM {
        let ring = json!({ "ring": { "outer": units.length * (1.5 * room + 1.0), "inner": units.length * 1.5 * room } });
        vec![wall("room", ring, [0.0, 0.0])]
    } else if draw < FLOOR {
        vec![wall("floor", block(20.0 * room, 1.0), [0.0, -room - 0.5])]
    } else {
        Vec::new()
    }
}

/// A body in a free place, if there is one.
fn body(
    random: &mut Random,
    units: &Units,
    room: f64,
    index: usize,
    placed: &[Placed],
) -> Option<(Value, Placed)> {
    let size = units.length
        * if random.chance(0.1) { random.power_of_ten(-3.0, 0.0) } else { random.between(0.2, 1.0) };
    let outline = shapes::shape(random, size);
    let position = place(random, units, room, &outline, placed)?;
    let name = format!("body{index}");
    let angle = if random.chance(0.3) { 0.0 } else { random.between(-4.0, 4.0) };
    let mass = if random.chance(0.1) { random.power_of_ten(-6.0, 6.0) } else { random.between(0.1, 3.0) };
    let speed = units.speed();
    let fast = if random.chance(0.05) { random.power_of_ten(0.0, 2.0) } else { 1.0 };
    let spin = if random.chance(0.05) { random.power_of_ten(0.0, 3.0) } else { 1.0 };
    let fixed = random.chance(0.06);
    let elasticity = match random.below(4) {
        0 => 0.0,
        1 => 1.0,
        _ => random.unit(),
    };
    let mut body = json!({
        "name": name,
        "shape": outline.shape,
        "position": position,
        "angle": angle,
        "center_of_mass": outline.center,
        "elasticity": elasticity,
    });
    if fixed {
        body["fixed"] = json!(true);
    } else {
        body["mass"] = json!(mass);
    }
    if !fixed && random.chance(0.6) {
        body["velocity"] =
            json!([speed * fast * random.between(-3.0, 3.0), speed * fast * random.between(-3.0, 3.0)]);
        if random.chance(0.7) {
            body["angular_velocity"] = json!(spin * random.between(-3.0, 3.0) / units.time);
        }
    }
    let radius = outline.radius;
    Some((body, Placed { name, position, angle, center_of_mass: outline.center, radius, mass }))
}

/// A place where the circle about a body meets no other circle; now and then it just touches another body or the
/// floor.
fn place(
    random: &mut Random,
    units: &Units,
    room: f64,
    outline: &Outline,
    placed: &[Placed],
) -> Option<[f64; 2]> {
    let free = room * units.length - outline.radius;
    for _ in 0..TRIES {
        let mut at = [random.between(-free, free), random.between(-free, free)];
        if random.chance(0.2) {
            at[1] = -free;
        }
        let mut position = [units.origin[0] + at[0], units.origin[1] + at[1]];
        if random.chance(0.3) && !placed.is_empty() {
            let other = &placed[random.below(placed.len())];
            let (apart, way) = (other.radius + outline.radius, random.between(0.0, 6.2));
            position = [other.position[0] + apart * way.cos(), other.position[1] + apart * way.sin()];
        }
        let inside = (0..2).all(|axis| (position[axis] - units.origin[axis]).abs() <= free);
        let apart = |other: &Placed| {
            let [x, y] = [position[0] - other.position[0], position[1] - other.position[1]];
            // An overlap by a rounding of the distance is lifted at the start.
            x.hypot(y) * (1.0 + 1e-12) >= other.radius + outline.radius
        };
        if free > 0.0 && inside && placed.iter().all(apart) {
            return Some(position);
        }
    }
    None
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    #[test]
    fn a_seed_makes_one_scene() {
        assert_eq!(scene_of_seed(7), scene_of_seed(7));
        assert_ne!(scene_of_seed(7), scene_of_seed(8));
    }

    /// Number of scenes of the first `count` seeds, each of which must be legal, that can be built.
    pub(crate) fn how_many_can_be_built(count: u64, scene_of: fn(u64) -> Value) -> usize {
        let can_be_built = |&seed: &u64| {
            let scene = Scene::parse(&scene_of(seed).to_string(), SceneFormat::Json);
            World::from_scene(&scene.unwrap_or_else(|error| panic!("{seed}: {error}"))).is_ok()
        };
        (0..count).filter(can_be_built).count()
    }

    #[test]
    fn scenes_are_legal_and_most_can_be_built() {
        let built = how_many_can_be_built(300, scene_of_seed);
        assert!(built > 240, "{built} of 300");
    }
}
