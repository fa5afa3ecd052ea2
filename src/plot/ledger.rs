//! The ledger of a run: where its energy is and went, and what the integrator got wrong.

use super::chart::{self, Chart, Line, Panel, prefixed};
use super::style::px;
use super::svg::Svg;
use super::{PlotError, palette};
use crate::observe::Observations;
use crate::record::RunRecord;
use plotters::style::{BLACK, RGBColor};

/// One kind of energy over time (J).
struct Account {
    name: &'static str,
    color: RGBColor,
    values: Vec<f64>,
}

/// Draws the ledger of a run.
///
/// # Errors
/// [`PlotError::NoLedger`] if the record holds none.
pub fn draw(record: &RunRecord) -> Result<Svg, PlotError> {
    let observations = &record.observations;
    if observations.residual.is_empty() {
        return Err(PlotError::NoLedger);
    }
    let accounts = accounts(observations);
    let residual = Account {
        name: "residual",
        color: BLACK,
        values: wide(&observations.residual),
    };
    let panels = [
        panel("where the energy is, and went", &accounts, observations),
        panel(
            "residual, what the integrator got wrong",
            std::slice::from_ref(&residual),
            observations,
        ),
    ];
    let chart = Chart {
        name: "ledger",
        common: vec![format!(
            "{}, time step {} s",
            record.scene.time.integrator.name(),
            crate::document::number(record.scene.time.dt)
        )],
        panels: panels.into(),
        columns: 1,
        height: px(240),
        x_label: "time (s)".to_owned(),
        y_label: "energy".to_owned(),
        legend: accounts
            .iter()
            .map(|account| (account.color, account.name.to_owned()))
            .collect(),
        notes: Vec::new(),
    };
    let (size, body) = chart.body(record.scene.title.as_deref())?;
    Ok(Svg::of_record("ledger", record, size, &body))
}

fn wide(values: &[f32]) -> Vec<f64> {
    values.iter().copied().map(f64::from).collect()
}

/// All kinds of energy that the run knew.
fn accounts(observations: &Observations) -> Vec<Account> {
    let Observations {
        kinetic,
        rotational,
        gravitational,
        elastic,
        springs,
        dissipated_by_damping,
        dissipated_by_friction,
        work_of_air,
        energy_brought,
        ..
    } = observations;
    let gravitational = wide(gravitational);
    let start = gravitational.first().copied().unwrap_or(0.0);
    let [blue, red, green, pink, orange, light_blue] = palette::DISTINCT;
    let accounts = [
        ("kinetic", blue, wide(kinetic)),
        ("rotational", light_blue, wide(rotational)),
        (
            "gravitational, from the start on",
            green,
            gravitational.iter().map(|energy| energy - start).collect(),
        ),
        (
            "elastic, in contacts and tangential springs",
            palette::LINES[0],
            elastic
                .iter()
                .zip(springs)
                .map(|(elastic, springs)| f64::from(*elastic) + f64::from(*springs))
                .collect(),
        ),
        ("dissipated by damping", red, wide(dissipated_by_damping)),
        (
            "dissipated by friction",
            orange,
            wide(dissipated_by_friction),
        ),
        ("work of the air", pink, wide(work_of_air)),
        ("brought by spheres", palette::GUIDE, wide(energy_brought)),
    ];
    let accounts = accounts.into_iter().map(|(name, color, values)| Account {
        name,
        color,
        values,
    });
    let is_known = |account: &Account| account.values.iter().any(|value| *value != 0.0);
    accounts.filter(is_known).collect()
}

/// A panel in the unit that its largest value asks for, which its head names.
fn panel(head: &str, accounts: &[Account], observations: &Observations) -> Panel {
    let values = || accounts.iter().flat_map(|account| account.values.iter());
    let largest = values().fold(0.0, |most: f64, value| most.max(value.abs()));
    let (unit, factor) = prefixed("J", largest);
    let lines = accounts.iter().map(|account| Line {
        points: observations
            .time
            .iter()
            .zip(&account.values)
            .map(|(time, value)| (*time, value * factor))
            .collect(),
        color: account.color,
    });
    Panel {
        head: vec![format!("{head} ({unit})")],
        x: (0.0, observations.time.last().copied().unwrap_or(1.0)),
        y: chart::range(values().map(|value| value * factor)).unwrap_or((0.0, 1.0)),
        lines: lines.collect(),
        bars: Vec::new(),
    }
}
