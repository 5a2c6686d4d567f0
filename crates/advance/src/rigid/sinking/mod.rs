//! Contacts that carry impulses only sink between the ticks of the step. `depth`: how far they may, and which wait to be put
//! back.
//!
//! **Invariant**: where contacts carry forces, nothing waits and no depth is allowed beyond that of active contacts.

pub(super) mod depth;
