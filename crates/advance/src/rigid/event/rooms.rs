//! All rooms together: what an event may change.

use crate::rigid::agenda::Agenda;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::force_law::Snapshot;
use crate::rigid::bodies::force_laws::ForceLaws;
use crate::rigid::bodies::moved::motion_of;
use crate::rigid::bodies::trajectory::Trajectory;
use crate::rigid::books::all::Books;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::pairs::Pairs;
use crate::rigid::event::coupling::Coupling;
use crate::rigid::event::members::Members;
use crate::rigid::event::work::EventWork;
use crate::rigid::group::groups::Groups;
use crate::rigid::parts::{BodyPart, RigidParts};
use crate::rigid::region::cause::Cause;
use crate::rigid::region::view::View;
use crate::rigid::search::neighbourhood::Neighbourhood;
use crate::rigid::search::searching::Searching;
use crate::rigid::settings::RigidSettings;
use crate::rigid::sinking::depth::Sinking;
use crate::rigid::surfaces::{PairRules, Surfaces};
use crate::rigid::zeno::memory::Zeno;
use crate::time::Time;
use halfgap_collision::{BodyId, Moving};

/// The parts of a system, each with its own room.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Rooms {
    pub(crate) assembly: Assembly,
    pub(crate) connectors: Connectors,
    pub(crate) sinking: Sinking,
    pub(crate) pairs: Pairs,
    pub(crate) search: Neighbourhood,
    pub(crate) groups: Groups,
    pub(crate) zeno: Zeno,
    pub(crate) books: Books,
    pub(crate) agenda: Agenda,
    /// Members of the groups that are being made.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(crate) members: Members,
    /// Which places of a region share their steps.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(crate) coupling: Coupling,
    /// Bodies that have begun a step.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(crate) coasting: Vec<BodyId>,
    /// Buffers of an event; taken out while one is handled.
    pub(crate) work: Option<Box<EventWork>>,
}

impl Rooms {
    /// Makes the rooms of the given parts, with all bodies in flight and nothing predicted.
    pub(crate) fn new(parts: RigidParts, settings: RigidSettings, start: Time) -> Self {
        // Steps know contacts and uniform accelerations only; bodies that go from steps to groups with more are not sound yet.
        let is_plain = parts.connectors.is_empty()
            && parts.force_laws.is_empty()
            && !parts
                .pairs
                .iter()
                .any(|(_, rule)| rule.rolling_resistance.is_some_and(|rolling| rolling > 0.0))
            && parts.bodies.iter().all(|part| {
                !part.free_motion.is_damped()
                    && part.surface.rolling_resistance == 0.0
                    && part.motion.is_none()
            });
        let region_steps = settings.region_steps.filter(|_| is_plain);
        let settings = RigidSettings { region_steps, ..settings };
        let RigidParts { bodies, connectors, force_laws, excluded, pairs } = parts;
        let surfaces = bodies.iter().map(|part| part.surface).collect();
        let surfaces = Surfaces::new(surfaces, PairRules::new(pairs));
        let trajectory = |BodyPart { body, free_motion, state, motion, .. }: BodyPart| {
            let motion = motion_of(motion, body.is_fixed());
            let trajectory = Trajectory::new(body, free_motion, state, start);
            match motion {
                Some(motion) => trajectory.moved_by(&motion),
                None => trajectory,
            }
        };
        let trajectories: Vec<Trajectory> = bodies.into_iter().map(trajectory).collect();
        let movings: Vec<Moving> =
            trajectories.iter().map(|trajectory| trajectory.moving_at(start)).collect();
        let snapshot = Snapshot::new(start.seconds(), &movings);
        let count = trajectories.len();
        let movable = trajectories.iter().filter(|trajectory| !trajectory.body().is_fixed()).count();
        let books = Books::new(movable, force_laws.len());
        let force_laws = ForceLaws::new(force_laws, count, &snapshot);
        let connectors = Connectors::new(connectors, count);
        Self {
            books,
            agenda: Agenda::new(count, connectors.all().len()),
            connectors,
            pairs: Pairs::new(
                trajectories
                    .iter()
                    .map(|trajectory| trajectory.body().is_fixed() && trajectory.moved().is_none())
                    .collect(),
            ),
            search: Neighbourhood::new(&trajectories, excluded, &settings),
            groups: Groups::new(movings, settings.method),
            zeno: Zeno::new(count),
            sinking: Sinking::default(),
            members: Members::default(),
            coupling: Coupling::default(),
            coasting: Vec::new(),
            work: None,
            assembly: Assembly::new(trajectories, force_laws, settings, start).with_surfaces(surfaces),
        }
    }

    /// What the search works on.
    pub(crate) fn searching(&mut self) -> Searching<'_> {
        let Self { assembly, connectors, sinking, pairs, search, agenda, .. } = self;
        Searching { assembly, connectors, sinking, pairs, search, agenda }
    }

    /// A look at all rooms.
    pub(crate) fn view(&self) -> View<'_> {
        let Self { assembly, connectors, sinking, pairs, search, groups, zeno, .. } = self;
        View { assembly, connectors, sinking, pairs, search, groups, zeno }
    }
}

/// Runs an action on an event of the given cause, with the buffers of events.
pub(crate) fn with_work<T>(
    rooms: &mut Rooms,
    cause: Cause,
    act: impl FnOnce(&mut Rooms, &mut EventWork) -> T,
) -> T {
    let mut work = rooms.work.take().unwrap_or_default();
    rooms.zeno.stepped_mut().begin_event();
    work.region.set_cause(cause);
    let outcome = act(rooms, &mut work);
    work.region.set_cause(Cause::Other);
    work.region.set_accumulating(false);
    work.region.set_strained(false);
    (work.repeats, work.fired_open) = (0, false);
    rooms.work = Some(work);
    outcome
}
