//! Single blows: on seams, on bodies that fit exactly, on a bob that rods hold. `halfgap_tests::blows` makes and checks
//! scenes from seeds; `cargo run --release -p halfgap-tests --example blows` runs more of them.

use halfgap::scene::Scene;
use halfgap_tests::blows::{check_drop, check_fit};
use halfgap_tests::generate::all_laws;
use halfgap_tests::{check_at, data};

#[test]
fn a_ball_beside_a_seam_a_piston_in_its_bore_and_a_bob_on_two_rods_are_struck_right() {
    for name in ["F1-seam-energy", "F5b-piston-in-bore", "F3-truss"] {
        let scene = Scene::read(data(&format!("faults/{name}.json"))).expect("a fine scene");
        for tolerance in [1e-6, 1e-8, 1e-10] {
            let report = check_at(&scene, Some(tolerance));
            assert!(report.ok, "{name} at {tolerance:e}: {:?}", report.why);
        }
    }
}

#[test]
fn bodies_dropped_on_seams_keep_as_much_energy_as_their_elasticity_says() {
    for seed in 1..=1000 {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let outcome = check_drop(seed, tolerance);
            assert_eq!(outcome, Ok(()), "drop {seed} at {tolerance:e}");
        }
    }
}

#[test]
fn bodies_that_fit_exactly_are_struck_without_loss_by_every_law() {
    // Seeds 10021 and 11973: a plug leaves its slot with a spin of rounding; a ball wedges itself between corners.
    for seed in (1..=150).chain([10_021, 11_973]) {
        for &law in all_laws() {
            for elasticity in [1.0, 0.7, 0.3, 0.0] {
                let outcome = check_fit(seed, law, elasticity);
                assert_eq!(outcome, Ok(()), "fit {seed} by {law}, elasticity {elasticity}");
            }
        }
    }
}
