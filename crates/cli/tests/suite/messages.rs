//! Messages on standard error.

use crate::command::{FLIGHT, Folder, halfgap};
use std::fs::OpenOptions;
use std::process::{Command, Output};

/// Runs the command with a full device for its standard error.
#[cfg(target_os = "linux")]
fn unheard(arguments: &[&str]) -> Output {
    let full = OpenOptions::new().write(true).open("/dev/full").expect("a device that takes nothing");
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfgap"));
    command.args(arguments).stderr(full).output().expect("the command runs")
}

#[test]
#[cfg(target_os = "linux")]
fn messages_that_cannot_be_written_cost_neither_the_result_nor_the_exit_code() {
    let folder = Folder::new("unheard");
    // A tolerance that coordinates of 10^9 m do not allow: each command warns.
    let scene = folder.write("far.toml", &FLIGHT.replace("mass = 2.0", "mass = 2.0\nposition = [1e9, 0.0]"));
    let bad = folder.write("bad.toml", &FLIGHT.replace("mass = 2.0", "mass = -2.0"));
    let problem =
        folder.write("one.json", r#"{"format":"halfgap-contact-1","A":[[2.0]],"b":[-4.0],"more":0}"#);
    let ends = |arguments: &[&str]| {
        let output = unheard(arguments);
        (output.status.code(), output.stdout.is_empty())
    };
    assert_eq!(ends(&["run", &scene, "--json", "--out", &folder.path("out")]), (Some(0), false));
    assert!(std::fs::exists(folder.path("out/result.json")).expect("a folder that can be read"));
    assert_eq!(ends(&["check", &scene, &bad]), (Some(2), false));
    assert_eq!(ends(&["sweep", &scene, "--vary", "body.disc.mass=1..2/2"]), (Some(0), false));
    assert_eq!(ends(&["solve", &problem]), (Some(0), false));
    assert_eq!(ends(&["solve", &scene]), (Some(2), true));
    assert_eq!(ends(&["run", &bad]), (Some(2), true));
    assert_eq!(ends(&["run"]), (Some(2), true));
}

#[test]
fn names_in_the_table_stay_on_their_line_and_can_be_told_apart() {
    let folder = Folder::new("names");
    let body = |number: u32| {
        format!(
            "[[body]]\nname = \"a body with quite a long\\nname, number {number}\"\nmass = 1.0\nposition = [{number}, 9]\n\
             shape = {{ disc = {{ radius = 0.1 }} }}\n"
        )
    };
    let bodies = [FLIGHT, &body(1), &body(2)].concat();
    let text = folder.plain(&halfgap(&["run", &folder.write("names.toml", &bodies)]).stdout);
    let rows: Vec<String> =
        text.lines().skip(3).take(3).map(|line| line.chars().take(24).collect()).collect();
    assert_eq!(rows, ["disc                    ", "a body with…me, number 1", "a body with…me, number 2"]);
}

#[test]
fn a_recording_that_would_not_fit_into_memory_is_refused_before_the_run() {
    let folder = Folder::new("states");
    let body = |number: u32| {
        format!(
            "[[body]]\nname = \"{number}\"\nmass = 1.0\nposition = [{number}, 9]\nshape = {{ disc = {{ radius = 0.1 }} }}\n"
        )
    };
    let fine = FLIGHT.replace("duration = 2.0", "duration = 2.0\noutput_step = 2e-6");
    let bodies: String = (1..60).map(body).collect();
    let scene = folder.write("many.toml", &[&fine, &*bodies].concat());
    for option in [&["--out", &folder.path("out")][..], &["--estimate-error"]] {
        let output = halfgap(&[&["run", &scene], option].concat());
        assert_eq!(output.status.code(), Some(2));
        insta::allow_duplicates! {
            insta::assert_snapshot!(folder.plain(&output.stderr), @r"
            error: many.toml:6: run.output_step: would record 60000060 states, of 60 bodies at 1000001 times; at most 50000000 are allowed, as with an `output_step` of 2.42e-6 s
               |
             6 | output_step = 2e-6
               | ^
            ");
        }
    }
    assert!(!std::path::Path::new(&folder.path("out")).exists());
    assert_eq!(halfgap(&["run", &scene]).status.code(), Some(0), "without a recording all is as before");
}

#[test]
fn solve_tells_a_scene_from_a_contact_problem() {
    let folder = Folder::new("no-problem");
    let message = |name: &str, text: &str| {
        let output = halfgap(&["solve", &folder.write(name, text)]);
        assert_eq!(output.status.code(), Some(2));
        folder.plain(&output.stderr)
    };
    let json = r#"{"format": "halfgap-scene-1", "title": "t", "run": {"duration": 1}}"#;
    insta::assert_snapshot!(message("scene.json", json), @r#"error: scene.json: field `format` is "halfgap-scene-1", expected "halfgap-contact-1": if it is a scene, run it by `halfgap run`"#);
    insta::assert_snapshot!(message("scene.toml", FLIGHT), @"error: scene.toml: not JSON, as a contact problem is: if it is a scene, run it by `halfgap run`");
}
