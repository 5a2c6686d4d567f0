//! Checks the probes, and the names of what they name.

use super::check::At;
use super::{Names, did_you_mean};
use crate::scene::{ConnectorRef, NamedData, ProbeData, Scene, SceneError};

/// Checks a probe, given those before it.
pub(super) fn validate(
    (scene, index): (&Scene, usize),
    names: &Names<'_>,
    at: &At<'_>,
) -> Result<(), SceneError> {
    let probe = &scene.probes[index];
    let Some(name) = &probe.name else {
        return Err(at.field("name").error("is missing: a probe has a name, under which it is told"));
    };
    require_new(name, &scene.probes[..index], at)?;
    let at = at.field(probe.key());
    match &probe.data {
        ProbeData::Point(point) => names.require_point(point, &at),
        ProbeData::Angle(angle) => {
            names.require_or_world(&angle.a, &at.field("a"))?;
            names.require_or_world(&angle.b, &at.field("b"))
        }
        ProbeData::Distance(distance) => {
            names.require_point(&distance.a, &at.field("a"))?;
            names.require_point(&distance.b, &at.field("b"))
        }
        ProbeData::Connector(connector) => require_connector(scene, connector, &at),
        ProbeData::Contact(bodies) => {
            let [a, b] = bodies;
            names.require(a, &at.element(0))?;
            names.require(b, &at.element(1))?;
            if a == b { Err(at.error("a body makes no contact with itself")) } else { Ok(()) }
        }
    }
}

/// Refuses a name that is empty, or that one of those before has.
pub(super) fn require_new<T>(name: &str, before: &[NamedData<T>], at: &At<'_>) -> Result<(), SceneError> {
    let at = at.field("name");
    if name.is_empty() {
        return Err(at.error("must not be empty"));
    }
    match before.iter().position(|other| other.name.as_deref() == Some(name)) {
        Some(other) => Err(at.error(format!("{name:?} is the name of number {other} already"))),
        None => Ok(()),
    }
}

fn require_connector(scene: &Scene, connector: &ConnectorRef, at: &At<'_>) -> Result<(), SceneError> {
    if scene.find_connector(connector).is_some() {
        return Ok(());
    }
    Err(match connector {
        ConnectorRef::Index(index) => at.error(format!(
            "there is no connector {index}; the scene has {}, counted from 0",
            scene.connectors.len()
        )),
        ConnectorRef::Name(name) => {
            let known = scene.connectors.iter().filter_map(|connector| connector.name.as_deref());
            at.error(format!("there is no connector named {name:?}{}", did_you_mean(name, known, '"')))
        }
    })
}
