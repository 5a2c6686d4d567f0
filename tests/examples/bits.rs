//! Prints a hash of all states, forces and events of all scenes, to tell whether a change moved a bit.
//!
//! ```text
//! cargo run --profile dist -p halfgap-tests --example bits
//! cargo run --profile dist -p halfgap-tests --example bits -- --count 100 --each   # a line for each scene
//! cargo run --profile dist -p halfgap-tests --example bits -- --remedies           # how often each remedy acts
//! cargo run --profile dist -p halfgap-tests --example bits -- --without haste      # with one remedy off
//! ```
//!
//! The scenes of the repository, the reference scenes, those with friction, and `--count` generated ones of each kind. A run ends after so
//! many reports of its progress, not after a time, so that the hash is the same on a slow machine.

use halfgap::scene::{Scene, SceneFormat};
use halfgap::{Record, Remedy, RemedyCounts, RemedySet, RunPlan, World, WorldBuilder, run};
use halfgap_tests::generate::{
    coarse_of_seed, impulses_of_seed, pushed_stack_of_seed, rough_of_seed, scene_of_seed, variation_of_seed,
};
use halfgap_tests::{data, names_in, reference_scene_names};
use serde_json::Value;
use std::fmt::{self, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Reports of progress after which a run ends: events, outputs, and every so many steps without either.
const LONGEST: u32 = 1500;
/// Threads that run scenes.
const JOBS: usize = 2;

/// The name of a kind of generated scenes, and the scene of a seed.
type Kind = (&'static str, fn(u64) -> Value);

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let place = arguments.iter().position(|argument| argument == "--count");
    let count = place.map_or(1000, |place| arguments[place + 1].parse().expect("a number follows --count"));
    let without = arguments.iter().position(|argument| argument == "--without");
    let without = without.map_or(RemedySet::NONE, |place| {
        let name = arguments.get(place + 1).expect("a name follows --without");
        let remedy = Remedy::ALL.into_iter().find(|remedy| remedy.name() == name);
        RemedySet::NONE.with(remedy.expect("a remedy has that name"))
    });
    let prints_remedies = arguments.iter().any(|argument| argument == "--remedies");
    let prints_each = arguments.iter().any(|argument| argument == "--each");
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let mut files: Vec<_> = std::fs::read_dir(scenes).expect("the scenes are there").flatten().collect();
    files.sort_by_key(std::fs::DirEntry::path);
    let outcomes = |count: usize, scene: &(dyn Fn(usize) -> Scene + Sync)| outcomes(count, scene, without);
    let of_repository =
        outcomes(files.len(), &|index| Scene::read(files[index].path()).expect("a fine scene"));
    let of_folder = |folder: &str, names: &[String]| {
        outcomes(names.len(), &|index| {
            Scene::read(data(&format!("{folder}/{}.json", names[index]))).expect("a fine scene")
        })
    };
    let reference = of_folder("scenes", &reference_scene_names());
    let friction = of_folder("friction", &names_in("friction"));
    let mut groups = vec![("repository", of_repository), ("reference", reference), ("friction", friction)];
    let kinds: [Kind; 6] = [
        ("ordinary", scene_of_seed),
        ("coarse", coarse_of_seed),
        ("impulses", impulses_of_seed),
        ("varied", variation_of_seed),
        ("rough", rough_of_seed),
        ("pushed", pushed_stack_of_seed),
    ];
    for (kind, of_seed) in kinds {
        let scene = |index| Scene::parse(&of_seed(1 + index as u64).to_string(), SceneFormat::Json);
        groups.push((kind, outcomes(count, &|index| scene(index).expect("a generated scene can be read"))));
    }
    if prints_remedies {
        print_remedies(&groups);
        return;
    }
    for (kind, outcomes) in groups {
        let hashes: Vec<u64> = outcomes.iter().map(|outcome| outcome.hash).collect();
        if prints_each {
            for (index, hash) in hashes.iter().enumerate() {
                println!("{kind} {} {hash:016x}", index + 1);
            }
        }
        let mut all = Hash::new();
        write!(all, "{hashes:?}").expect("hashing never fails");
        println!("{kind:<10} {:>5} scenes  {:016x}", hashes.len(), all.0);
    }
}

/// What became of a scene.
#[derive(Clone, Copy, Default)]
struct Outcome {
    hash: u64,
    remedies: RemedyCounts,
}

/// Prints, for each remedy and each group of scenes, in how many scenes it acted.
fn print_remedies(groups: &[(&str, Vec<Outcome>)]) {
    let titles = groups.iter().map(|(kind, outcomes)| format!("{kind} ({})", outcomes.len()));
    println!("| remedy | {} |", titles.collect::<Vec<_>>().join(" | "));
    println!("|---|{}", "---:|".repeat(groups.len()));
    for remedy in Remedy::ALL {
        let acted = groups.iter().map(|(_, outcomes)| {
            let acted = outcomes.iter().filter(|outcome| outcome.remedies.of(remedy) > 0);
            acted.count().to_string()
        });
        println!("| `{}` | {} |", remedy.name(), acted.collect::<Vec<_>>().join(" | "));
    }
}

/// What becomes of so many scenes, by their number.
fn outcomes(count: usize, scene: &(dyn Fn(usize) -> Scene + Sync), without: RemedySet) -> Vec<Outcome> {
    let (next, found) = (AtomicUsize::new(0), Mutex::new(vec![Outcome::default(); count]));
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                return;
            }
            let outcome = outcome_of(&scene(index), without);
            found.lock().expect("no thread panics")[index] = outcome;
        }
    };
    std::thread::scope(|scope| (0..JOBS).for_each(|_| drop(scope.spawn(work))));
    found.into_inner().expect("no thread panics")
}

/// The hash of all that a run records, of the error that it ends with, or of that which refuses the scene.
fn outcome_of(scene: &Scene, without: RemedySet) -> Outcome {
    let (mut hash, mut remedies) = (Hash::new(), RemedyCounts::default());
    // An error is written as that of the scene, which names the field.
    let refused = || World::from_scene(scene).map_or_else(|error| error.to_string(), |_| String::new());
    let world = WorldBuilder::from_scene(scene).map_err(|_| refused()).and_then(|mut builder| {
        builder.settings_mut().without = without;
        builder.build().map_err(|_| refused())
    });
    let written = match world {
        Ok(mut world) => {
            let mut reports = 0;
            let report = run(&mut world, &RunPlan::of_scene(scene, Record::Everything), &mut |_| {
                reports += 1;
                if reports < LONGEST { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            });
            remedies = world.statistics().remedies;
            write!(hash, "{:?} {:?} {:?}", report.recording, report.error, report.findings)
        }
        Err(error) => write!(hash, "{error}"),
    };
    written.expect("hashing never fails");
    Outcome { hash: hash.0, remedies }
}

/// FNV-1a of 64 bits. Numbers are written with all the digits that tell them apart.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        Ok(())
    }
}
