//! `phase export`: writes the spheres of records for other programs, browsers among them.

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders::ANOTHER_FOLDER;
use crate::cli::{folders, format, runs, values};
use phase::observe::Snapshot;
use phase::record::{RunRecord, States};
use phase::store::{self, DumpName, StoreError};
use serde::Serialize;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Write the spheres of records for other programs.
///
/// Writes every frame of the trajectory if the record has one, otherwise its snapshots, and says
/// which. `phase run --trajectory` makes a record with every frame.
#[derive(clap::Args)]
#[command(after_help = "\
Formats:
  xyz   NAME.xyz, extended XYZ for OVITO and ASE: radius, mass, velocity (velo), spin (omega)
  vtk   NAME.pvd and NAME/frame_*.vtp for ParaView: points with radius, mass, velocity, spin
  npy   NAME/*.npy for NumPy: time, position, velocity, spin, radius, mass
  csv   NAME.csv, one row per state and sphere; NAME-observations.csv, one row per frame
  svg   NAME/frame_*.svg, a picture per state for browsers and documents: walls red, door green,
        grains blue, to scale; a tank is seen from the side
  page  NAME.html, one page that plays the run in a browser, without any other file
  dump  dump_r..._p..._f....npy, the thesis's own: frames x spheres x 4 of x, y, z (m) and
        energy (J); the name says radius, density and Omega, the seed unless it is 1, and the
        name of the record where several would have one name

If spheres enter or leave, xyz, vtk and csv hold the spheres inside, by their id, and npy holds NaN
for the others. Fixed spheres go to NAME-fixed.xyz, NAME-fixed.csv, walls.npy and door.npy, and
to further parts of a ParaView series.

Example: one frame in ten for ParaView
  phase export spout.h5 --to vtk --every 10

Example: a silo as pictures for every second, and as a page that plays it
  phase export silo.h5 --to svg
  phase run sweeps/scenes/silo.toml --snapshot-interval 0.1 --out silo.h5
  phase export silo.h5 --to page

Example: dumps of a whole sweep that was run with output.trajectory
  phase export results/tank/records/*.h5 --to dump --out dumps")]
pub(crate) struct Arguments {
    /// The records (HDF5).
    #[arg(required = true, value_name = "RECORD")]
    records: Vec<PathBuf>,
    /// The format to write.
    #[arg(long, value_name = "FORMAT")]
    to: Format,
    /// The folder to write to; for a single record also a .xyz, .pvd, .csv, .html or .npy file
    /// [default: the record's folder].
    #[arg(short, long, value_name = "PATH")]
    out: Option<PathBuf>,
    /// Write one state in N, starting with the first.
    #[arg(long, value_name = "N", value_parser = values::at_least_one)]
    every: Option<usize>,
}

/// A format to write.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// Extended XYZ.
    Xyz,
    /// VTP files and a PVD series.
    Vtk,
    /// NumPy arrays.
    Npy,
    /// Tables of spheres and of observables.
    Csv,
    /// Pictures, one per state.
    Svg,
    /// A page that plays the run.
    Page,
    /// The thesis's own dump.
    Dump,
}

impl Format {
    /// The kind of the main file, and its first bytes, if they are always the same.
    fn signature(self) -> (&'static str, &'static [u8]) {
        match self {
            Self::Xyz | Self::Npy | Self::Svg => ("", b""),
            Self::Page => ("a page of a run", store::PAGE_SIGNATURE),
            Self::Vtk => (
                "a ParaView series of this command",
                store::VTK_SIGNATURE.as_bytes(),
            ),
            Self::Csv => ("a table of spheres", store::SPHERES_SIGNATURE),
            Self::Dump => ("a dump", b"\x93NUMPY"),
        }
    }

    /// Refuses to replace what is no export of this format.
    fn check(self, target: &Path) -> Result<(), Failure> {
        let (kind, signature) = self.signature();
        if target.exists() && !signature.is_empty() {
            folders::refuse_to_replace(target, kind, signature)?;
        }
        let names = ["observations", "fixed"];
        let files = match self {
            Self::Xyz => vec![target.to_owned(), self.beside(target, "fixed")],
            Self::Csv => names.map(|name| self.beside(target, name)).to_vec(),
            _ => Vec::new(),
        };
        folders::refuse_foreign(Path::new(""), files, ANOTHER_FOLDER)?;
        match self {
            Self::Npy => refuse_foreign_arrays(target),
            _ => Ok(()),
        }
    }

    /// A file next to the states' file, with this at the end of its name.
    fn beside(self, target: &Path, name: &str) -> PathBuf {
        let mut stem = target.file_stem().unwrap_or_default().to_owned();
        stem.push(format!("-{name}.{}", self.extension()));
        target.with_file_name(stem)
    }

    /// Extension of the file that stands for the whole.
    fn extension(self) -> &'static str {
        match self {
            Self::Xyz => "xyz",
            Self::Vtk => "pvd",
            Self::Csv => "csv",
            Self::Page => "html",
            Self::Npy | Self::Svg => "",
            Self::Dump => "npy",
        }
    }
}

/// Refuses to replace arrays in a folder that holds some of the arrays of a run and not all: an
/// array does not say what wrote it.
fn refuse_foreign_arrays(folder: &Path) -> Result<(), Failure> {
    let is_there = |name: &&str| folder.join(name).exists();
    match store::ARRAYS.into_iter().find(is_there) {
        Some(name) if !store::ARRAYS.iter().all(is_there) => Err(Failure::refused(format_args!(
            "{}: this array is not part of an export, and would be overwritten; {ANOTHER_FOLDER}, \
             or move it away",
            folder.join(name).display()
        ))),
        _ => Ok(()),
    }
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    if arguments.to == Format::Dump && arguments.every.is_some() {
        return Err(Failure::refused(
            "a dump holds every frame, because the sieves need them; drop --every",
        ));
    }
    let mut failed = Vec::new();
    for (path, target) in arguments.records.iter().zip(targets(arguments)?) {
        let exported = target.and_then(|target| export(path, &target, arguments, console));
        match exported {
            Ok(()) => {}
            // One record that cannot be exported does not stop the others.
            Err(failure) if arguments.records.len() > 1 => {
                console.error(&failure.message);
                failed.push(FailedRecord {
                    record: path.display().to_string(),
                    reason: failure.message,
                });
            }
            Err(failure) => return Err(failure),
        }
    }
    let exit = match failed.is_empty() {
        true => Exit::Done,
        false => Exit::Failed,
    };
    console.answer_with_files(&Answer { failed });
    Ok(exit)
}

/// The `--json` result.
#[derive(Serialize)]
struct Answer {
    /// The records that could not be exported.
    failed: Vec<FailedRecord>,
}

/// A record that could not be exported, and why.
#[derive(Serialize)]
struct FailedRecord {
    record: String,
    reason: String,
}

/// Where each record goes, or why it goes nowhere. Records that would go to one place are refused,
/// but for dumps, whose names then say the names of the records too.
fn targets(arguments: &Arguments) -> Result<Vec<Result<PathBuf, Failure>>, Failure> {
    let extension = arguments.to.extension();
    if let Some(out) = arguments.out.as_ref().filter(|out| !out.is_dir())
        && out.extension().is_some_and(|it| it != extension)
    {
        return Err(Failure::refused(format_args!(
            "give a folder, or for a single record a file that ends in .{extension}"
        ))
        .at(out));
    }
    let of_record = |path: &PathBuf| target(arguments, path);
    let mut targets: Vec<Result<ExportTarget, Failure>> =
        arguments.records.iter().map(of_record).collect();
    tell_apart(&arguments.records, &mut targets);
    let mut written: HashMap<PathBuf, &Path> = HashMap::new();
    for (path, target) in arguments.records.iter().zip(&targets) {
        if let Ok(ExportTarget { path: target, .. }) = target
            && let Some(other) = written.insert(target.clone(), path)
        {
            return Err(Failure::refused(format_args!(
                "{} and {} would both be written to {}; export them one by one with different \
                 --out",
                other.display(),
                path.display(),
                target.display()
            )));
        }
    }
    let checked = targets.into_iter().map(|target| {
        let ExportTarget { path, .. } = target?;
        arguments.to.check(&path).map(|()| path)
    });
    Ok(checked.collect())
}

/// Where a record goes.
struct ExportTarget {
    /// The main file of its export, or the folder of its arrays.
    path: PathBuf,
    /// The name of a dump that says what the record holds.
    name: Option<DumpName>,
}

/// Adds the names of records to dumps of one name: runs that differ in other keys than those that
/// the name of a dump says, such as runs of variants.
fn tell_apart(records: &[PathBuf], targets: &mut [Result<ExportTarget, Failure>]) {
    let mut times: HashMap<PathBuf, usize> = HashMap::new();
    for target in targets.iter().flatten() {
        *times.entry(target.path.clone()).or_default() += 1;
    }
    for (record, target) in records.iter().zip(targets) {
        if let Ok(ExportTarget {
            path,
            name: Some(name),
        }) = target
            && times[path] > 1
            && let Some(run) = record.file_stem()
        {
            name.run = Some(run.to_string_lossy().into_owned());
            path.set_file_name(name.to_string());
        }
    }
}

fn target(arguments: &Arguments, record_path: &Path) -> Result<ExportTarget, Failure> {
    // Refuse what is no record before anything is written.
    store::read_record_header(record_path)?;
    let extension = arguments.to.extension();
    let beside = record_path.parent().unwrap_or(Path::new(""));
    let folder = match &arguments.out {
        Some(out)
            if arguments.records.len() == 1
                && !extension.is_empty()
                && out.extension().is_some_and(|it| it == extension) =>
        {
            return Ok(ExportTarget {
                path: out.clone(),
                name: None,
            });
        }
        Some(folder) => folder.as_path(),
        None => beside,
    };
    let stem = record_path.file_stem().unwrap_or("record".as_ref());
    let name = match arguments.to {
        Format::Dump => {
            let record = store::read_record(record_path)?;
            runs::refuse_without_spheres(&record, record_path)?;
            Some(DumpName::of_record(&record))
        }
        _ => None,
    };
    let path = match (arguments.to, &name) {
        (_, Some(name)) => folder.join(name.to_string()),
        (Format::Npy | Format::Svg, None) => folder.join(stem),
        (_, None) => folder.join(stem).with_added_extension(extension),
    };
    Ok(ExportTarget { path, name })
}

fn export(
    path: &Path,
    target: &Path,
    arguments: &Arguments,
    console: &Console,
) -> Result<(), Failure> {
    let record = store::read_record(path).map_err(Failure::failed)?;
    let record = &match arguments.to {
        Format::Xyz | Format::Vtk | Format::Svg | Format::Page => record.wrapped(),
        // Numbers to compute with: paths go on across periodic sides.
        Format::Npy | Format::Csv | Format::Dump => record,
    };
    // Without spheres there still is a table of observables.
    if arguments.to != Format::Csv {
        runs::refuse_without_spheres(record, path)?;
    }
    let states = record.states();
    let every = arguments.every.unwrap_or(1);
    let all = match arguments.to {
        // Pictures have no place for numbers that mean nothing.
        Format::Svg | Format::Page => record.sound_states(),
        _ => states.all(),
    };
    let chosen: Vec<&Snapshot> = all.iter().step_by(every).collect();
    if chosen.is_empty() {
        return Err(Failure::failed(
            "the record holds no states of the spheres; run it again with --snapshot-interval",
        )
        .at(path));
    }
    console.note(format_args!(
        "{}: {states}: {}",
        path.display(),
        format::count(chosen.len(), "state")
    ));
    if arguments.to == Format::Dump && record.scene.has_flow() {
        return Err(Failure::refused(
            "the thesis's dump cannot represent spheres that enter or leave; use --to npy, which \
             has the same numbers",
        )
        .at(path));
    }
    if arguments.to == Format::Dump && matches!(states, States::Snapshots(_)) {
        console.note(
            "a dump of snapshots cannot be classified, which needs every frame: run it again with \
             `phase run --trajectory`",
        );
    }
    if arguments.to == Format::Dump && record.radius.iter().any(|it| *it != record.radius[0]) {
        console.note(
            "the name of a dump holds one radius, here the mean: `phase classify --scene` needs a \
             scene that lists the radius of each sphere",
        );
    }
    folders::make_for(target)?;
    for path in write(record, &chosen, target, arguments.to)? {
        console.file(&path);
    }
    Ok(())
}

/// Writes states of a record; returns the files, or the folder that holds them.
fn write(
    record: &RunRecord,
    states: &[&Snapshot],
    target: &Path,
    format: Format,
) -> Result<Vec<PathBuf>, Failure> {
    match format {
        Format::Xyz => store::write_xyz(record, states, target),
        Format::Vtk => {
            let names = store::vtk_names(states.len());
            folders::refuse_foreign(&target.with_extension(""), names, ANOTHER_FOLDER)?;
            store::write_vtk(record, states, target)
        }
        Format::Npy => store::write_arrays(record, states, target),
        Format::Csv => store::write_spheres(record, states, target),
        Format::Svg => {
            folders::refuse_other_frames(target, states.len(), "svg")?;
            store::write_svg(record, states, target)
        }
        Format::Page => store::write_page(record, states, target),
        Format::Dump => store::write_dump(record, states, target),
    }?;
    let mut written = vec![target.to_owned()];
    for (name, write) in more(record, format) {
        let path = format.beside(target, name);
        write(record, &path)?;
        written.push(path);
    }
    Ok(written)
}

/// Writes a file about a record.
type Write = fn(&RunRecord, &Path) -> Result<(), StoreError>;

/// Further files next to the states' file: the ends of their names, and what writes them.
fn more(record: &RunRecord, format: Format) -> Vec<(&'static str, Write)> {
    let fixed: Option<Write> = match format {
        Format::Xyz => Some(store::write_fixed_xyz),
        Format::Csv => Some(store::write_fixed),
        _ => None,
    };
    let observations: Option<Write> = match format {
        Format::Csv => Some(store::write_observations),
        _ => None,
    };
    let fixed = fixed.filter(|_| record.scene.dem.geometry.is_some());
    let named = [("observations", observations), ("fixed", fixed)];
    let present = named.into_iter();
    present
        .filter_map(|(name, write)| Some((name, write?)))
        .collect()
}
