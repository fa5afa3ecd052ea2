//! Verification: simulations of set-ups with known results.
//!
//! A [`Case`] is a row of data: a set-up, the expected numbers, a tolerance, a source. A family is
//! a kind of set-up with its parameters: a file that simulates and measures it, and a table of
//! cases. A new case is a new row; a new family is a file, its table, and a line each in
//! [`CaseSetup`] and `TABLES`.
//!
//! ```
//! use phase::{scene::Integrator, verify};
//!
//! let case = verify::cases().iter().find(|case| case.name == "cradle of three").unwrap();
//! let outcome = verify::run(case, Integrator::VelocityVerlet).unwrap();
//! assert!(outcome.passed());
//! ```

mod air_force;
mod attractive_impact;
mod bench;
mod columns;
mod convergence;
mod cradle;
mod critical_rotation;
mod dashpot;
mod flight;
mod gas;
mod impact;
mod incline;
mod material;
mod oscillation;
mod rolling;
mod rolling_resistance;
mod spot_flow;
mod stack;
mod step_limit;
mod tangential_loop;
mod tripod;
mod wall_orbit;

pub use material::{AnyMaterial, HookeMaterial, Material, SilbertMaterial, TsujiMaterial};

use crate::cpu_time;
use crate::dem::DemBuildError;
use crate::record::Instability;
use crate::scene::Integrator;
use bench::Bench;
use serde::Deserialize;
use serde::de::Error as _;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

/// The tables of all families.
const TABLES: [&str; 20] = [
    include_str!("impact.toml"),
    include_str!("dashpot.toml"),
    include_str!("attractive_impact.toml"),
    include_str!("tangential_loop.toml"),
    include_str!("cradle.toml"),
    include_str!("rolling.toml"),
    include_str!("incline.toml"),
    include_str!("rolling_resistance.toml"),
    include_str!("stack.toml"),
    include_str!("tripod.toml"),
    include_str!("oscillation.toml"),
    include_str!("flight.toml"),
    include_str!("air_force.toml"),
    include_str!("wall_orbit.toml"),
    include_str!("gas.toml"),
    include_str!("critical_rotation.toml"),
    include_str!("columns.toml"),
    include_str!("step_limit.toml"),
    include_str!("convergence.toml"),
    include_str!("spot_flow.toml"),
];

/// A set-up with a known result.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// A unique short description.
    pub name: String,
    /// The family and its parameters.
    pub setup: CaseSetup,
    /// Quantities that the family measures, in SI units, and their expected numbers.
    pub expect: BTreeMap<String, f64>,
    /// Allowed deviation of a measurement from its number.
    pub tolerance: CaseTolerance,
    /// Source of the numbers.
    pub source: String,
    /// Integrators that are expected to pass; all, if the row does not say.
    #[serde(default = "all_integrators")]
    pub integrators: Vec<Integrator>,
}

fn all_integrators() -> Vec<Integrator> {
    Integrator::ALL.to_vec()
}

/// Allowed deviation of a measurement from its number.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CaseTolerance {
    /// As a fraction of the number.
    Relative(f64),
    /// In the unit of the number.
    Absolute(f64),
}

impl CaseTolerance {
    /// Error of a measurement, on the scale of this tolerance.
    fn error(self, measured: f64, expected: f64) -> f64 {
        let difference = (measured - expected).abs();
        match self {
            Self::Relative(_) => difference / expected.abs(),
            Self::Absolute(_) => difference,
        }
    }

    /// Largest error allowed.
    pub fn limit(self) -> f64 {
        match self {
            Self::Relative(limit) | Self::Absolute(limit) => limit,
        }
    }
}

/// A family with the parameters of one set-up.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "family", rename_all = "kebab-case")]
pub enum CaseSetup {
    /// A sphere hits a sphere or a wall.
    Impact(impact::ImpactCase),
    /// Two discs, or a disc and a fixed one, hit each other under the linear contact.
    Dashpot(dashpot::Dashpot),
    /// A sphere hits another one, or something fixed, under a contact that attracts at its end.
    AttractiveImpact(attractive_impact::AttractiveImpact),
    /// A sphere is pressed on the floor and moved back and forth.
    TangentialLoop(tangential_loop::TangentialLoop),
    /// Spheres in a row, hit by the first of them.
    Cradle(cradle::Cradle),
    /// A sphere slides on the floor until it rolls.
    Rolling(rolling::RollingCase),
    /// A sphere rolls or slides down an incline.
    Incline(incline::Incline),
    /// A sphere rolls against rolling resistance, on the level or on an incline.
    RollingResistance(rolling_resistance::RollingResistance),
    /// A column of spheres at rest.
    Stack(stack::Stack),
    /// A sphere at rest on three others in a cylinder.
    Tripod(tripod::Tripod),
    /// A sphere on the floor oscillates about its rest position.
    Oscillation(oscillation::Oscillation),
    /// A single sphere in air and gravity.
    Flight(flight::Flight),
    /// Forces of the air on spheres at given places.
    AirForce(air_force::AirForce),
    /// A sphere that rotating air drives along the cylinder.
    WallOrbit(wall_orbit::WallOrbit),
    /// An elastic gas in the tank.
    Gas(gas::Gas),
    /// The critical rotation, in closed form.
    CriticalRotation(critical_rotation::CriticalRotation),
    /// Further columns of spheres at given places.
    Columns(columns::Columns),
    /// Limits of the time step, in closed form.
    StepLimit(step_limit::StepLimit),
    /// A scene with decreasing time steps.
    Convergence(convergence::Convergence),
    /// Spots that rise through a packing.
    SpotFlow(spot_flow::SpotFlow),
}

impl CaseSetup {
    fn family(&self) -> &dyn CaseFamily {
        match self {
            Self::Impact(it) => it,
            Self::Dashpot(it) => it,
            Self::AttractiveImpact(it) => it,
            Self::TangentialLoop(it) => it,
            Self::Cradle(it) => it,
            Self::Rolling(it) => it,
            Self::Incline(it) => it,
            Self::RollingResistance(it) => it,
            Self::Stack(it) => it,
            Self::Tripod(it) => it,
            Self::Oscillation(it) => it,
            Self::Flight(it) => it,
            Self::AirForce(it) => it,
            Self::WallOrbit(it) => it,
            Self::Gas(it) => it,
            Self::CriticalRotation(it) => it,
            Self::Columns(it) => it,
            Self::StepLimit(it) => it,
            Self::Convergence(it) => it,
            Self::SpotFlow(it) => it,
        }
    }

    /// Name of the family, as in the tables.
    pub fn name(&self) -> &'static str {
        self.family().name()
    }
}

/// A kind of set-up.
trait CaseFamily {
    /// Its name, as in the tables.
    fn name(&self) -> &'static str;

    /// Simulates the set-up and measures it.
    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError>;
}

/// Quantities and their measured values (SI units).
type MeasuredValues = BTreeMap<String, f64>;

/// Names quantities numbered from 1.
fn numbered(quantity: &str, values: impl IntoIterator<Item = f64>) -> MeasuredValues {
    let values = values.into_iter().enumerate();
    values
        .map(|(i, value)| (format!("{quantity}_{}", i + 1), value))
        .collect()
}

/// Names quantities.
fn named<const N: usize>(quantities: [(&str, f64); N]) -> MeasuredValues {
    quantities
        .map(|(quantity, value)| (quantity.to_owned(), value))
        .into()
}

/// An expected number and its measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// The quantity.
    pub quantity: String,
    /// The expected number (SI units).
    pub expected: f64,
    /// The measured number (SI units).
    pub measured: f64,
    /// Error on the scale of the tolerance.
    pub error: f64,
    /// Largest error allowed.
    pub limit: f64,
}

impl Check {
    /// Whether the measurement is within its tolerance.
    pub fn passed(&self) -> bool {
        self.error <= self.limit
    }
}

/// The outcome of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseOutcome {
    /// The comparison of every expected number.
    pub checks: Vec<Check>,
    /// Steps simulated.
    pub steps: u64,
    /// How often spheres were moved, counting sub-steps: each time with an evaluation of the force.
    pub moves: u64,
    /// Processor time it took (s).
    pub cpu_seconds: f64,
}

impl CaseOutcome {
    /// Whether every measurement is within its tolerance.
    pub fn passed(&self) -> bool {
        self.checks.iter().all(Check::passed)
    }
}

/// Why a case has no outcome.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// The scene cannot be built.
    #[error(transparent)]
    Build(#[from] DemBuildError),
    /// A guard ended the simulation.
    #[error(transparent)]
    Unstable(#[from] Instability),
    /// A spot simulation cannot start, or breaks a guard.
    #[error("{0}")]
    Spots(String),
    /// It was told to stop.
    #[error("stopped before its end")]
    Stopped,
    /// The event that the family waits for does not happen.
    #[error("no end after {steps} steps: {awaited}")]
    Unfinished {
        /// The awaited event.
        awaited: &'static str,
        /// Steps done.
        steps: u64,
    },
    /// The family does not measure this.
    #[error("this set-up has no quantity \"{quantity}\"; it has {known}")]
    UnknownQuantity {
        /// The expected quantity.
        quantity: String,
        /// The measured quantities, separated by commas.
        known: String,
    },
}

/// All cases.
pub fn cases() -> &'static [Case] {
    static CASES: OnceLock<Vec<Case>> = OnceLock::new();
    CASES.get_or_init(|| {
        let read = |text: &&str| parse(text).expect("tests read every table");
        TABLES.iter().flat_map(read).collect()
    })
}

/// The row of a case as in its table, so that some of its keys can be changed.
pub(crate) fn row(name: &str) -> Option<Value> {
    let mut rows = TABLES
        .iter()
        .flat_map(|text| rows(text).unwrap_or_default());
    rows.find(|row| row["name"] == name)
}

fn rows(text: &str) -> Result<Vec<Value>, toml::de::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Table {
        case: Vec<Value>,
    }
    Ok(toml::from_str::<Table>(text)?.case)
}

/// Reads a table of cases.
///
/// # Errors
/// The first place that is not such a table.
pub fn parse(text: &str) -> Result<Vec<Case>, toml::de::Error> {
    rows(text)?
        .into_iter()
        .enumerate()
        .map(|(row, case)| {
            // Via a tree, like scenes, so that the code that reads families is compiled only once.
            serde_json::from_value(case).map_err(|error| {
                toml::de::Error::custom(format!("case {} of the table: {error}", row + 1))
            })
        })
        .collect()
}

/// Simulates a case with an integrator and compares.
///
/// # Errors
/// If the set-up cannot be simulated, or the case expects a quantity that its family does not
/// measure.
pub fn run(case: &Case, integrator: Integrator) -> Result<CaseOutcome, VerifyError> {
    run_until(case, integrator, &AtomicBool::new(false))
}

/// The same, but stops when `stop` is set.
///
/// # Errors
/// As for [`run`], and [`VerifyError::Stopped`].
pub fn run_until(
    case: &Case,
    integrator: Integrator,
    stop: &AtomicBool,
) -> Result<CaseOutcome, VerifyError> {
    let started = cpu_time::of_this_thread();
    let mut bench = Bench::new(integrator, &case.expect, stop);
    let measured = case.setup.family().measure(&mut bench)?;
    let check = |(quantity, &expected): (&String, &f64)| match measured.get(quantity) {
        Some(&measured) => Ok(Check {
            quantity: quantity.clone(),
            expected,
            measured,
            error: case.tolerance.error(measured, expected),
            limit: case.tolerance.limit(),
        }),
        None => Err(VerifyError::UnknownQuantity {
            quantity: quantity.clone(),
            known: measured.keys().cloned().collect::<Vec<_>>().join(", "),
        }),
    };
    Ok(CaseOutcome {
        checks: case.expect.iter().map(check).collect::<Result<_, _>>()?,
        steps: bench.steps(),
        moves: bench.moves(),
        cpu_seconds: cpu_time::of_this_thread() - started,
    })
}
