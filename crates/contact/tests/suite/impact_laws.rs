//! Promises of every impact law: no energy out of nothing, momentum kept, no row left closing.

use crate::laws::{LAWS, ORDERS};
use halfgap_collision::BodyId;
use halfgap_contact::{CollisionRow, Impact, ImpactError, ImpactLaw, ImpactOrder, RowKind};
use proptest::prelude::*;

/// Rounding of sums of a few products of numbers near 1.
const ROUNDING: f64 = 1e-12;

/// A body of the test: its inverse inertia and its velocities.
#[derive(Clone, Copy, Debug)]
struct Mover {
    /// 1/mass, 1/mass, 1/moment.
    inverse: [f64; 3],
    velocity: [f64; 3],
}

/// A contact: bodies, direction of the normal, its arms about both centres of mass, elasticity.
#[derive(Clone, Copy, Debug)]
struct Touch {
    bodies: [usize; 2],
    angle: f64,
    moments: [f64; 2],
    elasticity: f64,
}

impl Touch {
    fn jacobian(&self) -> [f64; 6] {
        let (sin, cos) = self.angle.sin_cos();
        [cos, sin, self.moments[0], -cos, -sin, -self.moments[1]]
    }

    fn turned(self) -> Self {
        Self { angle: self.angle + std::f64::consts::PI, moments: self.moments.map(|moment| -moment), ..self }
    }

    fn row(&self, movers: &[Mover]) -> CollisionRow {
        let jacobian = self.jacobian();
        let side = |k: usize| &movers[self.bodies[k / 3]];
        CollisionRow {
            bodies: self.bodies.map(|body| BodyId(body as u32)),
            jacobian,
            response: std::array::from_fn(|k| jacobian[k] * side(k).inverse[k % 3]),
            third: None,
            elasticity: self.elasticity,
            velocity_tol: 1e-9,
            kind: RowKind::Unilateral,
            was_active: false,
            rate: (0..6).map(|k| jacobian[k] * side(k).velocity[k % 3]).sum(),
        }
    }
}

fn energy(movers: &[Mover]) -> f64 {
    let parts = movers.iter().flat_map(|mover| (0..3).map(|k| (mover.velocity[k], mover.inverse[k])));
    parts
        .filter(|&(_, inverse)| inverse > 0.0)
        .map(|(velocity, inverse)| 0.5 * velocity * velocity / inverse)
        .sum()
}

/// Resolves the impact and gives the bodies after it.
fn resolve(
    law: ImpactLaw,
    order: ImpactOrder,
    movers: &[Mover],
    touches: &[Touch],
) -> Result<(Vec<Mover>, Impact), ImpactError> {
    let mut impact = Impact::new();
    impact.set_rows(touches.iter().map(|touch| touch.row(movers)));
    law.resolve(&mut impact, order, 3)?;
    let mut after = movers.to_vec();
    for (row, &impulse) in impact.rows().iter().zip(impact.impulses()) {
        for k in 0..6 {
            after[row.bodies[k / 3].index()].velocity[k % 3] += row.response[k] * impulse;
        }
    }
    Ok((after, impact))
}

fn any_mover() -> impl Strategy<Value = Mover> {
    (0.3..3.0f64, 0.3..3.0f64, prop::array::uniform3(-1.0..1.0f64)).prop_map(|(mass, moment, velocity)| {
        Mover { inverse: [1.0 / mass, 1.0 / mass, 1.0 / moment], velocity }
    })
}

fn any_touch(bodies: [usize; 2]) -> impl Strategy<Value = Touch> {
    let elasticity = prop_oneof![Just(0.0), Just(1.0), 0.0..1.0f64];
    (-3.2..3.2f64, prop::array::uniform2(-1.0..1.0f64), elasticity)
        .prop_map(move |(angle, moments, elasticity)| Touch { bodies, angle, moments, elasticity })
}

/// Two rows on the same two bodies, or a chain of three bodies.
fn any_two_rows() -> impl Strategy<Value = (Vec<Mover>, Vec<Touch>)> {
    let second = prop_oneof![Just([0usize, 1]), Just([1, 2])];
    let touches = second.prop_flat_map(|bodies| (any_touch([0, 1]), any_touch(bodies)));
    (prop::array::uniform3(any_mover()), touches).prop_map(|(movers, (a, b))| (movers.to_vec(), vec![a, b]))
}

fn block_landing_flat(elasticity: f64) -> (Vec<Mover>, Vec<Touch>) {
    let block = Mover { inverse: [1.0, 1.0, 6.0], velocity: [0.3, -1.0, 0.0] };
    let floor = Mover { inverse: [0.0; 3], velocity: [0.0; 3] };
    let corner = |arm: f64| Touch {
        bodies: [0, 1],
        angle: std::f64::consts::FRAC_PI_2,
        moments: [arm, arm],
        elasticity,
    };
    (vec![block, floor], vec![corner(-0.5), corner(0.5)])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn energy_never_grows_and_no_row_is_left_closing((movers, touches) in any_two_rows()) {
        for law in LAWS {
            for order in ORDERS {
                let (after, impact) = resolve(law, order, &movers, &touches).expect("two rows between free bodies");
                let (before_energy, after_energy) = (energy(&movers), energy(&after));
                let largest = impact.impulses().iter().fold(1.0f64, |most, j| most.max(*j));
                prop_assert!(
                    after_energy <= before_energy + ROUNDING * largest * largest,
                    "{:?}: energy {} becomes {}", law, before_energy, after_energy
                );
                let fastest = impact.rows().iter().fold(0.0f64, |most, row| most.max(-row.rate));
                for (row, touch) in touches.iter().enumerate() {
                    prop_assert!(impact.impulses()[row] >= 0.0);
                    let rate = touch.row(&after).rate;
                    prop_assert!(rate >= -2.0 * ROUNDING * (fastest + largest), "{:?}: row {} closes at {}", law, row, rate);
                    prop_assert!((rate - impact.rates()[row]).abs() <= ROUNDING * (1.0 + largest));
                }
            }
        }
    }

    #[test]
    fn elastic_rows_keep_the_energy((movers, mut touches) in any_two_rows()) {
        for touch in &mut touches {
            touch.elasticity = 1.0;
        }
        for law in [ImpactLaw::Hybrid, ImpactLaw::SerialSeparate, ImpactLaw::SerialGrouped, ImpactLaw::Simultaneous] {
            let (after, impact) = resolve(law, ImpactOrder::Fastest, &movers, &touches).expect("two free rows");
            // Many rounds in a tight corner end without elasticity: those impacts may lose some energy, others none.
            if impact.solves() < 100 {
                let largest = impact.impulses().iter().fold(1.0f64, |most, j| most.max(*j));
                prop_assert!((energy(&after) - energy(&movers)).abs() <= 1e-11 * largest * largest, "{:?}", law);
            }
        }
    }

    #[test]
    fn momentum_is_kept_between_free_bodies((movers, touches) in any_two_rows()) {
        let sum = |movers: &[Mover], k: usize| movers.iter().map(|m| m.velocity[k] / m.inverse[k]).sum::<f64>();
        for law in LAWS {
            let (after, impact) = resolve(law, ImpactOrder::Fastest, &movers, &touches).expect("two free rows");
            let largest = impact.impulses().iter().fold(1.0f64, |most, j| most.max(*j));
            for k in 0..2 {
                prop_assert!((sum(&after, k) - sum(&movers, k)).abs() <= ROUNDING * 10.0 * largest);
            }
        }
    }

    #[test]
    fn one_elastic_row_reverses_its_rate(movers in prop::array::uniform2(any_mover()), touch in any_touch([0, 1])) {
        let touch = Touch { elasticity: 1.0, ..touch };
        for law in LAWS {
            let (after, impact) = resolve(law, ImpactOrder::Fastest, &movers, &[touch]).expect("one free row");
            let (before, now) = (impact.rows()[0].rate, touch.row(&after).rate);
            prop_assert!((now - before.abs()).abs() <= ROUNDING);
            prop_assert_eq!(impact.impulses()[0] > 0.0, before < 0.0);
        }
    }

    #[test]
    fn two_rows_that_close_alike_on_the_same_two_bodies_are_simultaneous_in_the_hybrid_law(
        movers in prop::array::uniform2(any_mover()), a in any_touch([0, 1]), b in any_touch([0, 1]),
    ) {
        // A contact that opens is one that closes, seen from its other side.
        let facing = |touch: Touch| if touch.row(&movers).rate < 0.0 { touch } else { touch.turned() };
        let touches = [facing(a), facing(b)];
        let [p, q] = touches.map(|touch| touch.row(&movers).rate.abs());
        prop_assume!(p.min(q) > p.max(q) / 32.0);
        let (hybrid, _) = resolve(ImpactLaw::Hybrid, ImpactOrder::Fastest, &movers, &touches).expect("two rows");
        let (together, impact) = resolve(ImpactLaw::Simultaneous, ImpactOrder::Fastest, &movers, &touches).expect("two rows");
        let largest = impact.impulses().iter().fold(1.0f64, |most, j| most.max(*j));
        for (p, q) in hybrid.iter().zip(&together) {
            for k in 0..3 {
                prop_assert!((p.velocity[k] - q.velocity[k]).abs() <= ROUNDING * 10.0 * largest);
            }
        }
    }

    #[test]
    fn a_seed_repeats_its_order((movers, touches) in any_two_rows(), seed in any::<u64>()) {
        let order = ImpactOrder::Seeded(seed);
        let once = resolve(ImpactLaw::SerialSeparate, order, &movers, &touches).expect("two rows");
        let again = resolve(ImpactLaw::SerialSeparate, order, &movers, &touches).expect("two rows");
        prop_assert_eq!(once.1.impulses(), again.1.impulses());
    }
}

#[test]
fn seeds_choose_which_of_two_equal_rows_comes_first() {
    // A disc flies into the corner of two others, more slowly along one normal: the order of rows decides its way out.
    let mover = |velocity| Mover { inverse: [1.0, 1.0, 2.0], velocity };
    let movers = [mover([1.0, 0.0, 0.0]), mover([0.0; 3]), mover([0.0; 3])];
    let touch = |other, angle: f64| Touch { bodies: [0, other], angle, moments: [0.0; 2], elasticity: 1.0 };
    let touches = [touch(1, 2.6), touch(2, -2.6)];
    let after = |seed| {
        let order = ImpactOrder::Seeded(seed);
        resolve(ImpactLaw::SerialSeparate, order, &movers, &touches).expect("two rows").0[0].velocity[1]
    };
    let upwards = (0..40).filter(|&seed| after(seed) > 0.0).count();
    assert!((8..=32).contains(&upwards), "{upwards} of 40 seeds take one row first");
}

#[test]
fn a_block_landing_flat_loads_both_corners_alike_when_solved_together() {
    for elasticity in [0.0, 0.5, 1.0] {
        let (movers, touches) = block_landing_flat(elasticity);
        for law in [ImpactLaw::Simultaneous, ImpactLaw::Hybrid] {
            let (after, impact) = resolve(law, ImpactOrder::Fastest, &movers, &touches).expect("two rows");
            assert!((impact.impulses()[0] - impact.impulses()[1]).abs() < 1e-15);
            assert!((after[0].velocity[1] - elasticity).abs() < 1e-15);
            assert!(after[0].velocity[2].abs() < 1e-15);
        }
    }
}

#[test]
fn active_rows_at_rest_take_part_in_a_simultaneous_impact() {
    // Three equal discs in a row, the last two at rest and touching: solved together they leave together.
    let mover = |velocity: f64| Mover { inverse: [1.0, 1.0, 2.0], velocity: [velocity, 0.0, 0.0] };
    let movers = [mover(1.0), mover(0.0), mover(0.0)];
    let touch = |bodies| Touch { bodies, angle: std::f64::consts::PI, moments: [0.0; 2], elasticity: 1.0 };
    let touches = [touch([0, 1]), touch([1, 2])];
    let speeds = |law| {
        let (after, _) = resolve(law, ImpactOrder::Fastest, &movers, &touches).expect("two rows");
        [0, 1, 2].map(|body| after[body].velocity[0])
    };
    let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-14);
    assert!(near(speeds(ImpactLaw::Simultaneous), [-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0]));
    assert!(near(speeds(ImpactLaw::SerialSeparate), [0.0, 0.0, 1.0]));
    assert!(near(speeds(ImpactLaw::Hybrid), [0.0, 0.0, 1.0]));
}

#[test]
fn a_line_of_nearly_elastic_discs_does_nearly_as_elastic_ones_do() {
    // Two discs strike three at rest: two leave. The impulses that run through the line leave small closing rates.
    let mover = |velocity: f64| Mover { inverse: [1.0, 1.0, 2.0], velocity: [velocity, 0.0, 0.0] };
    let movers = [1.0, 1.0, 0.0, 0.0, 0.0].map(mover);
    for elasticity in [0.9, 0.99, 0.999, 0.9999, 1.0] {
        let touches = [0, 1, 2, 3].map(|first: usize| Touch {
            bodies: [first, first + 1],
            angle: std::f64::consts::PI,
            moments: [0.0; 2],
            elasticity,
        });
        for law in [ImpactLaw::Hybrid, ImpactLaw::SerialSeparate] {
            let (after, _) = resolve(law, ImpactOrder::Fastest, &movers, &touches).expect("four rows");
            for (mover, expected) in after.iter().zip([0.0, 0.0, 0.0, 1.0, 1.0]) {
                let off = (mover.velocity[0] - expected).abs();
                assert!(off <= 2.0 * (1.0 - elasticity) + 1e-14, "{law:?}, {elasticity}: {after:?}");
            }
        }
    }
}

#[test]
fn a_row_that_opens_by_rounding_rests_in_a_simultaneous_impact() {
    // The first disc strikes the second, which touches a third: by the rounding of an active contact these two open, or
    // close, a little.
    let mover = |velocity: f64| Mover { inverse: [1.0, 1.0, 2.0], velocity: [velocity, 0.0, 0.0] };
    let touch = |bodies| Touch { bodies, angle: std::f64::consts::PI, moments: [0.0; 2], elasticity: 1.0 };
    let touches = [touch([0, 1]), touch([1, 2])];
    for apart in [0.0, 1e-13, 1e-11, 1e-9, -1e-9, 1e-7] {
        let movers = [mover(1.0), mover(0.0), mover(apart)];
        let mut impact = Impact::new();
        let rows = touches.map(|touch| CollisionRow { velocity_tol: 1e-3, ..touch.row(&movers) });
        impact.set_rows(rows);
        ImpactLaw::Simultaneous.resolve(&mut impact, ORDERS[0], 0).expect("two rows");
        let impulses = impact.impulses();
        let off = (impulses[0] - 4.0 / 3.0).abs().max((impulses[1] - 2.0 / 3.0).abs());
        assert!(off <= 2.0 * apart.abs() + ROUNDING, "{apart} m/s: {impulses:?}");
    }
}

/// The speed at which a mass comes back from a wall when a lighter mass, at rest between it and the wall, turns it
/// round blow by blow.
fn turned_round_by(light: f64) -> f64 {
    let (mut heavy_speed, mut light_speed) = (1.0, 0.0);
    while heavy_speed > light_speed || light_speed > 0.0 {
        if heavy_speed > light_speed {
            let together = (heavy_speed + light * light_speed) / (1.0 + light);
            (heavy_speed, light_speed) = (2.0 * together - heavy_speed, 2.0 * together - light_speed);
        } else {
            light_speed = -light_speed;
        }
    }
    heavy_speed
}

#[test]
fn light_bodies_before_a_wall_turn_a_heavy_one_round() {
    for (light, count) in [(1e-2, 1), (1e-4, 1), (1e-6, 1), (1e-8, 1), (1e-4, 3), (1e-6, 2)] {
        let mover = |mass: f64, speed: f64| Mover { inverse: [1.0 / mass; 3], velocity: [speed, 0.0, 0.0] };
        let wall = Mover { inverse: [0.0; 3], velocity: [0.0; 3] };
        let mut movers = vec![mover(1.0, 1.0)];
        movers.extend((0..count).map(|_| mover(light, 0.0)));
        movers.push(wall);
        let touch = |first| Touch {
            bodies: [first, first + 1],
            angle: std::f64::consts::PI,
            moments: [0.0; 2],
            elasticity: 1.0,
        };
        let touches: Vec<Touch> = (0..=count).map(touch).collect();
        for law in LAWS.into_iter().filter(|law| *law != ImpactLaw::Simultaneous) {
            let what = format!("{law:?}, {count} of {light:e} kg");
            let (after, _) = resolve(law, ImpactOrder::Fastest, &movers, &touches).expect("a line of bodies");
            let lost = energy(&after) - energy(&movers);
            assert!(lost.abs() < 1e-7, "{what}: {lost} J");
            let off = after[0].velocity[0] - turned_round_by(light);
            assert!(count > 1 || off.abs() < 1e-7, "{what}: off by {off} m/s");
        }
    }
}

#[test]
fn walls_that_all_but_face_each_other_turn_a_body_back() -> Result<(), ImpactError> {
    // The body goes into a wedge, and out again after pi blows for each radian of it, many of which are slow.
    for wedge in [0.3f64, 0.1, 0.05, 0.02] {
        let body = Mover { inverse: [1.0, 1.0, 0.0], velocity: [1.0, -0.3, 0.0] };
        let walls = Mover { inverse: [0.0; 3], velocity: [0.0; 3] };
        let normals = [std::f64::consts::FRAC_PI_2, -std::f64::consts::FRAC_PI_2 - wedge];
        let rows = normals.map(|angle| {
            let touch = Touch { bodies: [0, 1], angle, moments: [0.0; 2], elasticity: 1.0 };
            CollisionRow { velocity_tol: 1e-2 * wedge, ..touch.row(&[body, walls]) }
        });
        for law in LAWS {
            let mut impact = Impact::new();
            impact.set_rows(rows);
            law.resolve(&mut impact, ORDERS[0], 0)?;
            let parts = impact.rates().iter().zip(impact.rows()).zip(impact.impulses());
            let gained: f64 = parts.map(|((rate, row), impulse)| 0.5 * impulse * (rate + row.rate)).sum();
            let lost = gained / energy(&[body]);
            assert!(lost.abs() < 1e-6, "{law:?}, {wedge} rad: {lost} of the energy");
        }
    }
    Ok(())
}

#[test]
fn a_row_that_opens_is_not_held_by_force_in_a_simultaneous_impact() {
    // The impulse along the first normal turns round the second row, which opened before: stopping it there would do
    // work along a motion that opens, and add energy.
    let mover = |velocity| Mover { inverse: [1.0, 1.0, 2.0], velocity };
    let movers = [mover([0.2, -1.0, 0.0]), mover([0.0; 3])];
    let touch = |angle| Touch { bodies: [0, 1], angle, moments: [0.0; 2], elasticity: 1.0 };
    let touches = [touch(std::f64::consts::FRAC_PI_2), touch(-1.2)];
    assert!(touches[0].row(&movers).rate < -0.9 && touches[1].row(&movers).rate > 0.9);
    let (after, impact) =
        resolve(ImpactLaw::Simultaneous, ImpactOrder::Fastest, &movers, &touches).expect("two rows");
    assert!((energy(&after) - energy(&movers)).abs() < 1e-13);
    assert!(impact.rates().iter().all(|&rate| rate >= -1e-13), "{:?}", impact.rates());
}

#[test]
fn a_closing_row_that_moves_nothing_is_an_error() {
    let wall = |velocity| Mover { inverse: [0.0; 3], velocity };
    let movers = [wall([1.0, 0.0, 0.0]), wall([0.0; 3])];
    let touch = Touch { bodies: [0, 1], angle: std::f64::consts::PI, moments: [0.0; 2], elasticity: 1.0 };
    for law in LAWS {
        let error = resolve(law, ImpactOrder::Fastest, &movers, &[touch]).expect_err("nothing can move");
        assert_eq!(error, ImpactError::Immovable { row: 0, closing: 1.0 });
    }
    let opening = [wall([-1.0, 0.0, 0.0]), wall([0.0; 3])];
    assert!(resolve(ImpactLaw::Hybrid, ImpactOrder::Fastest, &opening, &[touch]).is_ok());
}
