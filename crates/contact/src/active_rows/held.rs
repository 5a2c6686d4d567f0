//! Bodies that rows of their own hold wholly: a hinge on what cannot move and the drive of its angle. Their motion follows from these
//! rows alone, whatever else acts on them, so that neither it nor these rows are unknowns of the equations of the others.
//!
//! With the coefficients K of the three rows of such a body, its acceleration a is changed by d = -K⁻¹ b, which adds J d to the offsets of
//! the other rows; these then see a body that cannot move. Their forces f known, those of the three follow from Kᵀ k = M d - Jᵀ f.
//!
//! *Invariant*: the rows of held bodies have no place in the order, and other rows no coefficient of a held body. Both are here only.

use super::ActiveRows;
use crate::problem::InverseInertia;

/// A body that three rows hold against what cannot move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct HeldBody {
    /// Index of the body.
    pub body: u32,
    /// Indices of the rows: of the displacement of its hinge along x, along y, and of its turning alone.
    pub rows: [u32; 3],
}

/// A held body with what its rows are at present.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Holding {
    held: HeldBody,
    inertia: InverseInertia,
    /// Where the coefficients of the body begin in those of each of its rows: 3 if it is the normal body.
    begin: [u32; 3],
    /// Coefficient of each row's own direction: displacements \[-\] and turning [m].
    own: [f64; 3],
    /// Coefficients [m] of the body's turning in the rows of displacements.
    turning: [f64; 2],
    /// Change of the acceleration (x, y [m/s²], rotation [rad/s²]) by the rows of the body.
    change: [f64; 3],
}

/// A side of another row on a held body.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Touching {
    row: u32,
    begin: u32,
    /// Index of the holding.
    holding: u32,
    /// Coefficients of the body (x, y \[-\] and rotation [m]).
    coefficients: [f64; 3],
}

/// The held bodies, and the sides of other rows on them.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Held {
    all: Vec<Holding>,
    touching: Vec<Touching>,
    /// The rows that hold none of them.
    pub(super) others: Vec<u32>,
    /// Offsets of all rows once the held bodies move as they must.
    offset: Vec<f64>,
}

impl Held {
    /// Takes over the held bodies among those of all rows.
    pub(super) fn set(
        &mut self,
        inertia: &[InverseInertia],
        rows: &[[Option<u32>; 2]],
        held: impl IntoIterator<Item = HeldBody>,
    ) {
        self.all.clear();
        self.touching.clear();
        self.others.clear();
        let can_move = |held: &HeldBody| {
            let InverseInertia { inverse_mass, inverse_moment } = inertia[held.body as usize];
            inverse_mass > 0.0 && inverse_moment > 0.0
        };
        for held in held.into_iter().filter(can_move) {
            let begin = held.rows.map(|row| begin_of(rows[row as usize], held.body));
            let inertia = inertia[held.body as usize];
            let (own, turning, change) = ([0.0; 3], [0.0; 2], [0.0; 3]);
            self.all.push(Holding { held, inertia, begin, own, turning, change });
        }
        for (row, sides) in (0..).zip(rows) {
            if self.all.iter().any(|holding| holding.held.rows.contains(&row)) {
                continue;
            }
            self.others.push(row);
            for (begin, side) in [0, 3].into_iter().zip(sides) {
                let holding = self.all.iter().position(|holding| Some(holding.held.body) == *side);
                if let Some(holding) = holding {
                    let holding = holding as u32;
                    self.touching.push(Touching { row, begin, holding, coefficients: [0.0; 3] });
                }
            }
        }
    }

    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Number of rows that hold them.
    #[inline]
    pub(super) fn row_count(&self) -> usize {
        3 * self.all.len()
    }

    /// True for one of them.
    pub(super) fn contains(&self, body: u32) -> bool {
        self.all.iter().any(|holding| holding.held.body == body)
    }

    /// Takes their coefficients out of those of all rows.
    pub(super) fn take_coefficients(&mut self, jacobians: &[[f64; 6]]) {
        for holding in &mut self.all {
            let entry = |k: usize, at: usize| {
                jacobians[holding.held.rows[k] as usize][holding.begin[k] as usize + at]
            };
            holding.own = [entry(0, 0), entry(1, 1), entry(2, 2)];
            holding.turning = [entry(0, 2), entry(1, 2)];
        }
        for touching in &mut self.touching {
            let of_row = &jacobians[touching.row as usize][touching.begin as usize..];
            touching.coefficients = [of_row[0], of_row[1], of_row[2]];
        }
    }

    /// Moves the held bodies as their rows ask for; returns the offsets of all rows then.
    fn lead(&mut self, offset: &[f64]) -> &[f64] {
        self.offset.clear();
        self.offset.extend_from_slice(offset);
        for Holding { held, own, turning, change, .. } in &mut self.all {
            let [x, y, turn] = held.rows.map(|row| std::mem::take(&mut self.offset[row as usize]));
            let angular = -turn / own[2];
            *change = [-(x + turning[0] * angular) / own[0], -(y + turning[1] * angular) / own[1], angular];
        }
        for &Touching { row, holding, coefficients: [x, y, turn], .. } in &self.touching {
            let change = &self.all[holding as usize].change;
            self.offset[row as usize] += x * change[0] + y * change[1] + turn * change[2];
        }
        &self.offset
    }

    /// Finds the forces \[N\] of the rows of the held bodies, those of the others known.
    fn find_forces(&self, force: &mut [f64]) {
        for (index, holding) in (0..).zip(&self.all) {
            let Holding { held, inertia, own, turning, change, .. } = holding;
            let [mut x, mut y] = [change[0], change[1]].map(|change| change / inertia.inverse_mass);
            let mut torque = change[2] / inertia.inverse_moment;
            for touching in self.touching.iter().filter(|touching| touching.holding == index) {
                let force = force[touching.row as usize];
                x -= touching.coefficients[0] * force;
                y -= touching.coefficients[1] * force;
                torque -= touching.coefficients[2] * force;
            }
            let [along_x, along_y] = [x / own[0], y / own[1]];
            torque -= turning[0] * along_x + turning[1] * along_y;
            let forces = [along_x, along_y, torque / own[2]];
            held.rows.iter().zip(forces).for_each(|(&row, own)| force[row as usize] = own);
        }
    }

    /// Adds what forces on rows change of the accelerations of held bodies.
    pub(super) fn respond(&self, force: &[f64], change: &mut [[f64; 3]]) {
        for Holding { held, inertia, own, turning, .. } in &self.all {
            let [x, y, turn] = held.rows.map(|row| force[row as usize]);
            let torque = turning[0] * x + turning[1] * y + own[2] * turn;
            push(inertia, [own[0] * x, own[1] * y, torque], &mut change[held.body as usize]);
        }
        for &Touching { row, holding, coefficients, .. } in &self.touching {
            let Holding { held, inertia, .. } = &self.all[holding as usize];
            let force = coefficients.map(|entry| entry * force[row as usize]);
            push(inertia, force, &mut change[held.body as usize]);
        }
    }

    /// Adds to the rates of all rows what a unit of force along a direction of its own gives them by way of the held bodies of a row.
    pub(super) fn add_rates(&self, row: u32, direction: &[f64; 6], rates: &mut [f64]) {
        for touching in self.touching.iter().filter(|touching| touching.row == row) {
            let Holding { held, inertia, own, turning, .. } = &self.all[touching.holding as usize];
            let mut motion = [0.0; 3];
            push(inertia, along(direction, touching.begin), &mut motion);
            let of_rows = [0, 1]
                .map(|k: usize| own[k] * motion[k] + turning[k] * motion[2])
                .into_iter()
                .chain([own[2] * motion[2]]);
            held.rows.iter().zip(of_rows).for_each(|(&row, rate)| rates[row as usize] += rate);
            for other in self.touching.iter().filter(|other| other.holding == touching.holding) {
                let [x, y, turn] = other.coefficients;
                rates[other.row as usize] += x * motion[0] + y * motion[1] + turn * motion[2];
            }
        }
    }

    /// Adds what a force on a row along a direction of its own changes of the accelerations of held bodies.
    pub(super) fn push_along(&self, row: u32, direction: &[f64; 6], force: f64, change: &mut [[f64; 3]]) {
        for touching in self.touching.iter().filter(|touching| touching.row == row) {
            let Holding { held, inertia, .. } = &self.all[touching.holding as usize];
            let force = along(direction, touching.begin).map(|entry| entry * force);
            push(inertia, force, &mut change[held.body as usize]);
        }
    }
}

/// Where the coefficients of a body begin in those of a row.
fn begin_of(sides: [Option<u32>; 2], body: u32) -> u32 {
    assert!(sides.contains(&Some(body)), "a row that holds a body is on it");
    if sides[0] == Some(body) { 0 } else { 3 }
}

/// The coefficients of one body in a direction.
fn along(direction: &[f64; 6], begin: u32) -> [f64; 3] {
    std::array::from_fn(|k| direction[begin as usize + k])
}

/// Adds what a force (x, y \[N\], torque [N m]) changes of a body's acceleration.
#[inline]
fn push(inertia: &InverseInertia, [x, y, torque]: [f64; 3], change: &mut [f64; 3]) {
    change[0] += inertia.inverse_mass * x;
    change[1] += inertia.inverse_mass * y;
    change[2] += inertia.inverse_moment * torque;
}

impl ActiveRows {
    /// Calls `solve` with the offsets that are left once held bodies move as they must, and then finds the forces of their rows.
    #[inline]
    pub(super) fn solve_others(
        &mut self,
        offset: &[f64],
        force: &mut [f64],
        solve: impl FnOnce(&mut Self, &[f64], &mut [f64]),
    ) {
        if self.held.is_empty() {
            return solve(self, offset, force);
        }
        let mut held = std::mem::take(&mut self.held);
        solve(self, held.lead(offset), force);
        held.find_forces(force);
        self.held = held;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TurnedRows;
    use proptest::prelude::*;

    /// Rows of an arm of a body: its hinge and its turning, the latter with a lever.
    fn hold([x, y]: [f64; 2], lever: f64) -> [[f64; 3]; 3] {
        [[1.0, 0.0, -y], [0.0, 1.0, x], [0.0, 0.0, lever]]
    }

    /// A row with the coefficients of its primary body, or of its normal one.
    fn on_side(side: usize, entries: [f64; 3]) -> [f64; 6] {
        let mut row = [0.0; 6];
        row[3 * side..3 * side + 3].copy_from_slice(&entries);
        row
    }

    /// Two cranks that are held, and two free bodies; contacts between any of them. The rows of the cranks are the first three and the
    /// last three.
    #[derive(Debug)]
    struct Case {
        inertia: Vec<InverseInertia>,
        sides: Vec<[Option<u32>; 2]>,
        rows: Vec<[f64; 6]>,
        held: Vec<HeldBody>,
        offset: Vec<f64>,
    }

    fn case() -> impl Strategy<Value = Case> {
        let arms = prop::collection::vec((-1.0..1.0, -1.0..1.0, 0.3..2.0, 0usize..2), 2);
        let masses = prop::collection::vec((0.2..5.0, 0.2..5.0), 4);
        // Each free body on each crank, and the free bodies on each other.
        let contacts = prop::collection::vec((0.0..6.3, [-1.0..1.0, -1.0..1.0]), 5);
        let offset = prop::collection::vec(-3.0..3.0, 11);
        (arms, masses, contacts, offset).prop_map(|(arms, masses, contacts, offset)| {
            let inertia = masses
                .iter()
                .map(|&(mass, moment)| InverseInertia { inverse_mass: mass, inverse_moment: moment });
            let crank = |body: usize| {
                let (x, y, lever, side) = arms[body];
                hold([x, y], lever).map(|entries| on_side(side, entries))
            };
            let sides_of = |body: usize| {
                let mut sides = [None; 2];
                sides[arms[body].3] = Some(body as u32);
                [sides; 3]
            };
            let pairs = [[2, 0], [0, 3], [2, 1], [3, 1], [2, 3]];
            let touching = contacts.iter().map(|&(angle, [p, q]): &(f64, [f64; 2])| {
                let (sin, cos) = angle.sin_cos();
                [cos, sin, p, -cos, -sin, q]
            });
            let rows = crank(0).into_iter().chain(touching).chain(crank(1)).collect();
            let pairs = pairs.map(|pair| pair.map(Some));
            let sides = sides_of(0).into_iter().chain(pairs).chain(sides_of(1)).collect();
            let held = vec![HeldBody { body: 0, rows: [0, 1, 2] }, HeldBody { body: 1, rows: [8, 9, 10] }];
            Case { inertia: inertia.collect(), sides, rows, held, offset }
        })
    }

    impl Case {
        fn active(&self, held: &[HeldBody]) -> ActiveRows {
            let mut active = ActiveRows::default();
            active.set_structure_with_held(&self.inertia, &self.sides, &[], held.iter().copied());
            assert_eq!(active.factorize(&self.rows), 0);
            assert_eq!(active.len(), self.rows.len());
            active
        }
    }

    /// Largest difference of two lists, as a fraction of the largest entry.
    fn difference(a: &[f64], b: &[f64]) -> f64 {
        let most = b.iter().fold(1.0f64, |most, value| most.max(value.abs()));
        a.iter().zip(b).fold(0.0f64, |off, (a, b)| off.max((a - b).abs())) / most
    }

    proptest! {
        #[test]
        fn forces_and_motions_are_those_of_equations_of_all_rows(case in case(), turn in prop::array::uniform3(-0.2..0.2f64)) {
            let solve = |held: &[HeldBody]| {
                let (mut active, mut force) = (case.active(held), vec![0.0; 11]);
                active.solve(&case.offset, &mut force);
                let kept = active.kept_beyond(0);
                let mut change = [[0.0; 3]; 4];
                active.respond(&force, &mut change);
                let mut rough = vec![0.0; 11];
                active.solve_roughly(&case.offset, &mut rough);
                assert!(kept < 1e-3 || difference(&rough, &force) < 1e-9);
                // Two of the contacts slip: one of a crank, and one of the free bodies.
                let (mut turned, mut slipping, [a, b, c]) = (TurnedRows::default(), vec![0.0; 11], turn);
                turned.factorize(&mut active, [(4, [a, b, c, -a, -b, c]), (7, [b, a, c, -b, -a, a])]);
                turned.solve(&mut active, &case.offset, &mut slipping);
                let mut turned_change = [[0.0; 3]; 4];
                turned.respond(&active, &slipping, &mut turned_change);
                (kept, force, change, slipping, turned_change)
            };
            let (kept, force, change, slipping, turned_change) = solve(&case.held);
            let (least, all_force, all_change, all_slipping, all_turned) = solve(&[]);
            prop_assume!(least > 1e-3 && kept > 1e-3);
            prop_assert!(difference(&force, &all_force) < 1e-9);
            prop_assert!(difference(change.as_flattened(), all_change.as_flattened()) < 1e-9);
            prop_assert!(difference(&slipping, &all_slipping) < 1e-8);
            prop_assert!(difference(turned_change.as_flattened(), all_turned.as_flattened()) < 1e-8);
        }
    }

    #[test]
    fn a_row_between_held_bodies_has_no_force_and_changes_nothing() {
        let crank = InverseInertia { inverse_mass: 0.5, inverse_moment: 2.0 };
        let rows: Vec<_> = hold([0.5, 0.0], 1.0).into_iter().map(|entries| on_side(0, entries)).collect();
        let rows: Vec<_> =
            rows.iter().chain(&rows).copied().chain([[1.0, 0.0, 0.1, -1.0, 0.0, 0.2]]).collect();
        let sides: Vec<_> = [0, 0, 0, 1, 1, 1]
            .map(|body| [Some(body), None])
            .into_iter()
            .chain([[Some(0), Some(1)]])
            .collect();
        let held = [HeldBody { body: 0, rows: [0, 1, 2] }, HeldBody { body: 1, rows: [3, 4, 5] }];
        let mut active = ActiveRows::default();
        active.set_structure_with_held(&[crank; 2], &sides, &[], held);
        assert_eq!(active.factorize(&rows), 1);
        assert!(active.is_dependent(6) && !active.is_dependent(2));
        let mut force = [1.0; 7];
        active.solve(&[0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 9.0], &mut force);
        // The centre is half a metre before its hinge, and is to turn back by 3 rad/s^2.
        assert_eq!(force, [0.0, 3.0, -3.0, 0.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn a_body_that_no_force_turns_is_not_held() {
        let bar = InverseInertia { inverse_mass: 0.25, inverse_moment: 0.0 };
        let rows: Vec<_> = hold([0.5, 0.0], 1.0).into_iter().map(|entries| on_side(0, entries)).collect();
        let mut active = ActiveRows::default();
        let held = [HeldBody { body: 0, rows: [0, 1, 2] }];
        active.set_structure_with_held(&[bar], &[[Some(0), None]; 3], &[], held);
        assert_eq!(active.factorize(&rows), 1);
        let mut force = [0.0; 3];
        active.solve(&[1.0, 2.0, 0.0], &mut force);
        assert_eq!(force, [-4.0, -8.0, 0.0]);
    }
}
