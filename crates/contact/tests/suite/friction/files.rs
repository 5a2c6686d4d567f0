//! The problems of the collection: by Lemke's method as they stand, and rebuilt as contacts with friction by all methods.

use super::judge::judge;
use halfgap_contact::{
    Auto, ContactFile, FileError, Lemke, Method, Modes, Problem, RowKind, Solution, SolveError, Solver,
};
use std::path::Path;

/// Number of rows from which a problem in four rows a contact is large.
const LARGE: usize = 1000;

/// The files, by name.
fn files() -> Vec<(String, ContactFile)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/contact");
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder.join("friction")).expect("the folder") {
        paths.push(entry.expect("a file").path());
    }
    for entry in std::fs::read_dir(folder.join("problems")).expect("the folder") {
        let path = entry.expect("a file").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if name.starts_with("fr_") {
            paths.push(path);
        }
    }
    paths.sort();
    let read = |path: &std::path::PathBuf| {
        let text = std::fs::read_to_string(path).expect("a text");
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        (name, ContactFile::parse(&text).expect("a problem"))
    };
    paths.iter().map(read).collect()
}

/// A problem in four rows a contact as one with friction, and where its rows and those of its slips are: a row σ has no
/// diagonal, mu at its normal row and -1 at the two of its friction.
fn rebuild(plain: &Problem) -> (Problem, Vec<[usize; 3]>, Vec<usize>) {
    let (a, n) = (plain.dense(), plain.len());
    let contacts: Vec<[usize; 4]> = (0..n)
        .filter_map(|slip| {
            let lifted: Vec<usize> = (0..n).filter(|&j| a[slip][j] == -1.0 && a[j][slip] == 1.0).collect();
            let normal = (0..n).find(|&j| a[slip][j] > 0.0 && a[j][slip] == 0.0)?;
            (a[slip][slip] == 0.0 && lifted.len() == 2).then(|| [normal, lifted[0], lifted[1], slip])
        })
        .collect();
    let left_out: Vec<usize> = contacts.iter().flat_map(|c| [c[2], c[3]]).collect();
    let kept: Vec<usize> = (0..n).filter(|row| !left_out.contains(row)).collect();
    let place = |row: usize| kept.iter().position(|kept| *kept == row).expect("a row that is kept");
    let rows: Vec<Vec<f64>> = kept.iter().map(|&i| kept.iter().map(|&j| a[i][j]).collect()).collect();
    let offset: Vec<f64> = kept.iter().map(|&row| plain.offset()[row]).collect();
    let mut problem = Problem::from_general_dense(&rows, &offset).expect("a matrix");
    for [normal, plus, _, slip] in &contacts {
        let kind = RowKind::Friction { normal: place(*normal), coefficient: a[*slip][*normal] };
        problem.set_kind(place(*plus), kind).expect("a fine row");
    }
    (problem, contacts.iter().map(|c| [c[0], c[1], c[2]]).collect(), kept)
}

#[test]
fn every_file_is_solved_as_it_stands_and_rebuilt() {
    let mut solution = Solution::new();
    let (mut rebuilt, mut without, mut recognised) = (0, 0, 0);
    for (name, file) in files() {
        let plain = file.problem().expect("a problem");
        // Lemke's method is tried on the largest, which take it seconds, by the tests of the collection.
        let is_large = plain.len() > LARGE;
        let outcome = if is_large { Ok(()) } else { Lemke::default().solve(&plain, &mut solution) };
        let is_solved = outcome.is_ok();
        match file.feasible {
            Some(true) => assert!(is_solved, "{name}: {outcome:?}"),
            Some(false) => assert!(matches!(outcome, Err(SolveError::Infeasible(_))), "{name}: {outcome:?}"),
            None => {}
        }
        let plain_force = solution.force.clone();
        // Large ones are recognised as what they are.
        let outcome = Auto::default().solve(&plain, &mut solution);
        assert_eq!(outcome.is_ok(), is_solved, "{name}: {outcome:?}");
        recognised += usize::from(is_solved && solution.method == Method::Modes);
        let (problem, contacts, kept) = rebuild(&plain);
        let mut methods: Vec<Box<dyn Solver>> = vec![Box::new(Auto::default())];
        if !contacts.is_empty() {
            methods.push(Box::new(Modes::default()));
        }
        if !contacts.is_empty() && !is_large {
            methods.push(Box::new(Lemke::default()));
        }
        for mut method in methods {
            let outcome = method.solve(&problem, &mut solution);
            assert_eq!(outcome.is_ok(), is_solved, "{name} by {}: {outcome:?}", method.method());
            if !is_solved {
                without += 1;
                continue;
            }
            let judged = judge(&problem, &solution.force);
            assert!(judged.good(), "{name} by {}: {judged:?}", method.method());
            rebuilt += 1;
            let Some(expected) = file.expected.as_ref().and_then(|e| e.force.as_ref()) else { continue };
            let mut known = plain_force.clone();
            known.clone_from(expected);
            for [_, plus, minus] in &contacts {
                known[*plus] -= known[*minus];
            }
            let size = known.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
            for (at, &row) in kept.iter().enumerate() {
                assert!((solution.force[at] - known[row]).abs() <= 1e-9 * size, "{name}, row {row}");
            }
        }
    }
    assert!(recognised >= 10, "{recognised} recognised");
    assert!(rebuilt > 40 && without > 0, "{rebuilt} rebuilt, {without} without a solution");
}

#[test]
fn a_problem_with_friction_is_written_and_read() {
    let text = r#"{"format":"halfgap-contact-1","A":[[2.0,0.5],[0.5,1.0]],"b":[-1.0,0.3],
        "friction":[{"row":1,"normal":0,"coefficient":0.4}]}"#;
    let problem = ContactFile::parse(text).and_then(|file| file.problem()).expect("a problem");
    assert_eq!(problem.kind(1), RowKind::Friction { normal: 0, coefficient: 0.4 });
    let again = ContactFile::of(&problem).to_json().expect("a text");
    assert_eq!(ContactFile::parse(&again).and_then(|file| file.problem()).expect("a problem"), problem);
    let bounded = r#"{"format":"halfgap-contact-1","A":[[2.0]],"b":[-1.0],"bounds":[{"row":0,"most":3.0}]}"#;
    let problem = ContactFile::parse(bounded).and_then(|file| file.problem()).expect("a problem");
    assert_eq!(problem.kind(0), RowKind::Bounded { least: f64::NEG_INFINITY, most: 3.0 });
    let error = |text: &str| ContactFile::parse(text).and_then(|file| file.problem()).expect_err("wrong");
    let misplaced = text.replace(r#""row":1"#, r#""row":7"#);
    assert!(matches!(error(&misplaced), FileError::Problem(_)), "{}", error(&misplaced));
    let wordy = text.replace("0.4", "\"much\"");
    let words = "field `friction[0]` must be an object with whole numbers `row` and `normal`";
    assert!(error(&wordy).to_string().starts_with(words), "{}", error(&wordy));
}
