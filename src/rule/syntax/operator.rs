//! Operators, and how tightly they bind.

/// An operator between two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::rule) enum Operator {
    Or,
    And,
    Compare(Comparator),
    Calculate(Arithmetic),
    Power,
}

/// A comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::rule) enum Comparator {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
}

/// One of the four rules of arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::rule) enum Arithmetic {
    Add,
    Subtract,
    Multiply,
    Divide,
}

/// How tightly `not` binds.
pub(in crate::rule) const NOT: u8 = 3;

/// How tightly a comparison binds.
const COMPARISON: u8 = 4;

/// How tightly a minus sign binds.
pub(in crate::rule) const MINUS: u8 = 7;

/// How tightly a power binds.
const POWER: u8 = 8;

/// How tightly a number, a name, a function or a parenthesis binds.
pub(in crate::rule) const ATOM: u8 = 9;

impl Operator {
    /// The operator as it is written.
    pub(in crate::rule) fn symbol(self) -> &'static str {
        match self {
            Self::Or => "or",
            Self::And => "and",
            Self::Compare(order) => order.symbol(),
            Self::Calculate(arithmetic) => arithmetic.symbol(),
            Self::Power => "^",
        }
    }

    /// How tightly it binds: the larger, the tighter.
    pub(in crate::rule) fn binding(self) -> u8 {
        match self {
            Self::Or => 1,
            Self::And => 2,
            Self::Compare(_) => COMPARISON,
            Self::Calculate(Arithmetic::Add | Arithmetic::Subtract) => 5,
            Self::Calculate(Arithmetic::Multiply | Arithmetic::Divide) => 6,
            Self::Power => POWER,
        }
    }

    /// How tightly what stands on its left binds at least.
    pub(in crate::rule) fn binding_on_left(self) -> u8 {
        match self {
            Self::Compare(_) => COMPARISON + 1,
            Self::Power => ATOM,
            _ => self.binding(),
        }
    }

    /// How tightly what stands on its right binds at least. A power takes a minus sign and other
    /// powers.
    pub(in crate::rule) fn binding_on_right(self) -> u8 {
        match self {
            Self::Power => MINUS,
            _ => self.binding() + 1,
        }
    }
}

impl Comparator {
    /// The comparison as it is written.
    pub(in crate::rule) fn symbol(self) -> &'static str {
        match self {
            Self::Less => "<",
            Self::LessOrEqual => "<=",
            Self::Greater => ">",
            Self::GreaterOrEqual => ">=",
            Self::Equal => "==",
            Self::NotEqual => "!=",
        }
    }

    /// Whether two numbers compare like this. What is not a number does not compare.
    pub(in crate::rule) fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Self::Less => left < right,
            Self::LessOrEqual => left <= right,
            Self::Greater => left > right,
            Self::GreaterOrEqual => left >= right,
            Self::Equal => left == right,
            Self::NotEqual => left != right && !left.is_nan() && !right.is_nan(),
        }
    }

    /// The distance to the border of the comparison, negative where it does not hold, from how
    /// much more the left number is than the right one.
    pub(in crate::rule) fn margin(self, excess: f64) -> f64 {
        match self {
            Self::Less | Self::LessOrEqual => -excess,
            Self::Greater | Self::GreaterOrEqual => excess,
            Self::Equal => -excess.abs(),
            Self::NotEqual => excess.abs(),
        }
    }
}

impl Arithmetic {
    /// The operator as it is written.
    pub(in crate::rule) fn symbol(self) -> &'static str {
        match self {
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
        }
    }

    /// The result.
    pub(in crate::rule) fn of(self, left: f64, right: f64) -> f64 {
        match self {
            Self::Add => left + right,
            Self::Subtract => left - right,
            Self::Multiply => left * right,
            Self::Divide => left / right,
        }
    }
}
