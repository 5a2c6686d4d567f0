//! The books: energy closes, and bodies free of the background keep momentum and angular momentum.

use super::within;
use halfgap::geometry::{DVec2, Shape};
use halfgap::scene::Scene;
use halfgap::{Anchor, BodyState, ConnectorKind, RunError, World};
use halfgap_tests::mechanism::{Workshop, advance, block, disc, thrown};
use halfgap_tests::{reference_scene, world_of};
use std::f64::consts::PI;

/// The energy that the books leave open, as a fraction of the largest kinetic energy met.
fn open_part(scene: &mut Scene, tolerance: f64) -> f64 {
    scene.set_tolerance(tolerance, "tolerance").expect("a fine tolerance");
    let mut world = World::from_scene(scene).expect("a world that can be built");
    let mut turned_over: f64 = 0.0;
    for look in 1..=100 {
        advance(&mut world, scene.run.duration * f64::from(look) / 100.0);
        turned_over = turned_over.max(world.energy().kinetic);
    }
    world.ledger().integration_error().abs() / turned_over
}

#[test]
fn the_energy_books_close_to_the_tolerance() {
    for name in
        ["ball_bounce", "disc_in_bowl", "double_pendulum", "newtons_cradle", "pendulum", "two_discs_e1"]
    {
        let mut scene = reference_scene(&format!("exact__{name}"));
        for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
            let what = format!(
                "energy books of {name} at tolerance {tolerance:.0e}, part of the energy turned over"
            );
            within(&what, open_part(&mut scene, tolerance), tolerance);
        }
    }
}

#[test]
fn an_event_where_forces_grow_beyond_all_bounds_costs_no_energy() {
    // Where the corners that hold a shuttle from both sides come to lie opposite each other, the whole step passes
    // astride of that point; a part of the step that ended there would not.
    let mut scene = reference_scene("do_nothing__do_nothing_grinder_test1");
    for tolerance in [1e-7, 1e-8, 1e-11, 1e-12] {
        let what = format!(
            "energy books of the grinder at tolerance {tolerance:.0e}, part of the energy turned over"
        );
        within(&what, open_part(&mut scene, tolerance), 1e-8);
    }
}

#[test]
fn the_work_of_a_constant_force_is_booked_between_impacts_that_follow_soon() {
    // The motion is simple and the method exact for it, however long the step; for the power it is not exact.
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let mut world = world_of(&format!(
            r#"
format = "halfgap-scene-1"
title = "A pushed disc in a corner"
run = {{ duration = 1.0, tolerance = {tolerance:e} }}
force = [
    {{ gravity = {{ acceleration = [0.0, -12.0] }} }},
    {{ constant = {{ body = "disc", point = [0.0, 0.05], force = [0.1, 0.1], torque = 0.02 }} }},
]
[[body]]
name = "floor"
fixed = true
elasticity = 0.9
shape = {{ block = {{ width = 4.0, height = 0.2 }} }}
position = [0.0, -0.2]
[[body]]
name = "wall"
fixed = true
elasticity = 0.9
shape = {{ block = {{ width = 0.2, height = 2.0 }} }}
position = [-0.2, 1.0]
[[body]]
name = "disc"
mass = 0.4
elasticity = 0.9
shape = {{ disc = {{ radius = 0.1 }} }}
position = [0.403, 1.0]
velocity = [-1.0, 0.0]
angular_velocity = 1.0
"#
        ));
        advance(&mut world, 1.0);
        let what = format!("books of a disc that is pushed in a corner, tolerance {tolerance:.0e}: J");
        within(&what, world.ledger().integration_error(), tolerance);
    }
}

/// Momentum [N s] and angular momentum [N m s] about the origin.
fn momenta(world: &World) -> (DVec2, f64) {
    let (mut linear, mut angular) = (DVec2::ZERO, 0.0);
    for body in world.bodies() {
        let Some(inertia) = world.inertia(body) else { continue };
        let state = world.state(body);
        linear += inertia.mass * state.velocity;
        angular +=
            inertia.mass * state.position.perp_dot(state.velocity) + inertia.moment * state.angular_velocity;
    }
    (linear, angular)
}

#[test]
fn bodies_that_nothing_holds_keep_momentum_and_angular_momentum() {
    // A rod ties two of the bodies, a spring three, and all collide: the ring holds the discs together for a while.
    let mut shop = Workshop::weightless(1e-10);
    let ring = shop.body("ring", Shape::ring(3.0, 2.8).expect("a ring"), 5.0, BodyState::default());
    let spinning = BodyState { angular_velocity: 3.0, ..thrown(0.2, 1.0, DVec2::new(1.0, -0.5)) };
    let block = shop.settler("block", block(1.0, 0.4), 1.0, spinning, 0.5);
    let left = shop.body("left", disc(0.4), 2.0, thrown(-1.0, -0.5, DVec2::new(0.5, 1.5)));
    let right = shop.dull("right", disc(0.3), 0.5, thrown(1.0, -0.5, DVec2::new(-1.0, 0.3)));
    let end = |body| Anchor { body, point: DVec2::ZERO };
    shop.connect(ConnectorKind::Rod { a: end(left), b: end(right), length: 2.0 }, 0.0);
    let spring = halfgap::force::Spring::new("spring", [end(ring), end(block)], 0.5, 20.0);
    shop.builder.add_force(std::sync::Arc::new(spring));
    let mut world = shop.build();
    let (linear, angular) = momenta(&world);
    advance(&mut world, 10.0);
    let impacts = world.statistics().impacts;
    assert!(impacts > 10, "{impacts} impacts");
    let (linear_now, angular_now) = momenta(&world);
    within("free bodies, 10 s of impacts: momentum [N s]", (linear_now - linear).length(), 1e-8);
    within("free bodies, 10 s of impacts: angular momentum [N m s]", angular_now - angular, 1e-8);
}

#[test]
fn a_gear_in_a_ring_of_teeth_keeps_its_energy() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/gear_in_ring.toml");
    let mut scene = Scene::read(path).expect("a scene to look at");
    scene.set_duration(5.0, "duration").expect("a fine duration");
    let open = open_part(&mut scene, 1e-8);
    within("gear in a ring of teeth, 5 s: energy books, part of the energy turned over", open, 1e-7);
}

/// Two bodies of 1 kg, 2 m apart about a given place, that attract each other and pass through each other.
fn attracted(place: DVec2, speed: f64) -> World {
    let body = |name: &str, side: f64| {
        let (x, y) = (place.x + side, place.y);
        format!(
            "[[body]]\nname = \"{name}\"\nmass = 1.0\nshape = {{ disc = {{ radius = 0.5 }} }}\n\
             position = [{x:?}, {y:?}]\nvelocity = [0.0, {:?}]\n",
            side * speed
        )
    };
    world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = {{ duration = 10.0, collisions = false }}\n\
         force = [{{ mutual_gravity = {{ strength = 1.0 }} }}]\n{}{}",
        body("a", 1.0),
        body("b", -1.0)
    ))
}

#[test]
fn a_body_that_flies_close_by_a_centre_of_attraction_keeps_its_energy() {
    // The bodies are nearest at speed^2 4 s^2/m = 1e-4 m, a five-thousandth of their size.
    let mut world = attracted(DVec2::ZERO, 0.005);
    advance(&mut world, 10.0);
    within(
        "energy after three passes at 1e-4 m, of bodies of 0.5 m [J]",
        world.ledger().integration_error(),
        1e-7,
    );
}

#[test]
fn a_body_that_falls_into_a_centre_of_attraction_stops_before_it_makes_energy() {
    let mut world = attracted(DVec2::new(10.0, 3.0), 0.0);
    let error = world.advance_to(10.0, &mut |_| {}).expect_err("the force has no bound");
    assert!(matches!(error, RunError::Unresolved { length, .. } if length < 1e-4), "{error}");
    // They meet after half the period of a Kepler ellipse without width.
    let met = PI / 2f64.sqrt();
    within("time at which two points meet [s]", world.time() - met, 1e-7);
    within("energy of a head-on fall when it is given up [J]", world.ledger().integration_error(), 1e-3);
}

#[test]
fn centres_that_meet_at_the_gap_of_a_contact_stop_the_run() {
    // Half discs lie flat on each other, with their centres of mass on the flats: as they slide, the centres pull each
    // other to where only the target gap separates them.
    let half = "shape = { outline = { paths = [{ start = [0.5, 0.0], edges = [\n\
                { arc = { to = [-0.5, 0.0], center = [0.0, 0.0] } }, { line = [0.5, 0.0] }] }] } }\n\
                mass = 1.0\nelasticity = 0.0\ncenter_of_mass = [0.0, 0.0]\n";
    let mut world = world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = {{ duration = 10.0, tolerance = 1e-5 }}\n\
         force = [{{ mutual_gravity = {{ strength = 1.0 }} }}]\n\
         [[body]]\nname = \"upper\"\nposition = [0.0, 0.0]\n{half}\
         [[body]]\nname = \"far\"\nposition = [0.0, 9.0]\n{half}\
         [[body]]\nname = \"lower\"\nposition = [0.3, -0.001]\nangle = {PI:?}\n{half}"
    ));
    let error = world.advance_to(10.0, &mut |_| {}).expect_err("the force has no bound");
    let gap = world.tolerances().target_gap;
    let RunError::Unresolved { length, bodies, .. } = &error else { panic!("{error}") };
    assert!(*length < 10.0 * gap && bodies.as_slice() == ["upper", "lower"], "{error}");
    assert!(error.time().is_some_and(|time| time < 1.0), "{error}");
    let turned_over = world.energy().kinetic;
    within(
        "energy as centres come to a gap, part of the energy turned over",
        world.ledger().integration_error() / turned_over,
        1e-7,
    );
}

#[test]
fn the_books_of_an_impact_close_at_the_end_of_a_lever() {
    // A body of a millimetre turns about a pin and carries a disc at the end of an arm of 7 m. It hits the floor with
    // an impulse ten thousand times that of the disc, and the rounding of its turning, enlarged by the arm, moves the
    // disc.
    let mut world = world_of(LEVER);
    advance(&mut world, 0.02);
    let ledger = world.ledger();
    within("books of an impact at a lever of 1 : 17000 [J]", ledger.integration_error(), 1e-9);
    assert!(ledger.impacts < -1.0, "{ledger:?}");
}

/// A disc on a lever whose short end is a half disc above a floor.
const LEVER: &str = r#"
format = "halfgap-scene-1"
title = "lever"
run = { duration = 0.02, tolerance = 1.7e-12 }

[[body]]
name = "floor"
fixed = true
shape = { block = { width = 13.8, height = 1.0 } }
position = [0.0, -6.406369892164545]
elasticity = 0.0

[[body]]
name = "disc"
mass = 1.0
shape = { disc = { radius = 0.40738226308911174 } }
position = [-3.1546096827938648, 1.215942832929814]
angle = -2.1814259707456927
center_of_mass = [-0.015309974567669995, -0.07629842312470107]
velocity = [2.944082875795413, -0.8602639478876211]
elasticity = 0.0

[[body]]
name = "end"
mass = 1.0
position = [-1.5620767106622928, -5.90536425541651]
angle = -2.70037269249399
elasticity = 0.0
center_of_mass = [0.0, 0.0]
shape = { outline = { paths = [{ start = [0.0010056367480345929, 0.0], edges = [
    { arc = { to = [-0.0010056367480345929, 0.0], center = [0.0, 0.0] } }, { line = [0.0010056367480345929, 0.0] },
] }] } }

[[connector]]
[connector.pin]
a = { body = "disc", point = [0.19610241006194815, -0.24298497230467314] }
b = { body = "end", point = [-1.334836350888328, -7.15927673718285] }

[[connector]]
[connector.pin]
a = { body = "end", point = [0.00041576912081334264, -0.00016921750925485496] }
b = { body = "world", point = [-1.5625249252775768, -5.905388794892994] }
"#;

/// Runs a scene as the command does, without records in between.
fn run_to_the_end(scene: &str) -> halfgap::RunReport {
    let scene = Scene::parse(scene, halfgap::scene::SceneFormat::Toml).expect("a fine scene");
    let mut world = World::from_scene(&scene).expect("a world that can be built");
    halfgap::run(
        &mut world,
        &halfgap::RunPlan::of_scene(&scene, halfgap::Record::Ends),
        &mut halfgap::unwatched,
    )
}

#[test]
fn books_are_weighed_by_what_goes_on_between_looks() {
    // Looks once a period find a disc on a spring at rest each time, and two bodies on long orbits slow and far apart.
    let spring = "format = \"halfgap-scene-1\"\ntitle = \"spring\"\nrun = { duration = 400.0 }\n\
        [[body]]\nname = \"disc\"\nmass = 1.0\nposition = [1.0, 0.0]\nshape = { disc = { radius = 0.1 } }\n\
        [[force]]\nspring = { a = { body = \"world\", point = [0, 0] }, b = { body = \"disc\", point = [0, 0] }, rest_length = 0.0, \
        stiffness = 39.47841760435743 }\n";
    let orbits = "format = \"halfgap-scene-1\"\ntitle = \"orbits\"\nrun = { duration = 14049.629462081451, tolerance = 1e-9 }\n\
        force = [{ mutual_gravity = { strength = 1.0 } }]\n\
        [[body]]\nname = \"a\"\nmass = 1.0\nshape = { disc = { radius = 1e-4 } }\nposition = [-9.995, 0.0]\nvelocity = [0.0, -0.0050012504689448045]\n\
        [[body]]\nname = \"b\"\nmass = 1.0\nshape = { disc = { radius = 1e-4 } }\nposition = [9.995, 0.0]\nvelocity = [0.0, 0.0050012504689448045]\n";
    for scene in [spring, orbits] {
        let report = run_to_the_end(scene);
        assert!(
            report.error.is_none() && report.findings.is_empty(),
            "{:?} {:?}",
            report.error,
            report.findings
        );
    }
}

#[test]
fn a_disc_that_stands_still_once_its_start_was_corrected_is_at_rest() {
    // A disc that a pin and a rod hold altogether is given a velocity: the correction leaves rounding of it, of which
    // projections may take all.
    for tolerance in [1e-3, 1e-4, 1e-6, 1e-8, 1e-10] {
        let report = run_to_the_end(&format!(
            "format = \"halfgap-scene-1\"\ntitle = \"held\"\nrun = {{ duration = 1.0, tolerance = {tolerance:e} }}\n\
             [[body]]\nname = \"disc\"\nshape = {{ disc = {{ radius = 0.3 }} }}\nmass = 0.7\n\
             position = [0.1, 0.3]\nvelocity = [1.3, 0.7]\nangular_velocity = 0.3\n\
             [[connector]]\npin = {{ a = {{ body = \"disc\", point = [0.1, 0.2] }}, \
             b = {{ body = \"world\", point = [0.2, 0.5] }} }}\n\
             [[connector]]\nrod = {{ a = {{ body = \"disc\", point = [0.2, -0.1] }}, \
             b = {{ body = \"world\", point = [1.0, 1.0] }}, length = 1.0630145812734648 }}\n"
        ));
        let is_quiet = report.error.is_none() && report.findings.is_empty();
        assert!(is_quiet, "{tolerance:e}: {:?} {:?}", report.error, report.findings);
    }
}
