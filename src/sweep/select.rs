//! Choosing points of a sweep by the values of its axes.

use super::Sweep;

/// Why no point could be chosen.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SelectError {
    /// The text is no list of `name=value`.
    #[error("`{0}` is not of the form `name=value`, such as `radius=0.003,omega=6`")]
    Syntax(String),
    /// The sweep has no such axis.
    #[error("the sweep has no axis `{name}`; it has {known}")]
    Axis {
        /// What was asked for.
        name: String,
        /// The sweep's axes.
        known: String,
    },
    /// The axis has no such value.
    #[error("`{name}` is never {value}; it takes {values}")]
    Value {
        /// Name of the axis.
        name: String,
        /// What was asked for.
        value: String,
        /// The values of the axis.
        values: String,
    },
}

/// Reads the values of a point, such as `radius=0.003,omega=6`.
///
/// # Errors
/// [`SelectError::Syntax`] with the part that is at fault.
pub fn parse_point(text: &str) -> Result<Vec<(String, f64)>, SelectError> {
    let pair = |part: &str| {
        let (name, value) = part.split_once('=')?;
        let value: f64 = value.trim().parse().ok()?;
        value.is_finite().then(|| (name.trim().to_owned(), value))
    };
    text.split(',')
        .map(|part| pair(part).ok_or_else(|| SelectError::Syntax(part.trim().to_owned())))
        .collect()
}

impl Sweep {
    /// This sweep with only the named values left on the named axes. A name may be that of the
    /// axis, the path of its key, or `seed`; a value is found within rounding.
    ///
    /// # Errors
    /// [`SelectError::Axis`] or [`SelectError::Value`].
    pub fn select(&self, point: &[(String, f64)]) -> Result<Self, SelectError> {
        let mut chosen = self.clone();
        for (name, value) in point {
            if name == "seed" {
                chosen.seeds.retain(|&seed| seed as f64 == *value);
                chosen.border_seeds.retain(|&seed| seed as f64 == *value);
                if chosen.seeds.is_empty() && chosen.border_seeds.is_empty() {
                    return Err(SelectError::Value {
                        name: name.clone(),
                        value: value.to_string(),
                        values: join(self.seeds.iter().chain(&self.border_seeds)),
                    });
                }
                continue;
            }
            let named = |axis: &&mut super::Axis| axis.name == *name || axis.key == *name;
            let Some(axis) = chosen.axes.iter_mut().find(named) else {
                return Err(SelectError::Axis {
                    name: name.clone(),
                    known: join(self.axes.iter().map(|axis| &axis.name)),
                });
            };
            let near = |&&known: &&f64| (known - value).abs() <= 1e-9 * known.abs();
            let Some(&known) = axis.values.iter().find(near) else {
                return Err(SelectError::Value {
                    name: name.clone(),
                    value: value.to_string(),
                    values: join(&axis.values),
                });
            };
            axis.values = vec![known];
        }
        Ok(chosen)
    }
}

fn join<T: ToString>(items: impl IntoIterator<Item = T>) -> String {
    let items: Vec<String> = items.into_iter().map(|item| item.to_string()).collect();
    items.join(", ")
}
