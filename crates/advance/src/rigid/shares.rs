//! Orders of magnitude, and counts, by which decisions are made.
//!
//! A quantity is compared with a share of another of its kind. Where no measurement and no formula asks for a certain share,
//! it is one of these orders of magnitude, so that there are few of them: none was fitted to a scene. A number that was
//! measured for one decision, or follows from a formula, is with that decision.
//!
//! What breaks on either side was measured on all tests of this crate and across crates, with one of them changed at a time.
//! Tests that follow one chaotic run up to a certain remedy are left out, and so are those that only ask for the number itself.

/// What is less than this fraction of another quantity is as good as nothing beside it [-]. The rate at rest beside that
/// of a slow contact, the force of a contact that is released beside the loads, and the like.
///
/// At 1e-2 a disc nearly in line with two others does not come to rest between them, and one fast body makes the bounces of
/// others count as slow. At 1e-4 impacts between which a disc goes far count as an accumulation.
pub(crate) const NEGLIGIBLE: f64 = 1e-3;
/// Fraction of a length up to which what bends along it is straight [-]: what is neglected is of the order of its square.
///
/// At 0.3 linkages lose energy where they fold, miss their dead points, and low hops are not brought to rest. At 0.03 nothing
/// but the place changes from which a step is led past a bifurcation point.
pub(crate) const SMALL: f64 = 0.1;
/// A quantity that exceeds another by this factor is of another order [-].
///
/// At 3 and at 30 a ball that bounces as high as the gap does not come to rest, and a generated scene is broken; at 30 a
/// disc bumps on the seam of two tiles of nearly one slope, and attracting centres that meet at the gap of a contact do not stop the run.
pub(crate) const LARGE: f64 = 10.0;
/// Fraction of a zone or of a body up to which an error or a depth is minor [-]: it need not be corrected.
///
/// At 1e-3 a driven bar that presses on another by impulses alone collides more than once in a step. At
/// 0.1 no test fails.
pub(crate) const MINOR: f64 = 1e-2;
/// Factor by which impulses, forces or losses of energy exceed what can explain them [-].
///
/// At 10 a reference scene ends elsewhere. At 1e3 no test fails.
pub(crate) const MAJOR: f64 = 1e2;
/// Fraction of a length, of a time, or of a force that cannot be seen [-].
///
/// At 1e-3 hops that move bodies farther than they may go unseen, and a generated scene with wide zones is broken. At 1e-5
/// no test fails.
pub(crate) const TINY: f64 = 1e-4;
/// A multiple of what the scene itself does that leaves no doubt [-]: of its acceleration, of the time that forces need, of
/// rounding.
///
/// No test fails at 1e2 nor at 1e4.
pub(crate) const HUGE: f64 = 1e3;
/// A few times [-]: a decision for something is worth its price if that is so much less.
///
/// At 2 the grinder sticks, and dyads that fold lose energy. At 8 two bodies that drift do not rest on each other as those
/// that stay do.
pub(crate) const SEVERAL: f64 = 4.0;
/// Almost all of a limit [-]: the next step may already pass it.
///
/// At 0.5 a block that its turning presses into another by impulses alone collides on and on. At 1 no test fails.
pub(crate) const NEARLY_ALL: f64 = 0.9;

/// Fraction of `accuracy`, the half-width of the target zone, that one error may take [-]: another of its size still
/// fits in.
///
/// At 0.25 short hops within the zone are followed instead of held. At 1 a load slides off the platform that carries it
/// round, and a generated scene with wide zones is broken.
pub(crate) const HALF_ZONE: f64 = 0.5;
/// Fraction of the length over which things vary by which a body may move in a step of a group with contacts; also the
/// angle [rad] by which a contact may turn. Within it they vary monotonously.
///
/// At 1 a light disc does not leave its floor as a planet flies over it, and energy is lost where forces grow beyond all
/// bounds. At 0.25 less is gained by bringing low hops to rest, as there are more steps.
pub(crate) const WAY_OF_A_STEP: f64 = 0.5;
/// Another try is worth its cost if it leaves less than this fraction of an error or of a way [-].
///
/// No test fails at 0.25 nor at 0.9.
pub(crate) const WORTHWHILE: f64 = 0.5;
/// Number of rounds of a correction that converges, each leaving less than about half of the error: what is left after
/// so many is not going to vanish.
///
/// No test fails at 4; at 16 a scene whose end rounding decides comes to another one.
pub(crate) const ROUNDS: u32 = 8;
/// Number of halvings of an interval after which floating-point numbers tell its ends apart no more.
///
/// No test fails at 32 nor at 128.
pub(crate) const HALVINGS: usize = 64;

/// Fraction of the sum of the sizes of some terms below which what is left of their sum is rounding [-]: thousands of
/// machine epsilons, for as many terms.
///
/// At 1e-11 less is gained by bringing low hops to rest. At 1e-13 no test fails.
pub(crate) const ROUNDED: f64 = 1e-12;
/// Fraction of the loads of its bodies, or of the largest force, below which a contact's force is rounding [-]: forces of
/// nearly redundant contacts are much less exact than sums.
///
/// At 1e-7 bodies leave floors, corners and arcs later than theory says. At 1e-11 no test fails.
pub(crate) const ROUNDED_FORCE: f64 = 1e-9;
/// Multiple of machine epsilon times a clock, or a length, from which a difference is more than its rounding [-].
///
/// No test fails at 16 nor at 256.
pub(crate) const ROUNDINGS: f64 = 64.0;
/// Share [-] by which the bounds of a problem are less than those that count. A contact that is this near its bound and slips by mistake
/// is slowed down, and stops at once.
pub(crate) const NARROWED: f64 = 1e-7;
/// Share [-] of the largest acceleration, or of that by the force that presses, from which a slip accelerates: between what solutions
/// are off, and what a contact at its bound does where bounds are less by [`NARROWED`].
pub(crate) const MOVES: f64 = 3e-13;
