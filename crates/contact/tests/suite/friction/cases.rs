//! Few contacts with answers in closed form, and the way on where there is no answer.

use super::judge::judge;
use halfgap_contact::{
    Auto, InverseInertia, Jump, Lemke, Modes, Problem, ProblemBody, Row, Solution, SolveError, Solver,
    WarmStart,
};

const LOAD: f64 = 9.81;

/// A block of 1 kg on a slope under its two lower corners, 1 m wide and 0.5 m high, pulled along the slope.
fn block_on_slope(angle: f64, mu: f64, pull: f64) -> Problem {
    let mut problem = Problem::new();
    let inertia = InverseInertia { inverse_mass: 1.0, inverse_moment: 12.0 / 1.25 };
    let block = problem.add_body(inertia).expect("a body");
    for arm in [-0.5, 0.5] {
        let normal = problem.add_row(&Row::new(block, [0.0, 1.0, arm], -LOAD * angle.cos())).expect("a row");
        // The tangent is the normal turned by +90 degrees: up the slope to the left.
        let along = Row::new(block, [-1.0, 0.0, 0.25], -(pull - LOAD * angle.sin()));
        problem.add_row(&along.friction(normal, mu)).expect("a row");
    }
    problem
}

fn solvers() -> [Box<dyn Solver>; 3] {
    [Box::new(Auto::default()), Box::new(Lemke::default()), Box::new(Modes::default())]
}

#[test]
fn a_block_sticks_within_its_cone_and_slips_beyond() {
    let (angle, mu) = (0.3_f64, 0.31);
    for mut solver in solvers() {
        let mut solution = Solution::new();
        for (pull, acceleration) in
            [(0.0, 0.0), (5.0, 0.0), (7.0, 7.0 - LOAD * (angle.sin() + mu * angle.cos()))]
        {
            let problem = block_on_slope(angle, mu, pull);
            solver.solve(&problem, &mut solution).expect("forces of a block");
            assert!((solution.acceleration[1] + acceleration).abs() < 1e-12, "{}", solver.method());
            assert!((solution.force[0] + solution.force[2] - LOAD * angle.cos()).abs() < 1e-12);
            assert!(judge(&problem, &solution.force).good());
        }
    }
}

#[test]
fn a_motor_pulls_with_what_it_has_and_holds_with_less() {
    for (load, force) in [(3.0, 3.0), (-1.5, -1.5), (8.0, 5.0), (-8.0, -2.0)] {
        for mut solver in solvers() {
            let mut problem = Problem::new();
            let body =
                problem.add_body(InverseInertia { inverse_mass: 0.5, inverse_moment: 2.0 }).expect("a body");
            problem.add_row(&Row::new(body, [1.0, 0.0, 0.0], -0.5 * load).bounded(-2.0, 5.0)).expect("a row");
            let mut solution = Solution::new();
            solver.solve(&problem, &mut solution).expect("a force of a motor");
            assert!((solution.force[0] - force).abs() < 1e-12, "{}, {load} N", solver.method());
        }
    }
}

#[test]
fn a_sliding_contact_is_a_row_with_a_turned_force() {
    // A block that slides to the right: friction acts to the left.
    let (mu, normal) = (0.25, [0.0, 1.0, 0.0]);
    let mut problem = Problem::new();
    let block = problem.add_body(InverseInertia { inverse_mass: 0.5, inverse_moment: 0.0 }).expect("a body");
    let row = Row::new(block, normal, -LOAD).with_force([-mu, 1.0, 0.0], [0.0; 3]);
    problem.add_row(&row).expect("a row");
    for mut solver in solvers() {
        let mut solution = Solution::new();
        solver.solve(&problem, &mut solution).expect("the force of a block");
        assert!((solution.force[0] - 2.0 * LOAD).abs() < 1e-12);
    }
}

/// A rod of length 2 m and 1 kg that stands on its lower end, tan(angle) = 2, and moves along the ground at 1 m/s so that
/// friction drives it into the ground (P. Painlevé 1895): the contact as two rows, and what slides as one turned row.
fn painleve_rod(mu: f64) -> (Problem, Problem) {
    let (cos, sin) = (1.0 / 5.0_f64.sqrt(), 2.0 / 5.0_f64.sqrt());
    let inertia = InverseInertia { inverse_mass: 1.0, inverse_moment: 3.0 };
    let arm = [-cos, -sin];
    let (normal, tangent) = ([0.0, 1.0, arm[0]], [-1.0, 0.0, arm[1]]);
    let fill = |rows: &dyn Fn(&mut Problem, ProblemBody)| {
        let mut problem = Problem::new();
        let rod = problem.add_body(inertia).expect("a body");
        rows(&mut problem, rod);
        problem
    };
    let at_rest = fill(&|problem, rod| {
        let contact = problem.add_row(&Row::new(rod, normal, -LOAD)).expect("a row");
        problem.add_row(&Row::new(rod, tangent, 0.0).friction(contact, mu)).expect("a row");
    });
    // It slides along its tangent, so friction acts against it.
    let push: [f64; 3] = std::array::from_fn(|k| normal[k] - mu * tangent[k]);
    let sliding = fill(&|problem, rod| {
        problem.add_row(&Row::new(rod, normal, -LOAD).with_force(push, [0.0; 3])).expect("a row");
    });
    (at_rest, sliding)
}

#[test]
fn a_rod_that_friction_drives_into_the_ground_has_no_force_but_a_jump() {
    // p = 1 + 3 cos (cos - mu sin) is negative from mu = 4/3 on.
    let (at_rest, sliding) = painleve_rod(1.2);
    let mut solution = Solution::new();
    Auto::default().solve(&sliding, &mut solution).expect("a force");
    assert!((solution.force[0] - LOAD / 0.16).abs() < 1e-9, "{}", solution.force[0]);
    let mut auto = Auto::default();
    let jump = Jump::find(&at_rest, &[0.0, 1.0], 1e-7, &mut auto, &mut solution).expect("impulses");
    assert_eq!(jump, Jump::Forces);
    assert!((solution.force[0] / 1e-7 - LOAD / 0.16).abs() < 1e-6 * LOAD / 0.16);

    let (at_rest, sliding) = painleve_rod(1.6);
    let error = auto.solve(&sliding, &mut solution).expect_err("there is none");
    let is_told = matches!(error, SolveError::Infeasible(_) | SolveError::NoModes { .. });
    assert!(is_told, "{error}");
    let jump = Jump::find(&at_rest, &[0.0, 1.0], 1e-7, &mut auto, &mut solution).expect("impulses");
    assert_eq!(jump, Jump::Impulses);
    // A^-1 (0, -1) in closed form, but for the moment of 1e-7 s.
    assert!((solution.force[0] - 0.3).abs() < 1e-6 && (solution.force[1] + 0.4).abs() < 1e-6, "{solution:?}");
}

#[test]
fn an_earlier_answer_is_found_again_at_once() {
    let (mut modes, mut solution, mut warm) = (Modes::default(), Solution::new(), WarmStart::new());
    for pull in [0.0, 7.0] {
        let problem = block_on_slope(0.3, 0.31, pull);
        modes.solve(&problem, &mut solution).expect("forces");
        warm.remember(&problem, &solution);
        let later = block_on_slope(0.3, 0.31, pull + 1e-3);
        modes.solve_from(&later, &warm, &mut solution).expect("forces");
        assert!(solution.iterations <= 2, "{} iterations", solution.iterations);
    }
}
