//! What callers are told of impacts.

use crate::rigid::{ImpactReport, RowReport};
use crate::stepping::bodies::{Bodies, Motion3};
use crate::stepping::rows::{Row, Source};
use crate::stepping::settings::SteppingSettings;
use crate::stepping::step::Scene;
use glam::DVec2;
use halfgap_collision::{BodyState, Collision, ConnectorId, Moment, Moving, record_features};

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
                let sample = scene.ties.measure(bodies, connector as usize, direction as usize);
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
