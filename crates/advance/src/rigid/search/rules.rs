//! Rules of the search for features that touch: which it skips, and how far others may sink before they fire.

use super::pairs::PairId;
use crate::rigid::event::cause::EventWork;
use crate::rigid::event::region::{Region, Touch};
use crate::rigid::held::settle::DEEPEST;
use crate::rigid::system::RigidSystem;
use halfgap_collision::{FeatureRule, pair_tolerances};

/// Distance by which a body that touches another fires later elsewhere, as a fraction of the accuracy: more than
/// rounding.
const SEAM_SHARE: f64 = 1.0 / 32.0;

/// Depth, as a multiple of that at which a deep contact was to fire, from which it has gone round its body.
const MUCH_DEEPER: f64 = 2.0;

impl RigidSystem {
    /// Distance [m] by which a contact without force may sink before it fires again.
    pub(crate) fn sink(&self) -> f64 {
        self.settings.tolerances.sink()
    }

    /// Gap [m] at which a contact without force fires again, by its present gap [m].
    pub(crate) fn refire_gap(&self, gap: f64) -> f64 {
        (gap - self.sink()).min(self.settings.tolerances.target_gap)
    }

    /// Gap [m] at which an opening contact fires: the target of any pair, however low the halos of its bodies. A
    /// contact may have been moved so deep, as others were brought to the gaps at which they are held, that the search
    /// would take it for the far side of a body, and it may come back before it is out: it fires where it lies.
    fn returns_to(&self, touch: Touch) -> f64 {
        let [a, b] = [0, 1]
            .map(|side: usize| self.flyer(touch.bodies[side]).body().shape.feature(touch.features[side]));
        // In a hollow that is barely larger, a contact never opens as far as others have to.
        let target = pair_tolerances(a, b, &self.settings.tolerances).target_gap;
        let (gap, _) = self.gap_at(touch, self.now);
        if gap < -DEEPEST * target { gap } else { target }
    }

    /// Sets the rules for the touching features of a region: the search skips those that are held or that a group
    /// watches, and lets others sink before they fire.
    pub(crate) fn set_rules(&mut self, EventWork { region, settling, .. }: &EventWork) {
        let rest = self.rest_speed();
        self.take_rules(region);
        let least = self.settings.tolerances.target_gap - self.settings.tolerances.accuracy;
        self.set_halos(region);
        for (touch, &(gap, rate)) in region.touches.iter().zip(&region.motions) {
            let Some(pair) = self.pairs.between(touch.bodies[0], touch.bodies[1]) else { continue };
            let is_held = settling.holds_touch(*touch);
            let rule: FeatureRule = if is_held || self.is_watched(*touch) {
                touch.skipped()
            } else if settling.lets_pass(*touch) {
                touch.lowered_to(self.grazing_gap(touch.bodies))
            } else {
                // A contact that fires although it does not close would do so again at once: it may sink, but no
                // farther than its zone.
                let stays = rate <= rest || (gap > least && self.fires_open(pair, touch.features));
                touch.lowered_to(if stays { self.sinks_to(*touch, gap) } else { self.returns_to(*touch) })
            };
            if is_held {
                self.leave_ends_alone(pair, touch);
            }
            if !self.is_idle(touch, &rule) {
                self.pairs.change_rules(pair, |rules| rules.push(rule));
            }
        }
        self.give_back_deep();
    }

    /// Drops the rules of the bodies of a region, and puts aside those of contacts that lie deep.
    fn take_rules(&mut self, region: &Region) {
        let deepest = self.deepest();
        self.search.deep.clear();
        for &body in &region.bodies {
            let pairs = self.pairs.of_body(body).iter().map(|link| link.pair);
            for pair in pairs.filter(|&pair| self.pairs.get(pair).has_rules) {
                let targets =
                    self.pairs.rules(pair).iter().filter_map(|rule| Some((rule.features, rule.target?)));
                let deep = targets.filter(|(_, target)| *target < deepest);
                self.search.deep.extend(deep.map(|(features, target)| (pair, features, target)));
            }
            self.pairs.clear_rules_of(body);
        }
    }

    /// Restores the rules of contacts that lie deep: one that fires where it lies is not seen by an event of other
    /// bodies, but goes on to do so until it is out.
    fn give_back_deep(&mut self) {
        let deepest = self.deepest();
        for index in 0..self.search.deep.len() {
            let (pair, features, told) = self.search.deep[index];
            let touch = Touch { bodies: self.pairs.bodies(pair), features };
            let (gap, rate) = self.gap_at(touch, self.now);
            // A contact that lies deeper by far has gone round its body.
            if gap < deepest && gap > MUCH_DEEPER * told {
                let target = if rate.abs() <= self.rest_speed() { self.refire_gap(gap) } else { gap };
                // A rule that this event has made for the same features comes first, and counts.
                self.pairs.change_rules(pair, |rules| rules.push(touch.lowered_to(target)));
            }
        }
    }

    /// Gap [m] below which the search would take a contact for the far side of a body. Where contacts carry impulses
    /// only, it looks as deep as they may sink.
    fn deepest(&self) -> f64 {
        let with_forces = self.settings.impulse_step.is_none();
        if with_forces { -DEEPEST * self.settings.tolerances.target_gap } else { f64::NEG_INFINITY }
    }

    /// Makes the search skip the corners at the ends of the edges of a held contact against the other of its features:
    /// they are no nearer than the contact, until that has run off its features and they take over. The same holds for
    /// the edges on both sides of corners that are held tip on tip.
    fn leave_ends_alone(&mut self, pair: PairId, touch: &Touch) {
        let [a, b] = touch.features;
        let shapes = touch.bodies.map(|body| &self.flyers[body.index()].body().shape);
        let [next_to_a, next_to_b] = match (shapes[0].sides_of(a), shapes[1].sides_of(b)) {
            (Some(of_a), Some(of_b)) => [of_a.map(Some), of_b.map(Some)],
            _ => [shapes[0].ends_of(a), shapes[1].ends_of(b)],
        };
        let firsts = next_to_a.into_iter().flatten().map(|next| [next, b]);
        let seconds = next_to_b.into_iter().flatten().map(|next| [a, next]);
        self.pairs.change_rules(pair, |rules| {
            // Of several rules for the same features the first counts.
            rules.extend(firsts.chain(seconds).map(|features| FeatureRule { features, target: None }));
        });
    }

    /// Lowers the gaps at which contacts fire that did so again and again without time going by, and their neighbours,
    /// by more each time: they lie nearer to these gaps than the search can tell.
    pub(crate) fn lower_insistent(&mut self, region: &Region) {
        let mut insistent = std::mem::take(&mut self.touched);
        insistent.clear();
        let pairs =
            region.touches.iter().filter_map(|touch| self.pairs.between(touch.bodies[0], touch.bodies[1]));
        insistent.extend(pairs);
        insistent.sort_unstable();
        insistent.dedup();
        for &pair in &insistent {
            let lower = f64::from(self.repeats_beyond_calm(pair)) * self.sink();
            if lower == 0.0 {
                continue;
            }
            self.pairs.change_rules(pair, |rules| {
                for rule in rules {
                    rule.target = rule.target.map(|target| target - lower);
                }
            });
            // The halo of a body that cannot move would never be raised again: it is in no region.
            for body in self.pairs.bodies(pair).into_iter().filter(|&body| region.place(body).is_some()) {
                self.search.lanes[body.index()].halo -= lower;
            }
        }
        self.touched = insistent;
    }

    /// True if a rule for two discs says only what holds without it.
    fn is_idle(&self, touch: &Touch, rule: &FeatureRule) -> bool {
        let target = self.settings.tolerances.target_gap;
        let mut lanes = touch.bodies.iter().map(|body| &self.search.lanes[body.index()]);
        rule.target == Some(target) && lanes.all(|lane| lane.radius > 0.0 && lane.halo == target)
    }

    /// Sets the gap at which each body of a region fires: its target, or a little less than the gap of a contact that
    /// it has.
    ///
    /// So a body that slides along at less than its target does not run against the seam of the next floor.
    fn set_halos(&mut self, region: &Region) {
        let target = self.settings.tolerances.target_gap;
        for &body in &region.bodies {
            self.search.lanes[body.index()].halo = target;
        }
        let seam = SEAM_SHARE * self.settings.tolerances.accuracy;
        let least = target - self.settings.tolerances.accuracy;
        for (touch, &(gap, rate)) in region.touches.iter().zip(&region.motions) {
            if rate > self.rest_speed() {
                continue;
            }
            for body in touch.bodies.into_iter().filter(|&body| region.place(body).is_some()) {
                let halo = &mut self.search.lanes[body.index()].halo;
                *halo = halo.min((gap - seam).max(least));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::limits::repeats::CALM_REPEATS;
    use crate::rigid::test_scene::resting_discs;
    use halfgap_collision::BodyId;

    #[test]
    fn a_contact_that_opens_from_where_the_search_does_not_look_fires_where_it_lies() {
        let mut system = resting_discs(&[0.0]);
        let target = system.settings.tolerances.target_gap;
        let mut work = EventWork::default();
        system.collect_region(&mut work.region, &[BodyId(1)], system.now);
        let [touch] = work.region.touches[..] else { panic!("one disc, one contact") };
        system.dissolve(BodyId(1));
        for (depth, returns_to) in [(-1.0, target), (0.4, target), (0.9, -0.9 * target)] {
            let mut state = system.flyer(BodyId(1)).state_at(system.now);
            state.position.y = 0.5 - depth * target;
            system.flyers[1].fly_from(system.now, state);
            assert!((system.returns_to(touch) - returns_to).abs() < 1e-9 * target, "{depth} target gaps");
        }
    }

    #[test]
    fn a_contact_that_fires_where_it_lies_goes_on_to_do_so_when_others_collide() {
        let mut system = resting_discs(&[0.0]);
        let target = system.settings.tolerances.target_gap;
        let mut work = EventWork::default();
        system.collect_region(&mut work.region, &[BodyId(1)], system.now);
        let [touch] = work.region.touches[..] else { panic!("one disc, one contact") };
        let pair = system.pairs.between(BodyId(0), BodyId(1)).expect("they touch");
        system.dissolve(BodyId(1));
        // An event that does not see the contact.
        work.region.touches.clear();
        let told = [target, -0.9 * target].map(|target| touch.lowered_to(target));
        for (rule, gap, is_kept) in [(0, -0.9, false), (1, -0.8, true), (1, -0.1, false), (1, -2.0, false)] {
            let mut state = system.flyer(BodyId(1)).state_at(system.now);
            (state.position.y, state.velocity.y) = (0.5 + gap * target, 1e-3);
            system.flyers[1].fly_from(system.now, state);
            system.pairs.clear_rules_of(BodyId(1));
            system.pairs.change_rules(pair, |rules| rules.push(told[rule]));
            system.set_rules(&work);
            let rules = system.pairs.rules(pair);
            assert_eq!(rules.len(), usize::from(is_kept), "{rules:?}");
            let lies_at =
                |rule: &FeatureRule| rule.target.is_some_and(|at| (at - gap * target).abs() < 1e-9 * target);
            assert!(rules.iter().all(lies_at), "{rules:?}");
        }
    }

    #[test]
    fn a_floor_on_which_a_contact_insists_fires_elsewhere_as_before() {
        let mut system = resting_discs(&[0.0]);
        let [floor, disc] = [BodyId(0), BodyId(1)];
        let before = system.search.lanes[floor.index()].halo;
        let pair = system.pairs.between(floor, disc).expect("they touch");
        for _ in 0..CALM_REPEATS + 5 {
            system.note_repeat(pair).expect("not stuck yet");
        }
        let mut work = EventWork::default();
        system.collect_region(&mut work.region, &[disc], system.now);
        system.remeasure(&mut work.region, system.now);
        system.measure_touches(&mut work.region);
        system.lower_insistent(&work.region);
        assert!(system.search.lanes[disc.index()].halo < before);
        assert_eq!(system.search.lanes[floor.index()].halo, before);
    }
}
