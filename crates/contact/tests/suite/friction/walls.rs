//! Walls and heaps at velocity level, which always have a solution.

use super::generated::{Random, heap, wall};
use super::judge::judge;
use halfgap_contact::{Auto, Lemke, Modes, Problem, Solution, Solver, WarmStart};

/// Solves by `solver` and judges the answer.
fn solve(solver: &mut dyn Solver, problem: &Problem, name: &str) -> Solution {
    let mut solution = Solution::new();
    let outcome = solver.solve(problem, &mut solution);
    outcome.unwrap_or_else(|error| panic!("{name} by {}: {error}", solver.method()));
    let judged = judge(problem, &solution.force);
    assert!(judged.good(), "{name} by {}: {judged:?}", solver.method());
    solution
}

#[test]
fn walls_and_heaps_are_solved_whatever_the_friction() {
    let mut random = Random::new(11);
    for seed in 0..60 {
        let mu = 0.05 * 40.0_f64.powf(random.between(0.0, 1.0));
        let (wide, high) = (random.between(2.0, 5.0) as usize, random.between(1.0, 7.0) as usize);
        let disorder = [0.0, 0.01, 0.1, 1.0][seed as usize % 4];
        let problem = wall(wide, high, mu, disorder, seed);
        let name = format!("wall {seed} of {wide} x {high}, mu {mu:.2}");
        solve(&mut Auto::default(), &problem, &name);
        solve(&mut Modes::default(), &problem, &name);
        let heap = heap(random.between(2.0, 25.0) as usize, mu, seed);
        solve(&mut Auto::default(), &heap, &format!("heap {seed}, mu {mu:.2}"));
        if problem.len() <= 60 {
            solve(&mut Lemke::default(), &problem, &name);
        }
    }
}

#[test]
fn large_walls_are_solved() {
    for (mu, disorder) in [(0.3, 0.1), (0.5, 0.0), (1.0, 0.1)] {
        let problem = wall(8, 12, mu, disorder, 7);
        assert!(problem.len() > 500);
        solve(&mut Auto::default(), &problem, &format!("mu {mu}, disorder {disorder}"));
    }
}

#[test]
fn forces_of_a_wall_at_rest_are_found_again_at_once() {
    let problem = wall(3, 4, 0.5, 0.0, 5);
    let (mut modes, mut warm) = (Modes::default(), WarmStart::new());
    let mut solution = solve(&mut modes, &problem, "a wall");
    warm.remember(&problem, &solution);
    modes.solve_from(&problem, &warm, &mut solution).expect("the same forces");
    assert_eq!(solution.iterations, 1);
}
