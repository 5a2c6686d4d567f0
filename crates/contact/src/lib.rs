//! Contact forces and impulses: rows in, forces out.
//!
//! *Invariant*: this crate knows rows, masses and complementarity, but no shapes, no time stepping and no scenes.
//!
//! # Conventions
//!
//! A row's rate is J v; negative closes. Forces [N] and impulses [N s] act along the rows: positive ones push the primary
//! body along the normal and the normal body against it.
//!
//! # Code map
//!
//! `row` turns collision records into rows; `impact` finds impulses by an impact law.

mod impact;
mod row;

pub use impact::{Impact, ImpactError, ImpactLaw, ImpactOrder};
pub use row::{InverseInertia, Row};
