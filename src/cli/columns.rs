//! Tables and numbers as text.

use phase::statistics::Estimate;

/// Rows of as many cells as lines of text, in columns.
pub(super) fn in_columns<R: AsRef<[String]>>(rows: &[R]) -> Vec<String> {
    let columns = rows.first().map_or(0, |row| row.as_ref().len());
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.as_ref().get(column));
        cells.map(|cell| cell.chars().count()).max()
    };
    let widths: Vec<usize> = (0..columns).filter_map(width).collect();
    let line = |row: &R| {
        let cells = row.as_ref().iter().zip(&widths);
        let padded = cells.map(|(cell, &width)| format!("{cell:<width$}"));
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

/// A value with its interval, if that is known.
pub(super) fn written(estimate: Estimate) -> String {
    match estimate.half_width.is_finite() {
        true => format!(
            "{:.4} ± {:.2}",
            Short(estimate.value),
            Short(estimate.half_width)
        ),
        false => format!("{:.4}", Short(estimate.value)),
    }
}

/// A number with so many significant digits as the precision says.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = formatter.precision().unwrap_or(4).saturating_sub(1);
        let rounded: f64 = format!("{:.digits$e}", self.0).parse().unwrap_or(self.0);
        match rounded.abs() {
            0.0 | 1e-3..1e6 => write!(formatter, "{rounded}"),
            _ => write!(formatter, "{rounded:e}"),
        }
    }
}
