//! The entries of A = J M⁻¹ Jᵀ for rows of bodies, each formed once from products whose places are known.
//!
//! Contacts keep their bodies from step to step while coefficients change, so the places are found once and kept while
//! the same columns appear in the same rows.

use std::ops::Range;

use crate::matrix::BodyRows;

/// Number of products per row above which they are not listed: rows of many contacts of one body, whose A is full.
const MOST_PER_ROW: usize = 64;

/// The entries A_ij of rows that share a movable column.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Entries {
    /// The pattern that the places are for: offsets and columns of the rows, and one flag per movable column.
    start: Vec<usize>,
    column: Vec<usize>,
    movable: Vec<bool>,
    listed: bool,
    /// The two rows i < j of each entry off the diagonal, and where its products end.
    rows: Vec<[u32; 2]>,
    end: Vec<u32>,
    /// Places of the coefficients of both rows.
    factors: Vec<[u32; 2]>,
    /// The entries by rows, each twice: where a row begins, the other row of each, and the two places of each entry.
    row_start: Vec<u32>,
    other: Vec<u32>,
    place: Vec<[u32; 2]>,
    /// Rows per column while listing: offsets and (row, place).
    touching_start: Vec<u32>,
    touching: Vec<[u32; 2]>,
    /// Other row, and places, of one row's products.
    found: Vec<[u32; 3]>,
    /// A_ij [1/kg] by entry.
    value: Vec<f64>,
    /// A_ii, s_i = sqrt(A_ii) (1 where A_ii = 0) and 1/s_i.
    diagonal: Vec<[f64; 3]>,
    /// The coefficients and inverse masses from which the entries were formed.
    formed_from: [Vec<f64>; 2],
    /// J M⁻¹ by place.
    response: Vec<f64>,
}

impl Entries {
    /// Forms the entries if the pattern is that of the last call, as places that serve only once are not worth finding.
    /// Returns whether there are entries.
    pub(crate) fn load(&mut self, bodies: &BodyRows) -> bool {
        let listed = self.prepare(bodies);
        let BodyRows { rows, inverse_mass } = bodies;
        let [coefficients, masses] = &self.formed_from;
        let same = self.are_formed() && *coefficients == rows.value && masses == inverse_mass;
        if listed && !same {
            self.formed_from[0].clone_from(&rows.value);
            self.formed_from[1].clone_from(inverse_mass);
            self.form(bodies);
        }
        listed
    }

    /// Drops the entries and keeps their places.
    pub(crate) fn forget(&mut self) {
        self.value.clear();
    }

    /// Whether the places of this pattern were looked for.
    pub(crate) fn are_listed(&self) -> bool {
        self.listed
    }

    /// Whether the entries are formed.
    pub(crate) fn are_formed(&self) -> bool {
        !self.value.is_empty()
    }

    /// A_ii [1/kg], s_i = sqrt(A_ii) (1 where A_ii = 0) and 1/s_i by row.
    pub(crate) fn diagonal(&self) -> &[[f64; 3]] {
        &self.diagonal
    }

    /// The entries off the diagonal: rows i < j, and A_ij [1/kg].
    pub(crate) fn off_diagonal(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        self.rows.iter().zip(&self.value).map(|(&[i, j], &value)| (i as usize, j as usize, value))
    }

    /// The range of a row's entries among all entries by rows, and the other row of each.
    pub(crate) fn of_row(&self, row: usize) -> (Range<usize>, &[u32]) {
        let range = self.row_start[row] as usize..self.row_start[row + 1] as usize;
        (range.clone(), &self.other[range])
    }

    /// Writes the entries by rows, those of rows i and j times `scale[i] scale[j]`.
    pub(crate) fn write_by_rows(&self, scale: &[f64], out: &mut Vec<f64>) {
        out.resize(self.other.len(), 0.0);
        for ((&[i, j], places), value) in self.rows.iter().zip(&self.place).zip(&self.value) {
            let scaled = value * (scale[i as usize] * scale[j as usize]);
            places.iter().for_each(|&place| out[place as usize] = scaled);
        }
    }

    fn form(&mut self, bodies: &BodyRows) {
        let BodyRows { rows, inverse_mass } = bodies;
        let j = &rows.value;
        self.response.clear();
        self.response.extend(rows.column.iter().zip(j).map(|(&k, v)| v * inverse_mass[k]));
        self.diagonal.clear();
        self.diagonal.extend(rows.start.windows(2).map(|ends| {
            let range = ends[0]..ends[1];
            let products = j[range.clone()].iter().zip(&self.response[range]);
            let diagonal: f64 = products.map(|(v, y)| v * y).sum();
            let s = if diagonal > 0.0 { diagonal.sqrt() } else { 1.0 };
            [diagonal, s, 1.0 / s]
        }));
        let mut begin = 0;
        self.value.clear();
        self.value.extend(self.end.iter().map(|&end| {
            let factors = &self.factors[begin..end as usize];
            begin = end as usize;
            factors.iter().map(|&[x, y]| j[x as usize] * self.response[y as usize]).sum::<f64>()
        }));
    }

    fn prepare(&mut self, bodies: &BodyRows) -> bool {
        let movable = bodies.inverse_mass.iter().map(|w| *w > 0.0);
        let known = self.start == bodies.rows.start
            && self.column == bodies.rows.column
            && movable.clone().eq(self.movable.iter().copied());
        if !known {
            self.start.clone_from(&bodies.rows.start);
            self.column.clone_from(&bodies.rows.column);
            self.movable.clear();
            self.movable.extend(movable);
            self.listed = false;
            self.rows.clear();
            self.value.clear();
        } else if !self.listed {
            self.listed = true;
            self.list();
        }
        !self.rows.is_empty()
    }

    /// Lists all products, unless they are too many.
    fn list(&mut self) {
        self.rows.clear();
        self.end.clear();
        self.factors.clear();
        self.list_touching();
        let squares = self.touching_start.windows(2).map(|w| (w[1] - w[0]) as usize);
        if squares.map(|n| n * n).sum::<usize>() > 2 * MOST_PER_ROW * (self.start.len() - 1) {
            return;
        }
        for row in 0..self.start.len() - 1 {
            self.list_row(row);
        }
        self.list_by_rows();
    }

    /// Finds the places of the entries by rows.
    fn list_by_rows(&mut self) {
        let n = self.start.len() - 1;
        self.row_start.clear();
        self.row_start.resize(n + 2, 0);
        for row in self.rows.iter().flatten() {
            self.row_start[*row as usize + 2] += 1;
        }
        for i in 2..n + 2 {
            self.row_start[i] += self.row_start[i - 1];
        }
        self.other.clear();
        self.other.resize(2 * self.rows.len(), 0);
        self.place.clear();
        for &[i, j] in &self.rows {
            self.place.push([(i, j), (j, i)].map(|(row, other)| {
                let next = &mut self.row_start[row as usize + 1];
                self.other[*next as usize] = other;
                *next += 1;
                *next - 1
            }));
        }
    }

    /// Lists the products of a row with later ones.
    fn list_row(&mut self, row: usize) {
        self.found.clear();
        for e in self.start[row]..self.start[row + 1] {
            let k = self.column[e];
            let touching =
                &self.touching[self.touching_start[k] as usize..self.touching_start[k + 1] as usize];
            let later = touching.iter().filter(|[other, _]| *other as usize > row);
            self.found.extend(later.map(|&[other, place]| [other, e as u32, place]));
        }
        self.found.sort_unstable();
        for &[other, e, place] in &self.found {
            if self.rows.last() != Some(&[row as u32, other]) {
                self.rows.push([row as u32, other]);
                self.end.push(0);
            }
            self.factors.push([e, place]);
            if let Some(end) = self.end.last_mut() {
                *end = self.factors.len() as u32;
            }
        }
    }

    /// Lists the rows by movable column, each with the place of its coefficient.
    fn list_touching(&mut self) {
        self.touching_start.clear();
        self.touching_start.resize(self.movable.len() + 2, 0);
        for &k in self.column.iter().filter(|k| self.movable[**k]) {
            self.touching_start[k + 2] += 1;
        }
        for k in 2..self.touching_start.len() {
            self.touching_start[k] += self.touching_start[k - 1];
        }
        self.touching.clear();
        self.touching.resize(self.touching_start.last().map_or(0, |&end| end as usize), [0; 2]);
        for row in 0..self.start.len() - 1 {
            for e in self.start[row]..self.start[row + 1] {
                let k = self.column[e];
                if self.movable[k] {
                    let next = &mut self.touching_start[k + 1];
                    self.touching[*next as usize] = [row as u32, e as u32];
                    *next += 1;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ProblemError;
    use crate::matrix::Matrix;
    use crate::problem::Problem;

    #[test]
    fn entries_are_those_of_the_product_from_the_second_time_on() -> Result<(), ProblemError> {
        // Rows 0 and 1 share a body that moves, rows 1 and 2 one that does not.
        let rows =
            [(0, 0, 1.0), (0, 1, 2.0), (1, 0, -3.0), (1, 1, 0.5), (1, 2, 4.0), (2, 2, 5.0), (2, 3, 1.0)];
        let problem = Problem::from_rows(&rows, &[0.5, 2.0, 0.0, 1.0], &[0.0; 3])?;
        let Matrix::Bodies(bodies) = &problem.matrix else { panic!("rows of bodies") };
        let mut entries = Entries::default();
        assert!(!entries.load(bodies));
        assert!(entries.load(bodies));
        let dense = problem.dense();
        let found: Vec<_> = entries.off_diagonal().collect();
        assert_eq!(found, [(0, 1, dense[0][1])]);
        let diagonal: Vec<f64> = entries.diagonal().iter().map(|[a, ..]| *a).collect();
        assert_eq!(diagonal, [dense[0][0], dense[1][1], dense[2][2]]);
        let mut by_rows = Vec::new();
        entries.write_by_rows(&[1.0, 2.0, 1.0], &mut by_rows);
        assert_eq!((entries.of_row(1), by_rows[1]), ((1..2, &[0][..]), 2.0 * dense[0][1]));
        Ok(())
    }
}
