//! The text of an expression and its tree.

mod function;
mod operator;
mod parse;
mod print;
mod token;
mod tree;

pub(in crate::rule) use function::{Function, Mathematics, Summary};
pub(in crate::rule) use operator::{Arithmetic, Comparator, Operator};
pub(in crate::rule) use parse::{parse, too_long};
pub(in crate::rule) use tree::{Term, TreePart};

/// Largest number of bytes of an expression, as written and in normal form.
pub(in crate::rule) const LONGEST: usize = 2000;

/// Largest number of operations, functions or parentheses inside of each other.
pub(in crate::rule) const DEEPEST: usize = 64;
