//! Rows at rest that no motion can open: those of a body that fits exactly between others.
//!
//! Rows at rest are locked if they can press on each other without moving a body: y >= 0, J^T y = 0, on the rows with
//! y > 0. By Stiemke's lemma these are the rows whose rate is 0 in each motion in which none closes: they act as
//! connectors do. If such a row rebounded from an impulse that goes through it, those that face it would close in turn,
//! without end. So locked rows are solved with each row that reaches them, by every law.
//!
//! To find them, all rows in question are pressed at once, and the least impulses of all rows at rest are found that keep
//! the bodies from going into each other. If all pressed rows then rest, pressing and answer are such a y, and all of
//! them are locked. If not, those that open are none, and the others are tried again: each round drops one at least.

use super::Impact;
use super::pair_problem::DEPENDENT;
use crate::row::CollisionRow;
use halfgap_collision::BodyId;

/// Part of a row in the search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
enum Part {
    /// It moves, or can be opened.
    #[default]
    None,
    /// It rests, and may be locked.
    Pressed,
    /// It is a connector, which opposes both ways.
    Connector,
}

/// The search for locked rows, and its buffers.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Locked {
    /// One flag per row: true if it is locked. Empty if none is.
    rows: Vec<bool>,
    parts: Vec<Part>,
    /// The rows at rest, with all connectors.
    at_rest: Vec<usize>,
    /// Rows that may have lost what opposes them.
    doubtful: Vec<usize>,
    /// Rates [m/s] and impulses [N s] of the impact, kept while it serves for the search.
    rates: Vec<f64>,
    impulses: Vec<f64>,
}

impl Locked {
    /// Forgets the rows of the last impact.
    pub(super) fn clear(&mut self) {
        self.rows.clear();
    }
}

impl Impact {
    /// Whether a row was found to be locked.
    pub(super) fn is_locked(&self, row: usize) -> bool {
        self.scratch.locked.rows.get(row).is_some_and(|&is_locked| is_locked)
    }

    /// Whether any row was.
    pub(super) fn has_locked(&self) -> bool {
        !self.scratch.locked.rows.is_empty()
    }

    /// Flags the locked rows among those that rested as the impact began (see [`find_locked`](Self::find_locked)), and goes
    /// back to that start if there are any; the impact stays as it is if not.
    pub(super) fn find_locked_at_start(&mut self, rest: f64, between_walls: bool) -> bool {
        std::mem::swap(&mut self.rates, &mut self.scratch.start_rates);
        self.find_locked(rest, between_walls);
        std::mem::swap(&mut self.rates, &mut self.scratch.start_rates);
        if self.has_locked() {
            self.start_again();
        }
        self.has_locked()
    }

    /// Flags the locked rows among those whose rate is at most `rest` [m/s]; if `between_walls`, those alone that press,
    /// directly or through other locked rows, on something immovable.
    pub(super) fn find_locked(&mut self, rest: f64, between_walls: bool) {
        let mut locked = std::mem::take(&mut self.scratch.locked);
        locked.rows.clear();
        self.list_at_rest(&mut locked, rest);
        while self.drop_unopposed(&mut locked) {
            if self.comes_to_rest_pressed(&mut locked) {
                locked.rows.extend(locked.parts.iter().map(|&part| part == Part::Pressed));
                if between_walls {
                    self.keep_those_at_walls(&mut locked);
                }
                break;
            }
        }
        self.scratch.locked = locked;
    }

    /// Drops the locked rows that do not reach anything immovable through each other.
    fn keep_those_at_walls(&self, locked: &mut Locked) {
        let Locked { rows, parts, at_rest: reached, .. } = locked;
        reached.clear();
        let is_at_wall = |&row: &usize| rows[row] && self.rows[row].movable_bodies().contains(&None);
        reached.extend((0..rows.len()).filter(is_at_wall));
        rows.fill(false);
        reached.iter().for_each(|&row| rows[row] = true);
        let mut next = 0;
        while next < reached.len() {
            for (other, _) in self.couplings.row(reached[next]) {
                if parts[other] == Part::Pressed && !rows[other] {
                    rows[other] = true;
                    reached.push(other);
                }
            }
            next += 1;
        }
        if reached.is_empty() {
            rows.clear();
        }
    }

    /// Takes the impulses of locked rows that press on each other without moving a body out of them: blow after blow may
    /// have left some, in one direction and in the other. Where no others are found, they stay.
    pub(super) fn relieve_locked(&mut self) {
        if !self.has_locked() {
            return;
        }
        self.keep_start();
        let mut set = std::mem::take(&mut self.scratch.set);
        set.clear();
        set.extend((0..self.rows.len()).filter(|&row| self.is_locked(row)));
        for &row in &set {
            self.apply(row, -self.impulses[row]);
        }
        self.aim_at_rest();
        if self.solve_together(&set).is_err() {
            self.start_again();
        }
        self.scratch.set = set;
    }

    fn list_at_rest(&self, locked: &mut Locked, rest: f64) {
        let Locked { at_rest, parts, .. } = locked;
        self.list_held(at_rest, rest);
        at_rest.retain(|&row| self.rows[row].is_bilateral() || !self.is_violated(row, rest));
        parts.clear();
        parts.resize(self.rows.len(), Part::None);
        for &row in &*at_rest {
            parts[row] = if self.rows[row].is_bilateral() { Part::Connector } else { Part::Pressed };
        }
    }

    /// Drops the pressed rows that no other one and no connector opposes on one of the bodies that they move, until all
    /// are opposed: forces that balance need an opposed one on each body. False if no pressed row is left.
    fn drop_unopposed(&self, locked: &mut Locked) -> bool {
        let Locked { parts, doubtful, .. } = locked;
        doubtful.clear();
        doubtful.extend((0..parts.len()).filter(|&row| parts[row] == Part::Pressed));
        let mut left = doubtful.len();
        while let Some(row) = doubtful.pop() {
            let is_opposed =
                |body: &Option<BodyId>| body.is_none_or(|body| self.is_opposed(row, body, parts));
            if parts[row] == Part::Pressed && !self.is_opposed_everywhere(row, is_opposed) {
                parts[row] = Part::None;
                left -= 1;
                let others = self.couplings.row(row).map(|(other, _)| other);
                doubtful.extend(others.filter(|&other| parts[other] == Part::Pressed));
            }
        }
        left > 0
    }

    /// Whether a row is opposed on each body that it moves.
    fn is_opposed_everywhere(&self, row: usize, is_opposed: impl Fn(&Option<BodyId>) -> bool) -> bool {
        let row = &self.rows[row];
        row.movable_bodies().iter().all(&is_opposed) && is_opposed(&row.movable_third())
    }

    /// Whether pressed rows and connectors may balance a pressed row on a body. A connector may always; pressed rows if one
    /// pushes against this row, and if the mean push of all is not along both this row and every other.
    fn is_opposed(&self, row: usize, body: BodyId, parts: &[Part]) -> bool {
        let on_body = || self.couplings.rows_of_body(body).filter(|&other| parts[other] != Part::None);
        if on_body().any(|other| parts[other] == Part::Connector) {
            return true;
        }
        let mut mean = [0.0; 3];
        let mut is_faced = false;
        for other in on_body() {
            let push = push_on(&self.rows[other], body).map(|entry| entry / self.length(other));
            is_faced |= along(&self.rows[row], body, push) < 0.0;
            mean = std::array::from_fn(|k| mean[k] + push[k]);
        }
        let along_mean = |row: usize| along(&self.rows[row], body, mean);
        is_faced
            && (along_mean(row) <= DEPENDENT * self.length(row)
                || on_body().any(|other| along_mean(other) < 0.0))
    }

    /// Presses the pressed rows and finds the impulses of all rows at rest. True if the pressed rows are at rest then;
    /// else those that open are dropped. The impact stays as it is.
    fn comes_to_rest_pressed(&mut self, locked: &mut Locked) -> bool {
        locked.rates.clone_from(&self.rates);
        locked.impulses.clone_from(&self.impulses);
        let kept = (self.noise, self.largest_change, self.solves);
        self.rates.fill(0.0);
        (self.noise, self.largest_change) = (0.0, 0.0);
        // The rates become as large as those of the impact, whose bounds serve here too.
        for (row, _) in locked.parts.iter().enumerate().filter(|&(_, &part)| part == Part::Pressed) {
            self.apply(row, self.fastest / self.couplings.diagonal(row));
        }
        let scaled = |impact: &Self, row: usize| impact.rates[row] / impact.length(row);
        let fastest = locked.at_rest.iter().fold(0.0f64, |most, &row| most.max(scaled(self, row).abs()));
        self.aim_at_rest();
        let is_solved = self.solve_together(&locked.at_rest).is_ok();
        let limit = DEPENDENT.sqrt() * fastest;
        let mut is_any_dropped = false;
        for (row, part) in locked.parts.iter_mut().enumerate().filter(|(_, part)| **part == Part::Pressed) {
            if !is_solved || scaled(self, row) > limit {
                *part = Part::None;
                is_any_dropped = true;
            }
        }
        self.rates.clone_from(&locked.rates);
        self.impulses.clone_from(&locked.impulses);
        (self.noise, self.largest_change, self.solves) = kept;
        !is_any_dropped
    }
}

/// Change of the velocity of one body per impulse along a row: x, y [1/kg], turn [rad/(kg m)].
fn push_on(row: &CollisionRow, body: BodyId) -> [f64; 3] {
    let [x, y, turn] = sum_on(row, body, &row.response);
    let third = row.third.filter(|third| third.body == body);
    third.map_or([x, y, turn], |third| [x, y, turn + third.response])
}

/// Rate of a row by the velocity of one body alone.
fn along(row: &CollisionRow, body: BodyId, velocity: [f64; 3]) -> f64 {
    let [x, y, turn] = sum_on(row, body, &row.jacobian);
    let third = row.third.filter(|third| third.body == body);
    let turn = third.map_or(turn, |third| turn + third.jacobian);
    [x, y, turn].iter().zip(velocity).map(|(entry, velocity)| entry * velocity).sum()
}

/// The three entries of a row that belong to one body.
fn sum_on(row: &CollisionRow, body: BodyId, entries: &[f64; 6]) -> [f64; 3] {
    let is_on = |side: usize| row.bodies[side] == body;
    std::array::from_fn(|k| (0..2).filter(|&side| is_on(side)).map(|side| entries[3 * side + k]).sum())
}

#[cfg(test)]
mod tests {
    use super::super::law::{ImpactLaw, ImpactOrder};
    use super::*;
    use crate::problem::InverseInertia;

    const FIXED: InverseInertia = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
    /// A block 1 m wide and 0.5 m high of 1 kg.
    const BLOCK: InverseInertia = InverseInertia { inverse_mass: 1.0, inverse_moment: 9.6 };

    /// Row at rest of the block's corner at (x, y) [m] against a wall with the normal [nx, ny].
    fn corner([x, y]: [f64; 2], [nx, ny]: [f64; 2]) -> CollisionRow {
        let jacobian = [nx, ny, x * ny - y * nx, -nx, -ny, 0.0];
        let row = CollisionRow::new([BodyId(0), BodyId::WORLD], jacobian, [BLOCK, FIXED], 0.0);
        CollisionRow { elasticity: 1.0, velocity_tol: 1e-6, ..row }
    }

    fn left_and_right() -> [CollisionRow; 4] {
        [(-0.5, -0.25), (-0.5, 0.25), (0.5, -0.25), (0.5, 0.25)]
            .map(|(x, y): (f64, f64)| corner([x, y], [-x.signum(), 0.0]))
    }

    fn below() -> [CollisionRow; 2] {
        [-0.5, 0.5].map(|x| corner([x, -0.25], [0.0, 1.0]))
    }

    fn locked(rows: &[CollisionRow], between_walls: bool) -> Vec<bool> {
        let mut impact = Impact::new();
        impact.set_rows(rows.iter().copied());
        impact.fastest = 1.0;
        impact.find_locked(1e-9, between_walls);
        assert!(
            impact.rates().iter().chain(impact.impulses()).all(|&x| x == 0.0),
            "the impact stays as it was"
        );
        (0..rows.len()).map(|row| impact.is_locked(row)).collect()
    }

    #[test]
    fn walls_on_both_sides_lock_a_block_and_a_floor_does_not() {
        let slot = [&left_and_right()[..], &below()].concat();
        assert_eq!(locked(&slot, true), [true, true, true, true, false, false]);
        let corner = [&left_and_right()[..2], &below()].concat();
        assert_eq!(locked(&corner, true), [false; 4]);
    }

    #[test]
    fn bodies_that_all_can_move_lock_each_other_but_not_at_walls() {
        // Two discs fill a frame from side to side.
        let disc = InverseInertia { inverse_mass: 1.0, inverse_moment: 0.0 };
        let row = |a: u32, b: u32| {
            CollisionRow::new([BodyId(a), BodyId(b)], [1.0, 0.0, 0.0, -1.0, 0.0, 0.0], [disc; 2], 0.0)
        };
        let rows = [row(1, 0), row(2, 1), row(0, 2)];
        assert_eq!(locked(&rows, false), [true; 3]);
        assert_eq!(locked(&rows, true), [false; 3]);
    }

    #[test]
    fn a_block_in_its_bore_is_struck_as_if_it_were_guided_by_every_law() {
        // A disc of 1 kg hits it at 1 m/s, 0.3 m off its middle.
        let disc = InverseInertia { inverse_mass: 1.0, inverse_moment: 0.0 };
        for elasticity in [0.0, 0.3, 0.7, 1.0] {
            let jacobian = [0.0, 1.0, 0.0, 0.0, -1.0, -0.3];
            let blow = CollisionRow::new([BodyId(1), BodyId(0)], jacobian, [disc, BLOCK], -1.0);
            let blow = CollisionRow { elasticity, velocity_tol: 1e-6, ..blow };
            let rows = [&left_and_right()[..], &[blow]].concat();
            for law in [
                ImpactLaw::Simultaneous,
                ImpactLaw::Hybrid,
                ImpactLaw::SerialSeparate,
                ImpactLaw::SerialGrouped,
                ImpactLaw::SerialSeparateLastpass,
                ImpactLaw::SerialGroupedLastpass,
            ] {
                let mut impact = Impact::new();
                impact.set_rows(rows.iter().copied());
                law.resolve(&mut impact, ImpactOrder::Fastest, 0).expect("an answer");
                let impulse = 0.5 * (1.0 + elasticity);
                assert!((impact.impulses()[4] - impulse).abs() < 1e-12, "{law:?}: {:?}", impact.impulses());
                // The walls turn back what the blow would turn, by one corner on each side.
                let walls: f64 = impact.impulses()[..4].iter().sum();
                assert!(
                    (walls - 2.0 * 0.3 * impulse / 0.5).abs() < 1e-12,
                    "{law:?}: {:?}",
                    impact.impulses()
                );
            }
        }
    }
}
