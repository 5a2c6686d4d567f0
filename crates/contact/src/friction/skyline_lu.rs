//! LU factors of an unsymmetric matrix with a symmetric pattern, within its envelope, without exchanges of rows.
//!
//! Row i of L and column i of U reach from `first[i]` to the diagonal; both are stored end to end, so that each entry is
//! a dot product of two runs of memory. The matrices that modes make have a multiple of the unit matrix added, and only
//! slipping contacts make them unsymmetric; where a pivot is lost all the same, the caller's residual shows it.
//! Source of the scheme: A. Jennings, "A compact storage scheme for the solution of symmetric linear simultaneous
//! equations", Computer Journal 9, 1966.

/// A matrix, then its factors.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct SkylineLu {
    /// First column of each row's envelope.
    first: Vec<u32>,
    /// Where the entry (i, `first[i]`) of each row lies; the run ends before the diagonal.
    start: Vec<usize>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    diagonal: Vec<f64>,
    /// Inverse pivots.
    pivot: Vec<f64>,
}

impl SkylineLu {
    /// Takes an envelope over, with all entries zero but `diagonal` on the diagonal.
    pub(super) fn reset(&mut self, first: &[u32], diagonal: f64) {
        let n = first.len();
        if self.first != first {
            self.first.clear();
            self.first.extend_from_slice(first);
            self.start.clear();
            let mut sum = 0;
            for (row, &first) in first.iter().enumerate() {
                self.start.push(sum);
                sum += row - first as usize;
            }
            self.start.push(sum);
        }
        let size = self.start.last().copied().unwrap_or(0);
        for entries in [&mut self.lower, &mut self.upper] {
            entries.clear();
            entries.resize(size, 0.0);
        }
        self.diagonal.clear();
        self.diagonal.resize(n, diagonal);
    }

    /// Adds to an entry inside the envelope.
    #[inline]
    pub(super) fn add(&mut self, row: usize, column: usize, value: f64) {
        match row.cmp(&column) {
            std::cmp::Ordering::Equal => self.diagonal[row] += value,
            std::cmp::Ordering::Greater => {
                self.lower[self.start[row] + column - self.first[row] as usize] += value;
            }
            std::cmp::Ordering::Less => {
                self.upper[self.start[column] + row - self.first[column] as usize] += value;
            }
        }
    }

    /// Factorises in place. False if a pivot is zero or not finite.
    pub(super) fn factorise(&mut self) -> bool {
        self.pivot.clear();
        for i in 0..self.diagonal.len() {
            let (first, start) = (self.first[i] as usize, self.start[i]);
            let (done_lower, own_lower) = self.lower.split_at_mut(start);
            let (done_upper, own_upper) = self.upper.split_at_mut(start);
            let mut sum = 0.0;
            for j in first..i {
                let (other_first, other) = (self.first[j] as usize, self.start[j]);
                let from = first.max(other_first);
                let (mine, theirs) =
                    (from - first..j - first, other + from - other_first..other + j - other_first);
                own_upper[j - first] -= dot(&done_lower[theirs.clone()], &own_upper[mine.clone()]);
                let rest = own_lower[j - first] - dot(&own_lower[mine], &done_upper[theirs]);
                own_lower[j - first] = rest * self.pivot[j];
                sum += own_lower[j - first] * own_upper[j - first];
            }
            let pivot = self.diagonal[i] - sum;
            if pivot == 0.0 || !pivot.is_finite() {
                return false;
            }
            self.pivot.push(1.0 / pivot);
        }
        true
    }

    /// Solves with the factors, in place of the right side.
    pub(super) fn solve(&self, x: &mut [f64]) {
        let run = |i: usize| (self.first[i] as usize, self.start[i]..self.start[i + 1]);
        for i in 0..x.len() {
            let (first, entries) = run(i);
            x[i] -= dot(&self.lower[entries], &x[first..i]);
        }
        for i in (0..x.len()).rev() {
            let (first, entries) = run(i);
            let value = x[i] * self.pivot[i];
            x[i] = value;
            x[first..i].iter_mut().zip(&self.upper[entries]).for_each(|(x, u)| *x -= u * value);
        }
    }
}

/// Sum of products in a fixed order, four sums at a time.
#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (blocks, others) = (a.chunks_exact(4), b.chunks_exact(4));
    let mut rest = 0.0;
    for (x, y) in blocks.remainder().iter().zip(others.remainder()) {
        rest += x * y;
    }
    let mut sums = [0.0; 4];
    for (x, y) in blocks.zip(others) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::SkylineLu;

    #[test]
    fn factors_solve_within_the_envelope() {
        // Rows 0 to 4; row 3 reaches back to row 0.
        let first = [0, 0, 1, 0, 3];
        let entry = |i: usize, j: usize| {
            let inside = if i > j { first[i] as usize <= j } else { first[j] as usize <= i };
            if inside { ((3 * i + 7 * j) as f64).sin() + if i == j { 4.0 } else { 0.0 } } else { 0.0 }
        };
        let mut factors = SkylineLu::default();
        factors.reset(&first, 0.5);
        for i in 0..5 {
            (0..5).filter(|&j| entry(i, j) != 0.0).for_each(|j| factors.add(i, j, entry(i, j)));
        }
        let expected = [1.0, -2.0, 3.0, 0.25, -1.5];
        let mut x: Vec<f64> = (0..5)
            .map(|i| 0.5 * expected[i] + (0..5).map(|j| entry(i, j) * expected[j]).sum::<f64>())
            .collect();
        assert!(factors.factorise());
        factors.solve(&mut x);
        assert!(x.iter().zip(&expected).all(|(x, e)| (x - e).abs() < 1e-14), "{x:?}");
        factors.reset(&[0, 0], 0.0);
        assert!(!factors.factorise());
    }
}
