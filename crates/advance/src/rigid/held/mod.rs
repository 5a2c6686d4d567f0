//! Choice of the rows that are held after an event. `settle` poses the problem of the candidates and chooses among
//! them, `settling` has its buffers and solvers. `levers` finds contacts that connectors leave next to no lever,
//! `redundant` contacts that can be spared, `leaving` contacts that end at once,
//! `squeezed` bodies that are too light for what they carry.

pub(super) mod hops;
pub(super) mod jammed;
pub(super) mod leaving;
pub(super) mod levers;
pub(super) mod passing;
pub(super) mod redundant;
pub(super) mod settle;
pub(super) mod settling;
pub(super) mod sparing;
