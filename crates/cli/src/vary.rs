//! The option `--vary` of `halfgap sweep`: a field and its values.

use halfgap::scene::FieldPath;
use std::str::FromStr;

/// Largest number of runs; more are taken for a mistake.
const MOST_VALUES: usize = 10_000_000;

/// Spacing of the values between the ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Spacing {
    /// Equal differences.
    Even,
    /// Equal ratios, as for tolerances.
    Geometric,
}

/// A field and its values.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Vary {
    pub(crate) field: FieldPath,
    from: f64,
    to: f64,
    count: usize,
    spacing: Spacing,
}

impl Vary {
    /// Returns the values in order; the ends are as given, to the last bit.
    pub(crate) fn values(&self) -> Vec<f64> {
        let last = self.count - 1;
        let value = |index: usize| match index {
            0 => self.from,
            index if index == last => self.to,
            index => {
                let part = index as f64 / last as f64;
                match self.spacing {
                    Spacing::Even => self.from + (self.to - self.from) * part,
                    Spacing::Geometric => self.from * libm::pow(self.to / self.from, part),
                }
            }
        };
        (0..self.count).map(value).collect()
    }
}

impl FromStr for Vary {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = || {
            let (field, range) = text.rsplit_once('=')?;
            let (ends, count) = range.split_once('/')?;
            let (from, to) = ends.split_once("..")?;
            Some((field, from, to, count))
        };
        let (field, from, to, count) = parts()
            .ok_or("must be like body.ball.elasticity=0.1..0.9/9, FIELD=A..B/N or FIELD=A..B/N/log")?;
        let field = field.parse().map_err(|error| format!("{error}"))?;
        let number = |text: &str| match text.trim().parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(format!("A and B must be finite numbers, got {text}")),
        };
        let (from, to) = (number(from)?, number(to)?);
        let (count, spacing) = match count.split_once('/') {
            None => (count, Spacing::Even),
            Some((count, "log")) if from * to > 0.0 => (count, Spacing::Geometric),
            Some((_, "log")) => return Err("with /log, A and B must not be 0, and of one sign".to_owned()),
            Some((_, other)) => return Err(format!("the spacing after N can be `log` only, got `{other}`")),
        };
        match count.trim().parse() {
            Ok(count @ 1..=MOST_VALUES) => Ok(Self { field, from, to, count, spacing }),
            _ => Err(format!("N must be a whole number from 1 to {MOST_VALUES}, got {count}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_even_and_include_the_ends() {
        let vary: Vary = "run.tolerance=-1..0.5/4".parse().expect("it is well formed");
        assert_eq!(vary.field.to_string(), "run.tolerance");
        assert_eq!(vary.values(), [-1.0, -0.5, 0.0, 0.5]);
        let one: Vary = "body[0].mass=1e-3..2/1".parse().expect("it is well formed");
        assert_eq!(one.values(), [1e-3]);
    }

    #[test]
    fn values_can_have_equal_ratios() {
        let vary: Vary = "run.tolerance=1e-2..1e-8/4/log".parse().expect("it is well formed");
        let values = vary.values();
        assert_eq!((values.len(), values[0], values[3]), (4, 1e-2, 1e-8));
        assert!((values[1] / 1e-4 - 1.0).abs() < 1e-12 && (values[2] / 1e-6 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn mistakes_in_an_option_are_explained() {
        for (text, why) in [
            ("mass", "FIELD=A..B/N"),
            ("mass=1..2", "FIELD=A..B/N"),
            ("mass=1/2", "FIELD=A..B/N"),
            ("body[=1..2/3", "a field is written like"),
            ("mass=1..inf/3", "finite numbers, got inf"),
            ("mass=1..2/0", "N must be a whole number from 1"),
            ("mass=0..2/3/log", "must not be 0"),
            ("mass=-1..2/3/log", "of one sign"),
            ("mass=1..2/3/lin", "`log` only"),
        ] {
            let error = text.parse::<Vary>().expect_err("it is wrong");
            assert!(error.contains(why), "{text}: {error}");
        }
    }
}
