//! Figures of a study of accuracy.

mod changes;
mod step_time;
mod work_precision;

use super::{Figure, StudyResult};
use crate::study::accuracy::Subject;

/// All of them.
pub(super) fn figures() -> [Figure; 3] {
    [
        Figure::of_study(
            "work-precision",
            "error of each setting against its processor time",
            |study, program| match study {
                StudyResult::Accuracy(study, found) => {
                    Some(work_precision::draw(study, found, program))
                }
                _ => None,
            },
        ),
        Figure::of_study(
            "label-changes",
            "labels that each setting changes, over the axes",
            |study, program| match study {
                StudyResult::Accuracy(study, found) => match &study.subject {
                    Subject::Scene(comparison) => {
                        Some(changes::draw(study, comparison, found, program))
                    }
                    Subject::Case(_) => None,
                },
                _ => None,
            },
        ),
        Figure::of_study(
            "step-time",
            "processor time of a step per sphere, over an axis or a ladder",
            |study, program| match study {
                StudyResult::StepTimes(comparison, rows, x) => {
                    Some(step_time::draw(x, comparison, rows, program))
                }
                _ => None,
            },
        ),
    ]
}

/// Colour of a line by its number.
fn color(line: usize, lines: usize) -> plotters::style::RGBColor {
    use super::palette;
    match lines <= palette::LINES.len() {
        true => palette::LINES[line % palette::LINES.len()],
        false => palette::DISTINCT[line % palette::DISTINCT.len()],
    }
}
