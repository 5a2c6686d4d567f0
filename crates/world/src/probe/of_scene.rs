//! The probes of a scene.

use super::{Probe, ProbeKind};
use crate::scene::{PointData, ProbeData, Scene, SceneError, WORLD};
use crate::world::World;
use halfgap_collision::{Anchor, BodyId, ConnectorId};

impl Probe {
    /// Makes the probes of a scene, given its world.
    ///
    /// # Errors
    /// [`SceneError`] for a scene that breaks a rule.
    pub fn of_scene(scene: &Scene, world: &World) -> Result<Vec<Self>, SceneError> {
        scene.validate_world()?;
        let body = |name: &str| {
            let place = scene.bodies.iter().position(|body| body.name == name);
            place.filter(|_| name != WORLD).map_or(BodyId::WORLD, BodyId::from_index)
        };
        let anchor = |point: &PointData| world.anchor(body(&point.body), point.point.into());
        let kind = |data: &ProbeData| -> Option<ProbeKind> {
            Some(match data {
                ProbeData::Point(point) => ProbeKind::Point(anchor(point)),
                ProbeData::Angle(angle) => ProbeKind::Angle([body(&angle.a), body(&angle.b)]),
                ProbeData::Distance(distance) => {
                    ProbeKind::Distance([anchor(&distance.a), anchor(&distance.b)])
                }
                ProbeData::Connector(connector) => {
                    let index = scene.find_connector(connector)?;
                    ProbeKind::Connector(ConnectorId(u32::try_from(index).ok()?))
                }
                ProbeData::Contact(bodies) => ProbeKind::Contact(bodies.each_ref().map(|name| body(name))),
            })
        };
        let probes = scene.probes.iter();
        Ok(probes
            .filter_map(|probe| Some(Self { name: probe.name.clone()?, kind: kind(&probe.data)? }))
            .collect())
    }
}

impl World {
    /// A point given in shape coordinates [m], or in those of the world for the background, as one in body coordinates.
    fn anchor(&self, body: BodyId, point: glam::DVec2) -> Anchor {
        let center =
            if body.is_world() { glam::DVec2::ZERO } else { self.bodies[body.index()].center_of_mass };
        Anchor { body, point: point - center }
    }
}
