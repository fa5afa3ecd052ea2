//! The functions of the language.

use std::fmt::{Display, Formatter, Result};

/// A function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::rule) enum Function {
    /// A function of numbers.
    Of(Mathematics),
    /// One number of the frames of the window.
    Over(Summary),
    /// The share of frames in which a condition holds.
    Share,
    /// How much of a number repeats with a period.
    Repeats,
}

/// A function of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::rule) enum Mathematics {
    Abs,
    Sqrt,
    Exp,
    Log,
    Sin,
    Cos,
    Tan,
    Lesser,
    Greater,
}

/// One number of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::rule) enum Summary {
    Mean,
    Min,
    Max,
    Deviation,
    First,
    Last,
    Trend,
}

/// All functions with their names.
const FUNCTIONS: [(&str, Function); 18] = [
    ("mean", Function::Over(Summary::Mean)),
    ("min", Function::Over(Summary::Min)),
    ("max", Function::Over(Summary::Max)),
    ("deviation", Function::Over(Summary::Deviation)),
    ("first", Function::Over(Summary::First)),
    ("last", Function::Over(Summary::Last)),
    ("trend", Function::Over(Summary::Trend)),
    ("share", Function::Share),
    ("repeats", Function::Repeats),
    ("abs", Function::Of(Mathematics::Abs)),
    ("sqrt", Function::Of(Mathematics::Sqrt)),
    ("exp", Function::Of(Mathematics::Exp)),
    ("log", Function::Of(Mathematics::Log)),
    ("sin", Function::Of(Mathematics::Sin)),
    ("cos", Function::Of(Mathematics::Cos)),
    ("tan", Function::Of(Mathematics::Tan)),
    ("lesser", Function::Of(Mathematics::Lesser)),
    ("greater", Function::Of(Mathematics::Greater)),
];

impl Function {
    /// The names of all functions.
    pub(in crate::rule) const NAMES: [&str; FUNCTIONS.len()] = {
        let mut names = [""; FUNCTIONS.len()];
        let mut index = 0;
        while index < names.len() {
            names[index] = FUNCTIONS[index].0;
            index += 1;
        }
        names
    };

    /// The function of that name.
    pub(in crate::rule) fn of_name(name: &str) -> Option<Self> {
        let found = FUNCTIONS.iter().find(|(known, _)| *known == name);
        found.map(|(_, function)| *function)
    }

    /// Its name.
    pub(in crate::rule) fn name(self) -> &'static str {
        let found = FUNCTIONS.iter().find(|(_, known)| *known == self);
        found.map_or("", |(name, _)| name)
    }

    /// Number of values that it takes.
    pub(in crate::rule) fn arity(self) -> usize {
        match self {
            Self::Of(Mathematics::Lesser | Mathematics::Greater) | Self::Repeats => 2,
            Self::Of(_) | Self::Over(_) | Self::Share => 1,
        }
    }

    /// How it is used.
    pub(in crate::rule) fn usage(self) -> &'static str {
        match self {
            Self::Of(Mathematics::Lesser) => "lesser(a, b) is the lesser of two numbers",
            Self::Of(Mathematics::Greater) => "greater(a, b) is the greater of two numbers",
            Self::Over(Summary::Min) => {
                "min(x) is the least x of all frames; the lesser of two numbers is lesser(a, b)"
            }
            Self::Over(Summary::Max) => {
                "max(x) is the largest x of all frames; the greater of two numbers is greater(a, b)"
            }
            Self::Share => "share(x > 0) is the share of frames in which x > 0",
            Self::Repeats => "repeats(x, T) says how much of x repeats with period T",
            Self::Of(_) => "write one number between its parentheses, such as sqrt(2)",
            Self::Over(_) => "write one number between its parentheses, such as mean(x)",
        }
    }
}

impl Display for Function {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        formatter.write_str(self.name())
    }
}
