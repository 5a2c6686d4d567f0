//! Planetary gears: a gear's row acts on three bodies.

use halfgap::force::{ConstantForce, ForceFrame, Push};
use halfgap::geometry::{DVec2, Shape};
use halfgap::{AdvanceBy, BodyId, BodyState, ConnectorKind, Turn, World, WorldSettings};
use halfgap_tests::mechanism::{Workshop, advance, at_rest, block, connector_error, disc, thrown};
use std::sync::Arc;

const WORLD: BodyId = BodyId::WORLD;
/// Radii [m] of the sun and the planets, and distance [m] from the one to the others.
const SUN: f64 = 0.2;
const PLANET: f64 = 0.16;
const ARM: f64 = SUN + PLANET;
/// Moments [kg m^2] of the sun, a planet and the arm; a planet has 1 kg.
const MOMENTS: [f64; 3] = [0.04, 0.0128, 0.0432];
/// Angles of the sun, a planet and the arm for one of the arm, in a ring that stands still.
const RATIOS: [f64; 3] = [3.6, -2.25, 1.0];

/// Inertia [kg m^2] of the whole gear as the arm sees it.
fn inertia(planets: f64) -> f64 {
    let [sun, planet, arm] = MOMENTS;
    sun * 3.6 * 3.6 + arm + planets * (ARM * ARM + planet * 2.25 * 2.25)
}

/// A sun, an arm and planets, in a ring that is the world.
struct Planetary {
    shop: Workshop,
    /// The sun, the first planet and the arm.
    bodies: [BodyId; 3],
}

impl Planetary {
    fn new(settings: WorldSettings, planets: usize, arm: Shape, turning: f64) -> Self {
        let mut shop = Workshop::of(settings).without_gravity();
        let spinning = |ratio: f64| BodyState { angular_velocity: ratio * turning, ..at_rest(0.0, 0.0) };
        let sun = shop.inert("sun", disc(SUN), [2.0, MOMENTS[0]], spinning(RATIOS[0]));
        let arm = shop.inert("arm", arm, [1.0, MOMENTS[2]], spinning(1.0));
        shop.pin(WORLD, sun, DVec2::ZERO);
        shop.pin(WORLD, arm, DVec2::ZERO);
        shop.builder.let_pass(sun, arm);
        let gear = |a: BodyId, b: BodyId, ratio: f64| {
            let turn = Turn { angle: 0.0, lever: SUN };
            ConnectorKind::Gear { a, b, carrier: arm, ratio, turn }
        };
        let places = [ARM, -ARM].map(|x| DVec2::new(x, 0.0));
        let mut first = None;
        for (index, place) in places.into_iter().enumerate().take(planets) {
            let state = BodyState { velocity: turning * place.perp(), ..spinning(RATIOS[1]) };
            let state = BodyState { position: place, ..state };
            let planet = shop.inert(&format!("planet {index}"), disc(PLANET), [1.0, MOMENTS[1]], state);
            first.get_or_insert(planet);
            shop.pin(arm, planet, place);
            shop.builder.let_pass(sun, planet);
            shop.connect(gear(sun, planet, -PLANET / SUN), 0.0);
            shop.connect(gear(planet, WORLD, (SUN + 2.0 * PLANET) / PLANET), 0.0);
        }
        Self { shop, bodies: [sun, first.expect("there is a planet"), arm] }
    }

    /// A torque [N m] on the sun.
    fn torque(&mut self, torque: f64) {
        let (frame, point, force) = (ForceFrame::World, DVec2::ZERO, DVec2::ZERO);
        let push = Push { frame, point, force, torque };
        self.shop.builder.add_force(Arc::new(ConstantForce::new("torque", self.bodies[0], push)));
    }
}

fn thin() -> Shape {
    block(1.2, 0.02)
}

fn at(tolerance: f64) -> WorldSettings {
    WorldSettings { tolerance, ..WorldSettings::default() }
}

/// Angles and angular velocities of some bodies.
fn turning(world: &World, bodies: [BodyId; 3]) -> [[f64; 2]; 3] {
    bodies.map(|body| {
        let state = world.state(body);
        [state.angle, state.angular_velocity]
    })
}

/// Largest difference of the angles and the angular velocities from those of a steady acceleration of the arm.
fn off(world: &World, bodies: [BodyId; 3], acceleration: f64) -> f64 {
    let time = world.time();
    let pairs = turning(world, bodies).into_iter().zip(RATIOS).map(|([angle, rate], ratio)| {
        let (a, r) = (0.5 * ratio * acceleration * time * time, ratio * acceleration * time);
        (angle - a).abs().max((rate - r).abs())
    });
    pairs.fold(0.0, f64::max)
}

#[test]
fn a_torque_on_the_sun_accelerates_the_inertia_of_the_whole_gear() {
    // Of two planets one is more than it takes: their gears depend on each other.
    for planets in [1, 2] {
        let mut gear = Planetary::new(at(1e-12), planets, thin(), 0.0);
        gear.torque(0.8);
        let bodies = gear.bodies;
        let mut world = gear.shop.build();
        let acceleration = 0.8 * 3.6 / inertia(planets as f64);
        for time in [0.1, 0.5, 2.0] {
            advance(&mut world, time);
            let off = off(&world, bodies, acceleration);
            println!("{planets} planets, {time} s: {off:e}, connectors {:e}", connector_error(&world));
            assert!(off < 1e-10 * acceleration * time.max(1.0), "{planets} planets, {time} s: {off}");
            assert!(
                connector_error(&world) < 1e-12,
                "{planets} planets, {time} s: {}",
                connector_error(&world)
            );
        }
        let [[sun, _], ..] = turning(&world, bodies);
        assert!(planets == 1 || (sun - 21.818_181_818_181_817).abs() < 1e-9, "{sun} rad");
    }
}

#[test]
fn an_elastic_blow_on_the_arm_meets_the_inertia_of_the_whole_gear() {
    for planets in [1, 2] {
        let mut gear = Planetary::new(at(1e-12), planets, thin(), 0.0);
        let (mass, lever) = (0.5, 0.56);
        let ball = gear.shop.body("ball", disc(0.02), mass, thrown(lever, -0.1, DVec2::new(0.0, 1.0)));
        let bodies = gear.bodies;
        let mut world = gear.shop.build();
        let before = world.energy().total();
        advance(&mut world, 0.5);
        let whole = inertia(planets as f64);
        let impulse = 2.0 / (1.0 / mass + lever * lever / whole);
        let rate = lever * impulse / whole;
        let left = 1.0 - impulse / mass;
        assert!((world.state(ball).velocity.y - left).abs() < 1e-12, "{:?}", world.state(ball));
        let states = turning(&world, bodies);
        for ([_, turned], ratio) in states.into_iter().zip(RATIOS) {
            assert!((turned - ratio * rate).abs() < 1e-11, "{planets}: {turned} for {}", ratio * rate);
        }
        let [[sun, _], [planet, _], [arm, _]] = states;
        println!("{planets} planets: {:e} {:e}", sun - 3.6 * arm, planet + 2.25 * arm);
        assert!((sun - 3.6 * arm).abs() < 1e-12 && (planet + 2.25 * arm).abs() < 1e-12, "{states:?}");
        assert!((world.energy().total() - before).abs() < 1e-12 * before, "{}", world.energy().total());
    }
}

#[test]
fn a_gear_whose_bodies_do_not_turn_together_is_made_to_at_the_start() {
    let mut gear = Planetary::new(at(1e-10), 1, thin(), 0.5);
    let state = BodyState { angular_velocity: 1.0, ..at_rest(0.0, 1.0) };
    let free = gear.shop.inert("wheel", disc(0.1), [1.0, 0.01], state);
    let turn = Turn { angle: 0.0, lever: 0.1 };
    let [_, planet, arm] = gear.bodies;
    gear.shop.connect(ConnectorKind::Gear { a: free, b: planet, carrier: arm, ratio: 2.0, turn }, 0.0);
    let world = gear.shop.build();
    let [wheel, planet, arm] = [free, planet, arm].map(|body| world.state(body).angular_velocity);
    assert!((wheel - 2.0 * planet + arm).abs() < 1e-14 && wheel != 1.0, "{wheel} {planet} {arm}");
    assert!((planet + 2.25 * arm).abs() < 1e-14 && arm != 0.5, "{planet} {arm}");
}

#[test]
fn by_steps_a_planetary_gear_turns_as_far() {
    let error = |step: f64, planets: usize| {
        let strategy = AdvanceBy::Steps { step: Some(step), residual: 1e-6 };
        let mut gear = Planetary::new(WorldSettings { strategy, ..at(1e-8) }, planets, thin(), 0.0);
        gear.torque(0.8);
        let bodies = gear.bodies;
        let mut world = gear.shop.build();
        advance(&mut world, 0.5);
        let acceleration = 0.8 * 3.6 / inertia(planets as f64);
        let pairs = turning(&world, bodies).into_iter().zip(RATIOS);
        pairs.fold([0.0_f64; 2], |[of_angle, of_rate], ([angle, rate], ratio)| {
            let (a, r) = (0.5 * 0.25 * ratio * acceleration, 0.5 * ratio * acceleration);
            [of_angle.max((angle - a).abs()), of_rate.max((rate - r).abs())]
        })
    };
    for planets in [1, 2] {
        let [coarse, fine] = [1.0 / 480.0, 1.0 / 960.0].map(|step| error(step, planets));
        println!("{planets} planets: {coarse:?}, {fine:?}");
        assert!(fine[0] < 2e-7 && fine[0] < 0.3 * coarse[0], "{planets} planets: {coarse:?}, {fine:?}");
        assert!(fine[1] < 2e-6 && fine[1] < 0.3 * coarse[1], "{planets} planets: {coarse:?}, {fine:?}");
    }
}

#[test]
fn by_steps_a_blow_goes_through_the_whole_gear() {
    let settings =
        WorldSettings { strategy: AdvanceBy::Steps { step: Some(1.0 / 960.0), residual: 1e-6 }, ..at(1e-8) };
    let mut gear = Planetary::new(settings, 1, thin(), 0.0);
    let (mass, lever) = (0.5, 0.56);
    let ball = gear.shop.body("ball", disc(0.02), mass, thrown(lever, -0.1, DVec2::new(0.0, 1.0)));
    let bodies = gear.bodies;
    let mut world = gear.shop.build();
    advance(&mut world, 0.5);
    let whole = inertia(1.0);
    let impulse = 2.0 / (1.0 / mass + lever * lever / whole);
    assert!((world.state(ball).velocity.y - (1.0 - impulse / mass)).abs() < 1e-3, "{:?}", world.state(ball));
    for ([_, rate], ratio) in turning(&world, bodies).into_iter().zip(RATIOS) {
        assert!((rate - ratio * lever * impulse / whole).abs() < 1e-2, "{rate}");
    }
}
