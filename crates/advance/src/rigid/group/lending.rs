//! Buffers of a stage that the watch borrows, as what it computes with them needs the stage too.

use crate::rigid::group::samples::{NODES, Samples};
use crate::rigid::group::stage::Stage;

impl Stage {
    /// Lends out the buffers of watched functions.
    pub(crate) fn lend_samples(&mut self) -> Samples {
        std::mem::take(&mut self.samples)
    }

    /// Takes back the buffers of watched functions.
    pub(crate) fn take_back_samples(&mut self, samples: Samples) {
        self.samples = samples;
    }

    /// Lends out the buffer of sampled forces.
    pub(crate) fn lend_force_samples(&mut self) -> Vec<[f64; NODES]> {
        std::mem::take(&mut self.samples.forces)
    }

    /// Takes back the buffer of sampled forces.
    pub(crate) fn take_back_force_samples(&mut self, forces: Vec<[f64; NODES]>) {
        self.samples.forces = forces;
    }

    /// Margin [N] of each row, where margins were last evaluated.
    #[inline]
    pub(crate) fn margins(&self) -> &[f64] {
        &self.margins
    }

    /// Lends out the buffer of margins.
    pub(crate) fn lend_margins(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.margins)
    }

    /// Takes back the buffer of margins.
    pub(crate) fn take_back_margins(&mut self, margins: Vec<f64>) {
        self.margins = margins;
    }

    /// Lends out the buffer of values at the earliest event.
    pub(crate) fn lend_there(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.there)
    }

    /// Takes that buffer back.
    pub(crate) fn take_back_there(&mut self, there: Vec<f64>) {
        self.there = there;
    }
}
