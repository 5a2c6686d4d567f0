//! Names set on the command line, and scenes from standard input.

use crate::command::Folder;
use std::io::Write;
use std::process::{Command, Output, Stdio};

const ROW: &str = r#"format = "halfgap-scene-1"
title = "A row of discs"
[let]
n = 2
[run]
duration = 1.0
[[body]]
repeat = { i = [1, "= n"] }
name = "disc {i}"
shape = { disc = { radius = 0.4 } }
mass = 1.0
position = ["= i", 0]
"#;

fn with_input(arguments: &[&str], text: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfgap"));
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the command starts");
    child.stdin.take().expect("it listens").write_all(text.as_bytes()).expect("it reads");
    child.wait_with_output().expect("it ends")
}

/// Names of the movable bodies in the result.
fn bodies(output: &Output) -> Vec<String> {
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let result: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one object");
    result["bodies"].as_object().expect("bodies").keys().cloned().collect()
}

#[test]
fn a_scene_from_standard_input_runs_with_other_values() {
    assert_eq!(bodies(&with_input(&["run", "-", "--json"], ROW)), ["disc 1", "disc 2"]);
    let set = ["run", "-", "--json", "--set", "n=2*pi/pi + 1", "--format", "toml"];
    assert_eq!(bodies(&with_input(&set, ROW)), ["disc 1", "disc 2", "disc 3"]);
    let json = r#"{"format": "halfgap-scene-1", "title": "a disc", "run": {"duration": 1}, "body": [{"name": "it", "shape": {"disc": {"radius": 1}}, "mass": 1}]}"#;
    assert_eq!(bodies(&with_input(&["run", "-", "--json"], json)), ["it"]);
}

#[test]
fn a_scene_from_standard_input_is_checked() {
    let expected = "[[expected]]\ntime = 1.0\nposition_tolerance = 1e-9\n[expected.bodies.\"disc 1\"]\nposition = [\"= n - 1\", 0]\n";
    let output = with_input(&["check", "-"], &format!("{ROW}{expected}"));
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.code() == Some(0) && text.starts_with("ok"), "{text}");
}

#[test]
fn what_cannot_be_set_is_named() {
    let message = |setting: &str, text: &str| {
        let output = with_input(&["run", "-", "--set", setting], text);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let unknown = message("m=3", ROW);
    assert!(
        unknown.contains("-:3: let: there is no `m` in `[let]` that could be set (did you mean `n`?)"),
        "{unknown}"
    );
    assert!(message("n", ROW).contains("must be NAME=VALUE"));
    assert!(message("n=1.5", ROW).contains("body[0].repeat.i[1]: must be a whole number, got 1.5"));
    assert!(message("n=3", "{").contains("-:1: not valid JSON"));
}

#[test]
fn sweep_varies_what_let_names() {
    let folder = Folder::new("language");
    let scene = folder
        .write("row.toml", &ROW.replace("{i}", "one").replace("= n", "= 1").replace(r#""= i""#, r#""= n""#));
    let output = Command::new(env!("CARGO_BIN_EXE_halfgap"))
        .args(["sweep", &scene, "--vary", "let.n=1..3/3", "--json"])
        .output()
        .expect("the command starts");
    let sweep: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one object");
    let runs = sweep["runs"].as_array().expect("runs");
    let places: Vec<_> =
        runs.iter().map(|run| run["result"]["bodies"]["disc one"]["position"][0].as_f64()).collect();
    assert_eq!(places, [Some(1.0), Some(2.0), Some(3.0)]);
}
