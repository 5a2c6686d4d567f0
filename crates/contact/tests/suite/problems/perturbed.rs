//! Variations of the collected problems of bodies: every coefficient changed a little, so that redundant
//! contacts become nearly redundant ones, which are harder.

use halfgap_contact::{Auto, Problem, Solution, SolveError, Solver};

use super::data::{Case, collection, disproof, judge};

/// The problem with every coefficient of J changed by up to `size` of itself, differently for each seed.
fn perturbed(case: &Case, size: f64, seed: usize) -> Problem {
    let golden = f64::midpoint(5.0_f64.sqrt(), 1.0);
    let part = |e: usize| 2.0 * (((e + 1) * (2 * seed + 1)) as f64 * golden).fract() - 1.0;
    let rows = case.file.j.as_ref().unwrap();
    let triplets: Vec<_> =
        rows.triplets.iter().enumerate().map(|(e, &(i, k, v))| (i, k, v * (1.0 + size * part(e)))).collect();
    let offset = case.file.b_next.as_ref().unwrap_or(&case.file.b);
    let mut problem =
        Problem::from_rows(&triplets, case.file.inverse_mass.as_ref().unwrap(), offset).unwrap();
    if let Some(bilateral) = &case.file.bilateral {
        problem.set_bilateral(bilateral).unwrap();
    }
    problem
}

#[test]
fn nearly_redundant_variations_are_solved_or_proven_infeasible() {
    let (mut auto, mut solution) = (Auto::default(), Solution::new());
    let mut failures = Vec::new();
    let mut count = 0;
    for case in collection().iter().filter(|case| case.problem.has_bodies() && case.problem.len() <= 1100) {
        for (seed, size) in [1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10].into_iter().enumerate() {
            let problem = perturbed(case, size, seed);
            count += 1;
            match auto.solve(&problem, &mut solution) {
                Ok(()) => {
                    let judged = judge(&problem, &solution.force);
                    let left = judged.natural - solution.inconsistency;
                    if !(judged.good() || (left <= 1e-12 && solution.inconsistency <= 1e-8)) {
                        failures.push(format!("{} {size:e}: {judged:?}", case.name));
                    }
                }
                // Some rows of a variation contradict each other truly: opposite sides of a disc, a joint given twice.
                Err(SolveError::Infeasible(proof)) => {
                    failures.extend(
                        disproof(&problem, &proof.direction).map(|why| format!("{}: {why}", case.name)),
                    );
                }
                Err(error) => failures.push(format!("{} {size:e}: {error}", case.name)),
            }
        }
    }
    assert!(failures.is_empty(), "{} of {count}:\n{}", failures.len(), failures.join("\n"));
}
