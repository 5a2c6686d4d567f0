//! What lies at a point or along a ray at the present time. Looks at every body: bodies whose disc of reach is missed
//! cost one comparison each.

use crate::world::World;
use glam::DVec2;
use halfgap_collision::BodyId;
use halfgap_geometry::{Pose, Ray};

/// The first point at which a ray meets a body, in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldHit {
    /// The body.
    pub body: BodyId,
    /// Distance [m] from the ray's origin.
    pub distance: f64,
    /// Point at which the ray meets the body's outline [m].
    pub point: DVec2,
    /// Outward unit normal of the outline there.
    pub normal: DVec2,
}

impl World {
    /// The bodies in whose solid a point [m] lies at the present time, in the order in which they were added; on an
    /// outline itself the answer is either. A point that is not finite lies in none.
    ///
    /// ```
    /// use halfgap::geometry::{DVec2, Ray, Shape};
    /// use halfgap::{BodySpec, WorldBuilder, WorldSettings};
    ///
    /// let mut builder = WorldBuilder::new(WorldSettings::default());
    /// let wheel = builder.add(BodySpec::fixed("wheel", Shape::ring(2.0, 1.0)?, DVec2::new(5.0, 0.0)));
    /// let world = builder.build()?;
    /// assert_eq!(world.bodies_at(DVec2::new(3.5, 0.0)).collect::<Vec<_>>(), [wheel]);
    /// assert_eq!(world.bodies_at(DVec2::new(5.0, 0.0)).count(), 0);
    ///
    /// let ray = Ray { origin: DVec2::ZERO, direction: DVec2::X };
    /// let hit = world.cast_ray(&ray, f64::INFINITY).ok_or("the wheel is in the way")?;
    /// assert_eq!((hit.body, hit.distance, hit.normal), (wheel, 3.0, DVec2::NEG_X));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn bodies_at(&self, point: DVec2) -> impl Iterator<Item = BodyId> {
        self.bodies().filter(move |&body| {
            let (shape, pose) = (self.shape(body), self.state(body).pose());
            pose.position.distance(point) <= shape.reach() && shape.contains(pose.point_to_body(point))
        })
    }

    /// The first body within `max_distance` [m] whose outline a ray meets at the present time, from outside or inside;
    /// of two at one distance the one that was added first. A ray that starts within a body meets the outline from
    /// inside, where the normal points along the ray. A ray whose direction is zero or not finite meets nothing.
    #[must_use]
    pub fn cast_ray(&self, ray: &Ray, max_distance: f64) -> Option<WorldHit> {
        let mut nearest: Option<WorldHit> = None;
        for body in self.bodies() {
            let pose = self.state(body).pose();
            let most = nearest.map_or(max_distance, |hit| hit.distance);
            let Some(hit) = self.cast_at(body, &pose, ray, most) else { continue };
            if nearest.is_none_or(|nearest| hit.distance < nearest.distance) {
                nearest = Some(hit);
            }
        }
        nearest
    }

    /// The point at which a ray first meets a body in a pose.
    fn cast_at(&self, body: BodyId, pose: &Pose, ray: &Ray, max_distance: f64) -> Option<WorldHit> {
        let shape = self.shape(body);
        if pose.position.distance(ray.origin) - shape.reach() > max_distance {
            return None;
        }
        let own =
            Ray { origin: pose.point_to_body(ray.origin), direction: pose.vector_to_body(ray.direction) };
        let hit = shape.cast_ray(&own, max_distance)?;
        Some(WorldHit {
            body,
            distance: hit.distance,
            point: pose.point_to_world(hit.point),
            normal: pose.vector_to_world(hit.normal),
        })
    }
}
