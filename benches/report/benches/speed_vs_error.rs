//! Runs every scene with every engine and writes table and plots to `target/speed-vs-error`.
//!
//! `cargo bench -p halfgap-report --bench speed_vs_error -- [--quick] [--only NAME]... [--out FOLDER]`

use halfgap_report::sweep::{Effort, Row};
use halfgap_report::{csv, scenes, sweep};
use std::path::PathBuf;

struct Options {
    effort: Effort,
    only: Vec<String>,
    out: PathBuf,
}

fn options() -> Result<Options, String> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../target/speed-vs-error");
    let mut options = Options { effort: Effort::thorough(), only: Vec::new(), out: folder };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} wants a value"));
        match word.as_str() {
            "--quick" => options.effort = Effort::quick(),
            "--only" => options.only.push(value()?),
            "--out" => options.out = value()?.into(),
            // What cargo adds.
            "--bench" => {}
            other => return Err(format!("unknown option {other}")),
        }
    }
    Ok(options)
}

fn print(row: &Row) {
    let (scene, engine, settings) = (&row.scene, row.engine, &row.settings);
    match &row.outcome {
        Ok(run) => {
            let error = run.error.map_or("-".to_owned(), |error| format!("{error:.1e}"));
            let milliseconds = 1e3 * run.wall_per_second;
            println!(
                "{scene:20} {engine:8} {settings:40} {milliseconds:12.4} ms/s  error {error:>8}  steps {}",
                run.steps
            );
        }
        Err(why) => println!("{scene:20} {engine:8} {settings:40} {why}"),
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = options()?;
    std::fs::create_dir_all(&options.out)?;
    let mut rows = Vec::new();
    for scene in scenes::all() {
        if !options.only.is_empty() && !options.only.iter().any(|name| scene.name.contains(name)) {
            continue;
        }
        for sweep in [sweep::halfgap_rows, sweep::rapier_rows, sweep::box2d_rows] {
            let found = sweep(&scene, &options.effort);
            found.iter().for_each(print);
            rows.extend(found);
        }
    }
    std::fs::write(options.out.join("runs.csv"), csv::table(&rows))?;
    Ok(())
}
