//! Marks on bodies that are all removed at once.

use halfgap_collision::BodyId;

/// A set of bodies that is emptied without visiting them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Marks {
    /// A body is marked where this is the present stamp.
    stamps: Vec<u32>,
    stamp: u32,
}

impl Marks {
    /// Removes all marks, and makes room for a number of bodies.
    pub(crate) fn begin(&mut self, body_count: usize) {
        self.stamps.resize(body_count, 0);
        self.stamp = self.stamp.wrapping_add(1);
        if self.stamp == 0 {
            self.stamps.fill(0);
            self.stamp = 1;
        }
    }

    #[inline]
    pub(crate) fn set(&mut self, body: BodyId) {
        self.stamps[body.index()] = self.stamp;
    }

    /// Removes the mark of a body; true if it had one.
    #[inline]
    pub(crate) fn take(&mut self, body: BodyId) -> bool {
        std::mem::take(&mut self.stamps[body.index()]) == self.stamp
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn marks_are_taken_once_and_forgotten_together() {
        let mut marks = Marks { stamps: Vec::new(), stamp: u32::MAX - 1 };
        for _ in 0..3 {
            marks.begin(2);
            assert!(!marks.take(BodyId(1)));
            marks.set(BodyId(0));
            assert!(marks.take(BodyId(0)) && !marks.take(BodyId(0)));
            marks.set(BodyId(1));
        }
    }
}
