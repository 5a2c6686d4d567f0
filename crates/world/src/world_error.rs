//! Why a world could not be built.

/// Why a world could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WorldError {
    /// Two bodies have one name.
    #[error("there are two bodies named \"{name}\"")]
    DoubleName {
        /// The name.
        name: String,
    },
    /// A number is out of range.
    #[error("body \"{body}\": {quantity} must be {rule}, got {value}")]
    BadNumber {
        /// Name of the body.
        body: String,
        /// Which quantity.
        quantity: &'static str,
        /// What it must be.
        rule: &'static str,
        /// What it is.
        value: f64,
    },
    /// A setting is out of range.
    #[error("{setting} must be {rule}, got {value}")]
    BadSetting {
        /// Which setting.
        setting: &'static str,
        /// What it must be.
        rule: &'static str,
        /// What it is.
        value: f64,
    },
    /// A force law names a body that is not there.
    #[error("force \"{law}\" names body {body}, but there are {bodies} bodies")]
    NoSuchBody {
        /// What the law is called.
        law: String,
        /// Index of the body.
        body: u32,
        /// How many bodies there are.
        bodies: usize,
    },
    /// A force law is not finite at the start.
    #[error("force \"{law}\" on body \"{body}\" is not finite at the start")]
    BadForce {
        /// What the law is called.
        law: String,
        /// Name of the body.
        body: String,
    },
    /// Two bodies overlap at the start by more than is allowed.
    #[error(
        "bodies \"{first}\" and \"{second}\" overlap by {depth} m at the start; at most {allowed} m are allowed"
    )]
    Overlap {
        /// Name of one body.
        first: String,
        /// Name of the other body.
        second: String,
        /// How deep [m].
        depth: f64,
        /// How deep would be allowed [m].
        allowed: f64,
    },
    /// Gaps at the start cannot all be lifted to the target gap.
    #[error(
        "bodies \"{first}\" and \"{second}\" cannot be moved apart at the start: {gap} m remain between them"
    )]
    CannotLift {
        /// Name of one body.
        first: String,
        /// Name of the other body.
        second: String,
        /// The gap [m].
        gap: f64,
    },
    /// The forces at the start cannot be found.
    #[error("at the start: {source}")]
    Start {
        /// Why not.
        source: halfgap_advance::rigid::AdvanceError,
    },
}
