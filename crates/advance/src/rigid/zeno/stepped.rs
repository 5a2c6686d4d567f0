//! The regions that are in a step, by their leaders.

use crate::rigid::contacts::touch::Touch;
use crate::time::Time;
use halfgap_collision::BodyId;

/// A region in a step: its bodies coast.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Stepped {
    /// The bodies, sorted; the least leads.
    pub(super) bodies: Vec<BodyId>,
    /// Their accelerations (x, y, angle) without contacts [m/s^2, m/s^2, rad/s^2].
    pub(super) accelerations: Vec<[f64; 3]>,
    /// The contacts that press in the step, sorted.
    pub(super) pressed: Vec<Pressed>,
    pub(super) start: Time,
    /// Length [s] of the step.
    pub(super) span: f64,
    /// Length [s] that the next step may have.
    pub(super) next_span: f64,
}

/// A contact that presses in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Pressed {
    pub(crate) touch: Touch,
    /// Speed [m/s] at which its gap closed as the step began.
    pub(crate) approach: f64,
    /// Impulse [N s] that keeps the gap from going below its target in the step.
    pub(crate) impulse: f64,
    /// Impulse [N s] that stopped it before the step.
    pub(crate) stopped_by: f64,
    /// What friction did.
    pub(crate) dragged: Dragged,
}

/// Friction of a contact in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Dragged {
    /// Impulse [N s] in the step.
    pub(crate) impulse: f64,
    /// Impulse [N s] as it was stopped before the step.
    pub(crate) stopped_by: f64,
    /// Side to which it slips, 1 or -1; 0 if it sticks.
    pub(crate) side: f64,
}

impl Stepped {
    pub(crate) fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    /// Their accelerations without contacts, in the order of the bodies.
    pub(crate) fn accelerations(&self) -> &[[f64; 3]] {
        &self.accelerations
    }

    pub(crate) fn start(&self) -> Time {
        self.start
    }

    /// Time [s] from the middle of the step to a time: bodies coast with the velocity that they have there.
    pub(crate) fn since_middle(&self, time: Time) -> f64 {
        time.since(self.start) - 0.5 * self.span
    }

    /// Begins a step without bodies, given its length [s] and that of the next.
    pub(crate) fn begin(&mut self, start: Time, [span, next_span]: [f64; 2]) {
        self.bodies.clear();
        self.accelerations.clear();
        self.pressed.clear();
        (self.start, self.span, self.next_span) = (start, span, next_span);
    }

    /// Adds a body, greater than those before.
    pub(crate) fn add(&mut self, body: BodyId, acceleration: [f64; 3]) {
        self.bodies.push(body);
        self.accelerations.push(acceleration);
    }

    /// Adds a contact that presses.
    pub(crate) fn press(&mut self, pressed: Pressed) {
        self.pressed.push(pressed);
    }

    /// Sorts the contacts that press.
    pub(crate) fn sort_pressed(&mut self) {
        self.pressed.sort_unstable_by_key(|pressed| pressed.touch);
    }
}

/// All regions in a step.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct AllStepped {
    by_leader: Vec<Option<Box<Stepped>>>,
    /// Contacts that pressed in the steps that the present event has ended.
    #[cfg_attr(feature = "save", serde(skip))]
    ended: Vec<Pressed>,
    /// Number of bodies in the steps that the present event has ended, and the least length [s] of the next step that they
    /// allow.
    #[cfg_attr(feature = "save", serde(skip))]
    of_ended: (usize, f64),
    /// Emptied ones, to be used again.
    #[cfg_attr(feature = "save", serde(skip))]
    #[expect(clippy::vec_box, reason = "they go from here to `by_leader` without being copied")]
    pool: Vec<Box<Stepped>>,
}

impl AllStepped {
    /// None, of so many bodies.
    pub(super) fn new(body_count: usize) -> Self {
        Self { by_leader: vec![None; body_count], ..Self::default() }
    }

    /// The region that a body leads, if it is in a step.
    pub(crate) fn led_by(&self, leader: BodyId) -> Option<&Stepped> {
        self.by_leader[leader.index()].as_deref()
    }

    /// All of them.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Stepped> {
        self.by_leader.iter().filter_map(Option::as_deref)
    }

    /// Takes out the region that a body leads.
    pub(crate) fn take(&mut self, leader: BodyId) -> Option<Box<Stepped>> {
        self.by_leader[leader.index()].take()
    }

    /// Contacts that pressed in the steps that the present event has ended.
    pub(crate) fn ended(&self) -> &[Pressed] {
        &self.ended
    }

    /// Begins an event, which has ended no step yet.
    pub(crate) fn begin_event(&mut self) {
        self.ended.clear();
        self.of_ended = (0, f64::INFINITY);
    }

    /// Adds contacts that forces have pressed until now, to those that pressed in steps.
    pub(crate) fn expect(&mut self, pressed: impl Iterator<Item = Pressed>) {
        self.ended.extend(pressed);
        self.ended.sort_unstable_by_key(|pressed| pressed.touch);
        self.ended.dedup_by_key(|pressed| pressed.touch);
    }

    /// Length [s] of the next step that the steps allow which the present event has ended.
    pub(crate) fn longest_next(&self) -> f64 {
        self.of_ended.1
    }

    /// Length [s] of the next step of so many bodies, if all of them were in steps that the present event has ended.
    pub(crate) fn next_span(&self, bodies: usize) -> Option<f64> {
        let (count, span) = self.of_ended;
        (count == bodies).then_some(span)
    }

    /// Notes what pressed in a step that ends now, and keeps its buffers.
    pub(crate) fn end(&mut self, stepped: Box<Stepped>) {
        let (count, span) = self.of_ended;
        self.of_ended = (count + stepped.bodies.len(), span.min(stepped.next_span));
        self.ended.extend_from_slice(&stepped.pressed);
        self.ended.sort_unstable_by_key(|pressed| pressed.touch);
        self.recycle(stepped);
    }

    /// An empty one.
    pub(crate) fn take_empty(&mut self) -> Box<Stepped> {
        self.pool.pop().unwrap_or_default()
    }

    /// Keeps one that has ended, to be used again.
    fn recycle(&mut self, stepped: Box<Stepped>) {
        self.pool.push(stepped);
    }

    /// Puts in a region that is in a step, with its leader.
    pub(crate) fn put(&mut self, leader: BodyId, stepped: Box<Stepped>) {
        self.by_leader[leader.index()] = Some(stepped);
    }
}
