//! Impacts with rows of three bodies, as gears on a carrier that moves.

use crate::laws::{LAWS, ORDERS};
use halfgap_collision::BodyId;
use halfgap_contact::{
    CollisionRow, CollisionThird, FrictionRow, Impact, ImpactLaw, ImpactOrder, InverseInertia, Restitution,
    RowKind,
};
use proptest::prelude::*;

const ROUNDING: f64 = 1e-12;

/// A body: its inertia and its velocities.
#[derive(Clone, Copy, Debug)]
struct Mover {
    inertia: InverseInertia,
    velocity: [f64; 3],
}

impl Mover {
    fn new(inverse_mass: f64, inverse_moment: f64, velocity: [f64; 3]) -> Self {
        Self { inertia: InverseInertia { inverse_mass, inverse_moment }, velocity }
    }

    fn energy(&self) -> f64 {
        let InverseInertia { inverse_mass, inverse_moment } = self.inertia;
        let inverse = [inverse_mass, inverse_mass, inverse_moment];
        let parts = self.velocity.iter().zip(inverse).filter(|&(_, inverse)| inverse > 0.0);
        parts.map(|(v, inverse)| 0.5 * v * v / inverse).sum()
    }
}

/// A row of two or three bodies: the coefficients of its sides, and the third body with its own.
#[derive(Clone, Copy, Debug)]
struct Tie {
    bodies: [usize; 2],
    jacobian: [f64; 6],
    third: Option<(usize, f64)>,
    elasticity: f64,
    bilateral: bool,
    friction: f64,
}

impl Tie {
    fn row(&self, movers: &[Mover]) -> CollisionRow {
        let id = |body: usize| BodyId(u32::try_from(body).expect("few bodies"));
        let of_two: f64 = (0..6).map(|k| self.jacobian[k] * movers[self.bodies[k / 3]].velocity[k % 3]).sum();
        let third = self.third.map(|(body, j)| CollisionThird::new(id(body), j, movers[body].inertia));
        let of_third = self.third.map_or(0.0, |(body, j)| j * movers[body].velocity[2]);
        let inertia = self.bodies.map(|body| movers[body].inertia);
        CollisionRow {
            third,
            elasticity: self.elasticity,
            velocity_tol: 1e-9,
            kind: RowKind::plain(self.bilateral),
            ..CollisionRow::new(self.bodies.map(id), self.jacobian, inertia, of_two + of_third)
        }
    }

    /// The slip of a contact, across its normal.
    fn slip(&self, movers: &[Mover]) -> FrictionRow {
        let [x, y, a, p, q, b] = self.jacobian;
        let jacobian = [-y, x, b, -q, p, a];
        let rate = (0..6).map(|k| jacobian[k] * movers[self.bodies[k / 3]].velocity[k % 3]).sum();
        FrictionRow::new(jacobian, self.bodies.map(|body| movers[body].inertia), rate, self.friction)
    }
}

fn impact_of(movers: &[Mover], ties: &[Tie]) -> Impact {
    let mut impact = Impact::new();
    impact.set_rows(ties.iter().map(|tie| tie.row(movers)));
    for (row, tie) in ties.iter().enumerate().filter(|(_, tie)| tie.friction > 0.0) {
        impact.set_friction(row, tie.slip(movers));
    }
    impact.set_restitution(Restitution::Poisson);
    impact
}

/// The bodies after the impulses.
fn after(movers: &[Mover], ties: &[Tie], impact: &Impact) -> Vec<Mover> {
    let mut after = movers.to_vec();
    for (index, (row, tie)) in impact.rows().iter().zip(ties).enumerate() {
        let impulse = impact.impulses()[index];
        let slip = tie.slip(movers);
        for k in 0..6 {
            let along = slip.response[k] * impact.friction_impulse(index);
            after[tie.bodies[k / 3]].velocity[k % 3] += row.response[k] * impulse + along;
        }
        if let (Some((body, _)), Some(third)) = (tie.third, row.third) {
            after[body].velocity[2] += third.response * impulse;
        }
    }
    after
}

fn energy(movers: &[Mover]) -> f64 {
    movers.iter().map(Mover::energy).sum()
}

/// A planetary gear on its carrier, all bodies but the planet turning about fixed points, and a disc that comes against the carrier.
fn planetary(disc_mass: f64, friction: f64) -> (Vec<Mover>, Vec<Tie>) {
    let movers = vec![
        Mover::new(0.0, 3.0, [0.0; 3]),
        Mover::new(2.0, 5.0, [0.0; 3]),
        Mover::new(0.0, 0.5, [0.0; 3]),
        Mover::new(1.0 / disc_mass, 0.0, [0.0, -1.0, 0.0]),
        Mover::new(0.0, 0.0, [0.0; 3]),
    ];
    let tie = Tie {
        bodies: [0, 1],
        jacobian: [0.0; 6],
        third: None,
        elasticity: 0.0,
        bilateral: true,
        friction: 0.0,
    };
    let gear = |bodies, ratio: f64| Tie {
        bodies,
        jacobian: [0.0, 0.0, 1.0, 0.0, 0.0, -ratio],
        third: Some((2, ratio - 1.0)),
        ..tie
    };
    let pin = |jacobian| Tie { bodies: [1, 2], jacobian, ..tie };
    let blow = Tie {
        bodies: [3, 2],
        jacobian: [0.0, 1.0, 0.0, 0.0, -1.0, -0.3],
        elasticity: 1.0,
        bilateral: false,
        friction,
        ..tie
    };
    let pins = [pin([1.0, 0.0, 0.0, -1.0, 0.0, 0.0]), pin([0.0, 1.0, 0.0, 0.0, -1.0, -0.36])];
    (movers, vec![gear([0, 1], -0.8), gear([1, 4], 3.25), pins[0], pins[1], blow])
}

#[test]
fn an_elastic_blow_on_the_carrier_meets_the_inertia_of_the_whole_gear() {
    // The sun turns 3.6 times as fast as the carrier, the planet -2.25 times.
    let inertia = 1.0 / 0.5 + 0.36 * 0.36 / 2.0 + 2.25 * 2.25 / 5.0 + 3.6 * 3.6 / 3.0;
    for friction in [0.0, 0.2] {
        let (movers, ties) = planetary(1.5, friction);
        for law in LAWS {
            // Rows one at a time, connectors apart, find it as the limit of a ricochet.
            if law == ImpactLaw::SerialSeparate || law == ImpactLaw::SerialSeparateLastpass {
                continue;
            }
            let mut impact = impact_of(&movers, &ties);
            law.resolve(&mut impact, ImpactOrder::Fastest, 0).expect("an answer");
            let now = after(&movers, &ties, &impact);
            let impulse = 2.0 / (1.0 / 1.5 + 0.3 * 0.3 / inertia);
            let carrier = -0.3 * impulse / inertia;
            let turns = [3.6, -2.25, 1.0].map(|share| share * carrier);
            for (mover, turn) in now.iter().zip(turns) {
                assert!((mover.velocity[2] - turn).abs() < 1e-14, "{law:?}: {now:?}");
            }
            assert!((energy(&now) - energy(&movers)).abs() < 1e-14, "{law:?}: {now:?}");
        }
    }
}

#[test]
fn a_gear_given_twice_or_nearly_so_changes_nothing() {
    let (movers, ties) = planetary(1.5, 0.0);
    let mut once = impact_of(&movers, &ties);
    ImpactLaw::Simultaneous.resolve(&mut once, ImpactOrder::Fastest, 0).expect("an answer");
    let expected = after(&movers, &ties, &once);
    for off in [0.0, 1e-9, 1e-7] {
        let (_, mut twice) = planetary(1.5, 0.0);
        let (body, j) = ties[0].third.expect("a gear on a carrier");
        twice.push(Tie { third: Some((body, j + off)), ..ties[0] });
        let mut impact = impact_of(&movers, &twice);
        ImpactLaw::Simultaneous.resolve(&mut impact, ImpactOrder::Fastest, 0).expect("an answer");
        let now = after(&movers, &twice, &impact);
        let rates = twice.iter().map(|tie| tie.row(&now).rate);
        assert!(off > 0.0 || rates.clone().take(2).all(|rate| rate.abs() < 1e-13));
        assert!(energy(&now) <= energy(&movers) + ROUNDING);
        for (p, q) in now.iter().zip(&expected) {
            assert!(off > 0.0 || (p.velocity[2] - q.velocity[2]).abs() < 1e-12, "{now:?}");
        }
    }
}

fn any_mover() -> impl Strategy<Value = Mover> {
    (0.3..3.0f64, 0.3..3.0f64, prop::array::uniform3(-1.0..1.0f64)).prop_map(
        |(inverse_mass, inverse_moment, velocity)| Mover::new(inverse_mass, inverse_moment, velocity),
    )
}

/// Up to four contacts and four connectors among five bodies, most of these with a third side.
fn any_impact(friction: f64) -> impl Strategy<Value = (Vec<Mover>, Vec<Tie>)> {
    let bodies = Just((0..5usize).collect::<Vec<_>>()).prop_shuffle();
    let tie =
        (bodies, -3.2..3.2f64, prop::array::uniform3(-1.0..1.0f64), 0..4, prop::array::uniform2(0.0..1.0f64));
    let tie = tie.prop_map(move |(bodies, angle, [a, b, c], kind, [elasticity, share])| {
        let (sin, cos) = angle.sin_cos();
        let bilateral = kind > 1;
        Tie {
            bodies: [bodies[0], bodies[1]],
            jacobian: [cos, sin, a, -cos, -sin, b],
            third: bilateral.then_some((bodies[2], c)).filter(|_| kind == 3),
            elasticity: if bilateral { 0.0 } else { elasticity },
            bilateral,
            friction: if bilateral { 0.0 } else { share * friction },
        }
    });
    (prop::collection::vec(any_mover(), 5), prop::collection::vec(tie, 1..9))
}

/// Energy does not grow, rows that hold are at rest, and no contact closes or pulls.
fn check(movers: &[Mover], ties: &[Tie], impact: &Impact, what: &str) -> Result<(), TestCaseError> {
    let now = after(movers, ties, impact);
    let largest = impact.impulses().iter().fold(1.0f64, |most, j| most.max(j.abs()));
    let (was, is) = (energy(movers), energy(&now));
    prop_assert!(is <= was + ROUNDING * largest * largest, "{}: energy {} becomes {}", what, was, is);
    for (k, tie) in ties.iter().enumerate() {
        let (rate, rounding) = (tie.row(&now).rate, ROUNDING * largest);
        prop_assert!((rate - impact.rates()[k]).abs() <= 10.0 * rounding, "{}: rate of row {}", what, k);
        let violation = if tie.bilateral { rate.abs() } else { -rate };
        prop_assert!(violation <= impact.bound() + 10.0 * rounding, "{}: row {} at {}", what, k, rate);
        prop_assert!(tie.bilateral || impact.impulses()[k] >= 0.0, "{}: row {} pulls", what, k);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn rows_of_three_bodies_keep_what_laws_promise((movers, ties) in any_impact(0.0)) {
        for law in LAWS {
            for order in ORDERS {
                let mut impact = impact_of(&movers, &ties);
                law.resolve(&mut impact, order, 3).expect("rest is admissible");
                check(&movers, &ties, &impact, &format!("{law:?} {order:?}"))?;
            }
        }
        let mut impact = impact_of(&movers, &ties);
        impact.resolve_inelastic().expect("rest is admissible");
        check(&movers, &ties, &impact, "inelastic")?;
    }

    #[test]
    fn rows_of_three_bodies_keep_rates_with_friction((movers, ties) in any_impact(0.5)) {
        // Bodies begin as connectors let them.
        let tied: Vec<Tie> = ties.iter().copied().filter(|tie| tie.bilateral).collect();
        let mut settling = impact_of(&movers, &tied);
        settling.resolve_inelastic().expect("rest is admissible");
        let movers = after(&movers, &tied, &settling);
        let mut impact = impact_of(&movers, &ties);
        if ImpactLaw::SerialGrouped.resolve(&mut impact, ImpactOrder::Fastest, 3).is_ok() {
            check(&movers, &ties, &impact, "grouped")?;
        }
    }
}
