//! The header of a saved world: what it is, which build wrote it, its length, and a checksum.
//!
//! In this order: [`MAGIC`]; the number of bytes of the build's name, in one; that name; the number of bytes of the content,
//! in eight, the least first; the checksum (XXH64) of the content, likewise; the content.

use super::error::LoadError;
use halfgap_contact::Method;
use xxhash_rust::xxh64::xxh64;

/// The first bytes of a saved world. The last ones are damaged where files are taken for text.
const MAGIC: [u8; 10] = *b"halfgap\r\n\0";
/// Number of bytes of the length, and of the checksum.
const NUMBER: usize = size_of::<u64>();
/// Seed of the checksum.
const SEED: u64 = 0;

/// Name of the build: the version, and the feature that adds to what worlds hold.
fn build() -> &'static str {
    if Method::Qp.is_built() { concat!(env!("CARGO_PKG_VERSION"), "+qp") } else { env!("CARGO_PKG_VERSION") }
}

/// A header whose numbers are still zero, behind which the content is to be written.
pub(super) fn room() -> Vec<u8> {
    let build = build().as_bytes();
    let mut bytes = MAGIC.to_vec();
    bytes.push(u8::try_from(build.len()).unwrap_or(u8::MAX));
    bytes.extend(build);
    bytes.extend([0; 2 * NUMBER]);
    bytes
}

/// Sets the numbers of the header, once the content is there.
pub(super) fn close(mut bytes: Vec<u8>) -> Vec<u8> {
    let start = MAGIC.len() + 1 + build().len() + 2 * NUMBER;
    let (head, content) = bytes.split_at_mut(start);
    let (length, checksum) = head[start - 2 * NUMBER..].split_at_mut(NUMBER);
    length.copy_from_slice(&(content.len() as u64).to_le_bytes());
    checksum.copy_from_slice(&xxh64(content, SEED).to_le_bytes());
    bytes
}

/// The content behind a header that fits it.
pub(super) fn open(bytes: &[u8]) -> Result<&[u8], LoadError> {
    let rest = bytes.strip_prefix(&MAGIC).ok_or(LoadError::NotAWorld)?;
    let (&count, rest) = rest.split_first().ok_or(LoadError::NotAWorld)?;
    let (found, rest) = rest.split_at_checked(usize::from(count)).ok_or(LoadError::NotAWorld)?;
    if found != build().as_bytes() {
        let found = String::from_utf8_lossy(found).into_owned();
        return Err(LoadError::OtherVersion { found, own: build().to_owned() });
    }
    let (length, rest) = number(rest)?;
    let (checksum, content) = number(rest)?;
    if content.len() as u64 != length {
        let (all, head) = (bytes.len() as u64, (bytes.len() - content.len()) as u64);
        return Err(LoadError::WrongLength { expected: length.saturating_add(head), found: all });
    }
    if xxh64(content, SEED) == checksum { Ok(content) } else { Err(LoadError::Damaged) }
}

/// A number, and the bytes behind it.
fn number(bytes: &[u8]) -> Result<(u64, &[u8]), LoadError> {
    let (number, rest) = bytes.split_first_chunk().ok_or(LoadError::NotAWorld)?;
    Ok((u64::from_le_bytes(*number), rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sound() -> Vec<u8> {
        let mut bytes = room();
        bytes.extend(b"content");
        close(bytes)
    }

    #[test]
    fn what_was_closed_can_be_opened() {
        assert_eq!(open(&sound()), Ok(&b"content"[..]));
        assert_eq!(open(&close(room())), Ok(&b""[..]));
    }

    #[test]
    fn no_change_of_a_byte_goes_unseen() {
        let sound = sound();
        for place in 0..sound.len() {
            for flip in 1..=u8::MAX {
                let mut bytes = sound.clone();
                bytes[place] ^= flip;
                assert!(open(&bytes).is_err(), "byte {place}, flipped by {flip}");
            }
            assert!(open(&sound[..place]).is_err(), "{place} bytes");
        }
        assert!(open(&[&sound[..], b"0"].concat()).is_err());
    }

    #[test]
    fn another_version_is_named() {
        let mut bytes = sound();
        bytes[MAGIC.len() + 1] = b'7';
        let message = open(&bytes).expect_err("another version").to_string();
        let found = build().replacen(|_| true, "7", 1);
        assert_eq!(message, format!("the world was saved by halfgap {found}, this is {}", build()));
    }
}
