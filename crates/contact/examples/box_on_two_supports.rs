//! A box on a floor: contact forces, a warm start for the next step, and the report of a contradiction.
//!
//! `cargo run -p halfgap-contact --example box_on_two_supports`

use halfgap_contact::{
    Auto, ContactKey, ForceSelection, InverseInertia, Problem, Row, Settings, Solution, SolveError, Solver,
    WarmStart,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A box of 2 kg and 1 m x 1 m, its centre of mass half a metre above the floor, on five points of the floor.
    let mut problem = Problem::new();
    let block = problem.add_body(InverseInertia { inverse_mass: 0.5, inverse_moment: 3.0 })?;
    for (key, arm) in [-0.5, -0.25, 0.0, 0.25, 0.5].into_iter().enumerate() {
        problem.add_row(&Row::new(block, [0.0, 1.0, arm], -9.81).with_key(ContactKey(key as u64)))?;
    }

    // Five contacts, two of which suffice: ask for the least forces rather than for any.
    let settings = Settings { selection: ForceSelection::LeastNorm, ..Settings::default() };
    let mut solver = Auto::new(settings)?;
    let mut solution = Solution::new();
    solver.solve(&problem, &mut solution)?;
    println!("forces [N]: {:.3?}", solution.force);
    println!("{}", solution.residuals);

    // The next step: the box is pushed to tip over its right edge. Contacts are found again by their keys.
    let mut warm = WarmStart::new();
    warm.remember(&problem, &solution);
    problem.set_offset(&[20.0, 5.0, -10.0, -25.0, -40.0])?;
    solver.solve_from(&problem, &warm, &mut solution)?;
    println!(
        "tipping, forces [N]: {:.3?}, accelerations [m/s²]: {:.3?}",
        solution.force, solution.acceleration
    );

    // No forces keep off a ceiling that comes down on the box; the combination of rows in the error proves it.
    problem.add_row(&Row::new(block, [0.0, -1.0, 0.0], -50.0))?;
    match solver.solve(&problem, &mut solution) {
        Err(SolveError::Infeasible(proof)) => {
            println!("{proof}; rows in these parts: {:.3?}", proof.direction)
        }
        other => println!("unexpected: {other:?}"),
    }
    Ok(())
}
