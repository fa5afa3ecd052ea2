//! The words of an expression.

use super::tree::WrittenUnit;
use super::{Arithmetic, Comparator, Operator};
use crate::rule::error::ExpressionError;
use crate::rule::unit::Unit;
use std::ops::Range;

/// A word of an expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token {
    Number(f64, Option<WrittenUnit>),
    Name,
    Operator(Operator),
    Not,
    Open,
    Close,
    Comma,
    End,
}

/// A word and its place.
pub(super) type PlacedToken = (Token, Range<usize>);

/// Signs of the language; longer ones first.
const SIGNS: [(&str, Token); 14] = [
    (
        "<=",
        Token::Operator(Operator::Compare(Comparator::LessOrEqual)),
    ),
    (
        ">=",
        Token::Operator(Operator::Compare(Comparator::GreaterOrEqual)),
    ),
    ("==", Token::Operator(Operator::Compare(Comparator::Equal))),
    (
        "!=",
        Token::Operator(Operator::Compare(Comparator::NotEqual)),
    ),
    ("<", Token::Operator(Operator::Compare(Comparator::Less))),
    (">", Token::Operator(Operator::Compare(Comparator::Greater))),
    ("+", Token::Operator(Operator::Calculate(Arithmetic::Add))),
    (
        "-",
        Token::Operator(Operator::Calculate(Arithmetic::Subtract)),
    ),
    (
        "*",
        Token::Operator(Operator::Calculate(Arithmetic::Multiply)),
    ),
    (
        "/",
        Token::Operator(Operator::Calculate(Arithmetic::Divide)),
    ),
    ("^", Token::Operator(Operator::Power)),
    ("(", Token::Open),
    (")", Token::Close),
    (",", Token::Comma),
];

/// Signs of other languages, and what to write instead.
const FOREIGN: [(&str, &str); 18] = [
    ("−", "write `-`"),
    ("**", "write `^` for a power"),
    ("&&", "write `and`"),
    ("||", "write `or`"),
    ("&", "write `and`"),
    ("|", "write `or`, or abs(x) for a magnitude"),
    ("=<", "write `<=`"),
    ("=>", "write `>=`"),
    ("<>", "write `!=`"),
    ("=", "write `==` to compare"),
    ("!", "write `not`"),
    ("≤", "write `<=`"),
    ("≥", "write `>=`"),
    ("≠", "write `!=`"),
    ("²", "write `^2`"),
    ("³", "write `^3`"),
    ("×", "write `*`"),
    ("·", "write `*`"),
];

/// The words of `text`, of which the last is the end.
pub(super) fn words(text: &str) -> Result<Vec<PlacedToken>, ExpressionError> {
    let mut words = Vec::new();
    let mut at = 0;
    loop {
        let rest = &text[at..];
        at += rest.len() - rest.trim_start().len();
        let (token, end) = word(text, at)?;
        let is_end = token == Token::End;
        words.push((token, at..end));
        if is_end {
            return Ok(words);
        }
        at = end;
    }
}

/// The word that begins at `at`, and where it ends.
fn word(text: &str, at: usize) -> Result<(Token, usize), ExpressionError> {
    let rest = &text[at..];
    let mut characters = rest.chars();
    let Some(first) = characters.next() else {
        return Ok((Token::End, at));
    };
    let second = characters.next();
    if first.is_ascii_digit() || first == '.' && second.is_some_and(|it| it.is_ascii_digit()) {
        return number(text, at);
    }
    if is_start(first) {
        return name(text, at);
    }
    let foreign = FOREIGN.iter().find(|(sign, _)| rest.starts_with(sign));
    let sign = SIGNS.iter().find(|(sign, _)| rest.starts_with(sign));
    match (foreign, sign) {
        // The longer sign counts: `!=` is a comparison, `**` is foreign.
        (foreign, Some((sign, token))) if foreign.is_none_or(|(it, _)| it.len() < sign.len()) => {
            Ok((token.clone(), at + sign.len()))
        }
        (foreign, _) => {
            let sign = foreign.map_or(&rest[..first.len_utf8()], |(sign, _)| sign);
            let help = foreign.map_or("remove it", |(_, help)| help);
            let message = match first.is_control() {
                true => format!("`{}` means nothing here", first.escape_unicode()),
                false => format!("`{sign}` means nothing here"),
            };
            Err(ExpressionError::new(message, at..at + sign.len(), help))
        }
    }
}

fn is_start(character: char) -> bool {
    character.is_alphabetic() || character == '_'
}

fn is_inside(character: char) -> bool {
    is_start(character) || character.is_ascii_digit()
}

/// Where the characters from `at` on end that `accepts` accepts.
fn end_of(text: &str, at: usize, accepts: impl Fn(char) -> bool) -> usize {
    let rest = &text[at..];
    at + rest.find(|it| !accepts(it)).unwrap_or(rest.len())
}

fn number(text: &str, at: usize) -> Result<(Token, usize), ExpressionError> {
    let is_digit = |character: char| character.is_ascii_digit();
    let mut end = end_of(text, at, is_digit);
    if text[end..].starts_with('.') {
        end = end_of(text, end + 1, is_digit);
    }
    if text[end..].starts_with(['e', 'E']) {
        let sign = usize::from(text[end + 1..].starts_with(['+', '-']));
        let exponent = end + 1 + sign;
        if text[exponent..].starts_with(is_digit) {
            end = end_of(text, exponent, is_digit);
        }
    }
    let value: f64 = text[at..end].parse().unwrap_or(f64::NAN);
    if !value.is_finite() {
        let message = "the number is too large";
        return Err(ExpressionError::new(
            message,
            at..end,
            "numbers are below 1.8e308",
        ));
    }
    let rest = &text[end..];
    let open = end + rest.len() - rest.trim_start().len();
    if !text[open..].starts_with('[') {
        return Ok((Token::Number(value, None), end));
    }
    let Some(length) = text[open..].find(']') else {
        let message = "`[` is not closed";
        let help = "write the unit in brackets, such as `0.05[m]`";
        return Err(ExpressionError::new(message, open..open + 1, help));
    };
    let inside = &text[open + 1..open + length];
    let end = open + length + 1;
    if inside.trim().is_empty() {
        let help = "write a unit, such as `0.05[m]`; the unit of a pure number is `[1]`";
        return Err(ExpressionError::new("the unit is missing", open..end, help));
    }
    let unit = Unit::parse(inside).map_err(|error| error.moved(open + 1))?;
    let text = inside.trim().to_owned();
    Ok((Token::Number(value, Some(WrittenUnit { unit, text })), end))
}

/// A word of the language, a column, or a key: words with dots between them and whole numbers in
/// brackets.
fn name(text: &str, at: usize) -> Result<(Token, usize), ExpressionError> {
    let mut end = end_of(text, at, is_inside);
    loop {
        let rest = &text[end..];
        if let Some(inside) = rest.strip_prefix('[') {
            let digits = end_of(inside, 0, |it| it.is_ascii_digit());
            if digits == 0 || !inside[digits..].starts_with(']') {
                let message = "this is not the index of an entry";
                let help = "an index is a whole number, such as in `axis[0]`; a unit stands behind \
                            a number only";
                let closed = rest.find(']').map_or(end + 1, |length| end + length + 1);
                return Err(ExpressionError::new(message, end..closed, help));
            }
            end += digits + 2;
        } else if let Some(behind) = rest.strip_prefix('.') {
            if !behind.starts_with(is_start) {
                let message = "a name is missing behind the dot";
                let help = "the names of a key have dots between them, such as `spheres.radius`";
                return Err(ExpressionError::new(message, end..end + 1, help));
            }
            end = end_of(text, end + 1, is_inside);
        } else {
            break;
        }
    }
    let token = match &text[at..end] {
        "and" => Token::Operator(Operator::And),
        "or" => Token::Operator(Operator::Or),
        "not" => Token::Not,
        _ => Token::Name,
    };
    Ok((token, end))
}
