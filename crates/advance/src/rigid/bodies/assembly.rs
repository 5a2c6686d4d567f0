//! All bodies at the present time: their trajectories, the laws that act on them, the thresholds by which they are
//! judged, and every elementary query about one or two of them. It knows no contact.

use crate::rigid::bodies::force_laws::ForceLaws;
use crate::rigid::bodies::trajectory::Trajectory;
use crate::rigid::remedies::Remedies;
use crate::rigid::settings::RigidSettings;
use crate::rigid::shares::SMALL;
use crate::rigid::surfaces::Surfaces;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, Moving};
use halfgap_contact::InverseInertia;

/// Facts about the segment that bodies of a group share, as the rest of the system needs them.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Shared {
    /// Time at which the segment ends.
    pub(crate) end: Time,
    /// Penetration [m] of the deepest active contact; 0 if there is none.
    pub(crate) depth: f64,
    /// Largest error [m] of a connector.
    pub(crate) largest_error: f64,
}

/// All bodies with their motions at the present time.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Assembly {
    pub(super) settings: RigidSettings,
    #[cfg_attr(feature = "save", serde(deserialize_with = "crate::rigid::bodies::saved::trajectories"))]
    pub(super) trajectories: Vec<Trajectory>,
    pub(super) remedies: Remedies,
    /// True for bodies that cannot move.
    pub(super) is_fixed: Vec<bool>,
    /// True if any of these is moved.
    pub(super) any_moved: bool,
    pub(super) force_laws: ForceLaws,
    /// True if some masses differ beyond the ratio that can be held together.
    pub(super) masses_are_extreme: bool,
    /// The surfaces of all bodies.
    pub(super) surfaces: Surfaces,
    /// True if nothing but contacts and connectors accelerates bodies.
    pub(super) is_forceless: bool,
    /// Time at which the system started.
    pub(super) start: Time,
    /// Time of the last event handled.
    pub(super) now: Time,
    /// Time at which an impulse last changed the velocity of each body.
    pub(super) struck: Vec<Option<Time>>,
    /// The body that leads each body's group, if it is in one.
    pub(super) leader_of: Vec<Option<BodyId>>,
    /// The segment of the group that each body leads; kept from the last one where it leads none.
    pub(super) shared: Vec<Shared>,
    /// Penetration [m] of the deepest contact of each body's last group, and the time at which the group ended.
    pub(super) sunk: Vec<(f64, Time)>,
}

impl Assembly {
    /// The bodies at a time at which none is in a group.
    pub(crate) fn new(
        trajectories: Vec<Trajectory>,
        force_laws: ForceLaws,
        settings: RigidSettings,
        start: Time,
    ) -> Self {
        let count = trajectories.len();
        let mut assembly = Self {
            settings,
            remedies: Remedies::new(settings.without),
            is_fixed: trajectories.iter().map(|trajectory| trajectory.body().is_fixed()).collect(),
            any_moved: trajectories.iter().any(|trajectory| trajectory.moved().is_some()),
            masses_are_extreme: false,
            surfaces: Surfaces::default(),
            is_forceless: force_laws.all.is_empty()
                && trajectories.iter().all(|trajectory| trajectory.free_motion().acceleration == DVec2::ZERO),
            trajectories,
            force_laws,
            start,
            now: start,
            struck: vec![None; count],
            leader_of: vec![None; count],
            shared: vec![Shared::default(); count],
            sunk: vec![(0.0, Time::default()); count],
        };
        assembly.masses_are_extreme = assembly.has_extreme_masses();
        assembly
    }

    /// Number of bodies.
    pub(crate) fn body_count(&self) -> usize {
        self.trajectories.len()
    }

    /// The remedies.
    #[inline]
    pub(crate) fn remedies(&self) -> &Remedies {
        &self.remedies
    }

    /// The same with surfaces.
    pub(crate) fn with_surfaces(self, surfaces: Surfaces) -> Self {
        Self { surfaces, ..self }
    }

    /// True if there is friction or rolling resistance between any bodies.
    #[inline]
    pub(crate) fn any_friction(&self) -> bool {
        self.surfaces.any_resists()
    }

    /// The surfaces of all bodies.
    #[inline]
    pub(crate) fn surfaces(&self) -> &Surfaces {
        &self.surfaces
    }

    /// The ids of all bodies.
    pub(crate) fn bodies(&self) -> impl Iterator<Item = BodyId> + use<> {
        (0..u32::try_from(self.trajectories.len()).unwrap_or(u32::MAX)).map(BodyId)
    }

    /// A body with its present segment.
    #[inline]
    pub(crate) fn trajectory(&self, body: BodyId) -> &Trajectory {
        &self.trajectories[body.index()]
    }

    /// A body with its present segment, to be moved.
    #[inline]
    pub(crate) fn trajectory_mut(&mut self, body: BodyId) -> &mut Trajectory {
        &mut self.trajectories[body.index()]
    }

    /// Goes on to a time, or back by a little where an event turns out to come earlier.
    pub(crate) fn set_now(&mut self, now: Time) {
        self.now = now;
    }

    /// Notes that a body is in a group that another leads.
    pub(crate) fn lead(&mut self, body: BodyId, leader: BodyId) {
        self.leader_of[body.index()] = Some(leader);
    }

    /// Notes that a body is in no group any more.
    pub(crate) fn part(&mut self, body: BodyId) {
        self.leader_of[body.index()] = None;
    }

    /// Notes the segment of the group that a body leads.
    pub(crate) fn share(&mut self, leader: BodyId, shared: Shared) {
        self.shared[leader.index()] = shared;
    }

    /// Notes until when the step that a body leads lasts.
    pub(crate) fn share_span(&mut self, leader: BodyId, end: Time) {
        self.shared[leader.index()] = Shared { end, ..Shared::default() };
    }

    /// Notes the depth [m] of the deepest contact of a body's group, which ends now.
    pub(crate) fn note_sunk(&mut self, body: BodyId, depth: f64) {
        self.sunk[body.index()] = (depth, self.now);
    }

    /// Notes that an impulse changes the velocity of a body at a time.
    pub(crate) fn note_struck(&mut self, body: BodyId, time: Time) {
        self.struck[body.index()] = Some(time);
    }

    /// The settings, for tests that change them.
    #[cfg(test)]
    pub(crate) fn settings_mut(&mut self) -> &mut RigidSettings {
        &mut self.settings
    }

    /// Sets the force laws, for tests, without listing the bodies that they act on.
    #[cfg(test)]
    pub(crate) fn set_force_laws(&mut self, force_laws: Vec<std::sync::Arc<dyn crate::rigid::ForceLaw>>) {
        self.force_laws.all = force_laws;
    }

    /// True for a body that can move.
    pub(crate) fn is_movable(&self, body: BodyId) -> bool {
        !body.is_world() && !self.is_fixed[body.index()]
    }

    /// End of the present segment of a body; `None` for a flight.
    pub(crate) fn segment_end(&self, body: BodyId) -> Option<Time> {
        if body.is_world() {
            None
        } else {
            self.leader_of[body.index()].map(|leader| self.shared[leader.index()].end)
        }
    }

    /// True if a step of their region takes care of the contacts between two bodies.
    pub(crate) fn share_step(&self, bodies: [BodyId; 2]) -> bool {
        let [a, b] = bodies;
        let coasts = |body: BodyId| self.trajectory(body).is_coasting();
        match bodies.map(|body| self.is_movable(body)) {
            [true, true] => coasts(a) && coasts(b) && self.leader_of[a.index()] == self.leader_of[b.index()],
            [true, false] => coasts(a),
            [false, true] => coasts(b),
            [false, false] => false,
        }
    }

    /// The segment that a body shares with its group, if it is in one.
    pub(crate) fn shared_by(&self, body: BodyId) -> Option<&Shared> {
        self.leader_of[body.index()].map(|leader| &self.shared[leader.index()])
    }

    /// The body under which facts about a body's motion are kept. Bodies of a group share one: a change of one's motion
    /// is a change of all.
    pub(crate) fn slot(&self, body: BodyId) -> usize {
        self.leader_of[body.index()].unwrap_or(body).index()
    }

    /// Depth [m] to which two bodies may lie in one another, as the contacts of a group do that one of them is in, or
    /// was in until now. A contact that takes over from a sunk one lies as deep.
    pub(crate) fn active_depth(&self, bodies: [BodyId; 2]) -> f64 {
        let depths = bodies.map(|body| match self.shared_by(body) {
            Some(shared) => shared.depth,
            None => {
                let (sunk, ended) = self.sunk[body.index()];
                if ended == self.now { sunk } else { 0.0 }
            }
        });
        let sunk = depths[0].max(depths[1]);
        // Other contacts of the two bodies may lie twice as deep.
        if sunk > 0.0 { (2.0 * sunk).min(self.thinness(bodies)) } else { 0.0 }
    }
}

impl Assembly {
    /// True for a body other than a disc that turns.
    pub(crate) fn turns_about(&self, body: BodyId) -> bool {
        let trajectory = self.trajectory(body);
        trajectory.disc().is_none() && trajectory.moving_at(self.now).angular_velocity != 0.0
    }
}

impl Assembly {
    pub(crate) fn inertia(&self, body: BodyId) -> InverseInertia {
        if body.is_world() {
            return InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        }
        let body = self.trajectory(body).body();
        InverseInertia { inverse_mass: body.inverse_mass, inverse_moment: body.inverse_moment }
    }
}

impl Assembly {
    /// Motion of a body at a time of its present segment; the background rests.
    pub(crate) fn moving_at(&self, body: BodyId, time: Time) -> Moving {
        if body.is_world() { Moving::BACKGROUND } else { self.trajectory(body).moving_at(time) }
    }
}

impl Assembly {
    /// Depth [m] up to which a body that lies in another is told from one that has gone through it.
    pub(crate) fn thinness(&self, bodies: [BodyId; 2]) -> f64 {
        let shares = bodies.map(|body| {
            let trajectory = self.trajectory(body);
            SMALL * trajectory.body().shape.mass_properties().area / trajectory.reach()
        });
        shares[0].min(shares[1])
    }
}

impl Assembly {
    /// Change of energy [J], not positive, by the damping of a body in flight since the start of its segment.
    pub(crate) fn damping_loss(&self, body: BodyId, time: Time) -> f64 {
        let trajectory = self.trajectory(body);
        let Some(start) = trajectory.flight_start().filter(|_| trajectory.free_motion().is_damped()) else {
            return 0.0;
        };
        let body = trajectory.body();
        let energy = |state: &BodyState| {
            body.kinetic_energy(state)
                - trajectory.free_motion().acceleration.dot(state.position) / body.inverse_mass
        };
        energy(&trajectory.unwound_at(time)) - energy(start)
    }
}

impl Assembly {
    /// Largest reach [m] of those of two bodies that can move; 0 if neither can.
    pub(crate) fn largest_reach(&self, bodies: [BodyId; 2]) -> f64 {
        let movable = bodies.into_iter().filter(|&body| self.is_movable(body));
        movable.fold(0.0, |most, body| most.max(self.trajectory(body).reach()))
    }
}

impl Assembly {
    /// Kinetic energy [J] of a movable body in a state.
    pub(crate) fn kinetic_energy(&self, body: BodyId, state: &BodyState) -> f64 {
        self.trajectory(body).body().kinetic_energy(state)
    }
}

impl Assembly {
    /// The trajectories.
    #[inline]
    pub(crate) fn trajectories(&self) -> &[Trajectory] {
        &self.trajectories
    }

    /// The laws.
    #[inline]
    pub(crate) fn force_laws(&self) -> &ForceLaws {
        &self.force_laws
    }

    /// The laws, to add or remove some: groups that have taken over the old ones must have been cut.
    pub(crate) fn force_laws_mut(&mut self) -> &mut ForceLaws {
        &mut self.force_laws
    }

    /// The body that leads each body's group, if it is in one.
    #[inline]
    pub(crate) fn leader_of(&self) -> &[Option<BodyId>] {
        &self.leader_of
    }

    /// Time of the last event handled.
    #[inline]
    pub(crate) fn now(&self) -> Time {
        self.now
    }

    /// The settings.
    #[inline]
    pub(crate) fn settings(&self) -> &RigidSettings {
        &self.settings
    }

    /// Time at which the system started.
    #[inline]
    pub(crate) fn start(&self) -> Time {
        self.start
    }

    /// Time at which an impulse last changed the velocity of each body.
    #[inline]
    pub(crate) fn struck(&self) -> &[Option<Time>] {
        &self.struck
    }
}
