//! Text of figures: its fonts, its markup, its width.
//!
//! Markup: `$...$` is mathematics, its letters oblique; within it `_x` or `_{xyz}` is an upright
//! subscript. A text with an odd number of `$` is taken literally.

use crate::fonts;
use crate::markup::words;
use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};
use std::sync::OnceLock;

/// Size of a subscript over the size of its line.
pub(super) const SUBSCRIPT_SIZE: f64 = 0.72;

/// Fonts measured by plotters: size means ascent plus descent there, the em here.
const LINE_OVER_EM: f64 = (1901.0 + 483.0) / 2048.0;

/// A piece of text of one style.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct TextRun {
    pub(super) text: String,
    pub(super) oblique: bool,
    pub(super) subscript: bool,
}

/// The pieces of a text with markup.
pub(super) fn runs(text: &str) -> Vec<TextRun> {
    if !balanced(text) {
        return vec![TextRun {
            text: text.to_owned(),
            ..TextRun::default()
        }];
    }
    let mut runs: Vec<TextRun> = Vec::new();
    let mut push = |character: char, oblique: bool, subscript: bool| match runs.last_mut() {
        Some(run) if run.oblique == oblique && run.subscript == subscript => {
            run.text.push(character);
        }
        _ => runs.push(TextRun {
            text: character.to_string(),
            oblique,
            subscript,
        }),
    };
    let (mut mathematics, mut braces) = (false, false);
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '$' => (mathematics, braces) = (!mathematics, false),
            '_' if mathematics && characters.peek() == Some(&'{') => {
                characters.next();
                braces = true;
            }
            '}' if braces => braces = false,
            '_' if mathematics && !matches!(characters.peek(), None | Some('$')) => {
                characters
                    .next()
                    .into_iter()
                    .for_each(|next| push(next, false, true));
            }
            _ => push(
                character,
                mathematics && !braces && character.is_alphabetic(),
                braces,
            ),
        }
    }
    runs
}

/// The text without its markup.
pub(super) fn plain(text: &str) -> String {
    runs(text).into_iter().map(|run| run.text).collect()
}

fn balanced(text: &str) -> bool {
    text.matches('$').count().is_multiple_of(2)
}

/// Width of a text with markup, in the unit of `size`, the em.
pub(super) fn width(text: &str, size: f64) -> f64 {
    static FONTS: OnceLock<()> = OnceLock::new();
    FONTS.get_or_init(|| {
        // Fonts that are part of the program are valid; were they not, the guess below serves.
        register_font(fonts::FAMILY, FontStyle::Normal, *fonts::REGULAR).unwrap_or_default();
        register_font(fonts::FAMILY, FontStyle::Oblique, *fonts::OBLIQUE).unwrap_or_default();
    });
    // Measured large, because plotters rounds widths to whole units.
    const MEASURE: f64 = 1000.0;
    runs(text)
        .iter()
        .map(|run| {
            let style = if run.oblique {
                FontStyle::Oblique
            } else {
                FontStyle::Normal
            };
            let font = FontDesc::new(
                FontFamily::Name(fonts::FAMILY),
                MEASURE * LINE_OVER_EM,
                style,
            );
            let em = font.layout_box(&run.text).map_or(
                0.6 * run.text.chars().count() as f64,
                |((left, _), (right, _))| f64::from(right - left) / MEASURE,
            );
            em * if run.subscript { SUBSCRIPT_SIZE } else { 1.0 }
        })
        .sum::<f64>()
        * size
}

/// Breaks a text into lines of at most `limit`, at spaces outside of mathematics, and between the
/// letters of a word that is longer. Mathematics that is longer keeps its line to itself.
pub(super) fn wrap(text: &str, size: f64, limit: f64) -> Vec<String> {
    // A text whose `$` is a letter has no mathematics.
    let may_break = |line: &str| balanced(line) || !balanced(text);
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    let is_mathematics = |word: &str| balanced(text) && word.contains('$');
    let fits = |word: &str| is_mathematics(word) || width(word, size) <= limit;
    for word in words(text, fits) {
        let word = word.as_str();
        let longer = if line.is_empty() {
            word.to_owned()
        } else {
            format!("{line} {word}")
        };
        if !line.is_empty() && may_break(&line) && width(&longer, size) > limit {
            lines.push(std::mem::replace(&mut line, word.to_owned()));
        } else {
            line = longer;
        }
    }
    lines.push(line);
    lines
}

/// Breaks a list into lines of at most `limit`, between its items; an item that is longer itself,
/// at its spaces.
pub(super) fn wrap_list(items: &[String], size: f64, limit: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for item in items {
        match lines.last_mut() {
            Some(line) if width(&format!("{line}, {item}"), size) <= limit => {
                line.push_str(", ");
                line.push_str(item);
            }
            last => {
                if let Some(line) = last {
                    line.push(',');
                }
                lines.extend(wrap(item, size, limit));
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(text: &str, oblique: bool, subscript: bool) -> TextRun {
        TextRun {
            text: text.to_owned(),
            oblique,
            subscript,
        }
    }

    #[test]
    fn markup() {
        assert_eq!(
            runs("at $Ω_c$ (2)"),
            [
                run("at ", false, false),
                run("Ω", true, false),
                run("c", false, true),
                run(" (2)", false, false)
            ]
        );
        assert_eq!(
            runs("$z_{min}$"),
            [run("z", true, false), run("min", false, true)]
        );
        assert_eq!(runs("5 $ each_one"), [run("5 $ each_one", false, false)]);
        assert_eq!(runs("a_b"), [run("a_b", false, false)]);
        assert_eq!(
            runs("$x_$"),
            [run("x", true, false), run("_", false, false)]
        );
    }

    #[test]
    fn width_is_that_of_the_font() {
        // Advances of DejaVu Sans, in 2048ths of the em: M 1767, i 569.
        assert!((width("M", 2048.0) - 1767.0).abs() < 3.0);
        assert!((width("Mi", 2048.0) - 2336.0).abs() < 5.0);
        assert!(width("$Ω_c$", 10.0) < width("$Ωc$", 10.0));
    }

    #[test]
    fn lists_break_between_their_items() {
        let items = ["$r$ = 2 mm", "$Ω$ = 40 rad/s", "$μ$ = 0.05"].map(str::to_owned);
        let line = |limit| wrap_list(&items, 12.0, limit);
        assert_eq!(line(400.0), [items.join(", ")]);
        assert_eq!(line(180.0), ["$r$ = 2 mm, $Ω$ = 40 rad/s,", "$μ$ = 0.05"]);
        assert_eq!(
            line(20.0).concat().replace([' ', ','], ""),
            items.concat().replace(' ', "")
        );
        assert!(wrap_list(&[], 12.0, 100.0).is_empty());
    }

    /// Symptom: a long title was cut at both ends of the figure. Cause: lines broke at spaces
    /// alone, and never after a single `$`.
    #[test]
    fn long_words_break_between_letters() {
        for text in [
            "a_title_without_any_space_from_a_file_name",
            "渦の中の粒子の状態図渦の中の粒子",
        ] {
            let lines = wrap(text, 10.0, 90.0);
            assert!(lines.len() > 1 && lines.concat() == text, "{lines:?}");
            assert!(
                lines.iter().all(|line| width(line, 10.0) <= 90.0),
                "{lines:?}"
            );
        }
        let text = "it costs 5 $ to run this sweep on a machine that is lent by the hour";
        let lines = wrap(text, 10.0, 90.0);
        assert!(
            lines.iter().all(|line| width(line, 10.0) <= 90.0),
            "{lines:?}"
        );
        assert_eq!(lines.join(" "), text);
    }

    #[test]
    fn wrapping_keeps_every_word() {
        let text = "Theoretical tank, linear drag: $a b$ states of 256 spheres";
        let lines = wrap(text, 10.0, 120.0);
        assert!(lines.len() > 2);
        assert!(lines.iter().all(|line| width(line, 10.0) <= 120.0));
        assert_eq!(lines.join(" "), text);
        assert!(lines.iter().all(|line| balanced(line)));
    }
}
