//! The jump: the way on for contacts whose forces have no solution.
//!
//! A sliding contact may press itself the harder the more it pushes back (Painlevé). Then there are no forces, but
//! impulses: within an instant the sliding stops, without any collision. The problem at velocity level, taken over a short
//! time h, always has a solution: with a moment h its offsets are v + h b, with the rates v and the offsets b of the force
//! problem. Where there are forces its impulses are h times these; where there are none they change velocities at once.
//! (With h = 0 no impulses at all would be a solution.) Sources: J. J. Moreau, "Unilateral contact and dry friction in
//! finite freedom dynamics", 1988; F. Génot, B. Brogliato, "New results on Painlevé paradoxes", Eur. J. Mech. A 18, 1999.

use crate::error::{ProblemError, SolveError};
use crate::problem::Problem;
use crate::solution::Solution;
use crate::solver::Solver;

/// What a jump led to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jump {
    /// There are forces: the impulses are these times the moment, and modes that hold are those of the forces.
    Forces,
    /// Velocities jump: the impulses act at once.
    Impulses,
}

/// An error of a jump.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum JumpError {
    /// The rates are no rates of the problem.
    #[error("{0}")]
    Problem(#[from] ProblemError),
    /// The problem at velocity level was not solved.
    #[error("{0}")]
    Solve(#[from] SolveError),
}

impl Jump {
    /// Solves the force `problem` at velocity level over a `moment` \[s\], such as 1e-7 of the time scale, into `solution`:
    /// impulses [N·s] and the rates after them [m/s].
    ///
    /// `rates` [m/s] are those of the rows before. Contacts must have their own rows of friction, those that slip, too: a
    /// row with a turned force would keep on slipping.
    ///
    /// # Errors
    ///
    /// [`JumpError`]: there is not one finite rate a row, or `solver` found no answer.
    pub fn find(
        problem: &Problem,
        rates: &[f64],
        moment: f64,
        solver: &mut impl Solver,
        solution: &mut Solution,
    ) -> Result<Self, JumpError> {
        let mut jump = problem.clone();
        let offsets: Vec<f64> =
            rates.iter().zip(problem.offset()).map(|(rate, b)| rate + moment * b).collect();
        jump.set_offset(&offsets)?;
        solver.solve(&jump, solution)?;
        let largest =
            |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, |most: f64, x| most.max(x.abs()));
        let scale = |row: usize| problem.row_scale(row);
        let fast = largest(&mut rates.iter().enumerate().map(|(row, rate)| rate / scale(row)));
        let slow = largest(&mut problem.offset().iter().enumerate().map(|(row, b)| moment * b / scale(row)));
        let impulse = largest(&mut solution.force.iter().enumerate().map(|(row, f)| f * scale(row)));
        // Impulses of a size between those of forces and those that stop the motion are neither; none were seen.
        Ok(if impulse * impulse > fast * slow { Self::Impulses } else { Self::Forces })
    }
}
