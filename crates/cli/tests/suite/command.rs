//! The command, as users meet it: exit codes, messages, JSON and files.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::process::{Child, Stdio};
use std::process::{Command, Output};

/// A scene of one disc that meets nothing.
pub(crate) const FLIGHT: &str = r#"format = "halfgap-scene-1"
title = "Free flight"

[run]
duration = 2.0

[[body]]
name = "disc"
shape = { disc = { radius = 0.5 } }
mass = 2.0
velocity = [1.0, 0.0]

[[expected]]
time = 2.0
position_tolerance = 1e-9
[expected.bodies.disc]
position = [2.0, 0.0]
"#;

/// A folder that one test has to itself, removed when the test is over.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(test: &str) -> Self {
        let path = std::env::temp_dir().join(format!("halfgap-{test}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder for the test");
        Self(path)
    }

    pub(crate) fn write(&self, name: &str, text: &str) -> String {
        let path = self.0.join(name);
        std::fs::write(&path, text).expect("a test file");
        path.display().to_string()
    }

    pub(crate) fn path(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }

    /// The text without the folder's name.
    pub(crate) fn plain(&self, bytes: &[u8]) -> String {
        String::from_utf8_lossy(bytes).replace(&format!("{}/", self.0.display()), "")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

pub(crate) fn halfgap(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_halfgap")).args(arguments).output().expect("the command runs")
}

pub(crate) fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).expect("standard output is JSON")
}

#[test]
fn run_prints_a_table() {
    let folder = Folder::new("table");
    let output = halfgap(&["run", &folder.write("flight.toml", FLIGHT)]);
    let text = folder.plain(&output.stdout);
    assert_eq!(output.status.code(), Some(0));
    assert!(text.starts_with("Free flight: done at t = 2 s\n"), "{text}");
    assert!(text.contains("disc      2.000000000                0"), "{text}");
    assert!(text.contains("integration error                             0 J"), "{text}");
    assert!(output.stderr.is_empty(), "no progress bar when piped");
}

#[test]
fn run_prints_one_json_object() {
    let folder = Folder::new("json");
    let output = halfgap(&["run", &folder.write("flight.toml", FLIGHT), "--json", "--duration", "1"]);
    let result = json(&output);
    assert_eq!(result["format"], "halfgap-result-1");
    assert_eq!(result["scene"], "Free flight");
    assert_eq!(result["status"], "done");
    assert_eq!(result["bodies"]["disc"]["position"], serde_json::json!([1.0, 0.0]));
    assert_eq!(result["energy"]["start"], 1.0);
    assert_eq!(result["statistics"]["largest_connector_error"], serde_json::Value::Null);
    assert_eq!(result["ledger"]["start"], 1.0);
    assert_eq!(result["ledger"]["integration_error"], 0.0);
}

#[test]
fn run_estimates_its_error() {
    let folder = Folder::new("estimate");
    let scene = folder.write("flight.toml", FLIGHT);
    let text = folder.plain(&halfgap(&["run", &scene, "--estimate-error"]).stdout);
    assert!(text.contains("error estimate: tolerance 1e-8 against 1e-10\n"), "{text}");
    assert!(text.contains("  largest        0 m, 0 rad, 0 m/s, 0 rad/s\n"), "{text}");
    let estimate = &json(&halfgap(&["run", &scene, "--estimate-error", "--json"]))["error_estimate"];
    assert_eq!(estimate["end"]["position"], 0.0);
    assert_eq!(estimate["target_gaps"], serde_json::json!([5e-11, 5e-13]));
    assert_eq!((&estimate["chaotic"], &estimate["trusted_until"]), (&false.into(), &serde_json::Value::Null));
    let without = json(&halfgap(&["run", &scene, "--json"]));
    assert!(without.get("error_estimate").is_none(), "{without}");
}

/// A block at rest on a slope of 1/2, with a friction coefficient.
fn block_on_slope(friction: f64) -> String {
    let (angle, cos, sin) = (0.5_f64.atan(), 0.8_f64.sqrt(), 0.2_f64.sqrt());
    let body = |name: &str, more: &str, (width, height): (f64, f64), up: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\n{more}\nfriction = {friction:?}\nangle = {angle:?}\n\
             position = [{:?}, {:?}]\nshape = {{ block = {{ width = {width:?}, height = {height:?} }} }}\n",
            -up * sin,
            up * cos
        )
    };
    let slope = body("slope", "fixed = true", (20.0, 1.0), -0.5);
    let block = body("block", "mass = 2.0", (1.0, 0.5), 0.25);
    format!(
        "format = \"halfgap-scene-1\"\ntitle = \"Slope\"\nrun = {{ duration = 2.0, tolerance = 1e-8 }}\n\
         {slope}{block}[[force]]\ngravity = {{ acceleration = [0.0, -10.0] }}\n"
    )
}

#[test]
fn the_estimate_warns_of_thresholds_of_friction() {
    let folder = Folder::new("threshold");
    let told = |friction: f64| {
        let scene = folder.write("slope.toml", &block_on_slope(friction));
        folder.plain(&halfgap(&["run", &scene, "--estimate-error"]).stdout)
    };
    let warning = "  at a threshold of friction from 0.0000 s on: slope on block has ";
    for friction in [0.5, 0.5 * (1.0 + 1e-8), 0.5 * (1.0 - 1e-8), 0.5 * (1.0 + 5e-7), 0.5 * (1.0 - 5e-7)] {
        assert!(told(friction).contains(warning), "{friction:?}: {}", told(friction));
    }
    assert!(told(0.5 * (1.0 + 5e-7)).contains(&format!("{warning}5e-7 of its friction to spare\n")));
    for friction in [0.5 * (1.0 + 1e-5), 0.5 * (1.0 - 1e-5), 0.3, 0.8] {
        assert!(!told(friction).contains("threshold"), "{friction:?}: {}", told(friction));
    }
    let scene = folder.write("slope.toml", &block_on_slope(0.5));
    let estimate = &json(&halfgap(&["run", &scene, "--estimate-error", "--json"]))["error_estimate"];
    assert_eq!(estimate["thresholds"][0]["bodies"], serde_json::json!(["slope", "block"]));
}

#[test]
fn quiet_is_quiet() {
    let folder = Folder::new("quiet");
    let output = halfgap(&["run", &folder.write("flight.toml", FLIGHT), "--quiet"]);
    assert_eq!((output.stdout.len(), output.stderr.len()), (0, 0));
}

#[test]
fn quiet_tells_the_error_that_was_asked_for() {
    let folder = Folder::new("quiet-estimate");
    let output = halfgap(&["run", &folder.write("flight.toml", FLIGHT), "--quiet", "--estimate-error"]);
    assert!(folder.plain(&output.stdout).starts_with("error estimate: tolerance "));
}

#[test]
fn out_writes_recording_and_pictures() {
    let folder = Folder::new("out");
    let scene =
        folder.write("flight.toml", &FLIGHT.replace("2.0\n\n[[body", "2.0\noutput_step = 0.75\n\n[[body"));
    let out = folder.path("deep/out");
    assert_eq!(halfgap(&["run", &scene, "--out", &out, "--pictures", "3", "--quiet"]).status.code(), Some(0));
    let read = |name: &str| std::fs::read_to_string(Path::new(&out).join(name)).expect("the file is there");
    insta::assert_snapshot!(read("states.csv"), @r"
    time [s],body,x [m],y [m],angle [rad],vx [m/s],vy [m/s],angular_velocity [rad/s]
    0.0,disc,0.0,0.0,0.0,1.0,0.0,0.0
    0.75,disc,0.75,0.0,0.0,1.0,0.0,0.0
    1.5,disc,1.5,0.0,0.0,1.0,0.0,0.0
    2.0,disc,2.0,0.0,0.0,1.0,0.0,0.0
    ");
    insta::assert_snapshot!(read("energy.csv"), @r"
    time [s],kinetic [J],potential [J],total [J]
    0.0,1.0,0.0,1.0
    0.75,1.0,0.0,1.0
    1.5,1.0,0.0,1.0
    2.0,1.0,0.0,1.0
    ");
    for name in ["impacts.csv", "contacts.csv", "forces.csv"] {
        assert_eq!(read(name).lines().count(), 1, "{name} has a header");
    }
    let recording: serde_json::Value = serde_json::from_str(&read("recording.json")).expect("JSON");
    assert_eq!(recording["frames"].as_array().map(Vec::len), Some(4));
    assert!(read("result.json").contains("\"status\":\"done\""));
    // There are no more output times in between.
    assert!(!Path::new(&folder.path("out/picture-0002.svg")).exists());
    for (name, time) in [("picture-0000.svg", "t = 0.750 s"), ("picture-0001.svg", "t = 1.500 s")] {
        assert!(read(name).contains(time), "{name}");
    }
    for name in ["start.svg", "end.svg", "energy.svg", "events.svg", "picture-0001.svg"] {
        assert!(read(name).starts_with("<svg ") && read(name).ends_with("</svg>\n"), "{name}");
    }
    assert!(
        read("end.svg").contains("A133.333 133.333 0 0 0 "),
        "arcs are drawn as arcs: {}",
        read("end.svg")
    );
    // Pictures that an earlier, longer run has left would seem to belong to this run.
    assert_eq!(halfgap(&["run", &scene, "--out", &out, "--pictures", "1", "--quiet"]).status.code(), Some(0));
    let is_there = |name: &str| Path::new(&out).join(name).exists();
    assert_eq!(["picture-0000.svg", "picture-0001.svg"].map(is_there), [true, false]);
}

#[test]
fn probes_are_written_beside_the_states_and_go_with_the_scene() {
    let folder = Folder::new("probes");
    let body = r#"
        format = "halfgap-scene-1"
        title = "Spin"
        run = { duration = 1.0, output_step = 0.5 }
        body = [{ name = "disc", shape = { disc = { radius = 1.0 } }, mass = 2.0, angular_velocity = 4.0 }]
        "#;
    let probe = "[[probe]]\nname = \"rim\"\npoint = { body = \"disc\", point = [0.0, 0.0] }\n";
    let (with, without) = (format!("{body}{probe}"), body);
    let [with, without] = [folder.write("with.toml", &with), folder.write("without.toml", without)];
    let out = folder.path("out");
    assert_eq!(halfgap(&["run", &with, "--out", &out, "--quiet"]).status.code(), Some(0));
    let read = |name: &str| std::fs::read_to_string(Path::new(&out).join(name)).expect("the file is there");
    insta::assert_snapshot!(read("probes.csv"), @r"
    time [s],rim x [m],rim y [m],rim vx [m/s],rim vy [m/s]
    0.0,0.0,0.0,0.0,0.0
    0.5,0.0,0.0,0.0,0.0
    1.0,0.0,0.0,0.0,0.0
    ");
    assert!(read("probes.svg").contains("rim: vy [m/s]"));
    assert_eq!(halfgap(&["run", &without, "--out", &out, "--quiet"]).status.code(), Some(0));
    assert!(!Path::new(&folder.path("out/probes.csv")).exists());
    assert!(!Path::new(&folder.path("out/probes.svg")).exists());
}

#[test]
fn a_wrong_scene_ends_with_2_and_shows_the_line() {
    let folder = Folder::new("wrong");
    let scene = folder.write("scene.toml", &FLIGHT.replace("mass = 2.0", "mass = -2"));
    let output = halfgap(&["run", &scene]);
    assert_eq!(output.status.code(), Some(2));
    insta::assert_snapshot!(folder.plain(&output.stderr), @r"
    error: scene.toml:10: body[0].mass: must be positive, got -2 kg
        |
     10 | mass = -2
        | ^
    ");
    let syntax = folder.write("syntax.toml", &FLIGHT.replace("mass = 2.0", "mass = = 2"));
    insta::assert_snapshot!(folder.plain(&halfgap(&["run", &syntax]).stderr), @r"
    error: syntax.toml:10: not valid TOML: extra `=`, expected nothing
        |
     10 | mass = = 2
        |        ^
    ");
    let none = halfgap(&["run", &folder.path("none.toml"), "--json"]);
    assert_eq!((none.status.code(), none.stdout.len()), (Some(2), 0));
    insta::assert_snapshot!(folder.plain(&none.stderr), @"error: none.toml: cannot be read: No such file or directory (os error 2)");
}

#[test]
fn a_motion_of_a_body_that_is_not_fixed_is_refused_with_its_line() {
    let folder = Folder::new("unsupported");
    let scene = folder.write(
        "scene.toml",
        &FLIGHT
            .replace("mass = 2.0\nvelocity = [1.0, 0.0]", "mass = 1.0\nmotion = { angular_velocity = 1.0 }"),
    );
    let output = halfgap(&["run", &scene]);
    assert_eq!(output.status.code(), Some(2));
    insta::assert_snapshot!(folder.plain(&output.stderr), @r"
    error: scene.toml:11: body[0].motion: only a fixed body is moved: give it `fixed = true`, or a `velocity` instead
        |
     11 | motion = { angular_velocity = 1.0 }
        | ^
    ");
}

#[test]
fn wrong_options_are_named() {
    let folder = Folder::new("options");
    let scene = folder.write("flight.toml", FLIGHT);
    let message = |option: &str, value: &str| {
        let output = halfgap(&["run", &scene, option, value]);
        assert_eq!(output.status.code(), Some(2), "{option} {value}");
        folder.plain(&output.stderr)
    };
    insta::assert_snapshot!(message("--tolerance", "-1"), @"error: --tolerance: must be positive, got -1");
    insta::assert_snapshot!(message("--tolerance", "nan"), @"error: --tolerance: must be a finite number, got NaN");
    insta::assert_snapshot!(message("--duration", "0"), @"error: --duration: must be positive, got 0 s");
    let file = folder.write("file", "");
    insta::assert_snapshot!(message("--out", &format!("{file}/out")), @"error: --out: cannot write file/out: Not a directory (os error 20)");
}

#[test]
fn check_compares_and_says_why() {
    let folder = Folder::new("check");
    let good = folder.write("good.toml", FLIGHT);
    let bad = folder.write("bad.toml", &FLIGHT.replace("position = [2.0, 0.0]", "position = [2.5, 0.0]"));
    assert_eq!(halfgap(&["check", &good]).status.code(), Some(0));
    let output = halfgap(&["check", &good, &bad]);
    assert_eq!(output.status.code(), Some(1));
    insta::assert_snapshot!(folder.plain(&output.stdout), @r"
    ok     good.toml  position 0 m  velocity -  energy -
    FAILED bad.toml  position 0.5 m  velocity -  energy -
           t = 2 s: disc: position: got [2, 0], expected [2.5, 0] within 1e-9 m
    ");
    let output = halfgap(&["check", &good, &bad, "--json"]);
    insta::assert_snapshot!(folder.plain(&output.stdout), @r#"[{"scene":"Free flight","ok":true,"position_error":0.0,"velocity_error":null,"energy_error":null,"why":[],"file":"good.toml"},{"scene":"Free flight","ok":false,"position_error":0.5,"velocity_error":null,"energy_error":null,"why":["t = 2 s: disc: position: got [2, 0], expected [2.5, 0] within 1e-9 m"],"file":"bad.toml"}]"#);
}

#[test]
fn check_reports_the_others_beside_a_scene_that_cannot_be_read() {
    let folder = Folder::new("check-unreadable");
    let good = folder.write("good.toml", FLIGHT);
    let output = halfgap(&["check", &folder.path("none.toml"), &good, "--json"]);
    assert_eq!(output.status.code(), Some(2));
    let reports = json(&output);
    assert_eq!(reports[0]["ok"], false);
    assert_eq!(reports[1]["ok"], true);
}

#[test]
fn the_scenes_to_look_at_can_be_read_and_run() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(scenes).expect("the scenes are there") {
        let scene = entry.expect("a readable entry").path().display().to_string();
        let output = halfgap(&["run", &scene, "--duration", "0.1", "--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{scene}: {}", String::from_utf8_lossy(&output.stderr));
        count += 1;
    }
    assert!(count >= 6);
}

/// Two discs that pass through each other fall together from rest: forces grow beyond all bounds where they meet.
const FALLS_TOGETHER: &str = r#"format = "halfgap-scene-1"
title = "Falls together"
run = { duration = 10.0, collisions = false }
force = [{ mutual_gravity = { strength = 1.0 } }]

[[body]]
name = "left"
shape = { disc = { radius = 0.1 } }
mass = 1.0
position = [-0.5, 0.0]

[[body]]
name = "right"
shape = { disc = { radius = 0.1 } }
mass = 1.0
position = [0.5, 0.0]
"#;

#[test]
fn a_run_that_stops_early_keeps_its_recording_and_exits_with_3() {
    let folder = Folder::new("stops-early");
    let scene = folder.write("fall.toml", FALLS_TOGETHER);
    let output = halfgap(&["run", &scene, "--json", "--out", &folder.path("out")]);
    assert_eq!(output.status.code(), Some(3));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(json["status"], "stuck");
    // Half of the period of an ellipse without width: pi/2 sqrt(d^3/(2 k (m1 + m2))).
    let meeting = std::f64::consts::FRAC_PI_4;
    let stopped = json["time"].as_f64().expect("a time");
    assert!((stopped - meeting).abs() < 1e-6, "stopped at {stopped} s, not at {meeting} s");
    let message = folder.plain(&output.stderr);
    assert!(message.contains("mutual_gravity"), "{message}");
    let times = message.matches(&format!("{stopped:.3}")).count();
    assert!(message.contains("stopped early: at ") && times == 1, "the time is told once: {message}");
    let states = std::fs::read_to_string(folder.path("out/states.csv")).expect("the recording is written");
    assert!(states.lines().count() > 60, "{states}");
    for name in [
        "states.csv",
        "energy.csv",
        "contacts.csv",
        "forces.csv",
        "recording.json",
        "result.json",
        "start.svg",
        "end.svg",
    ] {
        assert!(Path::new(&folder.path("out")).join(name).exists(), "{name} is missing");
    }
}

/// Asks a command to terminate once a file is there.
#[cfg(unix)]
fn terminated_once(arguments: &[&str], file: &str) -> Output {
    signalled_when("-TERM", arguments, || Path::new(file).exists())
}

/// Presses Ctrl-C once a condition holds.
#[cfg(unix)]
fn interrupted_when(arguments: &[&str], holds: impl FnMut() -> bool) -> Output {
    signalled_when("-INT", arguments, holds)
}

/// Sends a signal to a command that runs.
#[cfg(unix)]
pub(crate) fn send_signal(command: &Child, signal: &str) {
    let killed = Command::new("kill").args([signal, &command.id().to_string()]).status();
    assert!(killed.expect("there is a kill").success());
}

#[cfg(unix)]
fn signalled_when(signal: &str, arguments: &[&str], mut holds: impl FnMut() -> bool) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfgap"))
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    while !holds() && command.try_wait().expect("a state").is_none() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    send_signal(&command, signal);
    command.wait_with_output().expect("the command ends")
}

#[cfg(unix)]
#[test]
fn a_run_that_is_interrupted_writes_what_it_has_recorded() {
    let folder = Folder::new("interrupted");
    let endless = FLIGHT.replace("duration = 2.0", "duration = 1e4\noutput_step = 1e-3");
    let (scene, out) = (folder.write("endless.toml", &endless), folder.path("out"));
    let output = terminated_once(&["run", &scene, "--out", &out, "--json"], &out);
    assert_eq!(output.status.code(), Some(3));
    assert!(folder.plain(&output.stderr).contains("interrupted at "));
    let result = json(&output);
    assert_eq!(result["status"], "interrupted");
    let time = result["time"].as_f64().expect("a time");
    assert!(time < 1e4);
    let states = std::fs::read_to_string(format!("{out}/states.csv")).expect("states");
    let last: f64 = states
        .lines()
        .last()
        .and_then(|line| line.split(',').next())
        .map_or(f64::NAN, |time| time.parse().expect("a time"));
    assert_eq!(last, time);
}

#[test]
fn shapes_that_cannot_be_are_named_with_line_path_and_edge() {
    let folder = Folder::new("bad-shapes");
    let message = |shape: &str| {
        let scene = folder.write("shape.toml", &FLIGHT.replace("{ disc = { radius = 0.5 } }", shape));
        let output = halfgap(&["run", &scene]);
        assert_eq!(output.status.code(), Some(2));
        folder.plain(&output.stderr).lines().next().unwrap_or_default().to_owned()
    };
    assert_eq!(
        message("{ polygon = { vertices = [[0, 0], [1, 1], [1, 0], [0, 1]] } }"),
        "error: shape.toml:9: body[0].shape: path 0, edge 0 meets path 0, edge 2 at (0.5, 0.5) m"
    );
    let off_by_a_percent = "{ outline = { paths = [{ start = [0, 1], edges = [\
        { arc = { to = [1.01, 0], center = [0, 0], clockwise = true } }, { line = [0, 0] }, { line = [0, 1] }] }] } }";
    assert_eq!(
        message(off_by_a_percent),
        "error: shape.toml:9: body[0].shape: path 0, edge 0: arc radius is 1 m at its start but 1.01 m at its end: \
         off by 0.01 m"
    );
}

#[test]
fn a_tolerance_that_coordinates_do_not_allow_warns_and_runs() {
    let folder = Folder::new("warns");
    let scene = folder.write("flight.toml", FLIGHT);
    let output = halfgap(&["run", &scene, "--json", "--tolerance", "1e-15"]);
    assert_eq!(output.status.code(), Some(0));
    let message = folder.plain(&output.stderr);
    assert!(message.starts_with("warning: flight.toml: tolerance 1e-15 asks for a target gap"), "{message}");
}

/// A ball on a floor, which it leaves with part of its speed.
const BOUNCE: &str = r#"format = "halfgap-scene-1"
title = "Bounce"
run = { duration = 3.0 }

[[body]]
name = "floor"
fixed = true
shape = { block = { width = 10.0, height = 1.0 } }
position = [0.0, -0.5]

[[body]]
name = "ball"
shape = { disc = { radius = 0.5 } }
mass = 1.0
position = [0.0, 2.0]

[[force]]
gravity = { acceleration = [0.0, -9.81] }
"#;

#[test]
fn sweep_gives_the_same_bits_on_many_threads_as_one_run_at_a_time() {
    let folder = Folder::new("sweep");
    let scene = folder.write("bounce.toml", BOUNCE);
    let sweep = |threads: &str| {
        let file = folder.path(&format!("{threads}.csv"));
        let vary = "body.ball.elasticity=0.3..0.95/40";
        let output =
            halfgap(&["sweep", &scene, "--vary", vary, "--out", &file, "--threads", threads, "--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{}", folder.plain(&output.stderr));
        assert!(output.stdout.is_empty() && output.stderr.is_empty());
        std::fs::read_to_string(file).expect("the table was written")
    };
    let table = sweep("1");
    assert_eq!(sweep("4"), table);
    assert_eq!(table.lines().count(), 41);
    // A run alone, of a file that holds the value that the sweep put in.
    let alone = BOUNCE.replace("name = \"ball\"", "name = \"ball\"\nelasticity = 0.3");
    let alone = json(&halfgap(&["run", &folder.write("alone.toml", &alone), "--json"]));
    let first: Vec<_> = table.lines().nth(1).expect("a first run").split(',').collect();
    let height: f64 = first[8].parse().expect("a number");
    let known = alone["bodies"]["ball"]["position"][1].as_f64().expect("a number");
    assert_eq!(height.to_bits(), known.to_bits());
    assert!(table.starts_with("body[1].elasticity,status,time,"), "{table}");
}

#[test]
fn sweep_prints_a_table_or_json() {
    let folder = Folder::new("sweep-print");
    let scene = folder.write("bounce.toml", BOUNCE);
    let arguments = ["sweep", &scene, "--vary", "run.tolerance=1e-6..1e-3/3"];
    let output = halfgap(&arguments);
    let text = folder.plain(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{}", folder.plain(&output.stderr));
    assert_eq!(text.lines().count(), 4, "{text}");
    assert!(text.contains("run.tolerance") && text.contains("done"), "{text}");
    let object = json(&halfgap(&[&arguments[..], &["--json"]].concat()));
    assert_eq!(object["format"], "halfgap-sweep-1");
    assert_eq!(object["runs"][2]["value"], 1e-3);
    assert_eq!(object["runs"][2]["result"]["status"], "done");
}

#[test]
fn sweep_goes_on_past_a_value_of_which_no_world_can_be_made() {
    let folder = Folder::new("sweep-refused");
    let scene = folder.write("bounce.toml", BOUNCE);
    let file = folder.path("table.csv");
    // At 0.2 m the ball lies in the floor.
    let arguments = ["sweep", &scene, "--vary", "body.ball.position[1]=0.2..2/3", "--out", &file];
    let output = halfgap(&arguments);
    let (text, message) = (folder.plain(&output.stdout), folder.plain(&output.stderr));
    assert_eq!(output.status.code(), Some(2), "{message}");
    let status = |line: &str| line.split_whitespace().nth(1).map(str::to_owned);
    let statuses: Vec<_> = text.lines().skip(1).filter_map(status).collect();
    assert_eq!(statuses, ["refused", "done", "done"], "{text}");
    let why = "with body[1].position[1] = 0.2: body[1].position: bodies \"floor\" and \"ball\" overlap by";
    assert!(message.contains(why), "{message}");
    let table = std::fs::read_to_string(&file).expect("the table was written");
    let columns: BTreeSet<_> = table.lines().map(|line| line.split(',').count()).collect();
    assert_eq!(columns.len(), 1, "{table}");
    let object = json(&halfgap(&[&arguments[..], &["--json"]].concat()));
    assert!(object["runs"][0]["result"].is_null() && object["runs"][0]["error"].is_string());
    assert_eq!(object["runs"][1]["result"]["status"], "done");
}

/// A bar that a pin and a slot hold to second order only: once it turns, no forces keep it on both.
const LOCKED: &str = r#"format = "halfgap-scene-1"
title = "Locked"
run = { duration = 1.0 }

[[body]]
name = "bar"
mass = 1.0
shape = { block = { width = 2.0, height = 0.1 } }

[[body]]
name = "ball"
mass = 1.0
position = [0.8, 1.0]
velocity = [0.0, -2.0]
shape = { disc = { radius = 0.1 } }

[[connector]]
pin = { a = { body = "world", point = [0.0, 0.0] }, b = { body = "bar", point = [0.0, 0.0] } }

[[connector]]
slot = { a = { body = "world", point = [1.0, 0.0] }, b = { body = "bar", point = [1.0, 0.0] }, normal = [1.0, 0.0] }
"#;

#[test]
fn a_contact_problem_that_stops_a_run_is_kept_and_can_be_replayed() {
    let folder = Folder::new("problem");
    let (scene, out) = (folder.write("locked.toml", LOCKED), folder.path("out"));
    let output = halfgap(&["run", &scene, "--quiet", "--out", &out]);
    assert_eq!(output.status.code(), Some(3));
    let message = folder.plain(&output.stderr);
    assert!(message.contains("the row is of \"world\" and \"bar\""), "{message}");
    assert!(
        message
            .ends_with("`halfgap solve out/problem.json` explains the contact problem that has no answer\n")
    );
    let problem = folder.path("out/problem.json");
    let output = halfgap(&["solve", &problem]);
    assert_eq!(output.status.code(), Some(3));
    assert!(folder.plain(&output.stdout).contains("INFEASIBLE"));
    // A later run that does not stop removes the file.
    let flight = folder.write("flight.toml", FLIGHT);
    assert_eq!(halfgap(&["run", &flight, "--quiet", "--out", &out]).status.code(), Some(0));
    assert!(!Path::new(&problem).exists());
}

#[test]
fn sweep_opens_its_table_before_it_runs() {
    let folder = Folder::new("sweep-out");
    let scene = folder.write("bounce.toml", BOUNCE);
    let file = folder.path("nowhere/table.csv");
    let output = halfgap(&["sweep", &scene, "--vary", "body.ball.position[1]=0.2..0.3/2", "--out", &file]);
    assert_eq!(output.status.code(), Some(2));
    let message = folder.plain(&output.stderr);
    assert!(message.starts_with("error: --out: cannot write") && message.lines().count() == 1, "{message}");
}

#[cfg(unix)]
#[test]
fn a_sweep_that_is_interrupted_prints_the_runs_that_were_made() {
    let folder = Folder::new("sweep-interrupted");
    let long = FLIGHT.replace("duration = 2.0", "duration = 100.0\noutput_step = 1e-3");
    let (scene, file) = (folder.write("long.toml", &long), folder.path("table.csv"));
    let vary = "body.disc.velocity[0]=1..2/500000";
    let rows = || std::fs::read_to_string(&file).map_or(0, |table| table.lines().count());
    // The file has rows long before the sweep is over.
    let mut seen = 0;
    let arguments = ["sweep", &scene, "--vary", vary, "--threads", "2", "--out", &file];
    let output = interrupted_when(&arguments, || {
        seen = rows();
        seen > 20
    });
    let (text, message) = (folder.plain(&output.stdout), folder.plain(&output.stderr));
    assert_eq!(output.status.code(), Some(3), "{message}");
    let made = text.lines().count() - 1;
    let broken_off = text.matches("interrupted").count();
    assert!((seen - 1..500_000).contains(&made) && broken_off <= 2, "{seen} {made}");
    let told = format!("error: interrupted: {} of 500000 runs were made", made - broken_off);
    assert_eq!(message.lines().last(), Some(told.as_str()), "{message}");
    assert_eq!(rows(), made + 1);
    let table = std::fs::read_to_string(&file).expect("the table was written");
    let value = |row: &str| row.split(',').next().and_then(|value| value.parse::<f64>().ok());
    let values = table.lines().skip(1).map(|row| value(row).expect("a value"));
    assert!(values.is_sorted(), "the rows are in the order of their values");
}

#[test]
fn sweep_names_what_cannot_be_varied() {
    let folder = Folder::new("sweep-wrong");
    let scene = folder.write("bounce.toml", BOUNCE);
    for (vary, why) in [
        (
            "body.bal.elasticity=0..1/2",
            "body.bal.elasticity: there is no `bal` (did you mean `ball`?): there are floor, ball",
        ),
        ("body.ball.bounce=0..1/2", "body[1].bounce: unknown field `bounce`"),
        ("body.ball.name=0..1/2", "body[1].name: is no number"),
        ("body.ball.elasticity=0..2/3", "body[1].elasticity"),
        ("elasticity", "FIELD=A..B/N"),
    ] {
        let output = halfgap(&["sweep", &scene, "--vary", vary]);
        let message = folder.plain(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{vary}: {message}");
        assert!(message.contains(why), "{vary}: {message}");
    }
}

#[test]
fn solve_tells_whether_the_answer_is_the_expected_one() {
    let folder = Folder::new("solve");
    let problem = |rest: &str| {
        let text = format!("{{\"format\": \"halfgap-contact-1\", \"A\": [[2, 1], [1, 2]], {rest}}}");
        folder.write("problem.json", &text)
    };
    let solved = problem(
        "\"b\": [-5, -6], \"feasible\": false, \"expected\": {\"acceleration\": [0, 0.25], \"tolerance\": 1e-9}",
    );
    let output = halfgap(&["solve", &solved]);
    assert_eq!(output.status.code(), Some(0));
    let text = folder.plain(&output.stdout);
    let verdicts: Vec<&str> = text.lines().rev().take(2).collect();
    let expected = [
        "The expected acceleration differs by 0.25 at most, in row 1; 1e-9 is allowed.",
        "The file says that it has none, which was not found.",
    ];
    assert_eq!(verdicts, expected, "{text}");

    let contradiction = folder.write(
        "contradiction.json",
        "{\"format\": \"halfgap-contact-1\", \"A\": [[1, 1], [1, 1]], \"b\": [-1, -1.5], \"bilateral\": [true, true]}",
    );
    let output = halfgap(&["solve", &contradiction, "--json"]);
    assert_eq!(output.status.code(), Some(3));
    let solution: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(solution["status"], "infeasible");
    assert!(solution["inconsistency"].as_f64().is_some_and(|part| part > 0.1), "{solution}");
}

#[test]
fn tables_show_no_digits_below_what_a_run_can_know() {
    let folder = Folder::new("readable");
    // Discs that come to rest on each other: what is left of their speeds is of the order of 1e-80 m/s.
    let heap =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/heap_of_discs.toml").display().to_string();
    let output = halfgap(&["run", &heap]);
    let text = folder.plain(&output.stdout);
    let powers = text.split_whitespace().filter_map(|word| word.split_once('e')?.1.parse::<i32>().ok());
    assert!(powers.clone().all(|power| power != 0 && power > -20), "{text}");
    let speeds = text.lines().skip(3).take(25).filter_map(|line| line.split_whitespace().rev().nth(2));
    assert!(speeds.clone().count() == 25 && speeds.filter(|&speed| speed == "0").count() == 25, "{text}");
    assert!(text.contains("at the end       kinetic 0 J, potential 50.3"), "{text}");
    // What programs read has all digits.
    let result = json(&halfgap(&["run", &heap, "--json"]));
    assert!(
        result["energy"]["kinetic"].as_f64().is_some_and(|energy| energy > 0.0 && energy < 1e-30),
        "{result}"
    );
}

#[test]
fn a_repeated_run_tells_the_least_and_the_median_of_its_times() {
    let folder = Folder::new("repeat");
    let scene = folder.write("bounce.toml", BOUNCE);
    let once = json(&halfgap(&["run", &scene, "--json"]));
    assert!(once["statistics"].get("wall_seconds_median").is_none(), "{once}");
    let output = halfgap(&["run", &scene, "--json", "--repeat", "5"]);
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
    let mut result = json(&output);
    let time = |name: &str| result["statistics"][name].as_f64().expect("a time");
    let [least, median] = ["wall_seconds", "wall_seconds_median"].map(time);
    assert!(least > 0.0 && least <= median, "{least} {median}");
    // Everything else is as of one run.
    let mut once = once;
    for told in [&mut once, &mut result] {
        let statistics = told["statistics"].as_object_mut().expect("an object");
        statistics.retain(|name, _| !name.starts_with("wall"));
    }
    assert_eq!(once, result);
    let text = folder.plain(&halfgap(&["run", &scene, "--repeat", "4"]).stdout);
    assert!(text.contains(" s (least of 4 runs; median 0."), "{text}");
    let alone = folder.plain(&halfgap(&["run", &scene, "--repeat", "1"]).stdout);
    assert!(alone.contains("wall time") && !alone.contains("median"), "{alone}");
    let alone = json(&halfgap(&["run", &scene, "--repeat", "1", "--json"]));
    assert_eq!(alone["statistics"]["wall_seconds"], alone["statistics"]["wall_seconds_median"]);
    let none = halfgap(&["run", &scene, "--repeat", "0"]);
    assert_eq!(none.status.code(), Some(2));
    assert!(folder.plain(&none.stderr).contains("invalid value '0' for '--repeat <N>'"));
}
