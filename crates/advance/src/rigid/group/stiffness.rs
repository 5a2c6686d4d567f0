//! What is known of the fastest rate of a group.

/// Experience with the fastest rate of a group.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Stiffness {
    /// Steps are implicit.
    pub(super) is_stiff: bool,
    /// Implicit steps have served before.
    pub(super) is_known: bool,
    /// The fastest rate [1/s], as last estimated.
    pub(super) rate: f64,
    /// The rate [1/s] of the steepest forces by probes, where rounding of positions may matter; estimates from short
    /// steps do not show it. 0 where it does not matter.
    pub(super) steep: f64,
    /// Number of such probes, which tells the direction of the next.
    pub(super) probes: u32,
    /// Number of held-up steps less that of others, at least 0.
    pub(super) held_up: u32,
    /// Number of steps until the next estimate.
    pub(super) wait: u32,
    /// Length [s] of the last step with an estimate.
    pub(super) looked: f64,
    /// Cost that implicit steps have saved so far, in explicit steps; negative if they cost more.
    pub(super) saved: f64,
    /// Number of times that implicit steps were given up since they last saved something.
    pub(super) in_vain: u32,
}

impl Stiffness {
    /// The more telling experience of two, for bodies that come to share their steps.
    pub(crate) fn or(self, other: Self) -> Self {
        let first_tells = (self.is_known, self.rate) >= (other.is_known, other.rate);
        let told = if first_tells { self } else { other };
        Self { in_vain: self.in_vain.max(other.in_vain), ..told }
    }

    /// True if steps are implicit.
    pub(crate) fn is_stiff(&self) -> bool {
        self.is_stiff
    }

    /// True if the fastest rate allows an explicit step of a length [s].
    pub(crate) fn allows(&self, step: f64) -> bool {
        self.rate * step < 1.0
    }
}
