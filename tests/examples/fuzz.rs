//! Runs generated scenes and counts what became of them.
//!
//! ```text
//! cargo run --release -p halfgap-tests --example fuzz -- --count 100000 --seed 1
//! cargo run --release -p halfgap-tests --example fuzz -- --scene 4711      # prints the scene of a seed
//! cargo run --release -p halfgap-tests --example fuzz -- --billiard 4711   # the same without forces, ties and loss
//! cargo run --release -p halfgap-tests --example fuzz -- --shrink 4711     # prints a smaller one that fails alike
//! cargo run --release -p halfgap-tests --example fuzz -- --count 1000 --coarse   # with zones that one can see
//! cargo run --release -p halfgap-tests --example fuzz -- --count 1000 --impulses # with contacts that carry impulses only
//! cargo run --release -p halfgap-tests --example fuzz -- --count 1000 --varied   # reference scenes with other numbers
//! cargo run --release -p halfgap-tests --example fuzz -- --count 1000 --rough    # with friction
//! cargo run --release -p halfgap-tests --example fuzz -- --count 1000 --rolling  # with rolling resistance, too
//! cargo run --release -p halfgap-tests --example fuzz -- --count 1000 --pushed   # stacks of blocks that slide
//! cargo run --release -p halfgap-tests --example fuzz -- --count 1000 --mechanisms
//! cargo run --release -p halfgap-tests --example fuzz -- --count 1000 --needs haste,accumulation   # tells which scenes need a remedy
//! ```
//!
//! Scenes run in processes of their own, two at a time (`--jobs`), so that one that hangs or overflows is found too.

use halfgap::{Remedy, RemedySet};
use halfgap_tests::generate::{
    billiard_of_seed, coarse_of_seed, impulses_of_seed, mechanism_of_seed, pushed_stack_of_seed,
    rolling_of_seed, rough_of_seed, scene_of_seed, variation_of_seed,
};
use halfgap_tests::invariants::{Budget, Verdict, silence_panics, trial, trial_without};
use halfgap_tests::shrink::shrink;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// A scene that says nothing for so long hangs, even on a machine that others use.
const HANGS: Duration = Duration::from_secs(60);
/// Seeds listed for each kind.
const LISTED: usize = 8;

const USAGE: &str = "\
Runs generated scenes and counts what became of them.

  --count N     so many scenes (1000)
  --seed S      from this seed on (1)
  --jobs N      so many at a time (2)
  --scene S     prints the scene of a seed
  --billiard S  the same without forces, ties and loss
  --shrink S    prints a smaller one that fails alike
  --coarse      in all of this, scenes with zones that one can see
  --impulses    or such whose contacts carry impulses only
  --varied      or reference scenes with other numbers
  --rough       or scenes with friction
  --rolling     or scenes with friction and rolling resistance
  --pushed      or three blocks on each other that slide
  --mechanisms  or mechanisms
  --needs R,S   and again where one of these remedies acts, without it";

/// Options that a number follows, and those of the processes that this one starts.
const WITH_NUMBER: [&str; 6] = ["--count", "--seed", "--jobs", "--scene", "--billiard", "--shrink"];
const WORKER: &str = "--worker";
/// The option that names of remedies follow.
const NEEDS: &str = "--needs";

/// The remedies of some names; `None` if one has no such name.
fn remedies(names: &str) -> Option<Vec<Remedy>> {
    let of_name = |name| Remedy::ALL.into_iter().find(|remedy| remedy.name() == name);
    names.split(',').map(of_name).collect()
}

/// The names of some remedies; `None` without any.
fn names_of(remedies: &[Remedy]) -> Option<String> {
    let names: Vec<_> = remedies.iter().map(|remedy| remedy.name()).collect();
    (!names.is_empty()).then(|| names.join(","))
}

/// What is wrong with the arguments, if something is.
fn complaint(arguments: &[String]) -> Option<String> {
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        let takes_number = WITH_NUMBER.contains(&argument.as_str());
        if argument == NEEDS {
            match rest.next().and_then(|names| remedies(names)) {
                Some(_) => continue,
                None => return Some(format!("names of remedies must follow {NEEDS}")),
            }
        }
        if !takes_number && argument != WORKER && Scenes::asked_for(argument).is_none() {
            return Some(format!("\"{argument}\" is no option"));
        }
        if takes_number && rest.next().is_none_or(|number| number.parse::<u64>().is_err()) {
            return Some(format!("a number must follow {argument}"));
        }
    }
    let mut kinds = arguments.iter().filter(|argument| Scenes::asked_for(argument).is_some());
    let (first, second) = (kinds.next()?, kinds.next()?);
    Some(format!("either {first} or {second}"))
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| ["--help", "-h"].contains(&argument.as_str())) {
        println!("{USAGE}");
        return;
    }
    if let Some(complaint) = complaint(&arguments) {
        eprintln!("{complaint}\n\n{USAGE}");
        std::process::exit(2);
    }
    let number = |name: &str, default: u64| {
        let place = arguments.iter().position(|argument| argument == name);
        place.map_or(default, |place| arguments[place + 1].parse().expect("a number follows the option"))
    };
    let has = |name: &str| arguments.iter().any(|argument| argument == name);
    let (first, count) = (number("--seed", 1), number("--count", 1000));
    let asked = arguments.iter().find_map(|argument| Scenes::asked_for(argument));
    let scenes = asked.unwrap_or(Scenes::Fine);
    let names = arguments.iter().position(|argument| argument == NEEDS);
    let needs = names.and_then(|place| remedies(&arguments[place + 1])).unwrap_or_default();
    if has("--scene") {
        println!("{:#}", scenes.of_seed(number("--scene", 1)));
    } else if has("--billiard") {
        println!("{:#}", billiard_of_seed(number("--billiard", 1)));
    } else if has("--shrink") {
        print_shrunk(&scenes.of_seed(number("--shrink", 1)));
    } else if has(WORKER) {
        work(&Trials { scenes, needs }, first, count);
    } else {
        let failed = supervise(&Trials { scenes, needs }, first, count, number("--jobs", 2));
        std::process::exit(i32::from(failed));
    }
}

/// What scenes are run.
#[derive(Clone, Copy, Debug)]
enum Scenes {
    Fine,
    /// With zones that one can see.
    Coarse,
    /// With contacts that carry impulses only.
    Impulses,
    /// Reference scenes with other numbers.
    Varied,
    /// With friction.
    Rough,
    /// With friction and rolling resistance.
    Rolling,
    /// Linkages, gears and the like, driven and limited.
    Mechanisms,
    /// Stacks that are pushed.
    Pushed,
}

impl Scenes {
    fn of_seed(self, seed: u64) -> Value {
        match self {
            Self::Fine => scene_of_seed(seed),
            Self::Coarse => coarse_of_seed(seed),
            Self::Impulses => impulses_of_seed(seed),
            Self::Varied => variation_of_seed(seed),
            Self::Rough => rough_of_seed(seed),
            Self::Rolling => rolling_of_seed(seed),
            Self::Pushed => pushed_stack_of_seed(seed),
            Self::Mechanisms => mechanism_of_seed(seed),
        }
    }

    /// The option that asks for them.
    fn option(self) -> Option<&'static str> {
        match self {
            Self::Fine => None,
            Self::Coarse => Some("--coarse"),
            Self::Impulses => Some("--impulses"),
            Self::Varied => Some("--varied"),
            Self::Rough => Some("--rough"),
            Self::Rolling => Some("--rolling"),
            Self::Pushed => Some("--pushed"),
            Self::Mechanisms => Some("--mechanisms"),
        }
    }

    /// The scenes that an option asks for.
    fn asked_for(option: &str) -> Option<Self> {
        let all = [
            Self::Coarse,
            Self::Impulses,
            Self::Varied,
            Self::Rough,
            Self::Rolling,
            Self::Pushed,
            Self::Mechanisms,
        ];
        all.into_iter().find(|scenes| scenes.option() == Some(option))
    }
}

fn print_shrunk(scene: &Value) {
    silence_panics();
    let least = shrink(scene, Budget::default());
    eprintln!("{:?}", trial(&least.to_string(), Budget::default()));
    println!("{least:#}");
}

/// Runs scenes and writes a line before and after each.
fn work(Trials { scenes, needs }: &Trials, first: u64, count: u64) {
    silence_panics();
    let mut out = std::io::stdout().lock();
    let mut say = |line: String| {
        let told = writeln!(out, "{line}").and_then(|()| out.flush());
        told.expect("somebody listens");
    };
    for seed in first..first + count {
        say(format!("start {seed}"));
        let scene = scenes.of_seed(seed).to_string();
        let (verdict, acted) = trial_without(&scene, Budget::default(), RemedySet::NONE);
        for &remedy in needs.iter().filter(|&&remedy| acted.of(remedy) > 0) {
            let (other, _) = trial_without(&scene, Budget::default(), RemedySet::NONE.with(remedy));
            let ends = if other.is_worse_than(&verdict) { "worse" } else { "no worse" };
            let (name, other, verdict) = (remedy.name(), other.kind(), verdict.kind());
            eprintln!("seed {seed} ends {ends} without {name}: {other} instead of {verdict}");
        }
        let what = match &verdict {
            Verdict::Broken(broken) => format!("\t{}", broken.what.replace('\n', " ")),
            Verdict::Shallow(why)
            | Verdict::Stopped(why)
            | Verdict::Refused(why)
            | Verdict::Unfinished(why) => {
                format!("\t{}", why.replace('\n', " "))
            }
            Verdict::Finished => String::new(),
        };
        say(format!("end {}{what}", verdict.kind()));
    }
}

/// What is run: scenes of a kind, and again without each remedy of some that acts in them.
#[derive(Clone, Debug)]
struct Trials {
    scenes: Scenes,
    needs: Vec<Remedy>,
}

/// Seeds by kind, each with the first words about it.
type Found = BTreeMap<String, Vec<(u64, String)>>;

/// Lets processes run all scenes; true if one failed.
fn supervise(trials: &Trials, first: u64, count: u64, jobs: u64) -> bool {
    let started = Instant::now();
    let share = count.div_ceil(jobs);
    let threads: Vec<_> = (0..jobs)
        .map(|job| {
            let from = first + job * share;
            let to = (from + share).min(first + count);
            let trials = trials.clone();
            std::thread::spawn(move || run_all(&trials, from, to))
        })
        .collect();
    let mut found = Found::new();
    for thread in threads {
        for (kind, seeds) in thread.join().expect("a supervisor does not panic") {
            found.entry(kind).or_default().extend(seeds);
        }
    }
    report(&found);
    println!("{count} scenes from seed {first} in {:.0?}", started.elapsed());
    found.keys().any(|kind| kind.starts_with("BROKEN"))
}

fn report(found: &Found) {
    for (kind, seeds) in found {
        println!("{:7} {kind}", seeds.len());
        for (seed, what) in
            seeds.iter().filter(|(_, what)| !what.is_empty() || kind.starts_with("BROKEN")).take(LISTED)
        {
            let short: String = what.chars().take(200).collect();
            println!("          seed {seed}: {short}");
        }
    }
}

/// Runs the scenes of the seeds from one up to another, in as many processes as it takes.
fn run_all(trials: &Trials, mut from: u64, to: u64) -> Found {
    let mut found = Found::new();
    while from < to {
        let (mut child, lines) = spawn(trials, from, to - from);
        let mut running = None;
        loop {
            match lines.recv_timeout(HANGS) {
                Ok(line) => from = note(&line, from, &mut running, &mut found),
                Err(end) => {
                    if let Some(seed) = running {
                        add(&mut found, seed, &format!("BROKEN process: {end:?}"), "");
                        from = seed + 1;
                    }
                    break;
                }
            }
        }
        let _ = child.kill();
        let _ = child.wait();
    }
    found
}

/// Notes a line of a process; the answer is the first seed that has not been run.
fn note(line: &str, from: u64, running: &mut Option<u64>, found: &mut Found) -> u64 {
    if let Some(seed) = line.strip_prefix("start ") {
        *running = seed.parse().ok();
        return from;
    }
    let (Some(end), Some(seed)) = (line.strip_prefix("end "), running.take()) else { return from };
    let (kind, what) = end.split_once('\t').unwrap_or((end, ""));
    add(found, seed, kind, what);
    seed + 1
}

/// Notes how a scene ended, and tells at once what did not run to its end.
fn add(found: &mut Found, seed: u64, kind: &str, what: &str) {
    if kind != Verdict::Finished.kind() {
        eprintln!("seed {seed}: {kind}: {what}");
    }
    found.entry(kind.to_owned()).or_default().push((seed, what.to_owned()));
}

fn spawn(Trials { scenes, needs }: &Trials, first: u64, count: u64) -> (Child, Receiver<String>) {
    let program = std::env::current_exe().expect("this program has a path");
    let mut child = Command::new(program)
        .args([WORKER, "--seed", &first.to_string(), "--count", &count.to_string()])
        .args(scenes.option())
        .args(names_of(needs).iter().flat_map(|names| [NEEDS, names]))
        .stdout(Stdio::piped())
        .spawn()
        .expect("a process can be started");
    let output = child.stdout.take().expect("it is piped");
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        for line in BufReader::new(output).lines() {
            let Ok(line) = line else { break };
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    (child, receiver)
}
