//! Remedies: what is done in rare cases that no principle covers. Each has a name, a counter in the statistics, a switch for
//! tests, and, for all but one, a scene among the tests that fails without it; docs/lab/remedies.md lists them.
//!
//! The counters are atomic so that a system can be read from several threads; they change no motion.

use std::sync::atomic::{AtomicU64, Ordering};

/// A remedy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Remedy {
    /// Corners that pass over each other where two surfaces are flush are excluded from the search and from events.
    GhostCorners,
    /// Features and ropes that turn back by themselves before they touch, near a dead point of a mechanism, are let come nearer.
    DeadPoints,
    /// Contacts that fire again and again at one time fire at a lower gap, by more each time.
    Insistence,
    /// A body that slides along below its target gap fires later elsewhere, so that it does not run against seams.
    TriggerGaps,
    /// A contact that has fired although it did not close may sink as one at rest.
    OpenFiring,
    /// Corners that pass each other before they come to their target do not take part in an event.
    PassingBy,
    /// Contacts that have stayed within their zone since they were last seen meet without elasticity.
    LowBounces,
    /// Contacts that open so slowly that forces close them again within the zone become active at once.
    LowHops,
    /// Bodies with more events than forces can resolve are stopped without elasticity.
    Accumulation,
    /// In groups whose steps are very short, or that were ended at once, contacts that open ever so slowly become inactive.
    Haste,
    /// A group made anew at the time at which another was ended because a contact pulled may pull again at its start.
    Patience,
    /// Contacts farther apart than the gap at which bodies fire are excluded from impacts whose impulses cancel each other.
    JammedImpulses,
    /// A point that an impact drives off both sides of its corner is kept on one of them.
    HeldInCorner,
    /// A point that two forces do not hold in its corner leaves that along one of its sides.
    LooseCorner,
    /// Contacts beyond their target gap are excluded where forces exceed all loads by far.
    JammedForces,
    /// Contacts that act by next to no lever on a body held by connectors are excluded.
    Leverless,
    /// Contacts that run off at once are excluded where two corners hand over to each other without end.
    LeavingNeighbours,
    /// Contacts that contradict each other by little get forces by least squares.
    LenientForces,
    /// Contradictions that the rounding of bodies at rest explains are taken for no forces.
    RestingContradiction,
    /// Candidates that depend on others are excluded where the rows found would pull as equations.
    DependentRows,
    /// Contacts that have sunk too deep are lifted as they become active.
    Lifting,
    /// Contacts without force that start a segment below their gap by rounding fire at a lower one.
    SunkLowered,
    /// An event that was corrected beyond another contact goes back to that.
    Overtaken,
    /// Groups are cut by dense output where a repeated step has touching features elsewhere.
    CutByDense,
    /// Rows of connectors that depend on others are softened, so that they share their force.
    SoftRows,
    /// Rates at the start of a step that falls to nothing are found anew, as a law may have changed branch in between.
    RenewedRates,
}

impl Remedy {
    /// All remedies, in the order of their declaration.
    pub const ALL: [Self; 26] = [
        Self::GhostCorners,
        Self::DeadPoints,
        Self::Insistence,
        Self::TriggerGaps,
        Self::OpenFiring,
        Self::PassingBy,
        Self::LowBounces,
        Self::LowHops,
        Self::Accumulation,
        Self::Haste,
        Self::Patience,
        Self::JammedImpulses,
        Self::HeldInCorner,
        Self::LooseCorner,
        Self::JammedForces,
        Self::Leverless,
        Self::LeavingNeighbours,
        Self::LenientForces,
        Self::RestingContradiction,
        Self::DependentRows,
        Self::Lifting,
        Self::SunkLowered,
        Self::Overtaken,
        Self::CutByDense,
        Self::SoftRows,
        Self::RenewedRates,
    ];

    /// Its name in statistics.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::GhostCorners => "ghost_corners",
            Self::DeadPoints => "dead_points",
            Self::Insistence => "insistence",
            Self::TriggerGaps => "trigger_gaps",
            Self::OpenFiring => "open_firing",
            Self::PassingBy => "passing_by",
            Self::LowBounces => "low_bounces",
            Self::LowHops => "low_hops",
            Self::Accumulation => "accumulation",
            Self::Haste => "haste",
            Self::Patience => "patience",
            Self::JammedImpulses => "jammed_impulses",
            Self::HeldInCorner => "held_in_corner",
            Self::LooseCorner => "loose_corner",
            Self::JammedForces => "jammed_forces",
            Self::Leverless => "leverless",
            Self::LeavingNeighbours => "leaving_neighbours",
            Self::LenientForces => "lenient_forces",
            Self::RestingContradiction => "resting_contradiction",
            Self::DependentRows => "dependent_rows",
            Self::Lifting => "lifting",
            Self::SunkLowered => "sunk_lowered",
            Self::Overtaken => "overtaken",
            Self::CutByDense => "cut_by_dense",
            Self::SoftRows => "soft_rows",
            Self::RenewedRates => "renewed_rates",
        }
    }
}

/// A set of remedies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct RemedySet(u64);

impl RemedySet {
    /// No remedy.
    pub const NONE: Self = Self(0);

    /// The set with one more remedy.
    #[must_use]
    pub fn with(self, remedy: Remedy) -> Self {
        Self(self.0 | 1 << remedy as u32)
    }

    /// True if a remedy is in the set.
    #[must_use]
    #[inline]
    pub fn contains(self, remedy: Remedy) -> bool {
        self.0 & 1 << remedy as u32 != 0
    }
}

/// How often each remedy has acted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RemedyCounts([u64; Remedy::ALL.len()]);

impl Default for RemedyCounts {
    fn default() -> Self {
        Self([0; Remedy::ALL.len()])
    }
}

impl RemedyCounts {
    /// How often a remedy has acted.
    #[must_use]
    pub fn of(&self, remedy: Remedy) -> u64 {
        self.0[remedy as usize]
    }

    /// The remedies that have acted, with their counts.
    pub fn acted(&self) -> impl Iterator<Item = (Remedy, u64)> {
        Remedy::ALL.into_iter().zip(self.0).filter(|&(_, count)| count > 0)
    }
}

/// The remedies of a system: which are off, and how often each has acted.
#[derive(Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Remedies {
    without: RemedySet,
    acted: [AtomicU64; Remedy::ALL.len()],
}

impl Clone for Remedies {
    fn clone(&self) -> Self {
        Self { without: self.without, acted: self.counts().0.map(AtomicU64::new) }
    }
}

impl Remedies {
    pub(crate) fn new(without: RemedySet) -> Self {
        Self { without, acted: [0; Remedy::ALL.len()].map(AtomicU64::new) }
    }

    /// Counts that a remedy is to act; false if it is off.
    #[inline]
    pub(crate) fn act(&self, remedy: Remedy) -> bool {
        let is_on = self.is_on(remedy);
        if is_on {
            self.acted[remedy as usize].fetch_add(1, Ordering::Relaxed);
        }
        is_on
    }

    /// True unless a remedy is switched off.
    #[inline]
    pub(crate) fn is_on(&self, remedy: Remedy) -> bool {
        !self.without.contains(remedy)
    }

    pub(crate) fn counts(&self) -> RemedyCounts {
        RemedyCounts(std::array::from_fn(|index| self.acted[index].load(Ordering::Relaxed)))
    }
}
