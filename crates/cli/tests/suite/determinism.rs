//! Two runs of the command write the same bytes, apart from their run times.

use std::path::Path;
use std::process::Command;

/// Runs a scene into a folder of its own and returns the contents of the files written.
fn files_of(run: &str) -> Vec<(String, String)> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/capsules_in_a_round_room.toml");
    let folder = std::env::temp_dir().join(format!("halfgap-determinism-{run}-{}", std::process::id()));
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfgap"));
    let status =
        command.arg("run").arg(scene).args(["--duration", "5", "--quiet", "--out"]).arg(&folder).status();
    assert!(status.expect("the command runs").success());
    let entries = std::fs::read_dir(&folder).expect("the folder was written");
    let mut files: Vec<(String, String)> = entries
        .map(|entry| entry.expect("a readable entry").path())
        .map(|path| (path.file_name().unwrap_or_default().to_string_lossy().into_owned(), path))
        .map(|(name, path)| (name, std::fs::read_to_string(path).expect("a text")))
        .collect();
    files.sort();
    let _ = std::fs::remove_dir_all(&folder);
    files
}

#[test]
fn two_runs_of_the_command_write_the_same_bytes() {
    let (first, second) = (files_of("first"), files_of("second"));
    assert!(first.len() >= 8, "{} files", first.len());
    for ((name, text), (other_name, other)) in first.iter().zip(&second) {
        assert_eq!(name, other_name);
        let without_time = |text: &str| text.split("\"wall_seconds\"").next().unwrap_or_default().to_owned();
        assert!(without_time(text) == without_time(other), "{name} differs");
    }
}
