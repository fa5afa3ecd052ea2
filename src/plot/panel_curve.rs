//! Curves over the panels of a diagram.

use super::contour::Piece;
use super::legend::{LegendEntry, LegendKey};

/// A curve over a panel: pieces in shown values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PanelCurve {
    pub(super) pieces: Vec<Piece>,
    pub(super) stroke: Stroke,
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stroke {
    /// A theory.
    Full,
    /// An advice: thin and dashed.
    Dashed,
    /// A border between labels: thin.
    Border,
}

impl PanelCurve {
    /// Entries of the legend for the curves that there are, with words for full and dashed ones.
    pub(super) fn entries(curves: &[Vec<Self>], words: [&str; 2]) -> Vec<LegendEntry> {
        let is_there = |stroke: Stroke| {
            let mut curves = curves.iter().flatten();
            curves.any(|curve| curve.stroke == stroke && !curve.pieces.is_empty())
        };
        let [full, dashed] = words;
        let entries = [
            (Stroke::Full, LegendKey::Curve, full),
            (Stroke::Dashed, LegendKey::Dashes, dashed),
        ];
        let entries = entries.into_iter();
        entries
            .filter(|(stroke, ..)| is_there(*stroke))
            .map(|(_, key, words)| LegendEntry::new(key, words))
            .collect()
    }
}
