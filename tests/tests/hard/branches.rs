//! Loops closed by rods, slots or contacts, at points where they could go on in two ways.

use super::within;
use halfgap::geometry::DVec2;
use halfgap::{Anchor, BodyId, BodyState, ConnectorKind, SlotFrame, Stabilization, World, WorldSettings};
use halfgap_tests::mechanism::{Workshop, advance, block, connector_error, disc};

const WORLD: BodyId = BodyId::WORLD;
const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];
/// BodyAcceleration [rad/s] of the mechanisms at first, and duration [s] of the runs.
const SPIN: f64 = 3.0;
const DURATION: f64 = 2.0;

/// Time [s] that a mechanism of one freedom takes from one angle to another. Twice its kinetic energy is `metric` [kg
/// m^2] times the square of the rate, which is [`SPIN`] at first.
fn elapsed(metric: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    const PIECES: i32 = 20_000;
    let step = (to - from) / f64::from(2 * PIECES);
    let at = |index: i32| (metric(from + f64::from(index) * step) / metric(from)).sqrt() / SPIN;
    let piece = |index: i32| at(2 * index) + 4.0 * at(2 * index + 1) + at(2 * index + 2);
    (0..PIECES).map(piece).sum::<f64>() * step / 3.0
}

fn rod(shop: &mut Workshop, [a, b]: [BodyId; 2], [from, to]: [DVec2; 2]) {
    let kind =
        ConnectorKind::Rod { a: shop.anchor(a, from), b: shop.anchor(b, to), length: from.distance(to) };
    shop.connect(kind, 0.0);
}

fn weightless(tolerance: f64) -> Workshop {
    Workshop::passing(tolerance).without_gravity()
}

/// A crank of 1 m whose rod of the same length drives a slider along a line through its pivot: where the crank stands
/// straight up, the slider is on the pivot, and could stay there.
fn slider_crank(tolerance: f64, start: f64) -> (World, [BodyId; 2]) {
    let mut shop = weightless(tolerance);
    let spinning = BodyState { angle: start, angular_velocity: SPIN, ..BodyState::default() };
    let crank = shop.inert("crank", disc(0.05), [1.0, 0.5], spinning);
    let place = DVec2::new(2.0 * start.cos(), 0.0);
    let velocity = DVec2::new(-2.0 * SPIN * start.sin(), 0.0);
    let slider =
        shop.body("slider", disc(0.05), 1.0, BodyState { position: place, velocity, ..BodyState::default() });
    shop.pin(WORLD, crank, DVec2::ZERO);
    rod(&mut shop, [crank, slider], [DVec2::from_angle(start), place]);
    let on_line = Anchor { body: WORLD, point: DVec2::ZERO };
    let kind = ConnectorKind::Slot {
        a: on_line,
        b: shop.anchor(slider, place),
        normal: DVec2::Y,
        frame: SlotFrame::World,
    };
    shop.connect(kind, 0.0);
    (shop.build(), [crank, slider])
}

#[test]
fn a_slider_passes_the_pivot_of_its_crank() {
    for tolerance in TOLERANCES {
        let (mut late, mut off): (f64, f64) = (0.0, 0.0);
        for start in [0.1, 0.25, 0.45, 0.7, 0.9, 1.2] {
            let (mut world, [crank, slider]) = slider_crank(tolerance, start);
            advance(&mut world, DURATION);
            let [crank, slider] = [crank, slider].map(|body| world.state(body));
            let taken = elapsed(|angle| 0.5 + 4.0 * angle.sin().powi(2), start, crank.angle);
            late = late.max(((taken - DURATION) * crank.angular_velocity).abs());
            off = off.max((slider.position.x - 2.0 * crank.angle.cos()).abs());
        }
        within(
            &format!("slider over its crank's pivot at {tolerance}: angle [rad]"),
            late,
            tolerance.max(1e-9),
        );
        within(&format!("slider over its crank's pivot at {tolerance}: place [m]"), off, tolerance.max(1e-9));
    }
}

/// A near point that goes round on a rod of 1 m, and a far point that two rods of 1.5 m tie to the near one and to a
/// point of the world 1 m from the pivot. When the near point passes that point of the world, the far one could stay
/// where it is, or go round, too.
fn kite(tolerance: f64, start: f64) -> (World, [BodyId; 2]) {
    let mut shop = weightless(tolerance);
    let point = |name: &str, [position, rate]: [DVec2; 2], shop: &mut Workshop| {
        let state = BodyState { position, velocity: SPIN * rate, ..BodyState::default() };
        shop.body(name, disc(0.05), 1.0, state)
    };
    let near = [DVec2::from_angle(start), DVec2::from_angle(start).perp()];
    let far = far_corner(start);
    let bodies = [point("near", near, &mut shop), point("far", far, &mut shop)];
    rod(&mut shop, [WORLD, bodies[0]], [DVec2::ZERO, near[0]]);
    rod(&mut shop, bodies, [near[0], far[0]]);
    rod(&mut shop, [WORLD, bodies[1]], [DVec2::X, far[0]]);
    (shop.build(), bodies)
}

/// The kite's far corner, and its derivative by the angle of the near one.
fn far_corner(angle: f64) -> [DVec2; 2] {
    let (sin, cos) = (0.5 * angle).sin_cos();
    let side = (1.5f64.powi(2) - sin * sin).sqrt();
    let (way, growth) = (cos + side, -0.5 * sin * (1.0 + cos / side));
    let along = DVec2::new(cos, sin);
    [way * along, growth * along + 0.5 * way * along.perp()]
}

#[test]
fn a_kite_of_rods_opens_again_as_it_has_closed() {
    for tolerance in TOLERANCES {
        let (mut late, mut off): (f64, f64) = (0.0, 0.0);
        for start in [-2.0, -1.5, -1.2, -0.8, -0.5, -0.3] {
            let (mut world, [near, far]) = kite(tolerance, start);
            let mut angle = start;
            for piece in 1..=100 {
                advance(&mut world, 0.01 * DURATION * f64::from(piece));
                let place = world.state(near).position;
                angle += DVec2::from_angle(angle).angle_to(place);
            }
            let near = world.state(near);
            let taken = elapsed(|angle| 1.0 + far_corner(angle)[1].length_squared(), start, angle);
            late = late.max(((taken - DURATION) * near.velocity.length()).abs());
            off = off.max(world.state(far).position.distance(far_corner(angle)[0]));
        }
        within(&format!("kite of rods at {tolerance}: angle [rad]"), late, tolerance.max(1e-9));
        within(&format!("kite of rods at {tolerance}: far corner [m]"), off, tolerance.max(1e-9));
    }
}

/// Point halfway between the pivots of the two rods of 1 m.
const MIDDLE: DVec2 = DVec2::new(0.5, 0.0);

/// A bar that goes round level on two rods of the same length, which start at a given angle [rad]: where the rods are
/// flat, one could go on one way and the other the other way.
fn bar_on_two_rods(shop: &mut Workshop, start: f64) -> BodyId {
    let arm = DVec2::from_angle(start);
    let state = BodyState { position: MIDDLE + arm, velocity: SPIN * arm.perp(), ..BodyState::default() };
    let bar = shop.inert("bar", disc(0.05), [1.0, 0.2], state);
    for end in [DVec2::ZERO, DVec2::X] {
        rod(shop, [WORLD, bar], [end, end + arm]);
    }
    bar
}

#[test]
fn a_bar_on_two_equal_rods_goes_round_level() {
    for tolerance in TOLERANCES {
        let (mut off, mut turned): (f64, f64) = (0.0, 0.0);
        for start in (0..=24).map(|index| 0.5 + f64::from(index) / 12.0) {
            let mut shop = weightless(tolerance);
            let bar = bar_on_two_rods(&mut shop, start);
            let mut world = shop.build();
            advance(&mut world, DURATION);
            let state = world.state(bar);
            off = off.max(state.position.distance(MIDDLE + DVec2::from_angle(start + SPIN * DURATION)));
            turned = turned.max(state.angle.abs());
        }
        within(&format!("bar on two rods at {tolerance}: place [m]"), off, tolerance.max(1e-9));
        within(&format!("bar on two rods at {tolerance}: angle [rad]"), turned, tolerance.max(1e-9));
    }
}

#[test]
fn a_load_on_a_platform_that_two_wheels_carry_round_stays_on_it() {
    for tolerance in TOLERANCES {
        let mut shop = Workshop::new(tolerance);
        let axles = [DVec2::ZERO, DVec2::new(2.5, 0.0)];
        let (angle, spin) = (1.8f64, 1.36);
        let arm = DVec2::from_angle(angle);
        let middle = DVec2::new(1.25, 0.0);
        let wheel = |name: &str, inertia: [f64; 2], position: DVec2, shop: &mut Workshop| {
            let state = BodyState { position, angle, angular_velocity: spin, ..BodyState::default() };
            shop.inert(name, disc(0.1), inertia, state)
        };
        let wheels = [
            wheel("left wheel", [2.6, 18.8], axles[0], &mut shop),
            wheel("right wheel", [6.5, 94.7], axles[1], &mut shop),
        ];
        let carried =
            BodyState { position: middle + arm, velocity: spin * arm.perp(), ..BodyState::default() };
        let platform = shop.body("platform", block(7.0, 0.1), 0.19, carried);
        let lies = BodyState {
            position: middle + DVec2::new(0.0, arm.y + 0.15),
            velocity: DVec2::new(0.0, spin * arm.x),
            ..BodyState::default()
        };
        let load = shop.dull("load", block(0.4, 0.2), 2.7, lies);
        for (&axle, &wheel) in axles.iter().zip(&wheels) {
            shop.pin(WORLD, wheel, axle);
            shop.pin(wheel, platform, axle + arm);
        }
        for wheel in wheels {
            for other in [platform, load] {
                shop.builder.let_pass(wheel, other);
            }
        }
        let mut world = shop.build();
        let energy = world.energy().total();
        let mut impacts = 0;
        world
            .advance_to(4.6, &mut |event| impacts += usize::from(matches!(event, halfgap::Event::Impact(_))))
            .expect("it goes round");
        let what = format!("load on a platform at {tolerance}");
        let [load, platform] = [load, platform].map(|body| world.state(body));
        within(&format!("{what}: way along it [m]"), load.position.x - middle.x, tolerance.max(1e-9));
        let height = load.position.y - platform.position.y - 0.15;
        within(&format!("{what}: height over it [m]"), height, tolerance.max(1e-9));
        within(&format!("{what}: energy [J]"), world.energy().total() - energy, 10.0 * tolerance.max(1e-9));
        within(&format!("{what}: connectors [m]"), connector_error(&world), 1e-9);
        assert!(impacts < 2, "{what}: {impacts} impacts");
    }
}

#[test]
fn a_bar_that_is_not_moved_onto_its_rows_is_not_led_either() {
    // The bar drifts off its rows, but does not stop.
    for start in (0..=11).map(|index| 0.5 + f64::from(index) / 6.0) {
        let mut shop = Workshop::of(WorldSettings {
            tolerance: 1e-9,
            time_step: Some(2e-3),
            stabilization: Stabilization::None,
            collisions: false,
            ..WorldSettings::default()
        })
        .without_gravity();
        let bar = bar_on_two_rods(&mut shop, start);
        let mut world = shop.build();
        advance(&mut world, 5.0);
        let speed = world.state(bar).velocity.length();
        assert!((speed - SPIN).abs() < 1.0, "from {start} rad: {speed} m/s");
    }
}
