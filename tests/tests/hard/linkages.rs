//! Loops of connectors: closed, redundant, singular, long.

use super::within;
use halfgap::force::Spring;
use halfgap::geometry::DVec2;
use halfgap::{BodyId, BodyState, ConnectorKind, SlotFrame, World};
use halfgap_tests::mechanism::{
    Workshop, advance, at_rest, block, connector_error, disc, pendulum_period, thrown,
};

const WORLD: BodyId = BodyId::WORLD;

/// A coupler on parallel cranks of 1 m, at an angle [rad] from hanging; with three cranks one is redundant.
fn parallelogram(cranks: usize, angle: f64) -> (World, BodyId) {
    parallelogram_at(1e-10, cranks, angle)
}

/// A parallelogram at a tolerance.
fn parallelogram_at(tolerance: f64, cranks: usize, angle: f64) -> (World, BodyId) {
    let mut shop = Workshop::new(tolerance);
    let arm = DVec2::from_angle(angle - std::f64::consts::FRAC_PI_2);
    let feet: Vec<DVec2> = (0..cranks).map(|index| DVec2::new(2.0 * index as f64, 0.0)).collect();
    let last = *feet.last().expect("there are cranks");
    let coupler = shop.bar("coupler", feet[0] + arm, last + arm);
    let bars: Vec<BodyId> = feet
        .iter()
        .enumerate()
        .map(|(index, &foot)| shop.bar(&format!("crank{index}"), foot, foot + arm))
        .collect();
    for (&bar, &foot) in bars.iter().zip(&feet) {
        shop.pin(WORLD, bar, foot);
        shop.pin(bar, coupler, foot + arm);
    }
    for (index, &bar) in bars.iter().enumerate() {
        for &other in &bars[index + 1..] {
            shop.builder.let_pass(bar, other);
        }
    }
    (shop.build(), bars[0])
}

/// The period of a parallelogram [s]: the coupler (1 kg) moves with the cranks' ends, without turning; each
/// crank (1 kg, 1 by 0.1 m) turns about its end.
fn period_of(cranks: usize, amplitude: f64) -> f64 {
    let count = cranks as f64;
    let moment = 1.0 + count * ((1.0 + 0.01) / 12.0 + 0.25);
    pendulum_period((10.0 * (1.0 + 0.5 * count) / moment).sqrt(), amplitude)
}

#[test]
fn a_parallelogram_with_redundant_cranks_goes_through_its_dead_points() {
    // The linkage lies flat four times in a swing. The redundant cranks leave it only one way to go on.
    for (cranks, tolerances) in [(3, [1e-4, 1e-6, 1e-8, 1e-10]), (4, [1e-4, 1e-6, 1e-8, 1e-9])] {
        for tolerance in tolerances {
            for amplitude in [1.9, 2.2, 2.6] {
                let (mut world, crank) = parallelogram_at(tolerance, cranks, amplitude);
                let start = world.state(crank).angle;
                advance(&mut world, period_of(cranks, amplitude));
                let what =
                    format!("{cranks} cranks from {amplitude} rad at {tolerance:e}, a swing: rate [rad/s]");
                assert!((world.state(crank).angle - start).abs() < 0.1);
                within(&what, world.state(crank).angular_velocity, 30.0 * tolerance);
            }
        }
    }
}

/// A crank and a rod of half a metre each drive a slider along a line, turning at a rate [rad/s]; a spring ties
/// another slider beside it to that one. Two slots hold each slider.
fn folding_bars(tolerance: f64, rate: f64) -> World {
    let mut shop = Workshop::weightless(tolerance);
    let arm = 0.5 * DVec2::from_angle(1.0);
    let end = DVec2::new(2.0 * arm.x, 0.0);
    let state = |position: DVec2, velocity: DVec2, angle: f64, angular_velocity: f64| BodyState {
        position,
        angle,
        velocity,
        angular_velocity,
    };
    let of_crank = state(0.5 * arm, 0.5 * rate * arm.perp(), 1.0, rate);
    let of_rod = state(0.5 * (arm + end), rate * DVec2::new(-1.5 * arm.y, 0.5 * arm.x), -1.0, -rate);
    let crank = shop.body("crank", block(0.5, 0.04), 0.5, of_crank);
    let rod = shop.body("rod", block(0.5, 0.04), 0.5, of_rod);
    let slider =
        shop.body("slider", block(0.2, 0.2), 1.0, thrown(end.x, 0.0, DVec2::new(-2.0 * rate * arm.y, 0.0)));
    let other = shop.body("other", block(0.2, 0.2), 1.0, at_rest(2.0, 0.0));
    let all = [crank, rod, slider, other];
    for (index, &body) in all.iter().enumerate() {
        all[index + 1..].iter().for_each(|&other| shop.builder.let_pass(body, other));
    }
    shop.pin(WORLD, crank, DVec2::ZERO);
    shop.pin(crank, rod, arm);
    shop.pin(rod, slider, end);
    for (body, at) in [(slider, end.x), (other, 2.0)] {
        for place in [DVec2::new(at, 0.0), DVec2::new(at + 0.1, 0.0)] {
            let [a, b] = [shop.anchor(WORLD, DVec2::ZERO), shop.anchor(body, place)];
            shop.connect(ConnectorKind::Slot { a, b, normal: DVec2::Y, frame: SlotFrame::World }, 0.0);
        }
    }
    let ends = [shop.anchor(slider, end), shop.anchor(other, DVec2::new(2.0, 0.0))];
    shop.builder.add_force(std::sync::Arc::new(Spring::new("spring", ends, 1.0, 20.0)));
    shop.build()
}

#[test]
fn a_slider_on_two_slots_passes_the_fold_of_its_bars() {
    for (tolerance, allowed) in [(1e-8, 1e-6), (1e-9, 1e-6), (1e-10, 1e-6)] {
        let mut most: f64 = 0.0;
        for part in 0..60 {
            let mut world = folding_bars(tolerance, 1.0 + f64::from(part) / 12.0);
            advance(&mut world, 3.0);
            let ledger = world.ledger();
            most = most.max(ledger.projections.abs()).max(ledger.integration_error().abs());
        }
        within(
            &format!("60 sliders on two slots, through their folds at {tolerance:e}: energy [J]"),
            most,
            allowed,
        );
    }
}

#[test]
fn a_rod_that_adds_nothing_to_a_pin_costs_no_accuracy() {
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10] {
        let amplitude = 2.9;
        let mut shop = Workshop::new(tolerance);
        let arm = DVec2::from_angle(amplitude - std::f64::consts::FRAC_PI_2);
        let bar = shop.bar("bar", DVec2::ZERO, arm);
        shop.pin(WORLD, bar, DVec2::ZERO);
        let rod = ConnectorKind::Rod {
            a: shop.anchor(WORLD, DVec2::ZERO),
            b: shop.anchor(bar, 0.5 * arm),
            length: 0.5,
        };
        shop.connect(rod, 0.0);
        let mut world = shop.build();
        let start = world.state(bar).angle;
        let rate = f64::sqrt(5.0 / ((1.0 + 0.01) / 12.0 + 0.25));
        let period = pendulum_period(rate, amplitude);
        let what = format!("bar on a pin and a rod at {tolerance:e}");
        for part in [0.1, 0.3, 0.7] {
            advance(&mut world, part * period);
            within(&format!("{what}: energy [J]"), world.ledger().integration_error(), 30.0 * tolerance);
        }
        advance(&mut world, period);
        within(&format!("{what}: angle [rad]"), world.state(bar).angle - start, 30.0 * tolerance);
        within(&format!("{what}: rate [rad/s]"), world.state(bar).angular_velocity, 30.0 * tolerance);
    }
}

#[test]
fn a_parallelogram_with_a_redundant_crank_swings_as_one_pendulum() {
    for cranks in [2, 3, 4] {
        let amplitude = 1.2;
        let (mut world, crank) = parallelogram(cranks, amplitude);
        let start = world.state(crank).angle;
        let period = period_of(cranks, amplitude);
        let energy = world.energy().total();
        advance(&mut world, 3.0 * period);
        let what = format!("parallelogram of {cranks} cranks, 3 swings");
        within(&format!("{what}: angle [rad]"), world.state(crank).angle - start, 1e-8);
        within(&format!("{what}: rate [rad/s]"), world.state(crank).angular_velocity, 1e-7);
        within(&format!("{what}: energy, relative"), world.energy().total() / energy - 1.0, 1e-8);
        within(&format!("{what}: connectors [m]"), connector_error(&world), 1e-12);
    }
}

#[test]
fn a_parallelogram_that_is_let_go_near_its_dead_point_keeps_its_energy() {
    // Where cranks and coupler are in one line the loop may go on in two ways, and its rows depend on each other. Let
    // go near the top, it passes that point on its way down.
    let (mut world, crank) = parallelogram(2, 3.0);
    let energy = world.energy().total();
    let mut worst: f64 = 0.0;
    for piece in 1..=400 {
        advance(&mut world, 0.01 * f64::from(piece));
        worst = worst.max((world.energy().total() - energy).abs());
    }
    assert!((world.state(crank).angle - 3.0).abs() > 0.5, "it has swung");
    within("parallelogram at its dead point: energy [J]", worst, 1e-6);
    within("parallelogram at its dead point: connectors [m]", connector_error(&world), 1e-9);
}

#[test]
fn a_parallelogram_goes_through_its_dead_points_without_losing_energy() {
    // Three coordinates with two rows that depend on each other for a moment: the forces that hold the loop stay
    // finite.
    let mut worst: f64 = 0.0;
    for angle in [2.3, 2.5, 2.7, 2.9] {
        let (mut world, _) = parallelogram(2, angle);
        let energy = world.energy().total();
        advance(&mut world, 20.0);
        worst = worst.max((world.energy().total() / energy - 1.0).abs());
    }
    within("parallelogram, 20 s through its dead points: energy, relative", worst, 1e-9);
}

/// A weightless parallelogram of cranks of 1 m, the second of them fifty times as heavy, that turns at 2 rad/s from a
/// crank angle `across` [rad]; the whole is rotated by `turned` [rad].
fn turning_parallelogram(tolerance: f64, across: f64, turned: f64) -> (World, BodyId) {
    const SPIN: f64 = 2.0;
    let mut shop = Workshop::weightless(tolerance);
    let (along, arm) = (2.0 * DVec2::from_angle(turned), DVec2::from_angle(turned + across));
    let moving = |position: DVec2, angle: f64, velocity: DVec2, angular_velocity: f64| BodyState {
        position,
        angle,
        velocity,
        angular_velocity,
    };
    let swing = |way: DVec2| SPIN * way.perp();
    let cranks = [(DVec2::ZERO, 1.0), (along, 50.0)].map(|(foot, mass)| {
        let state = moving(foot + 0.5 * arm, turned + across, swing(0.5 * arm), SPIN);
        let crank = shop.body(if mass > 1.0 { "heavy" } else { "light" }, block(1.0, 0.1), mass, state);
        shop.pin(WORLD, crank, foot);
        crank
    });
    let state = moving(0.5 * along + arm, turned, swing(arm), 0.0);
    let coupler = shop.body("coupler", block(2.0, 0.1), 1.0, state);
    shop.pin(cranks[0], coupler, arm);
    shop.pin(cranks[1], coupler, along + arm);
    shop.builder.let_pass(cranks[0], cranks[1]);
    (shop.build(), cranks[0])
}

#[test]
fn a_parallelogram_turns_on_through_its_dead_points_whatever_the_tolerance() {
    // The linkage turns as if its cranks were one, through 63 points where it could change to its other way of
    // turning.
    for tolerance in [1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10] {
        let mut worst: f64 = 0.0;
        for (across, turned) in [(1.6, 0.7), (0.4, 0.0), (2.0, -1.9), (1.0, 0.2)] {
            let (mut world, crank) = turning_parallelogram(tolerance, across, turned);
            let start = world.state(crank).angle;
            advance(&mut world, 100.0);
            worst = worst.max((world.state(crank).angle - start - 200.0).abs());
        }
        within(&format!("parallelogram turned by 200 rad at {tolerance}: angle [rad]"), worst, 1e-4);
    }
}

/// Three wheels on one coupling rod under gravity, which turn from a crank angle [rad] on; the whole is rotated by
/// another angle [rad], and shifted.
fn coupled_wheels(tolerance: f64, [crank, turned]: [f64; 2], shift: DVec2) -> (Workshop, BodyId) {
    const SPIN: f64 = 3.0;
    let turn = |v: DVec2| DVec2::from_angle(turned).rotate(v);
    let place = |v: DVec2| turn(v) + shift;
    let mut shop = Workshop::weightless(tolerance);
    let arm = 0.4 * DVec2::from_angle(crank);
    let swing = SPIN * arm.perp();
    let feet = [-1.5, 0.0, 1.5].map(|x| DVec2::new(x, 0.0));
    let state = |position: DVec2, velocity: DVec2, angular_velocity: f64| BodyState {
        position: place(position),
        angle: turned,
        velocity: turn(velocity),
        angular_velocity,
    };
    let rod = shop.body("rod", block(3.2, 0.1), 4.0, state(arm, swing, 0.0));
    let wheels = feet.map(|foot| {
        let name = format!("wheel at {}", foot.x);
        let wheel = shop.body(&name, disc(0.6), 5.0, state(foot, DVec2::ZERO, SPIN));
        shop.pin(WORLD, wheel, place(foot));
        shop.pin(wheel, rod, place(foot + arm));
        wheel
    });
    for body in [rod].into_iter().chain(wheels) {
        shop.builder.add_gravity(body, turn(DVec2::new(0.0, -9.81)));
    }
    (shop, wheels[0])
}

#[test]
fn three_wheels_on_one_rod_start_whichever_way_they_stand() {
    // Velocities that fit up to rounding need no change, and rows that contradict each other by that much allow none.
    let starts = |place: u32| {
        let angles = [0.0157, 0.0618].map(|step| step * f64::from(place));
        let (shop, _) = coupled_wheels(1e-8, angles, DVec2::new(1.3, 4.1));
        shop.builder.build().is_ok()
    };
    let refused = (0..800).filter(|&place| !starts(place)).count();
    within("three wheels on one rod, 800 ways to stand: refused", refused as f64, 0.0);
}

#[test]
fn three_wheels_on_one_rod_turn_on_whichever_way_they_stand() {
    // The middle wheel is redundant, and near each dead point only the motion decides how they turn on.
    let turned_by = |tolerance: f64, turned: f64| {
        let (shop, wheel) = coupled_wheels(tolerance, [1.0, turned], DVec2::ZERO);
        let mut world = shop.build();
        advance(&mut world, 20.0);
        world.state(wheel).angle - turned
    };
    let expected = turned_by(1e-6, 0.0);
    let wrong = (0..12).filter(|&place| (turned_by(1e-9, 0.5 * f64::from(place)) - expected).abs() > 1e-4);
    within("three wheels on one rod, 12 ways to stand: gone wrong", wrong.count() as f64, 1.0);
}

#[test]
fn a_body_pinned_twice_stays_where_it_is() {
    let mut shop = Workshop::new(1e-10);
    let bar = shop.bar("bar", DVec2::new(-1.0, 0.0), DVec2::new(1.0, 0.0));
    for x in [-0.9, -0.3, 0.9] {
        shop.pin(WORLD, bar, DVec2::new(x, 0.0));
    }
    let mut world = shop.build();
    let start = world.state(bar);
    advance(&mut world, 10.0);
    let state = world.state(bar);
    within("bar pinned three times, 10 s: moved [m]", (state.position - start.position).length(), 1e-13);
    within("bar pinned three times, 10 s: turned [rad]", state.angle - start.angle, 1e-13);
    let holding: f64 = world.contact_forces().iter().map(|row| row.force * row.normal.y).sum();
    within("bar pinned three times, 10 s: weight [N]", holding.abs() - 10.0, 1e-9);
}

#[test]
fn a_chain_of_100_links_keeps_together_and_keeps_its_energy() {
    let mut shop = Workshop::new(1e-8);
    let length = 0.2;
    let mut before = WORLD;
    let mut links = Vec::new();
    for index in 0..100 {
        let (from, to) =
            (DVec2::new(length * f64::from(index), 0.0), DVec2::new(length * f64::from(index + 1), 0.0));
        let link = shop.bar(&format!("link{index}"), from, to);
        shop.pin(before, link, from);
        links.push(link);
        before = link;
    }
    for (index, &link) in links.iter().enumerate() {
        for &other in &links[index + 1..] {
            shop.builder.let_pass(link, other);
        }
    }
    let mut world = shop.build();
    advance(&mut world, 0.2);
    let ledger = world.ledger();
    within("chain of 100 links, 0.2 s: connectors [m]", connector_error(&world), 1e-9);
    within(
        "chain of 100 links, 0.2 s: energy, of the kinetic",
        ledger.integration_error() / ledger.now.kinetic,
        1e-6,
    );
}
