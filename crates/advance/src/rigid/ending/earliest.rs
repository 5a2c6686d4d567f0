//! The earliest of what ends a segment, as far as it was looked for.

use crate::rigid::step::group::SegmentEnd;

/// The earliest that was found so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Earliest {
    /// Its offset [s] and what it is.
    pub(super) found: Option<(f64, SegmentEnd)>,
}

impl Earliest {
    /// The offset [s] before which something must come to be the first.
    pub(super) fn limit(&self) -> Option<f64> {
        self.found.map(|(offset, _)| offset)
    }

    /// True if nothing was found before an offset [s], nor at it.
    pub(super) fn is_after(&self, offset: f64) -> bool {
        self.limit().is_none_or(|limit| offset < limit)
    }

    /// Takes in what may end the segment at an offset [s], if it does.
    pub(super) fn offer(&mut self, offset: Option<f64>, end: SegmentEnd) {
        if let Some(offset) = offset.filter(|&offset| self.is_after(offset)) {
            self.found = Some((offset, end));
        }
    }
}
