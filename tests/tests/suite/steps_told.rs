//! What an advance by steps tells of contacts.

use halfgap::geometry::DVec2;
use halfgap::{BodyId, Event, Intervention, World};

/// The world of a scene by steps, with weight, on a floor with friction, that lacks but its bodies.
fn world_of(bodies: &str) -> World {
    halfgap_tests::world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"told\"
        run = {{ duration = 10.0, strategy = \"steps\", time_step = 0.01 }}
        force = [{{ gravity = {{ acceleration = [0.0, -10.0] }} }}]
        [[body]]
        name = \"floor\"
        fixed = true
        friction = 0.5
        shape = {{ block = {{ width = 40.0, height = 1.0 }} }}
        position = [0.0, -0.5]\n{bodies}"
    ))
}

/// A change of a contact: a sign, the time, and the bodies.
type Change = (char, f64, [u32; 2]);

fn note(told: &mut Vec<Change>, event: &Event) {
    let (sign, change) = match event {
        Event::ContactBegins(change) => ('+', change),
        Event::ContactEnds(change) => ('-', change),
        _ => return,
    };
    told.push((sign, change.time, change.contact.bodies.map(|body| body.0)));
}

/// Adds to `told` what happens up to a time [s].
fn listen(world: &mut World, until: f64, told: &mut Vec<Change>) {
    world.advance_to(until, &mut |event| note(told, event)).expect("it goes on");
}

/// Adds a velocity [m/s] to the body above the floor, and to `told` what happens with that.
fn kick(world: &mut World, velocity: DVec2, told: &mut Vec<Change>) {
    let blow = Intervention::Velocity { body: BodyId(1), velocity, angular_velocity: 0.0 };
    world.intervene(&[blow], &mut |event| note(told, event)).expect("it is struck");
}

#[test]
fn a_contact_begins_where_a_disc_lands_and_ends_where_it_is_thrown_up() {
    let disc = "[[body]]\nname = \"disc\"\nmass = 1.0\nelasticity = 0.0\nfriction = 0.5\n\
                shape = { disc = { radius = 0.5 } }\nposition = [0.0, 1.75]\n";
    let mut world = world_of(disc);
    let mut told = Vec::new();
    // It falls for half a second.
    listen(&mut world, 2.0, &mut told);
    assert_eq!(told.len(), 1, "{told:?}");
    let (sign, time, bodies) = told[0];
    assert_eq!((sign, bodies), ('+', [1, 0]));
    assert!((time - 0.5).abs() <= 0.02, "{time}");
    // However long it has slept, it presses with its weight.
    let forces = world.contact_forces();
    assert_eq!(forces.len(), 1, "{forces:?}");
    assert!((forces[0].force - 10.0).abs() < 1e-6 && forces[0].normal == DVec2::Y, "{forces:?}");
    kick(&mut world, DVec2::new(0.0, 3.0), &mut told);
    listen(&mut world, 2.3, &mut told);
    assert_eq!(told.len(), 2, "{told:?}");
    let (sign, time, bodies) = told[1];
    assert_eq!((sign, bodies), ('-', [1, 0]));
    assert!((time - 2.0).abs() <= 0.02, "{time}");
}

#[test]
fn a_contact_ends_however_fast_the_body_leaves() {
    let block = "[[body]]\nname = \"block\"\nmass = 1.0\nelasticity = 0.0\nfriction = 0.5\n\
                 shape = { block = { width = 0.5, height = 0.5 } }\nposition = [0.0, 0.25]\n";
    let mut world = world_of(block);
    let mut told = Vec::new();
    listen(&mut world, 1.0, &mut told);
    kick(&mut world, DVec2::new(0.0, 400.0), &mut told);
    listen(&mut world, 2.0, &mut told);
    let ends = told.iter().filter(|(sign, ..)| *sign == '-').count();
    // It stands on two corners from the start on, of which nobody tells.
    assert_eq!((told.len(), ends), (2, 2), "{told:?}");
}

#[test]
fn a_wheel_that_rolls_over_its_edges_keeps_its_contact() {
    // A disc of four quarters.
    let wheel = "[[body]]\nname = \"wheel\"\nmass = 1.0\nfriction = 0.5\nposition = [-5.0, 0.5]\n\
                 velocity = [2.0, 0.0]\nangular_velocity = -4.0\nshape = { outline = { paths = [{ start = [0.5, 0.0], edges = [\
         { arc = { to = [0.0, 0.5], center = [0.0, 0.0] } }, { arc = { to = [-0.5, 0.0], center = [0.0, 0.0] } },\
         { arc = { to = [0.0, -0.5], center = [0.0, 0.0] } }, { arc = { to = [0.5, 0.0], center = [0.0, 0.0] } }] }] } }\n";
    let mut world = world_of(wheel);
    let mut told = Vec::new();
    listen(&mut world, 4.0, &mut told);
    assert!(world.state(BodyId(1)).angle < -15.0, "{:?}", world.state(BodyId(1)));
    assert_eq!(told, [], "it has one contact from the start on");
}

#[test]
fn a_rope_goes_taut_and_slack() {
    let bob = "[[body]]\nname = \"bob\"\nmass = 1.0\nelasticity = 0.0\nshape = { disc = { radius = 0.1 } }\n\
               position = [0.0, 4.0]\n\
               [[connector]]\nrope = { a = { body = \"world\", point = [0.0, 5.0] }, b = { body = \"bob\", point = [0.0, 0.0] }, length = 2.0 }\n";
    let mut world = world_of(bob);
    let mut told = Vec::new();
    listen(&mut world, 1.0, &mut told);
    kick(&mut world, DVec2::new(0.0, 2.0), &mut told);
    listen(&mut world, 1.2, &mut told);
    let signs: String = told.iter().map(|(sign, ..)| *sign).collect();
    assert_eq!(signs, "+-", "{told:?}");
}
