//! Problems with friction: rows whose force is bounded by that of another row or by constants, or acts in another
//! direction than is measured.
//!
//! `scaled_rows` holds such a problem, its columns in a `body_order`. [`Modes`] solves it: `mode` tells how each force is
//! found, `equations` are those of given modes, factorised by `skyline_lu`, `settle` corrects the modes of an earlier
//! answer, and `descent` finds a start from none. `stewart_trinkle` writes the problem as a plain complementarity problem
//! for [`Lemke`](crate::Lemke), and `recognition` finds contacts in such a one; `enumeration` tries all modes of few contacts, `methods` has the order of all these, and
//! [`Jump`] is the way on where forces have no solution. *Invariant*: nothing here is used by problems whose rows are all plain.

mod body_order;
mod descent;
mod enumeration;
mod equations;
mod jump;
mod methods;
mod mode;
mod modes;
mod recognition;
mod scaled_rows;
mod settle;
mod skyline_lu;
mod stewart_trinkle;

pub use jump::{Jump, JumpError};
pub(crate) use methods::FrictionMethods;
pub use modes::Modes;
pub(crate) use recognition::Recognised;
pub(crate) use stewart_trinkle::PlainForm;
