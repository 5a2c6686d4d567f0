//! Blocks that fall come to rest.

use halfgap::BodyState;
use halfgap::geometry::DVec2;
use halfgap_tests::mechanism::{Workshop, advance, at_rest, block};

#[test]
fn a_block_that_lands_askew_comes_to_rest_flat() {
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
    let state = BodyState { angle: 0.3, ..at_rest(0.0, 1.5) };
    let body = shop.dull("block", block(2.0, 1.0), 1.0, state);
    let mut world = shop.build();
    advance(&mut world, 5.0);
    let state = world.state(body);
    assert!(state.angle.abs() < 1e-9, "it lies at {} rad", state.angle);
    assert!((state.position.y - 0.5 - world.tolerances().target_gap).abs() < 1e-9, "{}", state.position);
    assert!(state.angular_velocity.abs() < 1e-12 && state.velocity.y.abs() < 1e-12, "{state:?}");
    assert_eq!(world.contact_forces().len(), 2);
    let ledger = world.ledger();
    assert!(ledger.integration_error().abs() < 1e-7 * ledger.start, "{ledger:?}");
}

#[test]
fn a_block_that_bounces_and_rocks_comes_to_rest_flat() {
    for elasticity in ["0.3", "0.5", "0.8"] {
        let scene = format!(
            "format = \"halfgap-scene-1\"\ntitle = \"rocks\"\nrun = {{ duration = 60.0 }}\n\
             force = [{{ gravity = {{ acceleration = [0.0, -10.0] }} }}]\n\
             [[body]]\nname = \"floor\"\nfixed = true\nshape = {{ block = {{ width = 60.0, height = 1.0 }} }}\n\
             position = [0.0, -0.5]\n\
             [[body]]\nname = \"block\"\nmass = 1.0\nshape = {{ block = {{ width = 2.0, height = 1.0 }} }}\n\
             position = [0.0, 1.5]\nangle = 0.3\nelasticity = {elasticity}\n"
        );
        let mut world = halfgap_tests::world_of(&scene);
        let body = world.find("block").expect("it is there");
        advance(&mut world, 60.0);
        let state = world.state(body);
        let upright = (state.angle / std::f64::consts::PI).round() * std::f64::consts::PI;
        assert!((state.angle - upright).abs() < 1e-8, "e = {elasticity}: it lies at {} rad", state.angle);
        assert!(state.angular_velocity.abs() < 1e-9, "e = {elasticity}: {state:?}");
        assert_eq!(world.contact_forces().len(), 2, "e = {elasticity}");
        println!("e = {elasticity}: {:?}", world.statistics());
    }
}
