//! What a group is made of: its members, the stops that it watches, the laws and works that go with it.

use crate::ode::Method;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::{Connectors, Stop, is_rope};
use crate::rigid::contacts::pulls::Pull;
use crate::rigid::contacts::rows::{ActiveRow, RowSource};
use crate::rigid::group::brief::{BRIEFEST, CUT_SHARE};
use crate::rigid::group::groups::Groups;
use crate::rigid::group::state::{Group, Work};
use crate::rigid::group::stiffness::Stiffness;
use crate::rigid::shares::SEVERAL;
use halfgap_collision::{BodyId, ConnectorId, GapState};

impl Group {
    /// Sets the bodies and the active rows of a new group. Bilateral rows come first: a contact that depends on them gives
    /// way.
    pub(crate) fn set_members(
        &mut self,
        bodies: impl Iterator<Item = BodyId>,
        rows: impl Iterator<Item = ActiveRow> + Clone,
    ) {
        self.bodies.extend(bodies);
        self.bodies.sort_unstable();
        self.rows.extend(rows.clone().filter(|row| row.bilateral));
        self.rows.extend(rows.filter(|row| !row.bilateral));
    }

    /// Adds motors and dry friction in joints that act with all their force.
    pub(crate) fn add_pulls(&mut self, pulls: impl Iterator<Item = Pull>) {
        self.pulls.extend(pulls);
    }

    /// Adds a contact that touches without force, with the gap below which it fires.
    pub(crate) fn add_idle(&mut self, row: ActiveRow) {
        self.idle.push(row);
    }

    /// Keeps the contacts without force of which a test is true.
    pub(crate) fn retain_idle(&mut self, stays: impl FnMut(&ActiveRow) -> bool) {
        self.idle.retain(stays);
    }

    /// Keeps the stops of which a test is true.
    pub(crate) fn retain_stops(&mut self, stays: impl FnMut(&Stop) -> bool) {
        self.stops.retain(stays);
    }

    /// Notes whether no event can end its segments early.
    pub(crate) fn set_unwatched(&mut self, is_unwatched: bool) {
        self.is_unwatched = is_unwatched;
    }

    /// Lists the stops, and the ropes that are watched like these, that are not active.
    pub(crate) fn list_stops(&mut self, assembly: &Assembly, connectors: &Connectors) {
        for index in 0..self.bodies.len() {
            for &id in connectors.of(self.bodies[index]) {
                let source = RowSource::Connector(id, 0);
                let is_active = self.rows.iter().any(|row| row.source == source);
                let is_known = || self.stops.iter().any(|stop| stop.id == id);
                if (connectors.connector(id).is_stop() || self.is_idly_taut(assembly, connectors, id))
                    && !is_active
                    && !is_known()
                {
                    self.stops.push(connectors.stop(assembly, id));
                }
            }
        }
    }

    /// True for a rope within the group that is taut and neither slackens nor tightens. Without a force it is watched
    /// like a stop, where the search would go on in steps as short as it takes to lengthen by next to nothing.
    fn is_idly_taut(&self, assembly: &Assembly, connectors: &Connectors, id: ConnectorId) -> bool {
        let connector = connectors.connector(id);
        let bodies = connector.bodies();
        let belongs = |body: BodyId| !assembly.is_movable(body) || self.bodies.binary_search(&body).is_ok();
        if !is_rope(connector) || !bodies.iter().all(|&body| belongs(body)) {
            return false;
        }
        let [a, b] = bodies.map(|body| assembly.moving_at(body, assembly.now()));
        let sample = connector.measure(0, &a, &b);
        let rest = assembly.rest_speed();
        GapState::of_rope(&sample, &assembly.settings().tolerances).is_contact(-rest..=rest)
    }

    /// Lists the laws that act on its bodies, and the works that are integrated with it: those of laws without potential
    /// in their order, then that of damping, then that of drives.
    pub(crate) fn list_laws(&mut self, assembly: &Assembly, connectors: &Connectors) {
        assembly.force_laws().list(&self.bodies, &mut self.force_laws);
        self.works.clear();
        let works = self
            .force_laws
            .iter()
            .copied()
            .filter(|&law| !assembly.force_laws().has_potential[law])
            .map(Work::Law);
        self.works.extend(works);
        if self.bodies.iter().any(|&body| assembly.trajectory(body).free_motion().is_damped()) {
            self.works.push(Work::Damping);
        }
        self.list_moved(assembly, connectors);
        let pulls_on = |pull: &Pull| connectors.connector(pull.id).prescribed_rate(0.0) != 0.0;
        let Self { rows, driven, .. } = &mut *self;
        driven.extend((0..rows.len()).filter(|&row| rows[row].is_driven(connectors.all())));
        if !self.moved.is_empty() || !self.driven.is_empty() || self.pulls.iter().any(pulls_on) {
            self.works.push(Work::Drives);
        }
        if self.pulls.iter().any(|pull| !pulls_on(pull)) {
            self.works.push(Work::Rubbing);
        }
    }

    /// Lists the moved bodies on which its motion depends.
    fn list_moved(&mut self, assembly: &Assembly, connectors: &Connectors) {
        if !assembly.any_moved() {
            return;
        }
        let of_rows = self.rows.iter().chain(&self.idle).flat_map(|row| row.bodies);
        let tied = self.bodies.iter().flat_map(|&body| connectors.of(body));
        let of_connectors = tied.flat_map(|&id| {
            let connector = connectors.connector(id);
            connector.bodies().into_iter().chain(connector.third().map(|(body, _)| body))
        });
        let of_laws =
            self.force_laws.iter().flat_map(|&law| assembly.force_laws().all[law].bodies()).copied();
        let all = of_rows.chain(of_connectors).chain(of_laws);
        self.moved.extend(all.filter(|&body| assembly.is_moved(body)));
        self.moved.sort_unstable();
        self.moved.dedup();
    }

    /// Chooses its first step, and whether its steps are brief, by the last groups of its bodies.
    pub(crate) fn foresee(&mut self, assembly: &Assembly, connectors: &Connectors, groups: &Groups) {
        let pasts = self.bodies.iter().map(|body| groups.past_of[body.index()]);
        self.next_step = pasts.clone().filter_map(|past| past.step).min_by(f64::total_cmp);
        self.stiffness = pasts.clone().map(|past| past.stiffness).fold(Stiffness::default(), Stiffness::or);
        if assembly.settings().method != Method::default() {
            return;
        }
        self.has_kinks = self.rows.iter().any(|row| match row.source {
            RowSource::Connector(id, _) => {
                connectors.connector(id).path().is_some_and(|path| path.is_spline())
            }
            RowSource::Contact(_) | RowSource::Anchor(_) | RowSource::Pull(_) => false,
        });
        let lasted = pasts.map(|past| past.lasted).fold(0.0, f64::max);
        let soon = SEVERAL * lasted;
        let is_brief = |step: f64| !self.has_kinks && SEVERAL * soon < step && self.stiffness.allows(soon);
        if let Some(step) = self.next_step.filter(|&step| is_brief(step)) {
            self.is_brief = true;
            (self.next_step, self.full_step) = (Some(soon.max(BRIEFEST * step)), Some(step));
        } else if let Some(step) = self.next_step.filter(|&step| lasted < step) {
            self.next_step = Some(CUT_SHARE * step);
        }
    }
}
