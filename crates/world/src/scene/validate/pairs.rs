//! Checks of the pairs that differ from what their bodies say.

use super::Names;
use super::check::{At, optional};
use crate::scene::{BodyData, PairData, SceneError};

/// Checks a pair, given those before it.
pub(super) fn validate(
    pair: &PairData,
    (before, bodies): (&[PairData], &[BodyData]),
    names: &Names<'_>,
    at: &At<'_>,
) -> Result<(), SceneError> {
    let [a, b] = &pair.bodies;
    for (index, name) in pair.bodies.iter().enumerate() {
        names.require(name, &at.field("bodies").element(index))?;
    }
    if a == b {
        return Err(at.field("bodies").error("a body makes no pair with itself"));
    }
    if let Some(other) = before.iter().position(|other| other.is_of(a, b)) {
        return Err(at.field("bodies").error(format!("is the pair of pair[{other}] again: give all in one")));
    }
    optional(pair.friction, |friction| at.field("friction").not_negative(friction, ""))?;
    optional(pair.static_friction, |friction| at.field("static_friction").not_negative(friction, ""))?;
    optional(pair.elasticity, |elasticity| at.field("elasticity").zero_to_one(elasticity))?;
    optional(pair.rolling_resistance, |rolling| at.field("rolling_resistance").not_negative(rolling, ""))?;
    optional(pair.tangential_elasticity, |share| at.field("tangential_elasticity").zero_to_one(share))?;
    validate_static_friction(pair, bodies, at)
}

/// Refuses a pair that would stick less than it is held back when it slips.
fn validate_static_friction(pair: &PairData, bodies: &[BodyData], at: &At<'_>) -> Result<(), SceneError> {
    let Some(sticks) = pair.static_friction else { return Ok(()) };
    let of_body =
        |name: &String| bodies.iter().find(|body| body.name == *name).map_or(0.0, |body| body.friction);
    let slips = pair.friction.unwrap_or_else(|| {
        let [a, b] = pair.bodies.each_ref().map(of_body);
        if a == b { a } else { (a * b).sqrt() }
    });
    if sticks < slips {
        let message =
            format!("the pair would stick less than it is held back when it slips: give at least {slips}");
        return Err(at.field("static_friction").error(message));
    }
    Ok(())
}

impl PairData {
    /// True if it is the pair of two bodies of these names.
    pub(super) fn is_of(&self, a: &str, b: &str) -> bool {
        let [first, second] = &self.bodies;
        (first == a && second == b) || (first == b && second == a)
    }
}
