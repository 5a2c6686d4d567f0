//! Contact solvers against clarabel, in one process and interleaved, on the collected problems given by bodies.
//!
//! `cargo bench -p halfgap-benches --bench contact [-- FILTER]` prints a table in Markdown. Every time is the median of
//! repeated solves, in microseconds, less what reading the clock takes:
//!
//! * cold: the automatic choice, from nothing but a workspace that has seen problems of the size, though not
//!   this matrix;
//! * next: cold and warm with the next step's right-hand side, warm from the answer of this step and with its factor;
//! * J: the same with every coefficient of J changed by up to 1e-3 of itself, so that no factor can be
//!   reused, not even one that was kept from another solve: between two solves of this J comes one of a J
//!   that was changed otherwise;
//! * clarabel: velocity form, building the solver and solving, tolerances 1e-12.
//!
//! Then, with `-- active` or without a filter, the parts of `ActiveRows` on chains and pyramids; with `-- impact`
//! or without a filter, impacts by each law, rows given anew. Each time is the least mean of some batches.
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on should stop")]

use std::hint::black_box;
use std::path::Path;
use std::sync::OnceLock;
use std::time::Instant;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, ZeroConeT};
use halfgap_collision::BodyId as WorldBody;
use halfgap_contact::{
    ActiveRows, Auto, CollisionRow, ContactFile, Impact, ImpactLaw, ImpactOrder, InverseInertia, Problem,
    RowKind, RowsField, Solution, Solver, WarmStart,
};

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
    if filter.is_empty() || filter == "active" {
        measure_held_rows();
    }
    if filter.is_empty() || filter == "impact" {
        measure_impacts();
    }
}

/// Inertia of all bodies: 1.25 kg and a third of a kg m².
const BLOCK: InverseInertia = InverseInertia { inverse_mass: 0.8, inverse_moment: 3.0 };

/// Prints the table of active rows.
fn measure_held_rows() {
    println!("\n| active rows | n | dependent | factorize | solve | respond |\n|---|---|---|---|---|---|");
    for rows in 1..=3 {
        let sides: Vec<_> = (0..rows).map(|row| [Some(0), (row % 2 == 1).then_some(1)]).collect();
        let row = |row: usize| {
            let (sin, cos) = (row as f64).sin_cos();
            [cos, sin, 0.3 * row as f64 - 0.4, -cos, -sin, 0.2]
        };
        measure_held("two bodies", 2, &sides, &(0..rows).map(row).collect::<Vec<_>>());
    }
    for links in [5_u32, 20, 100] {
        let sides: Vec<_> = (0..2 * links).map(|row| [Some(row / 2), (row / 2).checked_sub(1)]).collect();
        let row = |row: u32| {
            let (sin, cos) = (0.1 * f64::from(row / 2)).sin_cos();
            let across = [1.0, 0.0, -0.5 * sin, -1.0, 0.0, -0.5 * sin];
            if row.is_multiple_of(2) { across } else { [0.0, 1.0, 0.5 * cos, 0.0, -1.0, 0.5 * cos] }
        };
        measure_held("chain of pins", links as usize, &sides, &(0..2 * links).map(row).collect::<Vec<_>>());
    }
    for layers in [5, 10] {
        let (blocks, sides, coefficients) = pyramid(layers);
        measure_held("pyramid", blocks, &sides, &coefficients);
    }
}

/// Number of bodies; sides and coefficients of each row.
type Scene = (usize, Vec<[Option<u32>; 2]>, Vec<[f64; 6]>);

/// A pyramid of blocks, each on two corners of each block below.
fn pyramid(layers: u32) -> Scene {
    let (mut sides, mut coefficients) = (Vec::new(), Vec::new());
    let mut below = 0;
    let mut count = 0;
    for layer in 0..layers {
        for block in count..count + layers - layer {
            if layer == 0 {
                sides.extend([[Some(block), None]; 2]);
                coefficients.extend([-0.5, 0.5].map(|arm| [0.0, 1.0, arm, 0.0, 0.0, 0.0]));
                continue;
            }
            let left = below + block - count;
            for (other, lower, upper) in
                [(left, 0.0, -0.5), (left, 0.5, 0.0), (left + 1, -0.5, 0.0), (left + 1, 0.0, 0.5)]
            {
                sides.push([Some(block), Some(other)]);
                coefficients.push([0.0, 1.0, upper, 0.0, -1.0, -lower]);
            }
        }
        below = count;
        count += layers - layer;
    }
    (count as usize, sides, coefficients)
}

fn measure_held(name: &str, bodies: usize, sides: &[[Option<u32>; 2]], coefficients: &[[f64; 6]]) {
    let n = sides.len();
    let mut active = ActiveRows::default();
    active.set_structure(&vec![BLOCK; bodies], sides);
    let dependent = active.factorize(coefficients);
    let offset: Vec<f64> = (0..n).map(|row| (row % 3) as f64 - 9.81).collect();
    let (mut force, mut change) = (vec![0.0; n], vec![[0.0; 3]; bodies]);
    let factorize = least_mean(|| {
        black_box(active.factorize(black_box(coefficients)));
    });
    let solve = least_mean(|| active.solve(black_box(&offset), black_box(&mut force)));
    let respond = least_mean(|| active.respond(black_box(&force), black_box(&mut change)));
    println!("| {name} | {n} | {dependent} | {factorize:.3} | {solve:.3} | {respond:.3} |");
}

/// Prints the table of impacts.
fn measure_impacts() {
    println!("\n| impact | n | law | time | solves |\n|---|---|---|---|---|");
    let cases = [
        ("ball on a floor", vec![corner(0.0)]),
        ("block landing flat", [-0.5, 0.5].map(corner).to_vec()),
        ("block on three points", [-0.5, 0.0, 0.5].map(corner).to_vec()),
        ("21 discs in a row", discs(21, false)),
        ("2 discs in a tight box", discs(2, true)),
        ("20 discs in a tight box", discs(20, true)),
        ("chain of 20 pins, struck", struck_chain(20)),
    ];
    for (name, rows) in &cases {
        for law in [ImpactLaw::Simultaneous, ImpactLaw::Hybrid, ImpactLaw::SerialSeparate] {
            let mut impact = Impact::new();
            let time = least_mean(|| {
                impact.set_rows(rows.iter().copied());
                law.resolve(&mut impact, ImpactOrder::Fastest, 0).unwrap();
            });
            println!("| {name} | {} | {law:?} | {time:.2} | {} |", rows.len(), impact.solves());
        }
    }
}

fn impact_row(bodies: [WorldBody; 2], jacobian: [f64; 6], rate: f64, bilateral: bool) -> CollisionRow {
    let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
    let inertia = bodies.map(|body| if body.is_world() { fixed } else { BLOCK });
    CollisionRow {
        elasticity: 1.0,
        velocity_tol: 1e-9,
        kind: RowKind::plain(bilateral),
        ..CollisionRow::new(bodies, jacobian, inertia, rate)
    }
}

/// A corner that comes down on a floor.
fn corner(arm: f64) -> CollisionRow {
    impact_row([WorldBody(0), WorldBody::WORLD], [0.0, 1.0, arm, 0.0, -1.0, -arm], -1.0, false)
}

/// Touching discs in a row, the first of which moves, optionally between two walls.
fn discs(count: u32, walls: bool) -> Vec<CollisionRow> {
    let along = [-1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    let speed = |disc: u32| if disc == 1 { -1.0 } else { 0.0 };
    let touch = |disc: u32| impact_row([WorldBody(disc - 1), WorldBody(disc)], along, speed(disc), false);
    let mut rows: Vec<_> = (1..count).map(touch).collect();
    if walls {
        let wall = WorldBody::WORLD;
        rows.push(impact_row([WorldBody(count - 1), wall], along, 0.0, false));
        rows.push(impact_row([WorldBody(0), wall], along.map(|x| -x), 1.0, false));
    }
    rows
}

/// A chain of rods in a line, struck across at its end.
fn struck_chain(links: u32) -> Vec<CollisionRow> {
    let mut rows = Vec::new();
    for link in 0..links {
        let before = link.checked_sub(1).map_or(WorldBody::WORLD, WorldBody);
        let sides = [WorldBody(link), before];
        rows.push(impact_row(sides, [1.0, 0.0, 0.0, -1.0, 0.0, 0.0], 0.0, true));
        rows.push(impact_row(sides, [0.0, 1.0, -0.5, 0.0, -1.0, -0.5], 0.0, true));
    }
    let across = [0.0, 1.0, 0.0, 0.0, -1.0, -0.5];
    rows.push(impact_row([WorldBody(links), WorldBody(links - 1)], across, -1.0, false));
    rows
}

/// Time [µs] that `work` takes: the least mean over some batches.
fn least_mean(mut work: impl FnMut()) -> f64 {
    let begin = Instant::now();
    work();
    let batch = (2e-3 / begin.elapsed().as_secs_f64()).clamp(1.0, 1e5) as usize;
    let mean = |_| {
        let begin = Instant::now();
        (0..batch).for_each(|_| work());
        begin.elapsed().as_secs_f64() * 1e6 / batch as f64
    };
    (0..25).map(mean).fold(f64::INFINITY, f64::min)
}

/// Measures one problem and returns its line of the table.
fn measure(name: &str, file: &ContactFile) -> String {
    let problem = file.problem().unwrap();
    let next = file.b_next.as_ref().map(|b| {
        let mut next = problem.clone();
        next.set_offset(b).unwrap();
        next
    });
    let [perturbed, otherwise] = [0, 7].map(|first| perturbed(file, first));
    let (mut solver, mut solution, mut warm) = (Auto::default(), Solution::new(), WarmStart::new());
    solver.solve(&problem, &mut solution).unwrap();
    warm.remember(&problem, &solution);
    let (method, iterations) = (solution.method, solution.iterations);
    let mut times: [Vec<f64>; 6] = Default::default();
    let begin = Instant::now();
    while times[0].len() < MOST && (times[0].len() < 5 || begin.elapsed().as_secs_f64() < BUDGET) {
        // Cold solves, and warm ones with another J, follow solves of other matrices, so that no factor is kept.
        solver.solve(&otherwise, &mut solution).ok();
        times[0].push(time(|| solver.solve(&problem, &mut solution).is_ok()));
        times[1].push(time(|| clarabel(file)));
        if let Some(next) = &next {
            solver.solve(&otherwise, &mut solution).ok();
            times[2].push(time(|| solver.solve(next, &mut solution).is_ok()));
            times[3].push(time(|| solver.solve_from(next, &warm, &mut solution).is_ok()));
        }
        solver.solve(&otherwise, &mut solution).ok();
        solver.solve(&problem, &mut solution).ok();
        times[4].push(time(|| solver.solve(&perturbed, &mut solution).is_ok()));
        solver.solve(&otherwise, &mut solution).ok();
        solver.solve(&problem, &mut solution).ok();
        times[5].push(time(|| solver.solve_from(&perturbed, &warm, &mut solution).is_ok()));
    }
    let t: Vec<Option<f64>> = times.into_iter().map(median).collect();
    let show = |t: Option<f64>| {
        t.map_or("-".to_owned(), |t| if t < 10.0 { format!("{t:.2}") } else { format!("{t:.1}") })
    };
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

/// The problem with the next right-hand side, in which every coefficient is changed by up to 1e-3 of itself, by the
/// terms of a number sequence from index `first` on.
fn perturbed(file: &ContactFile, first: usize) -> Problem {
    let RowsField { triplets, .. } = file.j.as_ref().unwrap();
    let golden = f64::midpoint(5.0_f64.sqrt(), 1.0);
    let change = |e: usize| 1.0 + 1e-3 * (2.0 * ((e + first + 1) as f64 * golden).fract() - 1.0);
    let rows: Vec<_> = triplets.iter().enumerate().map(|(e, &(i, k, v))| (i, k, v * change(e))).collect();
    let offset = file.b_next.as_ref().unwrap_or(&file.b);
    let mut problem = Problem::from_rows(&rows, file.inverse_mass.as_ref().unwrap(), offset).unwrap();
    if let Some(bilateral) = &file.bilateral {
        problem.set_bilateral(bilateral).unwrap();
    }
    problem
}

/// Time [µs] that `work` takes, less the time of reading the clock.
fn time(work: impl FnOnce() -> bool) -> f64 {
    static CLOCK: OnceLock<f64> = OnceLock::new();
    let clock = CLOCK.get_or_init(|| (0..1000).map(|_| elapsed(|| true)).fold(f64::INFINITY, f64::min));
    elapsed(work) - clock
}

fn elapsed(work: impl FnOnce() -> bool) -> f64 {
    let begin = Instant::now();
    black_box(work());
    begin.elapsed().as_secs_f64() * 1e6
}

fn median(mut times: Vec<f64>) -> Option<f64> {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied()
}

/// Solves min ½ vᵀM v subject to J v + b ≥ 0 (= 0 on bilateral rows).
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
