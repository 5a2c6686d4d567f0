//! Prints the figures by which the rooms of the advance are kept: ARCHITECTURE.md says what they are for.
//!
//! ```text
//! cargo run -p halfgap-tests --example figures
//! ```
//!
//! It reads the sources of `crates/advance`, without their tests, and ends with an error if a figure is beyond its
//! bound. It is a reader of lines, not of Rust: it relies on the layout that rustfmt gives.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::ExitCode;

/// The rooms, each of which may import those before it only.
const ROOMS: [&str; 16] = [
    "bodies",
    "connectors",
    "contacts",
    "sinking",
    "search",
    "group",
    "watch",
    "books",
    "zeno",
    "region",
    "impact",
    "active_set",
    "stepping",
    "event",
    "ticks",
    "due",
];
/// Largest number of methods of `RigidSystem`.
const MOST_METHODS: usize = 60;
/// Largest number of files in a circle of imports.
const LONGEST_CIRCLE: usize = 4;
/// Largest number of named constants in `rigid`.
const MOST_CONSTANTS: usize = 150;
/// Largest number of lines of a file.
const LONGEST_FILE: usize = 350;
/// Largest number of lines of a function.
const LONGEST_FUNCTION: usize = 100;
/// Largest number of lines of the function below which 95 of 100 are.
const LONG_FUNCTION: usize = 40;

/// A source file without its tests.
struct Source {
    /// Path in `src`, such as `rigid/event/rules.rs`.
    path: String,
    lines: Vec<String>,
}

impl Source {
    /// Its room; `None` for files that are in none.
    fn room(&self) -> Option<&str> {
        let (room, _) = self.path.strip_prefix("rigid/")?.split_once('/')?;
        Some(room)
    }

    /// Its module path, such as `rigid::event::rules`.
    fn module(&self) -> String {
        let path = self.path.trim_end_matches(".rs").trim_end_matches("/mod");
        path.replace('/', "::")
    }

    /// Its lines without comments.
    fn code(&self) -> impl Iterator<Item = &str> {
        self.lines.iter().map(|line| line.split("//").next().unwrap_or_default())
    }
}

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/advance/src");
    let mut sources = Vec::new();
    collect(&root, &root, &mut sources);
    sources.sort_by(|a: &Source, b: &Source| a.path.cmp(&b.path));
    let imports = imports(&sources);
    let lengths = function_lengths(&sources);
    let percentile = |share: f64| lengths[((lengths.len() - 1) as f64 * share) as usize].0;
    let (longest, place) = lengths.last().cloned().unwrap_or_default();
    let (file_length, file) =
        sources.iter().map(|source| (source.lines.len(), &source.path)).max().expect("files");
    let circle = longest_circle(&imports);
    let up = arrows_up(&sources, &imports);
    let writes = foreign_writes(&sources);
    let figures = [
        ("methods of RigidSystem", methods(&sources), MOST_METHODS, String::new()),
        ("files in the longest circle of imports", circle.len(), LONGEST_CIRCLE, names(&sources, &circle)),
        ("imports from a later room", up.len(), 0, up.join(", ")),
        ("fields written from another room", writes.len(), 0, writes.join(", ")),
        ("named constants in rigid", constants(&sources), MOST_CONSTANTS, String::new()),
        ("lines of the longest file", file_length, LONGEST_FILE, file.clone()),
        ("lines of the longest function", longest, LONGEST_FUNCTION, place),
        ("lines of a function, 95th percentile", percentile(0.95), LONG_FUNCTION, String::new()),
    ];
    println!(
        "{} files, {} functions of {} lines at the median",
        sources.len(),
        lengths.len(),
        percentile(0.5)
    );
    let mut is_fine = true;
    for (name, figure, most, what) in figures {
        let verdict = if figure <= most { "" } else { "  BEYOND" };
        println!("{figure:>6} of at most {most:>4}  {name}{verdict}  {what}");
        is_fine &= figure <= most;
    }
    if is_fine { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Reads all files in a folder, but those of tests.
fn collect(root: &Path, folder: &Path, sources: &mut Vec<Source>) {
    let entries = std::fs::read_dir(folder).expect("the sources are there").flatten();
    for path in entries.map(|entry| entry.path()) {
        if path.is_dir() {
            collect(root, &path, sources);
        } else if !is_of_tests(&path) {
            let text = std::fs::read_to_string(&path).expect("a source can be read");
            let text = text.split("\n#[cfg(test)]\nmod tests {").next().unwrap_or_default();
            let path = path.strip_prefix(root).expect("a path below the root").display().to_string();
            sources.push(Source { path, lines: text.lines().map(str::to_owned).collect() });
        }
    }
}

fn is_of_tests(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    name == "tests.rs" || name == "test_scene.rs"
}

/// For each file the indices of the files that it imports from.
fn imports(sources: &[Source]) -> Vec<BTreeSet<usize>> {
    let by_module: BTreeMap<String, usize> =
        sources.iter().enumerate().map(|(index, source)| (source.module(), index)).collect();
    let find = |path: &str| {
        let mut path = path;
        loop {
            match by_module.get(path) {
                Some(&index) => return Some(index),
                None => path = path.rsplit_once("::")?.0,
            }
        }
    };
    let of_source = |(index, source): (usize, &Source)| {
        let code = source.code().collect::<Vec<_>>().join(" ");
        let uses = code.split("use crate::").skip(1).filter_map(|rest| rest.split(';').next());
        let mut found = BTreeSet::new();
        for path in uses {
            let path = path.replace(' ', "");
            let (head, names) = path.split_once('{').unwrap_or((&path, ""));
            let names = names.trim_end_matches('}').split(',');
            found.extend(names.filter_map(|name| find(&format!("{head}{name}"))));
        }
        found.remove(&index);
        found
    };
    sources.iter().enumerate().map(of_source).collect()
}

/// The largest set of files each of which imports all others, be it through others; empty if there is none.
fn longest_circle(imports: &[BTreeSet<usize>]) -> Vec<usize> {
    let reached: Vec<BTreeSet<usize>> = (0..imports.len()).map(|from| reached(imports, from)).collect();
    let circles = (0..imports.len()).map(|from| {
        let circle: Vec<usize> =
            reached[from].iter().copied().filter(|&to| reached[to].contains(&from)).collect();
        circle
    });
    circles.max_by_key(Vec::len).unwrap_or_default()
}

fn reached(imports: &[BTreeSet<usize>], from: usize) -> BTreeSet<usize> {
    let (mut found, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(file) = open.pop() {
        open.extend(imports[file].iter().copied().filter(|&to| found.insert(to)));
    }
    found
}

fn names(sources: &[Source], files: &[usize]) -> String {
    files.iter().map(|&file| sources[file].path.as_str()).collect::<Vec<_>>().join(", ")
}

/// Imports of rooms from rooms that come later in [`ROOMS`].
fn arrows_up(sources: &[Source], imports: &[BTreeSet<usize>]) -> Vec<String> {
    let place = |source: &Source| ROOMS.iter().position(|&room| source.room() == Some(room));
    let mut found = Vec::new();
    for (source, imports) in sources.iter().zip(imports) {
        for import in imports.iter().map(|&index| &sources[index]) {
            if place(source).zip(place(import)).is_some_and(|(from, to)| to > from) {
                found.push(format!("{} from {}", source.path, import.path));
            }
        }
    }
    found
}

/// Assignments to fields of structs of another room that are visible beyond it.
fn foreign_writes(sources: &[Source]) -> Vec<String> {
    let mut rooms: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for source in sources {
        let Some(room) = source.room() else { continue };
        for line in source.code().filter(|line| line.starts_with("    ")) {
            let Some((name, _)) = line.trim_start().split_once(": ") else { continue };
            let (visibility, name) = name.rsplit_once(' ').unwrap_or(("", name));
            if name.chars().all(|letter| letter.is_lowercase() || letter == '_') && !visibility.contains("fn")
            {
                let room = if visibility == "pub" || visibility == "pub(crate)" { room } else { "" };
                rooms.entry(name).or_default().insert(room);
            }
        }
    }
    let mut found = Vec::new();
    for source in sources {
        let Some(room) = source.room() else { continue };
        for (number, line) in source.code().enumerate() {
            let assigned =
                [" = ", " += ", " -= ", " |= "].into_iter().filter_map(|sign| line.split_once(sign));
            // Responses are parts of records, which another crate makes for all rooms to fill.
            let is_own = |target: &str| !target.contains("let ") && !target.contains(".response.");
            for (target, _) in assigned.take(1).filter(|(target, _)| is_own(target)) {
                let target = target.split('[').next().unwrap_or_default();
                let Some((_, field)) = target.rsplit_once('.') else { continue };
                let is_foreign = |rooms: &BTreeSet<&str>| {
                    !rooms.contains(room) && !rooms.contains("") && rooms.iter().any(|of| ROOMS.contains(of))
                };
                if rooms.get(field.trim()).is_some_and(is_foreign) {
                    found.push(format!("{}:{} {}", source.path, number + 1, line.trim()));
                }
            }
        }
    }
    found
}

fn methods(sources: &[Source]) -> usize {
    let mut count = 0;
    for source in sources {
        let mut is_inside = false;
        for line in source.code() {
            match line {
                "impl RigidSystem {" => is_inside = true,
                "}" => is_inside = false,
                _ => count += usize::from(is_inside && is_function(line) && line.starts_with("    ")),
            }
        }
    }
    count
}

fn is_function(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with("fn ") || (line.starts_with("pub") && line.contains(" fn "))
}

fn constants(sources: &[Source]) -> usize {
    let rigid = sources.iter().filter(|source| source.path.starts_with("rigid/"));
    let is_constant = |line: &&str| {
        let line = line.trim_start();
        let line = line.strip_prefix("pub(crate) ").or(line.strip_prefix("pub(super) ")).unwrap_or(line);
        let line = line.strip_prefix("pub ").unwrap_or(line);
        line.strip_prefix("const ").is_some_and(|rest| rest.starts_with(char::is_uppercase))
    };
    rigid.map(|source| source.code().filter(is_constant).count()).sum()
}

/// Lengths of all functions with the place of each, sorted.
fn function_lengths(sources: &[Source]) -> Vec<(usize, String)> {
    let mut lengths = Vec::new();
    for source in sources {
        for (number, line) in source.lines.iter().enumerate().filter(|(_, line)| is_function(line)) {
            let indent = line.len() - line.trim_start().len();
            let end = format!("{}}}", " ".repeat(indent));
            let length =
                source.lines[number..].iter().position(|line| *line == end).map_or(1, |last| last + 1);
            let declares =
                source.lines[number..].iter().find(|line| line.ends_with(';') || line.ends_with('{'));
            if declares.is_some_and(|line| line.ends_with('{')) {
                lengths.push((length, format!("{}:{}", source.path, number + 1)));
            }
        }
    }
    lengths.sort();
    lengths
}
