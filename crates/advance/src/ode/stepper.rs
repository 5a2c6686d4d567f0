//! The stepper: makes one step of a method, and returns its error and the motion along it.

use super::explicit::Explicit;
use super::method::Method;
use super::polynomial::SegmentPolynomial;
use super::radau::Radau;
use super::{Ode, Point};
use std::ops::Range;

/// Estimate, from one step, of the fastest part of a system and its effect on the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StiffnessEstimate {
    /// Product [-] of the fastest rate, in size, and the step. When it comes to [`Method::stability_limit`], the fast
    /// part rather than the error limits the steps of an explicit method. Always 0 for Euler's method, whose one stage
    /// does not tell it.
    pub fastest: f64,
    /// Error of the motion along the step by this part, in the units of [`Stepper::error_norm`], which does not include
    /// it; 0 where nothing is that fast. The end of the step may be right all the same. Always 0 for implicit methods,
    /// where it is not known: over a step as long as a load on a stiff system takes to come and go, the motion between
    /// its ends is that of a cubic.
    pub dense_error: f64,
}

/// Makes steps of a method; keeps the stages of the last one.
///
/// Systems of any size may follow each other; only one larger than all before allocates.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Stepper {
    kind: Kind,
    /// Buffer: a state at which rates are asked for.
    pub(super) trial: Vec<f64>,
    /// Buffer: rates there, or at the end of a step.
    pub(super) trial_rates: Vec<f64>,
}

#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
enum Kind {
    Explicit(Explicit),
    Implicit(Box<Radau>),
}

impl Default for Stepper {
    fn default() -> Self {
        Self::new(Method::default())
    }
}

impl Stepper {
    /// Makes a stepper; its buffers are still empty.
    #[must_use]
    pub fn new(method: Method) -> Self {
        let kind = match method.tableau() {
            Some(tableau) => Kind::Explicit(Explicit::new(tableau)),
            None => Kind::Implicit(Box::default()),
        };
        Self { kind, trial: Vec::new(), trial_rates: Vec::new() }
    }

    /// Method of the steps.
    #[must_use]
    #[inline]
    pub fn method(&self) -> Method {
        match &self.kind {
            Kind::Explicit(explicit) => explicit.tableau.method,
            Kind::Implicit(_) => Method::RadauIia5,
        }
    }

    /// Sets the errors that are just acceptable, one per component as in [`error_norm`](Self::error_norm), for an
    /// implicit method: it solves its equations to a small fraction of them. Components beyond the scales are
    /// integrals, on which no rates depend. Without scales, or with more of them than components, it solves to a small
    /// fraction of the state. Explicit methods ignore them.
    #[inline]
    pub fn set_scales(&mut self, scales: &[f64]) {
        if let Kind::Implicit(radau) = &mut self.kind {
            radau.set_scales(scales);
        }
    }

    /// Makes a step of a length [s] and writes the state at its end to `end`; a negative step goes back.
    ///
    /// Where an implicit method does not find the state, `end` is the start, and the error norm is infinite.
    ///
    /// # Errors
    /// The first error of the system; then nothing is known about the step.
    ///
    /// # Panics
    /// If the states differ in length, or the rates are fewer; for explicit methods also if the rates are more.
    pub fn step<S: Ode + ?Sized>(
        &mut self,
        system: &mut S,
        from: Point<'_>,
        step: f64,
        end: &mut [f64],
    ) -> Result<(), S::Error> {
        self.step_open(system, from, step, end)?;
        if self.needs_end_rates() {
            let mut rates = std::mem::take(&mut self.trial_rates);
            rates.clear();
            rates.resize(end.len(), 0.0);
            let outcome = system.derivative(from.offset + step, end, &mut rates);
            if outcome.is_ok() {
                self.close(&rates);
            }
            self.trial_rates = rates;
            outcome?;
        }
        Ok(())
    }

    /// Makes a step like [`step`](Self::step), but for methods that [need the rates at the end](Self::needs_end_rates)
    /// the error is known only after [`close`](Self::close): this lets a caller project the end state first and
    /// evaluate its rates once.
    ///
    /// # Errors
    /// The first error of the system; then nothing is known about the step.
    ///
    /// # Panics
    /// If the states and rates differ in length.
    #[inline]
    pub fn step_open<S: Ode + ?Sized>(
        &mut self,
        system: &mut S,
        from: Point<'_>,
        step: f64,
        end: &mut [f64],
    ) -> Result<(), S::Error> {
        match &mut self.kind {
            Kind::Explicit(explicit) => explicit.step(system, from, step, end),
            Kind::Implicit(radau) => radau.step(system, from, step, end),
        }
    }

    /// True if the error estimate of the method takes the rates at the end of the step.
    #[must_use]
    #[inline]
    pub fn needs_end_rates(&self) -> bool {
        matches!(&self.kind, Kind::Explicit(explicit) if explicit.tableau.needs_end_rates)
    }

    /// Takes the rates at the end of a step that was made by [`step_open`](Self::step_open); methods that do not need
    /// them ignore them.
    ///
    /// # Panics
    /// If they do not fit the state of the last step.
    #[inline]
    pub fn close(&mut self, end_rates: &[f64]) {
        if let Kind::Explicit(explicit) = &mut self.kind {
            explicit.close(end_rates);
        }
    }

    /// Size [-] of the estimated error of the last step: the weighted root mean square over the first `scales.len()`
    /// components, where `scales` are the errors that are just acceptable; so 1 is just acceptable.
    ///
    /// Methods with fixed steps return 0, whatever came of the step. For others the size is not finite if the step went
    /// out of all bounds.
    ///
    /// # Panics
    /// If there are more scales than components, where the method has an estimate.
    #[must_use]
    #[inline]
    pub fn error_norm(&self, scales: &[f64]) -> f64 {
        if scales.is_empty() {
            return 0.0;
        }
        match &self.kind {
            Kind::Explicit(explicit) => explicit.error_norm(0, scales),
            Kind::Implicit(radau) => radau.error_norm(scales),
        }
    }

    /// Size [-] of the estimated error of the last step over the components from `first` on, like
    /// [`error_norm`](Self::error_norm). Meant for integrals, on which no rates depend: implicit methods, which do not
    /// solve for these, return 0.
    ///
    /// # Panics
    /// If there are fewer components than scales from there on, where an explicit method has an estimate.
    #[must_use]
    #[inline]
    pub fn error_norm_from(&self, first: usize, scales: &[f64]) -> f64 {
        match &self.kind {
            Kind::Explicit(explicit) if !scales.is_empty() => explicit.error_norm(first, scales),
            _ => 0.0,
        }
    }

    /// Estimates the fastest part of the system, and its effect on the motion along the last step. `end` is the state
    /// at the end of that step with its rates, `scales` are as in [`error_norm`](Self::error_norm).
    ///
    /// # Panics
    /// If there are more scales than components, for an explicit method.
    #[must_use]
    #[inline]
    pub fn stiffness(&mut self, end: Point<'_>, scales: &[f64]) -> StiffnessEstimate {
        match &mut self.kind {
            Kind::Explicit(explicit) => explicit.stiffness(end, scales),
            Kind::Implicit(radau) => StiffnessEstimate { fastest: radau.stiffness(), dense_error: 0.0 },
        }
    }

    /// Writes some components of the motion along the last step as polynomials, one of `out` for each.
    ///
    /// `end` is the state at the end, as the step gave it or changed by about its error, with its rates; at both ends
    /// the polynomials have the values given, but for rounding of the motion, and those of explicit methods the rates,
    /// too. The degree is 7 for DOP853, which asks for three more derivatives, 4 for Dormand-Prince 5, and 3 for the
    /// others.
    ///
    /// # Errors
    /// The first error of the system; then `out` is unchanged.
    ///
    /// # Panics
    /// If `end` or the components do not fit the state of the last step.
    #[inline]
    pub fn dense<S: Ode + ?Sized>(
        &mut self,
        system: &mut S,
        end: Point<'_>,
        components: Range<usize>,
        out: &mut [SegmentPolynomial],
    ) -> Result<(), S::Error> {
        match &mut self.kind {
            Kind::Explicit(explicit) => explicit.dense(system, end, components, out),
            Kind::Implicit(radau) => {
                radau.dense(end, components, out);
                Ok(())
            }
        }
    }
}
