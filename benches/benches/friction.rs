//! Problems with friction: walls of bricks at velocity level, cold, and warm from the answer of a step before.
//!
//! `cargo bench -p halfgap-benches --bench friction` prints a table in Markdown. Every time is the least of repeated solves,
//! in microseconds. "Next" has the relative velocities of a step later: every brick moves 1 % otherwise.
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on should stop")]

use halfgap_contact::{InverseInertia, Lemke, Modes, Problem, ProblemBody, Row, Solution, Solver, WarmStart};
use std::time::Instant;

/// Solves of one kind; Lemke's method is tried once, and not beyond so many contacts.
const REPEATED: usize = 20;
const LEMKE: usize = 200;

/// A wall of bricks, two contacts where one lies on another; velocities [m/s] are random by `disorder`, other ones each
/// `step`.
fn wall(wide: usize, high: usize, mu: f64, disorder: f64, step: f64) -> Problem {
    let mut problem = Problem::new();
    let mut below: Vec<(ProblemBody, f64, [f64; 3])> = Vec::new();
    let mut count = 0.0_f64;
    for layer in 0..high {
        let shift = 0.5 * (layer % 2) as f64;
        let mut bricks = Vec::new();
        for k in 0..wide - layer % 2 {
            let body = problem.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 9.6 }).unwrap();
            let mut own = || {
                count += 1.0;
                disorder * ((count * 12.9898).sin() + 0.01 * step * (count * 78.233).sin())
            };
            bricks.push((body, k as f64 + shift, [own(), own() - 0.04, own()]));
        }
        for &(body, center, velocity) in &bricks {
            let mut contact = |lower: Option<(ProblemBody, f64, [f64; 3])>, x: f64| {
                let rate = |c: [f64; 3], v: [f64; 3]| (0..3).map(|k| c[k] * v[k]).sum::<f64>();
                let (gap, slip) = ([0.0, 1.0, x - center], [-1.0, 0.0, -0.25]);
                let rows = [gap, slip].map(|c| Row::new(body, c, rate(c, velocity)));
                let rows = match lower {
                    None => rows,
                    Some((other, place, moving)) => {
                        let others = [[0.0, -1.0, place - x], [1.0, 0.0, -0.25]];
                        [0, 1].map(|k| {
                            let offset = rows[k].offset + rate(others[k], moving);
                            Row { offset, ..rows[k] }.against(other, others[k])
                        })
                    }
                };
                problem.add_contact(&rows[0], &rows[1], mu).unwrap();
            };
            if layer == 0 {
                [-0.49, 0.49].into_iter().for_each(|side| contact(None, center + side));
            }
            for &lower in &below {
                let (from, to) = (center.max(lower.1) - 0.49, center.min(lower.1) + 0.49);
                if from < to {
                    [from, to].into_iter().for_each(|x| contact(Some(lower), x));
                }
            }
        }
        below = bricks;
    }
    problem
}

/// The least time of some solves [µs].
fn least(times: usize, mut solve: impl FnMut()) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..times {
        let begin = Instant::now();
        solve();
        least = least.min(begin.elapsed().as_secs_f64());
    }
    1e6 * least
}

fn main() {
    println!("| contacts | mu | disorder [m/s] | cold | steps | next, warm | steps | Lemke |");
    println!("|---:|---:|---:|---:|---:|---:|---:|---:|");
    let walls = [(1, 2), (2, 3), (3, 4), (4, 5), (4, 8), (6, 7), (6, 10), (10, 20), (20, 28)];
    for (wide, high) in walls {
        for (mu, disorder) in [(0.3, 0.0), (0.3, 0.1), (1.0, 0.1)] {
            let [problem, next] =
                [0.0, 1.0].map(|step| wall(wide.max(high % 2 + 1), high, mu, disorder, step));
            let (mut solution, mut warm, mut modes) = (Solution::new(), WarmStart::new(), Modes::default());
            let mut steps = 0;
            let repeated = if problem.len() > 1000 { 1 } else { REPEATED };
            let cold = least(repeated, || {
                modes.solve(&problem, &mut solution).unwrap();
                steps = solution.iterations;
            });
            warm.remember(&problem, &solution);
            let mut next_steps = 0;
            let next_time = least(REPEATED, || {
                modes.solve_from(&next, &warm, &mut solution).unwrap();
                next_steps = solution.iterations;
            });
            let contacts = problem.len() / 2;
            let lemke = (contacts <= LEMKE)
                .then(|| least(1, || Lemke::default().solve(&problem, &mut solution).unwrap()))
                .map_or_else(String::new, |time| format!("{time:.0}"));
            println!(
                "| {contacts} | {mu} | {disorder} | {cold:.1} | {steps} | {next_time:.1} | {next_steps} | {lemke} |"
            );
        }
    }
}
