//! Mangled scene files are read, or refused with a message; nothing panics.

use halfgap::scene::{Scene, SceneFormat};
use halfgap_tests::random::Random;
use halfgap_tests::{data, reference_scene_names};
use std::fs::read_to_string;
use std::panic::catch_unwind;
use std::path::Path;

/// Number of mangled texts of each format.
const COUNT: u64 = 6000;
/// Largest length of a file [bytes]: longer files test nothing that shorter ones do not.
const LONGEST: usize = 12_000;
/// Replacements of a number or a word.
const EXTREMES: [&str; 22] = [
    "0",
    "-0.0",
    "-1",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "1e400",
    "nan",
    "inf",
    "-inf",
    "NaN",
    "null",
    "true",
    "\"\"",
    "[]",
    "{}",
    "99999999999999999999",
    "18446744073709551616",
    "\"world\"",
    "[1, 2, 3]",
    "1e-16",
];

/// Replacements in scenes with names, expressions and repetition, beside those.
const EXPRESSIONS: [&str; 12] = [
    "\"= 1/0\"",
    "\"= i\"",
    "\"= n\"",
    "\"= -n^9^9\"",
    "\"= ((((\"",
    "\"= sqrt(-1e9)\"",
    "\"=\"",
    "\"{i}\"",
    "let",
    "repeat",
    "n",
    "pi",
];
/// Scenes with names, expressions and repetition.
const LANGUAGE: [&str; 3] = ["let_and_expressions", "repeat_ring_pairs", "repeat_row"];

fn texts(format: SceneFormat) -> Vec<String> {
    let paths: Vec<_> = match format {
        SceneFormat::Json => {
            reference_scene_names().iter().map(|name| data(&format!("scenes/{name}.json"))).collect()
        }
        SceneFormat::Toml => {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
            let files = std::fs::read_dir(folder).expect("the scenes to look at are there");
            files.map(|file| file.expect("a readable entry").path()).collect()
        }
    };
    let mut texts: Vec<String> =
        paths.iter().map(|path| read_to_string(path).expect("a readable scene")).collect();
    texts.retain(|text| text.len() < LONGEST);
    texts.sort();
    assert!(texts.len() > 5, "{} texts", texts.len());
    texts
}

/// Beginnings and ends of words and numbers.
fn tokens(text: &str) -> Vec<(usize, usize)> {
    let belongs = |c: char| c.is_alphanumeric() || "_.-+\"".contains(c);
    let mut tokens = Vec::new();
    let mut start = None;
    for (at, c) in text.char_indices().chain([(text.len(), ' ')]) {
        match (belongs(c), start) {
            (true, None) => start = Some(at),
            (false, Some(from)) => {
                tokens.push((from, at));
                start = None;
            }
            _ => {}
        }
    }
    tokens
}

fn mangle(random: &mut Random, text: &str) -> String {
    let mut mangled = text.to_owned();
    for _ in 0..1 + random.below(3) {
        mangled = match random.below(6) {
            0 => with_other_bytes(random, &mangled),
            1 => with_other_line(random, &mangled),
            2 => mangled.chars().take(random.below(mangled.len().max(1))).collect(),
            _ => with_other_token(random, &mangled, &EXTREMES),
        };
    }
    mangled
}

fn with_other_bytes(random: &mut Random, text: &str) -> String {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..1 + random.below(4) {
        let at = random.below(bytes.len().max(1));
        if let Some(byte) = bytes.get_mut(at) {
            *byte = random.one_of(b"{}[]\",:=.-e09ax \n\0\xff\xc3#");
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The text with a line left out, or repeated.
fn with_other_line(random: &mut Random, text: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    if !lines.is_empty() {
        let at = random.below(lines.len());
        if random.chance(0.7) {
            lines.remove(at);
        } else {
            lines.insert(at, lines[at]);
        }
    }
    lines.join("\n")
}

/// The text with a word or a number replaced by one of `others`, or by another one of the text.
fn with_other_token(random: &mut Random, text: &str, others: &[&str]) -> String {
    let tokens = tokens(text);
    if tokens.is_empty() {
        return text.to_owned();
    }
    let (from, to) = tokens[random.below(tokens.len())];
    let (start, end) = tokens[random.below(tokens.len())];
    let other = if random.chance(0.7) { random.one_of(others) } else { &text[start..end] };
    format!("{}{other}{}", &text[..from], &text[to..])
}

/// Parses mangled texts; counts those that are still scenes.
fn run(format: SceneFormat, texts: &[String], mangle: impl Fn(&mut Random, &str) -> String) {
    let mut parsed = 0;
    for seed in 0..COUNT {
        let mut random = Random::new(seed);
        let mangled = mangle(&mut random, &texts[seed as usize % texts.len()]);
        let outcome = catch_unwind(|| Scene::parse(&mangled, format).map_err(|error| error.to_string()));
        match outcome {
            Ok(Ok(_)) => parsed += 1,
            Ok(Err(message)) => assert!(!message.is_empty(), "seed {seed}: refused without a word"),
            Err(_) => panic!("seed {seed} makes the reader panic:\n{mangled}"),
        }
    }
    println!("{COUNT} texts: {parsed} parsed");
    // Some changes are harmless, most are not; otherwise nothing was tried.
    assert!(parsed > COUNT / 20 && parsed < COUNT * 9 / 10, "{parsed} parsed");
}

#[test]
fn mangled_json_never_panics() {
    run(SceneFormat::Json, &texts(SceneFormat::Json), mangle);
}

#[test]
fn mangled_toml_never_panics() {
    run(SceneFormat::Toml, &texts(SceneFormat::Toml), mangle);
}

#[test]
fn mangled_expressions_never_panic() {
    let read = |name| read_to_string(data(&format!("language/{name}.toml"))).expect("a readable scene");
    let others = [&EXTREMES[..], &EXPRESSIONS].concat();
    run(SceneFormat::Toml, &LANGUAGE.map(read), |random, text| with_other_token(random, text, &others));
}
