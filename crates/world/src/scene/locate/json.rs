//! Places of fields in JSON, from a scan that skips over everything beside the path.
//!
//! The text has usually been accepted by a real parser before: the scan accepts any text, never recurses and always
//! ends.

use crate::scene::field_path::Step;

/// Returns the byte offset of the field, or of the nearest table or array around it.
pub(super) fn find_offset(text: &str, steps: &[Step]) -> usize {
    let mut scan = Scan { bytes: text.as_bytes(), at: 0 };
    scan.skip_space();
    let mut found = scan.at;
    for step in steps {
        let inside = match step {
            Step::Field(name) => scan.enter_field(name),
            Step::Element(index) => scan.enter_element(*index),
        };
        match inside {
            Some(offset) => found = offset,
            None => break,
        }
    }
    found
}

/// A position in the text, at the start of a value between two steps.
struct Scan<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Scan<'_> {
    /// Moves to the value of a field of the object here, and returns the offset of its key.
    fn enter_field(&mut self, name: &str) -> Option<usize> {
        self.take(b'{')?;
        loop {
            self.skip_space();
            let key_start = self.at;
            if self.peek()? != b'"' {
                return None;
            }
            self.skip_string();
            let key = serde_json::from_slice::<String>(&self.bytes[key_start..self.at]);
            self.skip_space();
            self.take(b':')?;
            self.skip_space();
            if key.is_ok_and(|key| key == name) {
                return Some(key_start);
            }
            self.skip_value();
            self.skip_space();
            self.take(b',')?;
        }
    }

    /// Moves to an element of the array here, and returns its offset.
    fn enter_element(&mut self, index: usize) -> Option<usize> {
        self.take(b'[')?;
        for _ in 0..index {
            self.skip_space();
            self.skip_value();
            self.skip_space();
            self.take(b',')?;
        }
        self.skip_space();
        (self.peek()? != b']').then_some(self.at)
    }

    fn skip_value(&mut self) {
        let mut depth = 0_usize;
        while let Some(byte) = self.peek() {
            match byte {
                b'"' => {
                    self.skip_string();
                    if depth == 0 {
                        return;
                    }
                    continue;
                }
                b'{' | b'[' => depth += 1,
                b'}' | b']' if depth <= 1 => {
                    self.at += depth;
                    return;
                }
                b'}' | b']' => depth -= 1,
                b',' if depth == 0 => return,
                _ => {}
            }
            self.at += 1;
        }
    }

    fn skip_string(&mut self) {
        self.at += 1;
        while let Some(byte) = self.peek() {
            self.at += if byte == b'\\' { 2 } else { 1 };
            if byte == b'"' {
                break;
            }
        }
        self.at = self.at.min(self.bytes.len());
    }

    fn skip_space(&mut self) {
        while self.peek().is_some_and(|byte| byte.is_ascii_whitespace()) {
            self.at += 1;
        }
    }

    fn take(&mut self, byte: u8) -> Option<()> {
        (self.peek()? == byte).then(|| self.at += 1)
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::field_path::FieldPath;

    const TEXT: &str = r#"{"a": [1, {"x\"}": "]}"}, [[], {}]], "b": {"c": {"d": -2}}, "e": 5}"#;

    fn found(path: &FieldPath) -> &'static str {
        &TEXT[find_offset(TEXT, path.steps())..]
    }

    #[test]
    fn fields_and_elements_are_found_beyond_nested_values_and_strings() {
        let top = FieldPath::top();
        assert!(found(&top.field("b").field("c").field("d")).starts_with(r#""d": -2"#));
        assert!(found(&top.field("e")).starts_with(r#""e""#));
        assert!(found(&top.field("a").element(2).element(1)).starts_with("{}]"));
        assert!(found(&top.field("a").element(1).field("x\"}")).starts_with(r#""x\"}": "]}""#));
    }

    #[test]
    fn a_missing_field_is_looked_for_around_its_place() {
        let top = FieldPath::top();
        assert!(found(&top.field("b").field("c").field("mass")).starts_with(r#""c""#));
        assert!(found(&top.field("a").element(9)).starts_with(r#""a""#));
        assert!(found(&top.field("a").element(2).element(0).element(0)).starts_with("[], "));
    }

    #[test]
    fn cut_text_does_not_stop_the_scan() {
        let top = FieldPath::top();
        for end in 0..TEXT.len() {
            for path in [top.field("b").field("c").field("d"), top.field("a").element(2).element(1)] {
                let offset = find_offset(&TEXT[..end], path.steps());
                assert!(offset <= end, "{path}: {offset} of {end} bytes");
            }
        }
    }
}
