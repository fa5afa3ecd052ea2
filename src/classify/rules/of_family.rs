//! Labels and measures by rules, as a family has them.

use crate::classify::{Label, Measure};
use crate::scene::RuleWindow;

/// A label that a rule gives.
#[derive(Clone)]
pub(in crate::classify) struct LabelOfRule {
    pub(in crate::classify) label: Label,
    /// The condition. Besides columns and keys it may name what the sieves of the scene measure.
    pub(in crate::classify) when: &'static str,
    /// The part of the run that counts. Absent: the whole run.
    pub(in crate::classify) over: Option<RuleWindow>,
    /// The columns of its evidence.
    pub(in crate::classify) evidence: &'static [Measure],
}

/// The place of the margin among the columns of a rule's evidence.
pub(in crate::classify) const MARGIN: usize = 2;

/// A measure that a rule gives; the rule is its description.
pub(in crate::classify) struct MeasureOfRule {
    pub(in crate::classify) measure: Measure,
    /// The part of the run that counts. Absent: the whole run.
    pub(in crate::classify) over: Option<RuleWindow>,
}

/// A rule that the program brings: its label, the name of its evidence, and its condition.
macro_rules! rule {
    ($label:expr, $name:literal, $when:literal) => {
        $crate::classify::rules::LabelOfRule {
            label: $label,
            when: $when,
            over: None,
            evidence: &[
                $crate::classify::Measure {
                    name: concat!($name, "_value"),
                    description: concat!("what is compared in: ", $when),
                    ..$crate::classify::measure::evidence(concat!("value of \"", $name, "\""), "")
                },
                $crate::classify::Measure {
                    name: concat!($name, "_threshold"),
                    description: concat!("what it is compared with in: ", $when),
                    ..$crate::classify::measure::evidence(
                        concat!("threshold of \"", $name, "\""),
                        "",
                    )
                },
                $crate::classify::Measure {
                    name: concat!($name, "_margin"),
                    description: concat!(
                        "distance from the border, over the larger side, in: ",
                        $when
                    ),
                    ..$crate::classify::measure::evidence(concat!("margin of \"", $name, "\""), "")
                        .signed()
                },
            ],
        }
    };
}
pub(in crate::classify) use rule;
