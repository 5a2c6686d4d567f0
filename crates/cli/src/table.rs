//! The table that `halfgap run` prints, and numbers in tables.

use halfgap::{Difference, ErrorEstimate, Ledger, RunResult, short_names, short_text};
use std::fmt::Write;
use std::ops::Range;

/// Largest number of bodies listed; `--json` and `--out` list all.
const MOST_BODIES: usize = 60;
/// Largest length of a name; longer ones are shortened.
const LONGEST_NAME: usize = 24;
/// Largest length of a title; longer ones lose their end.
const LONGEST_TITLE: usize = 200;
/// Sizes, in the unit of the column, that are written without an exponent.
const PLAIN: Range<f64> = 1e-3..1e5;

/// Returns final states, energies, counters, the energy ledger and, if there is one, the error estimate.
pub(crate) fn of_result(result: &RunResult) -> String {
    let title = short_text(&result.scene, LONGEST_TITLE);
    let mut text = format!("{}: {} at t = {} s\n\n", title, result.status.name(), result.time);
    push_states(&mut text, result);
    push_summary(&mut text, result);
    push_ledger(&mut text, &result.ledger);
    if result.error_estimate.is_some() {
        text.push('\n');
    }
    text + &of_estimate(result)
}

/// Returns the error estimate; an empty text if none was asked for.
pub(crate) fn of_estimate(result: &RunResult) -> String {
    let mut text = String::new();
    if let Some(estimate) = &result.error_estimate {
        push_estimate(&mut text, estimate);
    }
    text
}

fn push_states(text: &mut String, result: &RunResult) {
    let listed = &result.bodies[..result.bodies.len().min(MOST_BODIES)];
    let names = short_names(listed.iter().map(|(name, _)| name.as_str()), LONGEST_NAME);
    let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(4);
    let heads = ["x [m]", "y [m]", "angle [rad]", "vx [m/s]", "vy [m/s]", "w [rad/s]"];
    let _ = write!(text, "{:width$}", "body");
    for head in heads {
        let _ = write!(text, " {head:>16}");
    }
    text.push('\n');
    for (name, (_, state)) in names.iter().zip(listed) {
        let _ = write!(text, "{name:width$}");
        let (position, velocity) = (state.position, state.velocity);
        for value in [position.x, position.y, state.angle, velocity.x, velocity.y, state.angular_velocity] {
            let _ = write!(text, " {:>16}", number(value));
        }
        text.push('\n');
    }
    if listed.len() < result.bodies.len() {
        let _ = writeln!(text, "... and {} more", result.bodies.len() - listed.len());
    }
    text.push('\n');
}

fn push_summary(text: &mut String, result: &RunResult) {
    let (energy, statistics) = (&result.energy, &result.statistics.world);
    let length = |value: Option<f64>| value.map_or("none".to_owned(), |value| format!("{value:.3e} m"));
    let change = energy.total - energy.start;
    let ends = format!("{} J at the start, {} J at the end", number(energy.start), number(energy.total));
    let wall = result.statistics.wall_seconds.map_or("none".to_owned(), |wall| format!("{wall:.6} s"));
    let rows = [
        ("energy", format!("{ends} (change {change:.3e} J)")),
        (
            "at the end",
            format!("kinetic {} J, potential {} J", number(energy.kinetic), number(energy.potential)),
        ),
        ("steps", format!("{} ({} evaluations)", statistics.steps, statistics.evaluations)),
        ("impacts", statistics.impacts.to_string()),
        ("back-ups", statistics.backups.to_string()),
        ("contact solves", statistics.contact_solves.to_string()),
        ("smallest gap", length(statistics.smallest_gap)),
        ("connector error", length(statistics.largest_connector_error)),
        ("wall time", wall),
    ];
    for (name, value) in rows {
        let _ = writeln!(text, "{name:16} {value}");
    }
}

/// Adds the changes of the energy that are not 0, and the error of the integration.
fn push_ledger(text: &mut String, ledger: &Ledger) {
    let fixed = [
        ("impacts", ledger.impacts),
        ("captures", ledger.captures),
        ("projections", ledger.projections),
        ("interventions", ledger.interventions),
        ("damping", ledger.damping),
    ];
    let laws = ledger.laws.iter().map(|law| (law.law.as_str(), law.work));
    let _ = writeln!(text, "\nenergy ledger");
    for (name, change) in fixed.into_iter().chain(laws).filter(|(_, change)| *change != 0.0) {
        let _ = writeln!(text, "  {name:30} {change:+.9e} J");
    }
    let _ = writeln!(text, "  {:30} {:+.9e} J", "integration error", ledger.integration_error());
    if ledger.start_correction != 0.0 {
        let _ = writeln!(text, "  {:30} {:+.9e} J", "corrections before the start", ledger.start_correction);
    }
}

fn push_estimate(text: &mut String, estimate: &ErrorEstimate) {
    let (tolerance, tighter) = (estimate.tolerance, estimate.tighter_tolerance);
    let _ = writeln!(text, "error estimate: tolerance {tolerance:.1e} against {tighter:.1e}");
    push_difference(text, "  largest", &estimate.largest);
    push_difference(text, &format!("  at {:.4} s", estimate.compared_until), &estimate.end);
    let times = estimate.event_time.map_or("none to compare".to_owned(), |time| format!("{time:.3e} s"));
    let [impacts, of_tighter] = estimate.impacts;
    let _ = writeln!(text, "  {:14} {times} ({impacts} impacts against {of_tighter})", "event times");
    match (estimate.chaotic, estimate.trusted_until) {
        (true, Some(time)) => {
            let _ = writeln!(text, "  chaotic: states are meaningful until {time:.4} s only");
        }
        (true, None) => {
            let _ =
                writeln!(text, "  chaotic: the error grows too fast for any tolerance to hold it for long");
        }
        (false, Some(time)) => {
            let _ = writeln!(
                text,
                "  states are meaningful until {time:.4} s only; a tighter tolerance extends that"
            );
        }
        (false, None) => {}
    }
    if let Some(error) = &estimate.tighter_stopped {
        let _ = writeln!(text, "  the tighter run stopped early: {error}");
    }
}

fn push_difference(text: &mut String, when: &str, difference: &Difference) {
    let Difference { position, angle, velocity, angular_velocity } = difference;
    let _ = writeln!(
        text,
        "{when:16} {position:.3e} m, {angle:.3e} rad, {velocity:.3e} m/s, {angular_velocity:.3e} rad/s"
    );
}

/// Formats a number to nine digits after the point, or eight with an exponent: few enough to compare by eye.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || PLAIN.contains(&size) { format!("{value:.9}") } else { format!("{value:.8e}") }
}
