//! The tree of an expression.

use super::{Function, Operator};
use crate::rule::unit::Unit;
use std::ops::Range;

/// A part of an expression with its place. Nodes are equal if their parts are, wherever they stand.
#[derive(Clone, Debug)]
pub(in crate::rule) struct Term {
    pub(in crate::rule) part: TreePart,
    /// The whole of it in the text, with parentheses, in bytes.
    pub(in crate::rule) span: Range<usize>,
    /// Its operator or name in the text, which a caret marks.
    pub(in crate::rule) mark: Range<usize>,
    /// Number of parts on the longest way down, from 1.
    pub(in crate::rule) depth: usize,
}

/// What a term is.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::rule) enum TreePart {
    /// A number, never negative and always finite.
    Number(f64, Option<WrittenUnit>),
    /// A column or a key.
    Name(String),
    Negative(Box<Term>),
    Not(Box<Term>),
    Binary(Operator, Box<Term>, Box<Term>),
    Call(Function, Vec<Term>),
}

/// A unit behind a number.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::rule) struct WrittenUnit {
    pub(in crate::rule) unit: Unit,
    /// As written, without spaces at its ends.
    pub(in crate::rule) text: String,
}

impl PartialEq for Term {
    fn eq(&self, other: &Self) -> bool {
        self.part == other.part
    }
}

impl Term {
    pub(in crate::rule) fn new(part: TreePart, span: Range<usize>, mark: Range<usize>) -> Self {
        let below = part.children().map(|child| child.depth).max();
        Self {
            depth: 1 + below.unwrap_or(0),
            part,
            span,
            mark,
        }
    }

    /// Calls `visit` for every name of a column or key, from left to right.
    pub(in crate::rule) fn names<'a>(&'a self, visit: &mut impl FnMut(&'a str, &'a Self)) {
        if let TreePart::Name(name) = &self.part {
            visit(name, self);
        }
        for child in self.part.children() {
            child.names(visit);
        }
    }
}

impl TreePart {
    /// Whether it can only be a condition; otherwise it can only be a number.
    pub(in crate::rule) fn is_condition(&self) -> bool {
        match self {
            Self::Not(_) => true,
            Self::Binary(operator, ..) => {
                matches!(
                    operator,
                    Operator::Or | Operator::And | Operator::Compare(_)
                )
            }
            Self::Number(..) | Self::Name(_) | Self::Negative(_) | Self::Call(..) => false,
        }
    }

    fn children(&self) -> impl Iterator<Item = &Term> {
        let (one, other, list): (Option<&Term>, Option<&Term>, &[Term]) = match self {
            Self::Number(..) | Self::Name(_) => (None, None, &[]),
            Self::Negative(operand) | Self::Not(operand) => (Some(operand), None, &[]),
            Self::Binary(_, left, right) => (Some(left), Some(right), &[]),
            Self::Call(_, arguments) => (None, None, arguments),
        };
        one.into_iter().chain(other).chain(list)
    }
}
