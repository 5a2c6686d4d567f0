//! Several contacts with friction at once: a problem of compression and one of restitution.
//!
//! Compression stops all rows without elasticity: impulses P. Restitution then adds elasticity times the normal ones, and
//! what more the contacts need to stay open, with friction bounded by mu times both: each is a problem with friction at
//! velocity level, which always has a solution, jammed or not. Compression never gains energy; should restitution, it gets
//! the largest share of its impulses with which it does not. Newton's hypothesis instead asks for the speeds of separation
//! in one problem, which may gain, and has no solution in a jam. Sources: S. D. Poisson, 1817; C. Glocker, F. Pfeiffer,
//! "Multiple impacts with friction in rigid multibody systems", Nonlinear Dynamics 7, 1995; C. Glocker, "Energetic
//! consistency conditions for standard impacts", Multibody System Dynamics 29, 2013.

use super::super::law::ImpactError;
use super::routh::Restitution;
use super::{Impact, Phase, Rough};
use crate::check::Residuals;
use crate::error::SolveError;
use crate::kind::RowKind;
use crate::problem::{Problem, Row};
use crate::row::CollisionRow;
use crate::settings::Settings;
use crate::solver::Method;

/// Bisections of the share of restitution, which is no exact number: it is as much as gains no energy.
const HALVINGS: usize = 6;
/// Energy [-] in units of the work of the impulses that is rounding.
const ROUNDING: f64 = 1e-13;

/// Impulses of the rows of a set, normal and tangential, and the rates after them.
type Found = (Vec<[f64; 2]>, Vec<[f64; 2]>);

impl Impact {
    /// Lets the rows of a set rebound together.
    pub(super) fn rebound_rough(&mut self, rough: &mut Rough, set: &[usize]) -> Result<(), ImpactError> {
        let elasticity: Vec<f64> = set
            .iter()
            .map(|&row| {
                let (data, rate) = (&self.rows[row], self.rates[row]);
                let rebounds = !data.is_bilateral() && rate < 0.0 && data.rebounds_at(-rate);
                if rebounds { data.elasticity } else { 0.0 }
            })
            .collect();
        if self.restitution == Restitution::Newton {
            let goals: Vec<f64> = set.iter().zip(&elasticity).map(|(&row, e)| -e * self.rates[row]).collect();
            if let Ok(found) = self.solve_set(rough, set, &goals, None) {
                self.take(rough, set, &found);
                return Ok(());
            }
        }
        let still = vec![0.0; set.len()];
        let compressed = self.solve_set(rough, set, &still, None)?;
        let full: Vec<f64> =
            elasticity.iter().zip(&compressed.0).map(|(e, impulses)| e * impulses[0]).collect();
        if full.iter().all(|&impulse| impulse == 0.0) {
            self.take(rough, set, &compressed);
            return Ok(());
        }
        let mut share = 1.0;
        let mut best = None;
        for halving in 0..HALVINGS {
            let least: Vec<f64> = full.iter().map(|impulse| share * impulse).collect();
            let found = self.restore(rough, set, &compressed, &least)?;
            let gains = self.gain(rough, set, &found);
            let step = 0.5_f64.powi(halving as i32 + 1);
            if gains {
                share -= step;
            } else {
                best = Some(found);
                if share == 1.0 {
                    break;
                }
                share += step;
            }
        }
        self.take(rough, set, best.as_ref().unwrap_or(&compressed));
        Ok(())
    }

    /// Stops the rows of a set together.
    pub(super) fn stop_rough(&mut self, rough: &mut Rough, set: &[usize]) -> Result<(), ImpactError> {
        let found = self.solve_set(rough, set, &vec![0.0; set.len()], None)?;
        self.take(rough, set, &found);
        Ok(())
    }

    /// Compression and restitution together, with at least the impulses `least` of restitution along the normals.
    fn restore(
        &mut self,
        rough: &mut Rough,
        set: &[usize],
        compressed: &Found,
        least: &[f64],
    ) -> Result<Found, ImpactError> {
        let (mut impulses, rates) =
            self.solve_set(rough, set, &vec![0.0; set.len()], Some((compressed, least)))?;
        impulses.iter_mut().zip(&compressed.0).for_each(|(sum, part)| {
            (0..2).for_each(|k| sum[k] += part[k]);
        });
        Ok((impulses, rates))
    }

    /// Solves the rows of a set, each to reach a rate. In restitution rates begin with those after compression, and each
    /// normal impulse is at least the given one.
    fn solve_set(
        &mut self,
        rough: &mut Rough,
        set: &[usize],
        goals: &[f64],
        restitution: Option<(&Found, &[f64])>,
    ) -> Result<Found, ImpactError> {
        rough.begin_problem();
        let before: Vec<[f64; 2]> = match restitution {
            Some(((_, rates), _)) => rates.clone(),
            None => set.iter().map(|&row| [self.rates[row], rough.slips[row]]).collect(),
        };
        for (at, &row) in set.iter().enumerate() {
            let place = rough.list(&self.rows, row, before[at][0] - goals[at]);
            let least = restitution.map_or(0.0, |(_, least)| least[at]);
            if let Some(place) = place.filter(|_| least > 0.0) {
                let kind = RowKind::Bounded { least, most: f64::INFINITY };
                rough.problem.set_kind(place, kind).map_err(|_| unsolved(set.len()))?;
            }
            if let Some(place) = place {
                rough.list_friction(row, before[at][1], place);
            }
        }
        let phase = if restitution.is_some() { Phase::Restitution } else { Phase::Compression };
        rough.solve(self.rows.len(), Some(phase))?;
        self.solves += 1;
        let (mut impulses, mut rates) = (vec![[0.0; 2]; set.len()], before);
        let mut at = 0;
        for (&(row, is_tangential), (&force, &rate)) in
            rough.listed.iter().zip(rough.solution.force.iter().zip(&rough.solution.acceleration))
        {
            while set[at] != row {
                at += 1;
            }
            let k = usize::from(is_tangential);
            impulses[at][k] = force;
            rates[at][k] = if is_tangential { rate } else { rate + goals[at] };
        }
        Ok((impulses, rates))
    }

    /// Whether impulses gain energy: the sum over rows of impulse times the mean of the rates before and after.
    fn gain(&self, rough: &Rough, set: &[usize], (impulses, rates): &Found) -> bool {
        let (mut sum, mut terms) = (0.0, 0.0);
        for (at, &row) in set.iter().enumerate() {
            for (k, before) in [self.rates[row], rough.slips[row]].into_iter().enumerate() {
                sum += 0.5 * impulses[at][k] * (before + rates[at][k]);
                terms += impulses[at][k].abs() * (before.abs() + rates[at][k].abs());
            }
        }
        sum > ROUNDING * terms
    }

    /// Applies impulses.
    fn take(&mut self, rough: &mut Rough, set: &[usize], (impulses, rates): &Found) {
        for (at, &row) in set.iter().enumerate() {
            self.impulses[row] += impulses[at][0];
            rough.loss -= 0.5 * impulses[at][1] * (rough.slips[row] + rates[at][1]);
            rough.push(&self.rows, row, impulses[at]);
        }
        self.renew_rates(rough);
    }
}

impl Rough {
    /// Begins a problem of the bodies.
    pub(super) fn begin_problem(&mut self) {
        self.problem.clear();
        self.listed.clear();
        for &inertia in self.motions.inertia() {
            // Inverse inertia is that of rows that were checked.
            let _ = self.problem.add_body(inertia);
        }
    }

    /// Adds the normal row of a row, with an offset. Returns its place in the problem.
    pub(super) fn list(&mut self, rows: &[CollisionRow], row: usize, offset: f64) -> Option<usize> {
        let sides = self.motions.sides(row).map(|side| side.map(crate::problem::ProblemBody));
        let made = Row::between(sides, &rows[row].jacobian, offset);
        let third = self.motions.third(row).map(crate::problem::ProblemBody).zip(rows[row].third);
        let made = match third {
            Some((body, third)) => Some(Row::turning(made, body, third.jacobian, offset)),
            None => made,
        }?;
        let made = if rows[row].is_bilateral() { made.bilateral() } else { made };
        let place = self.problem.add_row(&made).ok()?;
        self.listed.push((row, false));
        Some(place)
    }

    /// Adds the tangential row of a row behind its normal one, if it has friction.
    fn list_friction(&mut self, row: usize, offset: f64, normal: usize) {
        let Some(friction) = self.rows[row] else { return };
        let sides = self.motions.sides(row).map(|side| side.map(crate::problem::ProblemBody));
        let made = Row::between(sides, &friction.jacobian, offset);
        let added =
            made.and_then(|made| self.problem.add_row(&made.friction(normal, friction.coefficient)).ok());
        if added.is_some() {
            self.listed.push((row, true));
        }
    }

    /// Solves the problem, beginning with the last solution of the same rows in the same phase, if it is of one.
    pub(super) fn solve(&mut self, rows: usize, phase: Option<Phase>) -> Result<(), ImpactError> {
        let Self { problem, solution, solver, warm, listed, known, .. } = self;
        // Rates have the rounding of the fastest one, however slow the rows of this problem are.
        let rates = (0..problem.len()).map(|row| (problem.offset()[row] / problem.row_scale(row)).abs());
        let slowest = rates.fold(0.0, f64::max);
        let residual = Settings::default().natural_residual;
        let allowed = if slowest > 0.0 { residual * (self.fastest / slowest).max(1.0) } else { residual };
        solver.set_natural_residual(allowed);
        let mut known = phase.map(|phase| &mut known[phase as usize]);
        let near = known.as_ref().filter(|known| known.listed == *listed && !listed.is_empty());
        // What modes did not solve, they will not solve now.
        let without_modes = near.is_some_and(|known| known.is_hard);
        if !(without_modes && solver.solve_by_lemke(problem, solution)) {
            let start = near.map(|known| {
                warm.guess_forces(known.forces.iter().map(|&force| Some(force)));
                &*warm
            });
            solver.solve(problem, start, solution).map_err(|error| error_of(&error, problem, rows))?;
        }
        if let Some(known) = &mut known {
            known.listed.clone_from(listed);
            known.forces.clone_from(&solution.force);
            known.is_hard = solution.method != Method::Modes;
        }
        Ok(())
    }
}

fn unsolved(rows: usize) -> ImpactError {
    ImpactError::Unsolved { rows, residuals: Residuals::default() }
}

fn error_of(error: &SolveError, problem: &Problem, rows: usize) -> ImpactError {
    match error {
        SolveError::Infeasible(proof) => {
            let scale = problem.offset().iter().fold(0.0, |most: f64, b| most.max(b.abs()));
            ImpactError::Infeasible { row: proof.row, contradiction: proof.contradiction * scale }
        }
        &SolveError::NoModes { combinations } => ImpactError::DrawnIn { combinations },
        SolveError::Unsolved { residuals, .. } => ImpactError::Unsolved { rows, residuals: *residuals },
        _ => unsolved(rows),
    }
}
