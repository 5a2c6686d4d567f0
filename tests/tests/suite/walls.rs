//! Walls of bricks whose contacts slide past each other: some rest on two corners that are next to each other.

use halfgap::geometry::DVec2;
use halfgap::{BodyState, Event, World, WorldSettings};
use halfgap_tests::mechanism::{Workshop, block};
use std::ops::ControlFlow;

/// A brick: position [m], angle [rad], velocity [m/s], angular velocity [rad/s].
type Brick = ([f64; 2], f64, [f64; 2], f64);

/// Bricks of half a metre, two courses of which slide at different speeds, on a floor.
fn bricks(tolerance: f64, elasticity: f64, bricks: &[Brick]) -> World {
    let mut shop = Workshop::of(WorldSettings { tolerance, ..WorldSettings::default() });
    shop.fixed("floor", block(40.0, 1.0), DVec2::new(0.0, -0.5));
    for (index, &(position, angle, velocity, angular_velocity)) in bricks.iter().enumerate() {
        let [position, velocity] = [position, velocity].map(DVec2::from_array);
        let state = BodyState { position, angle, velocity, angular_velocity };
        shop.settler(&format!("brick {index}"), block(0.5, 0.25), 0.125, state, elasticity);
    }
    shop.build()
}

#[test]
fn contacts_that_take_turns_in_slow_impacts_are_let_go() {
    /// Number of impacts of a run, which would have no end if the brick above were held on both corners beneath it.
    const MOST: u32 = 2000;
    let lively: [Brick; 4] = [
        ([0.0096, 0.125], 0.0, [0.47, 0.0], 0.0),
        ([0.51, 0.125], 0.0, [0.5, 0.0], 0.0),
        ([0.27256, 0.37505], 1e-6, [2.0, 0.0], -1e-5),
        ([0.31, 0.63], 0.0, [5.0, 0.0], 3.0),
    ];
    let dull: [Brick; 4] = [
        ([0.017_877_690_18, 0.125_027_950_85], 0.0, [0.475_786_052_38, 0.0], 0.0),
        ([0.518_102_606_00, 0.125_027_950_85], 0.0, [0.482_803_548_88, 0.0], 0.0),
        ([0.305_230_595_21, 0.375_050_474_87], 9.977e-7, [1.892_820_244_49, 1.6e-6], 4.94e-6),
        ([0.389_378_711_13, 0.634_853_672_49], 0.039_526_4, [4.503_415_27, 0.142_360_17], 0.581_367_5),
    ];
    for (name, elasticity, states) in [("lively", 0.1, lively), ("dull", 0.0, dull)] {
        let mut world = bricks(1e-2, elasticity, &states);
        let mut impacts = 0;
        let outcome = world.advance_while(0.2, &mut |event| {
            impacts += u32::from(matches!(event, Event::Impact(_)));
            if impacts < MOST { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert_eq!(outcome, Ok(ControlFlow::Continue(())), "{name}: at {} s", world.time());
    }
}
