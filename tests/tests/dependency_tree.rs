//! Who picks one layer compiles only the layers below it.

use std::process::Command;

/// Names of the packages in the normal-dependency tree of a package of this workspace.
fn normal_dependencies(package: &str) -> Vec<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "-p", package, "-e", "normal", "--prefix", "none", "--format", "{p}"])
        .args(["--offline", "--locked"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs, as it has just built this test");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("names of packages are text");
    text.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect()
}

#[test]
fn geometry_alone_is_light() {
    let found = normal_dependencies("halfgap-geometry");
    assert!(found.iter().any(|name| name == "glam"), "{found:?}");
    for heavy in ["faer", "clarabel", "serde", "serde_core", "clap", "halfgap-collision", "halfgap-contact"] {
        assert!(!found.iter().any(|name| name == heavy), "{heavy} in {found:?}");
    }
}
