//! Hints: what the author of a scene may not have meant, although it is a scene.

use crate::builder::{WorldBuilder, center_of_mass};
use crate::rounded::Rounded;
use crate::scene::{BodyData, Scene, ShapeData};
use halfgap_collision::BodyId;

/// Distance of a centroid from the origin of the shape's coordinates, as a fraction of the shape's reach, up to which
/// the shape counts as centred: the accuracy to which the ends of an outline's edges must be written.
const CENTRED: f64 = 1e-6;

/// Returns the hints on a scene whose bodies are in a builder.
pub(super) fn of(scene: &Scene, builder: &WorldBuilder) -> Vec<String> {
    let bodies = scene.bodies.iter().enumerate();
    bodies.filter_map(|(index, body)| moved_drawing(body, BodyId::from_index(index), builder)).collect()
}

/// Hint on a fixed body that is drawn about another point than its centroid, as in world coordinates, and put with its
/// centroid at the world's origin because nothing is said of its place.
fn moved_drawing(body: &BodyData, id: BodyId, builder: &WorldBuilder) -> Option<String> {
    let is_drawn = matches!(body.shape, ShapeData::Polygon(_) | ShapeData::Outline(_));
    let is_placed = body.position.is_some() || body.origin.is_some() || body.center_of_mass.is_some();
    if !body.fixed || !is_drawn || is_placed {
        return None;
    }
    let spec = builder.body(id);
    let centroid = center_of_mass(spec);
    (centroid.length() > CENTRED * spec.shape.reach()).then(|| {
        format!(
            "fixed body {:?} is not where it is drawn: without `position` or `origin` its centroid, ({}, {}) m in the \
             drawing, is put at (0, 0); `origin = [0.0, 0.0]` keeps the drawing in place, `position = [0.0, 0.0]` \
             says that it is meant",
            body.name,
            Rounded(centroid.x),
            Rounded(centroid.y)
        )
    })
}
