//! Runs every scene with every engine and writes table and plots to `target/speed-vs-error`.
//!
//! `cargo bench -p halfgap-report --bench speed_vs_error -- [--quick] [--only NAME]... [--engine NAME] [--out FOLDER]
//! [--merge FILE]... [--passes N] [--longest SECONDS] [--gas] [--write-scenes FOLDER]`
//!
//! `overview.svg` has all scenes that were run without friction, motors and limits, `friction.svg` those with friction,
//! `motors_and_limits.svg` those in which something acts on joints.
//!
//! `--only` picks scenes by a part of their name, `--engine` one engine or `none`; `--merge` adds the runs of an
//! earlier table, and `--passes` is the number of passes through everything: of equal runs the least time is kept, for
//! a machine may be busy. `--longest` is the longest time [s] of a peer's run at ever shorter steps. `--gas` measures
//! impacts per second of free bodies instead.
//! `--write-scenes FOLDER` writes the scenes with their known states instead, for peers that run in a program of their
//! own, as `peers/mujoco_runs.py` does.

use halfgap_report::scene::{Group, Scene};
use halfgap_report::sweep::{Effort, Row, merge};
use halfgap_report::{csv, gas, levels, plot, scene_file, scenes, sweep};
use std::error::Error;
use std::fs;
use std::path::PathBuf;

type Sweep = fn(&Scene, &Effort) -> Vec<Row>;

/// The engines, each with its sweep.
const SWEEPS: [(&str, Sweep); 3] =
    [("halfgap", sweep::halfgap_rows), ("rapier", sweep::rapier_rows), ("box2d", sweep::box2d_rows)];

/// A picture for each group of scenes.
const PICTURES: [(&str, Group); 3] = [
    ("overview.svg", Group::Smooth),
    ("friction.svg", Group::Friction),
    ("motors_and_limits.svg", Group::MotorsAndLimits),
];

struct Options {
    effort: Effort,
    only: Vec<String>,
    engine: Option<String>,
    out: PathBuf,
    merge: Vec<PathBuf>,
    passes: usize,
    gas: bool,
    write_scenes: Option<PathBuf>,
}

fn options() -> Result<Options, String> {
    let mut options = Options {
        effort: Effort::thorough(),
        only: Vec::new(),
        engine: None,
        out: PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../target/speed-vs-error"),
        merge: Vec::new(),
        passes: 1,
        gas: false,
        write_scenes: None,
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} wants a value"));
        match word.as_str() {
            "--quick" => options.effort = Effort::quick(),
            "--only" => options.only.push(value()?),
            "--engine" => options.engine = Some(value()?),
            "--out" => options.out = value()?.into(),
            "--merge" => options.merge.push(value()?.into()),
            "--longest" => {
                options.effort.longest_run = value()?.parse().map_err(|_| "--longest wants seconds")?;
            }
            "--passes" => options.passes = value()?.parse().map_err(|_| "--passes wants a number")?,
            "--gas" => options.gas = true,
            "--write-scenes" => options.write_scenes = Some(value()?.into()),
            // Arguments that cargo adds.
            "--bench" => {}
            other => return Err(format!("unknown option {other}")),
        }
    }
    Ok(options)
}

fn print(row: &Row) {
    let (scene, engine, settings) = (&row.scene, &row.engine, &row.settings);
    match &row.outcome {
        Ok(run) => {
            let error = run.error.map_or("-".to_owned(), |error| format!("{error:.1e}"));
            let (milliseconds, steps) = (1e3 * run.wall_per_second, run.steps);
            println!(
                "{scene:20} {engine:8} {settings:50} {milliseconds:12.4} ms/s  error {error:>8}  steps {steps}"
            );
        }
        Err(why) => println!("{scene:20} {engine:8} {settings:50} {why}"),
    }
}

fn run_all(options: &Options, scenes: &[Scene]) -> Result<Vec<Row>, Box<dyn Error>> {
    let mut rows = Vec::new();
    for file in &options.merge {
        merge(&mut rows, csv::read(&fs::read_to_string(file)?)?);
    }
    for scene in std::iter::repeat_n(scenes, options.passes).flatten() {
        for (engine, sweep) in SWEEPS {
            if options.engine.as_ref().is_some_and(|only| only != engine) {
                continue;
            }
            let found = sweep(scene, &options.effort);
            found.iter().for_each(print);
            merge(&mut rows, found);
            // A long sweep that is broken off leaves the runs made so far.
            fs::write(options.out.join("runs.csv"), csv::table(&rows))?;
        }
    }
    Ok(rows)
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = options()?;
    fs::create_dir_all(&options.out)?;
    if options.gas {
        let rows = gas::measure(options.passes);
        println!("{}", gas::table(&rows));
        return Ok(fs::write(options.out.join("gas.svg"), plot::gas(&rows)?)?);
    }
    let is_wanted =
        |name: &str| options.only.is_empty() || options.only.iter().any(|part| name.contains(part));
    let scenes = scenes::wanted(is_wanted);
    for scene in &scenes {
        let answer = match scene.has_answer() {
            true => format!("{}, good to {:.0e} m", scene.reference, scene.reference_error),
            false => "nothing is known but its cost".to_owned(),
        };
        println!("{}: {}; {answer}", scene.name, scene.about);
    }
    if let Some(folder) = &options.write_scenes {
        fs::create_dir_all(folder)?;
        for scene in scenes.iter().filter(|scene| scene.has_answer()) {
            let file = folder.join(format!("{}.json", scene.name));
            fs::write(file, serde_json::to_string_pretty(&scene_file::json(scene))?)?;
        }
        return Ok(());
    }
    let rows = run_all(&options, &scenes)?;
    let answered = || scenes.iter().filter(|scene| scene.has_answer());
    let names: Vec<String> = answered().map(|scene| scene.name.clone()).collect();
    fs::write(options.out.join("runs.csv"), csv::table(&rows))?;
    for name in &names {
        fs::write(options.out.join(format!("{name}.svg")), plot::scene(&rows, name)?)?;
    }
    let mut tables = String::new();
    for (file, group) in PICTURES {
        let shown = answered().filter(|scene| scene.group() == group);
        let shown: Vec<String> = shown.map(|scene| scene.name.clone()).collect();
        if !shown.is_empty() {
            fs::write(options.out.join(file), plot::overview(&rows, &shown)?)?;
            tables += &format!("{}\n{}\n", levels::table(&rows, &shown), levels::ratios(&rows, &shown));
        }
    }
    tables += &levels::piles(&rows);
    fs::write(options.out.join("tables.md"), &tables)?;
    println!("\n{tables}");
    Ok(())
}
