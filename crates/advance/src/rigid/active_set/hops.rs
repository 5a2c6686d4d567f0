//! Hops too low to be told from contact: a contact opens at a rate v so small that its acceleration a < 0 closes it
//! again before its gap has grown by much. Such a contact is active at once, instead of being captured a moment later.
//!
//! A hop takes T = 2 v/|a| and stays within the target zone, where the landing stops the contact without elasticity. If
//! the row's coefficients and a are constant meanwhile, stopping the contact as it opens leads to the same positions
//! and velocities at T. So the less the bodies turn and slide in T, the higher a hop may be, up to the half-width of
//! the target zone.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::rows::row_of;
use crate::rigid::region::touching::Region;
use crate::rigid::shares::{HALF_ZONE, LARGE, TINY};
use halfgap_collision::{BodyId, Collision};

/// True if a contact of a region opens, perhaps in a low hop only. A contact that is alone in its region must open
/// no faster than `velocity_tol`: a faster one bounces visibly, and is stopped when it lands.
pub(crate) fn may_hop(assembly: &Assembly, region: &Region, record: &Collision) -> bool {
    let is_slow = !record.gap_state().opens(record.tolerances.velocity_tol);
    opens(assembly, record) && (region.records().len() > 1 || is_slow)
}

/// True if a contact that opens closes again before its gap has grown by much; `acceleration` [m/s^2] is that of
/// its gap, negative if it closes.
pub(crate) fn is_low_hop(assembly: &Assembly, record: &Collision, acceleration: f64) -> bool {
    let rate = record.motion.normal_velocity;
    let accuracy = record.tolerances.accuracy;
    let is_within = |share: f64| rate * rate <= -2.0 * acceleration * share * accuracy;
    let is_short = || {
        let bodies = record.bodies();
        let turn = TINY.max(HALF_ZONE * accuracy / assembly.largest_reach(bodies));
        2.0 * rate * turning(assembly, record) <= -acceleration * turn
    };
    acceleration < 0.0 && (is_within(TINY) || (is_within(HALF_ZONE) && is_short()))
}

/// Sum [1/s] of the rates at which the normal and the bodies of a contact turn, and slide relative to their reach.
pub(crate) fn turning(assembly: &Assembly, record: &Collision) -> f64 {
    let of_body = |body: BodyId| {
        if body.is_world() {
            return 0.0;
        }
        let trajectory = assembly.trajectory(body);
        let sliding = if trajectory.body().is_fixed() {
            0.0
        } else {
            record.motion.lateral_velocity / trajectory.reach()
        };
        sliding.abs() + trajectory.moving_at(assembly.now()).angular_velocity.abs()
    };
    let parties = &record.parties;
    record.geometry.normal_rate.length() + of_body(parties.primary.body) + of_body(parties.normal.body)
}

/// True if a contact opens faster than at rest.
pub(crate) fn opens(assembly: &Assembly, record: &Collision) -> bool {
    record.gap_state().opens(assembly.rest_speed())
}

/// True if any active contact opens.
pub(crate) fn any_active_hops(assembly: &Assembly, region: &Region, settling: &Settling) -> bool {
    let records = region.records();
    settling.active.iter().any(|&(index, _)| opens(assembly, &records[index]))
}

/// Time [s] until all active contacts that hop are at rest; `None` if no contact that opens makes a low hop.
pub(crate) fn time_of_hops(assembly: &Assembly, region: &Region, settling: &Settling) -> Option<f64> {
    let records = region.records();
    let active = settling.active.iter().map(|&(index, _)| &records[index]);
    let times = active.filter(|record| opens(assembly, record)).filter_map(|record| {
        let rate = record.motion.normal_velocity;
        let row = row_of(assembly, record);
        // All forces together hold the gap at no acceleration; without the contact's own force it closes at this
        // one.
        let closing = force_of(record) * row.coupling(&row);
        is_low_hop(assembly, record, -closing).then(|| 2.0 * rate / closing)
    });
    // After so many times the longest hop all have landed: one that comes down may make others hop.
    times.max_by(f64::total_cmp).map(|time| LARGE * time)
}

/// Force [N] at which a contact is active.
pub(crate) fn force_of(record: &Collision) -> f64 {
    record.response.force.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::rigid::active_set::hops::is_low_hop;
    use crate::rigid::event::life::dissolve;
    use crate::rigid::region::collecting::collect_region;
    use crate::rigid::test_scene::resting_discs;
    use halfgap_collision::BodyId;

    #[test]
    fn bodies_may_move_in_a_hop_by_as_much_as_is_asked_of_where_they_are() {
        let gravity: f64 = 9.81;
        let mut rooms = resting_discs(&[0.0]);
        let mut work = rooms.work.take().expect("the start has made it");
        dissolve(&mut rooms, BodyId(1));
        collect_region(&rooms.view(), &mut work.region, &[BodyId(1)], rooms.assembly.now());
        let [record] = work.region.records_mut() else { panic!("one disc, one contact") };
        // The disc lands after 1 ms.
        record.motion.normal_velocity = 5e-4 * gravity;
        for (accuracy, slide, is_low) in
            [(1e-4, 1e-5, true), (1e-4, 1e-4, false), (1e-3, 1e-4, true), (1e-3, 1e-3, false)]
        {
            record.motion.lateral_velocity = slide / 1e-3;
            record.tolerances.accuracy = accuracy;
            assert_eq!(is_low_hop(&rooms.assembly, record, -gravity), is_low, "{slide} m of {accuracy} m");
        }
    }
}
