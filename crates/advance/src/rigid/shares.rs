//! Orders of magnitude, and counts, by which decisions are made.
//!
//! A quantity is compared with a share of another of its kind. Where no measurement and no formula asks for a certain share,
//! it is one of these orders of magnitude, so that there are few of them: none was fitted to a scene. A number that was
//! measured for one decision, or follows from a formula, is with that decision.

/// What is less than this fraction of another quantity is as good as nothing beside it [-]. The rate at rest beside that
/// of a slow contact, the force of a contact that is released beside the loads, and the like.
pub(crate) const NEGLIGIBLE: f64 = 1e-3;
/// Fraction of a length up to which what bends along it is straight [-]: what is neglected is of the order of its square.
pub(crate) const SMALL: f64 = 0.1;
/// A quantity that exceeds another by this factor is of another order [-].
pub(crate) const LARGE: f64 = 10.0;
/// Fraction of a zone or of a body up to which an error or a depth is minor [-]: it need not be corrected.
pub(crate) const MINOR: f64 = 1e-2;
/// Factor by which impulses, forces or losses of energy exceed what can explain them [-].
pub(crate) const MAJOR: f64 = 1e2;
/// Fraction of a length, of a time, or of a force that cannot be seen [-].
pub(crate) const TINY: f64 = 1e-4;
/// A multiple of what the scene itself does that leaves no doubt [-]: of its acceleration, of the time that forces need, of
/// rounding.
pub(crate) const HUGE: f64 = 1e3;
/// A few times [-]: a decision for something is worth its price if that is so much less.
pub(crate) const SEVERAL: f64 = 4.0;
/// Almost all of a limit [-]: the next step may already pass it.
pub(crate) const NEARLY_ALL: f64 = 0.9;

/// Fraction of `accuracy`, the half-width of the target zone, that one error may take [-]: another of its size still
/// fits in.
pub(crate) const HALF_ZONE: f64 = 0.5;
/// Fraction of the length over which things vary by which a body may move in a step of a group with contacts; also the
/// angle [rad] by which a contact may turn. Within it they vary monotonously.
pub(crate) const WAY_OF_A_STEP: f64 = 0.5;
/// Another try is worth its cost if it leaves less than this fraction of an error or of a way [-].
pub(crate) const WORTHWHILE: f64 = 0.5;
/// Number of rounds of a correction that converges, each leaving less than about half of the error: what is left after
/// so many is not going to vanish.
pub(crate) const ROUNDS: u32 = 8;
/// Number of halvings of an interval after which floating-point numbers tell its ends apart no more.
pub(crate) const HALVINGS: usize = 64;

/// Fraction of the sum of the sizes of some terms below which what is left of their sum is rounding [-]: thousands of
/// machine epsilons, for as many terms.
pub(crate) const ROUNDED: f64 = 1e-12;
/// Fraction of the loads of its bodies, or of the largest force, below which a contact's force is rounding [-]: forces of
/// nearly redundant contacts are much less exact than sums.
pub(crate) const ROUNDED_FORCE: f64 = 1e-9;
/// Multiple of machine epsilon times a clock, or a length, from which a difference is more than its rounding [-].
pub(crate) const ROUNDINGS: f64 = 64.0;
