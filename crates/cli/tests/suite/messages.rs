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
