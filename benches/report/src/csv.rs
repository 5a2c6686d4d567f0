//! The table of all runs as CSV.

use crate::sweep::Row;
use std::fmt::Write;

const HEAD: &str = "scene,engine,version,settings,wall_seconds_per_simulated_second,steps,events,error_m,\
                    reference_error_m,largest_penetration_m,connector_error_m,energy_error_j,status";

/// One line per run, after a head.
#[must_use]
pub fn table(rows: &[Row]) -> String {
    let mut text = format!("{HEAD}\n");
    for row in rows {
        let Row { scene, engine, version, settings, .. } = row;
        let _ = write!(text, "{scene},{engine},{version},{settings},");
        match &row.outcome {
            Ok(run) => {
                let events = run.events.map_or(String::new(), |events| events.to_string());
                let error = run.error.map_or(String::new(), |error| format!("{error:e}"));
                let _ = writeln!(
                    text,
                    "{:e},{},{events},{error},{:e},{:e},{:e},{:e},done",
                    run.wall_per_second,
                    run.steps,
                    row.reference_error,
                    run.penetration,
                    run.connector_error,
                    run.energy_error
                );
            }
            Err(why) => {
                let _ = writeln!(text, ",,,,{:e},,,,\"{}\"", row.reference_error, why.replace('"', "'"));
            }
        }
    }
    text
}
