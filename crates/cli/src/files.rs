//! The folder that `--out` names: recording, result and pictures.

use crate::failure::Failure;
use halfgap::picture::{ScenePictures, energy_picture, events_picture, probes_picture};
use halfgap::{Frame, Probe, ProbeTable, Recording, RunError, RunResult, World};
use halfgap_contact::ContactFile;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Makes the folder before the run, so that a run is not lost to a bad path.
pub(crate) fn prepare(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| Failure::Write(folder.to_path_buf(), error))
}

/// Writes all files, with pictures of the start, the end, and `pictures` times in between.
pub(crate) fn write_all(
    folder: &Path,
    world: &World,
    recording: &Recording,
    result: &RunResult,
    (probes, pictures): (&[Probe], usize),
) -> Result<(), Failure> {
    write(folder, "states.csv", |out| recording.write_states_csv(out))?;
    write(folder, "impacts.csv", |out| recording.write_impacts_csv(out))?;
    write(folder, "contacts.csv", |out| recording.write_contacts_csv(out))?;
    write(folder, "forces.csv", |out| recording.write_forces_csv(out))?;
    write(folder, "energy.csv", |out| recording.write_energy_csv(out))?;
    write(folder, "recording.json", |out| recording.write_json(out))?;
    write(folder, "result.json", |out| writeln!(out, "{}", result.to_json()))?;
    write_probes(folder, probes, world, recording)?;
    let scene = ScenePictures::new(world, recording);
    let mut ends = Vec::new();
    ends.extend(recording.frames.first().map(|frame| ("start.svg", frame)));
    ends.extend(recording.frames.last().map(|frame| ("end.svg", frame)));
    for (name, frame) in ends {
        write(folder, name, |out| out.write_all(scene.at(frame).as_bytes()))?;
    }
    for (index, frame) in evenly(&recording.frames, pictures).enumerate() {
        let name = picture_name(index);
        write(folder, &name, |out| out.write_all(scene.at(frame).as_bytes()))?;
    }
    remove_further(folder, evenly(&recording.frames, pictures).count())?;
    write(folder, "energy.svg", |out| out.write_all(energy_picture(recording).as_bytes()))?;
    write(folder, "events.svg", |out| out.write_all(events_picture(recording).as_bytes()))
}

const PROBES: [&str; 2] = ["probes.csv", "probes.svg"];

/// Writes what probes tell. Without any, what an earlier run has left is removed.
fn write_probes(
    folder: &Path,
    probes: &[Probe],
    world: &World,
    recording: &Recording,
) -> Result<(), Failure> {
    let [csv, svg] = PROBES;
    if probes.is_empty() {
        return PROBES.into_iter().try_for_each(|name| remove(&folder.join(name)));
    }
    let table = ProbeTable::of(probes, world, recording);
    write(folder, csv, |out| table.write_csv(out))?;
    let picture = probes_picture(&recording.title, &table);
    write(folder, svg, |out| out.write_all(picture.as_bytes()))
}

/// Removes a file that an earlier run has left, if it is there.
fn remove(path: &Path) -> Result<(), Failure> {
    let is_there = path.exists();
    if is_there {
        std::fs::remove_file(path).map_err(|error| Failure::Write(path.to_path_buf(), error))
    } else {
        Ok(())
    }
}

/// Name of the contact problem that stopped a run, in its folder.
pub(crate) const PROBLEM: &str = "problem.json";

/// Writes the contact problem that stopped a run, if that is why it stopped; true if there is one. One that an earlier run
/// has left is removed.
pub(crate) fn write_problem(folder: &Path, error: Option<&RunError>) -> Result<bool, Failure> {
    let path = folder.join(PROBLEM);
    let Some(RunError::Contacts { problem, .. }) = error else {
        remove(&path)?;
        return Ok(false);
    };
    let text = ContactFile::of(problem).to_json();
    write(folder, PROBLEM, |out| writeln!(out, "{}", text.map_err(io::Error::other)?))?;
    Ok(true)
}

fn picture_name(index: usize) -> String {
    format!("picture-{index:04}.svg")
}

/// Removes the pictures from index `count` on, left by an earlier run with more of them, lest they seem to be of this
/// run.
fn remove_further(folder: &Path, count: usize) -> Result<(), Failure> {
    let left = (count..).map(|index| folder.join(picture_name(index))).take_while(|path| path.exists());
    left.into_iter().try_for_each(|path| remove(&path))
}

/// Returns `count` frames between the first and the last, evenly over the run; all of them if there are fewer.
fn evenly(frames: &[Frame], count: usize) -> impl Iterator<Item = &Frame> {
    let last = frames.len().saturating_sub(1);
    let count = count.min(last.saturating_sub(1));
    (1..=count).map(move |index| &frames[index * last / (count + 1)])
}

fn write(
    folder: &Path,
    name: &str,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    let path = folder.join(name);
    let fill_file = || {
        let mut out = BufWriter::new(File::create(&path)?);
        fill(&mut out)?;
        out.flush()
    };
    fill_file().map_err(|error| Failure::Write(path.clone(), error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_spread_evenly_between_the_ends() {
        let frame = |index: u32| Frame {
            time: f64::from(index),
            states: Vec::new(),
            energy: halfgap::Energy::default(),
            forces: Vec::new(),
        };
        let frames: Vec<_> = (0..9).map(frame).collect();
        let times = |count| evenly(&frames, count).map(|frame| frame.time).collect::<Vec<_>>();
        assert!(times(0).is_empty());
        assert_eq!(times(1), [4.0]);
        assert_eq!(times(3), [2.0, 4.0, 6.0]);
        assert_eq!(times(100), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        assert_eq!(evenly(&[], 5).count(), 0);
    }
}
