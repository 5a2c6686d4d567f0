//! The integrators: orders, dense output, step control.

mod control;
mod convergence;
mod dense;
mod polynomial;
mod problem;
mod stiff;
