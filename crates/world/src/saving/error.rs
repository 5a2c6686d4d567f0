//! Reasons why a world cannot be saved, or bytes be loaded.

/// Reason why a world cannot be saved.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The world has, or had, a force law that is not one of this crate's: nobody could make it again from bytes.
    #[error("the force law \"{law}\" is not one of halfgap's: a world with it cannot be saved")]
    OwnLaw {
        /// Name of the law.
        law: String,
    },
    /// A part of the world has no form as bytes.
    #[error("the world cannot be written: {reason}")]
    Unwritten {
        /// What is wrong with it.
        reason: String,
    },
}

/// Reason why no world can be loaded from bytes.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The bytes do not begin as those of a saved world.
    #[error("these bytes are no saved world")]
    NotAWorld,
    /// The world was saved by another version, whose form may differ, or by a build with other features.
    #[error("the world was saved by halfgap {found}, this is {own}")]
    OtherVersion {
        /// The version that saved it, with `+qp` if it was built with that feature.
        found: String,
        /// The version of this crate, likewise.
        own: String,
    },
    /// Bytes are missing, or others follow them.
    #[error("a saved world of {expected} bytes has {found}")]
    WrongLength {
        /// Number of bytes that the world was saved in.
        expected: u64,
        /// Number of bytes given.
        found: u64,
    },
    /// The bytes are not those that were saved.
    #[error("the bytes of the saved world are damaged: their checksum does not fit")]
    Damaged,
    /// The checksum fits, but the content is none that a world of this version writes.
    #[error("the saved world cannot be read: {reason}")]
    Unreadable {
        /// What is wrong with it.
        reason: String,
    },
}
