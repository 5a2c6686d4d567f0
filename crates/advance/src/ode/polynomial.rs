//! A component of the motion along a step, as a polynomial.

/// Largest degree: an integrated velocity of degree 7.
pub(super) const DEGREE: usize = 8;
/// Number of coefficients in the nested form of dense output.
pub(super) const NESTED: usize = 7;

/// A function of time over a step: a polynomial of degree 8 at most.
///
/// Written in `s = 2 offset / step - 1`, which runs from -1 to 1, where monomials are well conditioned and absolute
/// sums of the coefficients are good bounds. Only the constant is as large as the value; the others are as small as the
/// motion. So the values at the start and at the end are those given, up to a few ulps and the rounding of the motion
/// alone. Offsets [s] count from the start of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct SegmentPolynomial {
    /// Monomial coefficients in `s`; the first is the value at the middle.
    coefficients: [f64; DEGREE + 1],
    /// Length of the step [s].
    step: f64,
    /// Rate of `s` [1/s].
    rate: f64,
}

/// Value, first and second derivative with respect to time at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// Value.
    pub value: f64,
    /// First derivative [1/s].
    pub derivative: f64,
    /// Second derivative [1/s^2].
    pub second_derivative: f64,
}

/// Bounds of a function along a step: all values within a distance of a centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// Centre: the value at the middle of the step.
    pub center: f64,
    /// Largest distance from the centre.
    pub radius: f64,
}

impl Spread {
    /// Largest absolute value within the bounds.
    #[must_use]
    #[inline]
    pub fn largest(&self) -> f64 {
        self.center.abs() + self.radius
    }
}

impl SegmentPolynomial {
    /// Integrates a velocity to a position with given values at the start and at the end.
    ///
    /// The integral of the velocity misses the end by about the error of the step. The missing part is put in smoothly,
    /// as `3 x^2 - 2 x^3` of it after the fraction `x` of the step; so the derivatives at the ends are still the
    /// velocity's. A miss within the rounding of the values at the ends is left: over a short step it would be a
    /// velocity.
    ///
    /// The velocity is of degree 7 at most, as dense output is. A power of 8, which
    /// [`through`](SegmentPolynomial::through) may give, has no place in the integral: its contribution is part of the
    /// miss, and the derivative is off by it.
    #[must_use]
    pub fn integrated(start: f64, end: f64, velocity: &SegmentPolynomial) -> Self {
        let half_step = 0.5 * velocity.step;
        let mut motion = [0.0; DEGREE + 1];
        let mut end_motion = 0.0;
        // The highest power of the velocity is zero, for its integral would not fit; highest powers are the smallest.
        for power in (0..DEGREE).rev() {
            let term = half_step * velocity.coefficients[power] * SHARES[power + 1];
            motion[power + 1] = term;
            if power % 2 == 0 {
                motion[0] += term;
                end_motion += 2.0 * term;
            } else {
                motion[0] -= term;
            }
        }
        let missing = (end - start) - end_motion;
        let is_rounding = missing.abs() <= ROUNDING * start.abs().max(end.abs());
        let missing = if is_rounding { 0.0 } else { missing };
        motion[0] += 0.5 * missing;
        motion[1] += 0.75 * missing;
        motion[3] -= 0.25 * missing;
        Self::from_start(start, motion, velocity.step)
    }

    /// The polynomial `start + x (c2 + z (c3 + x (c4 + z (c5 + ...))))`, where `x` is the fraction of the step that has
    /// passed, and `z = 1 - x`.
    ///
    /// Loops go as far as there are powers, though many are zero: so all of it stays in registers.
    pub(super) fn from_nested(start: f64, nested: &[f64; NESTED], step: f64) -> Self {
        let mut motion = [0.0; DEGREE + 1];
        for index in (0..NESTED).rev() {
            motion[0] += nested[index];
            // times (1 + s) / 2 or (1 - s) / 2
            let sign = if index % 2 == 0 { 0.5 } else { -0.5 };
            for power in (1..=NESTED).rev() {
                motion[power] = 0.5 * motion[power] + sign * motion[power - 1];
            }
            motion[0] *= 0.5;
        }
        Self::from_start(start, motion, step)
    }

    /// The sum of the start value and a motion that is zero at the start, given by coefficients in `s`.
    pub(super) fn from_start(start: f64, motion: [f64; DEGREE + 1], step: f64) -> Self {
        let mut coefficients = motion;
        coefficients[0] += start;
        // A step of no length ends where it starts.
        let rate = if step == 0.0 { 0.0 } else { 2.0 / step };
        Self { coefficients, step, rate }
    }

    /// The first derivative with respect to time, as a polynomial [1/s].
    #[must_use]
    #[inline]
    pub fn derivative(&self) -> Self {
        let mut coefficients = [0.0; DEGREE + 1];
        for (power, coefficient) in coefficients[..DEGREE].iter_mut().enumerate() {
            *coefficient = self.rate * POWERS[power + 1] * self.coefficients[power + 1];
        }
        Self { coefficients, ..*self }
    }

    /// Monomial coefficients in `s = 2 offset / step - 1`, the constant first.
    #[must_use]
    #[inline]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Length of the step [s].
    #[must_use]
    #[inline]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Value at an offset [s].
    #[must_use]
    #[inline]
    pub fn value_at(&self, offset: f64) -> f64 {
        let s = self.centered(offset);
        let c = &self.coefficients;
        let slope =
            c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * (c[5] + s * (c[6] + s * (c[7] + s * c[8]))))));
        c[0] + s * slope
    }

    /// First derivative with respect to time at an offset [s].
    #[must_use]
    #[inline]
    pub fn derivative_at(&self, offset: f64) -> f64 {
        let s = self.centered(offset);
        let mut sum = 0.0;
        for power in (1..=DEGREE).rev() {
            sum = sum * s + POWERS[power] * self.coefficients[power];
        }
        self.rate * sum
    }

    /// Second derivative with respect to time at an offset [s].
    #[must_use]
    #[inline]
    pub fn second_derivative_at(&self, offset: f64) -> f64 {
        let s = self.centered(offset);
        let mut sum = 0.0;
        for power in (2..=DEGREE).rev() {
            sum = sum * s + POWERS[power] * POWERS[power - 1] * self.coefficients[power];
        }
        self.rate * self.rate * sum
    }

    /// Value and first derivative at an offset [s], to the bit those of [`SegmentPolynomial::jet_at`].
    #[must_use]
    #[inline]
    pub fn value_and_rate_at(&self, offset: f64) -> (f64, f64) {
        let s = self.centered(offset);
        let (mut motion, mut slope) = (self.coefficients[DEGREE], 0.0);
        for power in (1..DEGREE).rev() {
            slope = slope * s + motion;
            motion = motion * s + self.coefficients[power];
        }
        slope = slope * s + motion;
        (self.coefficients[0] + s * motion, self.rate * slope)
    }

    /// Value, first and second derivative at an offset [s], at less cost than one by one.
    #[must_use]
    #[inline]
    pub fn jet_at(&self, offset: f64) -> Jet {
        let s = self.centered(offset);
        // Horner's scheme thrice: the sums of one line are the coefficients of the next.
        let (mut motion, mut slope, mut half_curvature) = (self.coefficients[DEGREE], 0.0, 0.0);
        for power in (1..DEGREE).rev() {
            half_curvature = half_curvature * s + slope;
            slope = slope * s + motion;
            motion = motion * s + self.coefficients[power];
        }
        // The constant is not in yet: the value is `motion` times s more.
        half_curvature = half_curvature * s + slope;
        slope = slope * s + motion;
        Jet {
            value: self.coefficients[0] + s * motion,
            derivative: self.rate * slope,
            second_derivative: self.rate * self.rate * (2.0 * half_curvature),
        }
    }

    /// Bounds of the value along the step, by the sizes of the coefficients.
    #[must_use]
    #[inline]
    pub fn value_spread(&self) -> Spread {
        self.spread(0, |_| 1.0, 1.0)
    }

    /// Bounds of the first derivative with respect to time along the step.
    #[must_use]
    #[inline]
    pub fn derivative_spread(&self) -> Spread {
        self.spread(1, |power| POWERS[power], self.rate)
    }

    /// Bounds of the second derivative with respect to time along the step.
    #[must_use]
    #[inline]
    pub fn second_derivative_spread(&self) -> Spread {
        self.spread(2, |power| POWERS[power] * POWERS[power - 1], self.rate * self.rate)
    }

    /// Bounds of the third derivative with respect to time along the step.
    #[must_use]
    #[inline]
    pub fn third_derivative_spread(&self) -> Spread {
        let factor = |power: usize| POWERS[power] * POWERS[power - 1] * POWERS[power - 2];
        self.spread(3, factor, self.rate * self.rate * self.rate)
    }

    /// Bounds of a derivative whose constant comes from the power `order`.
    #[inline]
    fn spread(&self, order: usize, factor: impl Fn(usize) -> f64, unit: f64) -> Spread {
        let above = (order + 1..=DEGREE).map(|power| factor(power) * self.coefficients[power].abs());
        Spread {
            center: unit * factor(order) * self.coefficients[order],
            radius: unit.abs() * above.sum::<f64>(),
        }
    }

    #[inline]
    fn centered(&self, offset: f64) -> f64 {
        offset * self.rate - 1.0
    }
}

/// Rounding of a value at an end as a fraction of it: of the sum that makes it, and of a projection after it.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// One over each power, the factor of a term's integral; the first is not read.
const SHARES: [f64; DEGREE + 1] =
    [0.0, 1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0, 1.0 / 6.0, 1.0 / 7.0, 1.0 / 8.0];

/// The powers as numbers.
const POWERS: [f64; DEGREE + 1] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_of_a_place_is_no_velocity() {
        // Far away the end of a short step is off by a last digit, which over the step would be a few cm/s.
        let (start, speed, step) = (933_919.586_384_995_8, -5.0, 2.7e-9);
        let velocity = SegmentPolynomial::from_start(speed, [0.0; DEGREE + 1], step);
        for rounding in [-1.0, 0.0, 1.0] {
            let end = start + speed * step + rounding * f64::EPSILON * start;
            let path = SegmentPolynomial::integrated(start, end, &velocity);
            let errors = [0.0, 0.5, 1.0].map(|part| path.derivative_at(part * step) - speed);
            assert!(errors.iter().all(|error| error.abs() < 1e-14), "{errors:?}");
            assert_eq!(path.value_at(0.0), start);
            assert!((path.value_at(step) - end).abs() <= ROUNDING * start);
        }
    }

    #[test]
    fn a_step_of_no_length_ends_where_it_starts() {
        let path = SegmentPolynomial::from_nested(3.0, &[0.0; NESTED], 0.0);
        assert_eq!(
            [path.value_at(0.0), path.derivative_at(0.0), path.second_derivative_at(0.0)],
            [3.0, 0.0, 0.0]
        );
    }

    #[test]
    fn an_end_off_by_more_than_rounding_is_met() {
        let (start, speed, step) = (933_919.0, -5.0, 0.25);
        let velocity = SegmentPolynomial::from_start(speed, [0.0; DEGREE + 1], step);
        let path = SegmentPolynomial::integrated(start, start - 1.0, &velocity);
        assert_eq!(path.value_at(step), start - 1.0);
    }
}
