//! A small writer of SVG documents.

use crate::names::short_text;
use std::fmt::Write;

const BACKGROUND: &str = "#fdfdfb";
/// Width of a common character, as a fraction of the font size.
const CHARACTER: f64 = 0.6;

/// An SVG document in the making; coordinates are pixels, y down.
#[derive(Debug)]
pub(super) struct Svg {
    text: String,
}

/// Font size [px], anchor and colour of a text.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextStyle {
    pub(super) size: f64,
    pub(super) anchor: &'static str,
    pub(super) color: &'static str,
}

impl TextStyle {
    /// Width of a text of common characters [px].
    pub(super) fn width_of(self, text: &str) -> f64 {
        CHARACTER * self.size * text.chars().count() as f64
    }
}

impl Svg {
    pub(super) fn new(width: f64, height: f64) -> Self {
        let (width, height) = (number(width), number(height));
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"{BACKGROUND}\"/>\n"
        );
        Self { text }
    }

    /// Adds an empty element with attributes, whose values are escaped.
    pub(super) fn element(&mut self, name: &str, attributes: &[(&str, &str)]) {
        self.open(name, attributes);
        self.text.truncate(self.text.len() - 2);
        self.text.push_str("/>\n");
    }

    /// Opens a group, to be closed by `close_group`.
    pub(super) fn open_group(&mut self, attributes: &[(&str, &str)]) {
        self.open("g", attributes);
    }

    pub(super) fn close_group(&mut self) {
        self.text.push_str("</g>\n");
    }

    pub(super) fn line(&mut self, from: (f64, f64), to: (f64, f64), attributes: &[(&str, &str)]) {
        let data = format!("M{} {}L{} {}", number(from.0), number(from.1), number(to.0), number(to.1));
        self.path(&data, attributes);
    }

    pub(super) fn path(&mut self, data: &str, attributes: &[(&str, &str)]) {
        let mut all = vec![("d", data)];
        all.extend_from_slice(attributes);
        self.element("path", &all);
    }

    pub(super) fn circle(&mut self, center: (f64, f64), radius: f64, attributes: &[(&str, &str)]) {
        let (x, y, r) = (number(center.0), number(center.1), number(radius));
        let mut all = vec![("cx", x.as_str()), ("cy", y.as_str()), ("r", r.as_str())];
        all.extend_from_slice(attributes);
        self.element("circle", &all);
    }

    pub(super) fn text(&mut self, at: (f64, f64), style: TextStyle, text: &str) {
        let (x, y, size) = (number(at.0), number(at.1), number(style.size));
        let attributes = [
            ("x", x.as_str()),
            ("y", y.as_str()),
            ("font-size", size.as_str()),
            ("text-anchor", style.anchor),
            ("fill", style.color),
        ];
        self.open("text", &attributes);
        self.text.truncate(self.text.len() - 1);
        let _ = writeln!(self.text, "{}</text>", escaped(text));
    }

    /// Adds the title at the top of a page; one that is wider than the page loses its end.
    pub(super) fn title(&mut self, title: &str, page_width: f64) {
        let style = TextStyle { size: 18.0, anchor: "start", color: "#22272b" };
        let room = ((page_width - 40.0) / (CHARACTER * style.size)).max(1.0);
        self.text((20.0, 28.0), style, &short_text(title, room as usize));
    }

    /// Covers a band across the page, from `top` down, in the colour of the page.
    pub(super) fn cover(&mut self, top: f64, height: f64) {
        let (top, height) = (number(top), number(height));
        self.element("rect", &[("y", &top), ("width", "100%"), ("height", &height), ("fill", BACKGROUND)]);
    }

    /// Returns the whole document.
    pub(super) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    fn open(&mut self, name: &str, attributes: &[(&str, &str)]) {
        let _ = write!(self.text, "<{name}");
        for (key, value) in attributes {
            let _ = write!(self.text, " {key}=\"{}\"", escaped(value));
        }
        self.text.push_str(">\n");
    }
}

/// Formats a coordinate to a thousandth of a pixel, without needless zeros.
pub(super) fn number(value: f64) -> String {
    if !value.is_finite() {
        return "0".to_owned();
    }
    let text = format!("{value:.3}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            // XML cannot represent most control characters.
            other if other.is_control() => safe.push(' '),
            other => safe.push(other),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!([number(1.0), number(-0.0001), number(2.5), number(f64::NAN)], ["1", "0", "2.5", "0"]);
    }

    #[test]
    fn names_cannot_break_out() {
        assert_eq!(escaped("<a & \"b\">\u{1}"), "&lt;a &amp; &quot;b&quot;&gt; ");
    }
}
