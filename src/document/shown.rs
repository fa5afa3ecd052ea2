//! Texts of others in messages.

/// Most characters of such a text.
const MOST: usize = 200;

/// A text that this program did not write, fit for a message or a terminal: what controls a
/// terminal or turns the direction of writing is escaped, and a long text is cut.
pub fn shown(text: &str) -> String {
    let mut fit = String::new();
    for (place, sign) in text.chars().enumerate() {
        if place == MOST {
            return fit + " ...";
        }
        match is_hidden(sign) {
            true => fit.extend(sign.escape_default()),
            false => fit.push(sign),
        }
    }
    fit
}

/// Whether a sign is not seen, or changes how others are seen.
fn is_hidden(sign: char) -> bool {
    sign.is_control()
        || matches!(sign,
            '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}'
            | '\u{e0000}'..='\u{e007f}')
}

#[cfg(test)]
mod tests {
    use super::shown;

    #[test]
    fn what_cannot_be_seen_is_escaped_and_long_texts_are_cut() {
        assert_eq!(shown("python3 modèle.py"), "python3 modèle.py");
        assert_eq!(shown("a\u{1b}[2K\nb\u{202e}c"), "a\\u{1b}[2K\\nb\\u{202e}c");
        assert_eq!(shown(&"x".repeat(300)).len(), 204);
    }
}
