//! The complementarity problem of one or two rows, in closed form.
//!
//! A f + b >= 0, f >= 0, f.(A f + b) = 0: for two rows there are four cases of which rows carry a force, and for a
//! positive semidefinite A one of them fits; a bilateral row always carries one. Of two dependent rows (a seam between
//! two blocks) one carries the force for both.

/// Square of the angle [rad] between two rows below which they count as one: the rounding of their entries, and of the
/// rates, would move a body by more across both than the angle does.
pub(super) const DEPENDENT: f64 = 64.0 * f64::EPSILON;

/// What rows leave of each other's squares at least to be solved in doubles, which know it to 1e-16 and so the impulses to
/// 1e-11. Rows that leave less are solved by `near_rows`, which takes some ten times as long.
pub(super) const IN_DOUBLES: f64 = 1e-5;

/// The force f of one row with a f + b = 0; 0 if the row is unilateral and b is not negative.
pub(super) fn solve_one(a: f64, b: f64, bilateral: bool) -> f64 {
    if b < 0.0 || (bilateral && b != 0.0) { -b / a } else { 0.0 }
}

/// The forces of two rows with the symmetric matrix [a00, a01, a11] and offsets [b0, b1]. `None` if the rows nearly
/// depend on each other, or depend and may contradict each other.
pub(super) fn solve_two(
    [a00, a01, a11]: [f64; 3],
    [b0, b1]: [f64; 2],
    bilateral: [bool; 2],
) -> Option<[f64; 2]> {
    let only_first = solve_one(a00, b0, bilateral[0]);
    let only_second = solve_one(a11, b1, bilateral[1]);
    if only_first == 0.0 && only_second == 0.0 {
        return Some([0.0; 2]);
    }
    let determinant = a00 * a11 - a01 * a01;
    if determinant > IN_DOUBLES * a00 * a11 {
        let both = [(a01 * b1 - a11 * b0) / determinant, (a01 * b0 - a00 * b1) / determinant];
        let [first_pushes, second_pushes] = [0, 1].map(|row| bilateral[row] || both[row] >= 0.0);
        if first_pushes && second_pushes {
            return Some(both);
        }
        // In the two cases left one row carries a force; the case fits in which the other row is not driven to close.
        let second_after = b1 + a01 * only_first;
        let first_alone = bilateral[0] || (!bilateral[1] && second_after >= 0.0 && only_first > 0.0);
        return Some(if first_alone { [only_first, 0.0] } else { [0.0, only_second] });
    }
    if determinant > DEPENDENT * a00 * a11 || a01 < 0.0 || bilateral[0] || bilateral[1] {
        return None;
    }
    // Dependent rows: the one with the larger scaled force decides for both.
    let first_decides = only_first * a00.sqrt() >= only_second * a11.sqrt();
    Some(if first_decides { [only_first, 0.0] } else { [0.0, only_second] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_symmetric_landing_loads_both_corners_alike() {
        // A unit square landing flat: A = 1 + 3/2 on the diagonal, 1 - 3/2 beside it.
        assert_eq!(solve_two([2.5, -0.5, 2.5], [-1.0, -1.0], [false; 2]), Some([0.5, 0.5]));
    }

    #[test]
    fn dependent_rows_do_not_divide_by_zero() {
        assert_eq!(solve_two([2.0, 2.0, 2.0], [-1.0, -1.0], [false; 2]), Some([0.5, 0.0]));
    }

    #[test]
    fn dependent_rows_that_may_contradict_each_other_are_left_to_the_solver() {
        assert_eq!(solve_two([2.0, -2.0, 2.0], [-1.0, -1.0], [false; 2]), None);
        assert_eq!(solve_two([2.0, 2.0, 2.0], [-1.0, -1.0], [true, false]), None);
    }

    #[test]
    fn rows_that_nearly_depend_on_each_other_are_left_to_others() {
        let at = |angle: f64| solve_two([1.0, angle.cos(), 1.0], [-1.0, -1.0], [true, true]);
        assert!(at(5e-3).is_some() && at(2e-3).is_none());
    }

    proptest! {
        #[test]
        fn the_answer_is_complementary(
            j0 in prop::array::uniform3(-1.0..1.0f64), j1 in prop::array::uniform3(-1.0..1.0f64),
            b in prop::array::uniform2(-1.0..1.0f64), bilateral in prop::array::uniform2(any::<bool>()),
        ) {
            let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
            let a = [dot(j0, j0), dot(j0, j1), dot(j1, j1)];
            prop_assume!(a[0] > 1e-3 && a[2] > 1e-3 && a[0] * a[2] - a[1] * a[1] > IN_DOUBLES * a[0] * a[2]);
            let f = solve_two(a, b, bilateral).expect("independent rows");
            let after = [a[0] * f[0] + a[1] * f[1] + b[0], a[1] * f[0] + a[2] * f[1] + b[1]];
            let scale = 1.0 + f[0].abs() + f[1].abs();
            for row in 0..2 {
                if bilateral[row] {
                    prop_assert!(after[row].abs() <= 1e-12 * scale);
                } else {
                    prop_assert!(f[row] >= 0.0 && after[row] >= -1e-12 * scale);
                    prop_assert!((f[row] * after[row]).abs() <= 1e-12 * scale * scale);
                }
            }
        }
    }
}
