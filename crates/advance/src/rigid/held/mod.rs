//! What is held after an event: `settle` poses the problem of the candidates and chooses, `settling` are its
//! buffers and its solver, `levers` what connectors leave of a row, `redundant` which contacts can be spared, `leaving` contacts that are over at once.

pub(super) mod leaving;
pub(super) mod levers;
pub(super) mod redundant;
pub(super) mod settle;
pub(super) mod settling;
