//! Text in XML and in pages.

/// The words of a text; one that does not fit a line in pieces that do, as in languages without
/// spaces.
pub(crate) fn words(text: &str, fits: impl Fn(&str) -> bool) -> Vec<String> {
    let mut words = Vec::new();
    for word in text.split_whitespace() {
        if fits(word) {
            words.push(word.to_owned());
            continue;
        }
        let mut piece = String::new();
        for letter in word.chars() {
            piece.push(letter);
            if !fits(&piece) && piece.chars().count() > 1 {
                piece.pop();
                words.push(std::mem::replace(&mut piece, letter.to_string()));
            }
        }
        words.push(piece);
    }
    words
}

/// A text as XML; characters that XML cannot hold become U+FFFD.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::new();
    for character in text.chars() {
        match character {
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '"' => escaped.push_str("&quot;"),
            '\t' | '\n' | '\r' => escaped.push(' '),
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            other => escaped.push(other),
        }
    }
    escaped
}
