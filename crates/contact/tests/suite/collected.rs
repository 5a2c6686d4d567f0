//! Every collected problem by every method that claims its class.

use halfgap_contact::{DualActiveSet, Solution, SolveError, Solver};

use crate::data::{Case, collection, judge};

/// Whether an answer is good by the rules of the documentation. Where dependent rows contradict each other, what is
/// left of that contradiction, reported with the answer, is not the solver's error.
fn acceptable(case: &Case, solution: &Solution) -> Result<(), String> {
    let judged = judge(&case.problem, &solution.force);
    let within = judged.natural - solution.inconsistency <= 1e-12 && solution.inconsistency <= 1e-8;
    if judged.good() || within { Ok(()) } else { Err(format!("{}: {judged:?}", case.name)) }
}

#[test]
fn the_dual_active_set_solves_every_symmetric_problem() {
    let mut solver = DualActiveSet::default();
    let mut solution = Solution::new();
    let mut failures = Vec::new();
    for case in collection().iter().filter(|case| case.problem.is_symmetric()) {
        match solver.solve(&case.problem, &mut solution) {
            Ok(()) if case.feasible() => failures.extend(acceptable(case, &solution).err()),
            Err(SolveError::Infeasible(_)) if !case.feasible() => {}
            other => failures.push(format!("{}: {other:?}", case.name)),
        }
    }
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}
