//! Impacts with friction.
//!
//! A contact with friction has a tangential row beside its normal one, with a slip speed and an impulse of its own. The laws
//! that solve rows one after another take the path of each contact's impulse (`routh`), through the connectors that it
//! reaches; several contacts at once are solved in two problems, of compression and of restitution (`phases`). `motion`
//! keeps what the impulses so far have done to the bodies. *Invariant*: an impact none of whose rows has friction does not
//! come here.

mod motion;
mod phases;
mod routh;
mod serial;

pub use routh::Restitution;

use super::Impact;
use super::law::{FINAL_PASSES, ImpactError, ImpactLaw, ImpactOrder};
use super::patience::Patience;
use super::shuffle::Shuffle;
use crate::friction::FrictionMethods;
use crate::problem::{InverseInertia, Problem};
use crate::row::{CollisionRow, response};
use crate::settings::Settings;
use crate::solution::Solution;
use crate::warm::WarmStart;
use crate::words;
use motion::BodyMotions;

/// The tangential row of a contact with friction.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct FrictionRow {
    /// J of the slip speed [1, 1, m, 1, 1, m], as that of the gap in [`CollisionRow::jacobian`].
    pub jacobian: [f64; 6],
    /// J M^-1 [1/kg, 1/kg, 1/(kg m), ...].
    pub response: [f64; 6],
    /// Slip speed before the impact [m/s].
    pub rate: f64,
    /// Coefficient of friction [-].
    pub coefficient: f64,
    /// Share of the slip speed that an impact gives back [-], 0 to 1.
    pub tangential_elasticity: f64,
}

impl FrictionRow {
    /// Makes the tangential row of a contact, without tangential elasticity, with the `inertia` of its primary and normal
    /// body (zeros for an immovable one), its slip speed `rate` [m/s], and its coefficient of friction.
    #[must_use]
    #[inline]
    pub fn new(jacobian: [f64; 6], inertia: [InverseInertia; 2], rate: f64, coefficient: f64) -> Self {
        let response = response(&jacobian, inertia);
        Self { jacobian, response, rate, coefficient, tangential_elasticity: 0.0 }
    }
}

/// What an impact with friction has beside its normal rows.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Rough {
    /// The tangential row of each row of the impact.
    rows: Vec<Option<FrictionRow>>,
    /// Slip speed [m/s] and tangential impulse [N s] by row; 0 without friction.
    slips: Vec<f64>,
    impulses: Vec<f64>,
    /// Energy [J] that friction took.
    loss: f64,
    /// The largest scaled rate at the start [m/s times the root of kg].
    fastest: f64,
    motions: BodyMotions,
    /// Rows that are solved together.
    problem: Problem,
    solution: Solution,
    solver: FrictionMethods,
    warm: WarmStart,
    /// The last solution of each phase: in a ricochet the same rows are solved many times.
    known: [Known; 2],
    /// Normal and tangential rows of the problem: (row of the impact, whether it is the tangential one).
    listed: Vec<(usize, bool)>,
}

/// A solution of some rows.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Known {
    listed: Vec<(usize, bool)>,
    forces: Vec<f64>,
    /// Modes did not find it.
    is_hard: bool,
}

/// A problem of several contacts.
#[derive(Clone, Copy, Debug)]
enum Phase {
    Compression,
    Restitution,
}

impl Impact {
    /// Gives a contact friction. Impulses along it are then found with those along the normal.
    ///
    /// # Panics
    ///
    /// If there is no such row.
    pub fn set_friction(&mut self, row: usize, friction: FrictionRow) {
        assert!(row < self.rows.len(), "row {row} of {}", self.rows.len());
        let count = self.rows.len();
        let rough = self.rough.get_or_insert_with(Box::default);
        if !self.is_rough {
            rough.clear(count);
            self.is_rough = true;
        }
        rough.rows[row] = Some(friction);
        rough.slips[row] = friction.rate;
    }

    /// Sets what elasticity means where there is friction, for this and all later impacts. Several contacts that are
    /// solved at once take [`Restitution::Poisson`] for [`Restitution::Energetic`].
    pub fn set_restitution(&mut self, restitution: Restitution) {
        self.restitution = restitution;
    }

    /// Impulse [N s] along the tangential row of a row; 0 if it has none.
    #[must_use]
    pub fn friction_impulse(&self, row: usize) -> f64 {
        self.rough().and_then(|rough| rough.impulses.get(row).copied()).unwrap_or(0.0)
    }

    /// The tangential row of each row with its impulse [N s], `None` for a row without friction; nothing where no row has some.
    pub fn friction(&self) -> impl Iterator<Item = Option<(&FrictionRow, f64)>> {
        let rough = self.rough().into_iter();
        let rows = rough.flat_map(|rough| rough.rows.iter().zip(&rough.impulses));
        rows.map(|(friction, &impulse)| Some((friction.as_ref()?, impulse)))
    }

    /// Slip speed [m/s] of a row after the impulses; 0 if it has no friction.
    #[must_use]
    pub fn slip_speed(&self, row: usize) -> f64 {
        self.rough().and_then(|rough| rough.slips.get(row).copied()).unwrap_or(0.0)
    }

    /// Energy \[J\] that friction took: of one contact after another along the paths of their impulses, of several at once
    /// by the mean of their slip speeds before and after.
    #[must_use]
    pub fn friction_loss(&self) -> f64 {
        self.rough().map_or(0.0, |rough| rough.loss)
    }

    /// The first row whose friction has invalid numbers, and the rule that they break.
    pub(super) fn find_bad_friction(&self) -> Option<(usize, &'static str)> {
        let is_bad = |friction: &FrictionRow| {
            let numbers = friction.jacobian.iter().chain(&friction.response).sum::<f64>() + friction.rate;
            let is_range = (0.0..f64::INFINITY).contains(&friction.coefficient)
                && (0.0..=1.0).contains(&friction.tangential_elasticity);
            !(numbers.is_finite() && is_range)
        };
        let rows = &self.rough()?.rows;
        let row = rows.iter().position(|friction| friction.as_ref().is_some_and(is_bad))?;
        Some((row, words::FRICTION_RANGE))
    }

    fn rough(&self) -> Option<&Rough> {
        self.rough.as_deref().filter(|_| self.is_rough)
    }

    /// Resolves an impact with friction by a law.
    #[cold]
    pub(super) fn resolve_rough(
        &mut self,
        law: ImpactLaw,
        order: ImpactOrder,
        impact_index: u64,
    ) -> Result<(), ImpactError> {
        let small = self.begin()?;
        let mut rough = self.rough.take().unwrap_or_default();
        self.load_rough(&mut rough);
        let outcome = self.resolve_with(&mut rough, law, order, impact_index, small);
        self.rough = Some(rough);
        outcome
    }

    fn resolve_with(
        &mut self,
        rough: &mut Rough,
        law: ImpactLaw,
        order: ImpactOrder,
        impact_index: u64,
        small: f64,
    ) -> Result<(), ImpactError> {
        let mut shuffle = match order {
            ImpactOrder::Fastest => None,
            ImpactOrder::Seeded(seed) => Some(Shuffle::new(seed, impact_index)),
        };
        let slow = self.slow_speed();
        let mut patience = Patience::new(self.blows(), self.rows.len(), small, slow);
        match law.grouping() {
            None => self.rebound_rough(rough, &self.all_movable())?,
            Some(grouping) => self.solve_rough(rough, grouping, shuffle.as_mut(), &mut patience)?,
        }
        self.finish_rough(rough, small)
    }

    /// Stops rows that are still violated: first as exactly as they can be; then rates may have the rounding of the fastest slip, however
    /// slowly the rows close.
    fn finish_rough(&mut self, rough: &mut Rough, small: f64) -> Result<(), ImpactError> {
        for _ in 0..FINAL_PASSES {
            if !self.is_any_violated(small) || self.stop_rough(rough, &self.all_movable()).is_err() {
                break;
            }
        }
        let longest = self.rows.iter().map(CollisionRow::square).fold(0.0, f64::max).sqrt();
        self.noise = self.noise.max(Settings::default().natural_residual * rough.fastest * longest);
        for _ in 0..FINAL_PASSES {
            if !self.is_any_violated(small) {
                break;
            }
            self.stop_rough(rough, &self.all_movable())?;
        }
        self.conclude(small)
    }

    /// Takes the rows, with the impulses that were subtracted from them.
    fn load_rough(&mut self, rough: &mut Rough) {
        rough.begin(&self.rows);
        let subtracted = self.impulses.iter().enumerate().filter(|(_, impulse)| **impulse != 0.0);
        let mut any = false;
        for (row, &impulse) in subtracted {
            rough.motions.add_row(row, &self.rows[row], impulse);
            any = true;
        }
        if any {
            self.renew_rates(rough);
        }
    }

    /// Stops all rows, with friction and without elasticity.
    #[cold]
    pub(super) fn stop_all_rough(&mut self) -> Result<(), ImpactError> {
        let small = self.begin()?;
        let mut rough = self.rough.take().unwrap_or_default();
        self.load_rough(&mut rough);
        let outcome = self.stop_rough(&mut rough, &self.all_movable());
        let outcome = outcome.and_then(|()| self.finish_rough(&mut rough, small));
        self.rough = Some(rough);
        outcome
    }

    fn all_movable(&self) -> Vec<usize> {
        (0..self.rows.len()).filter(|&row| self.can_move(row)).collect()
    }
}

impl Rough {
    fn clear(&mut self, rows: usize) {
        self.rows.clear();
        self.rows.resize(rows, None);
        for list in [&mut self.slips, &mut self.impulses] {
            list.clear();
            list.resize(rows, 0.0);
        }
        self.loss = 0.0;
    }

    fn begin(&mut self, rows: &[CollisionRow]) {
        self.motions.load(rows, &self.rows);
        self.known.iter_mut().for_each(|known| known.listed.clear());
        let scaled = |square: f64, rate: f64| if square > 0.0 { rate.abs() / square.sqrt() } else { 0.0 };
        let normal = rows.iter().map(|row| scaled(row.square(), row.rate));
        let along = self.rows.iter().flatten();
        let along = along.map(|friction| {
            let square = friction.jacobian.iter().zip(&friction.response).map(|(j, r)| j * r).sum();
            scaled(square, friction.rate)
        });
        self.fastest = normal.chain(along).fold(0.0, f64::max);
    }

    /// Adds impulses along the normal and the tangential row of a row to the bodies.
    fn push(&mut self, rows: &[CollisionRow], row: usize, [normal, tangential]: [f64; 2]) {
        self.motions.add_row(row, &rows[row], normal);
        if let Some(friction) = &self.rows[row] {
            self.motions.add(row, &friction.response, tangential);
            self.impulses[row] += tangential;
        }
    }
}
