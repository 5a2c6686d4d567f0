//! Problems of a step with friction that sweeps do not bring to their residual, as where light bodies lie between heavy ones: solved to
//! rounding, if they are small.

use crate::rigid::stepping::rows::{StepRow, rate_along};
use crate::rigid::stepping::slips::StepSlip;
use crate::rigid::stepping::sweeps::sweep;
use halfgap_contact::{Auto, InverseInertia, Problem, ProblemBody, Row, Solution, Solver, WarmStart};

/// Largest number of contacts that are solved exactly: with more, sweeps take less time, and what they leave is stopped in the next step.
const MOST_CONTACTS: usize = 48;

/// The solver with its buffers.
#[derive(Clone, Debug, Default)]
pub(super) struct Exact {
    problem: Problem,
    solution: Solution,
    warm: WarmStart,
    solver: Auto,
    /// Velocities without the impulses of the problem.
    before: Vec<[f64; 3]>,
    start: Vec<f64>,
    /// Inertias of the bodies of the region.
    pub(super) inertias: Vec<InverseInertia>,
}

impl Exact {
    /// Does as [`sweep`]; where there is friction and a few contacts, to rounding if sweeps do not come to the residual.
    pub(super) fn sweep_or_solve(
        &mut self,
        (rows, slips): (&mut [StepRow], &mut [StepSlip]),
        velocities: &mut [[f64; 3]],
        residual: f64,
        acts: impl Fn(&StepRow) -> bool,
    ) {
        let may_solve = !slips.is_empty() && rows.len() <= MOST_CONTACTS;
        if may_solve {
            self.before.clear();
            self.before.extend_from_slice(velocities);
        }
        if sweep((&mut *rows, &mut *slips), velocities, (residual, 0.0), acts) || !may_solve {
            return;
        }
        self.pose(rows, slips);
        if self.run() {
            velocities.copy_from_slice(&self.before);
            self.take(rows, slips, velocities);
        }
    }

    fn run(&mut self) -> bool {
        self.warm.guess_forces(self.start.iter().map(|&force| Some(force)));
        let Self { problem, warm, solver, solution, .. } = self;
        solver.solve_from(problem, warm, solution).is_ok()
    }

    fn pose(&mut self, rows: &[StepRow], slips: &[StepSlip]) {
        let Self { problem, before, start, inertias, .. } = self;
        problem.clear();
        start.clear();
        for &inertia in inertias.iter() {
            // Inertias are those of bodies that were checked.
            let _ = problem.add_body(inertia);
        }
        let mut add =
            |places: [usize; 2], jacobian: &[f64; 6], offset: f64, of: Option<(usize, f64)>, impulse: f64| {
                let sides = places.map(|place| Some(place).filter(|&place| place < inertias.len()));
                let sides = sides.map(|place| Some(ProblemBody(u32::try_from(place?).ok()?)));
                let offset = rate_along(places, jacobian, before) + offset;
                let row = Row::between(sides, jacobian, offset)?;
                let row = of.map_or(row, |(normal, coefficient)| row.friction(normal, coefficient));
                let place = problem.add_row(&row).ok()?;
                start.push(impulse);
                Some(place)
            };
        for row in rows.iter().filter(|row| row.acts) {
            let normal = add(row.places, &row.jacobian, row.offset, None, row.impulse);
            let slip = row.slip.and_then(|slip| slips.get(slip as usize));
            if let (Some(normal), Some(slip)) = (normal, slip) {
                let StepSlip { jacobian, running, bounds: [coefficient, _], impulse, .. } = slip;
                add(row.places, jacobian, *running, Some((normal, *coefficient)), *impulse);
            }
        }
    }

    fn take(&self, rows: &mut [StepRow], slips: &mut [StepSlip], velocities: &mut [[f64; 3]]) {
        let mut forces = self.solution.force.iter().copied();
        for row in rows.iter_mut().filter(|row| row.acts) {
            row.impulse = forces.next().unwrap_or(0.0);
            row.push(velocities, row.impulse);
            if let Some(slip) = row.slip.and_then(|slip| slips.get_mut(slip as usize)) {
                slip.impulse = forces.next().unwrap_or(0.0);
                slip.push(row.places, velocities, slip.impulse);
            }
        }
    }
}
