//! The known word nearest to an unknown one, for messages.

use strsim::damerau_levenshtein;

/// Part of a word that may be mistyped, as a divisor of its length: the rule of rustc and cargo.
const MISTYPED: usize = 3;

/// Returns the known word that is nearest to an unknown one, if one is near: a third of its letters may be wrong,
/// missing, too many or swapped, and all may be in the other case.
pub(super) fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let plain = word.to_lowercase();
    let near = known.into_iter().filter_map(|other| {
        let distance = damerau_levenshtein(&plain, &other.to_lowercase());
        let length = word.chars().count().max(other.chars().count());
        (distance <= length.max(MISTYPED) / MISTYPED).then_some((distance, other))
    });
    near.min_by_key(|&(distance, _)| distance).map(|(_, other)| other)
}

/// Returns a question to be put behind an unknown word, in the quotes of the message; empty if no known word is near.
pub(super) fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>, quote: char) -> String {
    nearest(word, known).map_or(String::new(), |near| format!(" (did you mean {quote}{near}{quote}?)"))
}

/// Puts the question into a message of serde, "unknown field `x`, expected one of `a`, `b`"; other messages stay as
/// they are.
pub(super) fn with_nearest(message: &str) -> String {
    let asked = || {
        let rest =
            ["unknown field `", "unknown variant `"].iter().find_map(|start| message.strip_prefix(start))?;
        let (word, expected) = rest.split_once("`, expected ")?;
        let known = expected.split('`').skip(1).step_by(2);
        let question = did_you_mean(word, known, '`');
        let end = message.len() - expected.len() - ", expected ".len();
        (!question.is_empty()).then(|| format!("{}{question}{}", &message[..end], &message[end..]))
    };
    asked().unwrap_or_else(|| message.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_word_is_found_if_one_is_near() {
        let known = ["mass", "moment", "center_of_mass", "position"];
        for (word, near) in [
            ("mas", Some("mass")),
            ("Mass", Some("mass")),
            ("postion", Some("position")),
            ("psoition", Some("position")),
            ("centre_of_mass", Some("center_of_mass")),
            ("weight", None),
            ("", None),
        ] {
            assert_eq!(nearest(word, known), near, "{word}");
        }
        assert_eq!(nearest("ball 2", ["ball 1", "ball 22", "Ball 2"]), Some("Ball 2"));
    }

    #[test]
    fn the_question_stands_behind_the_word() {
        let message = "unknown field `mas`, expected one of `name`, `mass`";
        assert_eq!(
            with_nearest(message),
            "unknown field `mas` (did you mean `mass`?), expected one of `name`, `mass`"
        );
        let far = "unknown variant `weight`, expected `mass` or `name`";
        assert_eq!(with_nearest(far), far);
        assert_eq!(with_nearest("invalid type: map"), "invalid type: map");
    }
}
