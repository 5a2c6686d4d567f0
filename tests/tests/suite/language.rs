//! Scenes with names, expressions and repetition are the same as those written out.

use halfgap::scene::Scene;
use halfgap_tests::data;
use std::collections::BTreeMap;

/// Largest difference of two numbers [-], as a share of their size or of 1: rounding of a few operations.
const ROUNDING: f64 = 1e-15;

/// All numbers of a value's debug text, and the text around them.
fn parts(text: &str) -> (Vec<f64>, String) {
    let (mut numbers, mut rest) = (Vec::new(), String::new());
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || ".+-_".contains(letter);
    for word in text.split_inclusive(|letter| !is_part(letter)) {
        let (word, end) = word.split_at(word.trim_end_matches(|letter| !is_part(letter)).len());
        match word.parse::<f64>() {
            Ok(number) => numbers.push(number),
            Err(_) => rest.push_str(word),
        }
        rest.push_str(end);
    }
    (numbers, rest)
}

fn assert_same(name: &str, written: &Scene, plain: &Scene) {
    let ((numbers, text), (expected, plain)) = (parts(&format!("{written:?}")), parts(&format!("{plain:?}")));
    assert_eq!(text, plain, "{name}");
    for (number, expected) in numbers.iter().zip(&expected) {
        assert!(
            (number - expected).abs() <= ROUNDING * expected.abs().max(1.0),
            "{name}: {number} of {expected}"
        );
    }
}

#[test]
fn scenes_are_as_if_written_out() {
    let mut sizes = BTreeMap::new();
    for name in ["let_and_expressions", "repeat_ring_pairs", "repeat_row"] {
        let [mut written, plain] = ["toml", "json"]
            .map(|ending| Scene::read(data(&format!("language/{name}.{ending}"))).expect("a good scene"));
        // Titles are for people.
        written.title.clone_from(&plain.title);
        assert_same(name, &written, &plain);
        sizes.insert(name, written.bodies.len());
    }
    assert_eq!(sizes.into_values().collect::<Vec<_>>(), [1, 6, 5]);
}
