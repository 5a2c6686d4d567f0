//! The life of groups: made after an event from held rows and force laws, extended step by step, cut by the next event.

use super::connectors::is_rope;
use super::members::Members;
use super::region::{Region, Touch};
use crate::rigid::error::AdvanceError;
use crate::rigid::forest::Forest;
use crate::rigid::held::settling::Settling;
use crate::rigid::search::pairs::Prediction;
use crate::rigid::sources::Source;
use crate::rigid::step::attempt::StepFailure;
use crate::rigid::step::brief::Past;
use crate::rigid::step::dynamics::{Dynamics, Physics, body_state, set_body_state};
use crate::rigid::step::extending::Tools;
use crate::rigid::step::group::{Group, Work};
use crate::rigid::step::rows::{HeldRow, RowSource};
use crate::rigid::system::RigidSystem;

use halfgap_collision::{BodyId, BodyState, ConnectorId};
use halfgap_contact::InverseInertia;

/// Depth of other contacts of two bodies as a multiple of that to which one has sunk.
const SUNK_BESIDE: f64 = 2.0;

/// All groups by their leaders, and the buffers of their making.
#[derive(Clone, Debug, Default)]
pub(crate) struct Groups {
    /// Group of each leader.
    pub(crate) by_leader: Vec<Option<Box<Group>>>,
    /// Leader of each body's group.
    pub(crate) leader_of: Vec<Option<BodyId>>,
    /// Cleared groups to be used again.
    #[expect(clippy::vec_box, reason = "groups go from here to `by_leader` without being copied")]
    pool: Vec<Box<Group>>,
    /// Steps and depth of each body's last group.
    pub(crate) past_of: Vec<Past>,
    /// Places of a region, in sets that share their steps.
    coupled: Forest,
    /// True for places of a region that need an integrator.
    integrated: Vec<bool>,
    /// Leader of the group whose dense output is deferred until it is read.
    pub(crate) waiting: Option<BodyId>,
    /// Leaders of the groups that were made last.
    pub(crate) made: Vec<BodyId>,
    /// Members of the groups that are being made.
    members: Members,
    /// Inertias of the bodies of a group that starts.
    inertias: Vec<InverseInertia>,
}

impl Groups {
    pub(crate) fn new(body_count: usize) -> Self {
        Self {
            by_leader: (0..body_count).map(|_| None).collect(),
            leader_of: vec![None; body_count],
            past_of: vec![Past::default(); body_count],
            ..Self::default()
        }
    }

    /// Takes a group out to work on it.
    pub(crate) fn take(&mut self, leader: BodyId) -> Option<Box<Group>> {
        self.by_leader[leader.index()].take()
    }

    pub(crate) fn put(&mut self, group: Box<Group>) {
        let leader = group.leader();
        self.by_leader[leader.index()] = Some(group);
    }
}

impl RigidSystem {
    /// The group of a body, if it is in one.
    pub(crate) fn group_of(&self, body: BodyId) -> Option<&Group> {
        let leader = self.groups.leader_of[body.index()]?;
        self.groups.by_leader[leader.index()].as_deref()
    }

    /// Depth [m] to which two bodies may lie in one another, as the contacts of a group do that one of them is in, or
    /// was in until now. A contact that takes over from a sunk one lies as deep.
    pub(crate) fn held_depth(&self, bodies: [BodyId; 2]) -> f64 {
        let depths = bodies.map(|body| match self.group_of(body) {
            Some(group) => group.depth(),
            None => self.groups.past_of[body.index()].sunk_until(self.now),
        });
        let sunk = depths[0].max(depths[1]);
        if sunk > 0.0 { (SUNK_BESIDE * sunk).min(self.thinness(bodies)) } else { 0.0 }
    }

    /// Runs an action on a group with its dynamics and its stepper.
    pub(crate) fn with_group<T>(
        &mut self,
        group: &mut Group,
        act: impl FnOnce(&mut Dynamics<'_>, &mut Tools<'_>) -> T,
    ) -> T {
        let Self { flyers, connectors, laws, settings, stage, steppers, error_scales: scales, .. } = self;
        let physics = Physics::of(flyers, &connectors.all, &laws.all, settings);
        let (start, stepper) = (group.start, steppers.of(group.stepping()));
        act(&mut Dynamics { physics, group, stage, start }, &mut Tools { stepper, scales, settings })
    }

    /// Ends a group, whose bodies are in flight; its works are booked.
    pub(crate) fn dissolve(&mut self, leader: BodyId) {
        self.note_ways(leader);
        let Some(mut group) = self.groups.take(leader) else { return };
        self.book_works(&group);
        if group.rows.iter().any(|row| !row.bilateral) {
            self.with_group(&mut group, |dynamics, _| dynamics.evaluate_end());
            self.note_ends(&group);
        }
        for &body in &group.bodies {
            self.groups.leader_of[body.index()] = None;
            self.groups.past_of[body.index()] = Past::of(&group, self.now);
            self.counts.backups += 1;
        }
        self.queue.clear(self.source_id(Source::Group(leader)));
        group.clear();
        self.groups.pool.push(group);
    }

    fn book_works(&mut self, group: &Group) {
        if group.rows.iter().any(|row| row.bilateral) {
            self.counts.note_connector_error(group.largest_error);
        }
        if let Some(gap) = group.least_gap {
            self.counts.note_gap(gap);
        }
        self.ledger.projections += group.projected;
        let first = 2 * group.velocities();
        for (&work, &value) in group.works.iter().zip(&group.end_state[first..]) {
            self.ledger.book(work, value);
        }
    }

    /// Makes groups of the bodies of a region that held rows or force laws couple; the others stay in flight.
    pub(crate) fn regroup(&mut self, region: &Region, settling: &Settling) -> Result<(), AdvanceError> {
        self.couple(region, settling);
        self.groups.made.clear();
        let mut members = std::mem::take(&mut self.groups.members);
        members.list(region, settling, |place| self.groups.coupled.root(place));
        for place in 0..region.bodies.len() {
            if self.groups.integrated[place] && self.groups.coupled.root(place) == place {
                let group = self.make_group((region, settling), &members, place);
                let leader = group.leader();
                for &body in &group.bodies {
                    self.groups.leader_of[body.index()] = Some(leader);
                }
                self.groups.made.push(leader);
                self.groups.put(group);
            }
        }
        self.groups.members = members;
        let mut outcome = Ok(());
        for index in 0..self.groups.made.len() {
            let leader = self.groups.made[index];
            if outcome.is_ok() {
                outcome = self.start_group(leader);
            } else {
                self.drop_group(leader);
            }
        }
        outcome
    }

    /// Forgets the groups of a region that have just been made: its bodies are in flight again, in the states before.
    pub(crate) fn undo_groups(&mut self, region: &Region, before: &[BodyState]) {
        self.complete_dense();
        for (&body, &state) in region.bodies.iter().zip(before) {
            if let Some(leader) = self.groups.leader_of[body.index()] {
                self.queue.clear(self.source_id(Source::Group(leader)));
                self.drop_group(leader);
            }
            self.flyers[body.index()].fly_from(self.now, state);
        }
    }

    /// Forgets a group that was never started, or is made anew: its bodies are in flight.
    fn drop_group(&mut self, leader: BodyId) {
        let Some(group) = self.groups.take(leader) else { return };
        for &body in &group.bodies {
            self.groups.leader_of[body.index()] = None;
        }
    }

    /// Joins the places of a region that share their steps.
    fn couple(&mut self, region: &Region, settling: &Settling) {
        let count = region.bodies.len();
        self.groups.coupled.reset(count);
        self.groups.integrated.clear();
        self.groups.integrated.resize(count, false);
        for (_, row) in &settling.held {
            self.couple_bodies(region, row.bodies.iter().copied());
        }
        for place in 0..count {
            for index in 0..self.laws.of(region.bodies[place]).len() {
                let law = self.laws.all[self.laws.of(region.bodies[place])[index]].clone();
                self.couple_bodies(region, law.bodies().iter().copied());
            }
        }
        for place in 0..count {
            let mut connectors = self.connectors.of(region.bodies[place]).iter();
            self.groups.integrated[place] |= connectors.any(|&id| self.connector(id).is_stop());
        }
        self.couple_touching(region, settling);
        // A set is integrated if any of its places is.
        for place in 0..count {
            if self.groups.integrated[place] {
                let root = self.groups.coupled.root(place);
                self.groups.integrated[root] = true;
            }
        }
    }

    /// Joins bodies that touch without force, neither closing nor opening, if they are integrated or one of them turns:
    /// a group watches such a contact from step to step, where the search would go on in steps as short as the contact
    /// takes to sink by next to nothing.
    fn couple_touching(&mut self, region: &Region, settling: &Settling) {
        if self.settings.impulse_step.is_some() {
            return;
        }
        let rest = self.rest_speed();
        for (&touch, &(_, rate)) in region.touches.iter().zip(&region.motions) {
            if rate.abs() > rest || settling.holds_touch(touch) {
                continue;
            }
            let mut places = touch.bodies.into_iter().filter_map(|body| region.place(body));
            let are_integrated = places.all(|place| self.groups.integrated[place]);
            if are_integrated || touch.bodies.iter().any(|&body| self.turns_about(body)) {
                self.couple_bodies(region, touch.bodies.into_iter());
            }
        }
    }

    /// True for a body other than a disc that turns.
    fn turns_about(&self, body: BodyId) -> bool {
        let flyer = self.flyer(body);
        !flyer.body().is_fixed()
            && flyer.disc().is_none()
            && flyer.moving_at(self.now).angular_velocity != 0.0
    }

    fn couple_bodies(&mut self, region: &Region, bodies: impl Iterator<Item = BodyId>) {
        let mut first = None;
        for place in bodies.filter_map(|body| region.place(body)) {
            self.groups.integrated[place] = true;
            let first = *first.get_or_insert(place);
            self.groups.coupled.join(first, place);
        }
    }

    fn make_group(&mut self, of: (&Region, &Settling), members: &Members, root: usize) -> Box<Group> {
        let (region, settling) = of;
        let mut group = self.groups.pool.pop().unwrap_or_default();
        group.clear();
        group.bodies.extend(members.places(root).map(|place| region.bodies[place]));
        group.bodies.sort_unstable();
        // Bilateral rows first: a contact that depends on them gives way.
        let rows = members.held(settling, root);
        group.rows.extend(rows.clone().filter(|row| row.bilateral));
        group.rows.extend(rows.filter(|row| !row.bilateral));
        self.list_idle(&mut group, of, members.touches(root));
        self.list_stops(&mut group);
        self.laws.list(&group.bodies, &mut group.laws);
        self.list_works(&mut group);
        self.foresee(&mut group);
        group.is_unwatched = self.is_unwatched(&group);
        group
    }

    /// Lists the idle contacts of a group: touched without force, neither closing nor opening.
    fn list_idle(
        &self,
        group: &mut Group,
        (region, settling): (&Region, &Settling),
        touches: impl Iterator<Item = usize>,
    ) {
        if self.settings.impulse_step.is_some() {
            // Without contact forces the rules of the search tell of contacts that sink, once a step.
            return;
        }
        for index in touches {
            let (touch, (gap, rate)) = (region.touches[index], region.motions[index]);
            let is_inside = |body: BodyId| group.bodies.binary_search(&body).is_ok();
            let belongs = |body: BodyId| is_inside(body) || !self.is_movable(body);
            if !touch.bodies.iter().all(|&body| belongs(body)) || settling.holds_touch(touch) {
                continue;
            }
            if rate.abs() <= self.rest_speed() {
                let gap = self.refire_gap(gap);
                let source = RowSource::Contact(touch.features);
                let bodies = touch.bodies;
                let (hint, leans, is_lifted) = (None, false, false);
                let row = HeldRow { source, bodies, bilateral: false, gap, hint, leans, is_lifted };
                group.idle.push(self.with_lean(row, self.now));
            }
        }
    }

    /// True if a contact that is touched without force is watched by the group of one of its bodies.
    pub(crate) fn is_watched(&self, touch: Touch) -> bool {
        let source = RowSource::Contact(touch.features);
        let groups = touch.bodies.into_iter().filter_map(|body| self.group_of(body));
        let mut idle = groups.flat_map(|group| &group.idle);
        idle.any(|row| row.bodies == touch.bodies && row.source == source)
    }

    /// Hands back to the search the idle contacts of a group that have opened beyond the target zone, have run as far
    /// off their features, or have gone round their bodies and lie behind them, and the ropes that have slackened as
    /// much.
    pub(crate) fn let_go(&mut self, leader: BodyId) {
        let Some(mut group) = self.groups.take(leader) else { return };
        let opened = self.settings.tolerances.target_gap + self.settings.tolerances.accuracy;
        let mut touched = std::mem::take(&mut self.touched);
        touched.clear();
        group.idle.retain(|row| {
            let RowSource::Contact(features) = row.source else { return true };
            let touch = Touch { bodies: row.bodies, features };
            let [a, b] = row.bodies.map(|body| self.moving_at(body, self.now));
            let has_run_off = self.mechanism().overrun(row.bodies, features, [&a, &b]) > opened;
            let gap = self.gap_at(touch, self.now).0;
            let stays = gap < opened && gap > -self.settings.tolerances.distance_tol() && !has_run_off;
            if !stays && let Some(pair) = self.pairs.between(touch.bodies[0], touch.bodies[1]) {
                self.pairs.change_rules(pair, |rules| rules.retain(|rule| rule.features != features));
                // The contact has left the target zone: its return is no low bounce.
                self.pairs.seen_mut(pair).retain(|seen| seen.features != features);
                touched.push(pair);
            }
            stays
        });
        let slack = self.settings.tolerances.accuracy;
        group.stops.retain(|stop| {
            let connector = self.connector(stop.id);
            let [a, b] = connector.bodies().map(|body| self.moving_at(body, self.now));
            !is_rope(connector) || connector.measure(0, &a, &b).gap <= slack
        });
        self.groups.put(group);
        for &pair in &touched {
            self.note_prediction(pair, (Prediction::Quiet, self.now));
        }
        self.touched = touched;
    }

    fn list_stops(&self, group: &mut Group) {
        for index in 0..group.bodies.len() {
            for &id in self.connectors.of(group.bodies[index]) {
                let source = RowSource::Connector(id, 0);
                let is_held = group.rows.iter().any(|row| row.source == source);
                let is_known = || group.stops.iter().any(|stop| stop.id == id);
                if (self.connector(id).is_stop() || self.is_idly_taut(group, id)) && !is_held && !is_known() {
                    group.stops.push(self.stop(id));
                }
            }
        }
    }

    /// True for a rope within a group that is taut and neither slackens nor tightens. Without a force it is watched
    /// like a stop, where the search would go on in steps as short as it takes to lengthen by next to nothing.
    fn is_idly_taut(&self, group: &Group, id: ConnectorId) -> bool {
        let connector = self.connector(id);
        let bodies = connector.bodies();
        let belongs = |body: BodyId| !self.is_movable(body) || group.bodies.binary_search(&body).is_ok();
        if !is_rope(connector) || !bodies.iter().all(|&body| belongs(body)) {
            return false;
        }
        let [a, b] = bodies.map(|body| self.moving_at(body, self.now));
        let sample = connector.measure(0, &a, &b);
        sample.gap <= self.settings.tolerances.accuracy && sample.kinematics.rate.abs() <= self.rest_speed()
    }

    /// True if a group watches a rope.
    pub(crate) fn is_rope_watched(&self, id: ConnectorId) -> bool {
        let groups = self.connector(id).bodies().into_iter().filter(|body| !body.is_world());
        groups
            .filter_map(|body| self.group_of(body))
            .any(|group| group.stops.iter().any(|stop| stop.id == id))
    }

    /// Lists the works that are integrated with a group: those of laws without potential in their order, then that of
    /// damping.
    fn list_works(&self, group: &mut Group) {
        group.works.clear();
        let works = group.laws.iter().copied().filter(|&law| !self.laws.has_potential[law]).map(Work::Law);
        group.works.extend(works);
        if group.bodies.iter().any(|&body| self.flyer(body).law().is_damped()) {
            group.works.push(Work::Damping);
        }
    }

    /// Starts a group's first segment from the states of its bodies.
    fn start_group(&mut self, leader: BodyId) -> Result<(), AdvanceError> {
        let Some(mut group) = self.groups.take(leader) else { return Ok(()) };
        (group.start, group.made) = (self.now, self.now);
        group.is_patient = self.has_pulled(self.now);
        let count = group.bodies.len();
        let dimension = group.dimension();
        let mut inertias = std::mem::take(&mut self.groups.inertias);
        inertias.clear();
        inertias.extend(group.bodies.iter().map(|&body| self.inertia(body)));
        group.find_sides();
        group.held.set_structure(&inertias, &group.sides);
        self.groups.inertias = inertias;
        // The projection acts on the end of a segment: a segment of no length ends here.
        group.end_state.clear();
        group.end_state.resize(dimension, 0.0);
        for place in 0..count {
            self.book_damping(group.bodies[place], self.now);
            let state = self.flyer(group.bodies[place]).unwound_at(self.now);
            set_body_state(&mut group.end_state, count, place, &state);
        }
        group.span = 0.0;
        group.projected = 0.0;
        self.with_group(&mut group, |dynamics, tools| {
            dynamics.soften_dependent();
            dynamics.end_on_rows(tools);
            dynamics.leave_lifted();
            dynamics.lower_idle();
        });
        self.ledger.projections += std::mem::take(&mut group.projected);
        std::mem::swap(&mut group.state, &mut group.end_state);
        self.with_group(&mut group, |dynamics, tools| {
            dynamics.find_tree_and_loops(tools.settings);
            dynamics.set_out();
            if dynamics.leave_singular_tree() {
                dynamics.set_out();
            }
        });
        self.extend_group(group)
    }

    /// Extends a group whose segment has come to its natural end by another segment.
    pub(crate) fn continue_group(&mut self, leader: BodyId) -> Result<(), AdvanceError> {
        self.note_ways(leader);
        let Some(mut group) = self.groups.take(leader) else { return Ok(()) };
        self.book_works(&group);
        group.start = group.end();
        group.end_brief();
        group.choose_stiffness(self.settings.method);
        let first_work = 2 * group.velocities();
        let group_mut = &mut *group;
        std::mem::swap(&mut group_mut.state, &mut group_mut.end_state);
        std::mem::swap(&mut group_mut.rates, &mut group_mut.end_rates);
        std::mem::swap(&mut group_mut.forces, &mut group_mut.end_forces);
        group_mut.state[first_work..].fill(0.0);
        self.renew_hints(&mut group);
        self.extend_group(group)
    }

    /// Extends a group by a segment and puts it back.
    fn extend_group(&mut self, mut group: Box<Group>) -> Result<(), AdvanceError> {
        self.note_hints(&group.rows);
        let leader = group.leader();
        self.skip_dense(leader);
        let next_step = group.next_step;
        let mut outcome = self.with_group(&mut group, |dynamics, tools| dynamics.extend_watched(tools));
        if outcome.is_err() && group.stiffness.is_stiff {
            group.next_step = next_step;
            group.leave_stiffness(self.settings.method);
            outcome = self.with_group(&mut group, |dynamics, tools| dynamics.extend_watched(tools));
        }
        self.counts.segments += 1;
        if let Err(failure) = outcome {
            let error = self.step_error(&group, failure);
            self.give_up(&group);
            return Err(error);
        }
        self.note_pace(&group);
        self.note_kinetic_energy(&group);
        self.queue.set(self.source_id(Source::Group(leader)), group.due());
        if group.is_unwatched {
            self.defer_dense(leader);
        } else {
            self.fly_along(&group);
        }
        self.groups.put(group);
        Ok(())
    }

    /// Searches the rest of a group's segment for a contact that loses its force.
    pub(crate) fn look_further(&mut self, leader: BodyId) {
        let Some(mut group) = self.groups.take(leader) else { return };
        self.with_group(&mut group, |dynamics, _| dynamics.look_for_release());
        self.queue.set(self.source_id(Source::Group(leader)), group.due());
        self.groups.put(group);
    }

    /// Forgets a group that cannot be stepped: its bodies are where its last segment ended.
    fn give_up(&mut self, group: &Group) {
        for (place, &body) in group.bodies.iter().enumerate() {
            let state = body_state(&group.state, group.bodies.len(), place);
            self.flyers[body.index()].fly_from(group.start, state);
            self.groups.leader_of[body.index()] = None;
        }
    }

    /// Sets the bodies of a group on its dense output.
    pub(crate) fn fly_along(&mut self, group: &Group) {
        let span = group.end().since(group.start);
        for (&body, paths) in group.bodies.iter().zip(&group.paths) {
            self.flyers[body.index()].follow(group.start, paths, span);
        }
    }

    fn step_error(&self, group: &Group, failure: StepFailure) -> AdvanceError {
        let (time, bodies) = (group.start.seconds(), group.bodies.clone());
        let laws = self.names_of_laws(group);
        match failure {
            StepFailure::Collapsed(step) => AdvanceError::StepCollapsed { time, step, bodies, laws },
            StepFailure::RanAway(speed) => AdvanceError::RanAway { time, speed, bodies },
            StepFailure::Unresolved(length) => {
                let bodies = self.so_far_apart(group, length).map_or(bodies, Vec::from);
                AdvanceError::Unresolved { time, length, bodies, laws }
            }
        }
    }

    /// Two bodies whose centres are at a given distance [m], among those that a law of a group names together; `None`
    /// if there are none. Where forces vary over that length, these are to blame.
    fn so_far_apart(&self, group: &Group, length: f64) -> Option<[BodyId; 2]> {
        let center = |body: BodyId| match group.bodies.binary_search(&body) {
            Ok(place) => body_state(&group.state, group.bodies.len(), place).position,
            Err(_) => self.moving_at(body, group.start).pose.position,
        };
        let bodies = group.laws.iter().map(|&law| self.laws.all[law].bodies());
        let mut pairs = bodies
            .flat_map(|bodies| bodies.iter().enumerate().map(move |(at, &body)| (body, &bodies[at + 1..])))
            .flat_map(|(body, others)| others.iter().map(move |&other| [body, other]));
        pairs.find(|&[a, b]| (center(a) - center(b)).length() == length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::test_scene::resting_discs;

    #[test]
    fn how_deep_a_contact_has_sunk_holds_of_its_bodies_until_something_else_happens() {
        let mut system = resting_discs(&[0.0, 1.5]);
        let gap = system.settings.tolerances.target_gap;
        let mut group = system.groups.take(BodyId(1)).expect("it is held");
        system.with_group(&mut group, |dynamics, tools| {
            dynamics.extend(tools).expect("it rests");
            dynamics.group.state[1] -= 4.0 * gap;
            dynamics.group.end_state[1] -= 4.0 * gap;
            dynamics.make_dense(tools.stepper);
            dynamics.inner_excess(tools.settings.tolerances.accuracy, &tools.settings.steps);
        });
        system.groups.put(group);
        let [floor, sunk, other] = [0, 1, 2].map(BodyId);
        assert!((system.held_depth([floor, sunk]) / gap - 6.0).abs() < 1e-6);
        assert_eq!(system.held_depth([floor, other]), 0.0);
        system.dissolve(sunk);
        assert!((system.held_depth([floor, sunk]) / gap - 6.0).abs() < 1e-6);
        system.now = system.now.plus(1e-3);
        assert_eq!(system.held_depth([floor, sunk]), 0.0);
    }
}
