//! Contacts: the pairs of bodies that are near each other, the features that touch, their past, and how they are measured.
//!
//! **Invariant**: each pair of bodies whose boxes overlap is listed once, the lesser body first; a feature pair has at most
//! one remembered state. The room knows no forces: whether a contact is held is for rows to say, which groups own.
//!
//! `touch`: two features that touch · `pairs`: the table of pairs, with rules, predictions and past of each · `rows`: held
//! rows, measured at any moment · `ends`: how far a row is from running off its features · `gaps`: gap and rate of two
//! features · `bounces`: bounces too low to be told from contact.

pub(super) mod bounces;
pub(super) mod ends;
pub(super) mod gaps;
pub(super) mod pairs;
pub(super) mod rows;
pub(super) mod touch;
