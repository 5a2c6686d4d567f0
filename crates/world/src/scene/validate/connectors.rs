//! Checks the connectors.

use super::motion::validate_drive;
use super::{At, Names, optional, shape};
use crate::scene::error::SceneError;
use crate::scene::{
    ConnectorData, GearData, JointData, LengthData, LimitsData, MotorData, PulleyData, RackData, RailPath,
    RunData, Vector,
};

pub(super) fn validate(
    connector: &ConnectorData,
    (names, run): (&Names<'_>, &RunData),
    at: &At<'_>,
) -> Result<(), SceneError> {
    let at = at.field(connector.key());
    let [a, b] = connector.points();
    if let Some(a) = a {
        names.require_point(a, &at.field("a"))?;
    }
    if let Some(b) = b {
        names.require_point(b, &at.field("b"))?;
    }
    if let (Some(a), Some(b)) = (a, b) {
        names.require_apart(a, b, &at)?;
    }
    match connector {
        ConnectorData::Pin(_) | ConnectorData::Weld(_) => {}
        ConnectorData::Slot(slot) => validate_direction(slot.normal, &at.field("normal"))?,
        ConnectorData::Slider(slider) => validate_direction(slider.axis, &at.field("axis"))?,
        ConnectorData::Rod(LengthData { length, .. }) | ConnectorData::Rope(LengthData { length, .. }) => {
            at.field("length").positive(*length, "m")?;
        }
        ConnectorData::Rail(rail) => validate_rail_path(&rail.path, &at.field("path"))?,
        ConnectorData::RailStop(stop) => {
            validate_rail_path(&stop.path, &at.field("path"))?;
            at.field("at").finite(stop.at)?;
        }
        ConnectorData::Gear(gear) => validate_gear(gear, names, &at)?,
        ConnectorData::Rack(rack) => validate_rack(rack, names, &at)?,
        ConnectorData::Pulley(pulley) => validate_pulley(pulley, &at)?,
    }
    if let Some(joint) = connector.joint() {
        validate_joint(&joint, run, &at)?;
    }
    optional(connector.options().elasticity, |elasticity| at.field("elasticity").zero_to_one(elasticity))
}

fn validate_direction(direction: Vector, at: &At<'_>) -> Result<(), SceneError> {
    at.finite_point(direction)?;
    if direction == Vector::ZERO { Err(at.error("must have a direction, got [0, 0]")) } else { Ok(()) }
}

fn not_zero(value: f64, unit: &str, at: &At<'_>) -> Result<(), SceneError> {
    at.finite(value)?;
    if value == 0.0 { Err(at.error(format!("must not be 0{unit}"))) } else { Ok(()) }
}

fn validate_gear(gear: &GearData, names: &Names<'_>, at: &At<'_>) -> Result<(), SceneError> {
    let GearData { a, b, ratio, carrier, .. } = gear;
    for (field, name) in [("a", a), ("b", b), ("carrier", carrier)] {
        names.require_or_world(name, &at.field(field))?;
    }
    for (one, other) in [(a, b), (a, carrier), (b, carrier)] {
        if one == other && !(carrier == "world" && (one == carrier || other == carrier)) {
            return Err(at.error(format!("ties {one:?} to itself; the bodies must be different")));
        }
    }
    not_zero(*ratio, "", &at.field("ratio"))
}

fn validate_rack(rack: &RackData, names: &Names<'_>, at: &At<'_>) -> Result<(), SceneError> {
    let RackData { wheel, bar, radius, axis, .. } = rack;
    names.require_or_world(wheel, &at.field("wheel"))?;
    names.require_or_world(bar, &at.field("bar"))?;
    if wheel == bar {
        return Err(at.error(format!("ties {wheel:?} to itself; wheel and bar must be different bodies")));
    }
    not_zero(*radius, " m", &at.field("radius"))?;
    validate_direction(*axis, &at.field("axis"))
}

fn validate_pulley(pulley: &PulleyData, at: &At<'_>) -> Result<(), SceneError> {
    at.field("wheel_a").finite_point(pulley.wheel_a)?;
    at.field("wheel_b").finite_point(pulley.wheel_b)?;
    at.field("ratio").positive(pulley.ratio, "")?;
    at.field("length").positive(pulley.length, "m")
}

/// Checks what acts on a free coordinate.
fn validate_joint(joint: &JointData<'_>, run: &RunData, at: &At<'_>) -> Result<(), SceneError> {
    let JointData { motor, friction: (friction, most), limits, drive, spring } = joint;
    if let Some(MotorData { speed, max }) = motor {
        let at = at.field("motor");
        at.field("speed").finite(*speed)?;
        if max.is_infinite() {
            let message = "must be finite; a motor that holds its speed whatever it takes is a `drive`";
            return Err(at.field("max").error(message));
        }
        at.field("max").not_negative(*max, "")?;
    }
    optional(*most, |most| at.field(friction).not_negative(most, ""))?;
    if let Some(LimitsData { lower, upper, elasticity }) = limits {
        let at = at.field("limits");
        optional(*lower, |lower| at.field("lower").finite(lower))?;
        optional(*upper, |upper| at.field("upper").finite(upper))?;
        at.field("elasticity").zero_to_one(*elasticity)?;
        if let (Some(lower), Some(upper)) = (lower, upper)
            && lower > upper
        {
            let message = format!("`lower` must not be above `upper`, got {lower} and {upper}");
            return Err(at.error(message));
        }
        if (lower, upper) == (&None, &None) {
            return Err(at.error("must have `lower`, `upper` or both"));
        }
    }
    if let Some(drive) = drive {
        validate_drive(drive, run, &at.field("drive"))?;
        for (field, is_there) in [("motor", motor.is_some()), (*friction, most.is_some())] {
            if is_there {
                let message = "has no effect on a coordinate that is driven: give either this or `drive`";
                return Err(at.field(field).error(message));
            }
        }
    }
    if let Some(spring) = spring {
        let at = at.field("spring");
        at.field("rest").finite(spring.rest)?;
        at.field("stiffness").not_negative(spring.stiffness, "")?;
        at.field("damping").not_negative(spring.damping, "")?;
    }
    Ok(())
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
