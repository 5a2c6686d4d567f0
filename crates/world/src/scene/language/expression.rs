//! Expressions: numbers, names, `+ - * / ^`, parentheses and functions.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = signed { ("*" | "/") signed }
//! signed  = { "+" | "-" } power
//! power   = atom [ "^" signed ]
//! atom    = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
//! ```
//!
//! so that -a^2 is -(a^2), a^b^c is a^(b^c), and 2^-1 is allowed. A value is found as the text is read: there is no
//! tree of the expression. *Invariant*: any text ends in a finite number or an error; none recurses deeper than [`DEEPEST`].

use crate::scene::nearest::did_you_mean;
use std::f64::consts::PI;

/// What an expression begins with.
const MARK: char = '=';
/// Largest depth of parentheses, signs and exponents within each other, and of names that are defined by names. People
/// need a handful; a thousand times as many would overflow the stack.
pub(super) const DEEPEST: usize = 100;
/// Names that the language has taken.
const CONSTANTS: [(&str, f64); 1] = [("pi", PI)];

/// A function of one number.
type Function = fn(f64) -> f64;
const FUNCTIONS: [(&str, Function); 12] = [
    ("deg", f64::to_radians),
    ("sqrt", f64::sqrt),
    ("abs", f64::abs),
    ("floor", f64::floor),
    ("sin", libm::sin),
    ("cos", libm::cos),
    ("tan", libm::tan),
    ("asin", libm::asin),
    ("acos", libm::acos),
    ("atan", libm::atan),
    ("exp", libm::exp),
    ("ln", libm::log),
];
/// A function of two numbers.
type OfTwo = fn(f64, f64) -> f64;
/// The first two take more.
const OF_TWO: [(&str, OfTwo); 3] = [("min", f64::min), ("max", f64::max), ("atan2", libm::atan2)];
const OF_MANY: [&str; 2] = ["min", "max"];

/// Values of names: `None` if there is no such name, an error if it has no value.
pub(super) type Lookup<'a> = dyn FnMut(&str) -> Option<Result<f64, String>> + 'a;

/// The expression in a text, if it is one: what follows its `=`.
pub(in crate::scene) fn expression_in(text: &str) -> Option<&str> {
    text.strip_prefix(MARK)
}

/// True if the language itself uses a name.
pub(super) fn is_taken(name: &str) -> bool {
    taken().any(|taken| taken == name)
}

/// True for what can be a name: letters, digits and `_`, no digit first.
pub(super) fn is_name(text: &str) -> bool {
    !text.starts_with(|first: char| first.is_ascii_digit())
        && !text.is_empty()
        && text.chars().all(continues_name)
}

fn taken<'a>() -> impl Iterator<Item = &'a str> {
    let functions = FUNCTIONS.iter().map(|(name, _)| *name).chain(OF_TWO.iter().map(|(name, _)| *name));
    CONSTANTS.iter().map(|(name, _)| *name).chain(functions)
}

fn continues_name(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_'
}

/// Finds the value of an expression; `known` are the names to suggest for one that is unknown.
///
/// # Errors
/// Says what is wrong, with the character where it is.
pub(super) fn evaluate(text: &str, lookup: &mut Lookup<'_>, known: &[&str]) -> Result<f64, String> {
    let mut reader = Reader { text, at: 0, depth: 0, lookup, known };
    let value = reader.sum()?;
    match reader.peek() {
        None => Ok(value),
        Some(_) => Err(reader.unexpected("an operator such as `+`")),
    }
}

/// A place in an expression, before which all has been read.
struct Reader<'a, 'l> {
    text: &'a str,
    /// In bytes.
    at: usize,
    depth: usize,
    lookup: &'a mut Lookup<'l>,
    known: &'a [&'a str],
}

impl<'a> Reader<'a, '_> {
    fn sum(&mut self) -> Result<f64, String> {
        let mut sum = self.product()?;
        loop {
            if self.takes('+') {
                sum += self.product()?;
            } else if self.takes('-') {
                sum -= self.product()?;
            } else {
                return finite(sum);
            }
        }
    }

    fn product(&mut self) -> Result<f64, String> {
        let mut product = self.signed()?;
        loop {
            if self.takes('*') {
                product *= self.signed()?;
            } else if self.takes('/') {
                let divisor = self.signed()?;
                if divisor == 0.0 {
                    return Err("divides by zero".to_owned());
                }
                product /= divisor;
            } else {
                return finite(product);
            }
        }
    }

    fn signed(&mut self) -> Result<f64, String> {
        let mut is_negative = false;
        while let Some(sign @ ('+' | '-')) = self.peek() {
            self.at += sign.len_utf8();
            is_negative ^= sign == '-';
        }
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("is nested deeper than {DEEPEST} levels"));
        }
        let power = self.power()?;
        self.depth -= 1;
        Ok(if is_negative { -power } else { power })
    }

    fn power(&mut self) -> Result<f64, String> {
        let base = self.atom()?;
        if !self.takes('^') {
            return Ok(base);
        }
        let exponent = self.signed()?;
        told(libm::pow(base, exponent), || format!("{base}^{exponent}"))
    }

    fn atom(&mut self) -> Result<f64, String> {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                let value = self.sum()?;
                self.require(')')?;
                Ok(value)
            }
            Some(digit) if digit.is_ascii_digit() || digit == '.' => self.number(),
            Some(letter) if continues_name(letter) => self.named(),
            _ => Err(self.unexpected("a number, a name or `(`")),
        }
    }

    fn number(&mut self) -> Result<f64, String> {
        let rest = &self.text[self.at..];
        let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let mut length = digits(rest);
        if rest[length..].starts_with('.') {
            length += 1 + digits(&rest[length + 1..]);
        }
        if rest[length..].starts_with(['e', 'E']) {
            let sign = usize::from(rest[length + 1..].starts_with(['+', '-']));
            let power = digits(&rest[length + 1 + sign..]);
            length += if power > 0 { 1 + sign + power } else { 0 };
        }
        let number = rest[..length].parse::<f64>().map_err(|_| self.unexpected("a number"))?;
        self.at += length;
        told(number, || rest[..length].to_owned())
    }

    /// A constant, a name, or a function with its arguments.
    fn named(&mut self) -> Result<f64, String> {
        let rest = &self.text[self.at..];
        let name = &rest[..rest.find(|letter| !continues_name(letter)).unwrap_or(rest.len())];
        self.at += name.len();
        if self.takes('(') {
            return self.call(name);
        }
        if let Some((_, value)) = CONSTANTS.iter().find(|(other, _)| *other == name) {
            return Ok(*value);
        }
        if let Some(value) = (self.lookup)(name) {
            return value;
        }
        if is_taken(name) {
            return Err(format!("`{name}` is a function: write `{name}(...)`"));
        }
        let question = did_you_mean(name, self.known.iter().copied().chain(taken()), '`');
        Err(format!("there is no `{name}` in `[let]`{question}"))
    }

    fn call(&mut self, name: &'a str) -> Result<f64, String> {
        let first = self.sum()?;
        if let Some((_, function)) = FUNCTIONS.iter().find(|(other, _)| *other == name) {
            self.require(')')?;
            return told(function(first), || format!("{name}({first})"));
        }
        let Some((_, function)) = OF_TWO.iter().find(|(other, _)| *other == name) else {
            let question = did_you_mean(
                name,
                FUNCTIONS.map(|(name, _)| name).into_iter().chain(OF_TWO.map(|(name, _)| name)),
                '`',
            );
            return Err(format!("there is no function `{name}`{question}"));
        };
        self.require(',')?;
        let mut value = function(first, self.sum()?);
        while OF_MANY.contains(&name) && self.takes(',') {
            value = function(value, self.sum()?);
        }
        self.require(')')?;
        Ok(value)
    }

    /// The next character beyond spaces.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn takes(&mut self, wanted: char) -> bool {
        let is_next = self.peek() == Some(wanted);
        self.at += if is_next { wanted.len_utf8() } else { 0 };
        is_next
    }

    fn require(&mut self, wanted: char) -> Result<(), String> {
        if self.takes(wanted) { Ok(()) } else { Err(self.unexpected(&format!("`{wanted}`"))) }
    }

    fn unexpected(&mut self, wanted: &str) -> String {
        match self.peek() {
            None => format!("ends where {wanted} should stand"),
            Some(found) => {
                let place = self.text[..self.at].chars().count() + 1;
                format!("expected {wanted} at its character {place}, found `{found}`")
            }
        }
    }
}

fn finite(value: f64) -> Result<f64, String> {
    if value.is_finite() { Ok(value) } else { Err("is beyond the largest number".to_owned()) }
}

/// A value, if it is a finite number; `what` it is of.
fn told(value: f64, what: impl Fn() -> String) -> Result<f64, String> {
    if value.is_nan() {
        return Err(format!("{} is not a number", what()));
    }
    if value.is_infinite() { Err(format!("{} is not finite", what())) } else { Ok(value) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Result<f64, String> {
        let mut lookup = |name: &str| match name {
            "a" => Some(Ok(3.0)),
            "half_2" => Some(Ok(0.5)),
            _ => None,
        };
        evaluate(text, &mut lookup, &["a", "half_2"])
    }

    #[test]
    fn operators_bind_as_in_mathematics() {
        for (text, expected) in [
            ("1 + 2*3 - 4/8", 6.5),
            ("-a^2", -9.0),
            ("2^3^0.5", libm::pow(2.0, libm::pow(3.0, 0.5))),
            ("2^-1*a", 1.5),
            ("(1 - -1) * --2", 4.0),
            ("8/4/2", 1.0),
            (" 1e-3 ", 1e-3),
            (".5 + 5. + half_2", 6.0),
            ("2e", 2.0),
        ] {
            match value(text) {
                Ok(found) => assert_eq!(found, expected, "{text}"),
                Err(error) => assert!(text == "2e", "{text}: {error}"),
            }
        }
    }

    #[test]
    fn functions_are_those_of_mathematics() {
        for (text, expected) in [
            ("deg(180) - pi", 0.0),
            ("sqrt(2)^2", 2.0),
            ("abs(-a) + floor(-2.5)", 0.0),
            ("min(3, 1, 2) + max(3, 4) ", 5.0),
            ("sin(pi/6)", 0.5),
            ("cos(pi/3)", 0.5),
            ("tan(pi/4)", 1.0),
            ("asin(1) + acos(1)", PI / 2.0),
            ("4*atan(1) - atan2(0, -1)", 0.0),
            ("ln(exp(2))", 2.0),
        ] {
            assert!((value(text).expect(text) - expected).abs() < 1e-15, "{text}: {:?}", value(text));
        }
    }

    #[test]
    fn what_is_wrong_is_told_with_its_place() {
        let deep = "(".repeat(DEEPEST + 1);
        for (text, expected) in [
            ("", "ends where a number, a name or `(` should stand"),
            ("1 +", "ends where a number, a name or `(` should stand"),
            ("2 a", "expected an operator such as `+` at its character 3, found `a`"),
            ("(1", "ends where `)` should stand"),
            ("1/0", "divides by zero"),
            ("sqrt(-1)", "sqrt(-1) is not a number"),
            ("ln(0)", "ln(0) is not finite"),
            ("(-8)^(1/3)", "-8^0.3333333333333333 is not a number"),
            ("1e308*10", "is beyond the largest number"),
            ("1e999", "1e999 is not finite"),
            ("halv_2", "there is no `halv_2` in `[let]` (did you mean `half_2`?)"),
            ("sin", "`sin` is a function: write `sin(...)`"),
            ("sine(1)", "there is no function `sine` (did you mean `sin`?)"),
            ("atan2(1)", "expected `,` at its character 8, found `)`"),
            (".", "expected a number at its character 1, found `.`"),
            ("ä", "expected a number, a name or `(` at its character 1, found `ä`"),
            (&deep, "is nested deeper than 100 levels"),
        ] {
            assert_eq!(value(text), Err(expected.to_owned()), "{text}");
        }
    }
}
