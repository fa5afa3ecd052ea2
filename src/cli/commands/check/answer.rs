//! What `phase check --json` prints.

use super::{Arguments, walls};
use crate::cli::job;
use crate::cli::time_step::Tightest;
use phase::cost::Forecast;
use phase::dem::timestep::StepMargin;
use phase::grid::{Axis, Variant};
use phase::scene::{FileKind, Time};
use phase::sweep::{Job, Sweep, differing_keys};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// An axis of numbers or of variants, which are named.
#[derive(Serialize)]
pub(super) struct AxisAnswer<'a> {
    key: &'a str,
    name: &'a str,
    values: Vec<Value>,
}

impl<'a> AxisAnswer<'a> {
    pub(super) fn of(axis: &'a Axis) -> Self {
        let value = |value: &f64| match axis.variant(*value) {
            Some(variant) => variant.name.as_str().into(),
            None => (*value).into(),
        };
        Self {
            key: &axis.key,
            name: &axis.name,
            values: axis.values.iter().map(value).collect(),
        }
    }
}

/// What `--json` prints.
#[derive(Serialize)]
pub(super) struct Answer<'a> {
    file: &'a Path,
    kind: &'static str,
    title: Option<&'a str>,
    jobs: usize,
    axes: Vec<AxisAnswer<'a>>,
    seeds: &'a [u64],
    /// The named changes of the scene.
    variants: Vec<VariantAnswer<'a>>,
    /// Most runs of a refined sweep; `None` if the whole grid is run.
    budget: Option<usize>,
    /// What its program runs at the first point; `None` of scenes of spheres, which have all that
    /// follows.
    commands: Option<Vec<Vec<String>>>,
    spheres: Option<usize>,
    effects: Vec<String>,
    duration: Option<f64>,
    frames: Option<u64>,
    steps_per_frame: Option<u64>,
    dt: Option<f64>,
    /// The safety factor of `dt = "auto"`; `None` if the step was given.
    safety_factor: Option<f64>,
    limits: Vec<LimitAnswer>,
    /// Whether walls of discs hold; `None` without such walls.
    pub(super) walls: Option<walls::Answer>,
    pub(super) forecast: Option<ForecastAnswer>,
}

impl<'a> Answer<'a> {
    /// The answer on a sweep, without walls and forecast.
    pub(super) fn new(
        (arguments, kind): (&'a Arguments, FileKind),
        sweep: &'a Sweep,
        jobs: &[Job],
        tightest: &[Tightest<'_>],
    ) -> Self {
        let scene = &sweep.scene;
        let variants = sweep.axes.iter().flat_map(|axis| &axis.variants);
        let limits = tightest.iter();
        let time = (!scene.is_external()).then_some(&scene.time);
        Self {
            file: &arguments.file,
            kind: kind.name(),
            title: sweep.title.as_deref().or(scene.title.as_deref()),
            jobs: jobs.len(),
            axes: sweep.axes.iter().map(AxisAnswer::of).collect(),
            seeds: &sweep.seeds,
            variants: variants.map(|it| VariantAnswer::of(it, sweep)).collect(),
            budget: sweep.refine.as_ref().map(|it| it.budget),
            commands: jobs
                .first()
                .and_then(|job| job.scene().filled_program())
                .map(|program| program.commands),
            spheres: time.map(|_| scene.spheres.count),
            effects: super::effects(scene),
            duration: time.map(|it| it.duration),
            frames: time.map(Time::frames),
            steps_per_frame: time.map(Time::steps_per_frame),
            dt: time.map(|it| it.dt),
            safety_factor: scene.time.safety_factor,
            limits: limits
                .map(|limit| LimitAnswer::new(limit, &sweep.axes))
                .collect(),
            walls: None,
            forecast: None,
        }
    }
}

/// A named change of the scene.
#[derive(Serialize)]
struct VariantAnswer<'a> {
    name: &'a str,
    /// Keys and tables in which it differs from the scene.
    keys: Vec<String>,
    /// Factors on the values of axes, by the names of these.
    scale: BTreeMap<&'a str, f64>,
    effects: Vec<String>,
}

impl<'a> VariantAnswer<'a> {
    fn of(variant: &'a Variant, sweep: &Sweep) -> Self {
        let scale = variant.scale.iter();
        Self {
            name: &variant.name,
            keys: differing_keys(&sweep.scene, &variant.scene),
            scale: scale
                .map(|(axis, factor)| (axis.as_str(), *factor))
                .collect(),
            effects: super::effects(&variant.scene),
        }
    }
}

/// A limit of the time step, and the job that comes closest to it.
#[derive(Serialize)]
pub(super) struct LimitAnswer {
    name: &'static str,
    seconds: f64,
    decisive: bool,
    ratio: f64,
    point: BTreeMap<String, Value>,
    seed: u64,
}

impl LimitAnswer {
    pub(super) fn new(tightest: &Tightest<'_>, axes: &[Axis]) -> Self {
        let StepMargin { limit, ratio } = tightest.standing;
        Self {
            name: limit.name,
            seconds: limit.seconds,
            decisive: limit.decisive,
            ratio,
            point: job::point(axes, &tightest.job.values),
            seed: tightest.job.seed,
        }
    }
}

/// What the sweep will cost.
#[derive(Serialize)]
pub(super) struct ForecastAnswer {
    workers: usize,
    #[serde(flatten)]
    forecast: Forecast,
}

impl ForecastAnswer {
    pub(super) fn new(forecast: &Forecast, workers: usize) -> Self {
        Self {
            workers,
            forecast: *forecast,
        }
    }
}
