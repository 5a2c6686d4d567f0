//! Checks the values of a scene, in the order of the file, and stops at the first that breaks a rule.

mod bodies;
mod check;
mod connectors;
mod expected;
mod forces;
mod motion;
mod pairs;
mod probes;
mod run;
mod shape;

use super::body::WORLD;
use super::error::SceneError;
use super::nearest::did_you_mean;
use super::{NamedData, PointData, RunData, Scene};
use check::{At, optional};
use std::collections::BTreeSet;

/// Checks every value of the scene.
pub(super) fn validate(scene: &Scene) -> Result<(), SceneError> {
    validate_world(scene)?;
    let names = bodies::collect_names(&scene.bodies, &At::Top.field("body"))?;
    let at = At::Top.field("expected");
    each(&at, &scene.expected, |one, at| expected::validate(one, &scene.run, &names, at))
}

/// Checks every value but the expected states, whose times another duration may exclude.
pub(super) fn validate_world(scene: &Scene) -> Result<(), SceneError> {
    let top = At::Top;
    validate_run(&scene.run)?;
    let names = bodies::collect_names(&scene.bodies, &top.field("body"))?;
    each(&top.field("body"), &scene.bodies, |body, at| bodies::validate(body, &scene.run, &names, at))?;
    bodies::validate_static_friction((&scene.bodies, &scene.pairs), &top.field("body"))?;
    each(&top.field("connector"), &scene.connectors, |one, at| {
        connectors::validate(one, (&names, &scene.run), at)
    })?;
    each(&top.field("force"), &scene.forces, |one, at| forces::validate(one, &names, at))?;
    let at = top.field("pair");
    let check = |index: usize| {
        let (before, pair) = (&scene.pairs[..index], &scene.pairs[index]);
        pairs::validate(pair, (before, &scene.bodies), &names, &at.element(index))
    };
    (0..scene.pairs.len()).try_for_each(check)?;
    validate_names(&scene.connectors, &top.field("connector"))?;
    validate_names(&scene.forces, &top.field("force"))?;
    let at = top.field("probe");
    (0..scene.probes.len()).try_for_each(|index| probes::validate((scene, index), &names, &at.element(index)))
}

/// Checks the names that some elements may have.
fn validate_names<T>(named: &[NamedData<T>], at: &At<'_>) -> Result<(), SceneError> {
    named.iter().enumerate().try_for_each(|(index, one)| {
        let name = one.name.as_deref();
        name.map_or(Ok(()), |name| probes::require_new(name, &named[..index], &at.element(index)))
    })
}

/// Checks the table `[run]`.
pub(super) fn validate_run(run: &RunData) -> Result<(), SceneError> {
    run::validate(run, &At::Top.field("run"))
}

/// Refuses a recording of more states than fit into memory.
pub(super) fn validate_recording(scene: &Scene) -> Result<(), SceneError> {
    run::validate_recording(scene, &At::Top.field("run"))
}

/// Applies a check to each element of an array.
fn each<T>(
    at: &At<'_>,
    items: &[T],
    mut check: impl FnMut(&T, &At<'_>) -> Result<(), SceneError>,
) -> Result<(), SceneError> {
    items.iter().enumerate().try_for_each(|(index, item)| check(item, &at.element(index)))
}

/// The names of the scene's bodies.
struct Names<'a>(BTreeSet<&'a str>);

impl Names<'_> {
    fn require(&self, name: &str, at: &At<'_>) -> Result<(), SceneError> {
        if name == WORLD {
            return Err(at.error(format!("must be a body, not the background {WORLD:?}")));
        }
        if self.0.contains(name) { Ok(()) } else { Err(self.unknown(name, &[], at)) }
    }

    fn require_or_world(&self, name: &str, at: &At<'_>) -> Result<(), SceneError> {
        if name == WORLD || self.0.contains(name) { Ok(()) } else { Err(self.unknown(name, &[WORLD], at)) }
    }

    /// Returns the error of a name that neither a body has nor is among `others`.
    fn unknown(&self, name: &str, others: &[&str], at: &At<'_>) -> SceneError {
        let known = self.0.iter().copied().chain(others.iter().copied());
        at.error(format!("there is no body named {name:?}{}", did_you_mean(name, known, '"')))
    }

    /// Returns an error if two points that are tied are on one body.
    fn require_apart(&self, a: &PointData, b: &PointData, at: &At<'_>) -> Result<(), SceneError> {
        if a.body != b.body {
            return Ok(());
        }
        Err(at.error(format!("ties {:?} to itself; the two points must be on different bodies", a.body)))
    }

    fn require_point(&self, point: &PointData, at: &At<'_>) -> Result<(), SceneError> {
        self.require_or_world(&point.body, &at.field("body"))?;
        at.field("point").finite_point(point.point)
    }
}
