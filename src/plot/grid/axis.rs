//! An axis of a figure over a grid: its values as shown, its cells, its label.

use crate::classify::LabelTable;
use crate::grid::Axis;
use crate::plot::numbers;
use crate::plot::scale::AxisSpan;
use crate::plot::spacing::AxisSpacing;
use crate::plot::ticks::Ticks;
use crate::scene::Scene;
use crate::sweep::{PlotSettings, Sweep};

/// An axis of a figure.
#[derive(Clone, Debug)]
pub(in crate::plot) struct GridAxis {
    /// Path of the key.
    pub(in crate::plot) key: String,
    /// Name in tables and settings.
    pub(in crate::plot) name: String,
    /// Values in the key's unit, ascending.
    pub(in crate::plot) values: Vec<f64>,
    /// Shown value over value.
    pub(in crate::plot) factor: f64,
    /// Of an axis over one of several shares: the sum of the others. Shown is its part of all.
    pub(in crate::plot) other_shares: Option<f64>,
    /// Symbol with markup, and unit, of the shown values.
    pub(in crate::plot) symbol: String,
    pub(in crate::plot) unit: String,
    /// Its index among the sweep's axes.
    pub(in crate::plot) index: usize,
    /// Whether its values stand at equal distances, whatever they are.
    pub(in crate::plot) is_even: bool,
    /// Whether variants scale its values by different factors, which are left out.
    pub(in crate::plot) is_scaled: bool,
    /// Names of the variants that its values are; empty for numbers.
    pub(in crate::plot) words: Vec<String>,
}

/// How figures show an axis of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownAxis {
    /// Shown value over the value of the key.
    pub factor: f64,
    /// Symbol, with markup, and unit of the shown values.
    pub symbol: String,
    /// Their unit; empty for numbers.
    pub unit: String,
}

/// How figures show the axis of this index; none if no factor leads to what they show.
pub fn shown_axis(index: usize, sweep: &Sweep, table: &LabelTable) -> Option<ShownAxis> {
    let axis = GridAxis::new(index, sweep, table);
    axis.other_shares.is_none().then_some(ShownAxis {
        factor: axis.factor,
        symbol: axis.symbol,
        unit: axis.unit,
    })
}

impl GridAxis {
    /// The axis of this index in the sweep.
    pub(in crate::plot) fn new(index: usize, sweep: &Sweep, table: &LabelTable) -> Self {
        let values = table.rows.iter().map(|row| row.values[index]);
        Self::over(index, &sweep.axes, &sweep.scene, values).with(&sweep.plot)
    }

    /// The same as the settings want it.
    #[must_use]
    pub(in crate::plot) fn with(self, settings: &PlotSettings) -> Self {
        let is_named = |name: &String| *name == self.name || *name == self.key;
        let is_even = settings.equal_steps.iter().any(is_named);
        Self { is_even, ..self }
    }

    /// The axis of that index among `axes` over keys of a scene, with more values than its own. If
    /// variants would show its values in different ways, these are shown as the axis has them.
    pub(in crate::plot) fn over(
        index: usize,
        axes: &[Axis],
        scene: &Scene,
        more: impl Iterator<Item = f64>,
    ) -> Self {
        let axis = &axes[index];
        let mut values: Vec<f64> = axis.values.clone();
        values.extend(more);
        values.sort_by(f64::total_cmp);
        values.dedup();
        let plain = Self {
            key: axis.key.clone(),
            name: axis.name.clone(),
            values,
            factor: 1.0,
            other_shares: None,
            symbol: axis.name.clone(),
            unit: String::new(),
            index,
            is_even: false,
            is_scaled: false,
            words: axis.variants.iter().map(|it| it.name.clone()).collect(),
        };
        let mut of_variants = axes
            .iter()
            .flat_map(|axis| &axis.variants)
            .map(|variant| plain.shown_in(axes, &variant.scene, variant.factor(&axis.name)));
        let Some(first) = of_variants.next() else {
            return plain.shown_in(axes, scene, 1.0);
        };
        if of_variants.all(|other| other.is_shown_like(&first)) {
            return first;
        }
        let mut variants = axes.iter().flat_map(|axis| &axis.variants);
        let mut shown = match share_index(&axis.key) {
            // Shares themselves are no parts of all.
            Some(_) => plain,
            None => plain.noted_in(scene),
        };
        shown.is_scaled = variants.any(|variant| variant.factor(&axis.name) != 1.0);
        shown
    }

    /// The axis of the points of one variant, by its place.
    pub(in crate::plot) fn of_variant(&self, place: f64, axes: &[Axis]) -> Option<Self> {
        let variant = axes.iter().find_map(|axis| axis.variant(place))?;
        Some(self.shown_in(axes, &variant.scene, variant.factor(&self.name)))
    }

    /// Whether both show values in the same way.
    pub(in crate::plot) fn is_shown_like(&self, other: &Self) -> bool {
        let way = |it: &Self| (it.factor, it.other_shares, it.is_scaled);
        way(self) == way(other) && self.label() == other.label()
    }

    /// The axis with the symbol and unit of its key in a scene.
    fn noted_in(&self, scene: &Scene) -> Self {
        let (symbol, unit) = match scene.notation(&self.key) {
            Some(notation) => (format!("${}$", notation.symbol), notation.unit.to_owned()),
            None => {
                let share = share_of(&self.key, scene);
                (share.unwrap_or_else(|| self.name.clone()), String::new())
            }
        };
        Self {
            factor: 1.0,
            other_shares: None,
            symbol,
            unit,
            is_scaled: false,
            ..self.clone()
        }
    }

    /// The axis as it is shown where all points start from a scene and have its values times a
    /// factor.
    fn shown_in(&self, axes: &[Axis], scene: &Scene, times: f64) -> Self {
        let mut shown = self.noted_in(scene);
        shown.factor = times;
        let shares = share_index(&self.key).map(|index| other_shares(index, scene));
        shown.other_shares = shares.map(|shares| shares / times);
        if let Some((length, symbol)) = scale(&self.key, axes, scene) {
            shown.factor = times / length;
            symbol.clone_into(&mut shown.symbol);
            shown.unit = String::new();
        }
        shown
    }

    /// Label of the axis.
    pub(in crate::plot) fn label(&self) -> String {
        let remark = match self.is_scaled {
            true => ", before the factor of each variant",
            false => "",
        };
        if self.unit.is_empty() {
            format!("{}{remark}", self.symbol)
        } else {
            format!("{} ({}){remark}", self.symbol, self.unit)
        }
    }

    /// `symbol = value unit`, the head of a panel; of a variant its name.
    pub(in crate::plot) fn at(&self, value: f64) -> String {
        if let Some(word) = self.words.get(value as usize) {
            return word.clone();
        }
        let number = numbers::among(self.show(value), &self.shown());
        let text = format!("{} = {number} {}", self.symbol, self.unit);
        text.trim_end().to_owned()
    }

    /// Values as shown.
    pub(in crate::plot) fn shown(&self) -> Vec<f64> {
        self.values.iter().map(|&value| self.show(value)).collect()
    }

    /// A value as shown.
    pub(in crate::plot) fn show(&self, value: f64) -> f64 {
        match self.other_shares {
            Some(others) => value / (value + others),
            None => value * self.factor,
        }
    }

    /// The value that is shown so.
    pub(in crate::plot) fn value(&self, shown: f64) -> f64 {
        match self.other_shares {
            Some(others) => others * shown / (1.0 - shown),
            None => shown / self.factor,
        }
    }

    /// How its shown values are spaced: as the settings want it, or else as suits them.
    pub(in crate::plot) fn spacing(&self) -> AxisSpacing {
        match (self.is_even, self.logarithmic()) {
            (true, _) => AxisSpacing::equal(self.shown()),
            (false, true) => AxisSpacing::Logarithmic,
            (false, false) => AxisSpacing::Linear,
        }
    }

    /// Whether the values are spaced by ratios rather than by differences.
    fn logarithmic(&self) -> bool {
        let (Some(&low), Some(&high)) = (self.values.first(), self.values.last()) else {
            return false;
        };
        if self.values.len() < 3 || low <= 0.0 || high / low < 5.0 {
            return false;
        }
        let unevenness = |steps: Vec<f64>| {
            let most = steps.iter().copied().fold(0.0, f64::max);
            let least = steps.iter().copied().fold(f64::INFINITY, f64::min);
            most / least
        };
        let pairs = self.values.windows(2);
        let differences = pairs.clone().map(|pair| pair[1] - pair[0]).collect();
        let ratios = pairs.map(|pair| libm::log(pair[1] / pair[0])).collect();
        unevenness(ratios) < 0.5 * unevenness(differences)
    }

    /// Edges of the cells, one more than values, as shown: midway between neighbours on the axis.
    pub(in crate::plot) fn edges(&self) -> Vec<f64> {
        let spacing = self.spacing();
        let places = self.shown().into_iter().map(|value| spacing.place(value));
        let places: Vec<f64> = places.collect();
        let (Some(&first), Some(&last)) = (places.first(), places.last()) else {
            return Vec::new();
        };
        let halves: Vec<f64> = places
            .windows(2)
            .map(|pair| 0.5 * (pair[1] - pair[0]))
            .collect();
        // A single value has no neighbour: any width serves. Beyond the ends cells reach no farther
        // than the narrowest ones, as nothing is known there.
        let alone = if first == 0.0 { 0.5 } else { 0.5 * first.abs() };
        let outer = halves.iter().copied().reduce(f64::min).unwrap_or(alone);
        let mut edges = vec![first - outer];
        edges.extend(places.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])));
        edges.push(last + outer);
        let values = edges.into_iter().map(|place| spacing.value(place));
        values.collect()
    }

    /// Its range, with ticks at its values where they fit.
    pub(in crate::plot) fn span(&self) -> AxisSpan {
        let edges = self.edges();
        AxisSpan {
            low: edges[0],
            high: edges[edges.len() - 1],
            spacing: self.spacing(),
            ticks: match self.words.as_slice() {
                [] => Ticks::Values(self.shown()),
                _ => Ticks::Given(self.values.iter().map(|it| (*it, self.at(*it))).collect()),
            },
            letters: None,
        }
    }

    /// The value at a fraction of the axis, as shown.
    pub(in crate::plot) fn along(&self, fraction: f64) -> f64 {
        let AxisSpan {
            low, high, spacing, ..
        } = self.span();
        spacing.along(fraction, low, high)
    }

    /// Which of the values a point of the grid has.
    pub(in crate::plot) fn position(&self, values: &[f64]) -> Option<usize> {
        let value = values[self.index];
        self.values.iter().position(|&other| other == value)
    }
}

/// The length (m) that values of a key are shown over, and the symbol of the ratio: radii over that
/// of the tank, openings over the mean diameter of the grains, unless what they are shown over is
/// swept too.
fn scale(key: &str, axes: &[Axis], scene: &Scene) -> Option<(f64, &'static str)> {
    let swept = |name: &str| axes.iter().any(|axis| axis.key.starts_with(name));
    match key {
        "spheres.radius" if !swept("tank.radius") => {
            let radius = scene.tank.as_ref()?.radius?;
            Some((radius, "$r$ / $R$"))
        }
        "geometry.opening" if !swept("spheres.radius") => {
            let diameter = 2.0 * scene.spheres.radius.mean();
            Some((diameter, "$D$ / $d$"))
        }
        _ => None,
    }
}

/// Of an axis over the share of one of several radii: which of them.
fn share_index(key: &str) -> Option<usize> {
    let index = key.strip_prefix("spheres.radius[")?;
    index.strip_suffix("].share")?.parse().ok()
}

/// The shares of all radii but one.
fn other_shares(index: usize, scene: &Scene) -> f64 {
    let shares = scene.spheres.radius.shares().iter().enumerate();
    let others = shares.filter(|(other, _)| *other != index);
    others.map(|(_, share)| share.share).sum()
}

/// What an axis over the share of one of several radii is called.
fn share_of(key: &str, scene: &Scene) -> Option<String> {
    let index = share_index(key)?;
    let shares = scene.spheres.radius.shares();
    let radii: Vec<f64> = shares.iter().map(|share| share.radius * 1e3).collect();
    let radius = numbers::among(*radii.get(index)?, &radii);
    Some(format!("share of grains of $r$ = {radius} mm"))
}

/// The vertical axis of a figure that has none: from 0 to 1, without ticks.
pub(in crate::plot) fn strip() -> AxisSpan {
    AxisSpan {
        ticks: Ticks::Given(Vec::new()),
        ..AxisSpan::linear((0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn axis(values: &[f64]) -> GridAxis {
        GridAxis {
            key: "swirl.omega".to_owned(),
            name: "omega".to_owned(),
            values: values.to_vec(),
            factor: 1.0,
            other_shares: None,
            symbol: "$Ω$".to_owned(),
            unit: "rad/s".to_owned(),
            index: 0,
            is_even: false,
            is_scaled: false,
            words: Vec::new(),
        }
    }

    #[test]
    fn edges_are_midpoints() {
        let omega = axis(&[0.0, 2.0, 4.0, 8.0, 16.0, 40.0]);
        assert!(!omega.logarithmic());
        assert_eq!(omega.edges(), [-1.0, 1.0, 3.0, 6.0, 12.0, 28.0, 41.0]);
        assert_eq!(axis(&[4.0]).edges(), [2.0, 6.0]);
        assert_eq!(axis(&[0.0]).edges(), [-0.5, 0.5]);
    }

    #[test]
    fn logarithmic_spacing_is_seen() {
        let decades = axis(&[1e-3, 1e-2, 1e-1]);
        assert!(decades.logarithmic());
        for (edge, expected) in decades.edges().iter().zip([-3.5, -2.5, -1.5, -0.5]) {
            assert!((libm::log10(*edge) - expected).abs() < 1e-12);
        }
        assert!(axis(&[1.0, 2.0, 5.0, 10.0, 20.0, 50.0]).logarithmic());
        assert!(!axis(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).logarithmic());
        assert!(!axis(&[-1.0, 0.0, 100.0]).logarithmic());
    }

    #[test]
    fn head_of_a_panel() {
        assert_eq!(axis(&[4.0]).at(4.0), "$Ω$ = 4 rad/s");
    }

    proptest! {
        #[test]
        fn edges_ascend_and_enclose_their_values(
            mut values in prop::collection::vec(-1e3..1e3_f64, 1..20)
        ) {
            values.sort_by(f64::total_cmp);
            values.dedup();
            let axis = axis(&values);
            let edges = axis.edges();
            prop_assert_eq!(edges.len(), values.len() + 1);
            for (index, value) in values.iter().enumerate() {
                prop_assert!(edges[index] <= *value && *value <= edges[index + 1]);
            }
        }
    }
}
