//! The step of a region whose events accumulate: one problem of velocities in place of all that happens meanwhile.
//!
//! A step of length h begins at velocities v at which no contact closes. Its bodies coast with the velocities w in the middle,
//! the nearest to v + h/2 a, in the metric of the masses, at which no gap falls below its target: J w + g/h + h/2 J' v >= 0 (a: accelerations
//! without contacts; g: gap above its target). At its end velocities are w + h/2 a, and the nearest to these at which no contact closes; one that has closed fast opens by its
//! elasticity. That is the scheme RATTLE for inequalities: of second order where motions are smooth, exact at rest.
//! Both problems are solved by sweeps, and so are the displacements that bring what overlaps back to its target.
//!
//! **Invariant**: where a step begins no contact closes by more than the residual of a sweep; no step gives energy to its
//! contacts: what elasticity returns is no more than the approaches have brought.
//!
//! `rows`: the contacts of a step · `slips`: their friction · `sweeps`: the solver · `exact`: what sweeps do not reach · `step`: from one step to the next · `spans`: how long they are · `displacements`: back to
//! the target · `ending`: bodies in flight again.
//!
//! Sources: H. C. Andersen, J. Comput. Phys. 52 (1983) (RATTLE); M. Anitescu, F. A. Potra, Nonlinear Dyn. 14 (1997) (the
//! problem of velocities); J. J. Moreau, CISM Courses 302 (1988) (sweeps).

pub(super) mod displacements;
pub(super) mod ending;
mod exact;
pub(super) mod rows;
pub(super) mod slips;
pub(super) mod spans;
pub(super) mod step;
pub(super) mod sweeps;
