//! A run of another program as a simulation: it runs, then its rows are the frames.

use super::frames::TableFrames;
use super::process::ChildProcess;
use super::run_folder::RunFolder;
use super::states;
use crate::document::{lasting, shown};
use crate::scene::{ExternalProgram, FilledProgram, ProgramColumn, Scene};
use crate::simulation::{Column, Frame, FrameView, Instability, Simulation, Snapshot, StateError};
use std::fs::File;
use std::io;
use std::process::ExitStatus;
use std::time::{Duration, Instant};

/// Time between two looks at the size of a folder.
const WEIGHING: Duration = Duration::from_millis(250);

/// A run of another program.
pub(super) struct ExternalSimulation {
    program: ExternalProgram,
    filled: FilledProgram,
    identity: String,
    run_folder: RunFolder,
    /// Where what the programs say goes; none after a failure.
    output: Option<File>,
    columns: Vec<Column>,
    stage: RunStage,
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
enum RunStage {
    /// A command is to be started.
    Ready(Commands),
    /// A command runs.
    Running(Commands, ChildProcess, Instant),
    /// The frames are there, and the row is shown.
    Showing(TableFrames, usize),
    /// It cannot go on.
    Failed(String),
}

/// The commands of a run that are left.
struct Commands {
    all: Vec<Vec<String>>,
    /// The one that runs or is next.
    at: usize,
}

impl ExternalSimulation {
    /// A run at its start, or where an earlier one in this folder was stopped.
    pub(super) fn new(scene: &Scene, run_folder: RunFolder, may_go_on: bool) -> io::Result<Self> {
        let absent = || io::Error::other("the scene names no program");
        let program = scene.program.clone().ok_or_else(absent)?;
        let filled = scene.filled_program().ok_or_else(absent)?;
        let identity = scene.identity();
        let resumed = filled.resume.clone().filter(|_| may_go_on);
        let resumed = resumed.filter(|(file, _)| run_folder.goes_on_from(file, &identity));
        let (commands, output) = match resumed {
            Some((_, commands)) => (commands, run_folder.take_output()?),
            None => (
                filled.commands.clone(),
                run_folder.make(&identity, &filled.files)?,
            ),
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
            identity,
            output: Some(output),
            run_folder,
            stage: RunStage::Ready(Commands {
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
    fn start(&self, commands: Commands) -> Result<RunStage, String> {
        let Some(words) = commands.all.get(commands.at) else {
            return Ok(RunStage::Showing(self.read()?, 0));
        };
        let program = shown(words.first().map_or("", String::as_str));
        let refuse = |error: io::Error| match error.kind() {
            io::ErrorKind::NotFound => format!(
                "cannot start `{program}`: there is no such program, or no interpreter for it; {}",
                help_to_start(&program)
            ),
            _ => format!("cannot start `{program}`: {error}"),
        };
        let output = self.output.as_ref().ok_or("its folder is gone")?;
        let process = ChildProcess::start(words, self.run_folder.path(), output).map_err(refuse)?;
        Ok(RunStage::Running(commands, process, Instant::now()))
    }

    /// What follows after a look at a command that runs.
    fn watch(
        &mut self,
        mut commands: Commands,
        mut process: ChildProcess,
        weighed: Instant,
    ) -> Result<RunStage, String> {
        let words = shown(&commands.all[commands.at].join(" "));
        let status = process
            .look()
            .map_err(|error| format!("`{words}`: {error}"))?;
        if let Some(status) = status {
            self.spent += process.age();
            if !self.is_success(status) {
                return Err(format!("`{words}` failed ({})", describe(status)));
            }
            commands.at += 1;
            return Ok(RunStage::Ready(commands));
        }
        let limit = self.program.time_limit;
        if limit.is_some_and(|limit| (self.spent + process.age()).as_secs_f64() > limit) {
            let limit = limit.unwrap_or_default();
            self.spent += process.age();
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
        Ok(RunStage::Running(commands, process, weighed))
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

    fn read(&self) -> Result<TableFrames, String> {
        self.weigh()
            .map_err(|reason| format!("the program {reason}"))?;
        TableFrames::read(&self.program, &self.filled.tables, &self.run_folder)
    }

    /// Reads the states, if there are any.
    fn read_states(&mut self) -> Result<(), String> {
        let Some((file, radius)) = &self.filled.states else {
            return Ok(());
        };
        let (snapshots, count) =
            states::read(file, self.program.most_bytes as u64, &self.run_folder)?;
        self.radius = vec![*radius; count];
        self.mass = vec![f64::NAN; count];
        self.snapshots = Some(snapshots);
        Ok(())
    }

    /// What follows a failure: another attempt, or the end.
    fn fail(&mut self, reason: String) -> RunStage {
        self.failures += 1;
        self.seconds += self.spent.as_secs_f64();
        self.spent = Duration::ZERO;
        // Its lock goes with it.
        self.output = None;
        let mut told = reason;
        if self.failures <= self.program.retries {
            match self.run_folder.make(&self.identity, &self.filled.files) {
                Ok(output) => {
                    self.output = Some(output);
                    let all = self.filled.commands.clone();
                    return RunStage::Ready(Commands { all, at: 0 });
                }
                Err(error) => told += &format!("; it cannot be tried again: {error}"),
            }
        }
        if self.program.retries > 0 {
            told += &format!(", in {} of as many attempts", self.failures);
        }
        let lines = self.run_folder.last_lines();
        if !lines.is_empty() {
            told += &format!("; its last lines: {lines}");
        }
        self.run_folder.note_failure(&told);
        RunStage::Failed(told)
    }
}

/// What to do about a program that is not there.
fn help_to_start(program: &str) -> String {
    match program.split_whitespace().collect::<Vec<_>>() {
        words if words.len() > 1 => format!("split it into words: {words:?}"),
        _ => "install it, or write its full path".to_owned(),
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
        let stage = std::mem::replace(&mut self.stage, RunStage::Failed(String::new()));
        let next = match stage {
            RunStage::Ready(commands) => self.start(commands),
            RunStage::Running(commands, process, weighed) => self.watch(commands, process, weighed),
            RunStage::Showing(frames, row) => Ok(RunStage::Showing(frames, row + 1)),
            RunStage::Failed(reason) => Ok(RunStage::Failed(reason)),
        };
        let next = match next {
            Ok(RunStage::Showing(frames, 0)) => {
                self.run_folder.note_end();
                self.read_states().map(|()| RunStage::Showing(frames, 0))
            }
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
            RunStage::Showing(frames, row) => frames.time[*row],
            _ => 0.0,
        }
    }

    fn ended(&self) -> bool {
        match &self.stage {
            RunStage::Ready(_) | RunStage::Running(..) => false,
            RunStage::Showing(frames, row) => row + 1 >= frames.time.len(),
            RunStage::Failed(_) => true,
        }
    }

    fn has_frame(&self) -> bool {
        matches!(self.stage, RunStage::Showing(..))
    }

    fn frames(&self) -> Option<u64> {
        Some(u64::MAX)
    }

    fn failure(&self) -> Option<&str> {
        match &self.stage {
            RunStage::Failed(reason) => Some(reason),
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
            RunStage::Showing(frames, row) => frames.columns.iter().map(|it| it[*row]).collect(),
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
