//! Accumulations: more events in a short time than forces can resolve. They are ended by an impact without elasticity.
//!
//! The resolution time is the time that forces take to make `velocity_tol`, or to move a body through the half-width of
//! the target zone, whichever is longer; without forces, the time in which the fastest body crosses the target gap. The
//! events of each body within that time add up to a load. Wide events, between which bodies go far beyond the
//! target gap, are resolved in space all the same, so more of them are allowed. The same number is allowed of costly
//! ones, in which much energy would be lost, and still more of events that are both. A light body that heavy ones close
//! on takes up all their energy before it turns them back, and to do so it must hit them about as often as the root of
//! the masses' ratio; a die that jams in its slot is turned back by blows between which it moves by a gap or two.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::all::Books;
use crate::rigid::contacts::rows::row_of;
use crate::rigid::shares::{LARGE, NEGLIGIBLE};
use crate::rigid::zeno::memory::{Recent, Zeno};
use crate::rigid::zeno::repeats::CALM_REPEATS;
use halfgap_collision::{BodyId, Collision, Tolerances};

/// Number of such events that each row of the region allows beyond them.
const CALM_EVENTS_PER_ROW: usize = 10;
/// Load of an event that is wide or costly, but not both; that of one that is both is 1.
const LOAD_OF_ONE: usize = 100;
/// Load of an event that is neither; an accumulation is more than this times (20 + 10 x rows).
const LOAD_OF_NEITHER: usize = 50 * LOAD_OF_ONE;
/// An event is still if it follows the one before at once, and its bodies came towards each other in between by less
/// than this fraction of the half-width of the target zone. Such events are counted on beyond the resolution time,
/// however long they go on: forces that the start did not show press contacts together, of which now the one, now the
/// other gives way.
const STILL: f64 = 1e-6;
/// An event follows another at once if the time between is less than this fraction of the time in which a body of the
/// scene's speed crosses the radius of the smallest body.
const AT_ONCE: f64 = 1e-8;

/// Adds an event of some bodies and the records of their contacts to the loads of these bodies; true if it is one too many.
pub(crate) fn note_events(
    assembly: &Assembly,
    zeno: &mut Zeno,
    books: &mut Books,
    of: (&[BodyId], &[Collision]),
) -> bool {
    let (bodies, records) = of;
    let (now, window) = (assembly.now(), assembly.settings().resolution_time);
    let speed = records.iter().map(|record| -record.motion.normal_velocity).fold(0.0, f64::max);
    let Tolerances { target_gap, accuracy, .. } = assembly.settings().tolerances;
    // A light body between heavy ones that close on it goes a wide way each time, until it has turned them back: that is no accumulation.
    let (wide, still) = (LARGE * target_gap, STILL * accuracy);
    let at_once = AT_ONCE * assembly.settings().steps.length / assembly.settings().steps.speed;
    // So few events make no accumulation: none of them is examined for its cost.
    let is_often = bodies.iter().any(|body| zeno.recent[body.index()].load > 10 * LOAD_OF_ONE);
    let is_costly = is_often && is_costly(assembly, of);
    let mut most = 0;
    for &body in bodies {
        let recent = &mut zeno.recent[body.index()];
        let wait = recent.last.map(|last| now.since(last));
        let way = wait.map(|wait| wait * speed);
        let is_still = way.is_some_and(|way| way < still) && wait.is_some_and(|wait| wait < at_once);
        if !is_still && recent.since.is_none_or(|since| now.since(since) > window) {
            *recent = Recent { since: Some(now), load: 0, ..*recent };
        }
        let is_wide = way.is_none_or(|way| way > wide);
        recent.load += match (is_wide, is_costly) {
            (true, true) => 1,
            (true, false) | (false, true) => LOAD_OF_ONE,
            (false, false) => LOAD_OF_NEITHER,
        };
        recent.last = Some(now);
        most = most.max(recent.load);
    }
    let calm = CALM_REPEATS as usize + CALM_EVENTS_PER_ROW * records.len();
    let is_accumulating = most > LOAD_OF_NEITHER * calm;
    if is_accumulating {
        books.note_accumulation();
        for &body in bodies {
            zeno.recent[body.index()].load = 0;
        }
    }
    is_accumulating
}

/// True if stopping one of the contacts that close would take more than [`NEGLIGIBLE`] of the kinetic
/// energy of its bodies.
fn is_costly(assembly: &Assembly, (bodies, records): (&[BodyId], &[Collision])) -> bool {
    let closing = records.iter().map(|record| {
        let row = row_of(assembly, record);
        let (rate, inverse_mass) = (row.rate.min(0.0), row.coupling(&row));
        if inverse_mass > 0.0 { 0.5 * rate * rate / inverse_mass } else { 0.0 }
    });
    let moving = bodies.iter().map(|&body| {
        let trajectory = assembly.trajectory(body);
        trajectory.body().kinetic_energy(&trajectory.state_at(assembly.now()))
    });
    closing.fold(0.0, f64::max) > NEGLIGIBLE * moving.sum::<f64>()
}
