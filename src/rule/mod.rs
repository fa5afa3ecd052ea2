//! Rules over the columns of a run: conditions and numbers that a file states as text.
//!
//! A number consists of numbers (`0.05`, `0.05[m]`), keys of the scene (`spheres.radius`) and
//! columns of the run (`height_mean`), which have one value per frame. A reduction such as
//! `mean(height_mean)` makes one number of all frames of a window. A condition compares numbers:
//!
//! ```text
//! min(wall_share) > 0.95 and max(height_mean) / spheres.radius < 20
//! ```
//!
//! From loosest to tightest bind `or`, `and`, `not`, comparisons, `+ -`, `* /`, the minus sign and
//! `^`. Functions of numbers are abs, sqrt, exp, log (the natural logarithm), sin, cos, tan,
//! lesser and greater; reductions are mean, min, max, deviation, first, last, trend, share and
//! repeats. Units are checked: a sum, a comparison and an angle need fitting ones. A number
//! without a unit takes the one that its place needs.
//!
//! A comparison with what is not a number does not hold. A reduction is not a number if the window
//! has no frames, or if the value of a frame is not finite; only share counts such frames, as those
//! in which a comparison does not hold.
//!
//! ```
//! use phase::rule::Expression;
//!
//! let rule = Expression::parse("min(wall_share)>.95")?;
//! assert_eq!(rule.to_string(), "min(wall_share) > 0.95");
//!
//! let text = "0 < mean(wall_share) < 1";
//! let shown = [
//!     "comparisons cannot be chained",
//!     "  0 < mean(wall_share) < 1",
//!     "                       ^",
//!     "write `0 < mean(wall_share) and mean(wall_share) < …`",
//! ];
//! let error = Expression::parse(text).unwrap_err();
//! assert_eq!(error.render(text), shown.join("\n"));
//! # Ok::<(), phase::rule::ExpressionError>(())
//! ```
//!
//! [`Expression::parse`] reads the text. [`Expression::condition`] and [`Expression::number`] check
//! its names and units once; the result is evaluated for many runs. Nothing here has loops or
//! effects: the time of an evaluation is at most the number of frames times the length of the text.

mod check;
mod condition;
mod error;
mod evaluate;
mod expression;
mod names;
mod number;
mod syntax;
mod unit;

pub use condition::{Condition, SingleComparison};
pub use error::ExpressionError;
pub use evaluate::{ComparisonEvidence, Evidence};
pub use expression::Expression;
pub use names::{Names, Values};
pub use number::Number;
pub use unit::Unit;
