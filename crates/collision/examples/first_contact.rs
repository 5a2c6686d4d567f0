//! First contact of a spinning capsule, thrown at a disc: its time, place and record.
//!
//! Run it with `cargo run -p halfgap-collision --example first_contact`.

use glam::DVec2;
use halfgap_collision::{
    Body, BodyId, BodyState, Flight, Moment, Motion, MovingShape, Search, SearchSettings, Tolerances,
    detect_pair, first_contact,
};
use halfgap_geometry::Shape;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gravity = DVec2::new(0.0, -9.81);
    let solid = |shape| Body { shape, inverse_mass: 1.0, inverse_moment: 2.0, elasticity: 0.8 };
    let (capsule, disc) = (solid(Shape::capsule(1.0, 0.15)?), solid(Shape::disc(0.5)?));
    let throw = BodyState {
        position: DVec2::new(-4.0, 0.0),
        angle: 0.3,
        velocity: DVec2::new(6.0, 4.0),
        angular_velocity: 12.0,
    };
    let flight = Flight::new(throw, gravity, 0.0, 0.0);
    let rest = Flight::fixed(DVec2::new(0.0, 0.2), 0.0);

    let tolerances = Tolerances { target_gap: 1e-9, accuracy: 6e-10, velocity_tol: 1e-9 };
    let a = MovingShape { shape: &capsule.shape, motion: &flight, offset: 0.0 };
    let b = MovingShape { shape: &disc.shape, motion: &rest, offset: 0.0 };
    let time = match first_contact(&a, &b, 5.0, &tolerances, &SearchSettings::default()) {
        Search::Contact(contact) => contact.time,
        Search::NoneBefore(time) => {
            println!("The capsule flies past: no contact before {time} s.");
            return Ok(());
        }
    };
    let turns = flight.state_at(time).angle / std::f64::consts::TAU;
    println!("The capsule touches the disc after {time:.9} s and {turns:.2} turns.\n");

    // The record of that moment, as a contact solver would get it.
    let a = Moment { id: BodyId(0), body: &capsule, moving: flight.moving_at(time) };
    let b = Moment { id: BodyId(1), body: &disc, moving: rest.moving_at(time) };
    let mut records = Vec::new();
    detect_pair(&a, &b, &tolerances, tolerances.distance_tol(), time, &mut records);
    for record in &records {
        let (parties, geometry, motion) = (&record.parties, &record.geometry, &record.motion);
        println!("found by          {:?}", parties.detector);
        for (name, side) in [("primary", parties.primary), ("normal", parties.normal)] {
            if let Some(site) = side.site {
                println!("{name:<17} body {}, {:?}", side.body.0, site.kind);
            }
        }
        println!("gap               {:.3e} m ({:?})", geometry.distance, record.gap_state().zone());
        println!("point             ({:.6}, {:.6}) m", geometry.point_primary.x, geometry.point_primary.y);
        println!("normal            ({:.6}, {:.6})", geometry.normal.x, geometry.normal.y);
        println!("normal turns with ({:.4}, {:.4}) 1/s", geometry.normal_rate.x, geometry.normal_rate.y);
        println!("closing speed     {:.6} m/s", -motion.normal_velocity);
        println!("sliding speed     {:.6} m/s", motion.lateral_velocity);
    }
    Ok(())
}
