//! Checks the connectors.

use super::{At, Names, optional, shape};
use crate::scene::error::SceneError;
use crate::scene::{ConnectorData, LengthData, RailPath, SlotData, Vector};

pub(super) fn validate(connector: &ConnectorData, names: &Names<'_>, at: &At<'_>) -> Result<(), SceneError> {
    let at = at.field(connector.key());
    let (a, b) = connector.points();
    names.require_point(a, &at.field("a"))?;
    if let Some(b) = b {
        names.require_point(b, &at.field("b"))?;
        names.require_apart(a, b, &at)?;
    }
    match connector {
        ConnectorData::Pin(_) => {}
        ConnectorData::Slot(slot) => validate_normal(slot, &at)?,
        ConnectorData::Rod(LengthData { length, .. }) | ConnectorData::Rope(LengthData { length, .. }) => {
            at.field("length").positive(*length, "m")?;
        }
        ConnectorData::Rail(rail) => validate_rail_path(&rail.path, &at.field("path"))?,
        ConnectorData::RailStop(stop) => {
            validate_rail_path(&stop.path, &at.field("path"))?;
            at.field("at").finite(stop.at)?;
        }
    }
    optional(connector.options().elasticity, |elasticity| at.field("elasticity").zero_to_one(elasticity))
}

fn validate_normal(slot: &SlotData, at: &At<'_>) -> Result<(), SceneError> {
    let at = at.field("normal");
    at.finite_point(slot.normal)?;
    if slot.normal == Vector::ZERO { Err(at.error("must have a direction, got [0, 0]")) } else { Ok(()) }
}

/// Checks that a path is either edges from a start or points of a spline.
fn validate_rail_path(path: &RailPath, at: &At<'_>) -> Result<(), SceneError> {
    match (&path.start, &path.edges, &path.points) {
        (None, None, Some(points)) => shape::validate_points(points, 2, &at.field("points")),
        (Some(start), Some(edges), None) => {
            at.field("start").finite_point(*start)?;
            shape::validate_edges(edges, &at.field("edges"))
        }
        _ => Err(at.error("must have either `points`, or `start` and `edges`")),
    }
}
