//! Slip that leaves no forces, and forces that press against each other.

use super::{block, body, energy_change, floor, gravity, state, world_of};
use crate::within;
use halfgap_tests::mechanism::{GRAVITY, advance};
use std::fmt::Write;

/// Its slip has no forces, stops at once, and leaves the block to turn about the corner ahead: the turn about it stays,
/// m v h/2 = I w with I = m (w^2 + h^2)/3. It falls back on its base, and lies where it was.
#[test]
fn a_block_too_rough_to_slide_stops_at_once_and_tips_over_its_corner() {
    for friction in [10.0, 1e3] {
        let thrown = body("block", &block(1.0, 0.2), [0.0, 0.1], friction, "velocity = [3.0, 0.0]");
        let mut world = world_of(&[floor(100.0, friction), thrown, gravity(0.0, -GRAVITY)].concat());
        let kept = 0.5 * 0.3f64.powi(2) / ((1.0 + 0.04) / 3.0);
        advance(&mut world, 0.01);
        let what = format!("block that slides with mu {friction:e}");
        within(&format!("{what}: jam [J]"), world.ledger().jams - (kept - 4.5), 1e-12);
        advance(&mut world, 2.0);
        let block = state(&world, "block");
        within(&format!("{what}: back in its place [m]"), block.position.x, 1e-12);
        within(&format!("{what}: speed [m/s]"), block.velocity.length(), 1e-12);
    }
}

/// Four corners bear a wedge of 10 N in a notch whose sides are rough, where two would do.
#[test]
fn a_wedge_in_a_rough_notch_stays_and_is_not_squeezed() {
    let lean = 0.2f64.tan();
    for friction in [0.1, 0.5] {
        let half = |y: f64| 0.5 + lean * y;
        let mut parts = gravity(0.0, -GRAVITY);
        for side in [-1.0, 1.0] {
            let _ = write!(
                parts,
                "[[body]]\nname = \"wall {side}\"\nfixed = true\nfriction = {friction:?}\nelasticity = 0.0\norigin = [0.0, 0.0]\n\
                 shape = {{ polygon = {{ vertices = [[{:?}, -1.0], [{:?}, -1.0], [{:?}, 1.0], [{:?}, 1.0]] }} }}\n",
                side * half(-1.0),
                side * 3.0,
                side * 3.0,
                side * half(1.0)
            );
        }
        let (narrow, wide) = (half(-0.5), half(0.5));
        let _ = write!(
            parts,
            "[[body]]\nname = \"wedge\"\nmass = 1.0\nfriction = {friction:?}\nelasticity = 0.0\norigin = [0.0, 0.0]\n\
             shape = {{ polygon = {{ vertices = [[{:?}, -0.5], [{narrow:?}, -0.5], [{wide:?}, 0.5], [{:?}, 0.5]] }} }}\n",
            -narrow, -wide
        );
        let mut world = world_of(&parts);
        let before = state(&world, "wedge");
        let mut events = 0;
        world.advance_to(1000.0, &mut |_| events += 1).expect("it stays");
        assert_eq!(events, 0);
        let what = format!("wedge in a notch, mu {friction}, 1,000 s");
        within(
            &format!("{what}: moved [m]"),
            state(&world, "wedge").position.distance(before.position),
            1e-15,
        );
        within(&format!("{what}: energy [J]"), energy_change(&world), 1e-15);
        let forces = world.contact_forces();
        assert_eq!(forces.len(), 4);
        // Forces along the walls carry the most at the bound of friction: less pressure than this there is not.
        let least = GRAVITY / (0.2f64.sin() + friction * 0.2f64.cos());
        let pressed: f64 = forces.iter().map(|contact| contact.force).sum();
        within(&format!("{what}: pressed beyond need [N]"), pressed - least, 1e-5);
        for contact in forces {
            let friction = contact.friction.expect("it is rough");
            assert!(friction.sticks && friction.cone_use() <= 1.0 + 1e-12, "{contact:?}");
        }
    }
}

/// What is left after a slip of 1 m/s that stops at once is the turn about the tip: v sin(lean) over the moment of 4/3
/// about it. For all of these leans slip has no forces at mu = 1.6: 1 + 3 cos (cos - 1.6 sin) < 0.
#[test]
fn a_rod_that_slides_on_its_tip_jams_alike_to_both_sides() {
    for tangent in [1.7f64, 2.0, 2.5] {
        let lean = tangent.atan();
        let rods = [1.0, -1.0].map(|side| {
            let more = format!(
                "moment = {:?}\nvelocity = [{:?}, 0.0]\nangle = {:?}\n",
                1.0 / 3.0,
                -side,
                side * lean
            );
            let shape = "polygon = { vertices = [[1.0, 0.0], [0.0, 0.01], [-1.0, 0.0], [0.0, -0.01]] }";
            let rod = body("rod", shape, [side * lean.cos(), lean.sin()], 1.6, &more);
            let mut world = world_of(&[floor(200.0, 1.6), rod, gravity(0.0, -GRAVITY)].concat());
            advance(&mut world, 0.1);
            world
        });
        let kept = 0.5 * lean.sin().powi(2) / (4.0 / 3.0);
        for (world, side) in rods.iter().zip(["left", "right"]) {
            let what = format!("rod of slope {tangent} that slides to the {side}: jam [J]");
            within(&what, world.ledger().jams - (kept - 0.5), 1e-10);
        }
        let [here, there] = rods.map(|world| state(&world, "rod"));
        within("the same: unlike in the mirror [m]", here.position.x + there.position.x, 1e-12);
        within("the same: unlike in the mirror [rad]", here.angle + there.angle, 1e-12);
    }
}
