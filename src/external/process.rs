//! A process of another program.

use std::fs::File;
use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// How long a program that is asked to end may take before it is killed.
const GRACE: Duration = Duration::from_secs(5);

/// How long a look at a process waits at most.
const LOOK: Duration = Duration::from_millis(20);

/// A process that is ended, with all that it started, when this is dropped.
pub(super) struct Process {
    child: Child,
    started: Instant,
    has_ended: bool,
}

impl Process {
    /// Starts a program with its words in a folder. What it says goes to `output`.
    pub(super) fn start(words: &[String], folder: &Path, output: &File) -> io::Result<Self> {
        let (program, words) = words.split_first().ok_or(io::ErrorKind::InvalidInput)?;
        let mut command = Command::new(program);
        command
            .args(words)
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(output.try_clone()?)
            .stderr(output.try_clone()?);
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        Ok(Self {
            child: command.spawn()?,
            started: Instant::now(),
            has_ended: false,
        })
    }

    /// Waits a moment for its end.
    pub(super) fn look(&mut self) -> io::Result<Option<ExitStatus>> {
        let (begin, mut pause) = (Instant::now(), Duration::from_micros(500));
        loop {
            if let Some(status) = self.child.try_wait()? {
                self.has_ended = true;
                return Ok(Some(status));
            }
            if begin.elapsed() + pause > LOOK {
                return Ok(None);
            }
            sleep(pause);
            pause *= 2;
        }
    }

    /// For how long it has run.
    pub(super) fn age(&self) -> Duration {
        self.started.elapsed()
    }

    /// Asks it to end, and kills it if it does not.
    pub(super) fn end(&mut self) {
        if self.has_ended {
            return;
        }
        self.signal(Request::End);
        let asked = Instant::now();
        while asked.elapsed() < GRACE {
            match self.look() {
                Ok(None) => {}
                _ => break,
            }
        }
        // What it started may still be there.
        self.signal(Request::Kill);
        let _ = self.child.kill();
        let _ = self.child.wait();
        self.has_ended = true;
    }

    #[cfg(unix)]
    fn signal(&self, request: Request) {
        use rustix::process::{Pid, Signal, kill_process_group};
        let signal = match request {
            Request::End => Signal::TERM,
            Request::Kill => Signal::KILL,
        };
        // It may have ended by itself.
        let _ = kill_process_group(Pid::from_child(&self.child), signal);
    }

    #[cfg(not(unix))]
    fn signal(&self, _request: Request) {}
}

/// What a process is asked for.
enum Request {
    End,
    Kill,
}

impl Drop for Process {
    fn drop(&mut self) {
        self.end();
    }
}
