//! The table that `halfgap run` prints.

use crate::numbers::{booked, change, energy, gap, given, size, state};
use halfgap::{Difference, ErrorEstimate, FrictionThreshold, Ledger, RunResult, short_names, short_text};
use std::fmt::Write;

/// Largest number of bodies listed; `--json` and `--out` list all.
const MOST_BODIES: usize = 60;
/// Largest length of a name; longer ones are shortened.
const LONGEST_NAME: usize = 24;
/// Largest length of a title; longer ones lose their end.
const LONGEST_TITLE: usize = 200;

/// Returns final states, energies, counters, the energy ledger and, if there is one, the error estimate; `repeats` is
/// the number of runs that were timed.
pub(crate) fn of_result(result: &RunResult, repeats: usize) -> String {
    let title = short_text(&result.scene, LONGEST_TITLE);
    let mut text = format!("{}: {} at t = {} s\n\n", title, result.status.name(), given(result.time));
    push_states(&mut text, result);
    push_summary(&mut text, result, repeats);
    push_ledger(&mut text, &result.ledger, result.scales.energy);
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
    let scales = &result.scales;
    for (name, (_, body)) in names.iter().zip(listed) {
        let _ = write!(text, "{name:width$}");
        let (place, speed) = (body.position, body.velocity);
        let numbers = [place.x, place.y, body.angle, speed.x, speed.y, body.angular_velocity];
        // Angles are of the scale of a radian.
        let scales = [scales.length, scales.length, 1.0, scales.speed, scales.speed, scales.spin];
        for (value, scale) in numbers.into_iter().zip(scales) {
            let _ = write!(text, " {:>16}", state(value, scale));
        }
        text.push('\n');
    }
    if listed.len() < result.bodies.len() {
        let _ = writeln!(text, "... and {} more", result.bodies.len() - listed.len());
    }
    text.push('\n');
}

fn push_summary(text: &mut String, result: &RunResult, repeats: usize) {
    let (energies, statistics, scales) = (&result.energy, &result.statistics.world, &result.scales);
    let length = |value: Option<f64>| {
        value.map_or("none".to_owned(), |value| format!("{} m", gap(value, scales.length)))
    };
    let joules = |value: f64| energy(value, scales.energy);
    let lost = change(energies.total - energies.start, scales.energy);
    let ends = format!("{} J at the start, {} J at the end", joules(energies.start), joules(energies.total));
    let seconds = |wall: Option<f64>| wall.map_or("none".to_owned(), |wall| format!("{wall:.6} s"));
    let least = seconds(result.statistics.wall_seconds);
    let median = seconds(result.statistics.wall_seconds_median);
    let wall =
        if repeats > 1 { format!("{least} (least of {repeats} runs; median {median})") } else { least };
    let rows = [
        ("energy", format!("{ends} (change {lost} J)")),
        (
            "at the end",
            format!("kinetic {} J, potential {} J", joules(energies.kinetic), joules(energies.potential)),
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

/// Adds the changes of the energy that are not 0, and the error of the integration; `scale` is that of the energies
/// [J].
fn push_ledger(text: &mut String, ledger: &Ledger, scale: f64) {
    let fixed = [
        ("impacts", ledger.impacts),
        ("captures", ledger.captures),
        ("projections", ledger.projections),
        ("steps of accumulations", ledger.steps),
        ("interventions", ledger.interventions),
        ("damping", ledger.damping),
        ("jams", ledger.jams),
        ("friction in impacts", ledger.impact_friction),
        ("friction", ledger.friction),
        ("running surfaces", ledger.surfaces),
        ("drives", ledger.drives),
    ];
    let force_laws = ledger.force_laws.iter().map(|law| (law.law.as_str(), law.work));
    text.push_str("\nenergy ledger\n");
    let mut push = |name: &str, joules: f64, is_told: bool| {
        let joules = booked(joules, scale);
        if is_told || joules != "0" {
            let _ = writeln!(text, "  {name:30} {joules:>16} J");
        }
    };
    fixed.into_iter().chain(force_laws).for_each(|(name, joules)| push(name, joules, false));
    push("integration error", ledger.integration_error(), true);
    push("corrections before the start", ledger.start_correction, false);
}

fn push_estimate(text: &mut String, estimate: &ErrorEstimate) {
    let (tolerance, tighter) = (estimate.tolerance, estimate.tighter_tolerance);
    let _ = writeln!(text, "error estimate: tolerance {} against {}", size(tolerance), size(tighter));
    push_difference(text, "  largest", &estimate.largest);
    push_difference(text, &format!("  at {:.4} s", estimate.compared_until), &estimate.end);
    let times = estimate.event_time.map_or("none to compare".to_owned(), |time| format!("{} s", size(time)));
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
    for threshold in &estimate.thresholds {
        push_threshold(text, threshold);
    }
    if let Some(error) = &estimate.tighter_stopped {
        let _ = writeln!(text, "  the tighter run stopped early: {error}");
    }
}

/// Warns of a contact of which the least change decides whether it slips.
fn push_threshold(text: &mut String, threshold: &FrictionThreshold) {
    let FrictionThreshold { bodies: [a, b], time, spare, slip_speeds } = threshold;
    let _ = write!(text, "  at a threshold of friction from {time:.4} s on: {a} on {b} ");
    let _ = match slip_speeds.map(|speeds| speeds.map(size)) {
        Some([here, there]) => {
            writeln!(text, "slips at {here} m/s here, at {there} m/s at the tighter tolerance")
        }
        None => writeln!(text, "has {} of its friction to spare", size(*spare)),
    };
}

fn push_difference(text: &mut String, when: &str, difference: &Difference) {
    let Difference { position, angle, velocity, angular_velocity } = *difference;
    let [position, angle, velocity, spin] = [position, angle, velocity, angular_velocity].map(size);
    let _ = writeln!(text, "{when:16} {position} m, {angle} rad, {velocity} m/s, {spin} rad/s");
}
