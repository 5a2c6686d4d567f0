//! Contacts: the pairs of bodies that are near each other, the features that touch, their past, and how they are measured.
//!
//! **Invariant**: each pair of bodies whose boxes overlap is listed once, the lesser body first; two features
//! have at most one contact. The room knows no forces: whether a contact is active is decided above, and written here.
//!
//! `touch`: two features that touch · `table`: the contacts of each pair, with their modes, and the one place where these
//! change · `pairs`: the pairs, with their predictions · `rows`: active rows, measured at any moment · `ends`: how far a row is
//! from running off its features · `gaps`: gap and rate of two features · `bounces`: bounces too low to be told from
//! contact · `friction`: what friction does at them · `rolling`:
//! what resists rolling there.

pub(super) mod bounces;
pub(super) mod ends;
pub(super) mod friction;
pub(super) mod gaps;
pub(super) mod pairs;
pub(super) mod pulls;
pub(super) mod rolling;
pub(super) mod rows;
pub(super) mod table;
pub(super) mod touch;
