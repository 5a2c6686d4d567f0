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
