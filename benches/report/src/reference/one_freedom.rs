//! Mechanisms with one degree of freedom that never turn back.
//!
//! Energy gives the rate of the coordinate as a function of the coordinate alone; the time is then an
//! integral, taken by Gauss's rule on pieces that end where the rate has kinks, and solved for the coordinate
//! by Newton's method.

/// Points of the rule on each piece.
const POINTS: usize = 12;
/// Newton's method for the nodes, and for the coordinate at a time, ends by rounding well before this.
const MOST_ROUNDS: usize = 50;

/// A coordinate whose rate is known as a function of it.
pub(crate) struct OneFreedom<'a> {
    /// The rate of the coordinate, positive.
    pub(crate) rate: &'a dyn Fn(f64) -> f64,
    /// Where it starts.
    pub(crate) start: f64,
    /// Places at which the rate is not smooth, ascending.
    pub(crate) kinks: Vec<f64>,
    /// Longest piece.
    pub(crate) piece: f64,
}

impl OneFreedom<'_> {
    /// The coordinate at a time, and what it differs by if pieces are twice as long.
    #[must_use]
    pub(crate) fn at(&self, time: f64) -> (f64, f64) {
        let fine = self.coordinate(time, self.piece);
        (fine, (fine - self.coordinate(time, 2.0 * self.piece)).abs())
    }

    /// The time at which a coordinate is reached.
    #[must_use]
    pub(crate) fn time_of(&self, coordinate: f64) -> f64 {
        let (mut from, mut time) = (self.start, 0.0);
        while from < coordinate {
            let to = self.next(from, self.piece).min(coordinate);
            time += self.duration(from, to);
            from = to;
        }
        time
    }

    fn coordinate(&self, time: f64, piece: f64) -> f64 {
        let (mut from, mut left) = (self.start, time);
        loop {
            let to = self.next(from, piece);
            let duration = self.duration(from, to);
            if duration >= left {
                return self.within(from, left);
            }
            (from, left) = (to, left - duration);
        }
    }

    /// The coordinate after a short time.
    fn within(&self, from: f64, time: f64) -> f64 {
        let mut to = from + time * (self.rate)(from);
        for _ in 0..MOST_ROUNDS {
            let correction = (time - self.duration(from, to)) * (self.rate)(to);
            to += correction;
            if correction.abs() <= f64::EPSILON * to.abs() {
                break;
            }
        }
        to
    }

    fn next(&self, from: f64, piece: f64) -> f64 {
        let kink = self.kinks.iter().copied().find(|&kink| kink > from).unwrap_or(f64::INFINITY);
        (from + piece).min(kink)
    }

    fn duration(&self, from: f64, to: f64) -> f64 {
        let (half, middle) = (0.5 * (to - from), 0.5 * (to + from));
        nodes().iter().map(|(node, weight)| half * weight / (self.rate)(middle + half * node)).sum()
    }
}

/// Nodes and weights of Gauss's rule on [-1, 1]: the roots of the Legendre polynomial, by Newton's method.
fn nodes() -> [(f64, f64); POINTS] {
    let count = POINTS as f64;
    std::array::from_fn(|index| {
        let mut node = (std::f64::consts::PI * (index as f64 + 0.75) / (count + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..MOST_ROUNDS {
            let (mut before, mut value) = (1.0, node);
            for degree in 2..=POINTS {
                let degree = degree as f64;
                let next = ((2.0 * degree - 1.0) * node * value - (degree - 1.0) * before) / degree;
                (before, value) = (value, next);
            }
            slope = count * (node * value - before) / (node * node - 1.0);
            let correction = value / slope;
            node -= correction;
            if correction.abs() < f64::EPSILON {
                break;
            }
        }
        (node, 2.0 / ((1.0 - node * node) * slope * slope))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_with_a_closed_form_is_met() {
        // x' = 1 + x^2 from 0: x = tan t.
        let rate = |x: f64| 1.0 + x * x;
        let motion = OneFreedom { rate: &rate, start: 0.0, kinks: Vec::new(), piece: 0.1 };
        let (x, error) = motion.at(1.2);
        assert!((x - 1.2_f64.tan()).abs() < 1e-14 && error < 1e-14, "{x} {error}");
        assert!((motion.time_of(2.0) - 2.0_f64.atan()).abs() < 1e-15);
    }
}
