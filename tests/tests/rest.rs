//! Rest: bodies that lose their bounce stay where they are, at no cost.

use halfgap_tests::mechanism::rest_time;
use halfgap_tests::{on_floor, world_of};

#[test]
fn a_resting_contact_forms_where_a_ball_without_bounce_lands() {
    let mut world =
        world_of(&on_floor("shape = { disc = { radius = 0.5 } }\nposition = [0.0, 1.75]\nelasticity = 0.0"));
    let rest = rest_time(&mut world, 10.0);
    assert!((rest - 0.5).abs() < 1e-8, "at rest at {rest} s");
    assert_eq!(world.statistics().impacts, 1);
    let forces = world.contact_forces();
    assert!(forces.len() == 1 && (forces[0].force - 10.0).abs() < 1e-12, "{forces:?}");
}

#[test]
fn a_body_that_starts_at_rest_on_the_floor_stays_there() {
    for shape in ["disc = { radius = 0.5 }", "block = { width = 2.0, height = 1.0 }"] {
        let mut world = world_of(&on_floor(&format!("shape = {{ {shape} }}\nposition = [0.0, 0.5]")));
        let body = world.find("body").expect("it is there");
        let before = world.state(body);
        world.advance_to(1e3, &mut |_| {}).unwrap_or_else(|error| panic!("{shape}: {error}"));
        // Nothing holds it along the floor: an angle of one rounding error is a slope.
        let moved = world.state(body).position - before.position;
        assert!(moved.y.abs() < 1e-13 && moved.x.abs() < 1e-9, "{shape}: moved by {moved}");
        assert!(world.state(body).angle.abs() < 1e-12, "{shape}: turned by {}", world.state(body).angle);
        let weight: f64 = world.contact_forces().iter().map(|row| row.force).sum();
        assert!((weight - 10.0).abs() < 1e-11, "{shape}: {weight} N");
    }
}

#[test]
fn a_bouncing_ball_rests_when_the_geometric_series_ends() {
    for (elasticity, rest) in [(0.5, 1.5), (0.9, 9.5), (0.98, 49.5)] {
        let body = format!(
            "shape = {{ disc = {{ radius = 0.5 }} }}\nposition = [0.0, 1.75]\nelasticity = {elasticity}"
        );
        let mut world = world_of(&on_floor(&body));
        // A drop of 0.5 s, then bounces of 1, e, e^2, ... s.
        let last = rest_time(&mut world, 60.0);
        let speed = world.tolerances().velocity_tol;
        assert!(
            (last - rest).abs() < 10.0 * speed / (1.0 - elasticity),
            "e = {elasticity}: at {last} s, not {rest} s"
        );
        assert!(world.statistics().impacts > 10, "{} impacts", world.statistics().impacts);
        let ledger = world.ledger();
        assert!(ledger.integration_error().abs() < 1e-12 * ledger.start, "{ledger:?}");
        assert!((ledger.impacts + ledger.captures + 12.5).abs() < 1e-6, "{ledger:?}");
    }
}
