//! Thresholds of friction: whether a contact sticks or slips there is for the least change of the scene to decide.
//!
//! A contact is critical if it sticks but has next to no friction to spare, or slips but gains next to no speed. All other contacts that do not
//! slip, and connectors, make one of the bodies that they join, fixed ones included. A critical contact between two such sets is at a threshold.
//! One within a set proves nothing: where forces are redundant the others bear more if that one bears less.
//!
//! A contact comes to its bound in passing, too: only those count that are critical at two output times, one after the other. Likewise a contact
//! that sticks in one run and slips in the other does so at two output times.

use crate::event::{ContactForce, ContactFriction};
use crate::recording::{Frame, Recording};
use crate::world::World;
use halfgap_collision::BodyId;
use serde::Serialize;

/// Share of its friction [-] that a critical contact has to spare, or that is left of it to accelerate what slips. Ten times what bounds of
/// friction are narrowed by as forces are found, so that whatever may be taken for the other there is told; no coefficient is known as well as that.
const SPARE: f64 = 1e-6;

/// A contact of two bodies at a threshold of friction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrictionThreshold {
    /// Names of the bodies.
    pub bodies: [String; 2],
    /// Output time [s] from which on it is there.
    pub time: f64,
    /// Share of its friction [-] that it has to spare; 0 of one that slips.
    pub spare: f64,
    /// Slip speeds [m/s] in the run and in the tighter one, if it sticks in one of them only.
    pub slip_speeds: Option<[f64; 2]>,
}

/// A pair of bodies, the lesser first, that is at a threshold: the share to spare, and slip speeds where runs differ.
type Critical = ([BodyId; 2], f64, Option<[f64; 2]>);

/// Finds the contacts at thresholds of friction in two runs with the same output times, up to a time [s]; each pair of bodies once.
pub(super) fn find(world: &World, [run, tighter]: [&Recording; 2], until: f64) -> Vec<FrictionThreshold> {
    let frames: Vec<_> = run.frames.iter().zip(&tighter.frames).collect();
    let mut found: Vec<Critical> = Vec::new();
    let mut told = Vec::new();
    for pair in frames.windows(2) {
        let [(frame, other), (next, next_other)] = pair else { continue };
        if next.time > until || next.time != next_other.time {
            break;
        }
        let span = next.time - frame.time;
        let goes_on = [critical_in(world, next, span), differing(next, next_other)];
        let begins = [critical_in(world, frame, span), differing(frame, other)];
        for (begins, goes_on) in begins.into_iter().zip(goes_on) {
            for critical in begins {
                let is_of = |other: &Critical| other.0 == critical.0;
                if goes_on.iter().any(is_of) && !found.iter().any(is_of) {
                    found.push(critical);
                    let bodies = critical.0.map(|body| run.name(body).to_owned());
                    told.push(FrictionThreshold {
                        bodies,
                        time: frame.time,
                        spare: critical.1,
                        slip_speeds: critical.2,
                    });
                }
            }
        }
    }
    told
}

/// The critical contacts of a frame between bodies that nothing else holds to each other; `span` [s] is the time to the next output.
fn critical_in(world: &World, frame: &Frame, span: f64) -> Vec<Critical> {
    let ground = world.body_count();
    let place = |body: BodyId| if world.is_fixed(body) { ground } else { body.index() };
    let mut sets: Vec<usize> = (0..=ground).collect();
    let mut critical = Vec::new();
    for contact in &frame.forces {
        let spare = contact.friction.and_then(|friction| spare(world, contact, &friction, span));
        let slips = contact.friction.is_some_and(|friction| !friction.sticks);
        match spare {
            Some(spare) => critical.push((sorted(contact), spare, None)),
            None if slips => {}
            None => {
                let [a, b] = contact.bodies.map(|body| root(&sets, place(body)));
                sets[a.min(b)] = a.max(b);
            }
        }
    }
    critical.retain(|(bodies, ..)| {
        let [a, b] = bodies.map(|body| root(&sets, place(body)));
        a != b
    });
    critical
}

/// The share [-] of its friction that a critical contact has to spare; `None` for others.
fn spare(world: &World, contact: &ContactForce, friction: &ContactFriction, span: f64) -> Option<f64> {
    if friction.most <= 0.0 {
        return None;
    }
    if friction.sticks {
        let spare = (1.0 - friction.cone_use()).max(0.0);
        return (spare <= SPARE).then_some(spare);
    }
    let masses = contact.bodies.into_iter().filter_map(|body| world.inertia(body));
    let lightest = masses.map(|inertia| inertia.mass).fold(f64::INFINITY, f64::min);
    (friction.slip_speed.abs() <= SPARE * friction.most / lightest * span).then_some(0.0)
}

/// The pairs of bodies all of whose contacts stick in one of two frames and slip in the other.
fn differing(frame: &Frame, other: &Frame) -> Vec<Critical> {
    let mut pairs: Vec<[BodyId; 2]> =
        frame.forces.iter().filter(|contact| contact.friction.is_some()).map(sorted).collect();
    pairs.sort_unstable();
    pairs.dedup();
    let mut others: Vec<_> = other.forces.iter().map(|contact| (sorted(contact), contact)).collect();
    others.sort_by_key(|(bodies, _)| *bodies);
    let mut own: Vec<_> = frame.forces.iter().map(|contact| (sorted(contact), contact)).collect();
    own.sort_by_key(|(bodies, _)| *bodies);
    let differ = |bodies: [BodyId; 2]| {
        let [one, two] = [&own, &others].map(|contacts| hold_of(contacts, bodies));
        let ((one, here), (two, there)) = (one?, two?);
        (one != two).then_some((bodies, 0.0, Some([here, there])))
    };
    pairs.into_iter().filter_map(differ).collect()
}

/// Whether all contacts with friction of two bodies stick, and their largest slip speed [m/s]; `None` if some stick and some slip, or there are none.
fn hold_of(contacts: &[([BodyId; 2], &ContactForce)], bodies: [BodyId; 2]) -> Option<(bool, f64)> {
    let first = contacts.partition_point(|(other, _)| *other < bodies);
    let of_pair = contacts[first..].iter().take_while(|(other, _)| *other == bodies);
    let mut hold: Option<(bool, f64)> = None;
    for friction in of_pair.filter_map(|(_, contact)| contact.friction) {
        let (sticks, fastest) = hold.unwrap_or((friction.sticks, 0.0));
        if sticks != friction.sticks {
            return None;
        }
        hold = Some((sticks, fastest.max(friction.slip_speed.abs())));
    }
    hold
}

fn sorted(contact: &ContactForce) -> [BodyId; 2] {
    let [a, b] = contact.bodies;
    if a <= b { [a, b] } else { [b, a] }
}

/// The set of a place: each set points to a later one, the last to itself.
fn root(sets: &[usize], mut place: usize) -> usize {
    while sets[place] != place {
        place = sets[place];
    }
    place
}
