//! The choice of forces where redundant contacts leave several.

use halfgap_contact::{Auto, ForceSelection, InverseInertia, Problem, Row, Settings, Solution, Solver};

use super::data::{Case, judge};

fn least_norm() -> Auto {
    Auto::new(Settings { selection: ForceSelection::LeastNorm, ..Settings::default() }).unwrap()
}

#[test]
fn a_box_on_many_points_is_carried_symmetrically() {
    let mut problem = Problem::new();
    let body = problem.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 6.0 }).unwrap();
    for i in 0..9 {
        let arm = f64::from(i) / 8.0 - 0.5;
        problem.add_row(&Row::new(body, [0.0, 1.0, arm], -9.81)).unwrap();
    }
    let mut solution = Solution::new();
    least_norm().solve(&problem, &mut solution).unwrap();
    assert!(judge(&problem, &solution.force).good());
    for i in 0..9 {
        assert!(solution.force[i] > 0.5, "{:?}", solution.force);
        assert!((solution.force[i] - solution.force[8 - i]).abs() < 1e-7, "{:?}", solution.force);
    }
}

#[test]
fn least_norm_forces_are_right_and_no_longer_than_others() {
    for name in ["pyramid_20", "pyramid_50", "redundant_floor_50", "wall_20", "run__six_blocks_settle_0"] {
        let case = Case::named(name);
        let scaled = |solution: &Solution| {
            let a = case.problem.dense();
            (0..a.len()).map(|i| a[i][i] * solution.force[i].powi(2)).sum::<f64>().sqrt()
        };
        let (mut vertex, mut least) = (Solution::new(), Solution::new());
        Auto::default().solve(&case.problem, &mut vertex).unwrap();
        least_norm().solve(&case.problem, &mut least).unwrap();
        assert!(judge(&case.problem, &least.force).good(), "{name}");
        assert!(scaled(&least) <= scaled(&vertex) * (1.0 + 1e-12), "{name}");
    }
}
