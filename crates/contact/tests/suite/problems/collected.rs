//! Every collected problem by every method that claims its class, and all of them by the automatic choice.

use halfgap_contact::{
    Auto, Contradiction, DualActiveSet, Lemke, ProximalNewton, Settings, Solution, SolveError, Solver,
};

use super::data::{Case, collection, disproof, judge, scales};

/// True if an answer is good by the rules of the documentation, without allowance for contradictions.
fn judge_answer(case: &Case, solution: &Solution) -> Result<(), String> {
    let judged = judge(&case.problem, &solution.force);
    if !judged.good() {
        return Err(format!("{}: {judged:?}, inconsistency {:e}", case.name, solution.inconsistency));
    }
    agrees_with_reference(case, solution)
}

/// Accelerations are unique for a symmetric problem, so they must be those of the reference.
fn agrees_with_reference(case: &Case, solution: &Solution) -> Result<(), String> {
    let (s, scale) = scales(&case.problem);
    if let Some(expected) = &case.file.expected {
        let tolerance = expected.tolerance.unwrap();
        for (row, a) in expected.acceleration.as_ref().unwrap().iter().enumerate() {
            let difference = (a - solution.acceleration[row]).abs();
            if difference > tolerance {
                return Err(format!("{}: acceleration {row} differs by {difference:e}", case.name));
            }
        }
    }
    if let (Some(force), true) = (&case.file.reference_force, case.problem.is_symmetric()) {
        let a = case.problem.dense();
        for (row, entries) in a.iter().enumerate() {
            let reference =
                entries.iter().zip(force).map(|(x, f)| x * f).sum::<f64>() + case.problem.offset()[row];
            let difference = (reference - solution.acceleration[row]).abs() / s[row] / scale;
            if difference > 1e-9 {
                return Err(format!("{}: acceleration {row} differs by {difference:e}", case.name));
            }
        }
    }
    Ok(())
}

/// Solves all cases of a class and checks each answer, and each certificate of a problem known to be infeasible.
fn solve_all(solver: &mut dyn Solver, claims: impl Fn(&Case) -> bool) -> usize {
    let mut solution = Solution::new();
    let mut failures = Vec::new();
    let cases: Vec<Case> = collection().into_iter().filter(claims).collect();
    for case in &cases {
        match solver.solve(&case.problem, &mut solution) {
            Ok(()) if case.feasible() => failures.extend(judge_answer(case, &solution).err()),
            Err(SolveError::Infeasible(proof)) if !case.feasible() => {
                failures.extend(
                    disproof(&case.problem, &proof.direction).map(|why| format!("{}: {why}", case.name)),
                );
            }
            other => failures.push(format!("{}: {other:?}", case.name)),
        }
    }
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
    cases.len()
}

#[test]
fn the_dual_active_set_solves_every_symmetric_problem() {
    let solved = solve_all(&mut DualActiveSet::default(), |case| case.problem.is_symmetric());
    assert_eq!(solved, 190);
}

#[test]
fn the_proximal_method_solves_every_problem_of_bodies() {
    let solved = solve_all(&mut ProximalNewton::default(), |case| case.problem.has_bodies());
    assert_eq!(solved, 88);
}

#[cfg(feature = "qp")]
#[test]
fn quadratic_programming_solves_problems_of_bodies_and_small_matrices() {
    let claims =
        |case: &Case| case.problem.has_bodies() || (case.problem.is_symmetric() && case.problem.len() <= 100);
    solve_all(&mut halfgap_contact::Qp::default(), claims);
}

#[test]
fn lemke_solves_unsymmetric_problems() {
    solve_all(&mut Lemke::default(), |case| !case.problem.is_symmetric() && case.problem.len() <= 800);
}

#[test]
fn the_automatic_choice_solves_everything() {
    assert_eq!(solve_all(&mut Auto::default(), |_| true), 229);
}

#[test]
fn nearly_redundant_contacts_that_defeat_textbook_pivoting_are_solved() {
    let case = Case::named("run__do_nothing_error_0");
    let mut solution = Solution::new();
    Auto::default().solve(&case.problem, &mut solution).unwrap();
    let judged = judge(&case.problem, &solution.force);
    assert!(judged.good(), "{judged:?}");
}

#[test]
fn contacts_that_contradict_each_other_are_solved_as_given_or_by_least_squares() {
    let names = ["contact__matrix19_cf", "contact__matrix20_cf", "contact__matrix21_cf"];
    for name in names.into_iter().chain(["run__do_nothing_grinder_test1_2"]) {
        let case = Case::named(name);
        let mut solution = Solution::new();
        DualActiveSet::default().solve(&case.problem, &mut solution).unwrap();
        let judged = judge(&case.problem, &solution.force);
        assert!(judged.good() && judged.growth < 1e6, "{name}: {judged:?}");
        let settings = Settings { contradiction: Contradiction::LeastSquares, ..Settings::default() };
        DualActiveSet::new(settings).unwrap().solve(&case.problem, &mut solution).unwrap();
        let judged = judge(&case.problem, &solution.force);
        assert!(
            judged.growth < 1e3 && judged.natural - solution.inconsistency <= 1e-12,
            "{name}: {judged:?}"
        );
        assert!(solution.inconsistency < 1e-9, "{name}: {:e}", solution.inconsistency);
    }
}
