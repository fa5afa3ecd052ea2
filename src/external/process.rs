//! A process of another program.

use std::fs::File;
use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// How long a program that is asked to end may take before it is killed.
const GRACE: Duration = Duration::from_secs(5);

/// How long a look at a process waits at most.
const LOOK: Duration = Duration::from_millis(20);

/// A process that is ended, with all that it started, when this is dropped.
pub(super) struct ChildProcess {
    child: Child,
    started: Instant,
    has_ended: bool,
}

impl ChildProcess {
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
        let mut alive = lock(&ALIVE);
        let child = command.spawn()?;
        alive.push(child.id());
        Ok(Self {
            child,
            started: Instant::now(),
            has_ended: false,
        })
    }

    /// Waits a moment for its end.
    pub(super) fn look(&mut self) -> io::Result<Option<ExitStatus>> {
        let (begin, mut pause) = (Instant::now(), Duration::from_micros(500));
        loop {
            if let Some(status) = self.child.try_wait()? {
                self.note_end();
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
        signal(self.child.id(), Request::End);
        let asked = Instant::now();
        while asked.elapsed() < GRACE {
            match self.look() {
                Ok(None) => {}
                Ok(Some(_)) => return,
                Err(_) => break,
            }
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
        self.note_end();
    }

    /// Ends what it started and left.
    fn note_end(&mut self) {
        if !self.has_ended {
            signal(self.child.id(), Request::Kill);
            lock(&ALIVE).retain(|it| *it != self.child.id());
        }
        self.has_ended = true;
    }
}

/// The programs that run now.
static ALIVE: Mutex<Vec<u32>> = Mutex::new(Vec::new());

fn lock(alive: &Mutex<Vec<u32>>) -> MutexGuard<'_, Vec<u32>> {
    alive.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Kills all programs that run now, before this one ends at once.
pub fn kill_all() {
    lock(&ALIVE)
        .iter()
        .for_each(|group| signal(*group, Request::Kill));
}

/// Signals a program with all that it started, which are the group of its number.
#[cfg(unix)]
fn signal(group: u32, request: Request) {
    use rustix::process::{Pid, Signal, kill_process_group};
    let signal = match request {
        Request::End => Signal::TERM,
        Request::Kill => Signal::KILL,
    };
    // All of them may have ended.
    if let Some(group) = Pid::from_raw(group as i32) {
        let _ = kill_process_group(group, signal);
    }
}

#[cfg(not(unix))]
fn signal(_group: u32, _request: Request) {}

/// What a process is asked for.
enum Request {
    End,
    Kill,
}

impl Drop for ChildProcess {
    fn drop(&mut self) {
        self.end();
    }
}
