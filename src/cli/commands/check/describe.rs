//! What `phase check` says of a file: its grid, its variants and its effects.

use crate::cli::format;
use phase::grid::{Axis, Variant};
use phase::plot::figures;
use phase::scene::{Scene, Start, Tank, UsualColumns};
use phase::sweep::{Sweep, differing_keys};
use serde_json::Value;

pub(super) fn line(name: &str, text: impl std::fmt::Display) -> String {
    format!("  {name:<11} {text}")
}

pub(super) fn describe_sweep(sweep: &Sweep, jobs: usize) -> String {
    let title = sweep.title.as_ref().or(sweep.scene.title.as_ref());
    let mut lines = describe_grid(title, &format::count(jobs, "job"), &sweep.axes);
    lines.extend(describe_variants(sweep));
    let seeds: Vec<String> = sweep.seeds.iter().map(u64::to_string).collect();
    let at_most = match sweep.refine {
        Some(_) => " at most",
        None => "",
    };
    lines.push(line("seeds", seeds.join(", ") + at_most));
    if let Some(settings) = &sweep.refine {
        let (round, budget) = (settings.round, settings.budget);
        let text = match budget > jobs {
            true => format!("{jobs} to start, then rounds of {round} up to {budget} in total"),
            false => format!(
                "{jobs} to start, which is the whole budget: increase `refine.budget` for rounds \
                 of {round}"
            ),
        };
        lines.push(line("refined", text));
    }
    let count = |scene: &Scene| scene.spheres.count.to_string();
    if sweep.scenes().into_iter().all(Scene::is_external) {
        return lines.join("\n");
    }
    lines.extend(of_scenes(sweep, "spheres", count));
    lines.extend(of_scenes(sweep, "effects", |scene| {
        effects(scene).join(", ")
    }));
    lines.extend(of_scenes(sweep, "duration", describe_time));
    lines.extend(describe_columns(sweep));
    lines.join("\n")
}

/// Which usual columns are recorded, if not all, and which figures that leaves out.
fn describe_columns(sweep: &Sweep) -> Vec<String> {
    let scenes = sweep.scenes();
    let outputs = scenes.iter().map(|scene| &scene.output);
    let chosen = outputs.clone().find_map(|output| match &output.usual {
        UsualColumns::Named(names) => Some(names.join(", ")),
        UsualColumns::Word(_) => None,
    });
    let Some(chosen) = chosen else {
        return Vec::new();
    };
    let family = sweep.family();
    let figures = figures().iter().filter(|figure| figure.applies_to(family));
    let missing = figures.filter(|figure| outputs.clone().any(|it| figure.lacks(it).is_some()));
    let missing: Vec<&str> = missing.map(|figure| figure.name).collect();
    let mut lines = vec![line(
        "columns",
        format_args!("of the usual ones only {chosen}"),
    )];
    if !missing.is_empty() {
        let text = format!("without the figures {}", missing.join(", "));
        lines.push(line("", text));
    }
    lines
}

/// A line about the scene, or a line for each variant where their scenes differ.
fn of_scenes(sweep: &Sweep, name: &str, describe: impl Fn(&Scene) -> String) -> Vec<String> {
    let mut told: Vec<(String, Vec<String>)> = Vec::new();
    let names = sweep.variants();
    for (index, scene) in sweep.scenes().into_iter().enumerate() {
        let (text, of_variant) = (describe(scene), names.get(index).cloned());
        match told.iter_mut().find(|(known, _)| *known == text) {
            Some((_, names)) => names.extend(of_variant),
            None => told.push((text, Vec::from_iter(of_variant))),
        }
    }
    let is_one = told.len() == 1;
    let lines = told.into_iter().map(|(text, names)| match is_one {
        true => line(name, text),
        false => line(name, format_args!("{text} ({})", names.join(", "))),
    });
    lines.collect()
}

/// The variants one by one: what each changes.
fn describe_variants(sweep: &Sweep) -> Vec<String> {
    let variants = sweep.axes.iter().flat_map(|axis| &axis.variants);
    let describe = |variant: &Variant| {
        let keys = differing_keys(&sweep.scene, &variant.scene).into_iter();
        let tree = serde_json::to_value(&variant.scene).unwrap_or_default();
        let change = |key: String| match tree.pointer(&format!("/{}", key.replace('.', "/"))) {
            None | Some(Value::Null) => format!("without {key}"),
            Some(Value::Object(_) | Value::Array(_)) => format!("another {key}"),
            Some(value) => format!("{key} = {value}"),
        };
        let scale = variant.scale.iter();
        let scaled = scale.map(|(axis, factor)| format!("{axis} times {factor}"));
        let changes: Vec<String> = keys.map(change).chain(scaled).collect();
        match changes[..] {
            [] => line("", format_args!("{}: the scene as it is", variant.name)),
            [..] => line("", format_args!("{}: {}", variant.name, changes.join(", "))),
        }
    };
    variants.map(describe).collect()
}

/// Title and number of what is run, and the axes.
pub(super) fn describe_grid(title: Option<&String>, runs: &str, axes: &[Axis]) -> Vec<String> {
    let mut lines = vec![match title {
        Some(title) => format!("{title}: {runs}"),
        None => runs.to_owned(),
    }];
    for axis in axes {
        if axis.is_of_variants() {
            let (number, all) = (axis.values.len(), axis.words().join(", "));
            let text = format!("{number}, no two of which share a run: {all}");
            lines.push(line(&axis.name, text));
            continue;
        }
        let ends = match axis.values.as_slice() {
            [first, .., last] => format!("{first} to {last}, {} values", axis.values.len()),
            values => format!("{values:?}"),
        };
        lines.push(line(&axis.name, format_args!("{ends} ({})", axis.key)));
    }
    lines
}

/// The effects that the scene names; no other costs anything.
pub(super) fn effects(scene: &Scene) -> Vec<String> {
    let tank = scene.tank.as_ref();
    let contact = scene.dem.contact.iter();
    let friction = scene.dem.friction.iter();
    let laws = contact
        .map(|contact| format!("contact ({})", contact.law()))
        .chain(friction.map(|friction| format!("friction ({})", friction.law())));
    let others = [
        (scene.dem.rolling.is_some(), "rolling resistance"),
        (scene.dem.effects.added_mass.is_some(), "added mass"),
        (tank.is_some_and(|tank| tank.radius.is_some()), "cylinder"),
        (tank.is_some_and(Tank::has_sides), "sides"),
        (tank.is_some_and(|tank| tank.floor.is_some()), "floor"),
        (!scene.dem.walls.is_empty(), "walls"),
        (scene.dem.geometry.is_some(), "fixed spheres"),
        (matches!(scene.start, Start::Feed { .. }), "feed"),
        (scene.spot.is_some(), "spots"),
        (scene.dem.door.is_some(), "door"),
        (scene.dem.outlet.is_some(), "outlet"),
    ];
    let others = others.iter().filter(|(used, _)| *used);
    let effects = scene.dem.effects.names().map(str::to_owned);
    let others = others.map(|(_, name)| (*name).to_owned());
    effects.chain(laws).chain(others).collect()
}

fn describe_time(scene: &Scene) -> String {
    let (steps, frames) = (scene.time.steps_per_frame(), scene.time.frames());
    let (duration, unit) = (scene.time.duration, scene.units().of_time());
    if scene.spot.is_some() {
        return format!("{duration} {unit} in {frames} frames");
    }
    let dt = scene.time.dt;
    format!("{duration} {unit} in {frames} frames of {steps} steps of {dt} {unit}")
}
