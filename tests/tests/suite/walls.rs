//! Walls of bricks whose contacts slide past each other: some rest on two corners that are next to each other.

use halfgap::geometry::DVec2;
use halfgap::{BodyState, Event, World, WorldSettings};
use halfgap_tests::mechanism::{Workshop, block, disc, thrown};
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
    const MOST: u32 = 200;
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

#[test]
fn corners_that_pass_each_other_do_not_hand_over_without_end() {
    /// Places [m] and speeds [m/s] of two courses, of which the upper one slides over the lower one.
    const LOWER: [(f64, f64); 6] = [
        (3.265_965_710_316_327_3e-9, 0.0),
        (0.500_000_489_194_700_9, 0.0),
        (1.000_000_859_692_224_5, 0.0),
        (1.500_001_366_553_502_1, 0.000_670_284_224_308_760_7),
        (2.000_002_123_254_435, 0.000_538_641_830_740_812_5),
        (2.500_002_583_972_582_6, -1.395_800_255_242_414_2e-7),
    ];
    const UPPER: [(f64, f64); 5] = [
        (0.250_000_085_699_913_55, 1.600_272_618_276_309_2),
        (0.750_000_397_261_538_4, 1.599_904_967_507_791),
        (1.250_000_976_707, 1.600_272_390_701_262_8),
        (1.750_001_660_642_860_8, 1.600_272_618_276_309_2),
        (2.250_002_098_172_312, 1.599_758_167_380_745_3),
    ];
    let mut shop = Workshop::of(WorldSettings { tolerance: 1e-3, ..WorldSettings::default() });
    shop.fixed("floor", block(40.0, 1.0), DVec2::new(0.0, -0.5));
    let courses = [(0.125_002_8, &LOWER[..]), (0.375_005_6, &UPPER)];
    for (height, course) in courses {
        for (index, &(place, speed)) in course.iter().enumerate() {
            let state = thrown(place, height, DVec2::new(speed, 0.0));
            shop.dull(&format!("brick {index} at {height}"), block(0.5, 0.25), 0.125, state);
        }
    }
    // The ball comes too late to matter, but for the rounding of a step that its search cuts.
    let ball = thrown(-3.0, 0.645_689_462_101_162_2, DVec2::new(4.596_004_958_411_041, 0.0));
    shop.dull("ball", disc(0.2), 3.0 * std::f64::consts::PI * 0.04, ball);
    let mut world = shop.build();
    // A quarter of a metre on, the left ends of the upper course leave the right ends of the lower one.
    let mut events = 0;
    let outcome = world.advance_while(0.2, &mut |_| {
        events += 1;
        if events < 2000 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    assert_eq!(outcome, Ok(ControlFlow::Continue(())), "at {} s", world.time());
}
