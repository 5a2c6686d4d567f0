//! Generated scenes, about a minute of them: what must hold does.
//!
//! The longer run is the example `fuzz`.

use halfgap_tests::generate::scene_of_seed;
use halfgap_tests::invariants::{Budget, Verdict, silence_panics, trial};
use std::collections::BTreeMap;

/// Scenes of a run.
const COUNT: u64 = 300;

#[test]
fn what_must_hold_holds_in_generated_scenes() {
    silence_panics();
    let mut kinds: BTreeMap<String, u64> = BTreeMap::new();
    let mut broken = Vec::new();
    for seed in 1..=COUNT {
        let verdict = trial(&scene_of_seed(seed).to_string(), Budget::default());
        *kinds.entry(verdict.kind()).or_default() += 1;
        if let Verdict::Broken(what) = verdict {
            broken.push((seed, what));
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
    assert!(kinds.get("finished").is_some_and(|count| *count > COUNT / 2), "{kinds:#?}");
}
