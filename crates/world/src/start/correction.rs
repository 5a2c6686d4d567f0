//! Least corrections, weighted by mass, that satisfy rows: displacements for gaps, changes of velocity for rates.

use super::joined::{name_of, rows};
use super::moving;
use crate::builder::Joints;
use crate::world::Named;
use crate::world_error::{ConnectorName, WorldError};
use glam::DVec2;
use halfgap_advance::rigid::BodyPart;
use halfgap_collision::{BodyId, Collision, Connector, ConnectorKind, ConnectorSample, Tolerances};
use halfgap_contact::{DualActiveSet, InverseInertia, Problem, ProblemBody, Row, Settings, Solution, Solver};

/// Contradiction between dependent connectors, as a fraction of the largest gap, that a round may leave to the next:
/// gaps are curved, so those of a linkage with more bars than it needs agree only to second order.
const INCONSISTENCY: f64 = 1e-2;
/// Largest angle [rad] by which a round turns a body: beyond it, gaps are curved by too much.
const LARGEST_TURN: f64 = 0.1;
/// Rate of a connector that counts as zero, in machine epsilons of the velocities that make it up.
const RATE_ROUNDINGS: f64 = 64.0;

/// One row of a correction: J over (A, B), and the gap [m] or rate [m/s] that it is to undo.
#[derive(Clone, Copy)]
struct Correction {
    bodies: [BodyId; 2],
    jacobian: [f64; 6],
    /// A third body, with the coefficient [m] of its rotation.
    third: Option<(BodyId, f64)>,
    offset: f64,
    bilateral: bool,
}

/// Moves the bodies so that gaps and connectors come to fit, to first order, or a fraction of the way. Returns that
/// fraction, 1 for all of it; `None` if no displacement fits.
pub(super) fn correct_positions(
    bodies: &mut [BodyPart],
    records: &[Collision],
    connectors: &Joints,
) -> Option<f64> {
    let corrections: Vec<_> = records.iter().map(lift).chain(join(bodies, connectors)).collect();
    apply(bodies, &corrections)
}

/// Moves the bodies so that the `held` gaps come to their target, from either side, and others are lifted where they
/// are too small. Returns as [`correct_positions`] does.
pub(super) fn bring_to_target(
    bodies: &mut [BodyPart],
    held: &[Collision],
    others: &[Collision],
    connectors: &Joints,
) -> Option<f64> {
    let to_target = |record: &Collision| Correction {
        offset: record.distance_to_target(),
        bilateral: true,
        ..lift(record)
    };
    let contacts = held.iter().map(to_target).chain(others.iter().map(lift));
    let corrections: Vec<_> = contacts.chain(join(bodies, connectors)).collect();
    apply(bodies, &corrections)
}

fn apply(bodies: &mut [BodyPart], corrections: &[Correction]) -> Option<f64> {
    let changes = least_changes(bodies, corrections)?;
    let turn = changes.iter().fold(0.0f64, |most, change| most.max(change[2].abs()));
    let share = if turn > LARGEST_TURN { LARGEST_TURN / turn } else { 1.0 };
    for (BodyPart { state, .. }, change) in bodies.iter_mut().zip(changes) {
        state.position += share * DVec2::new(change[0], change[1]);
        state.angle += share * change[2];
    }
    Some(share)
}

/// True if a gap can be lifted while the connectors come to fit, with all other contacts left out.
pub(super) fn can_lift(bodies: &[BodyPart], record: &Collision, connectors: &Joints) -> bool {
    let corrections: Vec<_> = std::iter::once(lift(record)).chain(join(bodies, connectors)).collect();
    least_changes(bodies, &corrections).is_some()
}

fn lift(record: &Collision) -> Correction {
    let (above, accuracy) = (record.distance_to_target(), record.tolerances.accuracy);
    Correction {
        bodies: record.bodies(),
        jacobian: record.motion.kinematics.jacobian,
        third: None,
        // A gap that is in the zone already may move within it.
        offset: if above < -accuracy { above } else { above + accuracy },
        bilateral: false,
    }
}

fn join<'a>(bodies: &'a [BodyPart], connectors: &'a Joints) -> impl Iterator<Item = Correction> + use<'a> {
    rows(bodies, connectors).map(|(_, connector, sample)| Correction {
        bodies: connector.bodies(),
        jacobian: sample.kinematics.jacobian,
        third: connector.third(),
        offset: sample.gap,
        bilateral: connector.is_bilateral(),
    })
}

/// Changes the velocities so that no bilateral connector comes apart. Returns the connector that came apart fastest,
/// and its rate [m/s]. Where connectors contradict each other, velocities are left as they are if no connector comes
/// apart faster than the speed that counts as slow.
pub(super) fn correct_velocities(
    bodies: &mut [BodyPart],
    named: &[Named],
    connectors: &Joints,
    tolerances: &Tolerances,
) -> Result<Option<(ConnectorName, f64)>, WorldError> {
    let bilateral = rows(bodies, connectors).filter(|(_, connector, _)| connector.is_bilateral());
    let (mut corrections, mut of, mut worst) = (Vec::new(), Vec::new(), None::<(usize, f64)>);
    for (index, connector, sample) in bilateral {
        let sample = along_corner(bodies, connector, tolerances.accuracy).unwrap_or(sample);
        let (jacobian, rate) = (sample.kinematics.jacobian, sample.kinematics.rate);
        let (ends, third) = (connector.bodies(), connector.third());
        let size = rate_size(bodies, ends, &jacobian) + turning_size(bodies, third);
        if rate.abs() > RATE_ROUNDINGS * f64::EPSILON * size
            && worst.is_none_or(|(_, largest)| rate.abs() > largest)
        {
            worst = Some((index, rate.abs()));
        }
        of.push(index);
        corrections.push(Correction { bodies: ends, jacobian, third, offset: rate, bilateral: true });
    }
    let Some((index, rate)) = worst else { return Ok(None) };
    let Some(changes) = least_changes(bodies, &corrections) else {
        let connector = name_of(index, named, connectors);
        return if rate <= tolerances.velocity_tol {
            Ok(None)
        } else {
            // Which other one stands against it?
            let fits_without = |other: &usize| {
                let left: Vec<_> = corrections
                    .iter()
                    .zip(&of)
                    .filter(|(_, index)| *index != other)
                    .map(|(&correction, _)| correction)
                    .collect();
                least_changes(bodies, &left).is_some()
            };
            let mut others: Vec<usize> = of.iter().copied().filter(|&other| other != index).collect();
            others.dedup();
            let against = others.iter().rev().find(|other| fits_without(other));
            let against = against.map(|&other| Box::new(name_of(other, named, connectors)));
            Err(WorldError::ConnectorComesApart { connector, rate, against })
        };
    };
    for (BodyPart { state, .. }, change) in bodies.iter_mut().zip(changes) {
        state.velocity += DVec2::new(change[0], change[1]);
        state.angular_velocity += change[2];
    }
    Ok(Some((name_of(index, named, connectors), rate)))
}

/// Returns the row of a rail whose point is within a distance [m] of a corner: that of the side along which it moves.
fn along_corner(bodies: &[BodyPart], connector: &Connector, within: f64) -> Option<ConnectorSample> {
    let ConnectorKind::Rail { a: anchor, path } = &connector.kind else { return None };
    let [a, b] = connector.bodies().map(|body| moving(bodies, body));
    let sides = path.corner_at(a.pose.point_to_world(anchor.point), within)?;
    let samples = sides.map(|side| connector.measure_near(0, &a, &b, Some(&side)));
    samples.into_iter().min_by(|p, q| p.kinematics.rate.abs().total_cmp(&q.kinematics.rate.abs()))
}

/// Size of the speeds whose difference a rate is [m/s]. Components across the row count, too: the direction of a row is
/// known to rounding only.
fn rate_size(bodies: &[BodyPart], ends: [BodyId; 2], jacobian: &[f64; 6]) -> f64 {
    let sizes = ends.iter().zip(jacobian.chunks_exact(3)).map(|(end, part)| {
        let Some(BodyPart { body, state, .. }) = bodies.get(end.index()) else { return 0.0 };
        let arm = part[2].abs().max(body.shape.reach());
        DVec2::new(part[0], part[1]).length() * state.velocity.length() + arm * state.angular_velocity.abs()
    });
    sizes.sum()
}

/// Size of the part [m/s] of a rate that is of a third body.
fn turning_size(bodies: &[BodyPart], third: Option<(BodyId, f64)>) -> f64 {
    let of_body =
        |(body, j): (BodyId, f64)| Some((j * bodies.get(body.index())?.state.angular_velocity).abs());
    third.and_then(of_body).unwrap_or(0.0)
}

/// Returns the change of (x, y, angle) of each body, least in the mass metric, that undoes all rows; `None` if there is
/// none.
fn least_changes(bodies: &[BodyPart], corrections: &[Correction]) -> Option<Vec<[f64; 3]>> {
    let mut problem = Problem::new();
    for BodyPart { body, .. } in bodies {
        let inertia = InverseInertia { inverse_mass: body.inverse_mass, inverse_moment: body.inverse_moment };
        problem.add_body(inertia).ok()?;
    }
    let background = problem.add_body(InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 }).ok()?;
    for Correction { bodies, jacobian: j, third, offset, bilateral } in corrections {
        let id = |body: BodyId| if body.is_world() { background } else { ProblemBody(body.0) };
        let [primary, normal] = bodies.map(id);
        let row = Row::new(primary, [j[0], j[1], j[2]], *offset).against(normal, [j[3], j[4], j[5]]);
        let row = Row { third: third.map(|(body, j)| (id(body), j)), ..row };
        problem.add_row(&if *bilateral { row.bilateral() } else { row }).ok()?;
    }
    let settings = Settings { inconsistency: INCONSISTENCY, ..Settings::default() };
    let mut solution = Solution::new();
    DualActiveSet::new(settings).ok()?.solve(&problem, &mut solution).ok()?;
    let mut changes = vec![[0.0; 3]; bodies.len()];
    for (Correction { bodies: ends, jacobian, third, .. }, &force) in corrections.iter().zip(&solution.force)
    {
        for (end, part) in ends.iter().zip(jacobian.chunks_exact(3)) {
            let Some(BodyPart { body, .. }) = bodies.get(end.index()) else { continue };
            let change = &mut changes[end.index()];
            let inverse = [body.inverse_mass, body.inverse_mass, body.inverse_moment];
            for (place, entry) in part.iter().enumerate() {
                change[place] += entry * inverse[place] * force;
            }
        }
        if let Some((end, j)) = third
            && let Some(BodyPart { body, .. }) = bodies.get(end.index())
        {
            changes[end.index()][2] += j * body.inverse_moment * force;
        }
    }
    Some(changes)
}
