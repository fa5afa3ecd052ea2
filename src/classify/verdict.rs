//! The evidence of all sieves for one run.

use super::rules::MARGIN;
use super::{ClassifyError, Family, Label, Sieves, rules};
use crate::record::{Outcome, RunRecord};

/// The evidence of all sieves for one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The label.
    pub label: Label,
    /// Whose label and measures these are.
    pub family: &'static Family,
    /// Whether the run became steady before its time was up; none in a scene that does not ask for
    /// it, and of an unstable run.
    pub steady: Option<bool>,
    /// Values of the family's measures, in their order.
    pub values: Vec<Option<f64>>,
}

impl Verdict {
    /// A label without a measured value.
    pub fn unmeasured(family: &'static Family, label: Label) -> Self {
        Self {
            label,
            family,
            steady: None,
            values: vec![None; family.measures().count()],
        }
    }

    /// The same with a value of the measure of that name; none if the family has no such measure.
    pub fn with(mut self, name: &str, value: Option<f64>) -> Option<Self> {
        let place = self.family.measures().position(|it| it.name == name)?;
        *self.values.get_mut(place)? = value;
        Some(self)
    }

    /// The margin of each rule of the family, by the code of its label; none of an unstable run. A
    /// margin that is undefined is not a number.
    pub fn margins(&self) -> Vec<(i8, f64)> {
        if self.label == Label::UNSTABLE {
            return Vec::new();
        }
        let rules = self.family.rules.iter();
        let margins = rules.map(|rule| {
            let margin = self.value(rule.evidence[MARGIN].name);
            (rule.label.code, margin.unwrap_or(f64::NAN))
        });
        margins.collect()
    }

    /// Value of the measure of that name; none if it is undefined for the run, or is no measure of
    /// the family.
    pub fn value(&self, name: &str) -> Option<f64> {
        let place = self.family.measures().position(|it| it.name == name)?;
        self.values.get(place).copied().flatten()
    }
}

/// Labels one run: unstable if a guard ended it, else what the sieves of its family say. An
/// unstable run has no measured value, since its numbers mean nothing.
///
/// # Errors
/// The sieves cannot judge runs of this scene (see [`Sieves::check`]), or the record contradicts
/// itself.
pub fn classify(record: &RunRecord, sieves: &Sieves) -> Result<Verdict, ClassifyError> {
    sieves.check(&record.scene)?;
    let family = sieves.family(&record.scene);
    if let Outcome::Unstable(_) = record.outcome {
        return Ok(Verdict::unmeasured(family, Label::UNSTABLE));
    }
    let (label, values) = rules::judge(family, record, sieves)?;
    Ok(Verdict {
        label,
        family,
        steady: record.is_steady(),
        values,
    })
}
