//! Impacts that jam: large impulses cancel each other, between contacts that need not take part.
//!
//! A contact active since the start or its capture is held at the gap at which it formed. A body that fits between two
//! others with little room may so be held on both sides, farther from both than the gap at which bodies fire. As it
//! passes their corners, two such contacts come to lie opposite each other: they act like a vice, and the least angle
//! between them stops the body for good.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::impact::impacts::{Manner, find_impulses};
use crate::rigid::region::touching::Region;
use crate::rigid::region::view::View;
use crate::rigid::remedies::Remedy;
use crate::rigid::shares::{MAJOR, NEGLIGIBLE};
use halfgap_collision::Collision;
use halfgap_contact::{Impact, ImpactError};

/// Excludes from a region the contacts farther apart than the gap at which bodies fire, if the impulses of contacts
/// jam; true if there are any.
pub(crate) fn exclude_jammed(assembly: &Assembly, region: &mut Region, impact: &Impact) -> bool {
    // The contact that fired takes part, though cutting the steps may have moved it.
    let may_be_excluded =
        |record: &Collision| !record.must_handle && !record.gap_state().is_at_target(assembly.sink());
    if !region.records().iter().any(may_be_excluded) || !jams(assembly, region, impact) {
        return false;
    }
    if !assembly.remedies().act(Remedy::JammedImpulses) {
        return false;
    }
    region.exclude(may_be_excluded);
    true
}

/// Finds the impulses of a region without the excluded records, except those that are pressed all the same: of a
/// body that fits with little room only one side is. Where those jam, too, or cannot be solved, nothing is
/// excluded.
pub(crate) fn find_impulses_of_pressed(
    view: &View<'_>,
    region: &mut Region,
    impact: &mut Impact,
    manner: Manner,
) -> Result<(), ImpactError> {
    loop {
        let is_sound = find_impulses(view, region, impact, manner).is_ok();
        if !is_sound || jams(view.assembly, region, impact) {
            region.admit_all();
            return find_impulses(view, region, impact, manner);
        }
        if !admit_pressed(region, impact) {
            return Ok(());
        }
    }
}

/// True if the impulses of contacts jam: they cancel each other by far.
pub(crate) fn jams(assembly: &Assembly, region: &mut Region, impact: &Impact) -> bool {
    let contacts = region.records().iter().zip(impact.impulses());
    let contacts = contacts.filter(|(record, _)| !record.parties.bilateral);
    let largest = contacts.fold(0.0f64, |most, (_, impulse)| most.max(impulse.abs()));
    largest > 0.0 && largest > MAJOR * momentum_changed(assembly, region, impact)
}

/// Largest change of momentum [N s] of any body of a region by an impact: its mass times the change of velocity,
/// plus that of spin at its reach.
fn momentum_changed(assembly: &Assembly, region: &mut Region, impact: &Impact) -> f64 {
    region.sum_changes(impact);
    let changed = region.bodies().iter().zip(region.changes());
    changed.map(|(&body, change)| assembly.trajectory(body).load(change)).fold(0.0, f64::max)
}

/// Admits again the excluded records that are pressed by the impulses found without them; true if there are any.
fn admit_pressed(region: &mut Region, impact: &Impact) -> bool {
    region.sum_changes(impact);
    let records = region.records().iter().chain(region.excluded());
    let rates = records.map(|record| -record.motion.normal_velocity);
    let least = NEGLIGIBLE * rates.fold(0.0, f64::max);
    region.admit(|record, change| change.max(record.motion.normal_velocity + change) < -least)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::bodies::trajectory::FreeMotion;
    use crate::rigid::books::energy::interrupt;
    use crate::rigid::books::report::ImpactReport;
    use crate::rigid::event::resolving::resolve_impact;
    use crate::rigid::parts::{BodyPart, RigidParts};
    use crate::rigid::region::cause::Cause;
    use crate::rigid::region::collecting::collect_region;
    use crate::rigid::settings::RigidSettings;
    use crate::rigid::test_scene::FINE;
    use crate::rigid::test_scene::rooms_of;
    use crate::time::Time;
    use glam::DVec2;
    use halfgap_collision::BodyId;
    use halfgap_collision::{Body, BodyState, Tolerances};
    use halfgap_geometry::Shape;

    /// Gap [m] at which bodies fire; the target zone reaches from 0.4 to 1.6 times that.
    const GAP: f64 = 5e-3;

    /// Velocity [m/s] after an impact of a shuttle of 1 kg that goes down between a wall on its left and the end of
    /// another on its right, a gap [m] away from both and tilted so that its way narrows; a disc on its right moves
    /// towards it at a speed [m/s].
    fn velocity_after(gap: f64, disc_speed: f64) -> DVec2 {
        let body = |shape: Result<Shape, _>, inverse_mass: f64, position: DVec2, state: BodyState| {
            let shape = shape.expect("a fine size");
            let body = Body { shape, inverse_mass, inverse_moment: inverse_mass, elasticity: 0.0 };
            BodyPart::new(body, FreeMotion::default(), BodyState { position, ..state })
        };
        let going = |x: f64, y: f64| BodyState { velocity: DVec2::new(x, y), ..BodyState::default() };
        let side = 0.5 + gap;
        let bodies = vec![
            body(Shape::block(4.0, 20.0), 0.0, DVec2::new(-side - 2.0, 0.0), going(0.0, 0.0)),
            body(Shape::block(4.0, 4.0), 0.0, DVec2::new(side + 2.0, 2.25), going(0.0, 0.0)),
            body(Shape::block(1.0, 2.5), 1.0, DVec2::ZERO, BodyState { angle: -2e-5, ..going(0.0, -1.0) }),
            body(Shape::disc(0.3), 1.0, DVec2::new(0.8 + GAP, -0.5), going(-disc_speed, 0.0)),
        ];
        let tolerances = Tolerances { target_gap: GAP, accuracy: 0.6 * GAP, velocity_tol: 1e-3 };
        let parts = RigidParts { bodies, ..RigidParts::default() };
        let settings = RigidSettings { tolerances, ..FINE };
        let mut rooms = rooms_of(parts, settings, Time::ZERO);
        let mut work = rooms.work.take().expect("the start has made it");
        for (body, velocity) in
            [(BodyId(2), DVec2::new(0.0, -1.0)), (BodyId(3), DVec2::new(-disc_speed, 0.0))]
        {
            let state = rooms.assembly.trajectory(body).state_at(rooms.assembly.now());
            let state = BodyState { velocity, angular_velocity: 0.0, ..state };
            interrupt(&mut rooms.assembly, &mut rooms.books, body).fly_from(Time::ZERO, state);
        }
        work.region.set_cause(Cause::Start);
        collect_region(&rooms.view(), &mut work.region, &[BodyId(2), BodyId(3)], rooms.assembly.now());
        let (mut report, manner) = (ImpactReport::default(), Manner::Inelastic);
        let now = rooms.assembly.now();
        resolve_impact(&mut rooms, &mut work.region, &mut work.impact, &mut report, now, manner)
            .expect("it can be resolved");
        rooms.assembly.trajectory(BodyId(2)).state_at(now).velocity
    }

    #[test]
    fn a_shuttle_with_room_is_not_held_by_the_angle_of_its_sides() {
        assert!((velocity_after(1.4 * GAP, 0.0).y + 1.0).abs() < 1e-9);
        // Where the shuttle touches both walls, it is a wedge.
        let velocity = velocity_after(0.98 * GAP, 0.0);
        assert!(velocity.y.abs() < 1e-6, "{velocity}");
    }

    #[test]
    fn a_shuttle_with_room_is_pressed_against_one_side_only() {
        let velocity = velocity_after(1.4 * GAP, 1.0);
        assert!((velocity.y + 1.0).abs() < 1e-4, "{velocity}");
        assert!(velocity.x.abs() < 1e-4, "the wall stops it: {velocity}");
    }
}
