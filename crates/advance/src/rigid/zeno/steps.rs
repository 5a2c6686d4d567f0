//! The recent steps of a group, and their mean length.

use crate::time::Time;

/// Number of steps in succession over which one mean length is taken.
pub(crate) const STEPS: u32 = 10_000;

/// Number of steps in succession over whose mean length a group is found to be hasty.
pub(crate) const FEW_STEPS: u32 = 64;

/// The recent steps of a group, kept for the body that leads it.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Pace {
    pub(super) all: Count<STEPS>,
    pub(super) few: Count<FEW_STEPS>,
    /// Number of hopeless means in succession.
    pub(super) hopeless: u32,
    pub(super) is_hasty: bool,
}

/// Takes the mean length of every `STEPS` steps.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Count<const STEPS: u32> {
    /// Time at which counting began; `None` if it has not.
    since: Option<Time>,
    steps: u32,
}

impl<const STEPS: u32> Count<STEPS> {
    /// Notes a step that begins at a time; after every `STEPS` steps returns their mean length [s].
    pub(super) fn note(&mut self, start: Time) -> Option<f64> {
        let since = *self.since.get_or_insert(start);
        if self.steps < STEPS {
            self.steps += 1;
            return None;
        }
        *self = Self { since: Some(start), steps: 1 };
        Some(start.since(since) / f64::from(STEPS))
    }
}
