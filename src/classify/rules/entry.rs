//! Names and colours of labels and measures in a file.

use crate::document::Problem;

/// Longest name.
const LONGEST_NAME: usize = 40;

/// Whether a name begins with a small letter and goes on with these, digits and one sign.
pub(super) fn check_name(path: &str, name: &str, sign: char) -> Result<(), Problem> {
    let mut letters = name.chars();
    let begins_well = letters.next().is_some_and(|it| it.is_ascii_lowercase());
    let goes_on_well =
        letters.all(|it| it.is_ascii_lowercase() || it.is_ascii_digit() || it == sign);
    if begins_well && goes_on_well && name.len() <= LONGEST_NAME {
        return Ok(());
    }
    let message = format!("`{name}` is no name of a column or label");
    let help = format!(
        "use small letters, digits and `{sign}`, a letter first, {LONGEST_NAME} characters at most"
    );
    Err(Problem::new(path, message).help(help))
}

/// A colour such as `#b03a2e`.
pub(super) fn color(text: &str) -> Option<[u8; 3]> {
    let hex = text.strip_prefix('#').filter(|it| it.len() == 6)?;
    let number = u32::from_str_radix(hex, 16).ok()?;
    Some(crate::color::rgb(number))
}
