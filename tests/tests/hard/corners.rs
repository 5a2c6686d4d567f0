//! Corners of rails: bodies that pass them, come to rest in them, leave them again, and the sides along which they
//! leave.

use super::{impacts, within};
use halfgap::geometry::{DVec2, EdgeSpec};
use halfgap::{Anchor, BodyId, BodyState, ConnectorKind, Event, RailPath, World};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, connector_error, disc, pendulum_period};
use std::sync::Arc;

/// Radius of the bodies [m], and arm [m] by which a body hangs from its point.
const RADIUS: f64 = 0.1;
const ARM: f64 = 0.37;

/// Two lines of 2 m that rise from the origin by angles [rad] to the left and to the right.
fn valley([left, right]: [f64; 2]) -> Arc<RailPath> {
    let start = 2.0 * DVec2::new(-left.cos(), left.sin());
    let ends = [DVec2::ZERO, 2.0 * DVec2::new(right.cos(), right.sin())];
    let edges = ends.map(|to| EdgeSpec::Line { to });
    Arc::new(RailPath::from_edges(start, &edges).expect("a fine path"))
}

/// A disc of 1 kg on a valley, by a point at a given height [m] above its centre.
fn on_rail(shop: &mut Workshop, sides: [f64; 2], arm: f64, state: BodyState) -> BodyId {
    let body = shop.body("body", disc(RADIUS), 1.0, state);
    let a = Anchor { body, point: DVec2::new(0.0, arm) };
    shop.connect(ConnectorKind::Rail { a, path: valley(sides) }, 0.0);
    body
}

/// A disc that hangs with its point in the corner of a valley, turned by an angle [rad].
fn hanging(angle: f64, spin: f64) -> BodyState {
    let (sin, cos) = angle.sin_cos();
    BodyState {
        position: ARM * DVec2::new(sin, -cos),
        angle,
        velocity: spin * ARM * DVec2::new(cos, sin),
        angular_velocity: spin,
    }
}

/// Moment of inertia [kg m^2] of a hanging disc about its point, and square of its rate [1/s^2] in small swings.
fn pendulum() -> (f64, f64) {
    let about_point = 0.5 * RADIUS * RADIUS + ARM * ARM;
    (about_point, GRAVITY * ARM / about_point)
}

#[test]
fn a_disc_swings_about_a_corner_that_it_presses_into() {
    let amplitude = 0.3;
    let period = pendulum_period(pendulum().1.sqrt(), amplitude);
    for sides in [[0.4, 0.4], [0.35, 0.9], [1.2, 1.2]] {
        for tolerance in [1e-6, 1e-9] {
            let mut shop = Workshop::new(tolerance);
            let body = on_rail(&mut shop, sides, ARM, hanging(amplitude, 0.0));
            let mut world = shop.build();
            let blows = impacts(&mut world, 10.0 * period);
            let what = format!("swinging in a corner of {sides:?} rad at {tolerance:.0e}");
            within(&format!("{what}: impacts"), blows as f64, 0.0);
            within(&format!("{what}: off [m], by the tolerance"), connector_error(&world) / tolerance, 1.0);
            let angle = world.state(body).angle - amplitude;
            within(&format!("{what}: angle [rad], by the tolerance"), angle / tolerance, 10.0);
        }
    }
}

#[test]
fn a_disc_that_swings_too_far_leaves_its_corner_where_it_presses_no_more() {
    let (about_point, rate2) = pendulum();
    let share = ARM * ARM / about_point;
    let spin = 3.5;
    for side in [0.3_f64, 0.5] {
        // The force of the corner on the disc, as a fraction of its weight: it lies between the normals of both sides.
        let force = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let speed2 = spin * spin - 2.0 * rate2 * (1.0 - cos);
            let (turning, swinging) = (-share * sin, speed2 * ARM / GRAVITY);
            DVec2::new(turning * cos - swinging * sin, 1.0 + turning * sin + swinging * cos)
        };
        let presses = |angle: f64| -force(angle).x * side.cos() < force(angle).y * side.sin();
        let (mut held, mut free) = (0.0, 1.0);
        assert!(presses(held) && !presses(free), "it leaves between the two");
        for _ in 0..60 {
            let middle = 0.5 * (held + free);
            if presses(middle) { held = middle } else { free = middle }
        }
        let mut shop = Workshop::new(1e-9);
        let body = on_rail(&mut shop, [side, side], ARM, hanging(0.0, spin));
        let mut world = shop.build();
        let energy = world.energy().total();
        let mut left = Vec::new();
        let mut look = |event: &Event| {
            if let Event::ContactEnds(end) = event {
                left.push(end.time);
            }
        };
        world.advance_to(0.3, &mut look).expect("it swings");
        assert!(left.len() >= 2, "both sides end: {left:?}");
        let mut again = {
            let mut shop = Workshop::new(1e-9);
            on_rail(&mut shop, [side, side], ARM, hanging(0.0, spin));
            shop.build()
        };
        advance(&mut again, left[0]);
        let what = format!("a disc that leaves a corner of {side} rad");
        within(&format!("{what}: angle [rad]"), again.state(body).angle - held, 1e-8);
        // Leaving the corner costs no energy. The disc goes up the side on which the force would have had to pull.
        within(&format!("{what}: energy [J]"), world.energy().total() - energy, 1e-8);
        let state = world.state(body);
        let point = state.position + ARM * DVec2::new(-state.angle.sin(), state.angle.cos());
        let across = point.dot(DVec2::new(-side.sin(), side.cos()));
        within(&format!("{what}: off its side [m]"), across, 1e-9);
        assert!(point.x > 1e-3, "{point} m");
    }
}

#[test]
fn a_bead_that_comes_into_a_sharp_corner_stays_there() {
    for [left, right] in [[1.05, 1.05], [1.2, 0.9], [0.9, 1.4]] {
        let mut shop = Workshop::new(1e-8);
        let state = at_rest(-0.5 * f64::cos(left), 0.5 * f64::sin(left));
        let bead = on_rail(&mut shop, [left, right], 0.0, state);
        let mut world = shop.build();
        let blows = impacts(&mut world, 2.0);
        let what = format!("bead in a corner of {left} and {right} rad");
        within(&format!("{what}: impacts other than one"), blows as f64 - 1.0, 0.0);
        within(&format!("{what}: off [m]"), world.state(bead).position.length(), 1e-12);
        let lost = world.ledger().impacts + GRAVITY * 0.5 * f64::sin(left);
        within(&format!("{what}: energy of the impact [J]"), lost, 1e-12);
    }
}

#[test]
fn a_bead_that_is_struck_out_of_a_corner_keeps_to_its_rail() {
    let (side, weight, speed) = (0.3_f64, 0.5, 4.0);
    for elasticity in [0.0, 0.5, 1.0] {
        let mut shop = Workshop::weightless(1e-9);
        let bead = on_rail(&mut shop, [side, side], 0.0, at_rest(0.0, 0.0));
        let state = BodyState { velocity: DVec2::new(0.0, speed), ..at_rest(0.0, -0.5) };
        let ball = shop.settler("ball", disc(RADIUS), weight, state, elasticity);
        let mut world = shop.build();
        advance(&mut world, 0.3);
        // The bead can move along one side only: J (sin^2 + 1/m) = (1 + e) v.
        let impulse = (1.0 + elasticity) * speed / (side.sin().powi(2) + 1.0 / weight);
        let velocity = world.state(bead).velocity;
        let along = velocity.x.abs() * side.cos() + velocity.y * side.sin();
        let what = format!("bead struck with e = {elasticity}");
        within(&format!("{what}: speed [m/s]"), along - impulse * side.sin(), 1e-12);
        within(&format!("{what}: across [m/s]"), velocity.length() - along, 1e-12);
        let left = speed - impulse / weight;
        within(&format!("{what}: the ball [m/s]"), world.state(ball).velocity.y - left, 1e-12);
    }
}

#[test]
fn a_bead_in_a_corner_sets_out_along_the_side_of_its_velocity() {
    let sides = [0.5, 0.2];
    let directions = [
        DVec2::new(-f64::cos(sides[0]), f64::sin(sides[0])),
        DVec2::new(f64::cos(sides[1]), f64::sin(sides[1])),
    ];
    let kept = -directions[0].dot(directions[1]);
    for (side, direction) in directions.into_iter().enumerate() {
        for sense in [1.0, -1.0] {
            let mut shop = Workshop::weightless(1e-8);
            let state = BodyState { velocity: sense * direction, ..BodyState::default() };
            let bead = on_rail(&mut shop, sides, 0.0, state);
            let mut world = shop.build();
            advance(&mut world, 1.0);
            // A velocity that leads through the corner keeps its part along the other side.
            let expected = if sense > 0.0 { direction } else { kept * directions[1 - side] };
            let off = world.state(bead).position.distance(expected);
            within(&format!("bead from a corner, side {side}, {sense}: place [m]"), off, 1e-12);
            let lost = if sense > 0.0 { 0.0 } else { 0.5 * (1.0 - kept * kept) };
            let ledger = world.ledger();
            within("bead from a corner: energy of the impact [J]", ledger.impacts + lost, 1e-12);
            within("bead from a corner: captures [J]", ledger.captures, 1e-12);
        }
    }
}

/// The place of a hanging disc that slides into a valley, or into its mirror image.
fn slides(is_mirrored: bool) -> DVec2 {
    let sides = if is_mirrored { [0.6, 0.4] } else { [0.4, 0.6] };
    let mirror = |x: f64| if is_mirrored { -x } else { x };
    let mut shop = Workshop::new(1e-10);
    let start = at_rest(mirror(-0.5 * f64::cos(0.4)), 0.5 * f64::sin(0.4) - ARM);
    let body = on_rail(&mut shop, sides, ARM, start);
    let mut world: World = shop.build();
    advance(&mut world, 2.0);
    let place = world.state(body).position;
    DVec2::new(mirror(place.x), place.y)
}

#[test]
fn a_valley_and_its_mirror_image_do_the_same() {
    within("a disc in a valley and in its mirror image [m]", slides(true).distance(slides(false)), 1e-8);
}

/// A valley with a gentle piece at the bottom, which rises by 2 degrees: a bead that starts from rest on the left just
/// passes the corner at the end of that piece.
#[test]
fn a_bead_that_just_passes_a_corner_has_passed_it() {
    let degree = std::f64::consts::PI / 180.0;
    let (steep, gentle) = (29.0 * degree, 2.0 * degree);
    // The speed is multiplied by the cosine of each turn.
    let kept = (steep + gentle).cos();
    for beyond in [1e-5_f64, 1e-3, 0.1] {
        // The height from which the bead just reaches the end of the gentle piece, raised by the fraction `beyond`.
        let height = gentle.sin() * (1.0 + beyond) / (kept * kept);
        let far = DVec2::new(gentle.cos(), gentle.sin());
        let start = 2.0 * DVec2::new(-steep.cos(), steep.sin());
        let ends = [DVec2::ZERO, far, far + 2.0 * DVec2::new(steep.cos(), steep.sin())];
        let edges = ends.map(|to| EdgeSpec::Line { to });
        let path = Arc::new(RailPath::from_edges(start, &edges).expect("a fine path"));
        let way = height / steep.sin();
        for tolerance in [1e-6, 1e-9] {
            let mut shop = Workshop::new(tolerance);
            let bead = shop.body("bead", disc(RADIUS), 1.0, at_rest(-way * steep.cos(), height));
            let a = Anchor { body: bead, point: DVec2::ZERO };
            shop.connect(ConnectorKind::Rail { a, path: path.clone() }, 0.0);
            let mut world = shop.build();
            // Down, up the gentle piece, round its end and back down to it: three corners.
            let (down, up) = (GRAVITY * steep.sin(), GRAVITY * gentle.sin());
            let speed = kept * (2.0 * GRAVITY * height).sqrt();
            let at_end = (speed * speed - 2.0 * up).sqrt();
            let passed = at_end * (steep - gentle).cos();
            let time = (2.0 * way / down).sqrt() + (speed - at_end) / up + 2.0 * passed / down;
            let blows = impacts(&mut world, time + 1e-3);
            let what = format!("a bead {beyond:.0e} beyond a corner at {tolerance:.0e}");
            within(&format!("{what}: impacts other than three"), blows as f64 - 3.0, 0.0);
        }
    }
}

#[test]
fn a_body_struck_out_of_a_corner_goes_along_the_side_that_opens_the_other_whichever_way_the_path_runs() {
    // The body hangs by an arm, which makes one side much easier to move than the other.
    for is_reversed in [false, true] {
        let sides = [0.2_f64, 0.9];
        let mut ends = [
            2.0 * DVec2::new(-sides[0].cos(), sides[0].sin()),
            2.0 * DVec2::new(sides[1].cos(), sides[1].sin()),
        ];
        if is_reversed {
            ends.reverse();
        }
        let edges = [DVec2::ZERO, ends[1]].map(|to| EdgeSpec::Line { to });
        let path = Arc::new(RailPath::from_edges(ends[0], &edges).expect("a fine path"));
        let mut shop = Workshop::weightless(1e-9);
        let body = shop.body("body", disc(RADIUS), 1.0, at_rest(0.0, -0.5));
        let a = Anchor { body, point: DVec2::new(0.0, 0.5) };
        shop.connect(ConnectorKind::Rail { a, path }, 0.0);
        let state = BodyState { velocity: DVec2::Y, ..at_rest(0.0, -1.0) };
        shop.body("ball", disc(RADIUS), 1.0, state);
        let mut world = shop.build();
        let energy = world.energy().total();
        let blows = impacts(&mut world, 0.35);
        within("struck on an arm: impacts other than one", blows as f64 - 1.0, 0.0);
        within("struck on an arm: energy [J]", world.energy().total() - energy, 1e-9);
    }
}

#[test]
fn a_stop_holds_beyond_a_corner_that_turns_by_more_than_a_right_angle() {
    let (sides, room) = ([1.0, 0.82], 0.05);
    let mut shop = Workshop::new(1e-8);
    let start = at_rest(-0.6 * f64::cos(sides[0]), 0.6 * f64::sin(sides[0]) - ARM);
    let body = shop.body("body", disc(RADIUS), 1.0, start);
    let a = Anchor { body, point: DVec2::new(0.0, ARM) };
    let path = valley(sides);
    shop.connect(ConnectorKind::Rail { a, path: path.clone() }, 0.0);
    shop.connect(ConnectorKind::RailStop { a, path, at: 2.0 + room, upper: true }, 0.0);
    let mut world = shop.build();
    let (mut farthest, mut blows) = (0.0f64, 0);
    for look in 1..=2000 {
        blows += impacts(&mut world, 1e-3 * f64::from(look));
        let state = world.state(body);
        let point = state.position + ARM * DVec2::new(-state.angle.sin(), state.angle.cos());
        if point.x > 0.0 {
            farthest = farthest.max(point.length());
        }
    }
    assert!(blows > 1 && farthest > 0.5 * room, "it comes to the stop: {farthest} m, {blows} impacts");
    within("a stop beyond a sharp corner: run over by [m]", (farthest - room).max(0.0), 1e-9);
}
