//! Rules of the search for features that touch: which it skips, and how far others may sink before they fire.

use crate::rigid::active_set::exclusion::Exclusion;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::bounces::fires_open;
use crate::rigid::contacts::pairs::Pairs;
use crate::rigid::contacts::table::Mode;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::event::groups::is_watched;
use crate::rigid::event::work::EventWork;
use crate::rigid::group::groups::Groups;
use crate::rigid::region::touching::Region;
use crate::rigid::remedies::Remedy;
use crate::rigid::search::dead_point::dead_point_gap;
use crate::rigid::search::neighbourhood::Neighbourhood;
use crate::rigid::sinking::depth::sinks_to;
use crate::rigid::zeno::repeats::repeats_beyond_calm;
use halfgap_collision::{Zone, pair_tolerances};

/// Distance by which a body that touches another fires later elsewhere, as a fraction of the accuracy: more than
/// rounding.
const SEAM_SHARE: f64 = 1.0 / 32.0;

/// Gap [m] at which an opening contact fires: the target of any pair, however low the trigger gaps of its bodies.
fn opens_to(assembly: &Assembly, touch: Touch) -> f64 {
    let [a, b] = [0, 1].map(|side: usize| {
        assembly.trajectory(touch.bodies[side]).body().shape.feature(touch.features[side])
    });
    // In a hollow that is barely larger, a contact never opens as far as others have to.
    pair_tolerances(a, b, &assembly.settings().tolerances).target_gap
}

/// Sets the rules for the touching features of a region: the search skips those that are active or that a group
/// watches, and lets others sink before they fire.
pub(crate) fn set_rules(
    assembly: &Assembly,
    pairs: &mut Pairs,
    search: &mut Neighbourhood,
    groups: &Groups,
    EventWork { region, settling, .. }: &EventWork,
) {
    let rest = assembly.rest_speed();
    region.bodies().iter().for_each(|&body| pairs.forget_modes_of(body));
    set_trigger_gaps(assembly, search, region);
    for (touch, gap) in region.touches().iter().zip(region.motions()) {
        let Some(pair) = pairs.between(touch.bodies[0], touch.bodies[1]) else { continue };
        let mode = if settling.is_active(*touch) {
            Mode::Active
        } else if is_watched(assembly, groups, *touch) {
            Mode::Idle
        } else if settling.is_excluded(*touch, Exclusion::Leverless) {
            Mode::Open(dead_point_gap(assembly, touch.bodies))
        } else {
            // A contact that fires although it does not close would do so again at once: it may sink, but no
            // farther than its zone.
            let stays = !gap.opens(rest)
                || (gap.zone() <= Zone::Target
                    && fires_open(pairs, pair, touch.features)
                    && assembly.remedies().act(Remedy::OpenFiring));
            Mode::Open(if stays {
                sinks_to(assembly, *touch, gap.distance)
            } else {
                opens_to(assembly, *touch)
            })
        };
        if !says_nothing(assembly, search, touch, mode) {
            pairs.set_mode(pair, touch.features, mode);
        }
    }
}

/// Lowers the gaps at which contacts fire that did so again and again without time going by, and their neighbours,
/// by more each time: they lie nearer to these gaps than the search can tell.
pub(crate) fn lower_insistent(
    assembly: &Assembly,
    pairs: &mut Pairs,
    search: &mut Neighbourhood,
    region: &Region,
) {
    let mut insistent = search.take_touched();
    let touching =
        region.touches().iter().filter_map(|touch| pairs.between(touch.bodies[0], touch.bodies[1]));
    insistent.extend(touching);
    insistent.sort_unstable();
    insistent.dedup();
    for &pair in &insistent {
        let lower = f64::from(repeats_beyond_calm(assembly, pairs, pair)) * assembly.sink();
        if lower == 0.0 {
            continue;
        }
        pairs.lower_open(pair, lower);
        // The trigger gap of a body that cannot move would never be raised again: it is in no region.
        for body in pairs.bodies(pair).into_iter().filter(|&body| region.place(body).is_some()) {
            let trigger_gap = search.lanes()[body.index()].trigger_gap();
            search.set_trigger_gap(body, trigger_gap - lower);
        }
    }
    search.put_touched(insistent);
}

/// True if a mode of a contact of two discs says only what holds without it.
fn says_nothing(assembly: &Assembly, search: &Neighbourhood, touch: &Touch, mode: Mode) -> bool {
    let target = assembly.settings().tolerances.target_gap;
    let mut lanes = touch.bodies.iter().map(|body| &search.lanes()[body.index()]);
    mode == Mode::Open(target) && lanes.all(|lane| lane.radius() > 0.0 && lane.trigger_gap() == target)
}

/// Sets the gap at which each body of a region fires: its target, or a little less than the gap of a contact that
/// it has.
///
/// So a body that slides along at less than its target does not run against the seam of the next floor.
fn set_trigger_gaps(assembly: &Assembly, search: &mut Neighbourhood, region: &Region) {
    let target = assembly.settings().tolerances.target_gap;
    for &body in region.bodies() {
        search.set_trigger_gap(body, target);
    }
    let seam = SEAM_SHARE * assembly.settings().tolerances.accuracy;
    let least = target - assembly.settings().tolerances.accuracy;
    for (touch, gap) in region.touches().iter().zip(region.motions()) {
        if gap.opens(assembly.rest_speed()) {
            continue;
        }
        for body in touch.bodies.into_iter().filter(|&body| region.place(body).is_some()) {
            let trigger_gap = search.lanes()[body.index()].trigger_gap();
            let lower = (gap.distance - seam).max(least);
            if lower < trigger_gap && assembly.remedies().act(Remedy::TriggerGaps) {
                search.set_trigger_gap(body, lower);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::rigid::region::collecting::collect_region;
    use crate::rigid::region::records::remeasure;
    use crate::rigid::region::touching::measure_touches;
    use crate::rigid::test_scene::resting_discs;
    use crate::rigid::zeno::repeats::note_repeat;
    use halfgap_collision::BodyId;

    use crate::rigid::zeno::repeats::CALM_REPEATS;

    #[test]
    fn a_floor_on_which_a_contact_insists_fires_elsewhere_as_before() {
        let mut rooms = resting_discs(&[0.0]);
        let [floor, disc] = [BodyId(0), BodyId(1)];
        let before = rooms.search.lanes()[floor.index()].trigger_gap();
        let pair = rooms.pairs.between(floor, disc).expect("they touch");
        for _ in 0..CALM_REPEATS + 5 {
            note_repeat(&rooms.assembly, &mut rooms.pairs, &mut rooms.zeno, pair).expect("not stuck yet");
        }
        let mut work = EventWork::default();
        collect_region(&rooms.view(), &mut work.region, &[disc], rooms.assembly.now());
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now());
        measure_touches(&rooms.assembly, &mut work.region);
        lower_insistent(&rooms.assembly, &mut rooms.pairs, &mut rooms.search, &work.region);
        assert!(rooms.search.lanes()[disc.index()].trigger_gap() < before);
        assert_eq!(rooms.search.lanes()[floor.index()].trigger_gap(), before);
    }
}
