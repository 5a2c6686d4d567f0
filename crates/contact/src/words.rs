//! Words that errors of problems and impacts hold: rules, kinds of rows, reasons.
//!
//! *Invariant*: these errors hold no other words, so that an error that was saved finds its words again.

/// Words of an error, under a name of their own: serde would have saved errors hand them out as borrowed ones.
pub(crate) type Words = &'static str;

pub(crate) const PLAIN_ONLY: &str = "impact laws take unilateral and bilateral rows only";
pub(crate) const FINITE_ONLY: &str = "rate, velocity_tol, jacobian and response must be finite";
pub(crate) const ELASTICITY_RANGE: &str = "elasticity must be between 0 and 1";
pub(crate) const RESPONSE_SIGN: &str =
    "a response must be that of inverse masses and moments that are not negative";
pub(crate) const FRICTION_RANGE: &str =
    "friction takes finite numbers, a coefficient of 0 or more and a tangential elasticity between 0 and 1";
pub(crate) const UNILATERAL: &str = "a unilateral row";
pub(crate) const BILATERAL: &str = "a bilateral row";
pub(crate) const BOUNDED: &str = "a row bounded by constants";
pub(crate) const FRICTION: &str = "a row bounded by friction";
pub(crate) const SYMMETRIC_ONLY: &str = "it needs a symmetric, positive semidefinite matrix";
#[cfg(any(feature = "qp", feature = "save"))]
pub(crate) const TOO_LARGE: &str = "so large a problem must be given by the rows of bodies and their masses";
pub(crate) const BODIES_ONLY: &str = "it needs the rows of bodies and their masses";

/// All of them.
#[cfg(feature = "save")]
const ALL: [&str; 12] = [
    PLAIN_ONLY,
    FINITE_ONLY,
    ELASTICITY_RANGE,
    RESPONSE_SIGN,
    FRICTION_RANGE,
    UNILATERAL,
    BILATERAL,
    BOUNDED,
    FRICTION,
    SYMMETRIC_ONLY,
    TOO_LARGE,
    BODIES_ONLY,
];

#[cfg(feature = "save")]
pub(crate) fn serialize<S: serde::Serializer>(
    words: &&'static str,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    if ALL.contains(words) {
        serializer.serialize_str(words)
    } else {
        Err(serde::ser::Error::custom(format_args!("an error of a solver of one's own: {words}")))
    }
}

#[cfg(feature = "save")]
pub(crate) fn deserialize<'de, D: serde::Deserializer<'de>>(
    deserializer: D,
) -> Result<&'static str, D::Error> {
    let found = <String as serde::Deserialize>::deserialize(deserializer)?;
    let known = ALL.into_iter().find(|words| *words == found);
    known.ok_or_else(|| serde::de::Error::custom(format_args!("words that no error has: {found}")))
}
