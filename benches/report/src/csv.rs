//! The table of all runs as CSV, written and read back.

use crate::measure::Measurement;
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
                let why = why.replace(['"', '\n', '\r'], " ");
                let _ = writeln!(text, ",,,,{:e},,,,\"{why}\"", row.reference_error);
            }
        }
    }
    text
}

/// Reads a table back.
///
/// # Errors
/// A line that is not of this table.
pub fn read(text: &str) -> Result<Vec<Row>, String> {
    let mut lines = text.lines();
    if lines.next() != Some(HEAD) {
        return Err("the head is another".to_owned());
    }
    let row = |line: &str| read_row(line).ok_or(format!("cannot be read: {line}"));
    lines.map(row).collect()
}

fn read_row(line: &str) -> Option<Row> {
    // The status is last: it may have commas of its own.
    let fields: Vec<&str> = line.splitn(HEAD.split(',').count(), ',').collect();
    let [scene, engine, version, settings, numbers @ .., status] = fields.as_slice() else { return None };
    let number = |index: usize| numbers[index].parse::<f64>().ok();
    let outcome = if *status == "done" {
        Ok(Measurement {
            wall_per_second: number(0)?,
            steps: numbers[1].parse().ok()?,
            events: numbers[2].parse().ok(),
            error: number(3),
            penetration: number(5)?,
            connector_error: number(6)?,
            energy_error: number(7)?,
        })
    } else {
        Err(status.trim_matches('"').to_owned())
    };
    Some(Row {
        scene: (*scene).to_owned(),
        engine: (*engine).to_owned(),
        version: (*version).to_owned(),
        settings: (*settings).to_owned(),
        reference_error: number(4)?,
        outcome,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let run = Measurement {
            wall_per_second: 1.5e-3,
            steps: 7,
            events: None,
            error: Some(f64::INFINITY),
            penetration: 0.0,
            connector_error: 1e-12,
            energy_error: -2.5,
        };
        let row = |settings: &str, outcome| Row {
            scene: "a".to_owned(),
            engine: "b".to_owned(),
            version: "3.2 (c)".to_owned(),
            settings: settings.to_owned(),
            reference_error: 1e-14,
            outcome,
        };
        let rows = [row("steps 3", Ok(run)), row("steps 4", Err("stopped, at once".to_owned()))];
        let text = table(&rows);
        assert_eq!(table(&read(&text).expect("it is a table")), text);
        assert_eq!(text.lines().count(), 3);
    }
}
