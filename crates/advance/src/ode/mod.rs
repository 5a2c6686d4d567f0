//! Ordinary differential equations: one step of a method, its error, and the motion along it.
//!
//! This room knows no bodies: a system is a function that returns the rates of change of some numbers ([`Ode`]). A
//! [`Stepper`] makes one step and estimates its error. The caller decides whether the step is accepted, may change the
//! end state by about the error (projection on constraints), and may ask for the motion along the step as
//! [`SegmentPolynomial`]s. The buffers belong to the stepper: after the first step nothing is allocated.
//!
//! Source of methods and control: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd
//! ed., Springer 1993 ("HNW" in this room).
//!
//! # Code map
//!
//! `method` lists the methods, `tableau` describes the coefficients of an explicit one and has the small ones, `dop853`
//! and `dormand_prince5` the large ones; `stepper` makes a step and estimates its error: of an `explicit` method, whose
//! motion along the step is in `dense`, or by `radau`, which solves equations (`linear`); `polynomial` is the form of
//! the motion, `through` makes one from values; `start` proposes the first step and `control` the next.
//!
//! # Examples
//!
//! ```
//! use halfgap_advance::ode::{Method, Ode, Point, Stepper};
//! use std::convert::Infallible;
//!
//! /// y'' = -y
//! struct Spring;
//! impl Ode for Spring {
//!     type Error = Infallible;
//!     fn derivative(&mut self, _offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
//!         rates.copy_from_slice(&[state[1], -state[0]]);
//!         Ok(())
//!     }
//! }
//!
//! let mut stepper = Stepper::new(Method::Dop853);
//! let mut end = [0.0; 2];
//! let start = Point { offset: 0.0, state: &[0.0, 1.0], rates: &[1.0, 0.0] };
//! stepper.step(&mut Spring, start, 0.1, &mut end)?;
//! assert!((end[0] - 0.1_f64.sin()).abs() < 1e-15);
//! assert!(stepper.error_norm(&[1e-10, 1e-10]) < 1.0);
//! # Ok::<(), Infallible>(())
//! ```

mod control;
mod dense;
mod dop853;
mod dormand_prince5;
mod explicit;
mod linear;
mod method;
mod polynomial;
mod radau;
#[cfg(feature = "save")]
mod saved;
mod start;
mod stepper;
mod tableau;
mod through;

pub use control::{Accepted, is_kept};
pub use method::Method;
pub use polynomial::{Jet, SegmentPolynomial, Spread};
pub use stepper::{Stepper, StiffnessEstimate};

/// A system of ordinary differential equations `y' = f(t, y)`.
pub trait Ode {
    /// Error of rates that cannot be found.
    type Error;

    /// Writes the rates of change of a state [1/s] at an offset [s] from the start of the segment.
    ///
    /// # Errors
    /// There are no rates at this state; the step that asked is given up.
    fn derivative(&mut self, offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Self::Error>;
}

/// Start or end of a step: a state and its rates there.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// Offset [s] from the start of the segment.
    pub offset: f64,
    /// State, in units of the system.
    pub state: &'a [f64],
    /// Its rates of change [1/s] at the offset.
    pub rates: &'a [f64],
}
