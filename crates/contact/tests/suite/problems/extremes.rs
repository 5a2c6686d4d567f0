//! Extreme sizes and scales, degenerate and wrong problems.

use halfgap_contact::{
    Auto, DualActiveSet, InverseInertia, Problem, ProblemBody, ProblemError, Row, Settings, Solution,
    SolveError, Solver,
};

use super::data::{Case, judge};

fn solve(problem: &Problem) -> Result<Solution, SolveError> {
    let mut solution = Solution::new();
    Auto::default().solve(problem, &mut solution).map(|()| solution)
}

/// A box of width 1 m and 1 kg on `points` floor points.
fn box_on_floor(points: usize) -> Problem {
    let mut problem = Problem::new();
    let body = problem.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 6.0 }).unwrap();
    for i in 0..points {
        let arm = i as f64 / (points - 1) as f64 - 0.5;
        problem.add_row(&Row::new(body, [0.0, 1.0, arm], -9.81)).unwrap();
    }
    problem
}

#[test]
fn no_rows_have_no_forces() {
    let solution = solve(&Problem::new()).unwrap();
    assert!(solution.is_empty() && solution.residuals.natural == 0.0);
}

#[test]
fn one_row_stops_one_mass() {
    let problem = Problem::from_dense(&[vec![0.5]], &[-9.81]).unwrap();
    assert!((solve(&problem).unwrap().force[0] - 19.62).abs() < 1e-14);
}

#[test]
fn nothing_moves_without_a_right_hand_side() {
    let mut problem = box_on_floor(10);
    problem.set_offset(&[0.0; 10]).unwrap();
    assert_eq!(solve(&problem).unwrap().force, [0.0; 10]);
}

#[test]
fn a_matrix_of_rank_one_with_a_hundred_rows_is_solved() {
    let problem = Problem::from_dense(&vec![vec![2.0; 100]; 100], &[-9.81; 100]).unwrap();
    let solution = solve(&problem).unwrap();
    assert!((solution.force.iter().sum::<f64>() - 4.905).abs() < 1e-14);
    assert!(judge(&problem, &solution.force).good());
    assert!(judge(&box_on_floor(100), &solve(&box_on_floor(100)).unwrap().force).good());
}

#[test]
fn all_rows_bilateral_is_a_linear_system() {
    let mut problem = Problem::from_dense(&[vec![2.0, 1.0], vec![1.0, 3.0]], &[-5.0, 5.0]).unwrap();
    problem.set_bilateral(&[true, true]).unwrap();
    let force = solve(&problem).unwrap().force;
    assert!((force[0] - 4.0).abs() < 1e-14 && (force[1] + 3.0).abs() < 1e-14);
}

#[test]
fn mass_ratios_of_a_billion_are_solved() {
    for ratio in [1e6, 1e9] {
        for count in [2, 10, 40] {
            let mut problem = Problem::new();
            let bodies: Vec<ProblemBody> = (0..count)
                .map(|i| {
                    let inverse_mass = if i == count - 1 { 1.0 / ratio } else { 1.0 };
                    problem
                        .add_body(InverseInertia { inverse_mass, inverse_moment: 12.0 * inverse_mass })
                        .unwrap()
                })
                .collect();
            for (i, &upper) in bodies.iter().enumerate() {
                for arm in [-0.5, 0.5] {
                    let row = Row::new(upper, [0.0, 1.0, arm], if i == 0 { -9.81 } else { 0.0 });
                    let row = if i == 0 { row } else { row.against(bodies[i - 1], [0.0, -1.0, -arm]) };
                    problem.add_row(&row).unwrap();
                }
            }
            let solution = solve(&problem).unwrap();
            let judged = judge(&problem, &solution.force);
            assert!(judged.good(), "ratio {ratio:e}, {count} bodies: {judged:?}");
        }
    }
}

#[test]
fn units_from_1e_minus_12_to_1e12_make_no_difference() {
    let case = Case::named("pyramid_50");
    let file = case.file.j.as_ref().unwrap();
    let mass = case.file.inverse_mass.as_ref().unwrap();
    for exponent in [-12, -6, 6, 12] {
        let factor = 10.0_f64.powi(exponent);
        let scaled_mass: Vec<f64> = mass.iter().map(|w| w * factor).collect();
        let scaled_b: Vec<f64> = case.problem.offset().iter().map(|b| b / factor).collect();
        let problem = Problem::from_rows(&file.triplets, &scaled_mass, &scaled_b).unwrap();
        let judged = judge(&problem, &solve(&problem).unwrap().force);
        assert!(judged.good(), "{factor:e}: {judged:?}");
    }
}

#[test]
fn numbers_that_are_not_finite_are_named_by_their_row() {
    let wrong = Problem::from_dense(&[vec![1.0, 0.0], vec![0.0, f64::NAN]], &[0.0, 0.0]);
    assert!(matches!(wrong, Err(ProblemError::NotFinite { row: 1, .. })));
    let wrong = Problem::from_dense(&[vec![1.0, 0.0], vec![0.0, 1.0]], &[f64::INFINITY, 0.0]);
    assert!(matches!(wrong, Err(ProblemError::NotFinite { row: 0, .. })));
    let mut problem = box_on_floor(3);
    let row = Row::new(ProblemBody(0), [0.0, f64::NAN, 0.0], 0.0);
    let error = problem.add_row(&row).unwrap_err();
    assert!(error.to_string().starts_with("row 3:"), "{error}");
    assert_eq!(problem.len(), 3);
}

/// A pendulum's joint with its first row doubled, and the offset of the copy changed by the fraction `nudge` of
/// itself.
fn doubled_joint(nudge: f64) -> Problem {
    let mut problem = Problem::new();
    let body = problem.add_body(InverseInertia { inverse_mass: 0.5, inverse_moment: 3.0 }).unwrap();
    for (coefficients, offset) in
        [([1.0, 0.0, -0.4], 2.0), ([0.0, 1.0, 0.3], -9.81), ([1.0, 0.0, -0.4], 2.0 * (1.0 + nudge))]
    {
        problem.add_row(&Row::new(body, coefficients, offset).bilateral()).unwrap();
    }
    problem
}

#[test]
fn joints_that_contradict_each_other_by_rounding_are_solved_by_least_squares() {
    for nudge in [1e-12, 1e-10, 1e-9] {
        let problem = doubled_joint(nudge);
        let solution = solve(&problem).unwrap();
        // Half the nudge is left on either row, so neither is favoured.
        let left = [solution.acceleration[0], solution.acceleration[2]];
        assert!((left[0] + nudge).abs() < 1e-14 && (left[1] - nudge).abs() < 1e-14, "{left:?}");
        let expected = nudge / (0.5_f64 + 3.0 * 0.16).sqrt() / (9.81 / (0.5_f64 + 3.0 * 0.09).sqrt());
        assert!((solution.inconsistency / expected - 1.0).abs() < 1e-2, "{}", solution.inconsistency);
        assert!(solution.force.iter().all(|f| f.abs() < 100.0));
    }
}

#[test]
fn joints_that_contradict_each_other_for_good_are_infeasible() {
    for nudge in [1e-6, 1e-3, 1.0] {
        let error = solve(&doubled_joint(nudge)).unwrap_err();
        assert!(matches!(error, SolveError::Infeasible(_)), "{nudge:e}: {error}");
    }
}

#[test]
fn a_block_squeezed_by_walls_that_both_close_is_infeasible() {
    let mut problem = Problem::new();
    let body = problem.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 1.0 }).unwrap();
    problem.add_row(&Row::new(body, [1.0, 0.0, 0.0], -1.0)).unwrap();
    problem.add_row(&Row::new(body, [-1.0, 0.0, 0.0], -1.0)).unwrap();
    let SolveError::Infeasible(proof) = solve(&problem).unwrap_err() else { panic!("must be infeasible") };
    assert_eq!(proof.direction, [1.0, 1.0]);
    assert!(proof.least_growth() > 1e12);
}

#[test]
fn settings_that_are_not_positive_are_refused() {
    let settings = Settings { dependence: 0.0, ..Settings::default() };
    assert_eq!(DualActiveSet::new(settings).unwrap_err().field, "dependence");
}
