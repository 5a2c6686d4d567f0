//! The earliest event found that ends a segment.

use crate::rigid::group::state::SegmentEnd;

/// The earliest end of a segment found so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Earliest {
    /// Its offset [s] and kind.
    pub(super) found: Option<(f64, SegmentEnd)>,
}

impl Earliest {
    /// Offset [s] before which another end must come to be the first; `None` if none was found.
    pub(super) fn limit(&self) -> Option<f64> {
        self.found.map(|(offset, _)| offset)
    }

    /// True if nothing was found at an offset [s], nor before it.
    pub(super) fn is_after(&self, offset: f64) -> bool {
        self.limit().is_none_or(|limit| offset < limit)
    }

    /// Takes in an end of the segment at an offset [s], if there is one.
    pub(super) fn offer(&mut self, offset: Option<f64>, end: SegmentEnd) {
        if let Some(offset) = offset.filter(|&offset| self.is_after(offset)) {
            self.found = Some((offset, end));
        }
    }
}
