//! A block on a slope, with friction: it sticks, then it is pulled until it slips; a warm start for the next step.
//!
//! `cargo run -p halfgap-contact --example block_on_slope`

use halfgap_contact::{Auto, InverseInertia, Problem, Row, Solution, Solver, WarmStart};

const GRAVITY: f64 = 9.81;
const SLOPE: f64 = 0.3;
const MU: f64 = 0.31;

/// A block of 2 kg, 1 m wide and 0.5 m high, under its two lower corners; x runs down the slope. `pull` [N] acts down the
/// slope, too.
fn block(pull: f64) -> Result<Problem, Box<dyn std::error::Error>> {
    let mut problem = Problem::new();
    let block = problem.add_body(InverseInertia { inverse_mass: 0.5, inverse_moment: 4.8 })?;
    for x in [-0.5, 0.5] {
        let gap = Row::new(block, [0.0, 1.0, x], -GRAVITY * SLOPE.cos());
        let slip = Row::new(block, [-1.0, 0.0, -0.25], -GRAVITY * SLOPE.sin() - 0.5 * pull);
        problem.add_contact(&gap, &slip, MU)?;
    }
    Ok(problem)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut solver, mut solution, mut warm) = (Auto::default(), Solution::new(), WarmStart::new());
    for pull in [0.0, 0.1, 5.0] {
        let problem = block(pull)?;
        solver.solve_from(&problem, &warm, &mut solution)?;
        println!("pulled by {pull} N: normal and friction forces {:.3?} N", solution.force);
        println!("  slips with {:.3} m/s²; {}", -solution.acceleration[1], solution.residuals);
        warm.remember(&problem, &solution);
    }
    Ok(())
}
