//! From the words of an expression to its tree.

use super::operator::{MINUS, NOT};
use super::token::{PlacedToken, Token, words};
use super::{Arithmetic, DEEPEST, Function, LONGEST, Operator, Term, TreePart};
use crate::document::suggest;
use crate::rule::error::ExpressionError;
use crate::rule::unit::Unit;
use std::ops::Range;

type Parsed = Result<Term, ExpressionError>;

/// Reads an expression.
pub(in crate::rule) fn parse(text: &str) -> Parsed {
    if text.len() > LONGEST {
        return Err(too_long(
            "expression",
            text.floor_char_boundary(LONGEST)..text.len(),
        ));
    }
    let mut parser = Parser {
        text,
        words: words(text)?,
        next: 0,
        levels: [0; 2],
    };
    if *parser.token() == Token::End {
        let help = "write for example `mean(height_mean) > 0.05`";
        return Err(ExpressionError::new("the expression is empty", 0..0, help));
    }
    let term = parser.expression(0)?;
    match parser.token() {
        Token::End => Ok(term),
        _ => Err(parser.operator_missing()),
    }
}

/// The error of too many bytes in the expression or its normal form, which `what` says.
pub(in crate::rule) fn too_long(what: &str, span: Range<usize>) -> ExpressionError {
    let message = format!("the {what} has more than {LONGEST} bytes");
    let help = "divide it into several labels or measures";
    ExpressionError::new(message, span, help)
}

struct Parser<'t> {
    text: &'t str,
    words: Vec<PlacedToken>,
    /// Index of the next word; the last one, the end, is never passed.
    next: usize,
    /// How many of each kind of level are open.
    levels: [usize; 2],
}

/// What parts of an expression stand in. Both kinds are counted, so that the stack is bounded:
/// parentheses leave no trace in the tree, and the depth of an operation is known only at its end.
#[derive(Clone, Copy)]
enum Level {
    Parenthesis,
    Operation,
}

impl Parser<'_> {
    fn token(&self) -> &Token {
        &self.words[self.next].0
    }

    fn span(&self) -> Range<usize> {
        self.words[self.next].1.clone()
    }

    /// Passes the next word.
    fn pass(&mut self) -> Range<usize> {
        let span = self.span();
        self.next = (self.next + 1).min(self.words.len() - 1);
        span
    }

    /// What binds at least as tightly as `least`.
    fn expression(&mut self, least: u8) -> Parsed {
        let mut left = self.operand()?;
        let mut compared = false;
        while let Token::Operator(operator) = *self.token() {
            if operator.binding() < least {
                break;
            }
            let is_comparison = matches!(operator, Operator::Compare(_));
            if is_comparison && compared {
                return Err(self.chained(&left));
            }
            compared = is_comparison;
            let mark = self.pass();
            let right = self.inside(Level::Operation, &mark, |parser| {
                parser.expression(operator.binding_on_right())
            })?;
            let span = left.span.start..right.span.end;
            let part = TreePart::Binary(operator, Box::new(left), Box::new(right));
            left = term(part, span, mark)?;
        }
        Ok(left)
    }

    /// A number, a name, a function, a parenthesis, or one of these with a sign in front.
    fn operand(&mut self) -> Parsed {
        let start = self.span();
        match self.token().clone() {
            Token::Number(value, unit) => {
                self.pass();
                term(TreePart::Number(value, unit), start.clone(), start)
            }
            Token::Name => self.name(),
            Token::Open => {
                self.pass();
                let inside =
                    self.inside(Level::Parenthesis, &start, |parser| parser.expression(0))?;
                let end = self.close(&start)?;
                Ok(Term {
                    span: start.start..end,
                    ..inside
                })
            }
            Token::Not => self.signed(NOT, TreePart::Not),
            Token::Operator(Operator::Calculate(Arithmetic::Subtract)) => {
                self.signed(MINUS, TreePart::Negative)
            }
            Token::End => {
                let help = "write a number, a name, a function or a parenthesis at its end";
                Err(ExpressionError::new(
                    "the expression ends too early",
                    start,
                    help,
                ))
            }
            Token::Operator(_) | Token::Close | Token::Comma => {
                let word = &self.text[start.clone()];
                let message = format!("`{word}` stands where a value should");
                let help = "write a number, a name, a function or a parenthesis in front of it";
                Err(ExpressionError::new(message, start, help))
            }
        }
    }

    /// What has a sign in front.
    fn signed(&mut self, binding: u8, part: impl FnOnce(Box<Term>) -> TreePart) -> Parsed {
        let mark = self.pass();
        let operand = self.inside(Level::Operation, &mark, |parser| parser.expression(binding))?;
        let span = mark.start..operand.span.end;
        term(part(Box::new(operand)), span, mark)
    }

    /// A name, or a function if a parenthesis follows.
    fn name(&mut self) -> Parsed {
        let mark = self.pass();
        let name = &self.text[mark.clone()];
        if *self.token() != Token::Open {
            return term(TreePart::Name(name.to_owned()), mark.clone(), mark);
        }
        let Some(function) = Function::of_name(name) else {
            let help = match suggest(name, Function::NAMES) {
                Some(meant) => format!("write `{meant}`"),
                None => format!("functions are {}", Function::NAMES.join(", ")),
            };
            let message = format!("`{name}` is not a function");
            return Err(ExpressionError::new(message, mark, help));
        };
        let open = self.pass();
        let mut arguments = Vec::new();
        while *self.token() != Token::Close {
            arguments.push(self.inside(Level::Operation, &mark, |parser| parser.expression(0))?);
            if *self.token() != Token::Comma {
                break;
            }
            self.pass();
        }
        let span = mark.start..self.close(&open)?;
        let (count, arity) = (arguments.len(), function.arity());
        if count != arity {
            let values = if arity == 1 { "value" } else { "values" };
            let message = format!("`{name}` takes {arity} {values}, not {count}");
            return Err(ExpressionError::new(message, span, function.usage()));
        }
        term(TreePart::Call(function, arguments), span, mark)
    }

    /// Passes the parenthesis that closes the one at `open`, and returns where it ends.
    fn close(&mut self, open: &Range<usize>) -> Result<usize, ExpressionError> {
        match self.token() {
            Token::Close => Ok(self.pass().end),
            Token::End => {
                let help = "write `)` where it ends";
                Err(ExpressionError::new(
                    "`(` is not closed",
                    open.clone(),
                    help,
                ))
            }
            _ => Err(self.operator_missing()),
        }
    }

    /// Reads one level deeper, unless that is too deep.
    fn inside(
        &mut self,
        level: Level,
        place: &Range<usize>,
        read: impl FnOnce(&mut Self) -> Parsed,
    ) -> Parsed {
        let levels = self.levels[level as usize];
        if levels == DEEPEST {
            return Err(too_deep(place.clone()));
        }
        self.levels[level as usize] = levels + 1;
        let term = read(self)?;
        self.levels[level as usize] = levels;
        Ok(term)
    }

    /// The error of a second comparison behind the comparison `first`.
    fn chained(&self, first: &Term) -> ExpressionError {
        let second = &self.text[self.span()];
        let texts = match &first.part {
            TreePart::Binary(_, _, middle) => first.short().zip(middle.short()),
            _ => None,
        };
        let help = match texts {
            Some((first, middle)) => format!("write `{first} and {middle} {second} …`"),
            None => "join two comparisons by `and`".to_owned(),
        };
        let message = "comparisons cannot be chained";
        ExpressionError::new(message, self.span(), help)
    }

    /// The error of a word that stands where an operator should.
    fn operator_missing(&self) -> ExpressionError {
        let word = &self.text[self.span()];
        let after_number = matches!(self.words[self.next - 1].0, Token::Number(..));
        let (message, help) = match self.token() {
            Token::Close => (
                "`)` closes nothing".to_owned(),
                "remove it, or write `(` where it begins".to_owned(),
            ),
            Token::Comma => (
                "`,` separates nothing".to_owned(),
                "remove it; only values of a function have commas between them".to_owned(),
            ),
            Token::Name if after_number && Unit::parse(word).is_ok() => {
                let number = &self.text[self.words[self.next - 1].1.clone()];
                (
                    format!("`{word}` stands where an operator should"),
                    format!("write a unit in brackets, `{number}[{word}]`, or a product with `*`"),
                )
            }
            _ => (
                format!("`{word}` stands where an operator should"),
                "write an operator in front of it, such as `+`, `>` or `and`".to_owned(),
            ),
        };
        ExpressionError::new(message, self.span(), help)
    }
}

/// A term, unless it is too deep.
fn term(part: TreePart, span: Range<usize>, mark: Range<usize>) -> Parsed {
    let term = Term::new(part, span, mark);
    match term.depth > DEEPEST {
        true => Err(too_deep(term.mark)),
        false => Ok(term),
    }
}

fn too_deep(place: Range<usize>) -> ExpressionError {
    let message = format!("the expression is more than {DEEPEST} levels deep");
    let help = "divide it into several labels or measures";
    ExpressionError::new(message, place, help)
}
