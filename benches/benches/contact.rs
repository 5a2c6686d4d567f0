//! Contact solvers against clarabel, in one process and interleaved, on the collected problems given by bodies.
//!
//! `cargo bench -p halfgap-benches --bench contact [-- FILTER]` prints a table in Markdown. Every time is the median of
//! repeated solves, in microseconds:
//!
//! * cold: the automatic choice, from nothing but a workspace that has seen problems of the size, though not this matrix;
//! * next: cold and warm with the next step's right-hand side, warm from the answer of this step and with its factor;
//! * J: the same with every coefficient of J changed by up to 1e-3 of itself, so that no factor can be reused;
//! * clarabel: velocity form, building the solver and solving, tolerances 1e-12.
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on should stop")]

use std::path::Path;
use std::time::Instant;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, ZeroConeT};
use halfgap_contact::{Auto, ContactFile, Problem, RowsField, Solution, Solver, WarmStart};

/// Time spent on each problem [s], and the most solves of one kind.
const BUDGET: f64 = 0.3;
const MOST: usize = 201;

fn main() {
    let filter = std::env::args().skip(1).find(|arg| !arg.starts_with("--")).unwrap_or_default();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/contact/problems");
    let mut cases: Vec<(String, ContactFile)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.file_name().unwrap().to_string_lossy().contains(&filter))
        .map(|path| {
            let file = ContactFile::parse(&std::fs::read_to_string(&path).unwrap()).unwrap();
            (path.file_stem().unwrap().to_string_lossy().into_owned(), file)
        })
        .filter(|(_, file)| file.j.is_some() && file.feasible != Some(false))
        .collect();
    cases.sort_by_key(|(name, file)| (file.family.clone(), file.b.len(), name.clone()));
    println!(
        "| problem | n | method | cold | clarabel | ratio | next cold | next warm | ratio | J cold | J warm | ratio | iterations |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (name, file) in &cases {
        println!("{}", measure(name, file));
    }
}

/// One line of the table.
fn measure(name: &str, file: &ContactFile) -> String {
    let problem = file.problem().unwrap();
    let next = file.b_next.as_ref().map(|b| {
        let mut next = problem.clone();
        next.set_offset(b).unwrap();
        next
    });
    let perturbed = perturbed(file);
    let (mut solver, mut solution, mut warm) = (Auto::default(), Solution::new(), WarmStart::new());
    solver.solve(&problem, &mut solution).unwrap();
    warm.remember(&problem, &solution);
    let (method, iterations) = (solution.method, solution.iterations);
    let mut times: [Vec<f64>; 6] = Default::default();
    let begin = Instant::now();
    while times[0].len() < MOST && (times[0].len() < 5 || begin.elapsed().as_secs_f64() < BUDGET) {
        // Cold solves, and warm ones with another J, follow a solve of another matrix, so that no factor is kept.
        solver.solve(&perturbed, &mut solution).ok();
        times[0].push(time(|| solver.solve(&problem, &mut solution).is_ok()));
        times[1].push(time(|| clarabel(file)));
        if let Some(next) = &next {
            solver.solve(&perturbed, &mut solution).ok();
            times[2].push(time(|| solver.solve(next, &mut solution).is_ok()));
            times[3].push(time(|| solver.solve_from(next, &warm, &mut solution).is_ok()));
        }
        solver.solve(&problem, &mut solution).ok();
        times[4].push(time(|| solver.solve(&perturbed, &mut solution).is_ok()));
        solver.solve(&problem, &mut solution).ok();
        times[5].push(time(|| solver.solve_from(&perturbed, &warm, &mut solution).is_ok()));
    }
    let t: Vec<Option<f64>> = times.into_iter().map(median).collect();
    let show = |t: Option<f64>| t.map_or("-".to_owned(), |t| format!("{t:.1}"));
    let ratio = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => format!("{:.1}", a / b),
        _ => "-".to_owned(),
    };
    format!(
        "| {name} | {} | {method} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {iterations} |",
        problem.len(),
        show(t[0]),
        show(t[1]),
        ratio(t[1], t[0]),
        show(t[2]),
        show(t[3]),
        ratio(t[2], t[3]),
        show(t[4]),
        show(t[5]),
        ratio(t[4], t[5]),
    )
}

/// The problem with the next right-hand side, every coefficient changed by up to 1e-3 of itself.
fn perturbed(file: &ContactFile) -> Problem {
    let RowsField { triplets, .. } = file.j.as_ref().unwrap();
    let golden = f64::midpoint(5.0_f64.sqrt(), 1.0);
    let change = |e: usize| 1.0 + 1e-3 * (2.0 * ((e + 1) as f64 * golden).fract() - 1.0);
    let rows: Vec<_> = triplets.iter().enumerate().map(|(e, &(i, k, v))| (i, k, v * change(e))).collect();
    let offset = file.b_next.as_ref().unwrap_or(&file.b);
    let mut problem = Problem::from_rows(&rows, file.inverse_mass.as_ref().unwrap(), offset).unwrap();
    if let Some(bilateral) = &file.bilateral {
        problem.set_bilateral(bilateral).unwrap();
    }
    problem
}

/// Microseconds that `work` takes.
fn time(work: impl FnOnce() -> bool) -> f64 {
    let begin = Instant::now();
    std::hint::black_box(work());
    begin.elapsed().as_secs_f64() * 1e6
}

fn median(mut times: Vec<f64>) -> Option<f64> {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied()
}

/// min ½ vᵀM v subject to J v + b ≥ 0, = 0 on bilateral rows.
fn clarabel(file: &ContactFile) -> bool {
    let j = file.j.as_ref().unwrap();
    let mass = file.inverse_mass.as_ref().unwrap();
    let bilateral = |row: usize| file.bilateral.as_ref().is_some_and(|b| b[row]);
    let order: Vec<usize> =
        (0..j.rows).filter(|&row| bilateral(row)).chain((0..j.rows).filter(|&row| !bilateral(row))).collect();
    let mut place = vec![0; j.rows];
    order.iter().enumerate().for_each(|(at, &row)| place[row] = at);
    let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for &(i, k, v) in &j.triplets {
        rows.push(place[i]);
        columns.push(k);
        values.push(-v);
    }
    let constraints = CscMatrix::new_from_triplets(j.rows, j.columns, rows, columns, values);
    let diagonal: Vec<usize> = (0..j.columns).collect();
    let weights = mass.iter().map(|w| 1.0 / w).collect();
    let weights = CscMatrix::new_from_triplets(j.columns, j.columns, diagonal.clone(), diagonal, weights);
    let right: Vec<f64> = order.iter().map(|&row| file.b[row]).collect();
    let equations = order.iter().filter(|&&row| bilateral(row)).count();
    let cones = [ZeroConeT(equations), NonnegativeConeT(j.rows - equations)];
    let settings = DefaultSettings {
        verbose: false,
        max_threads: 1,
        tol_gap_abs: 1e-12,
        tol_gap_rel: 1e-12,
        tol_feas: 1e-12,
        direct_solve_method: "qdldl".to_owned(),
        ..DefaultSettings::default()
    };
    let linear = vec![0.0; j.columns];
    let mut solver = DefaultSolver::new(&weights, &linear, &constraints, &right, &cones, settings).unwrap();
    solver.solve();
    solver.solution.iterations > 0
}
