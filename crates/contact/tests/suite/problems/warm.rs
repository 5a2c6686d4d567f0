//! Warm starts: the same answer, whatever has changed about the contacts in between.

use halfgap_contact::{
    Auto, ContactKey, DualActiveSet, InverseInertia, Problem, ProximalNewton, Row, Solution, Solver,
    WarmStart,
};

use super::data::{Case, collection, judge};

#[test]
fn a_warm_start_finds_the_next_answer() {
    let (mut solution, mut warm) = (Solution::new(), WarmStart::new());
    let mut auto = Auto::default();
    for case in collection().iter().filter(|case| case.file.b_next.is_some()) {
        auto.solve(&case.problem, &mut solution).unwrap();
        warm.remember(&case.problem, &solution);
        let next = case.next();
        auto.solve_from(&next, &warm, &mut solution).unwrap();
        let judged = judge(&next, &solution.force);
        assert!(judged.good(), "{}: {judged:?}", case.name);
    }
}

/// Blocks of 1 kg in a row on a floor, two corners each, keyed by corner.
fn blocks(names: &[u64]) -> Problem {
    let mut problem = Problem::new();
    for &name in names {
        let body = problem.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 6.0 }).unwrap();
        for (corner, arm) in [(0, -0.5), (1, 0.5)] {
            let key = ContactKey(2 * name + corner);
            problem.add_row(&Row::new(body, [0.0, 1.0, arm], -9.81).with_key(key)).unwrap();
        }
    }
    problem
}

#[test]
fn contacts_are_found_again_by_their_keys() {
    let mut solver = DualActiveSet::default();
    let (mut solution, mut warm) = (Solution::new(), WarmStart::new());
    let before = blocks(&[7, 3, 5]);
    solver.solve(&before, &mut solution).unwrap();
    warm.remember(&before, &solution);
    let after = blocks(&[5, 9, 7, 3]);
    solver.solve_from(&after, &warm, &mut solution).unwrap();
    assert!(solution.force.iter().all(|f| (f - 4.905).abs() < 1e-12));
}

#[test]
fn keys_of_a_matrix_tell_which_of_its_rows_carried_a_force() {
    let mut solver = DualActiveSet::default();
    let (mut solution, mut warm) = (Solution::new(), WarmStart::new());
    // A problem that takes a while.
    let mut iterations = |case: &&Case| {
        let solved = case.problem.len() < 60 && solver.solve(&case.problem, &mut solution).is_ok();
        solved && solution.iterations > 3
    };
    let cases = collection();
    let case = cases.iter().find(|case| iterations(case)).expect("there are such problems");
    let (matrix, offset) = (case.problem.dense(), case.problem.offset());
    // The same rows in two orders, each with its name.
    let problem = |order: &[usize]| {
        let entries: Vec<Vec<f64>> =
            order.iter().map(|&i| order.iter().map(|&j| matrix[i][j]).collect()).collect();
        let offset: Vec<f64> = order.iter().map(|&row| offset[row]).collect();
        let mut problem = Problem::from_dense(&entries, &offset).unwrap();
        let keys: Vec<_> = order.iter().map(|&row| ContactKey(row as u64)).collect();
        assert!(problem.set_keys(&keys[1..]).is_err());
        problem.set_keys(&keys).unwrap();
        problem
    };
    let count = offset.len();
    let before = problem(&(0..count).collect::<Vec<_>>());
    solver.solve(&before, &mut solution).unwrap();
    warm.remember(&before, &solution);
    let after = problem(&(0..count).rev().collect::<Vec<_>>());
    solver.solve(&after, &mut solution).unwrap();
    let cold = solution.iterations;
    solver.solve_from(&after, &warm, &mut solution).unwrap();
    assert!(solution.iterations < cold, "{} iterations, {cold} without", solution.iterations);
}

#[test]
fn a_misleading_warm_start_does_no_harm() {
    let case = Case::named("wall_20");
    let (mut right, mut solution, mut warm) = (Solution::new(), Solution::new(), WarmStart::new());
    let mut solver = DualActiveSet::default();
    solver.solve(&case.problem, &mut right).unwrap();
    // Every closed row is guessed open, and every open row closed.
    let mut wrong = right.clone();
    wrong.active = (0..case.problem.len()).filter(|row| !right.active.contains(row)).collect();
    warm.remember(&case.problem, &wrong);
    solver.solve_from(&case.problem, &warm, &mut solution).unwrap();
    for (a, b) in solution.acceleration.iter().zip(&right.acceleration) {
        assert!((a - b).abs() < 1e-11);
    }
}

#[test]
fn a_right_guess_needs_no_pivots() {
    let case = Case::named("run__pile_10_random_blocks_0");
    let (mut cold, mut solution, mut warm) = (Solution::new(), Solution::new(), WarmStart::new());
    let mut solver = DualActiveSet::default();
    solver.solve(&case.problem, &mut cold).unwrap();
    warm.guess((0..case.problem.len()).map(|row| Some(cold.active.contains(&row))));
    solver.solve_from(&case.problem, &warm, &mut solution).unwrap();
    assert_eq!(solution.iterations, 0, "{} without a guess", cold.iterations);
    assert!(cold.iterations > 0);
    // A guess of which nothing is known does as well as none.
    warm.guess((0..case.problem.len()).map(|_| None));
    solver.solve_from(&case.problem, &warm, &mut solution).unwrap();
    assert_eq!(solution.iterations, cold.iterations);
}

#[test]
fn a_guess_that_is_far_off_or_no_number_does_no_harm() {
    let (mut cold, mut solution, mut warm) = (Solution::new(), Solution::new(), WarmStart::new());
    let mut solver = ProximalNewton::default();
    let mut solved = 0;
    for case in collection().iter().filter(|case| case.problem.has_bodies() && case.problem.len() < 100) {
        if solver.solve(&case.problem, &mut cold).is_err() {
            continue;
        }
        solved += 1;
        for guess in [1e300, f64::INFINITY, f64::NAN] {
            warm.guess_forces((0..case.problem.len()).map(|_| Some(guess)));
            let outcome = solver.solve_from(&case.problem, &warm, &mut solution);
            assert_eq!(outcome, Ok(()), "{}, {guess}", case.name);
        }
    }
    assert!(solved > 20, "{solved} problems");
}
