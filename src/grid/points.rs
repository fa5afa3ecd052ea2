//! The points of a grid and their scenes.

use super::{Axis, Variant};
use crate::document::{Problem, number};
use crate::scene::{Scene, Template};

/// A point of the grid whose scene cannot be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{}", if point.is_empty() { String::new() } else { format!("at {point}: ") },
    problems.iter().map(Problem::to_string).collect::<Vec<_>>().join("; "))]
pub struct PointError {
    /// The point, such as `radius = 0.003, omega = 6`; empty for a sweep without axes.
    pub point: String,
    /// Place of its variant, if it has one.
    pub variant: Option<usize>,
    /// What is wrong there.
    pub problems: Vec<Problem>,
}

crate::refusal::always!(true: PointError);

/// The points of a grid, in order: the first axis varies slowest.
pub(crate) fn points(axes: &[Axis]) -> impl Iterator<Item = Vec<f64>> {
    (0..number_of_points(axes)).map(move |index| point_at(axes, index))
}

/// The point of a grid with that place in its order.
pub(crate) fn point_at(axes: &[Axis], mut index: usize) -> Vec<f64> {
    let from_last = axes.iter().rev().map(|axis| {
        let value = axis.values[index % axis.values.len()];
        index /= axis.values.len();
        value
    });
    let mut values: Vec<f64> = from_last.collect();
    values.reverse();
    values
}

/// The variant of a point, if the grid has variants.
pub(crate) fn variant_at<'a>(axes: &'a [Axis], values: &[f64]) -> Option<&'a Variant> {
    let mut pairs = axes.iter().zip(values);
    pairs.find_map(|(axis, &value)| axis.variant(value))
}

/// The values of the keys at a point: those of the axes times the factors of its variant.
fn values_of_keys(axes: &[Axis], values: &[f64]) -> Vec<f64> {
    let Some(variant) = variant_at(axes, values) else {
        return values.to_vec();
    };
    let pairs = axes.iter().zip(values);
    pairs
        .map(|(axis, value)| variant.factor(&axis.name) * value)
        .collect()
}

/// Number of points of a grid.
pub(crate) fn number_of_points(axes: &[Axis]) -> usize {
    let sizes = axes.iter().map(|axis| axis.values.len());
    sizes.fold(1, usize::saturating_mul)
}

/// The scenes of the points of a grid.
pub(crate) struct PointScenes {
    axes: Vec<Axis>,
    /// One for each variant; one alone without variants.
    templates: Vec<Template>,
}

impl PointScenes {
    /// The scenes of all points, made of `scene`, whose numbers must be in their ranges.
    pub(crate) fn new(scene: &Scene, axes: &[Axis]) -> Result<Self, PointError> {
        let numbers = axes.iter().filter(|axis| !axis.is_of_variants());
        let keys: Vec<&str> = numbers.map(|axis| axis.key.as_str()).collect();
        let template = |scene: &Scene| {
            let template = Template::new(scene, &keys);
            template.map_err(|problem| PointError::new(&[], &[], vec![problem]))
        };
        let variants = axes.iter().flat_map(|axis| &axis.variants);
        let mut templates = variants
            .map(|variant| template(&variant.scene))
            .collect::<Result<Vec<_>, _>>()?;
        if templates.is_empty() {
            templates.push(template(scene)?);
        }
        Ok(Self {
            axes: axes.to_vec(),
            templates,
        })
    }

    /// The scene of a point. Only the ranges of its numbers are checked.
    pub(crate) fn unchecked(&self, values: &[f64]) -> Result<Scene, PointError> {
        let scaled = self.axes.iter().zip(values_of_keys(&self.axes, values));
        let (variants, numbers): (Vec<_>, Vec<_>) =
            scaled.partition(|(axis, _)| axis.is_of_variants());
        let numbers: Vec<f64> = numbers.into_iter().map(|(_, value)| value).collect();
        let template = variants.first().map_or(0, |(_, place)| *place as usize);
        let scene = self.templates[template].with(&numbers);
        scene.map_err(|problems| self.error(values, problems))
    }

    /// The scene that is run at a point.
    pub(crate) fn checked(&self, values: &[f64]) -> Result<Scene, PointError> {
        let scene = self.unchecked(values)?.with_chosen_step_in_range();
        scene.map_err(|problems| self.error(values, problems))
    }

    /// What is wrong at a point.
    pub(crate) fn error(&self, values: &[f64], problems: Vec<Problem>) -> PointError {
        PointError::new(&self.axes, values, problems)
    }
}

impl PointError {
    /// What is wrong at the point with these values.
    pub(crate) fn new(axes: &[Axis], values: &[f64], problems: Vec<Problem>) -> Self {
        let pairs = axes.iter().zip(values);
        let mut places = pairs.clone().filter(|(axis, _)| axis.is_of_variants());
        let variant = places.next().map(|(_, place)| *place as usize);
        let pairs: Vec<String> = pairs
            .map(|(axis, &value)| match axis.variant(value) {
                Some(variant) => format!("{} = {}", axis.name, variant.name),
                None => format!("{} = {}", axis.name, number(value)),
            })
            .collect();
        Self {
            point: pairs.join(", "),
            variant,
            problems,
        }
    }
}

/// Names a point of the grid with its seed: `radius = 0.003, omega = 6, seed 1`.
pub fn describe(axes: &[Axis], values: &[f64], seed: u64) -> String {
    match describe_point(axes, values) {
        point if point.is_empty() => format!("seed {seed}"),
        point => format!("{point}, seed {seed}"),
    }
}

/// Names a point of the grid: `radius = 0.003, omega = 6`.
pub(crate) fn describe_point(axes: &[Axis], values: &[f64]) -> String {
    let pairs = axes.iter().zip(values);
    let pairs = pairs.map(|(axis, value)| format!("{} = {}", axis.name, axis.word(*value)));
    pairs.collect::<Vec<_>>().join(", ")
}
