//! Generated scenes of bodies that fly and collide: what must hold does.
//!
//! The example `fuzz` runs scenes of all kinds, as many as one likes.

use halfgap_tests::generate::billiard_of_seed;
use halfgap_tests::invariants::{Budget, Verdict, silence_panics, trial};
use std::collections::BTreeMap;

/// Scenes of a run.
const COUNT: u64 = 380;

#[test]
fn what_must_hold_holds_in_generated_billiards() {
    silence_panics();
    let mut kinds: BTreeMap<String, u64> = BTreeMap::new();
    let mut broken = Vec::new();
    for seed in 1..=COUNT {
        let verdict = trial(&billiard_of_seed(seed).to_string(), Budget::default());
        *kinds.entry(verdict.kind()).or_default() += 1;
        if !matches!(verdict, Verdict::Finished | Verdict::Refused(_)) {
            broken.push((seed, verdict));
        }
    }
    // From here on panics are heard again.
    drop(std::panic::take_hook());
    println!("{kinds:#?}");
    assert!(broken.is_empty(), "{broken:#?}");
    assert!(kinds.get("finished").is_some_and(|count| *count > COUNT * 9 / 10), "{kinds:#?}");
}
