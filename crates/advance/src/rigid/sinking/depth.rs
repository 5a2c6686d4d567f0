//! How far bodies may sink into each other where contacts carry impulses only, and what waits to be put back.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::shares::{MINOR, NEARLY_ALL};
use halfgap_collision::{BodyId, Tolerances, Zone};

/// Contacts that wait for the next tick.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Sinking {
    /// Touches that have sunk, sorted.
    waiting: Vec<Touch>,
    /// Distance [m] by which bodies have been moved in being put back; zero except during a tick.
    moved: f64,
    /// Number of ticks that have gone by.
    count: f64,
    /// Number of collisions of sunk contacts since the last tick.
    pressed: u32,
    /// Buffer: indices of the laws of a region's bodies.
    force_laws: Vec<usize>,
}

impl Sinking {
    /// Notes that bodies have been moved by a distance [m] in being put back.
    pub(crate) fn note_move(&mut self, way: f64) {
        self.moved += way;
    }

    /// All bodies are put back.
    pub(crate) fn end_moves(&mut self) {
        self.moved = 0.0;
    }

    /// Counts a collision of a sunk contact; returns their number since the last tick.
    pub(crate) fn note_pressed(&mut self) -> u32 {
        self.pressed += 1;
        self.pressed
    }

    /// Begins a tick.
    pub(crate) fn begin_tick(&mut self) {
        self.pressed = 0;
    }

    /// Number of ticks that have gone by, given a number that surely have.
    pub(crate) fn passed(&mut self, surely: f64) -> f64 {
        self.count = surely.max(self.count);
        self.count
    }

    /// Takes out the touches that wait.
    pub(crate) fn take_waiting(&mut self) -> Vec<Touch> {
        std::mem::take(&mut self.waiting)
    }

    /// Puts in the touches that wait, sorted.
    pub(crate) fn put_waiting(&mut self, waiting: Vec<Touch>) {
        self.waiting = waiting;
    }

    /// Takes out the buffer of laws.
    pub(crate) fn take_force_laws(&mut self) -> Vec<usize> {
        std::mem::take(&mut self.force_laws)
    }

    /// Puts back the buffer of laws.
    pub(crate) fn put_force_laws(&mut self, force_laws: Vec<usize>) {
        self.force_laws = force_laws;
    }

    pub(crate) fn wait(&mut self, touch: Touch) {
        if let Err(place) = self.waiting.binary_search(&touch) {
            self.waiting.insert(place, touch);
        }
    }

    /// Waiting touches of two bodies, the lesser first.
    pub(crate) fn waiting_of(&self, bodies: [BodyId; 2]) -> &[Touch] {
        let start = self.waiting.partition_point(|touch| touch.bodies < bodies);
        let count = self.waiting[start..].partition_point(|touch| touch.bodies == bodies);
        &self.waiting[start..start + count]
    }
}

/// Fraction of the room to sink at which a pair fires again.
pub(crate) const FIRST_SHARE: f64 = 0.6;

/// Fraction of the room by which a pair may sink further whenever it fires again, slowly.
pub(crate) const FURTHER_SHARE: f64 = 1.0 / 96.0;

/// Multiple of the room: features that are deeper lie on the far side of a body.
pub(crate) const BEHIND: f64 = 1.25;

/// Fraction of the room beyond which a fast pair has sunk, rather than just been seen.
pub(crate) const DEEP_SHARE: f64 = 0.3;

/// Depth [m] by which a pair of bodies may sink below the target gap until it is put back; zero where contacts
/// carry forces.
///
/// # Panics
/// If there is no such body.
#[must_use]
#[inline]
pub(crate) fn room_to_sink(assembly: &Assembly, bodies: [BodyId; 2]) -> f64 {
    let Some(step) = assembly.settings().impulse_step else { return 0.0 };
    let reach = bodies.map(|body| assembly.trajectory(body).reach());
    let Tolerances { accuracy, velocity_tol, .. } = assembly.settings().tolerances;
    let of_bodies = (MINOR * reach[0].min(reach[1])).min(assembly.thinness(bodies));
    // Contacts may be anywhere in the target zone, and sink from there: a first firing lies no higher than its end.
    of_bodies.max(accuracy / FIRST_SHARE) + velocity_tol * step
}

/// Gap [m] at which a contact without force that does not open fires, by its present gap [m]. Forces on its bodies,
/// or their turning, may press on at once a contact that was stopped below its zone until it is put back: it may go
/// a fraction of the way that is left to the depth beyond which it sinks no further.
pub(crate) fn sinks_to(assembly: &Assembly, touch: Touch, gap: f64) -> f64 {
    let tolerances = &assembly.settings().tolerances;
    if assembly.settings().impulse_step.is_none() || Zone::of(gap, tolerances) <= Zone::Target {
        return assembly.refire_gap(gap);
    }
    let left = gap - tolerances.target_gap + NEARLY_ALL * room_to_sink(assembly, touch.bodies);
    gap - assembly.sink().max(FURTHER_SHARE * left)
}

/// Depth [m] to which two bodies, the lesser first, may lie in one another. Where contacts carry impulses only,
/// they have been left to sink, have been moved, or would sink within a step; where contacts carry forces, active
/// ones may lie deep.
pub(crate) fn may_have_sunk_by(assembly: &Assembly, sinking: &Sinking, bodies: [BodyId; 2]) -> f64 {
    if assembly.settings().impulse_step.is_none() {
        return assembly.active_depth(bodies);
    }
    // Either may have been moved against the other.
    let moved = 2.0 * sinking.moved;
    if !sinking.waiting_of(bodies).is_empty() {
        // A body that is turned as it is put back sinks at other places.
        return BEHIND * room_to_sink(assembly, bodies) + moved.min(assembly.thinness(bodies));
    }
    assembly.settings().search.depth.max(moved).min(assembly.thinness(bodies))
}

impl Sinking {
    /// Distance [m] by which bodies have been moved in being put back; zero except during a tick.
    #[inline]
    pub(crate) fn moved(&self) -> f64 {
        self.moved
    }

    /// Touches that have sunk, sorted.
    #[inline]
    pub(crate) fn waiting(&self) -> &[Touch] {
        &self.waiting
    }
}
