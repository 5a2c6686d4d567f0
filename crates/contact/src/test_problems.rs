//! Problems that the tests of several modules share.

use crate::matrix::Matrix;
use crate::problem::{InverseInertia, Problem, Row};

/// Blocks in a pyramid, each on two corners of each block below, which are `arm` [m] from their centres.
pub(crate) fn pyramid(layers: usize, arm: f64) -> Problem {
    let mut problem = Problem::new();
    let mut below = Vec::new();
    for layer in 0..layers {
        let inertia = InverseInertia { inverse_mass: 0.8, inverse_moment: 3.0 };
        let blocks: Vec<_> = (layer..layers).map(|_| problem.add_body(inertia).expect("a body")).collect();
        for (k, &block) in blocks.iter().enumerate() {
            if layer == 0 {
                for side in [-arm, arm] {
                    problem.add_row(&Row::new(block, [0.0, 1.0, side], -9.81)).expect("a row");
                }
                continue;
            }
            for (other, lower, upper) in
                [(k, 0.0, -arm), (k, arm, 0.0), (k + 1, -arm, 0.0), (k + 1, 0.0, arm)]
            {
                let row = Row::new(block, [0.0, 1.0, upper], 0.0);
                problem.add_row(&row.against(below[other], [0.0, -1.0, -lower])).expect("a row");
            }
        }
        below = blocks;
    }
    problem
}

/// Largest change of a coefficient of a crooked pyramid, as a fraction of itself.
const CROOKED: f64 = 1e-3;
/// Phase [rad] of the change from one coefficient to the next.
const PHASE: f64 = 1.7;

/// A pyramid in which each block has its own width: the corners no longer meet, and some of them open.
pub(crate) fn crooked_pyramid(layers: usize) -> Problem {
    let mut problem = pyramid(layers, 0.5);
    if let Matrix::Bodies(bodies) = &mut problem.matrix {
        for (k, value) in bodies.rows.value.iter_mut().enumerate() {
            *value *= 1.0 + CROOKED * (k as f64 * PHASE).sin();
        }
    }
    problem
}
