//! A backend that runs every job in a process of its own, and a sweep on it:
//!
//! ```text
//! cargo run --release --example processes -- sweeps/quick.toml /tmp/quick
//! ```
//!
//! The program `phase` is taken from the folder above that of the example.
#![allow(clippy::print_stdout, reason = "the example says what it did")]

use phase::record::RunRecord;
use phase::store;
use phase::sweep::{
    Backend, BackendError, Batch, Claim, Event, Folder, Job, Labelling, Plan, Pool, work,
};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

/// Time between two looks at a process.
const BETWEEN_LOOKS: Duration = Duration::from_millis(20);

/// Processes of `phase run`, so many at the same time.
struct Processes {
    program: PathBuf,
    count: usize,
    /// A folder for scenes and records under way.
    place: PathBuf,
}

impl Processes {
    /// Runs a job to its end. None if the batch was stopped meanwhile.
    fn run_job(&self, batch: &Batch<'_>, job: &Job) -> Result<Option<RunRecord>, Box<dyn Error>> {
        let file = |end: &str| self.place.join(format!("{}.{end}", job.id));
        let (scene, record) = (file("toml"), file("h5"));
        std::fs::write(&scene, toml::to_string(&job.scene())?)?;
        let mut child = Command::new(&self.program)
            .args([Path::new("run"), &scene, Path::new("--out"), &record])
            .args(["--quiet", "--threads", "1"])
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()?;
        while child.try_wait()?.is_none() {
            if batch.is_stopped() {
                child.kill()?;
                child.wait()?;
                return Ok(None);
            }
            thread::sleep(BETWEEN_LOOKS);
        }
        let output = child.wait_with_output()?;
        if !record.exists() {
            return Err(String::from_utf8_lossy(&output.stderr).into());
        }
        Ok(Some(store::read_record(&record)?))
    }
}

impl Backend for Processes {
    fn run(&self, batch: &Batch<'_>) -> Result<(), BackendError> {
        let done = work::each(self.count, batch.jobs(), |job| {
            let Claim::Granted(permit) = batch.claim(job) else {
                return;
            };
            batch.tell(Event::Started(job));
            match self.run_job(batch, job) {
                Ok(Some(record)) => permit.finish(&record),
                Ok(None) => {}
                Err(error) => permit.fail(error.to_string()),
            }
        });
        done.map_err(BackendError::new)
    }
}

/// The program beside the folder of the examples.
fn program() -> Result<PathBuf, Box<dyn Error>> {
    let example = std::env::current_exe()?;
    let folder = example.ancestors().nth(2).ok_or("no folder above")?;
    Ok(folder.join("phase"))
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().unwrap_or("sweeps/quick.toml".to_owned());
    let place = tempfile::tempdir()?;
    let out = arguments.next().map(PathBuf::from);
    let folder = Folder::new(out.unwrap_or_else(|| place.path().join("results")));
    let sweep = phase::sweep::load(Path::new(&file))?;
    folder.create()?;
    let processes = Processes {
        program: program()?,
        count: work::default_workers(),
        place: place.path().to_owned(),
    };
    let pool = Pool::new(&folder, &sweep, &processes);
    let plan = Plan::new(&folder, sweep.jobs()?, pool.workers)?;
    let report = pool.run(&plan)?;
    println!(
        "{} run in processes, {} failed",
        report.finished,
        report.failures.len()
    );
    for failure in &report.failures {
        println!("{}: {}", failure.id, failure.reason);
    }
    if let Some(error) = report.halted {
        return Err(error.into());
    }
    let labelling = Labelling::new(&folder, &sweep, &sweep.jobs()?, pool.workers)?;
    let labelled = labelling.write(&folder)?;
    println!("{} labelled", labelled.table.rows.len());
    Ok(())
}
