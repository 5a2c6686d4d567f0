//! Answers computed independently of every engine.
//!
//! `extrapolation` integrates in minimal coordinates, `one_freedom` finds the time of a mechanism with one degree of freedom by
//! quadrature, `double_double` carries 31 digits through billiards.

pub(crate) mod double_double;
pub(crate) mod extrapolation;
pub(crate) mod one_freedom;
