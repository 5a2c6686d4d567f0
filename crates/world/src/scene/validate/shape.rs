//! Checks the numbers of shapes and paths; the geometry crate checks whether outlines close and cross.

use super::{At, each};
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
        ShapeData::Outline(outline) => validate_outline(outline, &at),
    }
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
