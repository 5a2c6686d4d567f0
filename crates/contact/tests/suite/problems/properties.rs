//! Changes that must leave the answer as it is, on random problems of bodies.

use halfgap_contact::{
    Auto, DualActiveSet, InverseInertia, Lemke, Problem, ProximalNewton, Row, Solution, Solver,
};
use proptest::prelude::*;

use super::data::{judge, scales};

/// A row as data: bodies, coefficients, offset, whether bilateral.
type RawRow = (usize, usize, [f64; 6], f64, bool);

/// Bodies with inverse masses, and rows between them that share a few normals, so that some are dependent.
#[derive(Clone, Debug)]
struct Raw {
    masses: Vec<[f64; 2]>,
    rows: Vec<RawRow>,
}

impl Raw {
    fn problem(&self) -> Problem {
        let mut problem = Problem::new();
        let bodies: Vec<_> = self
            .masses
            .iter()
            .map(|&[inverse_mass, inverse_moment]| {
                problem.add_body(InverseInertia { inverse_mass, inverse_moment })
            })
            .collect::<Result<_, _>>()
            .unwrap();
        for &(a, b, c, offset, bilateral) in &self.rows {
            let row = Row::new(bodies[a], [c[0], c[1], c[2]], offset);
            let row = if a == b { row } else { row.against(bodies[b], [c[3], c[4], c[5]]) };
            problem.add_row(&if bilateral { row.bilateral() } else { row }).unwrap();
        }
        problem
    }
}

/// Problems that have a solution: b = -A f0 + a0 with random f0, a0 ≥ 0.
fn any_problem() -> impl Strategy<Value = Raw> {
    let mass = prop::array::uniform2(prop_oneof![0.1..10.0_f64, Just(1.0)]);
    let row = (
        0..4_usize,
        0..4_usize,
        prop::array::uniform2(-1.0..1.0_f64),
        0..6_u32,
        prop_oneof![Just(0.0), 0.1..5.0_f64],
        prop::bool::weighted(0.15),
        any::<bool>(),
    );
    (prop::collection::vec(mass, 4), prop::collection::vec(row, 1..14)).prop_map(|(masses, raw)| {
        let mut rows: Vec<RawRow> = Vec::new();
        for &(a, b, arms, direction, _, bilateral, _) in &raw {
            let angle = f64::from(direction) * std::f64::consts::FRAC_PI_3;
            let (y, x) = angle.sin_cos();
            rows.push((a, b, [x, y, arms[0], -x, -y, arms[1]], 0.0, bilateral));
        }
        let mut made = Raw { masses, rows };
        let matrix = made.problem().dense();
        let force = |k: usize| if raw[k].6 { raw[k].4 } else { 0.0 };
        let rest = |k: usize| if raw[k].6 || raw[k].5 { 0.0 } else { raw[k].4 };
        for (i, entries) in matrix.iter().enumerate() {
            let pushed: f64 = entries.iter().enumerate().map(|(j, a)| a * force(j)).sum();
            made.rows[i].3 = rest(i) - pushed;
        }
        made
    })
}

fn solve(solver: &mut dyn Solver, problem: &Problem) -> Solution {
    let mut solution = Solution::new();
    solver.solve(problem, &mut solution).unwrap();
    solution
}

/// Largest difference of scaled accelerations, in units of the scale.
fn difference(problem: &Problem, x: &[f64], y: &[f64]) -> f64 {
    let (s, scale) = scales(problem);
    (0..s.len()).map(|i| (x[i] - y[i]).abs() / s[i] / scale).fold(0.0, f64::max)
}

/// Largest difference of accelerations that agree, as a fraction of the scale: the residual rule, through the
/// condition of small random problems.
const CLOSE: f64 = 1e-9;

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_answer_passes_the_independent_check(raw in any_problem()) {
        let problem = raw.problem();
        let judged = judge(&problem, &solve(&mut Auto::default(), &problem).force);
        prop_assert!(judged.good(), "{judged:?}");
    }

    #[test]
    fn the_methods_agree(raw in any_problem()) {
        let problem = raw.problem();
        let dual = solve(&mut DualActiveSet::default(), &problem);
        let proximal = solve(&mut ProximalNewton::default(), &problem);
        prop_assert!(judge(&problem, &proximal.force).good());
        prop_assert!(difference(&problem, &dual.acceleration, &proximal.acceleration) < CLOSE);
        if !problem.bilateral().contains(&true) {
            let lemke = solve(&mut Lemke::default(), &problem);
            prop_assert!(difference(&problem, &dual.acceleration, &lemke.acceleration) < CLOSE);
        }
    }

    #[test]
    fn the_order_of_the_rows_does_not_matter(raw in any_problem(), turn in 1..13_usize) {
        let problem = raw.problem();
        let mut turned = raw.clone();
        let by = turn % raw.rows.len();
        turned.rows.rotate_left(by);
        let one = solve(&mut DualActiveSet::default(), &problem);
        let mut two = solve(&mut DualActiveSet::default(), &turned.problem());
        two.acceleration.rotate_right(by);
        prop_assert!(difference(&problem, &one.acceleration, &two.acceleration) < CLOSE);
    }

    #[test]
    fn scaling_a_row_scales_its_acceleration(raw in any_problem(), row in 0..13_usize, power in -8..8_i32) {
        let factor = 2.0_f64.powi(power);
        let row = row % raw.rows.len();
        let mut scaled = raw.clone();
        scaled.rows[row].2.iter_mut().for_each(|c| *c *= factor);
        scaled.rows[row].3 *= factor;
        let problem = raw.problem();
        let one = solve(&mut DualActiveSet::default(), &problem);
        let mut two = solve(&mut DualActiveSet::default(), &scaled.problem());
        two.acceleration[row] /= factor;
        prop_assert!(difference(&problem, &one.acceleration, &two.acceleration) < CLOSE);
    }

    #[test]
    fn units_do_not_matter(raw in any_problem(), mass in -6..6_i32, time in -6..6_i32) {
        let (mass, time) = (10.0_f64.powi(mass), 10.0_f64.powi(time));
        let mut scaled = raw.clone();
        scaled.masses.iter_mut().flatten().for_each(|w| *w *= mass);
        scaled.rows.iter_mut().for_each(|row| row.3 *= time);
        let problem = raw.problem();
        let one = solve(&mut DualActiveSet::default(), &problem);
        let mut two = solve(&mut DualActiveSet::default(), &scaled.problem());
        two.acceleration.iter_mut().for_each(|a| *a /= time);
        prop_assert!(difference(&problem, &one.acceleration, &two.acceleration) < CLOSE);
    }

    #[test]
    fn a_contact_found_twice_changes_nothing(raw in any_problem(), row in 0..13_usize) {
        let mut doubled = raw.clone();
        doubled.rows.push(raw.rows[row % raw.rows.len()]);
        let problem = raw.problem();
        let one = solve(&mut DualActiveSet::default(), &problem);
        let two = solve(&mut DualActiveSet::default(), &doubled.problem());
        let n = raw.rows.len();
        prop_assert!(difference(&problem, &one.acceleration, &two.acceleration[..n]) < CLOSE);
        prop_assert!(judge(&doubled.problem(), &two.force).good());
    }

    #[test]
    fn a_unique_force_does_not_depend_on_the_order(forces in prop::collection::vec(0.0..5.0_f64, 2..8)) {
        // A chain of bodies, each pressed to the one before: as many rows as bodies, so A is regular.
        let count = forces.len();
        let build = |order: &[usize]| {
            let mut problem = Problem::new();
            let bodies: Vec<_> = (0..count)
                .map(|i| problem.add_body(InverseInertia { inverse_mass: 1.0 + i as f64, inverse_moment: 1.0 }).unwrap())
                .collect();
            for &i in order {
                let row = Row::new(bodies[i], [1.0, 0.0, 0.1], -forces[i]);
                let row = if i == 0 { row } else { row.against(bodies[i - 1], [-1.0, 0.0, 0.2]) };
                problem.add_row(&row).unwrap();
            }
            problem
        };
        let there: Vec<usize> = (0..count).collect();
        let back: Vec<usize> = (0..count).rev().collect();
        let one = solve(&mut DualActiveSet::default(), &build(&there));
        let mut two = solve(&mut DualActiveSet::default(), &build(&back));
        two.force.reverse();
        for (x, y) in one.force.iter().zip(&two.force) {
            prop_assert!((x - y).abs() < 1e-11 * (1.0 + x.abs()));
        }
    }
}
