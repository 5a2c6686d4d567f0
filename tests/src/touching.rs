//! Invariants of contacts: bodies that are reported to touch do so, and push.
//!
//! A contact whose end is missed goes on beyond the ends of its edges, or holds its bodies together. Neither
//! penetrates, nor does it cost energy.

use halfgap::{ContactForce, World};

/// Largest distance of bodies in contact, as a multiple of the target gap plus the half-width of the target zone.
const ZONES: f64 = 4.0;
/// Pull of a contact that may be rounding, as a fraction of all forces on its bodies.
const PULL: f64 = 1e-6;

/// The first violation by a contact, as its kind and a message; `None` if there is none. `rounding` is that of
/// coordinates [m], `no_force` a force [N] that may be rounding.
pub(crate) fn wrong_contact(world: &World, rounding: f64, no_force: f64) -> Option<(&'static str, String)> {
    let rows = world.contact_forces();
    let mut contacts = rows.iter().filter(|row| row.connector.is_none());
    contacts.find_map(|contact| {
        not_touching(world, contact, rounding).or_else(|| pulling(world, contact, &rows, no_force))
    })
}

fn not_touching(world: &World, contact: &ContactForce, rounding: f64) -> Option<(&'static str, String)> {
    let [(first, pose), (second, other_pose)] =
        contact.bodies.map(|body| (world.shape(body), world.state(body).pose()));
    let distance = first.distance(&pose, second, &other_pose).distance;
    let tolerances = world.tolerances();
    let allowed = ZONES * (tolerances.target_gap + tolerances.accuracy) + rounding;
    let is_wrong = distance.is_nan() || distance > allowed;
    is_wrong.then(|| {
        ("contact apart", format!("{:?}: {distance:e} m, {allowed:e} m allowed", names(world, contact)))
    })
}

/// Reports a contact that pulls. Contacts of the same two bodies count together: where there are more than necessary,
/// their single forces are not unique.
fn pulling(
    world: &World,
    contact: &ContactForce,
    rows: &[ContactForce],
    no_force: f64,
) -> Option<(&'static str, String)> {
    let is_on = |row: &ContactForce, body| row.bodies.contains(&body);
    let on_either = rows.iter().filter(|row| contact.bodies.iter().any(|&body| is_on(row, body)));
    let all: f64 = on_either.map(|row| row.force.abs()).sum();
    let between = rows
        .iter()
        .filter(|row| row.connector.is_none() && contact.bodies.iter().all(|&body| is_on(row, body)));
    let force: f64 = between.map(|row| row.force).sum();
    let is_wrong = force.is_nan() || force < -(PULL * all + no_force);
    is_wrong.then(|| ("contact pulls", format!("{:?}: {force:e} N of {all:e} N", names(world, contact))))
}

fn names<'a>(world: &'a World, contact: &ContactForce) -> [&'a str; 2] {
    contact.bodies.map(|body| world.name(body))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world_of;

    /// Kind of the violation by a contact of two discs of radius 1 m, by the distance of their centres [m] and the
    /// force [N].
    fn wrong(apart: f64, force: f64) -> Option<&'static str> {
        let disc = "shape = { disc = { radius = 1.0 } }\nmass = 1.0\n";
        let world = world_of(&format!(
            "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = {{ duration = 1.0 }}\n\
             [[body]]\nname = \"a\"\n{disc}[[body]]\nname = \"b\"\n{disc}position = [{apart}, 0.0]\n"
        ));
        let bodies = [0, 1].map(halfgap::BodyId);
        let (point, normal) = (halfgap::geometry::DVec2::ZERO, halfgap::geometry::DVec2::X);
        let contact = ContactForce {
            bodies,
            connector: None,
            point: Some(point),
            torque: None,
            normal,
            force,
            friction: None,
            rolling_moment: None,
            heat: None,
        };
        let found =
            not_touching(&world, &contact, 1e-12).or_else(|| pulling(&world, &contact, &[contact], 1e-12));
        found.map(|(kind, _)| kind)
    }

    #[test]
    fn bodies_apart_or_pulled_are_in_no_contact() {
        assert_eq!(wrong(2.0 + 1e-10, 5.0), None);
        assert_eq!(wrong(2.001, 5.0), Some("contact apart"));
        assert_eq!(wrong(2.0 + 1e-10, -5.0), Some("contact pulls"));
    }
}
