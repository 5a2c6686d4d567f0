//! Hints: what the author of a scene may not have meant, although it is a scene.

use super::bodies::Bodies;
use crate::builder::{WorldBuilder, center_of_mass};
use crate::scene::{BodyData, FieldPath, ForceData, Scene, ShapeData};
use halfgap_collision::BodyId;
use halfgap_geometry::{EdgeSpec, Pose, Rounded};

/// Returns the hints on a scene whose bodies are in a builder.
pub(super) fn of(scene: &Scene, builder: &WorldBuilder) -> Vec<String> {
    let bodies = scene.bodies.iter().enumerate();
    let moved = bodies.filter_map(|(index, body)| moved_drawing(body, BodyId::from_index(index), builder));
    let forces = scene.forces.iter().enumerate();
    moved
        .chain(forces.filter_map(|(index, force)| without_direction((index, &force.data), scene, builder)))
        .collect()
}

/// Hint on a force between two points that start at the same place, where it has no direction.
fn without_direction(
    (index, force): (usize, &ForceData),
    scene: &Scene,
    builder: &WorldBuilder,
) -> Option<String> {
    let bodies = Bodies::of(scene);
    let field = FieldPath::top().field("force").element(index).field(force.key());
    match force {
        ForceData::MutualGravity(_) => {
            let mut places: Vec<_> = bodies
                .acted_on(force)
                .filter(|(_, body)| !body.fixed || body.mass.is_some() || body.density.is_some())
                .map(|(id, body)| (builder.body(id).state.position, body))
                .collect();
            places.sort_by(|(p, _), (q, _)| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
            let same = places.windows(2).find(|pair| pair[0].0 == pair[1].0)?;
            let [first, second] = [&same[0].1.name, &same[1].1.name];
            Some(format!(
                "bodies {first:?} and {second:?} start at the same place, where {field} has no direction: they do not \
                 attract each other"
            ))
        }
        ForceData::Spring(spring) if spring.rest_length > 0.0 => {
            let [a, b] = [&spring.a, &spring.b].map(|end| {
                let anchor = builder.anchor(bodies.find(&end.body), end.point.into());
                let pose =
                    |id: BodyId| if id.is_world() { Pose::IDENTITY } else { builder.body(id).state.pose() };
                pose(anchor.body).point_to_world(anchor.point)
            });
            (a == b).then(|| {
                format!(
                    "the ends of {field} start at the same place, where it has no direction: it does not push"
                )
            })
        }
        _ => None,
    }
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
    // A shape counts as centred to the accuracy to which the ends of an outline's edges must be written.
    (centroid.length() > EdgeSpec::FIT * spec.shape.reach()).then(|| {
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
