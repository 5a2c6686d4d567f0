//! Lift of a roller by a cam that turns under it.
//!
//! The cam is a base circle and a nose, both true arcs, joined by the two straight flanks that touch both. The roller
//! slides up and down above the cam's shaft. For each angle the roller is lowered until the distance of the two shapes
//! is zero; where the roller rests on an arc, its lift is known in closed form, and the two agree to rounding.
//!
//! Run it with `cargo run -p halfgap-geometry --example cam_and_roller`.

use halfgap_geometry::{DVec2, EdgeSpec, PathSpec, Pose, Shape, ShapeError};

/// Radius of the base circle [m].
const BASE: f64 = 0.030;
/// Radius of the nose [m].
const NOSE: f64 = 0.010;
/// Distance of the nose's center from the shaft [m].
const THROW: f64 = 0.035;
/// Radius of the roller [m].
const ROLLER: f64 = 0.012;

fn main() -> Result<(), ShapeError> {
    let (cam, roller) = (cam()?, Shape::disc(ROLLER)?);
    let mass = cam.mass_properties();
    println!(
        "A cam of {:.1} mm^2, whose centroid is {:.3} mm off the shaft.",
        mass.area * 1e6,
        mass.centroid.y * 1e3
    );
    println!("angle    lift     on an arc  touching");
    for step in 0..=18 {
        let angle = f64::from(step * 10).to_radians();
        let cam_pose = Pose::new(DVec2::ZERO, angle);
        let height = resting_height(&cam, &cam_pose, &roller);
        let found = cam.distance(&cam_pose, &roller, &Pose::new(DVec2::new(0.0, height), 0.0));
        let part = ["base", "right flank", "nose", "left flank"][found.edge_a.edge as usize];
        let lift = lift_of(height);
        let exact = on_arc_height(part, angle)
            .map_or("   -   ".to_owned(), |exact| format!("{:7.4}", lift_of(exact)));
        let bar = "#".repeat((lift.max(0.0) * 2.0) as usize);
        println!("{:4} deg {lift:7.4} mm {exact} mm {part:12} {bar}", step * 10);
    }
    Ok(())
}

/// Lift [mm] of a roller at a height [m] above its lowest height, rounded to 0.1 nm.
fn lift_of(height: f64) -> f64 {
    ((height - BASE - ROLLER) * 1e10).round() * 1e-7 + 0.0
}

/// The cam with its nose up.
fn cam() -> Result<Shape, ShapeError> {
    // The flanks touch both circles where their normals do, at this angle above the horizontal.
    let rise = ((BASE - NOSE) / THROW).asin();
    let normal = DVec2::new(rise.cos(), rise.sin());
    let flip = DVec2::new(-1.0, 1.0);
    let nose = DVec2::new(0.0, THROW);
    Shape::from_paths(&[PathSpec {
        start: normal * flip * BASE,
        edges: vec![
            EdgeSpec::Arc { to: normal * BASE, center: DVec2::ZERO, clockwise: false },
            EdgeSpec::Line { to: nose + normal * NOSE },
            EdgeSpec::Arc { to: nose + normal * flip * NOSE, center: nose, clockwise: false },
            EdgeSpec::Line { to: normal * flip * BASE },
        ],
    }])
}

/// Height [m] at which the roller rests on the cam: it is lowered by its distance from the cam, so that it never
/// overshoots, until no distance remains.
fn resting_height(cam: &Shape, cam_pose: &Pose, roller: &Shape) -> f64 {
    let mut height = 3.0 * (BASE + THROW);
    for _ in 0..2000 {
        let found = cam.distance(cam_pose, roller, &Pose::new(DVec2::new(0.0, height), 0.0));
        if found.distance < 1e-15 {
            break;
        }
        height -= found.distance;
    }
    height
}

/// Height [m] of a roller that rests on one of the cam's arcs, at the cam's angle [rad]; `None` on a flank.
fn on_arc_height(part: &str, angle: f64) -> Option<f64> {
    let on_circle =
        |center: DVec2, radius: f64| center.y + ((radius + ROLLER).powi(2) - center.x.powi(2)).sqrt();
    match part {
        "base" => Some(on_circle(DVec2::ZERO, BASE)),
        "nose" => Some(on_circle(DVec2::new(-angle.sin(), angle.cos()) * THROW, NOSE)),
        _ => None,
    }
}
