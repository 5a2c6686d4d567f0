//! Rigid bodies that are advanced by steps: what callers may ask and do.

use crate::rigid::{
    AdvanceError, ContactChanges, Counts, ForceLaw, ForceLaws, Handled, ImpactReport, Ledger, PairRules,
    RigidParts, RowForce, Snapshot,
};
use crate::stepping::bodies::Bodies;
use crate::stepping::books::StepBooks;
use crate::stepping::pacing::Pacing;
use crate::stepping::pairs::Pairs;
use crate::stepping::report;
use crate::stepping::settings::SteppingSettings;
use crate::stepping::sleep::Sleep;
use crate::stepping::step::{From, Scene, Stepper};
use crate::stepping::ties::Ties;
use crate::system::EventDriven;
use crate::time::Time;
use halfgap_collision::{Body, BodyId, BodyState, Connector, ConnectorId, RailHint};
use std::sync::Arc;

/// Overlap, as a fraction of the smaller body's reach, that is no fault [-].
const ROOM: f64 = 0.1;

/// Share of a step after which its end is reached [-]: sums of steps and the times that callers ask for differ by rounding.
const REACHED: f64 = 1.0 - 1e-9;

/// System of rigid bodies that is advanced by steps.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct SteppingSystem {
    pub(super) settings: SteppingSettings,
    pub(super) scene: Scene,
    pub(super) stepper: Stepper,
    pub(super) books: StepBooks,
    pacing: Pacing,
    /// Start of the present step, and its length [s].
    pub(super) node: Time,
    pub(super) span: f64,
    /// The last impact, and that of the present step, if there is one.
    impact: ImpactReport,
    fresh: ImpactReport,
}

impl SteppingSystem {
    /// Makes the system of the given parts at a time. The caller must see to it that bodies do not overlap and that
    /// connectors fit the states: neither is checked.
    ///
    /// # Errors
    /// Parts or settings out of range.
    pub fn new(parts: RigidParts, settings: SteppingSettings, start: Time) -> Result<Self, AdvanceError> {
        parts.check(&settings.rigid, start)?;
        settings.check()?;
        let RigidParts { bodies, connectors, force_laws, excluded, pairs } = parts;
        let count = bodies.len();
        let books = StepBooks::new(force_laws.len());
        let bodies = Bodies::new(bodies, start.seconds());
        let laws = ForceLaws::new(force_laws, count, &Snapshot::new(start.seconds(), &bodies.movings));
        let sleep = Sleep::new(count);
        let scene = Scene {
            sleep,
            bodies,
            pairs: Pairs::new(count, (excluded, PairRules::new(pairs)), settings.rigid.tolerances.target_gap),
            ties: Ties::new(connectors),
            laws,
        };
        let mut system = Self {
            settings,
            scene,
            stepper: Stepper::default(),
            books,
            pacing: Pacing::new(settings.step),
            node: start,
            span: settings.step,
            impact: ImpactReport::default(),
            fresh: ImpactReport::default(),
        };
        system.begin(From::Start(0.0));
        Ok(system)
    }

    /// Begins the step at the present node; tells of impacts there, and of contacts that begin or end.
    pub(super) fn begin(&mut self, from: From) -> Option<Handled> {
        let time = self.node.seconds();
        if let Some(accuracy) = self.settings.accuracy {
            let parts = (&mut self.scene, &mut self.stepper, &mut self.books);
            self.span = self.pacing.choose(parts, (&self.settings, accuracy), time, from);
        }
        let hits = self.books.counts().impacts;
        self.fresh.begin(self.node);
        self.stepper.begin(
            &mut self.scene,
            (&self.settings, time, self.span),
            from,
            (&mut self.books, &mut self.fresh),
        );
        if self.books.counts().impacts > hits {
            std::mem::swap(&mut self.impact, &mut self.fresh);
        }
        let handled = Handled { time: self.node, impact: self.books.counts().impacts > hits };
        (handled.impact || !self.stepper.changes.is_empty()).then_some(handled)
    }

    /// Brings all bodies to a time of the present step.
    pub(super) fn go_to(&mut self, time: Time) {
        self.scene.bodies.go_to(time.since(self.node), self.span);
        self.node = time;
    }

    /// Number of bodies.
    #[must_use]
    #[inline]
    pub fn body_count(&self) -> usize {
        self.scene.bodies.count()
    }

    /// A body.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    #[inline]
    pub fn body(&self, body: BodyId) -> &Body {
        &self.scene.bodies.natures[body.index()].body
    }

    /// State of a body at a time of the present step.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    #[inline]
    pub fn state_at(&self, body: BodyId, time: Time) -> BodyState {
        self.scene.bodies.courses[body.index()].state_at(time.since(self.node), self.span)
    }

    /// Start of the present step.
    #[must_use]
    #[inline]
    pub fn now(&self) -> Time {
        self.node
    }

    /// The settings.
    #[must_use]
    #[inline]
    pub fn settings(&self) -> &SteppingSettings {
        &self.settings
    }

    /// Counts and extremes since the start.
    #[must_use]
    #[inline]
    pub fn counts(&self) -> Counts {
        self.books.counts()
    }

    /// Connectors, in the order of their ids.
    #[must_use]
    #[inline]
    pub fn connectors(&self) -> &[Connector] {
        &self.scene.ties.all
    }

    /// Place on its path near which the point of a rail or of a rail's stop is sought; `None` for other connectors.
    #[must_use]
    #[inline]
    pub fn rail_hint(&self, connector: ConnectorId) -> Option<RailHint> {
        self.scene.ties.memory[connector.index()].hint
    }

    /// Pairs of bodies that never collide with each other, the lesser id first, sorted.
    #[must_use]
    #[inline]
    pub fn excluded(&self) -> &[(BodyId, BodyId)] {
        self.scene.pairs.excluded()
    }

    /// Depth [m] by which two bodies may overlap that the next steps will put apart: a minor part of the lesser one.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    pub fn room_to_sink(&self, bodies: [BodyId; 2]) -> f64 {
        let reach = bodies.map(|body| self.scene.bodies.natures[body.index()].reach);
        ROOM * reach[0].min(reach[1])
    }

    /// Forces of all rows that carry one in the present step, and then those between bodies that sleep.
    #[must_use]
    pub fn row_forces(&self) -> Vec<RowForce> {
        report::row_forces(&self.scene, &self.stepper.rows, self.node.seconds())
    }

    /// Writes the energy ledger at a time of the present step over `ledger`, whose buffer is used again.
    pub fn write_ledger(&self, time: Time, ledger: &mut Ledger) {
        self.books.write(time.since(self.node) - 0.5 * self.span, ledger);
    }

    /// Report of the last impact; empty if there was none.
    #[must_use]
    #[inline]
    pub fn last_impact(&self) -> &ImpactReport {
        &self.impact
    }

    /// Contacts that began or ended with the present step.
    #[must_use]
    #[inline]
    pub fn contact_changes(&self) -> &ContactChanges {
        &self.stepper.changes
    }

    /// Force laws, in the order of their indices, those that were removed included.
    #[must_use]
    pub fn force_laws(&self) -> &[Arc<dyn ForceLaw>] {
        &self.scene.laws.all
    }

    /// True if the force law at an index acts; false if it was removed or is not there.
    #[must_use]
    pub fn is_acting(&self, law: usize) -> bool {
        self.scene.laws.is_on(law)
    }

    /// True if the force law at an index has a potential; panics if there is no such law.
    #[must_use]
    pub fn has_potential(&self, law: usize) -> bool {
        self.scene.laws.has_potential[law]
    }
}

impl EventDriven for SteppingSystem {
    type Report = Handled;
    type Error = AdvanceError;

    fn next_event(&self) -> Option<Time> {
        Some(self.node.plus(REACHED * self.span))
    }

    /// Begins the next step.
    fn handle_next(&mut self) -> Result<Option<Handled>, AdvanceError> {
        self.books.begin(0.0);
        let last = self.span;
        self.go_to(self.node.plus(last));
        Ok(self.begin(From::Before(last)))
    }
}
