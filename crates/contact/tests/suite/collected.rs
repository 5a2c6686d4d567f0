//! Every collected problem by every method that claims its class.

use halfgap_contact::{DualActiveSet, Solution, SolveError, Solver};

use crate::data::{collection, judge};

#[test]
fn the_dual_active_set_solves_every_symmetric_problem() {
    let mut solver = DualActiveSet::default();
    let mut solution = Solution::new();
    let mut failures = Vec::new();
    for case in collection().iter().filter(|case| case.problem.is_symmetric()) {
        let t = std::time::Instant::now();
        let r = solver.solve(&case.problem, &mut solution);
        let t = t.elapsed().as_secs_f64() * 1e6;
        match r {
            Ok(()) if case.feasible() => {
                let judged = judge(&case.problem, &solution.force);
                println!("{} n {} it {} {t:.1} us {:?}", case.name, case.problem.len(), solution.iterations, judged);
                if !judged.good() {
                    failures.push(format!("{}: {judged:?}", case.name));
                }
            }
            Err(SolveError::Infeasible(_)) if !case.feasible() => {}
            other => failures.push(format!("{}: {other:?}", case.name)),
        }
    }
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}
