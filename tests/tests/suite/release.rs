//! Capture and release: contacts begin and end where theory says, and change from edge to edge on the way.

use halfgap::force::{ForceLaw, Snapshot, Wrenches};
use halfgap::geometry::{DVec2, EdgeSpec, PathSpec, Shape};
use halfgap::{BodyId, BodySpec, ToleranceOverrides};
use halfgap::{BodyState, Event, World, WorldBuilder, WorldSettings};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc, pendulum_period, thrown};
use std::f64::consts::PI;
use std::sync::Arc;

fn ends(world: &mut World, until: f64) -> Vec<(f64, DVec2)> {
    let mut ends = Vec::new();
    world
        .advance_to(until, &mut |event| {
            if let Event::ContactEnds(end) = event {
                ends.push((end.time, end.contact.normal));
            }
        })
        .unwrap_or_else(|error| panic!("{error}"));
    ends
}

#[test]
fn a_disc_leaves_a_circle_where_the_cosine_is_two_thirds_of_its_height() {
    for (tolerance, error) in [(1e-8, 1e-6), (1e-11, 1e-9)] {
        let speed = 0.25;
        let mut shop = Workshop::new(tolerance);
        shop.fixed("hill", disc(1.0), DVec2::ZERO);
        let ball = shop.dull("ball", disc(0.5), 1.0, thrown(0.0, 1.5, DVec2::new(speed, 0.0)));
        let mut world = shop.build();
        let radius = world.state(ball).position.y;
        // Gravity along the radius is just the force that turns the disc: v^2 = g r cos a, and v^2 = v0^2 + 2 g r (1 -
        // cos a).
        let cosine = 2.0 / 3.0 + speed * speed / (3.0 * GRAVITY * radius);
        let ends = ends(&mut world, 2.0);
        let [(time, normal)] = ends[..] else { panic!("it leaves once: {ends:?}") };
        assert!((normal.y - cosine).abs() < error, "leaves at a cosine of {}, not {cosine}", normal.y);
        // From there on it falls freely.
        let sine = (1.0 - cosine * cosine).sqrt();
        let leaves_at = (GRAVITY * radius * cosine).sqrt();
        let velocity = leaves_at * DVec2::new(cosine, -sine);
        let after = 2.0 - time;
        let expected = radius * DVec2::new(sine, cosine) + velocity * after
            - DVec2::new(0.0, 0.5 * GRAVITY * after * after);
        let off = (world.state(ball).position - expected).length();
        assert!(off < 10.0 * error, "{off} m off in its fall");
        assert_eq!(world.statistics().impacts, 0);
    }
}

#[test]
fn a_ball_thrown_up_slowly_is_not_held_back() {
    // The ball bounces once. Its speed is then below the velocity tolerance: slow enough to be caught when it comes
    // down, not when it goes up.
    let settings = WorldSettings {
        overrides: ToleranceOverrides { velocity_tol: Some(0.5), ..ToleranceOverrides::default() },
        ..WorldSettings::default()
    };
    let mut builder = WorldBuilder::new(settings);
    builder.add(BodySpec::fixed("floor", block(4.0, 1.0), DVec2::new(0.0, -0.5)));
    let spec = BodySpec::movable("ball", disc(0.5), 1.0, at_rest(0.0, 0.545));
    let ball = builder.add(BodySpec { elasticity: 0.5, ..spec });
    builder.add_gravity(ball, DVec2::new(0.0, -GRAVITY));
    let mut world = builder.build().expect("a fine world");
    let gap = world.tolerances().target_gap;
    let fall = (2.0 * (0.045 - gap) / GRAVITY).sqrt();
    let speed = 0.5 * GRAVITY * fall;
    assert!(speed < 0.5 && 2.0 * speed > 0.5);
    let top = fall + speed / GRAVITY;
    advance(&mut world, top);
    let height = world.state(ball).position.y - 0.5 - gap;
    assert!((height - speed * speed / (2.0 * GRAVITY)).abs() < 1e-12, "as high as {height} m");
    let mut begins = Vec::new();
    world
        .advance_to(1.0, &mut |event| {
            if let Event::ContactBegins(begin) = event {
                begins.push(begin.time);
            }
        })
        .expect("it comes down");
    assert!(begins.len() == 1 && (begins[0] - top - speed / GRAVITY).abs() < 1e-9, "caught at {begins:?} s");
    assert_eq!(world.state(ball).velocity.y, 0.0);
    assert!((world.ledger().captures + 0.5 * speed * speed).abs() < 1e-9, "{:?}", world.ledger());
}

#[test]
fn a_ball_that_departs_at_the_target_gap_never_fires() {
    let mut shop = Workshop::weightless(1e-8);
    shop.fixed("floor", block(4.0, 1.0), DVec2::new(0.0, -0.5));
    let ball = shop.body("ball", disc(0.5), 1.0, thrown(0.0, 0.5, DVec2::new(0.0, 1e-9)));
    let mut world = shop.build();
    let start = world.state(ball);
    let mut events = 0;
    world.advance_to(1e3, &mut |_| events += 1).expect("nothing happens");
    assert_eq!(events, 0);
    assert_eq!(world.state(ball).velocity, start.velocity);
}

/// A stadium-shaped hole in a block: a straight of 3 m between half circles of 1 m.
fn stadium_hole() -> Shape {
    let line = |x, y| EdgeSpec::Line { to: DVec2::new(x, y) };
    let bulge = |x, y| EdgeSpec::Bulge { to: DVec2::new(x, y), bulge: 1.0 };
    let outer = PathSpec {
        start: DVec2::new(-3.0, -1.5),
        edges: vec![line(3.0, -1.5), line(3.0, 1.5), line(-3.0, 1.5), line(-3.0, -1.5)],
    };
    let inner = PathSpec {
        start: DVec2::new(-1.5, -1.0),
        edges: vec![line(1.5, -1.0), bulge(1.5, 1.0), line(-1.5, 1.0), bulge(-1.5, -1.0)],
    };
    Shape::from_paths(&[outer, inner]).expect("a fine track")
}

/// A disc that slides to and fro in the hole.
fn sliding(tolerance: f64, speed: f64) -> (World, halfgap::BodyId) {
    let mut shop = Workshop::new(tolerance);
    shop.fixed("track", stadium_hole(), DVec2::ZERO);
    let disc = shop.dull("disc", disc(0.25), 1.0, thrown(0.0, -0.75, DVec2::new(speed, 0.0)));
    (shop.build(), disc)
}

#[test]
fn a_disc_that_slides_in_a_stadium_keeps_its_energy_for_a_hundred_seconds() {
    let (mut world, disc) = sliding(1e-10, 3.0);
    let energy = world.energy().total();
    let kinetic = world.energy().kinetic;
    let mut change = 0.0f64;
    for piece in 1..=1000 {
        advance(&mut world, 0.1 * f64::from(piece));
        change = change.max((world.energy().total() - energy).abs() / kinetic);
        assert!(world.state(disc).position.y < -0.2, "it stays below the middle");
    }
    println!("stadium track: energy {change:e}, {:?}", world.statistics());
    assert!(change < 1e-8, "{change}");
    assert_eq!(world.statistics().impacts, 0);
}

#[test]
fn a_contact_goes_from_line_to_arc_and_back_when_the_disc_does() {
    let (speed, tolerance) = (3.0, 1e-10);
    let (mut world, disc) = sliding(tolerance, speed);
    let gap = world.tolerances().target_gap;
    // On a half circle the disc is a pendulum that starts at the bottom: half a swing to and fro on each side.
    let radius = 0.75 - gap;
    let amplitude = (1.0 - speed * speed / (2.0 * GRAVITY * radius)).acos();
    let round = 2.0 * 3.0 / speed + pendulum_period((GRAVITY / radius).sqrt(), amplitude);
    let mut changes = Vec::new();
    world
        .advance_to(10.0 * round, &mut |event| {
            if let Event::ContactBegins(begin) = event {
                changes.push(begin.time);
            }
        })
        .expect("it slides");
    let state = world.state(disc);
    assert!(state.position.x.abs() < 1e-8, "{} m from its start after ten rounds", state.position.x);
    assert!((state.velocity - DVec2::new(speed, 0.0)).length() < 1e-8, "{}", state.velocity);
    // The contact changes four times a round, first after half of the straight.
    assert_eq!(changes.len(), 40, "{changes:?}");
    assert!((changes[0] - 0.5).abs() < 1e-8, "{changes:?}");
}

#[test]
fn three_feet_on_a_floor_carry_a_pendulum_by_turns() {
    // The middle foot is redundant: forces of redundant contacts come and go without anything moving.
    let foot = |x: f64| [DVec2::new(x, -0.5), DVec2::new(x + 0.2, -0.5), DVec2::new(x + 0.2, -0.3)];
    let mut vertices = Vec::new();
    for x in [-1.1, -0.1, 0.9] {
        vertices.extend(foot(x));
        if x < 0.9 {
            vertices.push(DVec2::new(x + 1.0, -0.3));
        }
    }
    vertices.extend([DVec2::new(1.1, 0.3), DVec2::new(-1.1, 0.3)]);
    let mut shop = Workshop::new(1e-9);
    shop.fixed("floor", block(40.0, 1.0), DVec2::new(0.0, -0.5));
    let shape = Shape::polygon(&vertices).expect("a table");
    let centroid = shape.mass_properties().centroid;
    let table = shop.dull("table", shape, 4.0, at_rest(centroid.x, 0.5 + centroid.y));
    let bob = shop.bar("bob", DVec2::new(0.0, 2.0), DVec2::new(0.8, 2.0));
    shop.pin(table, bob, DVec2::new(0.0, 2.0));
    let mut world = shop.build();
    let start: BodyState = world.state(table);
    let energy = world.energy().total();
    for piece in 1..=400 {
        advance(&mut world, 0.05 * f64::from(piece));
        let state = world.state(table);
        let sunk = state.position.y - start.position.y;
        assert!(
            sunk.abs() < 1e-9 && (state.angle - start.angle).abs() < 1e-9,
            "{sunk} m at {} s",
            world.time()
        );
    }
    assert!((world.energy().total() / energy - 1.0).abs() < 1e-8);
    assert_eq!(world.statistics().impacts, 0);
}

/// A push along x that is a function of time: force [N] at a time [s].
#[derive(Debug)]
struct Push([BodyId; 1], fn(f64) -> f64);

impl ForceLaw for Push {
    fn name(&self) -> &str {
        "push"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.0
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        wrenches.add_force(self.0[0], (self.1)(now.time) * DVec2::X, DVec2::ZERO);
    }
}

/// Target gap [m] of the worlds below.
const GAP: f64 = 1e-6;

/// A workshop whose target gap is [`GAP`].
fn wide_gap_shop() -> Workshop {
    let overrides = ToleranceOverrides { target_gap: Some(GAP), ..ToleranceOverrides::default() };
    let mut shop = Workshop::weightless(1e-10);
    shop.builder =
        WorldBuilder::new(WorldSettings { tolerance: 1e-10, overrides, ..WorldSettings::default() });
    shop
}

/// A disc of 1 kg at the origin that just touches a wall to its right, and a push on it.
fn pushed_at_a_wall(push: fn(f64) -> f64) -> (World, BodyId) {
    let mut shop = wide_gap_shop();
    shop.fixed("wall", block(1.0, 4.0), DVec2::new(1.0 + GAP, 0.0));
    let ball = shop.body("ball", disc(0.5), 1.0, at_rest(0.0, 0.0));
    shop.builder.add_force(Arc::new(Push([ball], push)));
    (shop.build(), ball)
}

#[test]
fn a_force_that_comes_and_goes_while_nothing_moves_is_missed_by_no_step() {
    // The force is there for three rounds, each time by less, before it is gone in the fourth.
    let push = |time: f64| 1.2 + time.sin() - 0.01 * time;
    let (mut world, _) = pushed_at_a_wall(push);
    let (mut held, mut gone) = (22.0f64, 23.56f64);
    assert!(push(held) > 0.0 && push(gone) < 0.0);
    while gone - held > 1e-12 {
        let middle = 0.5 * (held + gone);
        *if push(middle) > 0.0 { &mut held } else { &mut gone } = middle;
    }
    let ends = ends(&mut world, 24.0);
    assert!(ends.len() == 1 && (ends[0].0 - gone).abs() < 1e-7, "{ends:?}, expected at {gone} s");
}

#[test]
fn a_contact_without_force_is_held_when_it_is_pressed() {
    let (mut world, ball) = pushed_at_a_wall(f64::sin);
    let accuracy = world.tolerances().accuracy;
    assert!(world.contact_forces().is_empty(), "{:?}", world.contact_forces());
    for time in [0.1, 1.0, 2.0, 3.0] {
        advance(&mut world, time);
        let forces = world.contact_forces();
        assert!(forces.len() == 1 && (forces[0].force - time.sin()).abs() < 1e-12, "{forces:?} at {time} s");
        let state = world.state(ball);
        assert!(state.position.x <= accuracy && state.velocity.length() < 1e-12, "{state:?} at {time} s");
    }
    let ends = ends(&mut world, PI + 1.0);
    assert!(ends.len() == 1 && (ends[0].0 - PI).abs() < 1e-8, "{ends:?}");
    // From rest at that moment: v = cos(t) - 1 and x = sin(t) - t, with t from then on.
    let state = world.state(ball);
    assert!((state.position.x - (1f64.sin() - 1.0)).abs() < accuracy, "{state:?}");
    assert!((state.velocity.x - (1f64.cos() - 1.0)).abs() < 1e-8, "{state:?}");
}

#[test]
fn a_contact_without_force_that_has_opened_bounces_when_it_comes_back() {
    // x = -t^3/6 + t^4/12: away from the wall, and back at 2 s with 2/3 m/s.
    let (mut world, ball) = pushed_at_a_wall(|time| time * (time - 1.0));
    let mut impacts = Vec::new();
    world
        .advance_to(2.1, &mut |event| {
            impacts.extend(event.impact().map(|impact| (impact.time, impact.rows[0])))
        })
        .unwrap_or_else(|error| panic!("{error}"));
    let [(time, row)] = impacts[..] else { panic!("it comes back once: {impacts:?}") };
    // The contact fires within the target zone, a little below its target.
    let late = 0.1 * world.tolerances().accuracy;
    assert!((row.gap - GAP).abs() < late && (time - 2.0).abs() < 2.0 * late, "{row:?} at {time} s");
    assert!((row.velocity_before + 2.0 / 3.0).abs() < 4.0 * late, "{row:?}");
    assert_eq!(row.velocity_after, -row.velocity_before);
    assert_eq!(world.ledger().captures, 0.0);
    assert!(world.state(ball).velocity.x < -0.4, "{:?}", world.state(ball));
}

#[test]
fn a_disc_that_lies_lower_than_its_target_gap_slides_over_a_seam_without_a_bump() {
    for gap in [0.5 * GAP, 0.8 * GAP, GAP] {
        let mut shop = wide_gap_shop();
        shop.fixed("left", block(4.0, 1.0), DVec2::new(-2.0, -0.5));
        shop.fixed("right", block(4.0, 1.0), DVec2::new(2.0, -0.5));
        let ball = shop.body("ball", disc(0.5), 1.0, thrown(-1.0, 0.5 + gap, DVec2::X));
        shop.builder.add_gravity(ball, DVec2::new(0.0, -GRAVITY));
        let mut world = shop.build();
        advance(&mut world, 2.0);
        let state = world.state(ball);
        assert_eq!(world.statistics().impacts, 0, "from a gap of {gap} m");
        assert!((state.position - DVec2::new(1.0, 0.5 + GAP)).length() < 1e-9, "{state:?}");
        assert!((state.velocity - DVec2::X).length() < 1e-12, "{state:?}");
    }
}

#[test]
fn contacts_with_firm_forces_are_not_looked_at_again() {
    // A step of the default method has 12 stages, its end, and three more for dense output. Releases are watched at
    // five more places, unless the stages show that no force comes near to zero.
    let mut shop = Workshop::new(1e-9);
    shop.fixed("floor", block(40.0, 1.0), DVec2::new(0.0, -0.5));
    let sled = shop.dull("sled", disc(0.5), 1.0, thrown(0.0, 0.5, DVec2::new(1.0, 0.0)));
    shop.builder.add_force(Arc::new(Push([sled], |time| (7.0 * time).sin())));
    let mut world = shop.build();
    advance(&mut world, 5.0);
    let statistics = world.statistics();
    let per_step = statistics.evaluations as f64 / statistics.steps as f64;
    assert!(statistics.steps > 20 && per_step < 18.0, "{per_step} over {} steps", statistics.steps);
}

/// Two stones of a half arch, of inner radius 1 m, between a floor and a wall.
fn half_arch(outer: f64, joint: f64, tolerance: f64) -> World {
    let mut shop = Workshop::new(tolerance);
    shop.fixed("wall", block(0.5, 6.0), DVec2::new(-0.25, 1.0));
    shop.fixed("floor", block(2.0, 0.5), DVec2::new(1.8, -0.25));
    for (name, from, to) in [("lower", 0.0, joint), ("upper", joint, 0.5 * PI)] {
        let at = |angle: f64, radius: f64| radius * DVec2::from_angle(angle);
        let vertices = [at(from, 1.0), at(from, outer), at(to, outer), at(to, 1.0)];
        let stone = Shape::polygon(&vertices).expect("a stone");
        let place = stone.mass_properties().centroid;
        shop.dull(name, stone, 1.0, at_rest(place.x, place.y));
    }
    shop.build()
}

#[test]
fn stones_that_slide_apart_do_not_pull_as_their_faces_part() {
    // Two corners hold the stones flush. As the faces slide off each other, the corners come together, and their forces
    // grow without bound and change sign: one of them must let go before.
    let mut parted = 0;
    for case in 0..24 {
        let outer = 1.2 + 0.01 * f64::from(case);
        let joint = [0.7, 0.8, 0.9][case as usize % 3];
        let mut world = half_arch(outer, joint, 1e-3);
        let before = world.contact_forces().len();
        for step in 1..=120 {
            advance(&mut world, 5e-3 * f64::from(step));
            let least = world.contact_forces().iter().fold(0.0f64, |least, row| least.min(row.force));
            assert!(least > -1e-6 * GRAVITY, "{outer} m, {joint} rad: {least} N at {} s", world.time());
        }
        parted += u32::from(world.contact_forces().len() < before);
    }
    assert_eq!(parted, 24);
}
