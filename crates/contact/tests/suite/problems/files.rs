//! Problems written to a file and replayed.

use halfgap_contact::{Auto, ContactFile, FileError, Solution, SolutionFile, Solver};

use super::data::Case;

#[test]
fn a_dumped_problem_is_the_same_problem() {
    for name in ["pyramid_20", "run__chain_0", "fr_wedge_0", "redundant_joints_12"] {
        let case = Case::named(name);
        let text = ContactFile::of(&case.problem).to_json().unwrap();
        let replayed = ContactFile::parse(&text).unwrap().problem().unwrap();
        assert_eq!(replayed, case.problem, "{name}");
    }
}

#[test]
fn an_answer_is_written_with_its_residuals() {
    let case = Case::named("pyramid_10");
    let mut solution = Solution::new();
    Auto::default().solve(&case.problem, &mut solution).unwrap();
    let text = serde_json::to_string(&SolutionFile::of(&solution)).unwrap();
    assert!(
        text.starts_with(r#"{"format":"halfgap-solution-1","status":"solved","method":"dual_active_set""#)
    );
}

#[test]
fn wrong_files_are_explained() {
    let error = |text: &str| ContactFile::parse(text).and_then(|file| file.problem()).unwrap_err();
    assert!(matches!(error(r#"{"format":"other","b":[]}"#), FileError::Format(_)));
    assert!(matches!(error(r#"{"format":"halfgap-contact-1","b":[1]}"#), FileError::Missing("A or J")));
    let both = r#"{"format":"halfgap-contact-1","b":[1],"A":[[1]],"J":{"rows":1,"columns":1,"triplets":[]},"inverse_mass":[1]}"#;
    assert!(matches!(error(both), FileError::Both));
    let not_a_number = error(r#"{"format":"halfgap-contact-1","b":[NaN],"A":[[1]]}"#);
    assert!(not_a_number.to_string().contains("NaN"), "{not_a_number}");
    let misspelt = r#"{"format":"halfgap-contact-1","bilatral":[true],"b":[1],"A":[[1]]}"#;
    assert_eq!(ContactFile::unknown_fields(misspelt), ["bilatral"]);
    let unsymmetric = error(r#"{"format":"halfgap-contact-1","A":[[1,2],[0,1]],"b":[0,0]}"#);
    assert!(unsymmetric.to_string().starts_with("row 0: A is not symmetric"), "{unsymmetric}");
}

#[test]
fn values_of_the_wrong_kind_are_named_with_their_field() {
    let error = |fields: &str| {
        let text = format!("{{\"format\":\"halfgap-contact-1\",{fields}}}");
        ContactFile::parse(&text).and_then(|file| file.problem()).unwrap_err().to_string()
    };
    let whole = "must be a whole number that is not negative";
    let sparse =
        |n: &str, entry: &str| error(&format!(r#""b":[-1,-1],"A":{{"n":{n},"triplets":[{entry}]}}"#));
    assert_eq!(sparse("2", "[0,-1,1]"), format!("field `A.triplets[0][1]` {whole}, got -1"));
    assert_eq!(sparse("2", "[0,1,1],[0.5,1,1]"), format!("field `A.triplets[1][0]` {whole}, got 0.5"));
    assert_eq!(sparse("100000000000000000000", ""), format!("field `A.n` {whole}, got 1e+20"));
    assert_eq!(sparse("2", "[0,1]"), "field `A.triplets[0]` must be [row, column, value], got an array");
    assert_eq!(error(r#""A":[[2]],"b":["x"]"#), r#"field `b[0]` must be a number, got "x""#);
    assert_eq!(error(r#""A":[[2],3],"b":[1,1]"#), "field `A[1]` must be an array of numbers, got 3");
    let matrix = "field `A` must be rows of numbers, or an object with `n` and `triplets`, got";
    assert_eq!(error(r#""A":7,"b":[1]"#), format!("{matrix} 7"));
    assert_eq!(error(r#""A":{"n":1},"b":[1]"#), format!("{matrix} an object"));
    assert_eq!(
        error(r#""A":[[2]],"b":[1],"bilateral":[0]"#),
        "field `bilateral[0]` must be true or false, got 0"
    );
    assert_eq!(
        error(r#""J":{"rows":1,"columns":true,"triplets":[]},"inverse_mass":[1],"b":[1]"#),
        format!("field `J.columns` {whole}, got true")
    );
    assert_eq!(
        error(r#""A":[[2]],"b":[1],"expected":{"force":3}"#),
        "field `expected.force` must be an array of numbers, got 3"
    );
    assert_eq!(error(r#""A":[[2]]"#), "field `b` is missing");
    assert_eq!(ContactFile::parse("[]").unwrap_err().to_string(), "the file must be an object, got an array");
    let scene = ContactFile::parse(r#"{"format":"halfgap-scene-1","title":"t"}"#).unwrap_err().to_string();
    assert_eq!(scene, r#"field `format` is "halfgap-scene-1", expected "halfgap-contact-1""#);
}

#[test]
fn known_answers_have_a_number_for_each_row() {
    for answer in
        [r#""reference_force":[5]"#, r#""expected":{"force":[5]}"#, r#""expected":{"acceleration":[1,2,3]}"#]
    {
        let text = format!(r#"{{"format":"halfgap-contact-1","A":[[2,1],[1,2]],"b":[-1,-1],{answer}}}"#);
        let error = ContactFile::parse(&text).and_then(|file| file.problem()).unwrap_err();
        assert!(error.to_string().ends_with("entries, expected 2"), "{error}");
    }
}
