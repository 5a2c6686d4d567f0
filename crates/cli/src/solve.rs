//! `halfgap solve`: solves one contact problem from a file, and explains the answer or prints it as JSON.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Instant;

use crate::failure::{End, Failure};
use crate::numbers::{given, size};
use crate::output;
use clap::{Args, ValueEnum};
use halfgap::scene::SceneFormat;
use halfgap_contact::{
    Auto, ContactFile, DualActiveSet, FileError, Lemke, Modes, Problem, ProximalNewton, Qp, Residuals,
    RowKind, Settings, Solution, SolutionFile, SolveError, Solver, WarmStart,
};

/// Start of the formats of scenes.
const SCENE: &str = "halfgap-scene-";
/// Advice for a scene in the place of a contact problem.
const IS_SCENE: &str = "if it is a scene, run it by `halfgap run`";
/// Largest number of rows printed; of larger problems, those with the largest forces.
const SHOWN_ROWS: usize = 40;
/// Number of repetitions of a solve, of which the fastest counts.
const REPETITIONS: usize = 5;

/// Options of `halfgap solve`.
#[derive(Debug, Args)]
pub(crate) struct SolveArgs {
    /// A problem in the format halfgap-contact-1.
    problem: PathBuf,
    /// The method; by default chosen by size and structure.
    #[arg(long, value_enum, default_value = "auto")]
    method: Choice,
    /// Print the answer as JSON (halfgap-solution-1) instead of a table.
    #[arg(long)]
    json: bool,
}

/// Methods by their names in files.
#[derive(Clone, Copy, Debug, ValueEnum)]
#[value(rename_all = "snake_case")]
enum Choice {
    Auto,
    DualActiveSet,
    ProximalNewton,
    Qp,
    Lemke,
    Modes,
}

impl Choice {
    fn solver(self) -> Box<dyn Solver> {
        match self {
            Choice::Auto => Box::new(Auto::default()),
            Choice::DualActiveSet => Box::new(DualActiveSet::default()),
            Choice::ProximalNewton => Box::new(ProximalNewton::default()),
            Choice::Qp => Box::new(Qp::default()),
            Choice::Lemke => Box::new(Lemke::default()),
            Choice::Modes => Box::new(Modes::default()),
        }
    }
}

/// A solution, or error, with the times of the solve.
struct Outcome {
    solution: Solution,
    result: Result<(), SolveError>,
    microseconds: f64,
    microseconds_warm: Option<f64>,
}

/// Runs the command.
pub(crate) fn run(args: &SolveArgs) -> Result<End, Failure> {
    let (file, problem, next) = match read(args) {
        Ok(read) => read,
        Err(message) => {
            output::tell(&format!("error: {}: {message}", args.problem.display()));
            return Ok(End::BadInput);
        }
    };
    let outcome = solve(args.method, &problem, next.as_ref());
    if args.json {
        output::print(&format!("{}\n", json(args.method, &problem, &outcome)))?;
    } else {
        output::print(&explain(&file, &problem, &outcome))?;
    }
    Ok(if outcome.result.is_ok() { End::Done } else { End::Stopped })
}

/// Reads the file, its problem and, if it has `b_next`, that of the next step.
fn read(args: &SolveArgs) -> Result<(ContactFile, Problem, Option<Problem>), String> {
    let text = std::fs::read_to_string(&args.problem).map_err(|error| error.to_string())?;
    let file = ContactFile::parse(&text).map_err(|error| match &error {
        FileError::Format(format) if format.starts_with(SCENE) => format!("{error}: {IS_SCENE}"),
        FileError::Json(_) if SceneFormat::of_file(&args.problem) == Some(SceneFormat::Toml) => {
            format!("not JSON, as a contact problem is: {IS_SCENE}")
        }
        _ => error.to_string(),
    })?;
    for field in ContactFile::unknown_fields(&text) {
        output::tell(&format!(
            "warning: {}: there is no field `{field}`: it is ignored",
            args.problem.display()
        ));
    }
    let problem = file.problem().map_err(|error| error.to_string())?;
    let next = match &file.b_next {
        Some(b) => {
            let mut next = problem.clone();
            next.set_offset(b).map_err(|error| format!("field `b_next`: {}", FileError::from(error)))?;
            Some(next)
        }
        None => None,
    };
    Ok((file, problem, next))
}

fn solve(method: Choice, problem: &Problem, next: Option<&Problem>) -> Outcome {
    let mut solver = method.solver();
    let mut solution = Solution::new();
    let begin = Instant::now();
    let result = solver.solve(problem, &mut solution);
    let mut microseconds = begin.elapsed().as_secs_f64() * 1e6;
    let mut microseconds_warm = None;
    if result.is_ok() {
        let mut again = Solution::new();
        microseconds = fastest(microseconds, || solver.solve(problem, &mut again));
        if let Some(next) = next {
            let mut warm = WarmStart::new();
            warm.remember(problem, &solution);
            let time = fastest(f64::INFINITY, || solver.solve_from(next, &warm, &mut again));
            microseconds_warm = time.is_finite().then_some(time);
        }
    }
    Outcome { solution, result, microseconds, microseconds_warm }
}

/// Returns the least time of some repetitions \[µs\], or `known` if that is less. Work slower than a second, or
/// failing, is not repeated.
fn fastest(known: f64, mut work: impl FnMut() -> Result<(), SolveError>) -> f64 {
    let mut least = known;
    for _ in 0..REPETITIONS {
        let begin = Instant::now();
        if work().is_err() {
            break;
        }
        least = least.min(begin.elapsed().as_secs_f64() * 1e6);
        if least > 1e6 {
            break;
        }
    }
    least
}

fn json(method: Choice, problem: &Problem, outcome: &Outcome) -> String {
    let mut file = SolutionFile::of(&outcome.solution);
    file.microseconds = outcome.microseconds;
    file.microseconds_warm = outcome.microseconds_warm;
    if let Err(error) = &outcome.result {
        let infeasible = matches!(error, SolveError::Infeasible(_) | SolveError::NoModes { .. });
        if let SolveError::Infeasible(proof) = error {
            file.inconsistency = proof.contradiction;
        }
        file.status = if infeasible { "infeasible" } else { "failed" }.to_owned();
        file.method = method.solver().method().name().to_owned();
        file.force.resize(problem.len(), 0.0);
        if infeasible || file.force.iter().any(|f| !f.is_finite()) {
            file.force.fill(0.0);
        }
        let residuals = Residuals::of(problem, &file.force);
        (file.r_nat, file.growth, file.r_bwd) = (residuals.natural, residuals.growth, residuals.backward);
        file.acceleration = problem.accelerations(&file.force);
    }
    serde_json::to_string(&file).unwrap_or_else(|error| format!("{{\"error\":\"{error}\"}}"))
}

/// Returns the answer in words.
fn explain(file: &ContactFile, problem: &Problem, outcome: &Outcome) -> String {
    let title = file.title.as_deref().unwrap_or("contact problem");
    let bilateral = problem.bilateral().iter().filter(|b| **b).count();
    let mut text = format!("{title}: {} rows, {bilateral} of them bilateral\n\n", problem.len());
    match &outcome.result {
        Ok(()) => explain_answer(&mut text, problem, outcome),
        Err(SolveError::Infeasible(proof)) => {
            let parts = proof.direction.iter().enumerate().filter(|(_, z)| **z != 0.0);
            let rows: Vec<String> =
                parts.map(|(row, z)| format!("{row} ({z:.3})")).take(SHOWN_ROWS).collect();
            let _ = writeln!(
                text,
                "INFEASIBLE: {proof}.\nThe rows below, with the weights in parentheses, move against each other whatever the \
                 forces (rounding {:.0e}):\n  {}",
                proof.leakage,
                rows.join(", ")
            );
        }
        Err(error @ SolveError::NoModes { .. }) => {
            let _ = writeln!(
                text,
                "INFEASIBLE: {error}. The same contacts have impulses at velocity level, which stop the sliding at once."
            );
        }
        Err(error) => {
            let _ = writeln!(text, "FAILED: {error}.");
        }
    }
    compare(&mut text, file, outcome);
    text
}

/// Compares the answer with the expectations of the file.
fn compare(text: &mut String, file: &ContactFile, outcome: &Outcome) {
    let found = match &outcome.result {
        Ok(()) => Some(true),
        Err(SolveError::Infeasible(_) | SolveError::NoModes { .. }) => Some(false),
        Err(_) => None,
    };
    let says = |feasible: bool| if feasible { "has a solution" } else { "has none" };
    if let (Some(said), Some(found)) = (file.feasible, found) {
        let verdict = if said == found { "as found" } else { "which was not found" };
        let _ = writeln!(text, "The file says that it {}, {verdict}.", says(said));
    }
    let Some(expected) = file.expected.as_ref().filter(|_| found == Some(true)) else { return };
    let solution = &outcome.solution;
    for (what, said, found) in [
        ("acceleration", &expected.acceleration, &solution.acceleration),
        ("force (others may do where contacts are redundant)", &expected.force, &solution.force),
    ] {
        let Some(said) = said.as_ref().filter(|said| said.len() == found.len()) else { continue };
        let differences = said.iter().zip(found).map(|(said, found)| (said - found).abs());
        let Some((row, most)) = differences.enumerate().max_by(|p, q| p.1.total_cmp(&q.1)) else { continue };
        let _ = write!(text, "The expected {what} differs by {} at most, in row {row}", size(most));
        let allowed = expected.tolerance.map(|tolerance| format!("; {} is allowed", size(tolerance)));
        let _ = writeln!(text, "{}.", allowed.unwrap_or_default());
    }
}

fn explain_answer(text: &mut String, problem: &Problem, outcome: &Outcome) {
    let solution = &outcome.solution;
    let carrying = solution.force.iter().filter(|f| **f != 0.0).count();
    let mut rows: Vec<usize> = (0..problem.len()).collect();
    if rows.len() > SHOWN_ROWS {
        rows.sort_by(|&i, &j| solution.force[j].abs().total_cmp(&solution.force[i].abs()));
        rows.truncate(SHOWN_ROWS);
        let _ = writeln!(text, "the {SHOWN_ROWS} rows with the largest forces:");
    }
    let _ = writeln!(text, "{:>6}  {:>16}  {:>16}  state", "row", "force", "acceleration");
    for row in rows {
        let (force, acceleration) = (solution.force[row], solution.acceleration[row]);
        let state = state(problem.kind(row), force, solution, row);
        let (force, acceleration) = (given(force), given(acceleration));
        let _ = writeln!(text, "{row:>6}  {force:>16}  {acceleration:>16}  {state}");
    }
    let _ = writeln!(
        text,
        "\n{carrying} of {} rows carry force.\n{}\n{} in {} iterations: {}.",
        problem.len(),
        judgement(solution),
        solution.method,
        solution.iterations,
        times(outcome)
    );
}

/// Returns what a row does, in words.
fn state(kind: RowKind, force: f64, solution: &Solution, row: usize) -> &'static str {
    let is_closed = solution.active.binary_search(&row).is_ok();
    match (kind, force != 0.0, is_closed) {
        (RowKind::Bilateral, _, _) => "connector",
        (RowKind::Friction { normal, .. }, _, _) if solution.force[normal] == 0.0 => "free",
        (RowKind::Friction { .. }, _, true) => "sticks",
        (RowKind::Friction { .. }, _, false) => "slips",
        (RowKind::Bounded { .. }, _, true) => "holds",
        (RowKind::Bounded { .. }, _, false) => "at its bound",
        (_, true, _) => "carries force",
        (_, false, true) => "closed, no force",
        (_, false, false) => "free",
    }
}

fn times(outcome: &Outcome) -> String {
    match outcome.microseconds_warm {
        Some(warm) => {
            format!("{:.1} µs cold, {warm:.1} µs warm for the next step", outcome.microseconds)
        }
        None => format!("{:.1} µs", outcome.microseconds),
    }
}

/// Returns the residuals in words.
fn judgement(solution: &Solution) -> String {
    let Residuals { natural, growth, backward } = solution.residuals;
    let exact = natural <= Settings::default().natural_residual;
    let mut text = format!("Residual {} of the largest offset: ", size(natural));
    text += if exact {
        "the answer is exact to rounding."
    } else if solution.inconsistency > 0.0 {
        "left over because contacts contradict each other."
    } else {
        "rounding shows, because the forces are so much larger than the offsets."
    };
    let _ = write!(text, "\nGrowth {}, backward residual {}.", size(growth), size(backward));
    if solution.inconsistency > 0.0 {
        let _ = write!(
            text,
            "\nDependent rows contradict each other by {} of the largest offset; the answer is that of least squares.",
            size(solution.inconsistency)
        );
    }
    text
}
