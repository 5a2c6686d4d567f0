//! Shapes of bodies from those of a scene.

use crate::scene::{
    CamData, EdgeData, GearShapeData, GenevaData, LeanData, PathData, RackBarData, ShapeData,
};
use halfgap_collision::MotionMoment;
use halfgap_geometry::{EdgeSpec, FitError, GenevaWheel, Lean, Lift, PathSpec, Shape, ShapeError, Teeth};

/// Thickness of a rack's bar below its teeth, in modules [-], if none is given: as much as a tooth is high, nearly.
const THICKNESS: f64 = 2.0;
/// By how much a cam may be off, as a share of its base [-], if nothing is given: as flanks of teeth beside their module.
const CAM_TOLERANCE: f64 = Teeth::TOLERANCE;

/// Builds the shape of a body.
///
/// # Errors
/// Measures or paths of which no shape can be made.
pub(super) fn build_shape(shape: &ShapeData) -> Result<Shape, ShapeError> {
    match shape {
        ShapeData::Disc(disc) => Shape::disc(disc.radius),
        ShapeData::Block(block) => Shape::block(block.width, block.height),
        ShapeData::RoundedBlock(block) => Shape::rounded_block(block.width, block.height, block.radius),
        ShapeData::Polygon(polygon) => {
            let vertices: Vec<_> = polygon.vertices.iter().map(|&vertex| vertex.into()).collect();
            Shape::polygon(&vertices)
        }
        ShapeData::Ring(ring) => Shape::ring(ring.outer, ring.inner),
        ShapeData::Outline(outline) => {
            let paths: Vec<_> = outline.paths.iter().map(path_spec).collect();
            Shape::from_paths(&paths)
        }
        ShapeData::Capsule(capsule) => Shape::capsule(capsule.length, capsule.radius),
        ShapeData::Regular(regular) => Shape::regular_polygon(regular.sides, regular.radius),
        ShapeData::Gear(gear) => Shape::gear(&teeth_of_wheel(gear), gear.bore),
        ShapeData::RackBar(rack) => {
            let teeth = teeth_of_rack(rack);
            Shape::rack_bar(&teeth, rack.thickness.unwrap_or(THICKNESS * teeth.module))
        }
        ShapeData::Ratchet(ratchet) => {
            let lean = match ratchet.lean {
                LeanData::Left => Lean::Left,
                LeanData::Right => Lean::Right,
            };
            Shape::ratchet(ratchet.teeth, ratchet.outer, ratchet.inner, lean)
        }
        ShapeData::Geneva(geneva) => {
            let &GenevaData { slots, center_distance, pin_radius, clearance, lock_radius } = geneva;
            Shape::geneva(&GenevaWheel { slots, center_distance, pin_radius, clearance, lock_radius })
        }
        ShapeData::Cam(cam) => build_cam(cam),
    }
}

fn teeth_of_wheel(gear: &GearShapeData) -> Teeth {
    let common = Teeth::common(gear.module, gear.teeth);
    let tolerance = gear.tolerance.unwrap_or(common.tolerance);
    let common = Teeth { backlash: gear.backlash, root_radius: gear.root_radius, tolerance, ..common };
    with_profile(common, [gear.pressure_angle, gear.addendum, gear.dedendum])
}

fn teeth_of_rack(rack: &RackBarData) -> Teeth {
    let common = Teeth::common(rack.module, rack.teeth);
    let common = Teeth { backlash: rack.backlash, root_radius: rack.root_radius, ..common };
    with_profile(common, [rack.pressure_angle, rack.addendum, rack.dedendum])
}

/// Teeth with the pressure angle, addendum and dedendum that are given.
fn with_profile(common: Teeth, [pressure_angle, addendum, dedendum]: [Option<f64>; 3]) -> Teeth {
    Teeth {
        pressure_angle: pressure_angle.unwrap_or(common.pressure_angle),
        addendum: addendum.unwrap_or(common.addendum),
        dedendum: dedendum.unwrap_or(common.dedendum),
        ..common
    }
}

fn build_cam(cam: &CamData) -> Result<Shape, ShapeError> {
    // Tables that make no law have been refused before.
    let law = cam.lift.to_law().map_err(|_| FitError::NotFinite { parameter: 0.0 })?;
    let before = law.at(0.0).value;
    let lift = |turn: f64| {
        let MotionMoment { value, rate, acceleration } = law.at(turn);
        Lift { value: value - before, rate, acceleration }
    };
    Shape::cam(cam.base, cam.roller, &lift, cam.tolerance.unwrap_or(CAM_TOLERANCE * cam.base))
}

fn path_spec(path: &PathData) -> PathSpec {
    PathSpec { start: path.start.into(), edges: path.edges.iter().map(edge_spec).collect() }
}

pub(super) fn edge_spec(edge: &EdgeData) -> EdgeSpec {
    match edge {
        EdgeData::Line(to) => EdgeSpec::Line { to: (*to).into() },
        EdgeData::Arc(arc) => {
            EdgeSpec::Arc { to: arc.to.into(), center: arc.center.into(), clockwise: arc.clockwise }
        }
    }
}
