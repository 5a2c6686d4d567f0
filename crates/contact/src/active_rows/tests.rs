//! Active rows against plain products.

use super::*;
use crate::problem::InverseInertia;
use proptest::prelude::*;

const INERTIA: InverseInertia = InverseInertia { inverse_mass: 0.8, inverse_moment: 3.0 };

/// What an independent row may leave of its acceleration [m/s^2], per newton of the largest force.
const HELD: f64 = 1e-11;
/// What a dependent row may leave of it [m/s^2], per newton of the largest force: rows whose remainder is up to the root of
/// the threshold count as dependent.
const FOLLOWS: f64 = 1e-4;
/// Rounding of a response [m/s^2, rad/s^2], per newton of the largest force.
const RESPONSE: f64 = 1e-12;
/// Rounding of accelerations [m/s^2, rad/s^2] of the order of gravity, under soft rows.
const ROUNDED: f64 = 1e-12;
/// Rounding of a response to gears [rad/s^2], of the order of 1.
const GEARED: f64 = 1e-14;
/// Rounding of what soft gears leave of an acceleration of 1 rad/s^2 [rad/s^2].
const SOFTLY_GEARED: f64 = 1e-13;
/// Rounding of a force of 1 N on a row by itself [N].
const ONE_FORCE: f64 = 1e-15;
/// Rounding of a force of 0 [N] beside forces of some newtons.
const NO_FORCE: f64 = 1e-12;
/// Difference [N] by which soft rows miss the sharing of forces of some newtons.
const SHARED: f64 = 1e-4;
/// The same of two rows that are one and the same [N].
const SHARED_BY_TWINS: f64 = 1e-6;
/// A disagreement of rows [m/s^2], and what it may move [m/s^2].
const DISAGREEMENT: f64 = 1e-9;
const MOVED_BY_DISAGREEMENT: f64 = 1e-8;
/// Inverse mass [1/kg] and inverse moment of inertia [1/(kg m^2)] of a body of 100 t.
const OF_HEAVY: f64 = 1e-5;
/// What forces of 4e5 N on a body of a gram may leave of an acceleration [m/s^2].
const LEFT_OF_LARGE: f64 = 1e-6;

/// M⁻¹ Jᵀ f and A f, computed the plain way.
fn accelerations(
    inertia: &[InverseInertia],
    rows: &[[Option<u32>; 2]],
    jacobians: &[[f64; 6]],
    force: &[f64],
) -> (Vec<[f64; 3]>, Vec<f64>) {
    accelerations_with_thirds(inertia, (rows, &[]), jacobians, force)
}

fn accelerations_with_thirds(
    inertia: &[InverseInertia],
    (rows, thirds): (&[[Option<u32>; 2]], &[ThirdSide]),
    jacobians: &[[f64; 6]],
    force: &[f64],
) -> (Vec<[f64; 3]>, Vec<f64>) {
    let mut change = vec![[0.0; 3]; inertia.len()];
    let entries = |row: usize| {
        let own = thirds.iter().filter(move |third| third.row as usize == row);
        let of_two = (0..6).filter_map(move |k| Some((rows[row][k / 3]? as usize, k % 3, jacobians[row][k])));
        of_two.chain(own.map(|third| (third.body as usize, 2, third.coefficient)))
    };
    for (row, push) in force.iter().enumerate() {
        for (body, k, coefficient) in entries(row) {
            let weight = if k < 2 { inertia[body].inverse_mass } else { inertia[body].inverse_moment };
            change[body][k] += weight * coefficient * push;
        }
    }
    let rate = |row| entries(row).map(|(body, k, coefficient)| coefficient * change[body][k]).sum();
    let rates = (0..rows.len()).map(rate).collect();
    (change, rates)
}

/// Solves and compares with the plain products. The offsets must be those of some motion, so that dependent rows
/// agree. Returns how many rows are dependent.
fn check(
    inertia: &[InverseInertia],
    rows: &[[Option<u32>; 2]],
    jacobians: &[[f64; 6]],
    offset: &[f64],
) -> usize {
    check_with_thirds(inertia, (rows, &[]), jacobians, offset)
}

fn check_with_thirds(
    inertia: &[InverseInertia],
    (rows, thirds): (&[[Option<u32>; 2]], &[ThirdSide]),
    jacobians: &[[f64; 6]],
    offset: &[f64],
) -> usize {
    let mut active = ActiveRows::default();
    active.set_structure_with_thirds(inertia, rows, thirds);
    let dependent = active.factorize(jacobians);
    let mut force = vec![f64::NAN; rows.len()];
    active.solve(offset, &mut force);
    let (expected, rates) = accelerations_with_thirds(inertia, (rows, thirds), jacobians, &force);
    let largest = force.iter().fold(1.0f64, |m, f| m.max(f.abs()));
    for row in 0..rows.len() {
        let rounding = if active.is_dependent(row) { FOLLOWS } else { HELD };
        let left = rates[row] + offset[row];
        assert!(left.abs() <= rounding * largest, "row {row} of {}: {left}, forces {largest}", rows.len());
        assert!(!active.is_dependent(row) || force[row] == 0.0);
    }
    assert_eq!((0..rows.len()).filter(|&row| active.is_dependent(row)).count(), dependent);
    let mut change = vec![[0.0; 3]; inertia.len()];
    active.respond(&force, &mut change);
    for (p, q) in change.iter().zip(&expected) {
        assert!((0..3).all(|k| (p[k] - q[k]).abs() <= RESPONSE * largest));
    }
    dependent
}

#[test]
fn soft_rows_hold_as_much_and_share_it() {
    // A body on two pins and, twice as far out, a third: three of the six rows depend on the others.
    let (sides, arms) = ([[Some(0), None]; 6], [-1.0, 1.0, 2.0]);
    let jacobians: Vec<[f64; 6]> = arms
        .into_iter()
        .flat_map(|arm| [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, arm, 0.0, 0.0, 0.0]])
        .collect();
    let gravity: Vec<f64> = jacobians.iter().map(|row| -10.0 * row[1]).collect();
    let mut active = ActiveRows::default();
    active.set_structure(&[INERTIA], &sides);
    assert_eq!(active.factorize(&jacobians), 3);
    active.soften(|_| true);
    assert_eq!(active.factorize(&jacobians), 0);
    let mut force = [f64::NAN; 6];
    active.solve(&gravity, &mut force);
    let (change, _) = accelerations(&[INERTIA], &sides, &jacobians, &force);
    assert!((change[0][1] - 10.0).abs() < ROUNDED && change[0][2].abs() < ROUNDED, "{change:?}");
    // The least forces, each weighed by its row's square, that carry 12.5 N without a torque: (p + q arm)/square.
    let square = |arm: f64| INERTIA.inverse_mass + INERTIA.inverse_moment * arm * arm;
    let sum = |power: i32| arms.iter().map(|&arm| arm.powi(power) / square(arm)).sum::<f64>();
    let p = 12.5 / (sum(0) - sum(1) * sum(1) / sum(2));
    let q = -p * sum(1) / sum(2);
    for (arm, force) in arms.into_iter().zip(force.chunks(2)) {
        let expected = (p + q * arm) / square(arm);
        assert!((force[1] - expected).abs() < SHARED && force[0].abs() < NO_FORCE, "{arm}: {force:?}");
    }
    // A disagreement of the rows moves nothing, and its forces stay bounded.
    let mut disagreeing = gravity.clone();
    disagreeing[1] += DISAGREEMENT;
    active.solve(&disagreeing, &mut force);
    let (change, _) = accelerations(&[INERTIA], &sides, &jacobians, &force);
    assert!((change[0][1] - 10.0).abs() < MOVED_BY_DISAGREEMENT, "{change:?}");
    assert!(force.iter().all(|force| force.abs() < 20.0), "{force:?}");
}

/// The offsets of the rows for given accelerations of the bodies.
fn offsets(rows: &[[Option<u32>; 2]], jacobians: &[[f64; 6]], motion: &[[f64; 3]]) -> Vec<f64> {
    let sum = |(sides, row): (&[Option<u32>; 2], &[f64; 6])| {
        (0..6).filter_map(|k| Some(row[k] * motion[sides[k / 3]? as usize][k % 3])).sum()
    };
    rows.iter().zip(jacobians).map(sum).collect()
}

/// Two rows that pin body to body at two arms.
fn pin(sides: [Option<u32>; 2], [p, q]: [[f64; 2]; 2]) -> ([[Option<u32>; 2]; 2], [[f64; 6]; 2]) {
    ([sides; 2], [[1.0, 0.0, -p[1], -1.0, 0.0, q[1]], [0.0, 1.0, p[0], 0.0, -1.0, -q[0]]])
}

#[test]
fn a_chain_has_a_narrow_factor_in_any_order() {
    let links = 20;
    let mut joints: Vec<_> =
        (0..links).map(|k: u32| pin([Some(k), k.checked_sub(1)], [[-0.5, 0.1], [0.5, -0.1]])).collect();
    joints.sort_by_key(|(rows, _)| rows[0][0].map(|body| body * 7 % 20));
    let rows: Vec<_> = joints.iter().flat_map(|joint| joint.0).collect();
    let jacobians: Vec<_> = joints.iter().flat_map(|joint| joint.1).collect();
    let inertia = vec![INERTIA; links as usize];
    let offset: Vec<f64> = (0..2 * links).map(|k| f64::from(k % 3) - 9.81).collect();
    assert_eq!(check(&inertia, &rows, &jacobians, &offset), 0);
    let mut active = ActiveRows::default();
    active.set_structure(&inertia, &rows);
    let entries: usize =
        (0..rows.len()).map(|place| active.factor.entries(place).filter(|entry| *entry != 0.0).count()).sum();
    assert!(entries <= 3 * rows.len(), "{entries} entries");
}

#[test]
fn the_third_contact_under_a_block_takes_no_force() {
    let corner = |arm| [0.0, 1.0, arm, 0.0, 0.0, 0.0];
    let jacobians = [corner(-0.5), corner(0.1), corner(0.5)];
    assert_eq!(check(&[INERTIA], &[[Some(0), None]; 3], &jacobians, &[-9.81; 3]), 1);
}

#[test]
fn rows_that_depend_on_no_others_are_as_stiff_as_before() {
    // A heavy body hangs from a light one, which a pin holds; beside them a body is pinned twice.
    let (light, heavy) = (
        InverseInertia { inverse_mass: 1e3, inverse_moment: 1e3 },
        InverseInertia { inverse_mass: OF_HEAVY, inverse_moment: OF_HEAVY },
    );
    let (to_world, between) =
        (pin([Some(0), None], [[0.3, 0.1], [0.0; 2]]), pin([Some(0), Some(1)], [[-0.2, 0.4], [0.1, -0.5]]));
    let doubled =
        [pin([Some(2), None], [[0.3, 0.1], [0.0; 2]]), pin([Some(2), None], [[-0.7, 0.2], [0.0; 2]])];
    let pins = [to_world, between, doubled[0], doubled[1]];
    let rows: Vec<_> = pins.iter().flat_map(|(sides, _)| *sides).collect();
    let jacobians: Vec<_> = pins.iter().flat_map(|(_, pair)| *pair).collect();
    let inertia = [light, heavy, INERTIA];
    let mut active = ActiveRows::default();
    active.set_structure(&inertia, &rows);
    assert_eq!(active.factorize(&jacobians), 1);
    active.soften(|_| true);
    assert!(active.is_soft() && active.factorize(&jacobians) == 0);
    let falls = |side: Option<u32>| if side.is_some() { -9.81 } else { 0.0 };
    let offset: Vec<_> = rows
        .iter()
        .zip(&jacobians)
        .map(|(sides, row)| row[1] * falls(sides[0]) + row[4] * falls(sides[1]))
        .collect();
    let mut force = vec![0.0; rows.len()];
    active.solve(&offset, &mut force);
    let (_, rates) = accelerations(&inertia, &rows, &jacobians, &force);
    assert!(
        rates.iter().zip(&offset).all(|(rate, offset)| (rate + offset).abs() < LEFT_OF_LARGE),
        "{rates:?}"
    );
}

#[test]
fn rows_without_a_movable_body_take_no_force() {
    let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
    let jacobians = [[1.0, 0.0, 0.0, -1.0, 0.0, 0.0]; 2];
    assert_eq!(check(&[fixed, INERTIA], &[[Some(0), None], [Some(0), Some(1)]], &jacobians, &[0.0, 1.0]), 1);
}

#[test]
fn a_body_on_both_sides_counts_once() {
    let jacobians = [[1.0, 0.5, 0.3, -0.2, 1.0, 0.4]];
    assert_eq!(check(&[INERTIA], &[[Some(0), Some(0)]], &jacobians, &[2.0]), 0);
}

#[test]
fn another_structure_can_follow() {
    let mut active = ActiveRows::default();
    for count in [3usize, 1, 5] {
        let rows: Vec<_> = (0..count).map(|k| [Some(k as u32), None]).collect();
        active.set_structure(&vec![INERTIA; count], &rows);
        assert_eq!(active.len(), count);
        assert_eq!(active.factorize(&vec![[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]; count]), 0);
        let mut force = vec![0.0; count];
        active.solve(&vec![-0.8; count], &mut force);
        assert!(force.iter().all(|f| (f - 1.0).abs() < ONE_FORCE));
    }
}

/// A row of angles alone: a - ratio b + (ratio - 1) c, with c as its third side.
fn gear(row: u32, carrier: u32, ratio: f64) -> ([f64; 6], ThirdSide) {
    let third = ThirdSide { row, body: carrier, coefficient: ratio - 1.0 };
    ([0.0, 0.0, 1.0, 0.0, 0.0, -ratio], third)
}

#[test]
fn two_gears_on_one_carrier_turn_as_their_ratios_say() {
    // A sun, a planet and their carrier, all free to turn; the ring is fixed.
    let [sun, planet, carrier] =
        [3.0, 5.0, 0.5].map(|inverse_moment| InverseInertia { inverse_mass: 1.0, inverse_moment });
    let (first, of_first) = gear(0, 2, -0.8);
    let (second, of_second) = gear(1, 2, 3.25);
    let sides = [[Some(0), Some(1)], [Some(1), None]];
    let mut active = ActiveRows::default();
    let inertia = [sun, planet, carrier];
    active.set_structure_with_thirds(&inertia, &sides, &[of_second, of_first]);
    assert_eq!(active.factorize(&[first, second]), 0);
    let mut force = [0.0; 2];
    active.solve(&[3.0, 0.0], &mut force);
    // A unit torque on the sun; planet and carrier turn -2.25/3.6 and 1/3.6 as fast as it.
    let mut change = [[0.0, 0.0, 3.0], [0.0; 3], [0.0; 3]];
    active.respond(&force, &mut change);
    let [p, c] = [-2.25 / 3.6, 1.0 / 3.6];
    let expected = 1.0 / (1.0 / 3.0 + p * p / 5.0 + c * c / 0.5);
    for (change, share) in change.iter().zip([1.0, p, c]) {
        assert!((change[2] - share * expected).abs() < GEARED && change[..2] == [0.0; 2], "{change:?}");
    }
}

#[test]
fn a_gear_given_twice_depends_and_soft_rows_share_its_load() {
    let (row, third) = gear(0, 2, -0.8);
    let sides = [[Some(0), Some(1)]; 2];
    let thirds = [third, ThirdSide { row: 1, ..third }];
    let inertia = [INERTIA; 3];
    assert_eq!(check_with_thirds(&inertia, (&sides, &thirds), &[row; 2], &[1.0; 2]), 1);
    // The same sides without the carrier are another row.
    assert_eq!(check_with_thirds(&inertia, (&sides, &thirds[..1]), &[row; 2], &[1.0, 0.5]), 0);
    let mut active = ActiveRows::default();
    active.set_structure_with_thirds(&inertia, &sides, &thirds);
    active.factorize(&[row; 2]);
    active.soften(|_| true);
    assert_eq!(active.factorize(&[row; 2]), 0);
    let mut force = [0.0; 2];
    active.solve(&[1.0; 2], &mut force);
    let (_, rates) = accelerations_with_thirds(&inertia, (&sides, &thirds), &[row; 2], &force);
    assert!(
        (force[0] - force[1]).abs() < SHARED_BY_TWINS && (rates[0] + 1.0).abs() < SOFTLY_GEARED,
        "{force:?} {rates:?}"
    );
}

#[test]
fn a_gear_between_fixed_bodies_holds_its_carrier() {
    let (row, third) = gear(0, 0, -0.8);
    assert_eq!(check_with_thirds(&[INERTIA], (&[[None; 2]], &[third]), &[row], &[1.0]), 0);
    // A carrier that cannot turn is no side.
    let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
    assert_eq!(check_with_thirds(&[fixed], (&[[None; 2]], &[third]), &[row], &[0.0]), 1);
}

fn any_body() -> impl Strategy<Value = InverseInertia> {
    (0.1..10.0f64, 0.1..10.0f64, 0..8).prop_map(|(inverse_mass, inverse_moment, kind)| match kind {
        0 => InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 },
        _ => InverseInertia { inverse_mass, inverse_moment },
    })
}

/// Bodies, their rows, the coefficients of the rows, and a motion of the bodies.
type Linkage = (Vec<InverseInertia>, Vec<[Option<u32>; 2]>, Vec<[f64; 6]>, Vec<[f64; 3]>);

/// Linkages of pins: a tree, some loops, some pins given twice.
fn any_linkage() -> impl Strategy<Value = Linkage> {
    let arms = prop::array::uniform2(prop::array::uniform2(-1.0..1.0f64));
    let joint = (any::<prop::sample::Index>(), any::<prop::sample::Index>(), arms, 0..6);
    let bodies = 1..25usize;
    (bodies, 0..4usize).prop_flat_map(move |(bodies, loops)| {
        let movers = prop::collection::vec(any_body(), bodies);
        let motion = prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), bodies);
        let joints = prop::collection::vec(joint.clone(), bodies + loops);
        (movers, joints, motion).prop_map(|(movers, joints, motion)| {
            let (mut rows, mut jacobians) = (Vec::new(), Vec::new());
            for (k, (one, other, arms, kind)) in joints.iter().enumerate() {
                let first = if k < movers.len() { k } else { one.index(movers.len()) };
                let second = if first == 0 { None } else { Some(other.index(first) as u32) };
                let (sides, pair) = pin([Some(first as u32), second], *arms);
                for _ in 0..if *kind == 0 { 2 } else { 1 } {
                    rows.extend(sides);
                    jacobians.extend(pair);
                }
            }
            let moves = |body: usize| f64::from(u8::from(movers[body].inverse_mass > 0.0));
            let motion = (0..movers.len()).map(|body| motion[body].map(|v| v * moves(body))).collect();
            (movers, rows, jacobians, motion)
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn linkages_with_loops_and_doubled_joints_are_held((inertia, rows, jacobians, motion) in any_linkage()) {
        let offset = offsets(&rows, &jacobians, &motion);
        let dependent = check(&inertia, &rows, &jacobians, &offset);
        let movable = inertia.iter().filter(|body| body.inverse_mass > 0.0).count();
        prop_assert!(rows.len() - dependent <= 3 * movable);
    }

    #[test]
    fn linkages_with_third_sides_are_held(
        (inertia, rows, jacobians, motion) in any_linkage(),
        thirds in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), -2.0..2.0f64), 1..6),
    ) {
        let named = thirds.into_iter().map(|(row, body, coefficient)| ThirdSide {
            row: row.index(rows.len()) as u32,
            body: body.index(inertia.len()) as u32,
            coefficient,
        });
        let mut thirds: Vec<ThirdSide> =
            named.filter(|third| !rows[third.row as usize].contains(&Some(third.body))).collect();
        thirds.sort_by_key(|third| third.row);
        thirds.dedup_by_key(|third| third.row);
        let mut offset = offsets(&rows, &jacobians, &motion);
        for third in &thirds {
            offset[third.row as usize] += third.coefficient * motion[third.body as usize][2];
        }
        check_with_thirds(&inertia, (&rows, &thirds), &jacobians, &offset);
    }
}
