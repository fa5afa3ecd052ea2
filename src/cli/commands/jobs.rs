//! `phase jobs`: the jobs of a sweep as lines, for programs that hand them out.

use crate::cli::cluster::{self, Handed};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::Workers;
use crate::cli::values;
use phase::sweep::Shard;
use serde::Serialize;
use std::path::PathBuf;
use std::time::Duration;

/// List the jobs of a sweep or study, a line each, for programs that hand them out.
///
/// `phase sweep FILE --job LINE`, or `phase study`, runs what a line lists. Of a refined sweep
/// these are the jobs of the next round.
#[derive(clap::Args)]
#[command(after_help = "\
Examples: in chunks of 20 minutes through HyperQueue, or one by one through GNU parallel
  phase jobs sweeps/steel.toml --missing --chunk 20m > todo
  hq submit --each-line todo bash -c 'phase sweep sweeps/steel.toml -j 1 --job $HQ_ENTRY'
  phase jobs sweeps/quick.toml | parallel phase sweep sweeps/quick.toml -j 1 --job {}")]
pub(crate) struct Arguments {
    /// The sweep or study file (TOML).
    file: PathBuf,
    /// The results folder [default: that of `phase sweep` or `phase study`].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Only jobs that have no good record in the results folder.
    #[arg(long)]
    missing: bool,
    /// Put as many jobs into a line as a core runs in this time, such as 90s, 20m or 2h, by a short
    /// trial on this machine.
    #[arg(long, value_name = "TIME", value_parser = values::time)]
    chunk: Option<Duration>,
    #[command(flatten)]
    workers: Workers,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let workers = arguments.workers.count();
    let handed = Handed::load(&arguments.file, arguments.out.as_ref(), workers)?;
    let next = handed.next;
    let places = match arguments.missing {
        true => next.missing.clone(),
        false => (0..next.jobs.len()).collect(),
    };
    let shards = match arguments.chunk {
        None => next.shards(&places, 0.0, Duration::ZERO),
        Some(_) if places.is_empty() => Vec::new(),
        Some(time) => next.shards(
            &places,
            cluster::forecast(&next, &places, &handed.folder)?.rate,
            time,
        ),
    };
    let lines: Vec<String> = shards.iter().map(Shard::to_string).collect();
    for line in &lines {
        console.result(line);
    }
    console.answer(&Answer {
        jobs: places.len(),
        lines,
    });
    Ok(Exit::Done)
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    /// Number of jobs that the lines list.
    jobs: usize,
    lines: Vec<String>,
}
