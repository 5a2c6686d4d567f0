//! Rules of the search for features that touch: which it skips, and how far others may sink before they fire.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::bounces::fires_open;
use crate::rigid::contacts::gaps::gap_at;
use crate::rigid::contacts::pairs::{PairId, Pairs};
use crate::rigid::contacts::touch::{DEEPEST, Touch};
use crate::rigid::event::groups::is_watched;
use crate::rigid::event::work::EventWork;
use crate::rigid::group::groups::Groups;
use crate::rigid::region::touching::Region;
use crate::rigid::remedies::Remedy;
use crate::rigid::search::dead_point::dead_point_gap;
use crate::rigid::search::neighbourhood::Neighbourhood;
use crate::rigid::sinking::depth::sinks_to;
use crate::rigid::zeno::repeats::repeats_beyond_calm;
use halfgap_collision::{FeatureRule, pair_tolerances};

/// Distance by which a body that touches another fires later elsewhere, as a fraction of the accuracy: more than
/// rounding.
const SEAM_SHARE: f64 = 1.0 / 32.0;

/// Depth, as a multiple of that at which a deep contact was to fire, from which it has gone round its body.
const MUCH_DEEPER: f64 = 2.0;

/// Gap [m] at which an opening contact fires: the target of any pair, however low the trigger gaps of its bodies. A
/// contact may have been moved so deep, as others were brought to the gaps at which they are held, that the search
/// would take it for the far side of a body, and it may come back before it is out: it fires where it lies.
fn returns_to(assembly: &Assembly, touch: Touch) -> f64 {
    let [a, b] = [0, 1].map(|side: usize| {
        assembly.trajectory(touch.bodies[side]).body().shape.feature(touch.features[side])
    });
    // In a hollow that is barely larger, a contact never opens as far as others have to.
    let target = pair_tolerances(a, b, &assembly.settings().tolerances).target_gap;
    let (gap, _) = gap_at(assembly, touch, assembly.now());
    if gap < -DEEPEST * target && assembly.remedies().act(Remedy::DeepReturn) { gap } else { target }
}

/// Sets the rules for the touching features of a region: the search skips those that are held or that a group
/// watches, and lets others sink before they fire.
pub(crate) fn set_rules(
    assembly: &Assembly,
    pairs: &mut Pairs,
    search: &mut Neighbourhood,
    groups: &Groups,
    EventWork { region, settling, .. }: &EventWork,
) {
    let rest = assembly.rest_speed();
    take_rules(assembly, pairs, search, region);
    let least = assembly.settings().tolerances.target_gap - assembly.settings().tolerances.accuracy;
    set_trigger_gaps(assembly, search, region);
    for (touch, &(gap, rate)) in region.touches().iter().zip(region.motions()) {
        let Some(pair) = pairs.between(touch.bodies[0], touch.bodies[1]) else { continue };
        let is_held = settling.holds_touch(*touch);
        let rule: FeatureRule = if is_held || is_watched(assembly, groups, *touch) {
            touch.skipped()
        } else if settling.lets_pass(*touch) {
            touch.lowered_to(dead_point_gap(assembly, touch.bodies))
        } else {
            // A contact that fires although it does not close would do so again at once: it may sink, but no
            // farther than its zone.
            let stays = rate <= rest
                || (gap > least
                    && fires_open(pairs, pair, touch.features)
                    && assembly.remedies().act(Remedy::OpenFiring));
            touch.lowered_to(if stays {
                sinks_to(assembly, *touch, gap)
            } else {
                returns_to(assembly, *touch)
            })
        };
        if is_held && assembly.remedies().act(Remedy::EndsLeftAlone) {
            leave_ends_alone(assembly, pairs, pair, touch);
        }
        if !is_idle(assembly, search, touch, &rule) {
            pairs.change_rules(pair, |rules| rules.push(rule));
        }
    }
    give_back_deep(assembly, pairs, search);
}

/// Drops the rules of the bodies of a region, and puts aside those of contacts that lie deep.
fn take_rules(assembly: &Assembly, pairs: &mut Pairs, search: &mut Neighbourhood, region: &Region) {
    let deepest = deepest(assembly);
    search.clear_deep();
    for &body in region.bodies() {
        let near = pairs.of_body(body).iter().map(|link| link.pair);
        for pair in near.filter(|&pair| pairs.get(pair).has_rules()) {
            let targets = pairs.rules(pair).iter().filter_map(|rule| Some((rule.features, rule.target?)));
            let deep = targets.filter(|(_, target)| *target < deepest);
            deep.for_each(|(features, target)| search.put_deep(pair, features, target));
        }
        pairs.clear_rules_of(body);
    }
}

/// Restores the rules of contacts that lie deep: one that fires where it lies is not seen by an event of other
/// bodies, but goes on to do so until it is out.
fn give_back_deep(assembly: &Assembly, pairs: &mut Pairs, search: &Neighbourhood) {
    let deepest = deepest(assembly);
    for index in 0..search.deep().len() {
        let (pair, features, told) = search.deep()[index];
        let touch = Touch { bodies: pairs.bodies(pair), features };
        let (gap, rate) = gap_at(assembly, touch, assembly.now());
        // A contact that lies deeper by far has gone round its body.
        if gap < deepest && gap > MUCH_DEEPER * told && assembly.remedies().act(Remedy::DeepRulesKept) {
            let target = if rate.abs() <= assembly.rest_speed() { assembly.refire_gap(gap) } else { gap };
            // A rule that this event has made for the same features comes first, and counts.
            pairs.change_rules(pair, |rules| rules.push(touch.lowered_to(target)));
        }
    }
}

/// Gap [m] below which the search would take a contact for the far side of a body. Where contacts carry impulses
/// only, it looks as deep as they may sink.
pub(crate) fn deepest(assembly: &Assembly) -> f64 {
    let with_forces = assembly.settings().impulse_step.is_none();
    if with_forces { -DEEPEST * assembly.settings().tolerances.target_gap } else { f64::NEG_INFINITY }
}

/// Makes the search skip the corners at the ends of the edges of a held contact against the other of its features:
/// they are no nearer than the contact, until that has run off its features and they take over. The same holds for
/// the edges on both sides of corners that are held tip on tip.
fn leave_ends_alone(assembly: &Assembly, pairs: &mut Pairs, pair: PairId, touch: &Touch) {
    let [a, b] = touch.features;
    let shapes = touch.bodies.map(|body| &assembly.trajectory(body).body().shape);
    let [next_to_a, next_to_b] = match (shapes[0].sides_of(a), shapes[1].sides_of(b)) {
        (Some(of_a), Some(of_b)) => [of_a.map(Some), of_b.map(Some)],
        _ => [shapes[0].ends_of(a), shapes[1].ends_of(b)],
    };
    let firsts = next_to_a.into_iter().flatten().map(|next| [next, b]);
    let seconds = next_to_b.into_iter().flatten().map(|next| [a, next]);
    pairs.change_rules(pair, |rules| {
        // Of several rules for the same features the first counts.
        rules.extend(firsts.chain(seconds).map(|features| FeatureRule { features, target: None }));
    });
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
        pairs.change_rules(pair, |rules| {
            for rule in rules {
                rule.target = rule.target.map(|target| target - lower);
            }
        });
        // The trigger gap of a body that cannot move would never be raised again: it is in no region.
        for body in pairs.bodies(pair).into_iter().filter(|&body| region.place(body).is_some()) {
            let trigger_gap = search.lanes()[body.index()].trigger_gap();
            search.set_trigger_gap(body, trigger_gap - lower);
        }
    }
    search.put_touched(insistent);
}

/// True if a rule for two discs says only what holds without it.
fn is_idle(assembly: &Assembly, search: &Neighbourhood, touch: &Touch, rule: &FeatureRule) -> bool {
    let target = assembly.settings().tolerances.target_gap;
    let mut lanes = touch.bodies.iter().map(|body| &search.lanes()[body.index()]);
    rule.target == Some(target) && lanes.all(|lane| lane.radius() > 0.0 && lane.trigger_gap() == target)
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
    for (touch, &(gap, rate)) in region.touches().iter().zip(region.motions()) {
        if rate > assembly.rest_speed() {
            continue;
        }
        for body in touch.bodies.into_iter().filter(|&body| region.place(body).is_some()) {
            let trigger_gap = search.lanes()[body.index()].trigger_gap();
            let lower = (gap - seam).max(least);
            if lower < trigger_gap && assembly.remedies().act(Remedy::TriggerGaps) {
                search.set_trigger_gap(body, lower);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::event::life::dissolve;
    use crate::rigid::region::collecting::collect_region;
    use crate::rigid::region::records::remeasure;
    use crate::rigid::region::touching::measure_touches;
    use crate::rigid::test_scene::resting_discs;
    use crate::rigid::zeno::repeats::note_repeat;
    use halfgap_collision::BodyId;

    use crate::rigid::zeno::repeats::CALM_REPEATS;

    #[test]
    fn a_contact_that_opens_from_where_the_search_does_not_look_fires_where_it_lies() {
        let mut rooms = resting_discs(&[0.0]);
        let target = rooms.assembly.settings().tolerances.target_gap;
        let mut work = EventWork::default();
        collect_region(&rooms.view(), &mut work.region, &[BodyId(1)], rooms.assembly.now());
        let [touch] = work.region.touches()[..] else { panic!("one disc, one contact") };
        dissolve(&mut rooms, BodyId(1));
        for (depth, expected) in [(-1.0, target), (0.4, target), (0.9, -0.9 * target)] {
            let mut state = rooms.assembly.trajectory(BodyId(1)).state_at(rooms.assembly.now());
            state.position.y = 0.5 - depth * target;
            let now = rooms.assembly.now();
            rooms.assembly.trajectory_mut(BodyId(1)).fly_from(now, state);
            assert!(
                (returns_to(&rooms.assembly, touch) - expected).abs() < 1e-9 * target,
                "{depth} target gaps"
            );
        }
    }

    #[test]
    fn a_contact_that_fires_where_it_lies_goes_on_to_do_so_when_others_collide() {
        let mut rooms = resting_discs(&[0.0]);
        let target = rooms.assembly.settings().tolerances.target_gap;
        let mut work = EventWork::default();
        collect_region(&rooms.view(), &mut work.region, &[BodyId(1)], rooms.assembly.now());
        let [touch] = work.region.touches()[..] else { panic!("one disc, one contact") };
        let pair = rooms.pairs.between(BodyId(0), BodyId(1)).expect("they touch");
        dissolve(&mut rooms, BodyId(1));
        // An event that does not see the contact.
        work.region.forget_touches();
        let told = [target, -0.9 * target].map(|target| touch.lowered_to(target));
        for (rule, gap, is_kept) in [(0, -0.9, false), (1, -0.8, true), (1, -0.1, false), (1, -2.0, false)] {
            let mut state = rooms.assembly.trajectory(BodyId(1)).state_at(rooms.assembly.now());
            (state.position.y, state.velocity.y) = (0.5 + gap * target, 1e-3);
            let now = rooms.assembly.now();
            rooms.assembly.trajectory_mut(BodyId(1)).fly_from(now, state);
            rooms.pairs.clear_rules_of(BodyId(1));
            rooms.pairs.change_rules(pair, |rules| rules.push(told[rule]));
            set_rules(&rooms.assembly, &mut rooms.pairs, &mut rooms.search, &rooms.groups, &work);
            let rules = rooms.pairs.rules(pair);
            assert_eq!(rules.len(), usize::from(is_kept), "{rules:?}");
            let lies_at =
                |rule: &FeatureRule| rule.target.is_some_and(|at| (at - gap * target).abs() < 1e-9 * target);
            assert!(rules.iter().all(lies_at), "{rules:?}");
        }
    }

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
