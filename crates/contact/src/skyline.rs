//! Cholesky factor L Lᵀ = Â_CC of the closed rows, updated as rows are closed and opened.
//!
//! Each row of L is stored from its first nonzero on (the *envelope*, which a factor shares with its matrix: A. George,
//! J. Liu, "Computer Solution of Large Sparse Positive Definite Systems", 1981, chapter 4), so that a stack or a chain,
//! whose rows touch near neighbours only, costs little. A row is appended by a forward substitution; one is removed by
//! Givens rotations: P. Gill, G. Golub, W. Murray, M. Saunders, "Methods for modifying matrix factorizations",
//! Mathematics of Computation 28, 1974, 505-535.

/// A lower triangular factor with rows of varying length.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Skyline {
    /// Rows one after the other in order of position, with holes where rows were removed.
    data: Vec<f64>,
    /// Where each row begins in `data`, and the position of its first entry.
    begin: Vec<usize>,
    first: Vec<usize>,
    inverse_diagonal: Vec<f64>,
    rotation: Vec<(f64, f64)>,
}

impl Skyline {
    /// Forgets all rows and makes room for `rows` of them.
    pub(crate) fn reset(&mut self, rows: usize) {
        self.clear();
        self.data.reserve(rows * (rows + 1) / 2);
        self.begin.reserve(rows);
        self.first.reserve(rows);
        self.inverse_diagonal.reserve(rows);
        self.rotation.reserve(rows);
    }

    pub(crate) fn clear(&mut self) {
        self.truncate(0);
    }

    /// Forgets all rows from position `rows` on.
    pub(crate) fn truncate(&mut self, rows: usize) {
        if let Some(&end) = self.begin.get(rows) {
            self.data.truncate(end);
        }
        self.begin.truncate(rows);
        self.first.truncate(rows);
        self.inverse_diagonal.truncate(rows);
    }

    pub(crate) fn len(&self) -> usize {
        self.begin.len()
    }

    /// Entries left of the diagonal, in use by the rows.
    pub(crate) fn envelope(&self) -> usize {
        let length = self.first.len();
        length * length.saturating_sub(1) / 2 - self.first.iter().sum::<usize>()
    }

    /// The reciprocal of the least diagonal entry; zero without rows.
    pub(crate) fn largest_inverse_diagonal(&self) -> f64 {
        self.inverse_diagonal.iter().fold(0.0, |m: f64, d| m.max(*d))
    }

    /// y := L⁻¹ y, where y is zero before `from`. Returns the squared length of the result.
    pub(crate) fn forward(&self, y: &mut [f64], from: usize) -> f64 {
        let mut square = 0.0;
        for i in from..self.len() {
            let first = self.first[i].max(from);
            let begin = self.begin[i] + first - self.first[i];
            let row = &self.data[begin..begin + i - first];
            let value = (y[i] - dot(row, &y[first..i])) * self.inverse_diagonal[i];
            y[i] = value;
            square += value * value;
        }
        square
    }

    /// y := L⁻ᵀ y.
    pub(crate) fn backward(&self, y: &mut [f64]) {
        for i in (0..self.len()).rev() {
            let value = y[i] * self.inverse_diagonal[i];
            y[i] = value;
            if value != 0.0 {
                let first = self.first[i];
                let row = &self.data[self.begin[i]..self.begin[i] + i - first];
                for (out, entry) in y[first..i].iter_mut().zip(row) {
                    *out -= value * entry;
                }
            }
        }
    }

    /// y := (L Lᵀ)⁻¹ y.
    pub(crate) fn solve(&self, y: &mut [f64]) {
        self.forward(y, 0);
        self.backward(y);
    }

    /// Appends the row (y, diagonal), where y is zero before `first`.
    pub(crate) fn push(&mut self, y: &[f64], first: usize, diagonal: f64) {
        let position = self.len();
        let first = first.min(position);
        if self.data.len() + position + 1 > self.data.capacity() {
            self.compact();
        }
        self.begin.push(self.data.len());
        self.first.push(first);
        self.data.extend_from_slice(&y[first..position]);
        self.data.push(diagonal);
        self.inverse_diagonal.push(1.0 / diagonal);
    }

    /// Removes the row at position `k`; later rows move up by one.
    pub(crate) fn remove(&mut self, k: usize) {
        self.rotation.clear();
        for i in k + 1..self.len() {
            self.rotate_row(k, i);
        }
        self.begin.remove(k);
        self.first.remove(k);
        self.inverse_diagonal.remove(k);
    }

    /// Takes column `k` out of row `i`, which moves to position i - 1 and gives one more rotation.
    fn rotate_row(&mut self, k: usize, i: usize) {
        let first = self.first[i];
        let row = &mut self.data[self.begin[i]..=self.begin[i] + i - first];
        // Rotation q combines what is carried along with the entry of column k + 1 + q into the new column k + q.
        let (mut carried, begin, lag) =
            if first <= k { (row[k - first], 0, 1) } else { (0.0, first - k - 1, 0) };
        let shift = k.saturating_sub(first);
        for (q, &(cosine, sine)) in self.rotation[begin..].iter().enumerate() {
            let entry = row[shift + q + lag];
            row[shift + q] = cosine * carried + sine * entry;
            carried = cosine * entry - sine * carried;
        }
        let last = shift + self.rotation.len() - begin;
        let entry = row[last + lag];
        let length = (carried * carried + entry * entry).sqrt();
        row[last] = length;
        self.rotation.push((carried / length, entry / length));
        self.inverse_diagonal[i] = 1.0 / length;
        if first > k {
            self.first[i] = first - 1;
        }
    }

    /// Closes the holes.
    fn compact(&mut self) {
        let mut end = 0;
        for i in 0..self.len() {
            let length = i + 1 - self.first[i];
            self.data.copy_within(self.begin[i]..self.begin[i] + length, end);
            self.begin[i] = end;
            end += length;
        }
        self.data.truncate(end);
    }
}

/// Sum of products in a fixed order: four partial sums, so that the processor need not wait for each addition.
#[inline]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a_blocks, a_rest) = a.as_chunks::<4>();
    let (b_blocks, b_rest) = b.as_chunks::<4>();
    let mut sum = [0.0; 4];
    for (x, y) in a_blocks.iter().zip(b_blocks) {
        for l in 0..4 {
            sum[l] += x[l] * y[l];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    (sum[0] + sum[2]) + (sum[1] + sum[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entry of a well-conditioned matrix with zeros far from the diagonal, apart from its last rows.
    fn entry(i: usize, j: usize) -> f64 {
        let distance = i.abs_diff(j);
        match distance {
            0 => 3.0 + (i % 3) as f64,
            _ if distance > 2 && i.max(j) < 7 => 0.0,
            _ => 1.0 / (1.0 + (i + 2 * j) as f64 + (j + 2 * i) as f64),
        }
    }

    fn push(factor: &mut Skyline, closed: &mut Vec<usize>, row: usize) {
        let mut y: Vec<f64> = closed.iter().map(|&j| entry(row, j)).collect();
        let first = y.iter().position(|&v| v != 0.0).unwrap_or(y.len());
        let square = factor.forward(&mut y, first);
        factor.push(&y, first, (entry(row, row) - square).sqrt());
        closed.push(row);
    }

    fn error(factor: &Skyline, closed: &[usize]) -> f64 {
        let known: Vec<f64> = (0..closed.len()).map(|k| 1.0 + k as f64).collect();
        let product = |&i: &usize| closed.iter().zip(&known).map(|(&j, x)| entry(i, j) * x).sum();
        let mut y: Vec<f64> = closed.iter().map(product).collect();
        factor.solve(&mut y);
        y.iter().zip(&known).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_factor_stays_right_as_rows_come_and_go() {
        let (mut factor, mut closed) = (Skyline::default(), Vec::new());
        factor.reset(10);
        (0..10).for_each(|row| push(&mut factor, &mut closed, row));
        for k in [4, 0, 7, 2] {
            factor.remove(k);
            closed.remove(k);
            assert!(error(&factor, &closed) < 1e-13, "after removing position {k}");
        }
        for row in [4, 0] {
            push(&mut factor, &mut closed, row);
        }
        assert!(error(&factor, &closed) < 1e-13);
        assert!(factor.envelope() <= 28);
    }
}
