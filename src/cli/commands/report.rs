//! `phase report`: a page about results, to look at and to send.

use crate::cli::compared::{self as inputs, Input};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders::{self, Entry};
use crate::cli::format;
use crate::cli::labels;
use crate::cli::runs::check_labels;
use phase::classify::LabelTable;
use phase::plot;
use phase::record::RunRecord;
use phase::report::{self, NamedRecord, PageDocument, RecordReader, Section, SweepResults};
use phase::store;
use phase::sweep::{Folder, Learnt, Selection, Sweep, parse_point, read_failures};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Make one page (HTML) about results, which needs no network: to look at, and to send.
///
/// Of a sweep it shows the diagram, and for each point the runs with their columns over time,
/// animations of some, the scene and the command that runs it again. Thresholds can be moved on the
/// page where what is stored decides. Of a study it shows what was found; of records the columns,
/// spheres and measures beside each other.
#[derive(clap::Args)]
#[command(after_help = "\
Example: a page with the animation of one run of each label
  phase report results/quick
Example: with the animation of the runs at one point
  phase report results/quick --point radius=0.003,omega=6 --out quick.html
Example: what accuracy costs
  phase report results/accuracy/cradle --out cradle.html
Example: two drainages beside each other
  phase report full.h5 coarse.h5 --label elements --label spots --out pair.html")]
pub(crate) struct Arguments {
    /// A results folder of a sweep or study, a folder that holds several, or one or more records
    /// (.h5), which one page shows beside each other.
    #[arg(required = true, value_name = "DIR|RECORD")]
    paths: Vec<PathBuf>,
    /// The page [default: report.html in the folder; of a record its name with .html].
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// A point whose runs are animated, such as `radius=0.003,omega=6`; may be given several times
    /// [default: one run of each label].
    #[arg(
        short,
        long = "point",
        value_name = "POINT",
        conflicts_with = "without_animations"
    )]
    points: Vec<String>,
    /// Leave out animations.
    #[arg(long)]
    without_animations: bool,
    /// Name of a record; once for each, in their order.
    #[arg(long = "label", value_name = "TEXT")]
    labels: Vec<String>,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    pages: Vec<Entry<PageEntry>>,
}

/// A page that was written.
#[derive(Serialize)]
struct PageEntry {
    page: String,
    bytes: usize,
    /// What of these the animations take.
    bytes_of_animations: usize,
    runs: usize,
    animated: usize,
}

/// How a page begins that this program has written.
const SIGNATURE: &[u8] = b"<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
    <meta http-equiv=\"Content-Security-Policy\"";

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    arguments.check()?;
    let pages = match &arguments.paths[..] {
        [dir] if !dir.is_file() => arguments.of_folders(dir, console)?,
        paths => vec![Entry::Done(arguments.of_records(paths, console)?)],
    };
    let exit = Entry::exit(&pages, |_| true);
    console.answer_with_files(&Answer { pages });
    Ok(exit)
}

/// What a page shows, and how much of it is animations.
struct Contents {
    title: String,
    sections: Vec<Section>,
    bytes_of_animations: usize,
    runs: usize,
    animated: usize,
}

impl Arguments {
    /// Refuses what does not go together.
    fn check(&self) -> Result<(), Failure> {
        let folder = self.paths.iter().find(|path| !path.is_file());
        if let Some(folder) = folder.filter(|_| self.paths.len() > 1) {
            let reason = match folder.exists() {
                true => "several paths must all be records (.h5)",
                false => "no such file; check the path",
            };
            return Err(Failure::refused(reason).at(folder));
        }
        if folder.is_none() && !self.points.is_empty() {
            return Err(Failure::refused(
                "--point is for a results folder; a record holds one run",
            ));
        }
        check_labels(&self.labels, self.paths.len(), folder.is_some())
    }

    /// Pages about the results folders at `dir`.
    fn of_folders(&self, dir: &Path, console: &Console) -> Result<Vec<Entry<PageEntry>>, Failure> {
        if let Some(sections) = report::study(dir)? {
            let contents = Contents {
                title: title_of_study(dir),
                sections,
                bytes_of_animations: 0,
                runs: 0,
                animated: 0,
            };
            return Ok(vec![Entry::Done(self.write(
                contents,
                &[dir.to_owned()],
                console,
            )?)]);
        }
        let found = Folder::find(dir)?;
        if let (Some(out), [_, _, ..]) = (&self.out, &found[..]) {
            return Err(Failure::refused(format_args!(
                "--out {}: {} holds several results folders, and each has a page of its own",
                out.display(),
                dir.display()
            )));
        }
        folders::go_through(dir, found, console, |folder| {
            let root = folder.root().to_owned();
            let contents = match report::study(&root)? {
                Some(sections) => Contents {
                    title: title_of_study(&root),
                    sections,
                    bytes_of_animations: 0,
                    runs: 0,
                    animated: 0,
                },
                None => self.of_sweep(folder)?,
            };
            Ok(self.write(contents, &[root], console)?)
        })
    }

    fn of_sweep(&self, folder: &Folder) -> Result<Contents, Failure> {
        let sweep = folder.read_sweep()?;
        if sweep.axes.is_empty() {
            return Err(Failure::refused(format_args!(
                "a sweep without axes has no diagram; give its records, {}/*.h5",
                folder.records().display()
            ))
            .at(folder.root()));
        }
        let table = labels::read(folder)?.with_variants(sweep.variants());
        let refining = folder.read_refining(&sweep)?;
        let learnt = Learnt::of(&sweep, refining.as_ref(), &table).map_err(Failure::failed)?;
        // A table that cannot be read tells of no failure; `phase status` refuses it.
        let failures = read_failures(&sweep.axes, &folder.failures()).unwrap_or_default();
        let reader = |id: &str| folder.read_record(id);
        let has_records = !folder.recorded()?.is_empty();
        let animated = self.animated(&sweep, &table)?;
        let section = report::sweep(&SweepResults {
            sweep: &sweep,
            table: &table,
            learnt: learnt.as_ref(),
            failures: &failures,
            record: has_records.then_some(&reader as &RecordReader<'_>),
            animated: &animated,
            folder: format::shell_word(&folder.root().display().to_string()),
        })
        .map_err(|error| Failure::from(error).at(folder.labels()))?;
        Ok(Contents {
            title: section.title().to_owned(),
            bytes_of_animations: section.bytes_of_animations(),
            runs: table.rows.len(),
            animated: section.animations(),
            sections: vec![Section::Sweep(Box::new(section))],
        })
    }

    /// The rows of the runs that are animated.
    fn animated(&self, sweep: &Sweep, table: &LabelTable) -> Result<Vec<usize>, Failure> {
        if self.without_animations {
            return Ok(Vec::new());
        }
        if self.points.is_empty() {
            return Ok(report::one_of_each_label(table));
        }
        let points = self.points.iter().map(|text| parse_point(text));
        let points: Vec<Selection> = points.collect::<Result<_, _>>()?;
        let mut chosen = Vec::new();
        for point in &points {
            let selected = sweep.select(point)?;
            let jobs = selected.jobs()?;
            let ids: Vec<&str> = jobs.iter().map(|job| job.id.as_str()).collect();
            let rows = table.rows.iter().enumerate();
            let own = rows.filter(|(_, row)| ids.contains(&row.id.as_str()));
            chosen.extend(own.map(|(place, _)| place));
        }
        chosen.sort_unstable();
        chosen.dedup();
        Ok(chosen)
    }

    /// A page about records.
    fn of_records(&self, paths: &[PathBuf], console: &Console) -> Result<PageEntry, Failure> {
        let inputs = inputs::read(paths, None)?;
        let units = inputs::units(&inputs)?;
        let records = inputs.iter().filter_map(|input| match input {
            Input::Run(path, record) => Some((path, &**record)),
            Input::Table(_) => None,
        });
        let records: Vec<(&PathBuf, &RunRecord)> = records.collect();
        // A run that nothing is measured of is shown all the same.
        let columns = inputs::columns(&inputs, None).unwrap_or_default();
        let rows = inputs::rows(&columns);
        let all: Vec<&RunRecord> = records.iter().map(|(_, record)| *record).collect();
        let captions = plot::captions(&all);
        let named = records.iter().enumerate().map(|(place, (path, record))| {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            let own = captions[place].join(", ");
            let own = match own.is_empty() {
                true => stem.into_owned(),
                false => own,
            };
            NamedRecord {
                name: self.labels.get(place).cloned().unwrap_or(own),
                record,
            }
        });
        let named: Vec<NamedRecord<'_>> = named.collect();
        let section = report::records(&named, &rows, units, !self.without_animations);
        let title = match &records[..] {
            [(path, record)] => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                record.scene.title.clone().unwrap_or(stem.into_owned())
            }
            _ => "Runs beside each other".to_owned(),
        };
        let contents = Contents {
            title,
            bytes_of_animations: section.bytes_of_animations(),
            runs: records.len(),
            animated: section.animations(),
            sections: vec![Section::Records(section)],
        };
        self.write(contents, paths, console)
    }

    /// Writes a page about what is at these paths.
    fn write(
        &self,
        contents: Contents,
        paths: &[PathBuf],
        console: &Console,
    ) -> Result<PageEntry, Failure> {
        let default = match paths {
            [dir] if dir.is_dir() => dir.join("report.html"),
            [record] => record.with_extension("html"),
            _ => PathBuf::from("report.html"),
        };
        let path = self.out.clone().unwrap_or(default);
        folders::refuse_to_replace(&path, "a page of `phase report`", SIGNATURE)?;
        let word = |path: &PathBuf| format::shell_word(&path.display().to_string());
        let names: Vec<String> = paths.iter().map(word).collect();
        let labels = self
            .labels
            .iter()
            .map(|label| format!(" --label {}", format::shell_word(label)));
        let line = format!(
            "phase report {}{}",
            names.join(" "),
            labels.collect::<String>()
        );
        let commands = vec![("Make this page again".to_owned(), line)];
        let document = PageDocument::new(contents.title, commands, contents.sections);
        let text = report::html(&document).map_err(Failure::failed)?;
        folders::make_for(&path)?;
        store::write_atomic(&path, text.as_bytes())?;
        let page = PageEntry {
            page: path.display().to_string(),
            bytes: text.len(),
            bytes_of_animations: contents.bytes_of_animations,
            runs: contents.runs,
            animated: contents.animated,
        };
        console.result(page.describe());
        console.file(&path);
        Ok(page)
    }
}

/// The title of a page about a study.
fn title_of_study(dir: &Path) -> String {
    let name = dir.file_name().unwrap_or_default().to_string_lossy();
    let parent = dir.parent().and_then(Path::file_name).unwrap_or_default();
    match parent.to_string_lossy() {
        parent if parent.is_empty() => name.into_owned(),
        parent => format!("{parent}: {name}"),
    }
}

impl PageEntry {
    fn describe(&self) -> String {
        let kilobytes = |bytes: usize| format!("{:.0} kB", bytes as f64 / 1e3);
        let mut text = format!("a page of {}", kilobytes(self.bytes));
        if self.runs > 0 {
            text += &format!(" about {}", format::count(self.runs, "run"));
        }
        if self.animated > 0 {
            let added = kilobytes(self.bytes_of_animations);
            text += &format!("; {added} of it animate {} of them", self.animated);
        }
        text
    }
}
