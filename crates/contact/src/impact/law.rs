//! The impact laws, and the steps that all of them share.

use super::many_rows::NEARLY;
use super::patience::{Patience, QUIET, RICOCHET};
use super::serial::{Grouping, Ricochet};
use super::shuffle::Shuffle;
use super::{Impact, NOISE};
use crate::check::Residuals;
use crate::row::CollisionRow;
use crate::words::{self, Words};
use halfgap_collision::geometry::Rounded;

/// Rule by which the rows of an impact are solved together or one after another. Rows at rest that no motion can open, those
/// of a body that fits exactly between others, are solved with each row that reaches them, by every law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum ImpactLaw {
    /// All rows that close or rest in one problem, with all connectors; repeated while rows still close.
    Simultaneous,
    /// One group of rows after another: the row that closes fastest with the others on its movable bodies that close at a
    /// comparable speed, at least a 32nd of its own, and all connectors that these reach through movable bodies.
    #[default]
    Hybrid,
    /// One row at a time, connectors too. The only law in which the elasticity of a connector acts. A pin is two rows
    /// along the axes of the world, and the result may depend on the directions of these axes.
    SerialSeparate,
    /// One row at a time, with all connectors that it reaches through movable bodies.
    SerialGrouped,
    /// `SerialSeparate`, then all rows together without elasticity.
    SerialSeparateLastpass,
    /// `SerialGrouped`, then all rows together without elasticity.
    SerialGroupedLastpass,
}

/// Order in which the laws that solve rows one after another select the next row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum ImpactOrder {
    /// The row that closes fastest first (a bilateral row counts with the size of its rate). Among rows within 1e-9 of
    /// the fastest, relative to it, the last in the list. That choice is arbitrary but fixed: rounding does not decide
    /// it, and equal runs are equal.
    #[default]
    Fastest,
    /// A random order from a seed; the same seed gives the same order.
    Seeded(u64),
}

/// An impact that could not be resolved.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum ImpactError {
    /// The numbers of a row are not those of a constraint between two bodies.
    #[error("row {row}: {rule}")]
    BadRow {
        /// Index of the row.
        row: usize,
        /// The rule that the numbers break.
        #[cfg_attr(feature = "save", serde(with = "crate::words"))]
        rule: Words,
    },
    /// A row closes, but neither of its bodies can move.
    #[error("row {row} closes at {} m/s, but neither of its bodies can move", Rounded(*closing))]
    Immovable {
        /// Index of the row.
        row: usize,
        /// Closing speed [m/s], or size of the rate of a bilateral row.
        closing: f64,
    },
    /// No impulses keep all rows from closing: for example a body between jaws that nothing stops.
    #[error(
        "row {row} cannot be kept from closing: the rows that hold it contradict it by {} m/s",
        Rounded(*contradiction)
    )]
    Infeasible {
        /// Index of the row at which the contradiction showed.
        row: usize,
        /// Size [m/s] of the least change of rates that would remove the contradiction.
        contradiction: f64,
    },
    /// The solver found no impulses that pass its check.
    #[error("no impulses of {rows} rows pass the check: {residuals}")]
    Unsolved {
        /// Number of rows that were solved together.
        rows: usize,
        /// Residuals of the last impulses.
        residuals: Residuals,
    },
    /// With friction no impulses exist: something driven or moved draws a body in between others, the harder the more
    /// it is pressed. Between bodies of finite mass there always are some.
    #[error(
        "no impulses keep the rows with friction from closing, none of the {combinations} combinations of modes does: what is driven or moved draws a body in, whatever resists it"
    )]
    DrawnIn {
        /// Number of combinations of modes (open, sticking, slipping either way), all of which were tried.
        combinations: u64,
    },
    /// A row still closes, or a bilateral one has a rate, after all attempts.
    #[error("row {row} is left at a rate of {} m/s, beyond the bound of {} m/s", Rounded(*rate), Rounded(*bound))]
    Unfinished {
        /// Index of the row.
        row: usize,
        /// Its rate [m/s], negative when closing.
        rate: f64,
        /// Greatest rate [m/s] that may be left.
        bound: f64,
    },
}

impl ImpactError {
    /// Index of the row that the error is about; `None` if it is about all of them.
    #[must_use]
    #[inline]
    pub fn row(&self) -> Option<usize> {
        match *self {
            Self::BadRow { row, .. }
            | Self::Immovable { row, .. }
            | Self::Infeasible { row, .. }
            | Self::Unfinished { row, .. } => Some(row),
            Self::Unsolved { .. } | Self::DrawnIn { .. } => None,
        }
    }
}

/// Rounding of a bound on rates, as a fraction of the bound. The bound is a residual of the solver, which is a rate
/// divided by the scales of row and problem, multiplied by these scales again: four products and quotients and a root,
/// each wrong by half a unit in the last place.
const ROUNDING_OF_BOUND: f64 = 4.0 * f64::EPSILON;

/// Number of passes without elasticity that may follow a law to bring rows to rest. Each pass after the first removes
/// the violations that the one before left by rounding or by nearly dependent rows.
pub(super) const FINAL_PASSES: usize = 4;

impl ImpactLaw {
    /// Finds the impulses of an impact. `impact_index` is the number of impacts before it in its run; with the order
    /// [`Seeded`](ImpactOrder::Seeded), each impact draws its own random numbers.
    ///
    /// Afterwards no unilateral row closes faster than [`Impact::bound`], and the rate of no bilateral row is larger.
    ///
    /// # Errors
    /// [`ImpactError`], mostly with the row whose numbers are invalid, that closes between immovable bodies, or that no
    /// impulses can keep from closing.
    pub fn resolve(
        self,
        impact: &mut Impact,
        order: ImpactOrder,
        impact_index: u64,
    ) -> Result<(), ImpactError> {
        if impact.is_rough {
            return impact.resolve_rough(self, order, impact_index);
        }
        let small = impact.begin()?;
        if impact.rows.len() == 1 {
            // The most common impact by far: all laws treat it alike, and it needs no buffers.
            impact.solve_single();
            return Ok(());
        }
        let mut shuffle = match order {
            ImpactOrder::Fastest => None,
            ImpactOrder::Seeded(seed) => Some(Shuffle::new(seed, impact_index)),
        };
        let slow = impact.slow_speed();
        let quiet = QUIET * slow;
        let mut patience = Patience::new(impact.blows(), impact.rows.len(), small.max(quiet), slow);
        if !matches!(self, ImpactLaw::SerialSeparate | ImpactLaw::SerialSeparateLastpass) {
            impact.settle_connectors(small)?;
        }
        // Rows at rest were brought to rest by earlier solves, which leave them rates up to this.
        let rest = small.max(quiet.min(NEARLY * impact.fastest));
        match self.grouping() {
            None => impact.solve_all(rest, &mut patience)?,
            Some(grouping) => {
                impact.keep_start();
                let begun = patience;
                if impact.solve_serially(grouping, shuffle.as_mut(), &mut patience)? == Ricochet::Returns {
                    // A last pass is meant to stop what would go to and fro between bodies that all can move.
                    if impact.find_locked_at_start(rest, self.has_last_pass()) {
                        patience = begun;
                    }
                    impact.solve_serially(grouping, shuffle.as_mut(), &mut patience)?;
                }
                if impact.has_few_contacts() && impact.still_rebounds(rest.max(NEARLY * impact.fastest)) {
                    // Walls at too small an angle. Together the rows turn the body back as that many blows would.
                    impact.start_again();
                    impact.solve_all(rest, &mut Patience::short(impact.rows.len(), small.max(quiet)))?;
                }
                impact.relieve_locked();
            }
        }
        if self.has_last_pass() {
            impact.solve_all_inelastic(small)?;
        }
        impact.finish(small)
    }

    pub(super) fn has_last_pass(self) -> bool {
        matches!(self, ImpactLaw::SerialSeparateLastpass | ImpactLaw::SerialGroupedLastpass)
    }

    /// The rows that join a focus; `None` if all rows are solved together.
    pub(super) fn grouping(self) -> Option<Grouping> {
        match self {
            ImpactLaw::Simultaneous => None,
            ImpactLaw::Hybrid => Some(Grouping::Closing),
            ImpactLaw::SerialSeparate | ImpactLaw::SerialSeparateLastpass => Some(Grouping::One),
            ImpactLaw::SerialGrouped | ImpactLaw::SerialGroupedLastpass => Some(Grouping::Connectors),
        }
    }
}

impl Impact {
    /// Resolves all rows together without elasticity: the bodies get the admissible motion that is nearest to their own
    /// in the energy norm. Ends accumulations of events.
    ///
    /// # Errors
    /// Those of [`ImpactLaw::resolve`].
    #[inline]
    pub fn resolve_inelastic(&mut self) -> Result<(), ImpactError> {
        if self.is_rough {
            return self.stop_all_rough();
        }
        let small = self.begin()?;
        self.solve_all_inelastic(small)?;
        self.finish(small)
    }

    /// Does as [`resolve_inelastic`](Self::resolve_inelastic), but gives up on problems that take more than about one
    /// pivot per row. For impacts that the caller can leave unresolved.
    ///
    /// # Errors
    /// Those of [`ImpactLaw::resolve`]; [`ImpactError::Unsolved`] also when the pivots run out.
    #[inline]
    pub fn try_inelastic(&mut self) -> Result<(), ImpactError> {
        self.is_trial = true;
        let outcome = self.resolve_inelastic();
        self.is_trial = false;
        outcome
    }

    /// Speed [m/s] below which no row rebounds: the least `velocity_tol`.
    pub(super) fn slow_speed(&self) -> f64 {
        self.rows.iter().map(|row| row.velocity_tol).fold(f64::INFINITY, f64::min)
    }

    /// Checks the rows, and returns the rate [m/s] up to which a row counts as done.
    pub(super) fn begin(&mut self) -> Result<f64, ImpactError> {
        if let Some((row, rule)) = self.find_bad_row() {
            return Err(ImpactError::BadRow { row, rule });
        }
        self.fastest = (0..self.rows.len()).fold(0.0f64, |most, row| most.max(self.violation(row)));
        let small = RICOCHET * self.fastest;
        self.bound = small;
        let stuck = (0..self.rows.len()).find(|&row| self.is_violated(row, small) && !self.can_move(row));
        match stuck {
            None => Ok(small),
            Some(row) => Err(ImpactError::Immovable { row, closing: self.violation(row) }),
        }
    }

    /// The first row with invalid numbers, and the rule that they break.
    fn find_bad_row(&self) -> Option<(usize, &'static str)> {
        let rule = |row: &CollisionRow| {
            let sum = row.rate + row.velocity_tol + row.response.iter().sum::<f64>();
            let (j, response) = row.third.map_or((0.0, 0.0), |third| (third.jacobian, third.response));
            let is_finite = (sum + row.jacobian.iter().sum::<f64>() + j + response).is_finite();
            if !row.kind.is_plain() {
                Some(words::PLAIN_ONLY)
            } else if !is_finite {
                Some(words::FINITE_ONLY)
            } else if !(0.0..=1.0).contains(&row.elasticity) {
                Some(words::ELASTICITY_RANGE)
            } else if j * response < 0.0
                || row.jacobian.iter().zip(&row.response).any(|(entry, response)| entry * response < 0.0)
            {
                Some(words::RESPONSE_SIGN)
            } else {
                None
            }
        };
        let of_row = |(index, row)| Some((index, rule(row)?));
        self.rows.iter().enumerate().find_map(of_row).or_else(|| self.find_bad_friction())
    }

    /// Keeps the rates and impulses with which the rows begin.
    pub(super) fn keep_start(&mut self) {
        self.scratch.start_rates.clone_from(&self.rates);
        self.scratch.start_impulses.clone_from(&self.impulses);
    }

    /// Goes back to the rates and impulses that were kept.
    pub(super) fn start_again(&mut self) {
        self.rates.clone_from(&self.scratch.start_rates);
        self.impulses.clone_from(&self.scratch.start_impulses);
    }

    /// Whether a contact closes faster than `slow` [m/s] and would rebound.
    fn still_rebounds(&self, slow: f64) -> bool {
        let rebounds =
            |row: usize| self.rows[row].elasticity > 0.0 && self.rows[row].rebounds_at(-self.rates[row]);
        (0..self.rows.len()).any(|row| self.is_violated(row, slow) && rebounds(row))
    }

    /// Solves an impact of one row: a contact rebounds, a connector comes to rest.
    fn solve_single(&mut self) {
        if self.violation(0) > 0.0 && self.can_move(0) {
            self.aim_at_rebounds(&[0]);
            self.solve_alone(0, self.scratch.targets[0]);
        }
    }

    /// Slack [m/s] for comparing a rate with a bound that may come from the solver's residual: the rounding of the
    /// bound, and that of the terms of the rate, which `apply` adds up in another order than the solver. The least
    /// normal number covers rates below it, where rounding is not relative and a bound that is a fraction of the rate
    /// is 0.
    fn rounding_of_rates(&self, bound: f64) -> f64 {
        f64::MIN_POSITIVE + ROUNDING_OF_BOUND * bound + NOISE * self.largest_change
    }

    /// Stops the rows that are still violated, without elasticity, and sets the bound.
    fn finish(&mut self, small: f64) -> Result<(), ImpactError> {
        for _ in 0..FINAL_PASSES {
            if !self.is_any_violated(small) {
                break;
            }
            self.solve_all_inelastic(small)?;
        }
        if self.unfinished().is_some() {
            self.at_last = true;
            let outcome = self.solve_all_inelastic(small);
            self.at_last = false;
            outcome?;
        }
        self.conclude(small)
    }

    /// Sets the bound by what is left.
    pub(super) fn conclude(&mut self, small: f64) -> Result<(), ImpactError> {
        let violation = (0..self.rows.len()).fold(0.0f64, |most, row| most.max(self.violation(row)));
        self.bound = self.rest(small).max(violation);
        self.unfinished().map_or(Ok(()), Err)
    }

    /// The error of the row with the greatest violation, if that exceeds the greatest that may be left.
    fn unfinished(&self) -> Option<ImpactError> {
        // Impulses that grew beyond all bounds.
        if let Some(row) = self.rates.iter().position(|rate| !rate.is_finite()) {
            return Some(ImpactError::Unfinished { row, rate: self.rates[row], bound: self.bound });
        }
        let row = (0..self.rows.len()).max_by(|&p, &q| self.violation(p).total_cmp(&self.violation(q)))?;
        let bound = self.rest(NEARLY * self.fastest);
        let is_left = self.violation(row) > bound + self.rounding_of_rates(bound);
        is_left.then(|| ImpactError::Unfinished { row, rate: self.rates[row], bound })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::InverseInertia;
    use halfgap_collision::BodyId;

    /// Ends an impact of a closing row between immovable bodies, where rates up to `noise` [m/s] are rounding.
    fn finish_at(closing: f64, noise: f64, largest_change: f64) -> Result<(), ImpactError> {
        let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        let jacobian = [0.0, 1.0, 0.0, 0.0, -1.0, 0.0];
        let bodies = [BodyId(0), BodyId::WORLD];
        let mut impact = Impact::new();
        impact.set_rows([CollisionRow {
            velocity_tol: 1e-3,
            ..CollisionRow::new(bodies, jacobian, [fixed; 2], -closing)
        }]);
        (impact.noise, impact.largest_change) = (noise, largest_change);
        impact.finish(0.0)
    }

    #[test]
    fn rows_with_numbers_that_no_row_can_have_are_named() {
        let disc = InverseInertia { inverse_mass: 1.0, inverse_moment: 1.0 };
        let row = |rate: f64, arm: f64, elasticity: f64| {
            let jacobian = [0.0, 1.0, arm, 0.0, -1.0, 0.0];
            CollisionRow {
                elasticity,
                velocity_tol: 1e-3,
                ..CollisionRow::new([BodyId(0), BodyId(1)], jacobian, [disc; 2], rate)
            }
        };
        let of_negative_mass =
            CollisionRow { response: [0.0, -0.5, 0.0, 0.0, 0.5, 0.0], ..row(-1.0, 0.0, 0.5) };
        for bad in
            [row(f64::NAN, 0.0, 0.5), row(-1.0, f64::INFINITY, 0.5), row(-1.0, 0.0, 2.0), of_negative_mass]
        {
            for rows in [vec![bad], vec![row(-1.0, 0.0, 0.5), bad]] {
                let last = rows.len() - 1;
                let mut impact = Impact::new();
                impact.set_rows(rows);
                let outcome = ImpactLaw::Hybrid.resolve(&mut impact, ImpactOrder::Fastest, 0);
                assert!(
                    matches!(outcome, Err(ImpactError::BadRow { row, .. }) if row == last),
                    "{outcome:?}"
                );
                assert!(matches!(impact.resolve_inelastic(), Err(ImpactError::BadRow { .. })));
            }
        }
    }

    #[test]
    fn rates_that_are_not_finite_are_never_finished() {
        for rate in [f64::NAN, -f64::NAN, f64::INFINITY] {
            let outcome = finish_at(rate, 1.0, 0.0);
            assert!(matches!(outcome, Err(ImpactError::Unfinished { row: 0, .. })), "{rate}: {outcome:?}");
        }
    }

    #[test]
    fn a_rate_that_is_the_bound_but_for_rounding_is_finished() {
        let (rate, bound) = (1.7162831790140682e-16, 1.716283179014068e-16);
        assert!(rate > bound);
        assert_eq!(finish_at(rate, bound, 0.0), Ok(()));
        assert_eq!(finish_at(1.5 * NOISE, NOISE, 1.0), Ok(()));
        assert!(matches!(
            finish_at((1.0 + 1e-14) * bound, bound, 0.0),
            Err(ImpactError::Unfinished { row: 0, .. })
        ));
        // The least positive number, in an impact so weak that all fractions of its speed are 0.
        assert_eq!(finish_at(f64::from_bits(1), 0.0, 0.0), Ok(()));
        assert!(finish_at(2.1 * NOISE, NOISE, 1.0).is_err());
    }
}
