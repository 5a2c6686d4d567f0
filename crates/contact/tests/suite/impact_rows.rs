//! Impacts of many rows, with connectors and with the background.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::laws::{LAWS, ORDERS};
use halfgap_collision::BodyId;
use halfgap_contact::{CollisionRow, Impact, ImpactError, ImpactLaw, ImpactOrder, InverseInertia, RowKind};
use proptest::prelude::*;

/// Rounding of sums of some products of numbers near 1.
const ROUNDING: f64 = 1e-12;
/// The body of the test that stands for the background.
const WORLD: usize = usize::MAX;

/// A body of the test: its inertia and its velocities.
#[derive(Clone, Copy, Debug)]
struct Mover {
    inertia: InverseInertia,
    velocity: [f64; 3],
}

impl Mover {
    fn new(mass: f64, moment: f64, velocity: [f64; 3]) -> Self {
        Self { inertia: InverseInertia { inverse_mass: 1.0 / mass, inverse_moment: 1.0 / moment }, velocity }
    }

    fn fixed(velocity: [f64; 3]) -> Self {
        Self { inertia: InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 }, velocity }
    }

    fn energy(&self) -> f64 {
        let InverseInertia { inverse_mass, inverse_moment } = self.inertia;
        let inverse = [inverse_mass, inverse_mass, inverse_moment];
        let parts = self.velocity.iter().zip(inverse).filter(|&(_, inverse)| inverse > 0.0);
        parts.map(|(v, inverse)| 0.5 * v * v / inverse).sum()
    }
}

/// A row: bodies, direction of the normal, its arms about both centres of mass.
#[derive(Clone, Copy, Debug)]
struct Tie {
    bodies: [usize; 2],
    angle: f64,
    moments: [f64; 2],
    elasticity: f64,
    bilateral: bool,
}

impl Tie {
    fn contact(bodies: [usize; 2], angle: f64, moments: [f64; 2], elasticity: f64) -> Self {
        Self { bodies, angle, moments, elasticity, bilateral: false }
    }

    /// Two rows that pin body to body at arms (x, y) from their centres of mass.
    fn pin(bodies: [usize; 2], arms: [[f64; 2]; 2]) -> [Self; 2] {
        [0.0, FRAC_PI_2].map(|angle: f64| {
            let moments = arms.map(|[x, y]| x * angle.sin() - y * angle.cos());
            Self { bodies, angle, moments, elasticity: 0.0, bilateral: true }
        })
    }

    fn row(&self, movers: &[Mover]) -> CollisionRow {
        let (sin, cos) = self.angle.sin_cos();
        let jacobian = [cos, sin, self.moments[0], -cos, -sin, -self.moments[1]];
        let rest = Mover::fixed([0.0; 3]);
        let sides = self.bodies.map(|body| *movers.get(body).unwrap_or(&rest));
        let rate = (0..6).map(|k| jacobian[k] * sides[k / 3].velocity[k % 3]).sum();
        let ids = self.bodies.map(|body| if body == WORLD { BodyId::WORLD } else { BodyId(body as u32) });
        let inertia = sides.map(|side| side.inertia);
        CollisionRow {
            elasticity: self.elasticity,
            velocity_tol: 1e-9,
            kind: RowKind::plain(self.bilateral),
            ..CollisionRow::new(ids, jacobian, inertia, rate)
        }
    }
}

fn energy(movers: &[Mover]) -> f64 {
    movers.iter().map(Mover::energy).sum()
}

fn impact_of(movers: &[Mover], ties: &[Tie]) -> Impact {
    let mut impact = Impact::new();
    impact.set_rows(ties.iter().map(|tie| tie.row(movers)));
    impact
}

/// The bodies after the impulses.
fn after(movers: &[Mover], impact: &Impact) -> Vec<Mover> {
    let mut after = movers.to_vec();
    for (row, &impulse) in impact.rows().iter().zip(impact.impulses()) {
        for k in 0..6 {
            if let Some(mover) = after.get_mut(row.bodies[k / 3].index()) {
                mover.velocity[k % 3] += row.response[k] * impulse;
            }
        }
    }
    after
}

fn resolve(law: ImpactLaw, movers: &[Mover], ties: &[Tie]) -> (Vec<Mover>, Impact) {
    let mut impact = impact_of(movers, ties);
    law.resolve(&mut impact, ImpactOrder::Fastest, 3).expect("an impact that can be resolved");
    (after(movers, &impact), impact)
}

fn largest_impulse(impact: &Impact) -> f64 {
    impact.impulses().iter().fold(1.0f64, |most, j| most.max(j.abs()))
}

fn any_mover() -> impl Strategy<Value = Mover> {
    (0.3..3.0f64, 0.3..3.0f64, prop::array::uniform3(-1.0..1.0f64), 0..5).prop_map(
        |(mass, moment, velocity, kind)| match kind {
            0 => Mover::fixed([0.0; 3]),
            _ => Mover::new(mass, moment, velocity),
        },
    )
}

fn any_tie(bodies: usize) -> impl Strategy<Value = Tie> {
    let elasticity = prop_oneof![Just(0.0), Just(1.0), 0.0..1.0f64];
    let moments = prop::array::uniform2(-1.0..1.0f64);
    (0..bodies, 1..=bodies, -3.2..3.2f64, moments, elasticity, 0..4).prop_map(
        move |(first, step, angle, moments, elasticity, kind)| {
            let second = (first + step) % (bodies + 1);
            let second = if second == bodies { WORLD } else { second };
            Tie { bodies: [first, second], angle, moments, elasticity, bilateral: kind == 0 }
        },
    )
}

/// Up to six bodies, some fixed, and up to twelve rows, each perhaps twice.
fn any_impact() -> impl Strategy<Value = (Vec<Mover>, Vec<Tie>)> {
    (2..=6usize, 1..=12usize).prop_flat_map(|(bodies, rows)| {
        let movers = prop::collection::vec(any_mover(), bodies);
        let ties = prop::collection::vec((any_tie(bodies), 0..4), rows);
        (movers, ties).prop_map(|(movers, ties)| {
            let twice = |(tie, copies)| std::iter::repeat_n(tie, if copies == 0 { 2 } else { 1 });
            let moves = |tie: &Tie| tie.row(&movers).coupling(&tie.row(&movers)) > 1e-6;
            let ties = ties.into_iter().flat_map(twice).filter(moves).collect();
            (movers, ties)
        })
    })
}

/// Checks the promises of every resolved impact.
fn check(movers: &[Mover], ties: &[Tie], impact: &Impact, what: &str) -> Result<(), TestCaseError> {
    let now = after(movers, impact);
    let largest = largest_impulse(impact);
    let (was, is) = (energy(movers), energy(&now));
    prop_assert!(is <= was + ROUNDING * largest * largest, "{}: energy {} becomes {}", what, was, is);
    let fastest = impact.rows().iter().fold(0.0f64, |most, row| most.max(row.rate.abs()));
    prop_assert!(impact.bound() <= 1e-5 * fastest + ROUNDING * largest, "{}: bound {}", what, impact.bound());
    for (k, tie) in ties.iter().enumerate() {
        let rate = tie.row(&now).rate;
        let rounding = ROUNDING * largest;
        prop_assert!((rate - impact.rates()[k]).abs() <= rounding, "{}: rate of row {}", what, k);
        if tie.bilateral {
            prop_assert!(rate.abs() <= impact.bound() + rounding, "{}: row {} moves at {}", what, k, rate);
        } else {
            prop_assert!(impact.impulses()[k] >= 0.0, "{}: row {} pulls", what, k);
            prop_assert!(rate >= -impact.bound() - rounding, "{}: row {} closes at {}", what, k, rate);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_law_loses_energy_and_leaves_no_row_violated((movers, ties) in any_impact()) {
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
    fn doubled_rows_change_no_motion((movers, ties) in any_impact()) {
        let twice: Vec<Tie> = ties.iter().flat_map(|&tie| [tie, tie]).collect();
        for law in [ImpactLaw::Simultaneous, ImpactLaw::Hybrid] {
            let (once, impact) = resolve(law, &movers, &ties);
            let (doubled, _) = resolve(law, &movers, &twice);
            // Ricochets enlarge rounding, and the number of rows decides where they are broken off.
            if impact.solves() > 20 {
                continue;
            }
            let scale = largest_impulse(&impact);
            for (p, q) in once.iter().zip(&doubled) {
                for k in 0..3 {
                    prop_assert!((p.velocity[k] - q.velocity[k]).abs() <= 1e-9 * scale * scale, "{:?}", law);
                }
            }
        }
    }

    #[test]
    fn the_order_of_rows_changes_no_simultaneous_impact((movers, ties) in any_impact()) {
        let (difference, allowed) = difference_by_order(&movers, &ties);
        prop_assert!(
            difference <= allowed || difference <= 4.0 * sensitivity(&movers, &ties),
            "speeds differ by {}, {} allowed", difference, allowed
        );
    }
}

fn reversed(ties: &[Tie]) -> Vec<Tie> {
    ties.iter().rev().copied().collect()
}

/// Largest difference between the velocities of the same bodies.
fn difference(these: &[Mover], those: &[Mover]) -> f64 {
    let pairs = these.iter().zip(those).flat_map(|(p, q)| p.velocity.into_iter().zip(q.velocity));
    pairs.fold(0.0, |most, (p, q)| most.max((p - q).abs()))
}

/// Dependence of the motion after a simultaneous impact on the order of its rows, and the dependence allowed.
fn difference_by_order(movers: &[Mover], ties: &[Tie]) -> (f64, f64) {
    let (forth, impact) = resolve(ImpactLaw::Simultaneous, movers, ties);
    let (back, _) = resolve(ImpactLaw::Simultaneous, movers, &reversed(ties));
    let scale = largest_impulse(&impact);
    (difference(&forth, &back), 1e-9 * scale * scale)
}

/// Change of the motion after a simultaneous impact when speeds change by a few roundings.
///
/// Ricochets enlarge rounding, and a row that an earlier round left at rest may open by rounding in a later one: then
/// the next round leaves it out, which is another motion. The order of rows may decide all that rounding may decide.
fn sensitivity(movers: &[Mover], ties: &[Tie]) -> f64 {
    let (as_given, _) = resolve(ImpactLaw::Simultaneous, movers, ties);
    let varied = |variant: usize| {
        let mut varied = movers.to_vec();
        for (k, velocity) in varied.iter_mut().flat_map(|mover| &mut mover.velocity).enumerate() {
            let roundings = ((k * 5 + variant * 3) % 7) as f64 - 3.0;
            *velocity *= 1.0 + roundings * f64::EPSILON;
        }
        varied
    };
    let change = |variant| difference(&as_given, &resolve(ImpactLaw::Simultaneous, &varied(variant), ties).0);
    (0..21).map(change).fold(0.0, f64::max)
}

fn row_of_discs(count: usize, elasticity: f64, walls: bool) -> (Vec<Mover>, Vec<Tie>) {
    let mut movers = vec![Mover::new(1.0, 0.5, [0.0; 3]); count];
    movers[0].velocity[0] = 1.0;
    let mut ties: Vec<Tie> = (1..count).map(|k| Tie::contact([k - 1, k], PI, [0.0; 2], elasticity)).collect();
    if walls {
        ties.push(Tie::contact([count - 1, WORLD], PI, [0.0; 2], elasticity));
        ties.push(Tie::contact([0, WORLD], 0.0, [0.0; 2], elasticity));
    }
    (movers, ties)
}

#[test]
fn three_rows_at_once_stop_a_disc_in_a_ring() {
    let movers: Vec<Mover> = std::iter::once([0.0; 3])
        .chain([30.0f64, 150.0, 270.0].map(|angle| {
            let (sin, cos) = angle.to_radians().sin_cos();
            [-cos, -sin, 0.0]
        }))
        .map(|velocity| Mover::new(1.0, 0.5, velocity))
        .collect();
    let ties: Vec<Tie> = [30.0f64, 150.0, 270.0]
        .iter()
        .enumerate()
        .map(|(k, angle)| Tie::contact([0, k + 1], angle.to_radians() + PI, [0.0; 2], 1.0))
        .collect();
    for law in [ImpactLaw::Simultaneous, ImpactLaw::Hybrid] {
        let (now, impact) = resolve(law, &movers, &ties);
        assert_eq!(impact.solves(), 1);
        assert!(now[0].velocity.iter().all(|v| v.abs() < 1e-14), "the middle one moves: {:?}", now[0]);
        for (was, is) in movers[1..].iter().zip(&now[1..]) {
            assert!((0..2).all(|k| (was.velocity[k] + is.velocity[k]).abs() < 1e-14), "{was:?} {is:?}");
        }
    }
}

#[test]
fn a_block_landing_flat_on_many_points_keeps_level() {
    let movers = [Mover::new(2.0, 0.4, [0.3, -1.0, 0.0])];
    for count in [3, 5, 40] {
        for elasticity in [0.0, 0.5, 1.0] {
            let arms = (0..count).map(|k| k as f64 / (count - 1) as f64 - 0.5);
            let ties: Vec<Tie> =
                arms.map(|arm| Tie::contact([0, WORLD], FRAC_PI_2, [arm, arm], elasticity)).collect();
            for law in [ImpactLaw::Simultaneous, ImpactLaw::Hybrid] {
                let (now, _) = resolve(law, &movers, &ties);
                let expected = [0.3, elasticity, 0.0];
                assert!((0..3).all(|k| (now[0].velocity[k] - expected[k]).abs() < 1e-13), "{:?}", now[0]);
            }
        }
    }
}

#[test]
fn an_impulse_travels_along_a_row_of_discs_in_every_serial_law() {
    let (movers, ties) = row_of_discs(21, 1.0, false);
    for law in [ImpactLaw::Hybrid, ImpactLaw::SerialSeparate, ImpactLaw::SerialGrouped] {
        let (now, impact) = resolve(law, &movers, &ties);
        assert_eq!(impact.solves(), 20);
        assert!((now[20].velocity[0] - 1.0).abs() < 1e-13);
        assert!(now[..20].iter().all(|mover| mover.velocity[0].abs() < 1e-13));
    }
}

#[test]
fn elastic_discs_in_a_tight_box_come_to_an_end() {
    for count in [2, 20] {
        let (movers, ties) = row_of_discs(count, 1.0, true);
        for law in LAWS {
            let (now, impact) = resolve(law, &movers, &ties);
            // Few contacts may take two hundred blows a row before slow rows stop to count.
            let first_stage = if ties.len() <= 4 { 200 } else { 20 };
            let most = (first_stage + 11 * 20) * ties.len() as u64 + 10;
            assert!(impact.solves() <= most, "{law:?}: {} solves of {count} discs", impact.solves());
            assert!(energy(&now) <= energy(&movers) + 1e-12);
        }
    }
}

/// A chain of rods of length 1 along x, the first pinned to the background, with an inward kick at its end.
fn pinned_chain(links: usize) -> (Vec<Mover>, Vec<Tie>) {
    let movers = vec![Mover::new(1.0, 1.0 / 12.0, [0.0; 3]); links];
    let ties = (0..links)
        .flat_map(|k| {
            let before = if k == 0 { WORLD } else { k - 1 };
            let arm = if k == 0 { [0.0, 0.0] } else { [0.5, 0.0] };
            Tie::pin([k, before], [[-0.5, 0.0], arm])
        })
        .collect();
    (movers, ties)
}

#[test]
fn joints_pass_an_impact_on_and_keep_its_energy() {
    // A hanging chain at rest is struck at its end by a ball, across.
    for links in [1, 2, 20] {
        let (mut movers, mut ties) = pinned_chain(links);
        movers.push(Mover::new(0.5, 0.1, [0.0, -1.0, 0.0]));
        ties.push(Tie::contact([links, links - 1], FRAC_PI_2, [0.0, 0.5], 1.0));
        for law in [ImpactLaw::Simultaneous, ImpactLaw::Hybrid, ImpactLaw::SerialGrouped] {
            let (now, impact) = resolve(law, &movers, &ties);
            assert!((energy(&now) - energy(&movers)).abs() < 1e-13, "{law:?}: {}", energy(&now));
            let contact = impact.rows().len() - 1;
            assert!((impact.rates()[contact] - 1.0).abs() < 1e-13);
            for tie in &ties[..contact] {
                assert!(tie.row(&now).rate.abs() < 1e-13, "{law:?}: a joint moves");
            }
        }
        let (now, impact) = resolve(ImpactLaw::SerialSeparate, &movers, &ties);
        assert!(ties[..2 * links].iter().all(|tie| tie.row(&now).rate.abs() <= impact.bound() + 1e-13));
    }
}

#[test]
fn joints_that_do_not_fit_are_drawn_together_without_adding_energy() {
    // The first link turns, the second rests: their joint moves, and the end closes on a wall that is elastic.
    let (mut movers, mut ties) = pinned_chain(2);
    movers[0].velocity = [0.0, 0.5, 1.0];
    movers[1].velocity = [0.0, -1.0, 0.3];
    ties.push(Tie::contact([1, WORLD], FRAC_PI_2, [0.5, 0.0], 1.0));
    for elasticity in [0.0, 1.0] {
        ties.iter_mut().for_each(|tie| tie.elasticity = elasticity);
        for law in LAWS {
            let mut impact = impact_of(&movers, &ties);
            law.resolve(&mut impact, ImpactOrder::Fastest, 0).expect("rest is admissible");
            check(&movers, &ties, &impact, &format!("{law:?}")).expect("what every impact owes");
        }
    }
}

#[test]
fn a_disc_between_closing_jaws_is_infeasible() {
    let jaw = |speed| Mover::fixed([speed, 0.0, 0.0]);
    let movers = [Mover::new(1.0, 0.5, [0.0; 3]), jaw(1.0), jaw(-1.0)];
    let ties = [Tie::contact([0, 1], 0.0, [0.0; 2], 1.0), Tie::contact([0, 2], PI, [0.0; 2], 1.0)];
    for law in LAWS {
        let mut impact = impact_of(&movers, &ties);
        let error = law.resolve(&mut impact, ImpactOrder::Fastest, 0).expect_err("it is crushed");
        let ImpactError::Infeasible { row, contradiction } = error else { panic!("{law:?}: {error}") };
        assert!(row < 2 && contradiction > 0.1, "{law:?}: row {row}, {contradiction} m/s");
    }
    let mut impact = impact_of(&movers, &ties);
    let error = impact.resolve_inelastic().expect_err("it is crushed");
    assert!(matches!(error, ImpactError::Infeasible { .. }), "{error}");
}

#[test]
fn a_weak_impact_does_not_mind_rates_of_rounding_in_doubled_joints() {
    // The joint is given twice, and its rates differ by the rounding of the bodies' speeds, which is large beside the
    // impact.
    let (mut movers, mut ties) = pinned_chain(1);
    ties.extend_from_within(..);
    movers.push(Mover::new(0.5, 0.1, [0.0, -1e-10, 0.0]));
    ties.push(Tie::contact([1, 0], FRAC_PI_2, [0.0, 0.5], 1.0));
    let mut rows: Vec<CollisionRow> = ties.iter().map(|tie| tie.row(&movers)).collect();
    for (row, rounding) in rows.iter_mut().zip([1e-16, -2e-16, -1e-16, 1.5e-16]) {
        row.rate += rounding;
    }
    for law in LAWS {
        let mut impact = Impact::new();
        impact.set_rows(rows.iter().copied());
        law.resolve(&mut impact, ImpactOrder::Fastest, 0).expect("the joints agree but for rounding");
        assert!(impact.bound() < 1e-15, "{law:?}: {}", impact.bound());
        assert!(impact.rates()[4] >= 0.0 - impact.bound());
    }
}

#[test]
fn without_elasticity_everything_comes_to_rest_at_once() {
    let (movers, ties) = row_of_discs(20, 1.0, true);
    let mut impact = impact_of(&movers, &ties);
    impact.resolve_inelastic().expect("rest is admissible");
    assert!(after(&movers, &impact).iter().all(|mover| mover.velocity[0].abs() < 1e-13));
    assert!(impact.solves() <= 2, "{} solves", impact.solves());
}

#[test]
fn the_background_is_shared_by_no_rows() {
    let movers = [Mover::new(1.0, 0.5, [0.0, -1.0, 0.0]), Mover::new(1.0, 0.5, [0.0, -2.0, 0.0])];
    let rows = [0, 1].map(|body| Tie::contact([body, WORLD], FRAC_PI_2, [0.0; 2], 1.0).row(&movers));
    assert_eq!(rows[0].coupling(&rows[1]), 0.0);
    assert_eq!(rows[0].coupling(&rows[0]), 1.0);
}

fn tie(bodies: [usize; 2], angle: f64, moments: [f64; 2], elasticity: f64, bilateral: bool) -> Tie {
    Tie { bodies, angle, moments, elasticity, bilateral }
}

fn mover_of(inverse_mass: f64, inverse_moment: f64, velocity: [f64; 3]) -> Mover {
    Mover { inertia: InverseInertia { inverse_mass, inverse_moment }, velocity }
}

#[test]
fn which_of_four_connectors_of_one_body_are_independent_does_not_show() {
    // Three of the four connectors hold the body; some three of them hold it badly, and magnify the rounding that is
    // left of the fourth.
    let movers = [
        mover_of(1.0007670227180745, 3.3333333333333335, [0.6514338096216623, 0.0, 0.0]),
        Mover::fixed([0.0; 3]),
        mover_of(0.6525856843542307, 0.5034361718141036, [0.0, 0.53879329423446, 0.0]),
    ];
    let once = [
        tie([0, 1], 0.0, [0.0, 0.0], 0.0, false),
        tie([0, 2], 3.0176258530528237, [0.0, -0.9618792360727745], 0.0, false),
        tie([2, 1], -1.7101940030013938, [-0.2765465693573402, 0.0], 0.0, true),
        tie([2, 1], -1.9985362460097595, [0.0, 0.0], 1.0, false),
        tie([1, 2], 2.9923638326742905, [0.0, 0.7825371243026156], 0.0, true),
        tie([2, WORLD], -3.004724154428924, [0.7072593263848038, 0.0], 0.0, true),
        tie([1, 0], 0.0, [0.0, -0.2979929408741181], 0.0, true),
        tie([2, 1], 1.0557504242128442, [-0.905557674438499, 0.0], 0.0, true),
    ];
    let ties: Vec<Tie> = once.into_iter().flat_map(|tie| [tie, tie]).collect();
    let (difference, _) = difference_by_order(&movers, &ties);
    assert!(difference < 1e-12, "{difference}");
    let (_, impact) = resolve(ImpactLaw::Simultaneous, &movers, &ties);
    assert!(impact.solves() <= 2, "{} solves", impact.solves());
}

#[test]
fn connectors_that_nearly_depend_on_each_other_have_modest_impulses() {
    // The three connectors of the second body depend on each other but for 1e-6, and all contacts work against them.
    let movers = [
        mover_of(
            0.7149984689577534,
            0.3531101210289318,
            [-0.08881969859850015, -0.4975416733522855, -0.7399501753470457],
        ),
        mover_of(1.0343908311578132, 0.6436807219051828, [-0.5038051740265443, 0.0, -0.21599106749031474]),
    ];
    let ties = [
        tie([0, 1], -0.7865153697149554, [0.34432814260406275, -0.10457921678829821], 0.0, true),
        tie([0, 1], -0.7865153697149554, [0.34432814260406275, -0.10457921678829821], 0.0, true),
        tie([1, WORLD], 3.151910392268887, [0.39609074773566033, 0.0], 1.0, false),
        tie([1, WORLD], 3.151910392268887, [0.39609074773566033, 0.0], 1.0, false),
        tie([1, WORLD], -0.8558171187543877, [0.16989834385893568, 0.0], 0.0, true),
        tie([1, WORLD], -3.1933105770559562, [0.4843724932055978, 0.0], 0.0, true),
        tie([1, WORLD], -3.1933105770559562, [0.4843724932055978, 0.0], 0.0, true),
        tie([0, 1], 0.0, [-0.5413488812503479, 0.9908807471889515], 1.0, false),
        tie([0, 1], 0.0, [-0.5413488812503479, 0.9908807471889515], 1.0, false),
        tie([1, 0], 0.29085218105853894, [0.05338875587622466, 0.010356381498869638], 1.0, false),
        tie([1, 0], 0.29085218105853894, [0.05338875587622466, 0.010356381498869638], 1.0, false),
        tie([1, WORLD], 0.94962360086483, [-0.8683773226620571, 0.0], 0.0, true),
        tie([0, 1], -1.018670599410737, [0.8425737979145524, 0.0], 1.0, false),
        tie([1, WORLD], 1.0104483568356868, [0.7500107692938491, 0.0], 1.0, false),
        tie([1, WORLD], 2.022626734886343, [-0.2923257456333828, 0.0], 0.0, false),
        tie([0, 1], -2.394476005728737, [0.0, 0.0], 0.0, false),
        tie([0, 1], -2.394476005728737, [0.0, 0.0], 0.0, false),
        tie([0, WORLD], 3.099548100366386, [-0.4311383915094525, 0.0], 0.0, true),
    ];
    let (difference, _) = difference_by_order(&movers, &ties);
    assert!(difference < 1e-9, "{difference}");
    let (_, impact) = resolve(ImpactLaw::Simultaneous, &movers, &ties);
    assert!(largest_impulse(&impact) < 1e6, "{}", largest_impulse(&impact));
}

#[test]
fn an_impulse_that_is_carried_comes_back_as_far_as_it_is_needed() -> Result<(), ImpactError> {
    let body = InverseInertia { inverse_mass: 0.5, inverse_moment: 0.0 };
    let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
    let jacobian = [0.0, 1.0, 0.0, 0.0, -1.0, 0.0];
    let row = CollisionRow {
        velocity_tol: 1e-3,
        ..CollisionRow::new([BodyId(0), BodyId::WORLD], jacobian, [body, fixed], 0.1)
    };
    let mut impact = Impact::new();
    // Two kilograms that rise at 0.1 m/s: an impulse of 0.2 N s stops them.
    for (carried, rate, impulse) in
        [(0.0, 0.1, 0.0), (0.05, 0.075, -0.05), (0.2, 0.0, -0.2), (3.0, 0.0, -0.2)]
    {
        impact.set_rows([row]);
        impact.unload(&[carried]);
        impact.resolve_inelastic()?;
        assert!((impact.rates()[0] - rate).abs() < 1e-15, "{carried}: {:?}", impact.rates());
        assert!((impact.impulses()[0] - impulse).abs() < 1e-15, "{carried}: {:?}", impact.impulses());
    }
    Ok(())
}

#[test]
fn a_point_that_slides_over_two_slopes_is_not_stopped_by_carried_impulses() -> Result<(), ImpactError> {
    // A point of 1 kg rises at 1 mm/s in a hollow of 1e-4 rad, along which it slides at 1 m/s.
    let body = InverseInertia { inverse_mass: 1.0, inverse_moment: 0.0 };
    let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
    let (angle, slide, rise): (f64, f64, f64) = (1e-4, 1.0, 1e-3);
    let side = |angle: f64, body_id: u32| {
        let normal = [-angle.sin(), angle.cos()];
        let jacobian = [normal[0], normal[1], 0.0, -normal[0], -normal[1], 0.0];
        let rate = normal[0] * slide + normal[1] * rise;
        CollisionRow {
            velocity_tol: 1e-3,
            ..CollisionRow::new([BodyId(0), BodyId(body_id)], jacobian, [body, fixed], rate)
        }
    };
    let rows = [side(angle, 1), side(-angle, 2)];
    let mut impact = Impact::new();
    impact.set_rows(rows);
    impact.unload(&[0.01, 0.01]);
    impact.try_inelastic()?;
    let change = |entry: usize| {
        rows.iter().zip(impact.impulses()).map(|(row, impulse)| row.response[entry] * impulse).sum::<f64>()
    };
    assert!(change(0).abs() < 2e-4, "slowed by {} m/s", change(0));
    // The point goes up the side that it comes to.
    assert!((rise + change(1) - angle * slide).abs() < 1e-7, "rises at {} m/s", rise + change(1));
    Ok(())
}
