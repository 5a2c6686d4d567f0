//! The dictionary (tableau) of Lemke's method: basic variables in terms of the nonbasic ones.
//!
//! Variables are w_i (index i), z_i (index n + i) and the artificial z_0 (index 2n), starting from w = q + M z + d z_0.
//! Ties are broken as if q were q + (ε, ε², ..., εⁿ), with which there are no ties: R. Cottle, J.-S. Pang, R. Stone,
//! "The Linear Complementarity Problem", 1992, section 4.9. The row i of B⁻¹ that this needs is in the columns of the
//! nonbasic w. Entries are `f64`, or have twice as many digits.

use crate::twofold::Number;

/// Number of roundings of the largest entry of a column: smaller entries are no pivots.
const PIVOT: f64 = 4.5e6;

/// Least value taken for the largest entry of a column, in units of the scaled matrix: in a column with smaller entries
/// all may be rounding.
const COLUMN: f64 = 1e-3;

/// Number of roundings, of the least ratio plus 1, within which ratios tie.
const TIE: f64 = 4.5e4;

/// Number of roundings of the terms of an entry: an entry up to this is zero.
const LEFT: f64 = 64.0;

/// Column of a w that is basic.
const NONE: u32 = u32::MAX;

/// Basic variables as affine functions of the nonbasic ones.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Dictionary<T> {
    n: usize,
    /// Rows of n + 1 coefficients and the constant.
    entries: Vec<T>,
    /// Variable of each row and of each column.
    basic: Vec<usize>,
    nonbasic: Vec<usize>,
    /// Column in which each w is nonbasic, or `NONE`.
    column_of_w: Vec<u32>,
    /// One flag per row: true for a bilateral row, which may take any sign and never blocks.
    free: Vec<bool>,
    pivot_row: Vec<T>,
    candidates: Vec<usize>,
}

impl<T: Number> Dictionary<T> {
    /// Starts from w = q + M z + d z_0, with d = 1 on unilateral and 0 on bilateral rows; M is to be filled in.
    pub(crate) fn reset(&mut self, q: &[T], bilateral: &[bool]) {
        let n = q.len();
        self.n = n;
        let width = n + 2;
        self.entries.clear();
        self.entries.resize(n * width, T::default());
        for i in 0..n {
            self.entries[i * width + n] = T::from(f64::from(u8::from(!bilateral[i])));
            self.entries[i * width + n + 1] = q[i];
        }
        self.basic.clear();
        self.basic.extend(0..n);
        self.nonbasic.clear();
        self.nonbasic.extend(n..=2 * n);
        self.column_of_w.clear();
        self.column_of_w.resize(n, NONE);
        self.free.clear();
        self.free.extend_from_slice(bilateral);
    }

    /// Adds to the coefficient M_ij of the start.
    pub(crate) fn add(&mut self, i: usize, j: usize, value: T) {
        let entry = &mut self.entries[i * (self.n + 2) + j];
        *entry = *entry + value;
    }

    /// The artificial variable.
    pub(crate) fn artificial(&self) -> usize {
        2 * self.n
    }

    /// The complement of a variable w_i or z_i.
    pub(crate) fn complement(&self, variable: usize) -> usize {
        if variable < self.n { variable + self.n } else { variable - self.n }
    }

    fn at(&self, row: usize, column: usize) -> T {
        self.entries[row * (self.n + 2) + column]
    }

    /// The constant of a row, which is the value of its basic variable.
    fn constant(&self, row: usize) -> T {
        self.at(row, self.n + 1)
    }

    /// The variable of a column.
    pub(crate) fn entering(&self, column: usize) -> usize {
        self.nonbasic[column]
    }

    /// Basic variables and their values.
    pub(crate) fn basic_rows(&self) -> impl Iterator<Item = (usize, T)> + '_ {
        self.basic.iter().enumerate().map(|(row, &variable)| (variable, self.constant(row)))
    }

    /// The column of a nonbasic variable.
    pub(crate) fn column(&self, variable: usize) -> Option<usize> {
        self.nonbasic.iter().position(|&v| v == variable)
    }

    /// Makes the z of bilateral rows basic, largest pivots first, and bars their w from entering. Rows that depend on
    /// others stay as they are. Entries that are then only rounding are set to zero; they belong to contacts that
    /// connectors hold entirely, and could seem to be a ray.
    pub(crate) fn eliminate_bilateral(&mut self) {
        if !self.free.contains(&true) {
            return;
        }
        let mut sizes: Vec<f64> = self.entries.iter().map(|entry| entry.abs().nearest()).collect();
        loop {
            let mut best = (T::default(), 0, 0);
            for row in (0..self.n).filter(|&row| self.free[row] && self.basic[row] < self.n) {
                for column in 0..self.n {
                    let variable = self.nonbasic[column];
                    let size = self.at(row, column).abs();
                    if variable >= self.n && self.free[variable - self.n] && size > best.0 {
                        best = (size, row, column);
                    }
                }
            }
            let (size, row, column) = best;
            if size <= T::from(PIVOT * T::ROUNDING) {
                break;
            }
            self.add_sizes(&mut sizes, row, column);
            self.pivot(row, column);
        }
        for (entry, size) in self.entries.iter_mut().zip(&sizes) {
            if entry.abs().nearest() <= LEFT * T::ROUNDING * size {
                *entry = T::default();
            }
        }
    }

    /// The directions in which dependent bilateral rows and others cancel each other: combinations of the w that are
    /// constant, if the rows depend on bilateral rows alone.
    pub(crate) fn null_directions(&self) -> Vec<Vec<T>> {
        let dependent = (0..self.n).filter(|&row| self.free[row] && self.basic[row] < self.n);
        let direction = |row: usize| {
            let mut direction = vec![T::default(); self.n];
            direction[self.basic[row]] = T::from(1.0);
            for (column, &variable) in self.nonbasic.iter().enumerate().filter(|(_, v)| **v < self.n) {
                direction[variable] = -self.at(row, column);
            }
            direction
        };
        dependent.map(direction).collect()
    }

    /// Adds the terms of a pivot to the sums of absolute terms of the entries.
    fn add_sizes(&self, sizes: &mut [f64], row: usize, column: usize) {
        let width = self.n + 2;
        let pivot = self.at(row, column).abs().nearest();
        let mut pivot_row: Vec<f64> =
            sizes[row * width..(row + 1) * width].iter().map(|v| v / pivot).collect();
        pivot_row[column] = 1.0 / pivot;
        for (i, sizes) in sizes.chunks_exact_mut(width).enumerate().filter(|(i, _)| *i != row) {
            let factor = self.at(i, column).abs().nearest();
            if factor > 0.0 {
                sizes[column] = 0.0;
                sizes.iter_mut().zip(&pivot_row).for_each(|(out, p)| *out += factor * p);
            }
        }
        sizes[row * width..(row + 1) * width].copy_from_slice(&pivot_row);
    }

    /// Of the rows that grow with the variable of a column, the one that becomes feasible last. `None` if none of them
    /// is infeasible.
    pub(crate) fn last_covered(&mut self, column: usize) -> Option<usize> {
        self.candidates.clear();
        for row in (0..self.n).filter(|&row| !self.free[row]) {
            if self.at(row, column) > T::default() {
                self.candidates.push(row);
            }
        }
        if self.candidates.iter().all(|&row| self.constant(row) >= T::default()) {
            return None;
        }
        self.break_ties(column, None)
    }

    /// The row that blocks the variable of a column first; `None` if none does.
    pub(crate) fn blocking(&mut self, column: usize) -> Option<usize> {
        let sizes = (0..self.n).map(|row| self.at(row, column).abs());
        let largest = sizes.fold(T::from(COLUMN), larger);
        let least = T::from(PIVOT * T::ROUNDING) * largest;
        self.candidates.clear();
        let blocks = |row: &usize| !self.free[*row] && self.at(*row, column) < -least;
        let rows = (0..self.n).filter(blocks).collect::<Vec<_>>();
        self.candidates.extend(rows);
        self.break_ties(column, Some(self.artificial()))
    }

    /// Narrows the candidates to the one with the lexicographically least ratio, or the `preferred` variable if it
    /// ties.
    fn break_ties(&mut self, column: usize, preferred: Option<usize>) -> Option<usize> {
        let mut level = None;
        loop {
            let ratio = |row: usize| {
                let perturbed = match level {
                    None => self.constant(row),
                    Some(w) => self.perturbation(row, w),
                };
                perturbed / self.at(row, column).abs()
            };
            let ratios = self.candidates.iter().map(|&row| ratio(row));
            let least = ratios.reduce(|p, q| if q < p { q } else { p })?;
            let limit = least + T::from(TIE * T::ROUNDING) * (T::from(1.0) + least.abs());
            let kept: Vec<usize> =
                self.candidates.iter().copied().filter(|&row| ratio(row) <= limit).collect();
            self.candidates = kept;
            if self.candidates.len() <= 1 {
                return self.candidates.first().copied();
            }
            let leaves = |&&row: &&usize| preferred == Some(self.basic[row]);
            if let Some(&row) = self.candidates.iter().find(leaves) {
                return Some(row);
            }
            let next = level.map_or(0, |w| w + 1);
            if next == self.n {
                return self.largest_pivot(column);
            }
            level = Some(next);
        }
    }

    fn largest_pivot(&self, column: usize) -> Option<usize> {
        let size = |row: usize| self.at(row, column).abs();
        self.candidates.iter().copied().reduce(|p, q| if size(q) >= size(p) { q } else { p })
    }

    /// Entry of B⁻¹ in a row and the column of w, which is the coefficient of its power of ε.
    fn perturbation(&self, row: usize, w: usize) -> T {
        match self.column_of_w[w] {
            NONE => T::from(f64::from(u8::from(self.basic[row] == w))),
            column => -self.at(row, column as usize),
        }
    }

    /// Exchanges the variables of a row and a column. Returns the variable that left the basis.
    pub(crate) fn pivot(&mut self, row: usize, column: usize) -> usize {
        let (n, width) = (self.n, self.n + 2);
        let inverse = T::from(1.0) / self.at(row, column);
        self.pivot_row.clear();
        self.pivot_row.extend(self.entries[row * width..(row + 1) * width].iter().map(|v| -*v * inverse));
        self.pivot_row[column] = inverse;
        for (i, entries) in self.entries.chunks_exact_mut(width).enumerate() {
            let factor = entries[column];
            if i != row && factor != T::default() {
                entries[column] = T::default();
                entries.iter_mut().zip(&self.pivot_row).for_each(|(out, p)| *out = *out + factor * *p);
            }
        }
        self.entries[row * width..(row + 1) * width].copy_from_slice(&self.pivot_row);
        let (leaving, entering) = (self.basic[row], self.nonbasic[column]);
        self.basic[row] = entering;
        self.nonbasic[column] = leaving;
        if leaving < n {
            self.column_of_w[leaving] = column as u32;
        }
        if entering < n {
            self.column_of_w[entering] = NONE;
        }
        leaving
    }

    /// Change of every basic variable per unit of the variable of a column.
    pub(crate) fn ray(&self, column: usize) -> impl Iterator<Item = (usize, T)> + '_ {
        self.basic.iter().enumerate().map(move |(row, &variable)| (variable, self.at(row, column)))
    }
}

fn larger<T: Number>(p: T, q: T) -> T {
    if q > p { q } else { p }
}
