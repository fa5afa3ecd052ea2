//! A run of another program as a simulation: it runs, then its rows are the frames.

use super::frames::Frames;
use super::process::Process;
use super::run_folder::RunFolder;
use super::states;
use crate::document::lasting;
use crate::scene::{ExternalProgram, FilledProgram, ProgramColumn};
use crate::simulation::{Column, Frame, FrameView, Instability, Simulation, Snapshot, StateError};
use std::fs::File;
use std::io;
use std::process::ExitStatus;
use std::time::{Duration, Instant};

/// Time between two looks at the size of a folder.
const WEIGHING: Duration = Duration::from_secs(1);

/// A run of another program.
pub(super) struct ExternalSimulation {
    program: ExternalProgram,
    filled: FilledProgram,
    run_folder: RunFolder,
    columns: Vec<Column>,
    stage: Stage,
    /// How often it has failed.
    failures: u32,
    /// Time that ended commands of this attempt took.
    spent: Duration,
    /// Time of all attempts (s).
    seconds: f64,
    radius: Vec<f64>,
    mass: Vec<f64>,
    snapshots: Option<Vec<Snapshot>>,
}

/// How far a run is.
enum Stage {
    /// A command is to be started.
    Ready(Commands),
    /// A command runs.
    Running(Commands, Process, Instant),
    /// The frames are there, and the row is shown.
    Showing(Frames, usize),
    /// It cannot go on.
    Failed(String),
}

/// The commands of a run that are left.
#[derive(Clone)]
struct Commands {
    all: Vec<Vec<String>>,
    /// The one that runs or is next.
    at: usize,
}

impl ExternalSimulation {
    /// A run at its start, or where an earlier one in this folder was stopped.
    pub(super) fn new(
        program: ExternalProgram,
        filled: FilledProgram,
        run_folder: RunFolder,
    ) -> io::Result<Self> {
        let resumed = filled.resume.clone();
        let resumed = resumed.filter(|(file, _)| run_folder.goes_on_from(file));
        let commands = match resumed {
            Some((_, commands)) => commands,
            None => {
                run_folder.make(&filled.files)?;
                filled.commands.clone()
            }
        };
        let column = |column: &ProgramColumn| Column {
            name: lasting(column.name()),
            unit: lasting(column.unit()),
            description: lasting(column.description()),
        };
        Ok(Self {
            columns: program.columns().map(column).collect(),
            program,
            filled,
            run_folder,
            stage: Stage::Ready(Commands {
                all: commands,
                at: 0,
            }),
            failures: 0,
            spent: Duration::ZERO,
            seconds: 0.0,
            radius: Vec::new(),
            mass: Vec::new(),
            snapshots: None,
        })
    }

    /// What follows a command that can be started.
    fn start(&self, commands: Commands) -> Result<Stage, String> {
        let Some(words) = commands.all.get(commands.at) else {
            return Ok(Stage::Showing(self.read()?, 0));
        };
        let program = words.first().map_or("", String::as_str);
        let refuse = |error: io::Error| match error.kind() {
            io::ErrorKind::NotFound => {
                format!(
                    "cannot start `{program}`: there is no such program; install it, or write \
                         its full path"
                )
            }
            _ => format!("cannot start `{program}`: {error}"),
        };
        let output: File = self.run_folder.open_output().map_err(refuse)?;
        let process = Process::start(words, self.run_folder.path(), &output).map_err(refuse)?;
        Ok(Stage::Running(commands, process, Instant::now()))
    }

    /// What follows after a look at a command that runs.
    fn watch(
        &mut self,
        mut commands: Commands,
        mut process: Process,
        weighed: Instant,
    ) -> Result<Stage, String> {
        let words = commands.all[commands.at].join(" ");
        let status = process
            .look()
            .map_err(|error| format!("`{words}`: {error}"))?;
        if let Some(status) = status {
            self.spent += process.age();
            if !self.is_success(status) {
                return Err(format!("`{words}` failed ({})", describe(status)));
            }
            commands.at += 1;
            return Ok(Stage::Ready(commands));
        }
        let limit = self.program.time_limit;
        if limit.is_some_and(|limit| (self.spent + process.age()).as_secs_f64() > limit) {
            let limit = limit.unwrap_or_default();
            return Err(format!(
                "`{words}` took longer than `program.time_limit` = {limit} s and was ended"
            ));
        }
        let mut weighed = weighed;
        if weighed.elapsed() >= WEIGHING {
            weighed = Instant::now();
            self.weigh()
                .map_err(|reason| format!("`{words}` {reason} and was ended"))?;
        }
        Ok(Stage::Running(commands, process, weighed))
    }

    /// Refuses a folder that has become too large.
    fn weigh(&self) -> Result<(), String> {
        let most = self.program.most_bytes;
        match self.run_folder.size() as f64 > most {
            true => Err(format!(
                "left more than `program.most_bytes` = {most} bytes"
            )),
            false => Ok(()),
        }
    }

    fn is_success(&self, status: ExitStatus) -> bool {
        let codes = &self.program.exit_codes;
        status.code().is_some_and(|code| codes.contains(&code))
    }

    fn read(&self) -> Result<Frames, String> {
        self.weigh()
            .map_err(|reason| format!("the program {reason}"))?;
        Frames::read(&self.program, &self.filled.tables, &self.run_folder)
    }

    /// Reads the states, if there are any.
    fn read_states(&mut self) -> Result<(), String> {
        let Some((file, radius)) = &self.filled.states else {
            return Ok(());
        };
        let (snapshots, count) = states::read(file, &self.run_folder)?;
        self.radius = vec![*radius; count];
        self.mass = vec![f64::NAN; count];
        self.snapshots = Some(snapshots);
        Ok(())
    }

    /// What follows a failure: another attempt, or the end.
    fn fail(&mut self, reason: String) -> Stage {
        self.failures += 1;
        self.seconds += self.spent.as_secs_f64();
        self.spent = Duration::ZERO;
        let again = self.failures <= self.program.retries;
        if again && self.run_folder.make(&self.filled.files).is_ok() {
            let all = self.filled.commands.clone();
            return Stage::Ready(Commands { all, at: 0 });
        }
        let mut told = reason;
        if self.program.retries > 0 {
            told += &format!(", in {} of as many attempts", self.failures);
        }
        let lines = self.run_folder.last_lines();
        if !lines.is_empty() {
            told += &format!("; its last lines: {lines}");
        }
        self.run_folder.note_failure(&told);
        Stage::Failed(told)
    }
}

/// How a program ended, in words.
fn describe(status: ExitStatus) -> String {
    match status.code() {
        Some(code) => format!("exit code {code}"),
        // A signal.
        None => status.to_string(),
    }
}

impl Simulation for ExternalSimulation {
    fn advance_frame(&mut self) -> Result<(), Instability> {
        let stage = std::mem::replace(&mut self.stage, Stage::Failed(String::new()));
        let next = match stage {
            Stage::Ready(commands) => self.start(commands),
            Stage::Running(commands, process, weighed) => self.watch(commands, process, weighed),
            Stage::Showing(frames, row) => Ok(Stage::Showing(frames, row + 1)),
            Stage::Failed(reason) => Ok(Stage::Failed(reason)),
        };
        let next = match next {
            Ok(Stage::Showing(frames, 0)) => self.read_states().map(|()| Stage::Showing(frames, 0)),
            next => next,
        };
        self.stage = match next {
            Ok(next) => next,
            Err(reason) => self.fail(reason),
        };
        Ok(())
    }

    fn time(&self) -> f64 {
        match &self.stage {
            Stage::Showing(frames, row) => frames.time[*row],
            _ => 0.0,
        }
    }

    fn ended(&self) -> bool {
        match &self.stage {
            Stage::Ready(_) | Stage::Running(..) => false,
            Stage::Showing(frames, row) => row + 1 >= frames.time.len(),
            Stage::Failed(_) => true,
        }
    }

    fn has_frame(&self) -> bool {
        matches!(self.stage, Stage::Showing(..))
    }

    fn frames(&self) -> Option<u64> {
        Some(u64::MAX)
    }

    fn failure(&self) -> Option<&str> {
        match &self.stage {
            Stage::Failed(reason) => Some(reason),
            _ => None,
        }
    }

    /// What the program leaves itself is all there is to go on from.
    fn can_be_saved(&self) -> bool {
        false
    }

    fn work(&self) -> u64 {
        u64::from(self.ended())
    }

    fn radius(&self) -> &[f64] {
        &self.radius
    }

    fn mass(&self) -> &[f64] {
        &self.mass
    }

    fn look(&mut self, look: &mut dyn FnMut(&dyn Frame)) {
        look(&FrameView {
            position: [&[]; 3],
            velocity: [&[]; 3],
            spin: None,
            radius: &[],
            mass: &[],
            inertia: &[],
            elastic_energy: 0.0,
            ledger: None,
            number: None,
            flow: None,
        });
    }

    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn values(&mut self) -> Vec<f64> {
        match &self.stage {
            Stage::Showing(frames, row) => frames.columns.iter().map(|it| it[*row]).collect(),
            _ => Vec::new(),
        }
    }

    fn save(&self, _to: &mut dyn io::Write) -> io::Result<()> {
        Err(io::Error::other(
            "the state of another program cannot be saved",
        ))
    }

    fn restore(&mut self, _state: &[u8]) -> Result<(), StateError> {
        Err(StateError("the state of another program cannot be saved"))
    }

    /// The time of the program: how much of it was processor time is not known.
    fn seconds_of_threads(&self) -> f64 {
        self.seconds + self.spent.as_secs_f64()
    }

    fn take_snapshots(&mut self) -> Option<Vec<Snapshot>> {
        self.snapshots.take()
    }
}
