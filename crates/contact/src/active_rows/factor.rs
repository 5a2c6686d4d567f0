//! The factor of A = L D Lᵀ, in tiles of four rows and four columns, each row of tiles from its first tile with an
//! entry on. Whole tiles need no special cases at the ends of rows, and four rows at a time do not wait for each
//! other's results; rows of contacts are so short that either would cost more than the products. The parent module
//! forms A and decides which rows have a pivot.

/// Rows and columns of a tile.
const SIDE: usize = 4;
/// A number for each of the rows of a tile.
type Lanes = [f64; SIDE];
/// Columns of a tile, with a number for each row.
type Tile = [Lanes; SIDE];

/// L below its diagonal of ones, and the reciprocals of D.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Factor {
    /// First column of tiles of each row of tiles.
    lead: Vec<usize>,
    /// Where each row of tiles begins in `tiles`; it ends with the one on the diagonal.
    begin: Vec<usize>,
    /// Tiles of A until their row is eliminated, then of L, zero on and above the diagonal.
    tiles: Vec<Tile>,
    /// 1/D; 0 for rows without a pivot, and beyond the last.
    inverse_pivot: Vec<Lanes>,
    /// L D of the row of tiles that is being eliminated, left of the diagonal.
    scaled: Vec<Tile>,
    /// For each row of the tile that is being eliminated, the part of its square that earlier rows of tiles account
    /// for.
    square: Lanes,
    /// L⁻¹ b, and x as far as it is known.
    forward: Vec<Lanes>,
    solution: Vec<Lanes>,
}

impl Factor {
    /// Lays out the tiles for rows whose first entries are in these columns.
    pub(super) fn lay_out(&mut self, first: impl Iterator<Item = usize>) {
        self.lead.clear();
        for (place, first) in first.enumerate() {
            let lead = first.min(place) / SIDE;
            if place % SIDE == 0 {
                self.lead.push(lead);
            } else if let Some(last) = self.lead.last_mut() {
                *last = lead.min(*last);
            }
        }
        self.begin.clear();
        let mut end = 0;
        for (block, lead) in self.lead.iter().enumerate() {
            self.begin.push(end);
            end += block + 1 - lead;
        }
        self.tiles.clear();
        self.tiles.resize(end, Tile::default());
        for lanes in [&mut self.inverse_pivot, &mut self.forward, &mut self.solution] {
            lanes.clear();
            lanes.resize(self.lead.len(), Lanes::default());
        }
    }

    /// Position of an entry within the tiles.
    pub(super) fn position(&self, place: usize, column: usize) -> usize {
        let block = place / SIDE;
        let tile = self.begin[block] + column / SIDE - self.lead[block];
        (tile * SIDE + column % SIDE) * SIDE + place % SIDE
    }

    /// First column of a row's tiles.
    pub(super) fn first(&self, place: usize) -> usize {
        self.lead[place / SIDE] * SIDE
    }

    /// The entries of a row, from its first column up to the diagonal.
    pub(super) fn entries(&self, place: usize) -> impl Iterator<Item = f64> {
        let first = self.first(place);
        let columns = self.tiles[self.begin[place / SIDE]..].as_flattened();
        columns.iter().take(place - first).map(move |column| column[place % SIDE])
    }

    /// Sets all entries of A to zero.
    pub(super) fn clear(&mut self) {
        self.tiles.fill(Tile::default());
    }

    /// The entries of A below its diagonal by [`position`](Self::position), valid until their rows are eliminated.
    pub(super) fn entries_mut(&mut self) -> &mut [f64] {
        self.tiles.as_flattened_mut().as_flattened_mut()
    }

    /// Eliminates a row; rows must come in order. Returns the part of its square that earlier rows account for.
    pub(super) fn eliminate(&mut self, place: usize) -> f64 {
        let (block, lane) = (place / SIDE, place % SIDE);
        if lane == 0 {
            self.eliminate_left(block);
        }
        let tile = &mut self.tiles[self.begin[block] + block - self.lead[block]];
        let mut square = self.square[lane];
        let mut row = Lanes::default();
        for column in 0..lane {
            let mut entry = tile[column][lane];
            for k in 0..column {
                entry -= row[k] * tile[k][column];
            }
            row[column] = entry;
            let part = entry * self.inverse_pivot[block][column];
            square += entry * part;
            tile[column][lane] = part;
        }
        for column in &mut tile[lane..] {
            column[lane] = 0.0;
        }
        square
    }

    /// Sets the reciprocal of the pivot of a row that was eliminated; 0 if it has none.
    pub(super) fn set_inverse_pivot(&mut self, place: usize, inverse: f64) {
        self.inverse_pivot[place / SIDE][place % SIDE] = inverse;
    }

    /// True if a row has a pivot.
    pub(super) fn has_pivot(&self, place: usize) -> bool {
        self.inverse_pivot[place / SIDE][place % SIDE] != 0.0
    }

    /// Eliminates a row of tiles up to the one on the diagonal, from which the products of the earlier tiles are
    /// subtracted.
    fn eliminate_left(&mut self, block: usize) {
        let lead = self.lead[block];
        let (before, own) = self.tiles.split_at_mut(self.begin[block]);
        self.scaled.clear();
        for (at, tile) in own[..block - lead].iter().enumerate() {
            let other = lead + at;
            let from = self.lead[other].max(lead);
            let theirs = &before
                [self.begin[other] + from - self.lead[other]..=self.begin[other] + other - self.lead[other]];
            // U_J = A_J - sum over K of U_K L_JKᵀ.
            let mut tile = *tile;
            for (scaled, theirs) in self.scaled[from - lead..].iter().zip(theirs) {
                subtract_product(&mut tile, scaled, theirs);
            }
            let corner = &theirs[theirs.len() - 1];
            for column in 1..SIDE {
                for k in 0..column {
                    let (factor, earlier) = (corner[k][column], tile[k]);
                    for (out, entry) in tile[column].iter_mut().zip(earlier) {
                        *out -= factor * entry;
                    }
                }
            }
            self.scaled.push(tile);
        }
        self.square = Lanes::default();
        let (left, corner) = own.split_at_mut(block - lead);
        for ((tile, scaled), inverse) in left.iter_mut().zip(&self.scaled).zip(&self.inverse_pivot[lead..]) {
            for (column, (out, entries)) in tile.iter_mut().zip(scaled).enumerate() {
                for lane in 0..SIDE {
                    out[lane] = entries[lane] * inverse[column];
                    self.square[lane] += entries[lane] * out[lane];
                }
            }
            subtract_product(&mut corner[0], scaled, tile);
        }
    }

    /// Solves L D Lᵀ x = b. `right` returns b by place, zero beyond the last row; `take` is called with each place and
    /// its x.
    pub(super) fn solve(&mut self, right: impl Fn(usize) -> f64, mut take: impl FnMut(usize, f64)) {
        let (y, x) = (&mut self.forward, &mut self.solution);
        for (block, &lead) in self.lead.iter().enumerate() {
            let mut own: Lanes = std::array::from_fn(|lane| right(block * SIDE + lane));
            let tiles = &self.tiles[self.begin[block]..=self.begin[block] + block - lead];
            for (tile, y) in tiles.iter().zip(&y[lead..block]) {
                for (column, y) in tile.iter().zip(y) {
                    for (out, entry) in own.iter_mut().zip(column) {
                        *out -= entry * y;
                    }
                }
            }
            let (corner, [a, mut b, mut c, mut d]) = (&tiles[block - lead], own);
            b -= corner[0][1] * a;
            c -= corner[0][2] * a + corner[1][2] * b;
            d -= corner[0][3] * a + corner[1][3] * b + corner[2][3] * c;
            y[block] = [a, b, c, d];
            let inverse = &self.inverse_pivot[block];
            x[block] = [a * inverse[0], b * inverse[1], c * inverse[2], d * inverse[3]];
        }
        for (block, &lead) in self.lead.iter().enumerate().rev() {
            let tiles = &self.tiles[self.begin[block]..=self.begin[block] + block - lead];
            let (corner, [mut a, mut b, mut c, d]) = (&tiles[block - lead], x[block]);
            c -= corner[2][3] * d;
            b -= corner[1][3] * d + corner[1][2] * c;
            a -= corner[0][3] * d + corner[0][2] * c + corner[0][1] * b;
            let own = [a, b, c, d];
            for (lane, value) in own.into_iter().enumerate() {
                take(block * SIDE + lane, value);
            }
            for (tile, x) in tiles.iter().zip(&mut x[lead..block]) {
                for (out, column) in x.iter_mut().zip(tile) {
                    *out -= dot(column, &own);
                }
            }
        }
    }
}

/// out -= a bᵀ, of tiles.
#[inline]
fn subtract_product(out: &mut Tile, a: &Tile, b: &Tile) {
    for (j, out) in out.iter_mut().enumerate() {
        for (a, b) in a.iter().zip(b) {
            for (out, entry) in out.iter_mut().zip(a) {
                *out -= entry * b[j];
            }
        }
    }
}

#[inline]
fn dot(a: &Lanes, b: &Lanes) -> f64 {
    (a[0] * b[0] + a[2] * b[2]) + (a[1] * b[1] + a[3] * b[3])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entry of a matrix whose rows begin at different columns; its diagonal outweighs the others.
    fn entry(first: &[usize], row: usize, column: usize) -> f64 {
        let (row, column) = (row.max(column), row.min(column));
        match row - column {
            0 => 4.0 + (row % 3) as f64,
            _ if column < first[row] => 0.0,
            apart => 1.0 / (1.0 + apart as f64 + ((3 * row + column) % 5) as f64),
        }
    }

    /// First columns of the rows, from the diagonal to far away from it.
    fn first_columns(count: usize) -> Vec<usize> {
        (0..count).map(|row| row.saturating_sub((row * 7 + row / 3) % 11)).collect()
    }

    #[test]
    fn rows_of_any_length_are_solved_for() {
        for count in 0..23 {
            let first = first_columns(count);
            let mut factor = Factor::default();
            factor.lay_out(first.iter().copied());
            // The second time over the entries that the first has left.
            for _ in 0..2 {
                factor.clear();
                for (row, &first_of_row) in first.iter().enumerate() {
                    for column in first_of_row..row {
                        let position = factor.position(row, column);
                        factor.entries_mut()[position] = entry(&first, row, column);
                    }
                }
                for row in 0..count {
                    let left = entry(&first, row, row) - factor.eliminate(row);
                    factor.set_inverse_pivot(row, 1.0 / left);
                }
                let known = |row: usize| 1.0 + row as f64;
                let product = |row| (0..count).map(|column| entry(&first, row, column) * known(column)).sum();
                let right: Vec<f64> = (0..count).map(product).collect();
                let mut largest = 0.0f64;
                factor.solve(
                    |row| right.get(row).copied().unwrap_or_default(),
                    |row, value| {
                        let expected = if row < count { known(row) } else { 0.0 };
                        largest = largest.max((value - expected).abs());
                    },
                );
                assert!(largest < 1e-13, "{count} rows: {largest}");
            }
        }
    }

    #[test]
    fn a_row_without_a_pivot_has_nothing_and_gives_nothing() {
        // The sixth row repeats the second.
        let count = 7;
        let first = vec![0; count];
        let of = |row: usize| if row == 5 { 1 } else { row };
        let mut factor = Factor::default();
        factor.lay_out(first.iter().copied());
        for row in 0..count {
            for column in 0..row {
                let position = factor.position(row, column);
                factor.entries_mut()[position] = entry(&first, of(row), of(column));
            }
        }
        for row in 0..count {
            let left = entry(&first, of(row), of(row)) - factor.eliminate(row);
            assert_eq!(left.abs() < 1e-14, row == 5, "row {row}: {left}");
            factor.set_inverse_pivot(row, if row == 5 { 0.0 } else { 1.0 / left });
            assert_eq!(factor.has_pivot(row), row != 5);
        }
        let known = |row: usize| if row == 5 { 0.0 } else { 1.0 + row as f64 };
        let product = |row| (0..count).map(|column| entry(&first, of(row), of(column)) * known(column)).sum();
        let right: Vec<f64> = (0..count).map(product).collect();
        factor.solve(
            |row| right.get(row).copied().unwrap_or_default(),
            |row, value| assert!(row >= count || (value - known(row)).abs() < 1e-13, "row {row}: {value}"),
        );
    }
}
