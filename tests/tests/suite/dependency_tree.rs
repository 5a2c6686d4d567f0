//! A dependency on one layer compiles only the layers below it, and no more other packages than that layer needs.

use std::collections::BTreeSet;
use std::process::Command;

/// Packages of procedural macros: built for the host, not linked.
const OF_MACROS: [&str; 5] = ["proc-macro2", "quote", "syn", "thiserror-impl", "unicode-ident"];

/// Names of the packages that a package of this workspace is linked with, itself included.
fn linked(package: &str, options: &[&str]) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "-p", package, "-e", "normal", "--prefix", "none", "--format", "{p}"])
        .args(["--offline", "--locked"])
        .args(options)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs, as it has just built this test");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("names of packages are text");
    let names = text.lines().filter_map(|line| line.split_whitespace().next());
    names.filter(|name| !OF_MACROS.contains(name)).map(str::to_owned).collect()
}

fn set(names: &[&str]) -> BTreeSet<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

/// The packages among the given ones that are layers of the workspace.
fn layers(packages: &BTreeSet<String>) -> BTreeSet<String> {
    packages.iter().filter(|name| name.starts_with("halfgap")).cloned().collect()
}

#[test]
fn the_lower_layers_alone_are_light() {
    let small = ["glam", "libm", "thiserror"];
    let geometry = set(&[&small[..], &["halfgap-geometry"]].concat());
    assert_eq!(linked("halfgap-geometry", &[]), geometry);
    let collision = set(&[&small[..], &["halfgap-geometry", "halfgap-collision"]].concat());
    assert_eq!(linked("halfgap-collision", &[]), collision);
    let advance = linked("halfgap-advance", &["--no-default-features"]);
    assert_eq!(advance, set(&["halfgap-advance", "libm", "thiserror"]));
}

#[test]
fn a_layer_leans_on_those_below_it_only() {
    let order = ["halfgap-geometry", "halfgap-collision", "halfgap-contact", "halfgap-advance", "halfgap"];
    for (place, package) in order.into_iter().enumerate() {
        assert_eq!(layers(&linked(package, &[])), set(&order[..=place]), "{package}");
    }
}

#[test]
fn no_interior_point_method_is_built_for_who_does_not_ask_for_it() {
    for package in ["halfgap-contact", "halfgap"] {
        let found = linked(package, &["--no-default-features"]);
        for heavy in ["clarabel", "serde", "toml"] {
            assert!(!found.contains(heavy), "{heavy} in {package}: {found:?}");
        }
    }
    assert!(!linked("halfgap-advance", &[]).contains("clarabel"));
}
