//! Recordings as JSON, format `halfgap-recording-1`: bodies, states, energies, forces, events and the energy ledger in
//! one object.

use super::{ContactRecord, Frame, Recording};
use crate::event::{ContactForce, Impact, ImpactRow};
use crate::ledger::Ledger;
use serde::Serialize;
use std::io::{self, Write};

#[derive(Serialize)]
struct RecordingJson<'a> {
    format: &'static str,
    scene: &'a str,
    units: &'static str,
    bodies: Vec<BodyJson<'a>>,
    movable: Vec<&'a str>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    moved: Vec<&'a str>,
    frames: Vec<FrameJson<'a>>,
    impacts: Vec<ImpactJson<'a>>,
    contacts: Vec<ContactJson<'a>>,
    ledger: &'a Ledger,
}

#[derive(Serialize)]
struct BodyJson<'a> {
    name: &'a str,
    fixed: bool,
}

/// States as `[x, y, angle, vx, vy, angular_velocity]`, in the order of `movable`, then of `moved`.
#[derive(Serialize)]
struct FrameJson<'a> {
    time: f64,
    states: Vec<[f64; 6]>,
    kinetic: f64,
    potential: f64,
    total: f64,
    forces: Vec<ForceJson<'a>>,
}

#[derive(Serialize)]
struct ForceJson<'a> {
    primary: &'a str,
    normal_body: &'a str,
    connector: Option<u32>,
    point: Option<[f64; 2]>,
    normal: [f64; 2],
    force: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    torque: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    friction: Option<FrictionJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rolling_moment: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    heat: Option<f64>,
}

#[derive(Serialize)]
struct FrictionJson {
    mode: &'static str,
    force: f64,
    slip_speed: f64,
    cone_use: f64,
}

#[derive(Serialize)]
struct ContactJson<'a> {
    change: &'static str,
    time: f64,
    #[serde(flatten)]
    contact: ForceJson<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    energy_change: Option<f64>,
}

#[derive(Serialize)]
struct ImpactJson<'a> {
    time: f64,
    energy_change: f64,
    rows: Vec<RowJson<'a>>,
}

#[derive(Serialize)]
struct RowJson<'a> {
    primary: &'a str,
    normal_body: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    connector: Option<u32>,
    point: Option<[f64; 2]>,
    normal: [f64; 2],
    gap: f64,
    velocity_before: f64,
    velocity_after: f64,
    impulse: f64,
}

impl Recording {
    /// Writes the recording as one JSON object.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        let bodies = self.bodies.iter().map(|body| BodyJson { name: &body.name, fixed: body.fixed });
        let json = RecordingJson {
            format: "halfgap-recording-1",
            scene: &self.title,
            units: "SI, radians; states are [x, y, angle, vx, vy, angular_velocity] of the movable bodies",
            bodies: bodies.collect(),
            movable: self.movable.iter().map(|&body| self.name(body)).collect(),
            moved: self.moved.iter().map(|&body| self.name(body)).collect(),
            frames: self.frames.iter().map(|frame| self.frame_json(frame)).collect(),
            impacts: self.impacts.iter().map(|impact| self.impact_json(impact)).collect(),
            contacts: self.contacts.iter().map(|record| self.contact_json(record)).collect(),
            ledger: &self.ledger,
        };
        serde_json::to_writer(&mut *out, &json)?;
        writeln!(out)
    }

    fn impact_json(&self, impact: &Impact) -> ImpactJson<'_> {
        let rows = impact.rows.iter().map(|row| self.row_json(row)).collect();
        ImpactJson { time: impact.time, energy_change: impact.energy_change, rows }
    }

    fn row_json(&self, row: &ImpactRow) -> RowJson<'_> {
        RowJson {
            primary: self.name(row.primary),
            normal_body: self.name(row.normal_body),
            connector: row.connector.map(|id| id.0),
            point: row.point.map(|point| point.to_array()),
            normal: row.normal.to_array(),
            gap: row.gap,
            velocity_before: row.velocity_before,
            velocity_after: row.velocity_after,
            impulse: row.impulse,
        }
    }

    fn force_json(&self, force: &ContactForce) -> ForceJson<'_> {
        let [primary, normal_body] = force.bodies.map(|body| self.name(body));
        ForceJson {
            primary,
            normal_body,
            connector: force.connector.map(|id| id.0),
            point: force.point.map(|point| point.to_array()),
            normal: force.normal.to_array(),
            force: force.force,
            torque: force.torque,
            friction: force.friction.map(|friction| FrictionJson {
                mode: friction.mode(),
                force: friction.force,
                slip_speed: friction.slip_speed,
                cone_use: friction.cone_use(),
            }),
            rolling_moment: force.rolling_moment,
            heat: force.heat,
        }
    }

    fn contact_json(&self, record: &ContactRecord) -> ContactJson<'_> {
        ContactJson {
            change: record.change.name(),
            time: record.event.time,
            contact: self.force_json(&record.event.contact),
            energy_change: record.event.energy_change,
        }
    }

    fn frame_json(&self, frame: &Frame) -> FrameJson<'_> {
        let states = frame.states.iter().map(|state| {
            let (position, velocity) = (state.position, state.velocity);
            [position.x, position.y, state.angle, velocity.x, velocity.y, state.angular_velocity]
        });
        FrameJson {
            time: frame.time,
            states: states.collect(),
            kinetic: frame.energy.kinetic,
            potential: frame.energy.potential,
            total: frame.energy.total(),
            forces: frame.forces.iter().map(|force| self.force_json(force)).collect(),
        }
    }
}
