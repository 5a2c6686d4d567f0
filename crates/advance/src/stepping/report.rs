//! What callers are told of impacts, and of contacts that begin and end.

use crate::rigid::{ImpactReport, RowForce, RowReport};
use crate::stepping::bodies::{Bodies, Motion3};
use crate::stepping::contacts::measure;
use crate::stepping::pairs::{Pair, Pairs};
use crate::stepping::rows::{Row, Rows, Source};
use crate::stepping::settings::SteppingSettings;
use crate::stepping::step::Scene;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, Collision, ConnectorId, Moment, Moving, record_features};
use halfgap_geometry::{FeatureId, GapSample};

/// Adds the rows of an impact that have struck, with their rates before and after it.
pub(super) fn add_rows<'a>(
    (scene, settings): (&Scene, &SteppingSettings),
    rows: impl Iterator<Item = &'a Row>,
    (before, after): (&[Motion3], &[Motion3]),
    report: &mut ImpactReport,
) {
    let (bodies, time) = (&scene.bodies, report.time.seconds());
    let tolerances = &settings.rigid.tolerances;
    for row in rows {
        let ids = row.bodies(bodies.count());
        let moving = ids.map(|body| bodies.moving(body));
        let record = match row.source {
            Source::Contact { pair, contact } => {
                let pair = &scene.pairs.all()[pair as usize];
                let moments = pair.bodies.map(|id| Moment {
                    id,
                    body: &bodies.natures[id.index()].body,
                    moving: bodies.movings[id.index()],
                });
                let features = pair.contacts[contact as usize].features;
                record_features([&moments[0], &moments[1]], features, tolerances, time)
            }
            Source::Connector { connector, direction } => {
                let sample = scene.ties.measure(bodies, (connector as usize, direction as usize), time);
                let (id, tie) = (ConnectorId(connector), &scene.ties.all[connector as usize]);
                let sides: [&Moving; 2] = [&moving[0], &moving[1]];
                Some(Collision::of_connector(id, direction, tie, &sample, sides, tolerances, time))
            }
        };
        let Some(collision) = record else { continue };
        let (rate_before, rate_after) =
            (row.strikes.map_or(row.rate(before), |speed| -speed), row.rate(after));
        report.add(RowReport { collision, rate_before, rate_after, impulse: row.blows[0] }, 0.0);
    }
}

impl Row {
    /// What callers are told of the row, which carries a force [N] along its normal.
    pub(super) fn told(&self, (bodies, pairs): (&Bodies, &Pairs), force: f64) -> RowForce {
        let (connector, features) = match self.source {
            Source::Contact { pair, contact } => {
                (None, Some(pairs.all()[pair as usize].contacts[contact as usize].features))
            }
            Source::Connector { connector, .. } => (Some(ConnectorId(connector)), None),
        };
        let [x, y, turning, ..] = self.normal.jacobian();
        let place = (self.point, DVec2::new(x, y), turning);
        RowForce::along(self.bodies(bodies.count()), (connector, features), place, force)
    }
}

impl Pair {
    /// What callers are told of a contact without a row, which carries a force [N], where it is measured.
    pub(super) fn told(&self, features: [FeatureId; 2], sample: &GapSample, force: f64) -> RowForce {
        let [a, b] = self.bodies;
        let bodies = if sample.primary_is_a { [a, b] } else { [b, a] };
        RowForce::along(bodies, (None, Some(features)), (sample.point_primary, sample.normal, 0.0), force)
    }
}

/// Forces of all rows of a step that begins at a time [s], of those that carry one, and then those between bodies that sleep.
pub(super) fn row_forces(scene: &Scene, rows: &Rows, time: f64) -> Vec<RowForce> {
    let Scene { bodies, pairs, ties, sleep, .. } = scene;
    let sleeps = |body: BodyId| bodies.is_fixed(body) || sleep.is_asleep(body.index());
    let mut all = Vec::new();
    for row in rows.all.iter().filter(|row| !row.bodies(bodies.count()).into_iter().all(sleeps)) {
        let force = match row.source {
            Source::Contact { pair, contact } => {
                pairs.all()[pair as usize].contacts[contact as usize].forces[0]
            }
            Source::Connector { connector, direction } => {
                ties.memory[connector as usize].forces[direction as usize]
            }
        };
        all.extend((force != 0.0).then(|| row.told((bodies, pairs), force)));
    }
    for pair in pairs.all().iter().filter(|pair| pair.bodies.into_iter().all(sleeps)) {
        let sides = pair.bodies.map(|body| {
            let place = body.index();
            (&bodies.natures[place].body.shape, &bodies.movings[place])
        });
        for contact in pair.contacts.iter().filter(|contact| contact.is_told) {
            let told = |sample| pair.told(contact.features, &sample, contact.forces[0]);
            all.extend(measure(sides, contact.features).map(told));
        }
    }
    let tied = ties.all.iter().zip(&ties.memory).enumerate();
    for (index, (connector, tie)) in tied.filter(|(_, (tie, _))| tie.all_bodies().all(sleeps)) {
        for (direction, &force) in tie.forces.iter().enumerate().filter(|&(_, &force)| force != 0.0) {
            let sample = ties.measure(bodies, (index, direction), time);
            let [x, y, turning, ..] = sample.kinematics.jacobian;
            let place = (sample.point_a, DVec2::new(x, y), turning);
            let origin = (Some(ConnectorId(index as u32)), None);
            all.push(RowForce::along(connector.bodies(), origin, place, force));
        }
    }
    all
}

/// A force that begins, or the last one of what ends [N].
#[derive(Clone, Copy, Debug)]
pub(super) enum Change {
    Begins(f64),
    Ends(f64),
}

impl Change {
    /// What callers are to be told of a unilateral row that carried a force `last` [N] and now carries `force`, if they do not know it yet.
    pub(super) fn of(is_told: &mut bool, last: f64, force: f64) -> Option<Self> {
        let carries = force > 0.0;
        let change = if carries { Self::Begins(force) } else { Self::Ends(last) };
        (std::mem::replace(is_told, carries) != carries).then_some(change)
    }
}

impl Bodies {
    /// State of a body at the start of the present step, with given velocities.
    pub(super) fn state_with(&self, place: usize, [x, y, spin]: Motion3) -> BodyState {
        let course = &self.courses[place];
        BodyState {
            position: course.position,
            angle: course.angle,
            velocity: DVec2::new(x, y),
            angular_velocity: spin,
        }
    }
}
