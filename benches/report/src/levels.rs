//! What each engine needs to reach an error, as a table in Markdown, beside the best of an independent suite.

use crate::sweep::Row;
use std::fmt::Write;

/// The errors [m] that are asked for.
const LEVELS: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-6, 1e-9, 1e-10];
/// The peers and their titles, in the order of the columns.
const PEERS: [(&str, &str); 3] = [("rapier", "Rapier"), ("box2d", "Box2D"), ("mujoco", "MuJoCo")];

/// The cheapest of nine engines and its letter at the levels 1e-2, 1e-3, 1e-4, 1e-6 and 1e-9 m: time [ms] per simulated
/// second.
type Bar = [Option<(f64, char)>; 5];

/// An independent suite's measurement of the field, on a core of its own machine. Siconos event-driven,
/// MuJoCo with RK4 in reduced coordinates, Chipmunk; N where the engine is not named.
const BARS: [(&str, Bar); 15] = [
    ("ball_bounce", bar([0.057, 0.105, 0.105, 0.105, 0.123], b"CSSSS")),
    ("two_discs_e1", bar([0.028; 5], b"SSSSS")),
    ("newtons_cradle", bar([0.32, 4.4, 70.0, 0.0, 0.0], b"CCC  ")),
    ("square_billiard", bar([0.16; 5], b"SSSSS")),
    ("pendulum", bar([0.06, 0.16, 0.31, 0.63, 2.5], b"CMMMM")),
    ("double_pendulum", bar([0.088, 0.088, 0.18, 0.70, 5.6], b"MMMMM")),
    ("four_bar", bar([0.18, 0.67, 2.7, 21.0, 0.0], b"CMMM ")),
    ("falling_chain", bar([1.1, 4.4, 4.4, 18.0, 72.0], b"MMMMM")),
    ("disc_in_bowl", bar([0.24, 0.24, 0.38, 0.47, 0.97], b"SSSSS")),
    ("disc_off_hill", bar([0.23, 0.54, 1.2, 1.2, 1.2], b"CMSSS")),
    ("block_slide_friction", bar([0.33, 1.4, 32.0, 0.0, 0.0], b"NNN  ")),
    ("disc_slips_then_rolls", bar([0.0, 0.77, 0.77, 3.3, 67.0], b" NNNN")),
    ("block_rocks", bar([0.16, 0.61, 30.0, 0.0, 0.0], b"NNN  ")),
    ("stack_10", bar([0.9, 0.0, 0.0, 0.0, 0.0], b"N    ")),
    ("pyramid_20", bar([18.0, 73.0, 0.0, 0.0, 0.0], b"NN   ")),
];

/// Times with the letters of their engines; a blank is a level that none reaches.
const fn bar(times: [f64; 5], engines: &[u8; 5]) -> Bar {
    let mut bar = [None; 5];
    let mut index = 0;
    while index < bar.len() {
        if engines[index] != b' ' {
            bar[index] = Some((times[index], engines[index] as char));
        }
        index += 1;
    }
    bar
}

/// The least time [ms] per simulated second in which an engine gets a scene to an error.
fn cheapest(rows: &[Row], scene: &str, engine: &str, level: f64) -> Option<f64> {
    let runs = rows.iter().filter(|row| row.scene == scene && row.engine == engine);
    let runs = runs.filter_map(Row::time_and_error).filter(|(_, error)| *error <= level);
    runs.map(|(time, _)| 1e3 * time).min_by(f64::total_cmp)
}

/// One line per scene and level that halfgap or a peer reaches; engines that ran on none of the scenes have no column, nor
/// has the bar where none of them has one.
#[must_use]
pub fn table(rows: &[Row], scenes: &[String]) -> String {
    let is_shown = |name: &str| scenes.iter().any(|scene| scene == name);
    let ran = |engine: &str| rows.iter().any(|row| row.engine == engine && is_shown(&row.scene));
    let peers: Vec<(&str, &str)> = PEERS.into_iter().filter(|(engine, _)| ran(engine)).collect();
    let has_bar = BARS.iter().any(|(name, _)| is_shown(name));
    let mut heads = vec!["scene", "error [m]", "halfgap [ms/s]"];
    heads.extend(peers.iter().map(|(_, title)| title));
    heads.extend(if has_bar {
        ["the bar", "bar or best peer / halfgap"].as_slice()
    } else {
        &["best peer / halfgap"]
    });
    let mut text = format!("| {} |\n|{}\n", heads.join(" | "), "---|".repeat(heads.len()));
    for scene in scenes {
        let bars = BARS.iter().find(|(name, _)| name == scene).map(|(_, bar)| bar);
        for (index, &level) in LEVELS.iter().enumerate() {
            let bar = bars.and_then(|bar| bar.get(index).copied().flatten());
            let ours = cheapest(rows, scene, "halfgap", level);
            let times: Vec<_> =
                peers.iter().map(|(engine, _)| cheapest(rows, scene, engine, level)).collect();
            if ours.is_none() && bar.is_none() && times.iter().all(Option::is_none) {
                continue;
            }
            let mut cells = vec![scene.clone(), format!("{level:e}"), shown(ours)];
            cells.extend(times.iter().map(|&time| shown(time)));
            if has_bar {
                cells.push(bar.map_or("-".to_owned(), |(time, engine)| format!("{time} {engine}")));
            }
            let others = times.into_iter().chain([bar.map(|(time, _)| time)]).flatten();
            cells.push(match (ours, others.min_by(f64::total_cmp)) {
                (Some(ours), Some(best)) => format!("{}", number(best / ours)),
                (Some(_), None) => "only halfgap".to_owned(),
                (None, _) => "not reached".to_owned(),
            });
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        }
    }
    text
}

/// What the cheapest peer takes over what halfgap takes, a line per scene.
#[must_use]
pub fn ratios(rows: &[Row], scenes: &[String]) -> String {
    let heads = LEVELS.map(|level| format!("{level:e} m"));
    let mut text = format!(
        "| scene | {} | at most a tenth |\n|---|{}---|\n",
        heads.join(" | "),
        "---|".repeat(heads.len())
    );
    for scene in scenes {
        let ratio = |level: f64| {
            let peers = PEERS.iter().filter_map(|(engine, _)| cheapest(rows, scene, engine, level));
            let best = peers.min_by(f64::total_cmp)?;
            Some(cheapest(rows, scene, "halfgap", level).map_or(0.0, |ours| best / ours))
        };
        let ratios = LEVELS.map(ratio);
        let reached = ratios.iter().flatten().count();
        let missed = ratios.iter().flatten().filter(|&&ratio| ratio < 10.0).count();
        let verdict = match (reached, missed) {
            (0, _) => "no peer reaches 1e-2",
            (_, 0) => "yes",
            _ => "no",
        };
        let _ = writeln!(text, "| {scene} | {} | {verdict} |", ratios.map(shown).join(" | "));
    }
    text
}

fn shown(number: Option<f64>) -> String {
    number.map_or("-".to_owned(), |value| self::number(value).to_string())
}

/// Two significant digits.
fn number(value: f64) -> f64 {
    let unit = 10_f64.powf(value.abs().log10().floor() - 1.0);
    let rounded = (value / unit).round() * unit;
    // The shortest form of it: the product above has a tail.
    format!("{rounded:.12}").parse().unwrap_or(rounded)
}

/// Time of scenes of which nothing else is known: one line per run.
#[must_use]
pub fn piles(rows: &[Row]) -> String {
    let mut text = String::from(
        "| scene | engine | settings | ms per simulated second | deepest overlap [m] |\n|---|---|---|---|---|\n",
    );
    for row in rows {
        let Row { scene, engine, settings, .. } = row;
        let _ = match &row.outcome {
            Ok(run) if run.error.is_none() => {
                let time = number(1e3 * run.wall_per_second);
                writeln!(text, "| {scene} | {engine} | {settings} | {time} | {:.1e} |", run.penetration)
            }
            Err(why) if why.starts_with("given up") => {
                writeln!(text, "| {scene} | {engine} | {settings} | {why} | - |")
            }
            _ => Ok(()),
        };
    }
    text
}
