//! Rows that nearly depend on each other, solved with twice as many digits.
//!
//! Let two rows of one body have directions (J M^-1/2) that differ by an angle x. The Delassus matrix knows their
//! difference by its square: of x = 1e-7 the entries 1 - x^2/2 of doubles keep one digit, and impulses computed from them
//! lose or gain energy. Here the matrix is made from J itself, in numbers of 31 digits, so that only the rounding of the
//! rates is left. It moves a body by its share 1e-16/x of the speed, across the two directions. Rows closer than
//! [`DEPENDENT`] count as one: told apart, rounding would move bodies by more than the angle between them does.
//!
//! The method is that of Goldfarb and Idnani (see `dual_active_set`), with the factor made anew at each pivot: it serves
//! the few rows of `few_rows`.

use super::Impact;
use super::pair_problem::DEPENDENT;
use crate::problem::pushing;
use crate::row::CollisionRow;
use crate::twofold::{Number, Twofold};

/// Rounding of a scaled rate, as a fraction of the largest: that of the products it was made from.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Fraction of a contact's square: if others leave less of it, it counts as one with them, as in larger problems
/// (`Settings::dependence`). Two contacts 3e-6 rad from opposite each other hold a body between them like a vice, though
/// where they lie is known no better than the gap, over which their directions change by more.
const CONTACTS: f64 = 1e-11;

/// Cap on pivots, per row: without rounding each set of closed rows comes once at most, and one or two exchanges a row are
/// what problems take. It ends a search that rounding would send round for ever.
const PIVOTS: usize = 8;

/// A small problem A f + b >= 0, f >= 0, f.(A f + b) = 0, with A f + b = 0 on bilateral rows.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct NearRows {
    directions: Vec<Direction>,
    /// A (n, n) [1/kg], by rows, of n rows.
    matrix: Vec<Twofold>,
    /// sqrt(A_ii) [1/sqrt(kg)].
    length: Vec<f64>,
    /// b [m/s], and the rates A f + b.
    offset: Vec<f64>,
    rate: Vec<Twofold>,
    bilateral: Vec<bool>,
    /// f [N s].
    force: Vec<Twofold>,
    /// The closed rows, whose rates are held at 0.
    closed: Vec<usize>,
    /// Whether a row counts as one with closed ones, which may contradict it by as little as they are told apart.
    is_same: Vec<bool>,
    /// The largest violation of such a row, as a scaled rate [sqrt(kg) m/s].
    left: f64,
    /// The factor L D L^T of A on the closed rows, by rows, with D on the diagonal.
    factor: Vec<Twofold>,
    /// Change of the closed forces per force on the entering row, with its sign reversed.
    shares: Vec<Twofold>,
}

/// Direction in which a row moves its bodies.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Direction {
    bodies: [u32; 2],
    /// J M^-1/2 [1/sqrt(kg)].
    entries: [f64; 6],
    /// The third body of the row, and the entry of its rotation.
    third: Option<(u32, f64)>,
}

impl Direction {
    /// Of coefficient and response, J and J/m, each entry is the geometric mean with the sign of J.
    fn new(row: &CollisionRow) -> Self {
        let mean = |j: f64, response: f64| (j * response).max(0.0).sqrt().copysign(j);
        let entry = |k: usize| mean(row.jacobian[k], row.response[k]);
        let third = row.third.map(|third| (third.body.0, mean(third.jacobian, third.response)));
        Self { bodies: row.bodies.map(|body| body.0), entries: std::array::from_fn(entry), third }
    }

    /// Entry of A of two rows [1/kg].
    fn product(&self, other: &Self) -> Twofold {
        let mut sum = Twofold::default();
        for (side, body) in self.bodies.iter().enumerate() {
            for other_side in (0..2).filter(|&other_side| other.bodies[other_side] == *body) {
                for k in 0..3 {
                    let (own, theirs) = (self.entries[3 * side + k], other.entries[3 * other_side + k]);
                    sum = sum + Twofold::from(own) * Twofold::from(theirs);
                }
            }
        }
        if self.third.is_some() || other.third.is_some() { sum + self.product_by_thirds(other) } else { sum }
    }

    /// The part of the entry of A of two rows that goes through a third body of either.
    fn product_by_thirds(&self, other: &Self) -> Twofold {
        let mut sum = Twofold::default();
        for (of, others) in [(self, other), (other, self)] {
            let Some((body, entry)) = of.third else { continue };
            for side in (0..2).filter(|&side| others.bodies[side] == body) {
                sum = sum + Twofold::from(entry) * Twofold::from(others.entries[3 * side + 2]);
            }
        }
        match (self.third, other.third) {
            (Some((p, own)), Some((q, theirs))) if p == q => sum + Twofold::from(own) * Twofold::from(theirs),
            _ => sum,
        }
    }
}

impl NearRows {
    fn clear(&mut self) {
        self.directions.clear();
        self.offset.clear();
        self.bilateral.clear();
    }

    /// Adds a row whose rate is to change by -`offset` [m/s].
    fn push(&mut self, row: &CollisionRow, offset: f64) {
        self.directions.push(Direction::new(row));
        self.offset.push(offset);
        self.bilateral.push(row.is_bilateral());
    }

    fn count(&self) -> usize {
        self.offset.len()
    }

    /// Finds the forces; false if rows contradict each other or the pivots run out.
    fn solve(&mut self) -> bool {
        self.begin();
        let scaled = self.offset.iter().zip(&self.length).map(|(b, length)| (b / length).abs());
        let scale = scaled.fold(0.0, f64::max);
        self.close_connectors();
        let mut pivots = PIVOTS * self.count();
        while let Some(row) = self.most_violated(ROUNDING * scale) {
            loop {
                match self.step(row) {
                    Step::Closed => break,
                    Step::Opened if pivots > 0 => pivots -= 1,
                    Step::Opened => return false,
                    Step::Contradicted => {
                        self.is_same[row] = true;
                        break;
                    }
                }
            }
            if pivots == 0 {
                return false;
            }
            pivots -= 1;
            self.update_rates();
        }
        self.left = 0.0;
        let mut fits = true;
        for row in (0..self.count()).filter(|&row| self.is_same[row]) {
            let violation = self.violation(row);
            self.left = self.left.max(violation);
            fits &= violation <= self.dependence(row).sqrt() * scale;
        }
        fits
    }

    /// Fraction of a row's square up to which what others leave of it counts as nothing.
    fn dependence(&self, row: usize) -> f64 {
        if self.bilateral[row] { DEPENDENT } else { CONTACTS }
    }

    /// Forms the matrix, with all forces 0 and all rows open.
    fn begin(&mut self) {
        let n = self.count();
        self.matrix.clear();
        for i in 0..n {
            for j in 0..n {
                let known = if j < i {
                    self.matrix[j * n + i]
                } else {
                    self.directions[i].product(&self.directions[j])
                };
                self.matrix.push(known);
            }
        }
        self.length.clear();
        self.length.extend((0..n).map(|i| self.matrix[i * n + i].nearest().sqrt()));
        self.closed.clear();
        self.force.clear();
        self.force.resize(n, Twofold::default());
        self.rate.clear();
        self.rate.extend(self.offset.iter().map(|&b| Twofold::from(b)));
    }

    /// Closes the connectors that do not depend on each other, each next one that of whose square those before leave most:
    /// forces through a bad lever would be large. The others count as one with these.
    fn close_connectors(&mut self) {
        self.is_same.clear();
        self.is_same.extend_from_slice(&self.bilateral);
        loop {
            let mut next = None;
            let mut most = DEPENDENT;
            for row in 0..self.count() {
                if self.is_same[row] {
                    let share = self.consider(row).nearest() / (self.length[row] * self.length[row]);
                    if share > most {
                        (next, most) = (Some(row), share);
                    }
                }
            }
            let Some(next) = next else { return };
            self.is_same[next] = false;
            // Nothing gives way to a connector but contacts, and none is closed yet.
            self.step(next);
            self.update_rates();
        }
    }

    /// Violation of a row, as a scaled rate [sqrt(kg) m/s].
    fn violation(&self, row: usize) -> f64 {
        let rate = self.rate[row].nearest() / self.length[row];
        if self.bilateral[row] { rate.abs() } else { -rate }
    }

    /// The open contact that is violated most, by more than `noise`.
    fn most_violated(&self, noise: f64) -> Option<usize> {
        let is_free =
            |row: &usize| !self.bilateral[*row] && !self.is_same[*row] && !self.closed.contains(row);
        let violated = (0..self.count()).filter(|row| is_free(row) && self.violation(*row) > noise);
        violated.max_by(|&p, &q| self.violation(p).total_cmp(&self.violation(q)))
    }

    /// Changes the force of an open row until its rate is 0, or until that of a closed one vanishes.
    fn step(&mut self, row: usize) -> Step {
        let complement = self.consider(row);
        let rate = self.rate[row];
        let pushes = rate < Twofold::default();
        let is_independent =
            complement.nearest() > self.dependence(row) * self.length[row] * self.length[row];
        let full = is_independent.then(|| rate.abs() / complement);
        // A share that is no larger than what dependent rows are told apart by does not give way to one: a force of that
        // many times its own would have to move it.
        let least_share = if is_independent { 0.0 } else { self.dependence(row).sqrt() * self.length[row] };
        // The force that is used up first by what the entering row takes over.
        let mut blocking: Option<(usize, Twofold)> = None;
        for (place, &closed) in self.closed.iter().enumerate() {
            let share = if pushes { self.shares[place] } else { -self.shares[place] };
            if self.bilateral[closed] || share.nearest() * self.length[closed] <= least_share {
                continue;
            }
            let least = self.force[closed] / share;
            if blocking.is_none_or(|(_, known)| least < known) {
                blocking = Some((place, least));
            }
        }
        let opens = match (blocking, full) {
            (Some((_, least)), Some(full)) => least < full,
            (Some(_), None) => true,
            (None, Some(_)) => false,
            (None, None) => return Step::Contradicted,
        };
        let size = if opens { blocking.map(|(_, least)| least) } else { full };
        let size = size.unwrap_or_default();
        let size = if pushes { size } else { -size };
        for (place, &closed) in self.closed.iter().enumerate() {
            self.force[closed] = self.force[closed] - size * self.shares[place];
        }
        self.force[row] = self.force[row] + size;
        self.rate[row] = rate + size * complement;
        match blocking.filter(|_| opens) {
            Some((place, _)) => {
                let opened = self.closed.remove(place);
                self.force[opened] = Twofold::default();
                Step::Opened
            }
            None => {
                self.closed.push(row);
                Step::Closed
            }
        }
    }

    /// Finds the shares of the closed rows in an open one, and returns what they leave of its square.
    fn consider(&mut self, row: usize) -> Twofold {
        let (n, count) = (self.count(), self.closed.len());
        self.factorize();
        let factor = &self.factor;
        let shares = &mut self.shares;
        shares.clear();
        let mut complement = self.matrix[row * n + row];
        for (i, &closed) in self.closed.iter().enumerate() {
            let mut value = self.matrix[row * n + closed];
            for j in 0..i {
                value = value - factor[i * count + j] * shares[j];
            }
            complement = complement - value * value / factor[i * count + i];
            shares.push(value);
        }
        for i in 0..count {
            shares[i] = shares[i] / factor[i * count + i];
        }
        for i in (0..count).rev() {
            for k in i + 1..count {
                shares[i] = shares[i] - factor[k * count + i] * shares[k];
            }
        }
        complement
    }

    fn factorize(&mut self) {
        let (n, count) = (self.count(), self.closed.len());
        let factor = &mut self.factor;
        factor.clear();
        factor.resize(count * count, Twofold::default());
        for i in 0..count {
            let mut square = self.matrix[self.closed[i] * n + self.closed[i]];
            for j in 0..i {
                let mut value = self.matrix[self.closed[i] * n + self.closed[j]];
                for k in 0..j {
                    value = value - factor[i * count + k] * factor[j * count + k] * factor[k * count + k];
                }
                let part = value / factor[j * count + j];
                square = square - part * value;
                factor[i * count + j] = part;
            }
            factor[i * count + i] = square;
        }
    }

    /// Brings all rates up to date with the forces.
    fn update_rates(&mut self) {
        let n = self.count();
        for i in 0..n {
            let products = (0..n).map(|j| self.matrix[i * n + j] * self.force[j]);
            self.rate[i] = products.fold(Twofold::from(self.offset[i]), |sum, term| sum + term);
        }
    }
}

/// Outcome of a step.
enum Step {
    /// The row is closed now.
    Closed,
    /// Another row was opened, and the row is still violated.
    Opened,
    /// The closed rows keep the row from moving, and none of them gives way.
    Contradicted,
}

impl Impact {
    /// Solves a few rows that may nearly depend on each other, each to reach its target rate, and applies the impulses;
    /// false if they contradict each other.
    pub(super) fn solve_near(&mut self, set: &[usize]) -> bool {
        let mut near = self.scratch.near.take().unwrap_or_default();
        near.clear();
        for &row in set {
            near.push(&self.rows[row], self.rates[row] - self.scratch.targets[row]);
        }
        let is_solved = near.solve();
        if is_solved {
            self.solves += 1;
            self.apply_together(set, &near);
            for &row in set {
                self.noise = self.noise.max(near.left * self.length(row));
            }
        }
        self.scratch.near = Some(near);
        is_solved
    }

    /// Adds the impulses of nearly dependent rows. They may cancel each other by far, so that their changes of a rate are
    /// summed up before they are rounded.
    fn apply_together(&mut self, set: &[usize], near: &NearRows) {
        for (place, &row) in set.iter().enumerate() {
            let impulse = near.force[place].nearest();
            self.impulses[row] += if self.rows[row].is_bilateral() { impulse } else { pushing(impulse) };
        }
        let mut reached = std::mem::take(&mut self.scratch.listed);
        reached.clear();
        reached.resize(self.rows.len(), false);
        for &row in set {
            self.couplings.row(row).for_each(|(other, _)| reached[other] = true);
        }
        for other in (0..self.rows.len()).filter(|&other| reached[other]) {
            let own = Direction::new(&self.rows[other]);
            let pairs = near.directions.iter().zip(&near.force);
            let changes = pairs.map(|(direction, &force)| own.product(direction) * force);
            let change = changes.fold(Twofold::default(), |sum, term| sum + term).nearest();
            self.largest_change = self.largest_change.max(change.abs());
            self.rates[other] += change;
        }
        self.scratch.listed = reached;
        self.noise = self.noise.max(super::NOISE * self.largest_change);
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::{ImpactLaw, ImpactOrder};
    use super::*;
    use crate::kind::RowKind;
    use crate::problem::InverseInertia;
    use halfgap_collision::BodyId;
    use proptest::prelude::*;

    const FIXED: InverseInertia = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
    const DISC: InverseInertia = InverseInertia { inverse_mass: 1.0, inverse_moment: 0.0 };

    /// Row of a disc at a velocity [m/s] against something fixed, whose normal leans by an angle [rad] from the vertical.
    fn leaning(angle: f64, [x, y]: [f64; 2], elasticity: f64) -> CollisionRow {
        let (sin, cos) = angle.sin_cos();
        CollisionRow {
            elasticity,
            velocity_tol: 1e-6,
            ..CollisionRow::new(
                [BodyId(0), BodyId::WORLD],
                [sin, cos, 0.0, -sin, -cos, 0.0],
                [DISC, FIXED],
                sin * x + cos * y,
            )
        }
    }

    /// Velocity [m/s] of the disc after the impact.
    fn after(rows: &[CollisionRow], [x, y]: [f64; 2], law: ImpactLaw) -> [f64; 2] {
        let mut impact = Impact::new();
        impact.set_rows(rows.iter().copied());
        law.resolve(&mut impact, ImpactOrder::Fastest, 0).expect("an answer");
        let sum =
            |k: usize| rows.iter().zip(impact.impulses()).map(|(row, j)| row.response[k] * j).sum::<f64>();
        [x + sum(0), y + sum(1)]
    }

    #[test]
    fn normals_however_close_throw_a_disc_back_as_one_does() {
        for exponent in -40..=-8 {
            let angle = 10f64.powf(0.25 * f64::from(exponent));
            for (law, elasticity) in
                [(ImpactLaw::Simultaneous, 1.0), (ImpactLaw::Hybrid, 1.0), (ImpactLaw::Hybrid, 0.5)]
            {
                let (before, rows) =
                    ([0.0, -5.0], [0.0, angle].map(|angle| leaning(angle, [0.0, -5.0], elasticity)));
                let [x, y] = after(&rows, before, law);
                assert!((y - 5.0 * elasticity).abs() < 1e-10 && x.abs() < 1e-8, "{angle:e}: {x:e}, {y}");
            }
        }
    }

    #[test]
    fn a_bob_on_two_rods_is_fixed_until_they_count_as_one() {
        // The rods' anchors lie an angle apart, seen from the bob; a ball hits the bob across both.
        for (angle, is_fixed) in [(1e-2, true), (2e-6, true), (2e-7, true), (2e-8, false), (1e-12, false)] {
            let ball = InverseInertia { inverse_mass: 1.0, inverse_moment: 0.0 };
            let rod = |lean: f64| CollisionRow {
                kind: RowKind::Bilateral,
                elasticity: 0.0,
                ..leaning(lean, [0.0; 2], 0.0)
            };
            let hit = CollisionRow {
                elasticity: 1.0,
                velocity_tol: 1e-6,
                ..CollisionRow::new(
                    [BodyId(1), BodyId(0)],
                    [-1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
                    [ball, DISC],
                    -2.0,
                )
            };
            let rows = [rod(-0.5 * angle), rod(0.5 * angle), hit];
            for law in [ImpactLaw::Simultaneous, ImpactLaw::Hybrid, ImpactLaw::SerialGrouped] {
                let mut impact = Impact::new();
                impact.set_rows(rows);
                law.resolve(&mut impact, ImpactOrder::Fastest, 0).expect("an answer");
                let impulse = if is_fixed { 4.0 } else { 2.0 };
                let off = impact.impulses()[2] - impulse;
                assert!(off.abs() < 1e-7, "{law:?}, {angle:e}: off by {off:e} N s");
            }
        }
    }

    #[test]
    fn rows_without_an_answer_are_left_to_others() {
        // Two fixed jaws that close on a disc at 1 m/s each.
        let jaw = |angle: f64| CollisionRow { rate: -1.0, ..leaning(angle, [0.0; 2], 0.0) };
        let mut near = NearRows::default();
        for row in [jaw(0.0), jaw(std::f64::consts::PI)] {
            near.push(&row, -1.0);
        }
        assert!(!near.solve());
    }

    proptest! {
        #[test]
        fn the_answer_is_complementary(
            angles in prop::collection::vec((-8.0..0.0f64, any::<bool>()), 2..8),
            offsets in prop::array::uniform8(-1.0..0.2f64),
            arms in prop::array::uniform8(-1.0..1.0f64),
        ) {
            // Rows of one body that push upwards, of angles from 1e-8 to 1 rad: they always have an answer.
            let mut near = NearRows::default();
            let body = InverseInertia { inverse_mass: 1.0, inverse_moment: 3.0 };
            for (place, &(power, left)) in angles.iter().enumerate() {
                let angle = 10f64.powf(power) * if left { -1.0 } else { 1.0 };
                let (sin, cos) = angle.sin_cos();
                let jacobian = [sin, cos, arms[place], 0.0, 0.0, 0.0];
                near.push(&CollisionRow::new([BodyId(0), BodyId::WORLD], jacobian, [body, FIXED], 0.0), offsets[place]);
            }
            prop_assert!(near.solve());
            for row in 0..angles.len() {
                let (rate, force) = (near.rate[row].nearest(), near.force[row].nearest());
                prop_assert!(force >= 0.0 && rate >= -1e-5, "{rate:e}, {force:e}");
                prop_assert!(force == 0.0 || rate.abs() < 1e-13, "{rate:e}, {force:e}");
            }
        }
    }
}
