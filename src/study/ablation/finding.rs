//! What an ablation finds: which effects a scene needs, and which it does not.

use super::Ablated;
use crate::study::comparison::States;
use serde::Serialize;

/// Shift of an order parameter, in units of its spread over seeds, above which an effect is needed
/// although labels stay.
const LARGE_SHIFT: f64 = 0.5;

/// Whether a scene needs an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// More labels change without it than seeds change, or an order parameter shifts.
    Needed,
    /// At most the tolerance of the labels change without it, and order parameters stay, for
    /// certain.
    NotNeeded,
    /// The runs do not tell.
    Undecided,
}

impl Verdict {
    pub(super) fn of(states: &States, missing: usize, tolerance: f64) -> Self {
        let labels = states.disagreement.as_ref();
        let changes = labels.is_some_and(|it| it.excess.low > 0.0);
        let shift = states.largest_shift();
        let shifts = shift.is_some_and(|(_, it)| it.root_mean_square.low > LARGE_SHIFT);
        if changes || shifts {
            Self::Needed
        } else if missing == 0 && states.are_within(tolerance, Some(2.0 * LARGE_SHIFT)) {
            Self::NotNeeded
        } else {
            Self::Undecided
        }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Needed => "needed",
            Self::NotNeeded => "not needed",
            Self::Undecided => "undecided",
        }
    }
}

/// What an ablation finds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Finding {
    /// Share of the labels that may change.
    pub tolerance: f64,
    /// The sentence.
    pub sentence: String,
}

impl Finding {
    /// What follows from the single ablations.
    pub fn of(ablated: &[Ablated], tolerance: f64) -> Self {
        let named = |verdict: Verdict, more: &dyn Fn(&Ablated) -> String| {
            let own = ablated.iter().filter(|it| it.verdict == verdict);
            let names: Vec<String> = own.map(|it| format!("{}{}", it.name, more(it))).collect();
            names.join(", ")
        };
        let changed = |it: &Ablated| match &it.states.disagreement {
            Some(labels) if labels.excess.low > 0.0 => {
                format!(" ({:.0} % of labels)", 100.0 * labels.excess.value)
            }
            _ => it
                .states
                .largest_shift()
                .map_or_else(String::new, |(name, shift)| {
                    format!(
                        " ({name} by {:.1} of its spread)",
                        shift.root_mean_square.value
                    )
                }),
        };
        let hidden = |it: &Ablated| {
            let labels = it.states.disagreement.as_ref();
            labels.map_or_else(String::new, |it| {
                format!(" (no more than {:.1} % of labels)", 100.0 * it.excess.high)
            })
        };
        let mut sentences = Vec::new();
        for (verdict, text, more) in [
            (
                Verdict::NotNeeded,
                "This scene can do with",
                &hidden as &dyn Fn(&Ablated) -> String,
            ),
            (Verdict::Needed, "It changes with", &changed),
            (
                Verdict::Undecided,
                "These runs cannot decide about",
                &hidden,
            ),
        ] {
            let names = named(verdict, more);
            match (names.is_empty(), verdict) {
                (false, _) => sentences.push(format!("{text}: {names}.")),
                (true, Verdict::NotNeeded) => {
                    sentences.push("Nothing can be left out for certain.".to_owned());
                }
                _ => {}
            }
        }
        Self {
            tolerance,
            sentence: sentences.join(" "),
        }
    }
}
