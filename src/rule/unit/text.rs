//! Units in text, such as `kg m^2/s`, `m/s²` and `kg/(m² s)`.

use super::{SYMBOLS, Unit};
use crate::rule::error::ExpressionError;
use std::ops::Range;

/// Largest exponent in a text.
const LARGEST: f64 = 99.0;

/// Superscript digits, in their order.
const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// What a slash in front divides by.
#[derive(Clone, Copy, PartialEq)]
enum FractionPart {
    /// No slash yet.
    Above,
    /// The one factor that follows a slash.
    Below,
    /// All factors up to a closing parenthesis.
    Group,
    /// Behind what a slash divides by, where another factor would be ambiguous.
    Behind,
}

/// A text, read from left to right.
struct UnitReader<'t> {
    text: &'t str,
    at: usize,
}

impl Unit {
    /// Reads a unit: factors with spaces between them. A slash divides by the factor behind it, or
    /// by those in parentheses. An empty text is the unit of pure numbers.
    ///
    /// # Errors
    /// If the text is not a unit; its place is in bytes of `text`.
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        let mut reader = UnitReader { text, at: 0 };
        let mut place = FractionPart::Above;
        let mut unit = Self::ONE;
        let mut factors = 0;
        while let Some(next) = reader.skip_spaces() {
            let here = reader.here();
            if next == '/'
                && factors > 0
                && matches!(place, FractionPart::Above | FractionPart::Behind)
            {
                reader.at += 1;
                place = FractionPart::Below;
            } else if next == '(' && place == FractionPart::Below {
                reader.at += 1;
                place = FractionPart::Group;
            } else if next == ')' && place == FractionPart::Group {
                reader.at += 1;
                place = FractionPart::Behind;
            } else {
                let factor = reader.factor()?;
                let here = here.start..reader.at;
                if place == FractionPart::Behind {
                    let message = "the slash may divide by this factor or not";
                    let help = "write negative exponents, such as `kg m^-1 s^-2`";
                    return Err(ExpressionError::new(message, here, help));
                }
                let product = match place {
                    FractionPart::Above => unit.times(factor),
                    _ => unit.over(factor),
                };
                unit = product.ok_or_else(|| too_large(here))?;
                factors += 1;
                if place == FractionPart::Below {
                    place = FractionPart::Behind;
                }
            }
        }
        match place {
            FractionPart::Above | FractionPart::Behind => Ok(unit),
            FractionPart::Below | FractionPart::Group => {
                let message = "the unit ends too early";
                let help = match place {
                    FractionPart::Group => "close the parenthesis",
                    _ => "a slash stands between two units, such as `m/s`",
                };
                Err(ExpressionError::new(message, reader.here(), help))
            }
        }
    }
}

fn too_large(span: Range<usize>) -> ExpressionError {
    let message = "the exponent of the unit is too large";
    ExpressionError::new(message, span, format!("exponents are at most {LARGEST}"))
}

impl UnitReader<'_> {
    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    fn skip_spaces(&mut self) -> Option<char> {
        self.take(|character| character.is_whitespace() || character == '·');
        self.peek()
    }

    /// The place of the next character.
    fn here(&self) -> Range<usize> {
        self.at..self.at + self.peek().map_or(0, char::len_utf8)
    }

    /// The longest text of such characters from here.
    fn take(&mut self, accepts: impl Fn(char) -> bool) -> &str {
        let rest = &self.text[self.at..];
        let length = rest.find(|it| !accepts(it)).unwrap_or(rest.len());
        self.at += length;
        &rest[..length]
    }

    /// A symbol with its exponent.
    fn factor(&mut self) -> Result<Unit, ExpressionError> {
        let start = self.at;
        if self.take(char::is_alphabetic).is_empty() {
            self.take(|character| character.is_ascii_digit());
        }
        let symbol = &self.text[start..self.at];
        let Some(unit) = Unit::of_symbol(symbol) else {
            let (symbol, span) = match symbol.is_empty() {
                true => (&self.text[self.here()], self.here()),
                false => (symbol, start..self.at),
            };
            let known = SYMBOLS.map(|(name, _)| name).join(", ");
            let help = format!("units are {known}, without prefixes, such as `kg m^2/s`");
            let message = format!("`{symbol}` is not a unit");
            return Err(ExpressionError::new(message, span, help));
        };
        let exponent = self.exponent()?;
        unit.raised(exponent)
            .ok_or_else(|| no_exponent(start..self.at))
    }

    /// The exponent that stands here; 1 if none does.
    fn exponent(&mut self) -> Result<f64, ExpressionError> {
        let start = self.at;
        let written = if self.peek() == Some('^') {
            self.at += 1;
            self.take(|it| it.is_ascii_digit() || it == '-' || it == '.')
                .to_owned()
        } else {
            let raised = self.take(|it| RAISED.contains(&it) || it == '⁻');
            raised.chars().map(lowered).collect()
        };
        if self.at == start {
            return Ok(1.0);
        }
        let exponent: f64 = written.parse().map_err(|_| no_exponent(start..self.at))?;
        if exponent.abs() > LARGEST {
            return Err(too_large(start..self.at));
        }
        Ok(exponent)
    }
}

fn no_exponent(span: Range<usize>) -> ExpressionError {
    let help = "an exponent is a whole number, such as in `m^2` or `s^-1`";
    ExpressionError::new("this is not an exponent of a unit", span, help)
}

/// The digit or sign of a superscript.
fn lowered(character: char) -> char {
    let digit = RAISED.iter().position(|raised| *raised == character);
    digit.map_or('-', |digit| char::from(b'0' + digit as u8))
}
