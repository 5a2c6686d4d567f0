//! Recordings as tables of comma-separated values, whose headers give the units.
//!
//! Numbers have the shortest form that reads back as the same bits.

use super::Recording;
use crate::event::ContactForce;
use std::borrow::Cow;
use std::io::{self, Write};

/// Columns of a force; `connector` is empty for bodies that touch.
const FORCE_HEADER: &str = "primary,normal_body,connector,x [m],y [m],normal_x,normal_y,force [N]";

impl Recording {
    /// Writes a line for each movable body, and each that is moved, at each output time.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_states_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let header = "time [s],body,x [m],y [m],angle [rad],vx [m/s],vy [m/s],angular_velocity [rad/s]";
        writeln!(out, "{header}")?;
        let names: Vec<_> =
            self.movable.iter().chain(&self.moved).map(|&body| csv_field(self.name(body))).collect();
        for frame in &self.frames {
            for (name, state) in names.iter().zip(&frame.states) {
                let (position, velocity) = (state.position, state.velocity);
                let place = numbers([position.x, position.y, state.angle]);
                let speed = numbers([velocity.x, velocity.y, state.angular_velocity]);
                writeln!(out, "{:?},{name},{place},{speed}", frame.time)?;
            }
        }
        Ok(())
    }

    /// Writes a line for each row of each impact; column `connector` is empty for bodies that touch.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_impacts_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "impact,time [s],primary,normal_body,x [m],y [m],normal_x,normal_y,gap [m],")?;
        writeln!(
            out,
            "velocity_before [m/s],velocity_after [m/s],impulse [N s],energy_change_of_impact [J],connector"
        )?;
        for (index, impact) in self.impacts.iter().enumerate() {
            for row in &impact.rows {
                let (primary, normal) =
                    (csv_field(self.name(row.primary)), csv_field(self.name(row.normal_body)));
                let point = row.point.map_or_else(|| ",".to_owned(), |point| numbers([point.x, point.y]));
                let place = format!("{point},{}", numbers([row.normal.x, row.normal.y, row.gap]));
                let blow = numbers([row.velocity_before, row.velocity_after, row.impulse]);
                let connector = row.connector.map(|id| id.0.to_string()).unwrap_or_default();
                write!(out, "{index},{:?},{primary},{normal},{place},{blow},", impact.time)?;
                writeln!(out, "{:?},{connector}", impact.energy_change)?;
            }
        }
        Ok(())
    }

    /// Writes a line for each contact that began, ended or changed otherwise.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_contacts_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let further = Further::of(self.contacts.iter().map(|record| &record.event.contact));
        let any_jams = self.contacts.iter().any(|record| record.event.energy_change.is_some());
        let energy_change = if any_jams { ",energy_change [J]" } else { "" };
        writeln!(out, "change,time [s],{FORCE_HEADER}{}{energy_change}", further.header())?;
        for record in &self.contacts {
            write!(out, "{},{:?},", record.change.name(), record.event.time)?;
            self.write_force(out, &record.event.contact, further)?;
            write_number(out, record.event.energy_change, any_jams)?;
            writeln!(out)?;
        }
        Ok(())
    }

    /// Writes a line for each contact and each direction of a connector at each output time.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_forces_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let further = Further::of(self.frames.iter().flat_map(|frame| &frame.forces));
        writeln!(out, "time [s],{FORCE_HEADER}{}", further.header())?;
        for frame in &self.frames {
            for force in &frame.forces {
                write!(out, "{:?},", frame.time)?;
                self.write_force(out, force, further)?;
                writeln!(out)?;
            }
        }
        Ok(())
    }

    fn write_force(&self, out: &mut dyn Write, force: &ContactForce, further: Further) -> io::Result<()> {
        let [primary, normal] = force.bodies.map(|body| csv_field(self.name(body)));
        let connector = force.connector.map(|id| id.0.to_string()).unwrap_or_default();
        let point = force.point.map_or_else(|| ",".to_owned(), |point| numbers([point.x, point.y]));
        let told = numbers([force.normal.x, force.normal.y, force.force]);
        write!(out, "{primary},{normal},{connector},{point},{told}")?;
        write_number(out, force.torque, further.torque)?;
        match force.friction {
            Some(friction) => {
                let told = numbers([friction.force, friction.slip_speed, friction.cone_use()]);
                write!(out, ",{},{told}", friction.mode())?;
            }
            None if further.friction => write!(out, ",,,,")?,
            None => (),
        }
        write_number(out, force.rolling_moment, further.rolling)?;
        write_number(out, force.heat, further.heat)
    }

    /// Writes a line with the energies for each output time.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_energy_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "time [s],kinetic [J],potential [J],total [J]")?;
        for frame in &self.frames {
            let energy = &frame.energy;
            let told = numbers([frame.time, energy.kinetic, energy.potential, energy.total()]);
            writeln!(out, "{told}")?;
        }
        Ok(())
    }
}

/// Further columns of forces: where any row is a torque, where any contact has friction, where any resists rolling, and where any is told its heat.
#[derive(Clone, Copy, Debug, Default)]
struct Further {
    torque: bool,
    friction: bool,
    rolling: bool,
    heat: bool,
}

impl Further {
    fn of<'a>(forces: impl Iterator<Item = &'a ContactForce>) -> Self {
        forces.fold(Self::default(), |further, force| Self {
            torque: further.torque || force.torque.is_some(),
            friction: further.friction || force.friction.is_some(),
            rolling: further.rolling || force.rolling_moment.is_some(),
            heat: further.heat || force.heat.is_some(),
        })
    }

    fn header(self) -> String {
        let torque = if self.torque { ",torque [N m]" } else { "" };
        let friction = if self.friction { ",mode,friction_force [N],slip_speed [m/s],cone_use" } else { "" };
        let rolling = if self.rolling { ",rolling_moment [N m]" } else { "" };
        let heat = if self.heat { ",heat [J]" } else { "" };
        format!("{torque}{friction}{rolling}{heat}")
    }
}

/// Writes a number behind a comma, or nothing behind one where the table has a column for it.
fn write_number(out: &mut dyn Write, number: Option<f64>, has_column: bool) -> io::Result<()> {
    match number {
        Some(number) => write!(out, ",{number:?}"),
        None if has_column => write!(out, ","),
        None => Ok(()),
    }
}

/// Joins numbers by commas.
fn numbers<const COUNT: usize>(values: [f64; COUNT]) -> String {
    values.map(|value| format!("{value:?}")).join(",")
}

/// Returns a text as a field of a CSV table: in quotes if it contains a comma, a quote or a line break (RFC 4180).
#[must_use]
pub fn csv_field(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_awkward_names_are_csv_field() {
        assert_eq!(csv_field("big ball"), "big ball");
        assert_eq!(csv_field("a,\"b\""), "\"a,\"\"b\"\"\"");
    }
}
