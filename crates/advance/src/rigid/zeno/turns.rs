//! Turns: bodies that turn too often in the run to be followed.
//!
//! A body that turns by itself costs nothing, nor does a disc about its centre. One that may hit others is searched
//! turn by turn, and one that is tied is stepped so, however little comes of it.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::pairs::{PairId, Pairs};
use crate::rigid::error::AdvanceError;
use crate::rigid::zeno::memory::Zeno;
use crate::time::Time;
use halfgap_collision::BodyId;
use std::f64::consts::TAU;

/// Largest number of turns of a body in a run that are followed. Measured with blocks at 1e6 to 1e8 rad/s: a turn takes
/// 0.4 us of a run above a floor, and 6 to 11 us on a pin, so that so many take 40 s to 20 minutes. More would be
/// a run of hours; fewer are a matter of patience.
const MOST_TURNS: f64 = 1e8;
/// Number of times in succession that the search of a pair goes on before its bodies are looked at. Measured with a
/// block at 1e9 rad/s: half a second, in which a body that turns fast may well have passed the other.
const SEARCHES: u32 = 100_000;

/// Notes that the search of a pair has gone on. If that is since one of the bodies turns too fast, the error is
/// kept in the memory, to be returned once the event is over.
pub(crate) fn note_search(assembly: &Assembly, pairs: &mut Pairs, zeno: &mut Zeno, pair: PairId) {
    if pairs.count_search(pair) >= SEARCHES {
        pairs.forget_searches(pair);
        let spin = |body: BodyId| assembly.moving_at(body, assembly.now()).angular_velocity;
        let mut bodies = pairs.bodies(pair).into_iter();
        zeno.crawls = bodies.find_map(|body| too_fast(zeno, body, spin(body), assembly.now()));
    }
}

/// Error of a body that has an angular velocity [rad/s] at a time, if it turns too often in the time to be
/// simulated.
pub(crate) fn too_fast(zeno: &Zeno, body: BodyId, angular_velocity: f64, time: Time) -> Option<AdvanceError> {
    let duration = zeno.duration;
    let is_too_fast = angular_velocity.abs() * duration > MOST_TURNS * TAU;
    let time = time.seconds();
    is_too_fast.then_some(AdvanceError::TooFast { time, body, angular_velocity, duration })
}
