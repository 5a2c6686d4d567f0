//! The values of all probes at all output times.

use super::{Probe, Quantity};
use crate::recording::{Recording, csv_field};
use crate::world::World;
use std::io::{self, Write};

/// Values of some probes in all frames of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbeTable {
    columns: Vec<(String, Quantity)>,
    times: Vec<f64>,
    /// Values frame by frame.
    values: Vec<f64>,
}

impl ProbeTable {
    /// Reads the probes from a recording of a world. Fixed bodies are where they are now.
    #[must_use]
    pub fn of(probes: &[Probe], world: &World, recording: &Recording) -> Self {
        let columns = probes.iter().flat_map(|probe| {
            probe.quantities(world).into_iter().map(|quantity| (probe.name.clone(), quantity))
        });
        let columns: Vec<_> = columns.collect();
        let mut values = Vec::with_capacity(columns.len() * recording.frames.len());
        for frame in &recording.frames {
            for probe in probes {
                probe.measure(world, recording, frame, &mut values);
            }
        }
        Self { columns, times: recording.frames.iter().map(|frame| frame.time).collect(), values }
    }

    /// The columns: the name of the probe, and the quantity with its unit.
    #[must_use]
    pub fn columns(&self) -> &[(String, Quantity)] {
        &self.columns
    }

    /// The times [s].
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The values of a column, by its place.
    pub fn column(&self, place: usize) -> impl Iterator<Item = f64> {
        self.values.iter().skip(place).step_by(self.columns.len().max(1)).copied()
    }

    /// Writes a line for each output time.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "time [s]")?;
        for (name, (quantity, unit)) in &self.columns {
            write!(out, ",{}", csv_field(&format!("{name} {quantity} [{unit}]")))?;
        }
        writeln!(out)?;
        for (time, values) in self.times.iter().zip(self.values.chunks(self.columns.len().max(1))) {
            write!(out, "{time:?}")?;
            values.iter().try_for_each(|value| write!(out, ",{value:?}"))?;
            writeln!(out)?;
        }
        Ok(())
    }
}
