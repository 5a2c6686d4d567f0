//! Checks the bodies.

use super::{At, Names, each, motion, optional, shape};
use crate::scene::body::WORLD;
use crate::scene::error::SceneError;
use crate::scene::{BodyData, PairData, RunData, Vector};
use std::collections::BTreeMap;

/// Collects the names of all bodies, and checks that they are not empty, not reserved, and unique.
pub(super) fn collect_names<'a>(bodies: &'a [BodyData], at: &At<'_>) -> Result<Names<'a>, SceneError> {
    let mut first_with = BTreeMap::new();
    for (index, body) in bodies.iter().enumerate() {
        let element = at.element(index);
        let place = element.field("name");
        if body.name.is_empty() {
            return Err(place.error("must not be empty"));
        }
        if body.name == WORLD {
            return Err(place.error("\"world\" is reserved for the immovable background"));
        }
        if let Some(first) = first_with.insert(body.name.as_str(), index) {
            return Err(place.error(format!("{:?} is already the name of body[{first}]", body.name)));
        }
    }
    Ok(Names(first_with.into_keys().collect()))
}

pub(super) fn validate(
    body: &BodyData,
    run: &RunData,
    names: &Names<'_>,
    at: &At<'_>,
) -> Result<(), SceneError> {
    shape::validate(&body.shape, &at.field("shape"))?;
    optional(body.mass, |mass| at.field("mass").positive(mass, "kg"))?;
    optional(body.density, |density| at.field("density").positive(density, "kg/m^2"))?;
    optional(body.moment, |moment| at.field("moment").positive(moment, "kg m^2"))?;
    if !body.fixed {
        validate_inertia(body, at)?;
    }
    optional(body.center_of_mass, |point| at.field("center_of_mass").finite_point(point))?;
    optional(body.position, |point| at.field("position").finite_point(point))?;
    optional(body.origin, |point| at.field("origin").finite_point(point))?;
    if body.position.is_some() && body.origin.is_some() {
        return Err(at.field("origin").error("give position or origin, not both"));
    }
    at.field("angle").finite(body.angle)?;
    at.field("velocity").finite_point(body.velocity)?;
    at.field("angular_velocity").finite(body.angular_velocity)?;
    if body.fixed {
        validate_rest(body, at)?;
    }
    at.field("elasticity").zero_to_one(body.elasticity)?;
    at.field("friction").not_negative(body.friction, "")?;
    optional(body.static_friction, |friction| at.field("static_friction").not_negative(friction, ""))?;
    at.field("surface_velocity").finite(body.surface_velocity)?;
    at.field("rolling_resistance").not_negative(body.rolling_resistance, "")?;
    at.field("tangential_elasticity").zero_to_one(body.tangential_elasticity)?;
    optional(body.motion.as_ref(), |motion| motion::validate(motion, body, run, &at.field("motion")))?;
    each(&at.field("passes_through"), &body.passes_through, |other, at| {
        names.require(other, at)?;
        if *other == body.name { Err(at.error("is the body itself, which it cannot meet")) } else { Ok(()) }
    })
}

/// Refuses pairs that would stick less than they are held back when they slip: of each pair, the geometric means count, unless
/// it has coefficients of its own.
pub(super) fn validate_static_friction(
    (bodies, pairs): (&[BodyData], &[PairData]),
    at: &At<'_>,
) -> Result<(), SceneError> {
    let of = |body: &BodyData| [body.static_friction.unwrap_or(body.friction), body.friction];
    let low = bodies.iter().enumerate().filter(|(_, body)| of(body)[0] < of(body)[1]);
    for (index, body) in low {
        let ([sticks, slips], others) = (of(body), bodies.iter().enumerate());
        let has_own = |other: &BodyData| {
            let own = pairs.iter().find(|pair| pair.is_of(&body.name, &other.name));
            own.is_some_and(|pair| pair.friction.or(pair.static_friction).is_some())
        };
        let mut others = others.filter(|&(other, body)| other != index && !has_own(body));
        let is_less = |&(_, other): &(usize, &BodyData)| sticks * of(other)[0] < slips * of(other)[1];
        if let Some((_, other)) = others.find(is_less) {
            let name = &other.name;
            let message = format!(
                "with {name:?} the pair would stick less than it is held back when it slips: give at least `friction`"
            );
            return Err(at.element(index).field("static_friction").error(message));
        }
    }
    Ok(())
}

fn validate_inertia(body: &BodyData, at: &At<'_>) -> Result<(), SceneError> {
    match (body.mass, body.density) {
        (Some(_), Some(_)) => Err(at.field("density").error("give mass or density, not both")),
        (None, None) => Err(at.error(format!("missing mass or density: body {:?} is not fixed", body.name))),
        _ => Ok(()),
    }
}

fn validate_rest(body: &BodyData, at: &At<'_>) -> Result<(), SceneError> {
    if body.velocity != Vector::ZERO {
        return Err(at.field("velocity").error("a fixed body does not move"));
    }
    if body.angular_velocity != 0.0 {
        return Err(at.field("angular_velocity").error("a fixed body does not turn"));
    }
    Ok(())
}
