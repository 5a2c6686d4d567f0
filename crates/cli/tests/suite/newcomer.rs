//! What a newcomer sees of a command that takes long, or that is mistyped.

use crate::command::{FLIGHT, Folder, halfgap};
#[cfg(unix)]
use {
    crate::command::{json, send_signal},
    std::io::{BufRead, BufReader, Read},
    std::path::Path,
    std::process::{Child, Command, Stdio},
};

/// A run that goes on for hours: two discs on a stiff spring.
#[cfg(unix)]
fn long_run(folder: &Folder, options: &[&str]) -> Child {
    let stiff = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/faults/43_stiff.toml");
    let stiff = std::fs::read_to_string(stiff).expect("the scene is there");
    let scene = folder.write("stiff.toml", &stiff.replace("duration = 1.0", "duration = 1e3"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfgap"));
    let command = command.args(["run", &scene]).args(options).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("the command starts")
}

#[cfg(unix)]
#[test]
fn a_long_run_tells_how_far_it_is_and_ctrl_c_prints_what_it_has() {
    let folder = Folder::new("long-run");
    for options in [&[][..], &["--json"]] {
        let mut command = long_run(&folder, options);
        let mut messages = BufReader::new(command.stderr.take().expect("a pipe"));
        let mut line = String::new();
        messages.read_line(&mut line).expect("a line");
        assert!(line.starts_with("progress: at 0.") && line.contains(" s of 1000 s, "), "{line}");
        assert!(line.ends_with(" events so far\n") && !line.contains(" 0 events"), "{line}");
        send_signal(&command, "-INT");
        let output = command.wait_with_output().expect("the command ends");
        let mut rest = String::new();
        messages.read_to_string(&mut rest).expect("text");
        assert_eq!(output.status.code(), Some(3), "{rest}");
        assert!(rest.contains("stopped early: interrupted at 0."), "{rest}");
        if options.is_empty() {
            let text = folder.plain(&output.stdout);
            assert!(text.starts_with("t: interrupted at t = 0.") && text.contains("energy ledger"), "{text}");
        } else {
            let result = json(&output);
            assert_eq!(result["status"], "interrupted");
            assert!(result["time"].as_f64().is_some_and(|time| time > 0.0 && time < 1e3), "{result}");
        }
    }
}

#[cfg(unix)]
#[test]
fn a_quiet_run_tells_nothing_of_its_progress() {
    let folder = Folder::new("long-quiet-run");
    let command = long_run(&folder, &["--quiet"]);
    std::thread::sleep(std::time::Duration::from_secs(4));
    send_signal(&command, "-INT");
    let output = command.wait_with_output().expect("the command ends");
    let messages = folder.plain(&output.stderr);
    assert!(messages.contains("error: ") && !messages.contains("progress"), "{messages}");
    assert_eq!((output.status.code(), output.stdout.len()), (Some(3), 0));
}

#[cfg(unix)]
#[test]
fn ctrl_c_between_repetitions_keeps_those_that_were_made() {
    let folder = Folder::new("repeat-interrupted");
    let scene = folder.write("flight.toml", FLIGHT);
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfgap"));
    let command = command.args(["run", &scene, "--json", "--repeat", "100000000"]);
    let mut command =
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the command starts");
    let mut messages = BufReader::new(command.stderr.take().expect("a pipe"));
    let mut text = String::new();
    messages.read_line(&mut text).expect("a line of progress");
    send_signal(&command, "-INT");
    let output = command.wait_with_output().expect("the command ends");
    messages.read_to_string(&mut text).expect("text");
    assert_eq!(output.status.code(), Some(3), "{text}");
    assert!(text.contains("interrupted: ") && text.ends_with(" of 100000000 runs were made\n"), "{text}");
    assert!(json(&output)["statistics"]["wall_seconds_median"].is_number());
}

#[test]
fn a_mistyped_name_comes_with_the_one_that_is_meant() {
    let folder = Folder::new("mistyped");
    let message = |arguments: &[&str]| {
        let output = halfgap(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        folder.plain(&output.stderr)
    };
    let with = |from: &str, to: &str| FLIGHT.replace(from, to);
    let flight = folder.write("flight.toml", FLIGHT);
    let push = "[[force]]\nconstant = { body = \"disk\", point = [0, 0], force = [1, 0] }\n\n[[expected]]";
    for (scene, meant) in [
        (with("{ disc = ", "{ disk = "), "unknown field `disk` (did you mean `disc`?)"),
        (with("radius = ", "radios = "), "unknown field `radios` (did you mean `radius`?)"),
        (
            with("[run]", "[run]\nintegrator = \"dop835\""),
            "unknown variant `dop835` (did you mean `dop853`?)",
        ),
        (with("bodies.disc", "bodies.disk"), "there is no body named \"disk\" (did you mean \"disc\"?)"),
        (with("[[expected]]", push), "there is no body named \"disk\" (did you mean \"disc\"?)"),
        (with("mass = 2.0", "mass = 2.0\npasses_through = [\"Disc\"]"), "(did you mean \"disc\"?)"),
    ] {
        let told = message(&["run", &folder.write("mistyped.toml", &scene)]);
        assert!(told.contains(meant), "{told}");
    }
    for (vary, meant) in [
        ("body.dsic.mass=1..2/2", "there is no `dsic` (did you mean `disc`?)"),
        ("bodi.disc.mass=1..2/2", "there is no `bodi` in the scene (did you mean `body`?)"),
        ("body.disc.mas=1..2/2", "unknown field `mas` (did you mean `mass`?)"),
        ("run.toleranc=1e-6..1e-8/2", "unknown field `toleranc` (did you mean `tolerance`?)"),
    ] {
        let told = message(&["sweep", &flight, "--vary", vary]);
        assert!(told.contains(meant), "{told}");
    }
    assert!(message(&["rum", &flight]).contains("a similar subcommand exists: 'run'"));
    assert!(
        message(&["run", &flight, "--tolerence", "1"]).contains("a similar argument exists: '--tolerance'")
    );
}
