//! Checks the numbers of shapes and paths; the geometry crate checks whether outlines close and cross.

use super::motion::validate_lift;
use super::{At, each, optional};
use crate::scene::error::SceneError;
use crate::scene::{EdgeData, OutlineData, PathData, RingData, RoundedBlockData, ShapeData, Vector};

pub(super) fn validate(shape: &ShapeData, at: &At<'_>) -> Result<(), SceneError> {
    let at = at.field(shape.key());
    match shape {
        ShapeData::Disc(disc) => at.field("radius").length(disc.radius),
        ShapeData::Block(block) => validate_sides(block.width, block.height, &at),
        ShapeData::RoundedBlock(block) => validate_rounded_block(block, &at),
        ShapeData::Polygon(polygon) => validate_points(&polygon.vertices, 3, &at.field("vertices")),
        ShapeData::Ring(ring) => validate_ring(ring, &at),
        ShapeData::Capsule(capsule) => {
            at.field("length").length(capsule.length)?;
            at.field("radius").length(capsule.radius)
        }
        ShapeData::Regular(regular) => {
            validate_count(regular.sides, 3, &at.field("sides"))?;
            at.field("radius").length(regular.radius)
        }
        ShapeData::Gear(gear) => {
            validate_count(gear.teeth, 3, &at.field("teeth"))?;
            at.field("module").length(gear.module)
        }
        ShapeData::RackBar(rack) => {
            validate_count(rack.teeth, 1, &at.field("teeth"))?;
            at.field("module").length(rack.module)
        }
        ShapeData::Ratchet(ratchet) => {
            validate_count(ratchet.teeth, 3, &at.field("teeth"))?;
            at.field("outer").length(ratchet.outer)?;
            at.field("inner").length(ratchet.inner)?;
            at.field("inner").below(ratchet.inner, ratchet.outer, "outer", "m")
        }
        ShapeData::Geneva(geneva) => {
            validate_count(geneva.slots, 3, &at.field("slots"))?;
            at.field("center_distance").length(geneva.center_distance)?;
            at.field("pin_radius").length(geneva.pin_radius)?;
            at.field("clearance").not_negative(geneva.clearance, "m")
        }
        ShapeData::Cam(cam) => {
            at.field("base").length(cam.base)?;
            at.field("roller").length(cam.roller)?;
            optional(cam.tolerance, |tolerance| at.field("tolerance").length(tolerance))?;
            validate_lift(&cam.lift, &at.field("lift"))
        }
        ShapeData::Outline(outline) => validate_outline(outline, &at),
    }
}

/// Refuses fewer teeth, slots or sides than a shape has, and so many that its edges, ten a tooth, would be more than the
/// elements of a scene.
fn validate_count(count: usize, least: usize, at: &At<'_>) -> Result<(), SceneError> {
    const MOST: usize = 100_000;
    if (least..=MOST).contains(&count) {
        return Ok(());
    }
    Err(at.error(format!("must lie between {least} and {MOST}, got {count}")))
}

fn validate_sides(width: f64, height: f64, at: &At<'_>) -> Result<(), SceneError> {
    at.field("width").length(width)?;
    at.field("height").length(height)
}

fn validate_rounded_block(block: &RoundedBlockData, at: &At<'_>) -> Result<(), SceneError> {
    validate_sides(block.width, block.height, at)?;
    let at = at.field("radius");
    at.length(block.radius)?;
    at.at_most(block.radius, 0.5 * block.width.min(block.height), "half of the shorter side", "m")
}

fn validate_ring(ring: &RingData, at: &At<'_>) -> Result<(), SceneError> {
    at.field("outer").length(ring.outer)?;
    at.field("inner").length(ring.inner)?;
    at.field("inner").below(ring.inner, ring.outer, "outer", "m")
}

fn validate_outline(outline: &OutlineData, at: &At<'_>) -> Result<(), SceneError> {
    if outline.paths.is_empty() {
        return Err(at.field("paths").error("needs at least one path"));
    }
    each(&at.field("paths"), &outline.paths, validate_path)
}

fn validate_path(path: &PathData, at: &At<'_>) -> Result<(), SceneError> {
    at.field("start").finite_point(path.start)?;
    validate_edges(&path.edges, &at.field("edges"))
}

pub(super) fn validate_edges(edges: &[EdgeData], at: &At<'_>) -> Result<(), SceneError> {
    if edges.is_empty() {
        return Err(at.error("needs at least one edge"));
    }
    each(at, edges, |edge, at| {
        let at = at.field(edge.key());
        match edge {
            EdgeData::Line(to) => at.finite_point(*to),
            EdgeData::Arc(arc) => {
                at.field("to").finite_point(arc.to)?;
                at.field("center").finite_point(arc.center)
            }
        }
    })
}

pub(super) fn validate_points(points: &[Vector], least: usize, at: &At<'_>) -> Result<(), SceneError> {
    if points.len() < least {
        return Err(at.error(format!("needs at least {least} points, got {}", points.len())));
    }
    each(at, points, |point, at| at.finite_point(*point))
}
