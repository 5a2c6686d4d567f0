//! Repetitions of a run: their wall times, and a check that all give the same bits.

use halfgap::{Outcome, RunResult};
use std::num::NonZeroUsize;

/// Wall times of the repetitions of a run, and whether they gave the same.
#[derive(Debug, Default)]
pub(crate) struct Repeats {
    /// Wall times [s], of the runs that have one.
    walls: Vec<f64>,
    /// The first result without its wall time, as text.
    first: Option<String>,
    /// Number of runs.
    pub(crate) count: usize,
    /// Number of the first run, from 1, that differs from the first.
    pub(crate) differs: Option<usize>,
}

impl Repeats {
    /// Makes `count` runs in all, of which `result` is the first, and puts the least wall time and the median into it.
    /// An interrupted run ends them and does not count.
    pub(crate) fn make<E>(
        result: &mut RunResult,
        count: NonZeroUsize,
        mut again: impl FnMut() -> Result<RunResult, E>,
    ) -> Result<Self, E> {
        let mut repeats = Self::default();
        repeats.add(result);
        while repeats.count < count.get() {
            let one = again()?;
            if one.status == Outcome::Interrupted {
                break;
            }
            repeats.add(&one);
        }
        repeats.write(result);
        Ok(repeats)
    }

    /// Adds the result of a run.
    fn add(&mut self, result: &RunResult) {
        self.count += 1;
        self.walls.extend(result.statistics.wall_seconds);
        let text = without_times(result);
        let first = self.first.get_or_insert_with(|| text.clone());
        if *first != text && self.differs.is_none() {
            self.differs = Some(self.count);
        }
    }

    /// Puts the least wall time and the median into a result.
    fn write(&self, result: &mut RunResult) {
        let mut walls = self.walls.clone();
        walls.sort_unstable_by(f64::total_cmp);
        result.statistics.wall_seconds = walls.first().copied();
        result.statistics.wall_seconds_median = median(&walls);
    }
}

/// All bits of a result but its wall times and its error estimate: the shortest digits that read back as the same bits.
fn without_times(result: &RunResult) -> String {
    let mut result = RunResult { error_estimate: None, ..result.clone() };
    result.statistics.wall_seconds = None;
    result.statistics.wall_seconds_median = None;
    result.to_json()
}

/// Returns the median of ascending numbers: the middle one of an odd number of them, the mean of the two in the middle
/// of an even number; `None` of none.
fn median(ascending: &[f64]) -> Option<f64> {
    let middle = ascending.len() / 2;
    let upper = ascending.get(middle)?;
    let is_odd = ascending.len() % 2 == 1;
    Some(if is_odd { *upper } else { 0.5 * (ascending[middle - 1] + upper) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use halfgap::scene::{Scene, SceneFormat};
    use halfgap::{Record, RunPlan, World, run, unwatched};

    fn result() -> RunResult {
        let text = "format = \"halfgap-scene-1\"\ntitle = \"flight\"\nrun = { duration = 1.0 }\n[[body]]\nname = \"disc\"\n\
            mass = 1.0\nvelocity = [1.0, 0.0]\nshape = { disc = { radius = 1.0 } }\n";
        let scene = Scene::parse(text, SceneFormat::Toml).expect("a good scene");
        let mut world = World::from_scene(&scene).expect("a world");
        let report = run(&mut world, &RunPlan::of_scene(&scene, Record::Ends), &mut unwatched);
        RunResult::new(&world, &report)
    }

    #[test]
    fn the_least_time_counts_and_the_median_is_in_the_middle() {
        let mut repeats = Repeats::default();
        let mut one = result();
        for (wall, median) in [(3.0, 3.0), (1.0, 2.0), (8.0, 3.0), (4.0, 3.5)] {
            one.statistics.wall_seconds = Some(wall);
            repeats.add(&one);
            let mut told = one.clone();
            repeats.write(&mut told);
            assert_eq!(told.statistics.wall_seconds_median, Some(median));
        }
        repeats.write(&mut one);
        assert_eq!((one.statistics.wall_seconds, repeats.count, repeats.differs), (Some(1.0), 4, None));
        assert_eq!(median(&[]), None);
    }

    #[test]
    fn a_run_that_differs_in_one_bit_is_found() {
        let (mut repeats, one) = (Repeats::default(), result());
        repeats.add(&one);
        repeats.add(&one);
        assert_eq!(repeats.differs, None);
        let mut other = one.clone();
        other.bodies[0].1.position.x = other.bodies[0].1.position.x.next_up();
        repeats.add(&other);
        repeats.add(&one);
        assert_eq!(repeats.differs, Some(3));
    }
}
