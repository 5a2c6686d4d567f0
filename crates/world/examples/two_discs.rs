//! Two discs meet off centre, without friction: watch their impact, their energy and where they go.
//!
//! `cargo run -p halfgap --example two_discs`

use halfgap::geometry::{DVec2, Shape};
use halfgap::{BodySpec, BodyState, WorldBuilder, WorldSettings};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let moving = |x: f64, y: f64, vx: f64| BodyState {
        position: DVec2::new(x, y),
        velocity: DVec2::new(vx, 0.0),
        ..BodyState::default()
    };
    let mut builder = WorldBuilder::new(WorldSettings::default());
    builder.add(BodySpec::movable("big", Shape::disc(0.5)?, 4.0, moving(-2.0, 0.0, 1.0)));
    builder.add(BodySpec::movable("small", Shape::disc(0.25)?, 1.0, moving(2.0, 0.4, -1.5)));
    let mut world = builder.build()?;

    let mut impacts = Vec::new();
    println!("time  big at            small at          kinetic energy");
    for step in 0..=6 {
        world.advance_to(0.5 * f64::from(step), &mut |event| impacts.extend(event.impact().cloned()))?;
        print!("{:3.1} s", world.time());
        for body in world.bodies() {
            let place = world.state(body).position;
            print!(" ({:+.3}, {:+.3}) m", place.x, place.y);
        }
        println!("  {:.12} J", world.energy().kinetic);
    }
    for impact in impacts {
        for row in &impact.rows {
            let Some(point) = row.point else { continue };
            println!(
                "\n{} and {} met at {:.9} s in ({:.4}, {:.4}) m: {:.4} N s turned a closing speed of {:.4} m/s round.",
                world.name(row.primary),
                world.name(row.normal_body),
                impact.time,
                point.x,
                point.y,
                row.impulse,
                -row.velocity_before
            );
        }
    }
    Ok(())
}
