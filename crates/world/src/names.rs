//! Names and other texts of users, fit for a place of limited length.

use std::collections::BTreeMap;

/// Stands for the part of a text that is left out.
const DOTS: char = '…';

/// Returns names of at most `longest` characters each, on one line.
///
/// Longer ones lose their middle, since names in a row often differ at the end; where that makes two of them equal, they
/// keep the part in which they differ first.
#[must_use]
pub fn short_names<'a>(names: impl IntoIterator<Item = &'a str>, longest: usize) -> Vec<String> {
    let full: Vec<Vec<char>> = names.into_iter().map(|name| on_one_line(name).chars().collect()).collect();
    let mut short: Vec<String> = full.iter().map(|name| without_middle(name, longest)).collect();
    let mut alike: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (index, name) in short.iter().enumerate() {
        alike.entry(name).or_default().push(index);
    }
    let alike: Vec<Vec<usize>> = alike.into_values().filter(|group| group.len() > 1).collect();
    for group in alike {
        let first = &full[group[0]];
        let others = group.iter().map(|&index| &full[index]).filter(|name| *name != first);
        let common = others.map(|name| common_start(first, name)).min().unwrap_or(0);
        for index in group {
            short[index] = around(&full[index], common, longest);
        }
    }
    short
}

/// Returns a text of at most `longest` characters on one line; a longer one loses its end.
#[must_use]
pub fn short_text(text: &str, longest: usize) -> String {
    let text = on_one_line(text);
    if text.chars().count() <= longest {
        return text;
    }
    text.chars().take(longest.saturating_sub(1)).chain([DOTS]).collect()
}

/// Returns the text with spaces for line breaks and other control characters.
fn on_one_line(text: &str) -> String {
    text.chars().map(|character| if character.is_control() { ' ' } else { character }).collect()
}

fn without_middle(name: &[char], longest: usize) -> String {
    if name.len() <= longest {
        return name.iter().collect();
    }
    let kept = longest.saturating_sub(1);
    let (start, end) = (kept / 2, kept - kept / 2);
    name[..start].iter().chain([&DOTS]).chain(&name[name.len() - end..]).collect()
}

/// Number of equal characters at the start of two names.
fn common_start(a: &[char], b: &[char]) -> usize {
    a.iter().zip(b).take_while(|(a, b)| a == b).count()
}

/// Returns the part of a name about a place at which it differs from others.
fn around(name: &[char], place: usize, longest: usize) -> String {
    if name.len() <= longest {
        return name.iter().collect();
    }
    let kept = longest.saturating_sub(2);
    let start = place.saturating_sub(kept / 2).min(name.len() - kept);
    let head = (start > 0).then_some(&DOTS);
    let tail = (start + kept < name.len()).then_some(&DOTS);
    head.into_iter().chain(&name[start..start + kept]).chain(tail).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_keep_the_part_that_tells_them_apart() {
        let names = ["long name of disc 17", "long name of disc 18", "ball"];
        assert_eq!(short_names(names, 16), ["long na… disc 17", "long na… disc 18", "ball"]);
        let names =
            ["a long name, number 0, which goes on and on", "a long name, number 1, which goes on and on"];
        assert_eq!(short_names(names, 16), ["…number 0, whic…", "…number 1, whic…"]);
        assert_eq!(short_names(["same name, quite long", "same name, quite long"], 9)[0], "same na…");
        assert_eq!(short_names(["üßé…ñöäü"], 4), ["ü…äü"]);
    }

    #[test]
    fn texts_stay_on_one_line() {
        assert_eq!(short_text("two\nlines", 20), "two lines");
        assert_eq!(short_text("a long title", 7), "a long…");
        assert_eq!(short_names(["a\tb"], 5), ["a b"]);
    }
}
