//! Answers computed independently of every engine.
//!
//! `extrapolation` integrates in minimal coordinates, `phases` the same where the law of motion changes at events,
//! `one_freedom` finds the time of a mechanism with one
//! degree of freedom by quadrature, `geneva` puts such times together for a drive that indexes,
//! `double_double` carries 31 digits through billiards.

pub(crate) mod double_double;
pub(crate) mod extrapolation;
pub(crate) mod geneva;
pub(crate) mod one_freedom;
pub(crate) mod phases;
