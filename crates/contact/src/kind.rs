//! Kinds of rows: how the force of a row and its acceleration belong together, and in which direction the force acts.
//!
//! *Invariant*: the symmetric methods see plain rows only. Rows that are not plain are few and are listed apart, so that a problem
//! without them costs nothing for them.

use crate::error::{ProblemError, SolveError};
use crate::matrix::{Matrix, SparseMatrix};
use crate::problem::{Problem, Row};
use crate::solver::Method;
use crate::words;

/// How the force f of a row and its acceleration a belong together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum RowKind {
    /// f ≥ 0, a ≥ 0, f a = 0: a contact, a rope, a stop.
    #[default]
    Unilateral,
    /// a = 0 with f of either sign: a connector.
    Bilateral,
    /// least ≤ f ≤ most, where a = 0 between the bounds, a ≥ 0 at the least force and a ≤ 0 at the most: a motor, a brake,
    /// friction in a joint.
    Bounded {
        /// Least force \[N\]; it may be infinite.
        least: f64,
        /// Most force \[N\]; it may be infinite.
        most: f64,
    },
    /// |f| ≤ mu fₙ with the force fₙ of another row, where a = 0 inside the bounds, and a opposes f on them: the tangential
    /// row of a contact with Coulomb friction.
    Friction {
        /// The row whose force bounds this one's, added before it: a unilateral one, or one whose least force is not
        /// negative.
        normal: usize,
        /// Coefficient of friction mu \[-\], 0 or more.
        coefficient: f64,
    },
}

impl RowKind {
    /// The kind of a plain row: bilateral, or unilateral.
    #[must_use]
    #[inline]
    pub fn plain(bilateral: bool) -> Self {
        if bilateral { Self::Bilateral } else { Self::Unilateral }
    }

    /// Words for messages.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Unilateral => words::UNILATERAL,
            Self::Bilateral => words::BILATERAL,
            Self::Bounded { .. } => words::BOUNDED,
            Self::Friction { .. } => words::FRICTION,
        }
    }

    /// True for a row whose force is never negative.
    pub(crate) fn pushes(&self) -> bool {
        match *self {
            Self::Unilateral => true,
            Self::Bounded { least, .. } => least >= 0.0,
            Self::Bilateral | Self::Friction { .. } => false,
        }
    }

    /// True for a unilateral and for a bilateral row.
    #[must_use]
    #[inline]
    pub fn is_plain(&self) -> bool {
        matches!(self, Self::Unilateral | Self::Bilateral)
    }

    /// Refuses bounds that are none, and a normal row that is not a unilateral one of `problem`.
    pub(crate) fn check(&self, row: usize, problem: &Problem) -> Result<(), ProblemError> {
        match *self {
            Self::Unilateral | Self::Bilateral => Ok(()),
            // NaN is no bound.
            Self::Bounded { least, most } if least <= most => Ok(()),
            Self::Bounded { least, most } => Err(ProblemError::BadBounds { row, least, most }),
            Self::Friction { normal, coefficient } => {
                let is_contact = normal != row && normal < problem.len() && problem.kind(normal).pushes();
                if !is_contact {
                    return Err(ProblemError::NotAContact { row, normal });
                }
                let is_sound = coefficient.is_finite() && coefficient >= 0.0;
                if is_sound { Ok(()) } else { Err(ProblemError::BadFriction { row, coefficient }) }
            }
        }
    }
}

/// The direction of a force: the bodies of the primary and of the normal side, `None` for an immovable one, and the
/// coefficients for x, y \[1\] and rotation \[m\] of each.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Direction {
    pub(crate) bodies: [Option<u32>; 2],
    pub(crate) coefficients: [[f64; 3]; 2],
}

impl Direction {
    /// Columns and coefficients.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (usize, f64)> {
        let Self { bodies, coefficients } = *self;
        let sides = bodies.into_iter().zip(coefficients);
        sides.flat_map(|(body, coefficients)| {
            let first = body.map(|body| 3 * body as usize);
            (0..3).filter_map(move |k| first.map(|first| (first + k, coefficients[k])))
        })
    }
}

/// The rows of a problem that are not plain, ascending.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct FurtherRows(Vec<(usize, RowKind, Option<Direction>)>);

impl FurtherRows {
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Forgets the rows from `rows` on.
    pub(crate) fn truncate(&mut self, rows: usize) {
        self.0.retain(|further| further.0 < rows);
    }

    fn find(&self, row: usize) -> Option<&(usize, RowKind, Option<Direction>)> {
        self.0.binary_search_by_key(&row, |further| further.0).ok().map(|place| &self.0[place])
    }

    /// Kind of a row; `None` if it is unilateral or bilateral.
    pub(crate) fn kind(&self, row: usize) -> Option<RowKind> {
        self.find(row).map(|further| further.1).filter(|kind| !kind.is_plain())
    }

    /// Direction of the force of a row; `None` if it acts in the direction that is measured.
    pub(crate) fn direction(&self, row: usize) -> Option<Direction> {
        self.find(row).and_then(|further| further.2)
    }

    /// True if a force acts in a direction of its own.
    pub(crate) fn has_directions(&self) -> bool {
        self.0.iter().any(|further| further.2.is_some())
    }

    /// Writes along what the forces act to `pushes`, for rows that measure `rows`. Columns of a turned row may come twice.
    pub(crate) fn turn(&self, rows: &SparseMatrix, pushes: &mut SparseMatrix) {
        pushes.clone_from(&SparseMatrix::new());
        for row in 0..rows.rows() {
            match self.direction(row) {
                Some(direction) => {
                    pushes.column.extend(direction.entries().map(|entry| entry.0));
                    pushes.value.extend(direction.entries().map(|entry| entry.1));
                }
                None => {
                    let (columns, values) = rows.row(row);
                    pushes.column.extend_from_slice(columns);
                    pushes.value.extend_from_slice(values);
                }
            }
            pushes.start.push(pushes.column.len());
        }
    }

    /// The rows that are not plain, or whose force acts in a direction of its own, and their kinds.
    pub(crate) fn kinds(&self) -> impl Iterator<Item = (usize, RowKind)> + '_ {
        self.0.iter().filter(|further| !further.1.is_plain()).map(|&(row, kind, _)| (row, kind))
    }

    /// Sets the kind of a row.
    pub(crate) fn set_kind(&mut self, row: usize, kind: RowKind) {
        match self.0.binary_search_by_key(&row, |further| further.0) {
            Ok(place) if kind.is_plain() && self.0[place].2.is_none() => drop(self.0.remove(place)),
            Ok(place) => self.0[place].1 = kind,
            Err(_) if kind.is_plain() => {}
            Err(place) => self.0.insert(place, (row, kind, None)),
        }
    }

    /// Refuses bounds and directions that are none, of the row that is to be added to a problem.
    pub(crate) fn check_row(
        row: usize,
        kind: RowKind,
        direction: Option<Direction>,
        problem: &Problem,
    ) -> Result<(), ProblemError> {
        kind.check(row, problem)?;
        let mut numbers = direction.iter().flat_map(|direction| direction.coefficients).flatten();
        match numbers.find(|number| !number.is_finite()) {
            Some(value) => Err(ProblemError::NotFinite { row, what: "a coefficient of the force", value }),
            None => Ok(()),
        }
    }

    /// Adds a row behind those before, unless it is plain.
    pub(crate) fn push(&mut self, row: usize, kind: RowKind, direction: Option<Direction>) {
        if !kind.is_plain() || direction.is_some() {
            self.0.push((row, kind, direction));
        }
    }
}

impl Problem {
    /// Adds the two rows of a contact with friction: that of its gap, which is made unilateral, and that of its slip.
    /// Returns the numbers of both.
    ///
    /// The slip of a contact at a point p, with the normal n and t = n turned by +90 degrees, is measured by the coefficients
    /// (t, (p - x) × t) of the primary and their opposites of the normal side, with p the same point for both.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row, or the coefficient; the problem is unchanged then.
    ///
    /// # Examples
    ///
    /// A block of 1 kg on the floor, pushed sideways at its centre with 2 N: mu = 0.3 would hold 2.943 N.
    ///
    /// ```
    /// use halfgap_contact::{Auto, InverseInertia, Problem, Row, Solution, Solver};
    ///
    /// let mut problem = Problem::new();
    /// let block = problem.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 6.0 })?;
    /// for x in [-0.5, 0.5] {
    ///     // The corner lies at (x, -0.5) from the centre; the tangent points to -x.
    ///     let (gap, slip) = (Row::new(block, [0.0, 1.0, x], -9.81), Row::new(block, [-1.0, 0.0, -0.5], -2.0));
    ///     problem.add_contact(&gap, &slip, 0.3)?;
    /// }
    /// let mut solution = Solution::new();
    /// Auto::default().solve(&problem, &mut solution)?;
    /// assert!((solution.force[1] + solution.force[3] - 2.0).abs() < 1e-12 && solution.acceleration[1].abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn add_contact(
        &mut self,
        gap: &Row,
        slip: &Row,
        coefficient: f64,
    ) -> Result<[usize; 2], ProblemError> {
        let normal = self.add_row(&Row { kind: RowKind::Unilateral, ..*gap })?;
        match self.add_row(&slip.friction(normal, coefficient)) {
            Ok(tangential) => Ok([normal, tangential]),
            Err(error) => {
                self.pop_row();
                Err(error)
            }
        }
    }

    /// Takes the last row off.
    fn pop_row(&mut self) {
        if let Matrix::Bodies(bodies) = &mut self.matrix {
            bodies.rows.pop_row();
        }
        self.offset.pop();
        self.bilateral.pop();
        self.further.truncate(self.offset.len());
        self.keys.truncate(self.offset.len());
    }

    /// Changes the kind of a row, such as one of a matrix, which has no other way to friction.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the bounds that are none, or a normal row that is not a unilateral one; the problem is
    /// unchanged then.
    ///
    /// # Panics
    ///
    /// If there is no such row.
    pub fn set_kind(&mut self, row: usize, kind: RowKind) -> Result<(), ProblemError> {
        assert!(row < self.len(), "row {row} of {}", self.len());
        kind.check(row, self)?;
        let bounded = |(other, kind): &(usize, RowKind)| match kind {
            RowKind::Friction { normal, .. } => *normal == row && *other != row,
            _ => false,
        };
        if let Some((other, _)) = self.further.kinds().find(bounded)
            && !kind.pushes()
        {
            return Err(ProblemError::NotAContact { row: other, normal: row });
        }
        self.bilateral[row] = kind == RowKind::Bilateral;
        self.further.set_kind(row, kind);
        Ok(())
    }

    /// Refuses, in the name of a method, a problem that has other rows than unilateral and bilateral ones whose forces act
    /// in the directions that are measured.
    ///
    /// # Errors
    ///
    /// [`SolveError::UnsupportedRow`] names the first such row.
    #[inline]
    pub fn require_plain(&self, method: Method) -> Result<(), SolveError> {
        match self.unplain_row() {
            Some((row, kind)) => Err(SolveError::UnsupportedRow { method, row, kind }),
            None => Ok(()),
        }
    }

    /// Refuses, in the name of a method, a problem that is not plain, or not given with a symmetric matrix.
    pub(crate) fn require_symmetric(&self, method: Method) -> Result<(), SolveError> {
        self.require_plain(method)?;
        let reason = words::SYMMETRIC_ONLY;
        if self.is_symmetric() { Ok(()) } else { Err(SolveError::NotApplicable { method, reason }) }
    }

    /// The first row that is not plain, with words for its kind.
    pub(crate) fn unplain_row(&self) -> Option<(usize, &'static str)> {
        let &(row, kind, _) = self.further.0.first()?;
        let turned = "a row whose force acts in another direction than is measured";
        Some((row, if kind.is_plain() { turned } else { kind.name() }))
    }

    /// True if all rows are unilateral or bilateral, with forces in the directions that are measured.
    #[must_use]
    #[inline]
    pub fn is_plain(&self) -> bool {
        self.further.0.is_empty()
    }
}
