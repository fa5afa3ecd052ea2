//! The right of one process to do what others may want to do too, on any machine that sees the
//! folder.
//!
//! A lease is a file that only one process can make (`O_EXCL`), which works where files cannot be
//! locked, as on many file systems of clusters. Its holder touches it every [`BEAT`]. A process of
//! the same machine sees at once whether the holder is dead. One of another machine watches the
//! file: if its time does not change for [`PATIENCE`] by the watcher's own clock, the holder is
//! taken to be dead. No clock of two machines is compared.
//!
//! Whoever breaks the lease `NAME` of a dead holder first makes `NAME.1`, which again only one can
//! do, and gives it the name `NAME`. Should that process die in between, `NAME.1` is broken with
//! `NAME.2`, and so on.

use super::atomic::unfinished_beside;
use super::process::ProcessIdentity;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, Once, PoisonError, Weak};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// Time between two signs of life of a holder.
const BEAT: Duration = Duration::from_secs(15);

/// How long a holder on another machine may give no sign of life. Network file systems show a
/// change after up to a minute.
const PATIENCE: Duration = Duration::from_mins(2);

/// Time between two looks at a file whose holder may be dead.
const BETWEEN_LOOKS: Duration = Duration::from_millis(500);

/// How many broken leases in a row are broken. More means that no process can keep one.
const LONGEST_CHAIN: usize = 16;

/// How the name of a lease ends.
const SUFFIX: &str = ".lease";

/// Who has a lease: what its file says.
///
/// [`Display`](std::fmt::Display) names the process for people.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Holder {
    /// The process.
    #[serde(flatten)]
    pub process: ProcessIdentity,
    /// When it was taken, by the clock of the holder (seconds since 1970).
    pub since: u64,
    /// Number of the lease in its process.
    serial: u64,
}

impl std::fmt::Display for Holder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "process {} on {}",
            self.process.number, self.process.host
        )?;
        match &self.process.task {
            Some(task) => write!(f, " ({task})"),
            None => Ok(()),
        }
    }
}

/// A right that this process has, given back when it is dropped.
#[derive(Debug)]
pub struct Lease {
    path: PathBuf,
    holder: Holder,
    // Signs of life end with it.
    _file: Arc<File>,
}

/// What is known of a lease.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Tenure {
    /// Nobody has it.
    Free,
    /// Its holder lives, or has not been watched for long enough. What the file says of the holder
    /// cannot be read for an instant after it was made.
    Held(Option<Holder>),
    /// Its holder is dead.
    Stale(Option<Holder>),
}

impl Lease {
    /// Takes a lease, a file of that name with `.lease` appended. None if another process has it.
    ///
    /// # Errors
    /// If the file cannot be made or read.
    pub fn take(name: &Path) -> io::Result<Option<Self>> {
        Leases::ours().take(&file_of(name))
    }

    /// Takes the right to write a file NAME: the lease `.NAME`, whose file people do not see. Waits
    /// for so long for a process that has it.
    ///
    /// # Errors
    /// Those of [`take`](Self::take).
    pub fn take_beside(file: &Path, time: Duration) -> io::Result<Option<Self>> {
        let mut name = OsString::from(".");
        name.push(file.file_name().unwrap_or_default());
        let name = file.with_file_name(name);
        let begun = Instant::now();
        loop {
            let taken = Self::take(&name)?;
            if taken.is_some() || begun.elapsed() >= time {
                return Ok(taken);
            }
            thread::sleep(Duration::from_millis(20));
        }
    }

    /// Who has a lease.
    pub fn tenure(name: &Path) -> Tenure {
        let tenure = Leases::ours().tenure(&file_of(name));
        tenure.unwrap_or(Tenure::Held(None))
    }

    /// Whether another process has a lease.
    pub fn is_taken(name: &Path) -> bool {
        matches!(Self::tenure(name), Tenure::Held(_))
    }

    /// Watches a lease until it is known whether its holder lives: up to [`PATIENCE`] if it is on
    /// another machine. Calls `wait` before the first pause.
    pub(crate) fn watch(name: &Path, wait: &dyn Fn(&Holder)) -> Tenure {
        Leases::ours().watch(&file_of(name), wait)
    }

    /// The name of the lease whose file that is, if it is a lease or was made to break one.
    pub(crate) fn name_of(file: &str) -> Option<&str> {
        let (name, rest) = file.rsplit_once(SUFFIX)?;
        let number = rest.strip_prefix('.');
        let breaks = number.is_some_and(|it| it.bytes().all(|byte| byte.is_ascii_digit()));
        (rest.is_empty() || breaks).then_some(name)
    }
}

impl Drop for Lease {
    fn drop(&mut self) {
        // A holder that was taken to be dead has lost the lease to another process.
        let is_ours =
            matches!(look(&self.path), Ok(Some(it)) if it.holder.as_ref() == Some(&self.holder));
        if is_ours {
            // If it cannot be removed, it is broken by who wants it next.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// The leases that one process holds and watches.
struct Leases {
    process: ProcessIdentity,
    beat: Duration,
    patience: Duration,
    /// The clock that signs of life are written with.
    clock: fn() -> SystemTime,
    taken: AtomicU64,
    held: Arc<Mutex<Vec<Weak<File>>>>,
    beats: Once,
    watched: Mutex<HashMap<PathBuf, Watched>>,
}

/// A lease of another process when it was first seen like this.
struct Watched {
    seen: Seen,
    since: Instant,
}

/// What a look at a file gives.
#[derive(Clone, PartialEq, Eq)]
struct Seen {
    /// None if the file does not say it, or not yet.
    holder: Option<Holder>,
    changed: Option<SystemTime>,
}

impl Leases {
    fn ours() -> &'static Self {
        static OURS: LazyLock<Leases> = LazyLock::new(|| {
            Leases::new(
                ProcessIdentity::this().clone(),
                BEAT,
                PATIENCE,
                SystemTime::now,
            )
        });
        &OURS
    }

    fn new(
        process: ProcessIdentity,
        beat: Duration,
        patience: Duration,
        clock: fn() -> SystemTime,
    ) -> Self {
        Self {
            process,
            beat,
            patience,
            clock,
            taken: AtomicU64::new(0),
            held: Arc::default(),
            beats: Once::new(),
            watched: Mutex::default(),
        }
    }

    fn take(&self, path: &Path) -> io::Result<Option<Lease>> {
        let holder = self.holder();
        let mut stale: Vec<(PathBuf, Option<Holder>)> = Vec::new();
        for number in 0..LONGEST_CHAIN {
            let name = link(path, number);
            if let Some(file) = make(&name, &holder)? {
                let took = self.settle(path, &name, &stale)?;
                return Ok(took.then(|| self.keep(path, holder, file)));
            }
            match self.tenure(&name)? {
                Tenure::Stale(of) => stale.push((name, of)),
                // Given back meanwhile: what it was held for is done, or it is free the next time.
                Tenure::Free | Tenure::Held(_) => return Ok(None),
            }
        }
        Ok(None)
    }

    /// Whether the file `name`, which this process has made, gives it the lease: always if it is
    /// the lease itself, and else if those before it in the chain are still the stale ones.
    fn settle(
        &self,
        path: &Path,
        name: &Path,
        stale: &[(PathBuf, Option<Holder>)],
    ) -> io::Result<bool> {
        if stale.is_empty() {
            return Ok(true);
        }
        for (before, of) in stale {
            if !look(before)?.is_some_and(|it| it.holder == *of) {
                // Another process has broken it.
                remove(name)?;
                return Ok(false);
            }
        }
        match fs::rename(name, path) {
            Ok(()) => {}
            // This process has paused for so long that another one took it to be dead.
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
            Err(error) => return Err(error),
        }
        for (left, _) in &stale[1..] {
            remove(left)?;
        }
        self.watched().remove(path);
        Ok(true)
    }

    fn keep(&self, path: &Path, holder: Holder, file: File) -> Lease {
        let file = Arc::new(file);
        lock(&self.held).push(Arc::downgrade(&file));
        self.beats.call_once(|| self.start_beats());
        Lease {
            path: path.to_owned(),
            holder,
            _file: file,
        }
    }

    /// A thread that touches the files of all leases now and then, until this is dropped.
    fn start_beats(&self) {
        let held = Arc::downgrade(&self.held);
        let (beat, clock) = (self.beat, self.clock);
        let beats = move || {
            loop {
                thread::sleep(beat);
                let Some(held) = held.upgrade() else { return };
                lock(&held).retain(|file| file.strong_count() > 0);
                let files: Vec<_> = lock(&held).iter().filter_map(Weak::upgrade).collect();
                for file in files {
                    // One that cannot be touched now may be the next time.
                    let _ = file.set_modified(clock());
                }
            }
        };
        // Without the thread, other machines take long runs over: work is done twice, not lost.
        let _ = thread::Builder::new().name("leases".into()).spawn(beats);
    }

    fn holder(&self) -> Holder {
        let since = (self.clock)().duration_since(UNIX_EPOCH);
        Holder {
            process: self.process.clone(),
            since: since.map_or(0, |it| it.as_secs()),
            serial: self.taken.fetch_add(1, Ordering::Relaxed),
        }
    }

    fn tenure(&self, path: &Path) -> io::Result<Tenure> {
        let Some(seen) = look(path)? else {
            self.watched().remove(path);
            return Ok(Tenure::Free);
        };
        let holder = seen.holder.clone();
        let process = holder.as_ref().map(|it| &it.process);
        let lives = process.and_then(|it| it.is_alive_for(&self.process));
        let is_stale = match lives {
            Some(lives) => !lives,
            None => self.unchanged_for(path, seen) >= self.patience,
        };
        Ok(match is_stale {
            true => Tenure::Stale(holder),
            false => Tenure::Held(holder),
        })
    }

    /// For how long this process has seen a file without a change.
    fn unchanged_for(&self, path: &Path, seen: Seen) -> Duration {
        let mut watched = self.watched();
        match watched.get(path) {
            Some(known) if known.seen == seen => known.since.elapsed(),
            _ => {
                let since = Instant::now();
                watched.insert(path.to_owned(), Watched { seen, since });
                Duration::ZERO
            }
        }
    }

    fn watch(&self, path: &Path, wait: &dyn Fn(&Holder)) -> Tenure {
        let mut first: Option<Seen> = None;
        loop {
            let seen = look(path).ok().flatten();
            let tenure = self.tenure(path).unwrap_or(Tenure::Held(None));
            let Tenure::Held(holder) = &tenure else {
                return tenure;
            };
            let process = holder.as_ref().map(|it| &it.process);
            let is_known = process.is_some_and(|it| it.is_alive_for(&self.process).is_some());
            let has_moved = first.is_some() && seen.is_some() && seen != first;
            if is_known || has_moved {
                return tenure;
            }
            if first.is_none() {
                if let Some(holder) = holder {
                    wait(holder);
                }
                first = seen;
            }
            thread::sleep(BETWEEN_LOOKS.min(self.beat));
        }
    }

    fn watched(&self) -> MutexGuard<'_, HashMap<PathBuf, Watched>> {
        lock(&self.watched)
    }
}

/// Locks; a panic elsewhere leaves only whole entries.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The file of a lease.
fn file_of(name: &Path) -> PathBuf {
    with(name, SUFFIX)
}

/// The file that breaks the lease of a file in a chain; the first is the file itself.
fn link(path: &Path, number: usize) -> PathBuf {
    match number {
        0 => path.to_owned(),
        _ => with(path, &format!(".{number}")),
    }
}

fn with(path: &Path, end: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(end);
    name.into()
}

/// Makes a file that is not there. None if it is. It appears whole: an unfinished one, whose
/// process was killed, would name nobody.
fn make(path: &Path, holder: &Holder) -> io::Result<Option<File>> {
    let mut tries = 1..=MOST_TRIES;
    loop {
        match make_once(path, holder) {
            // A process that is alone in the folder took the unfinished file for one that was left
            // behind.
            Err(error) if error.kind() == ErrorKind::NotFound && tries.next().is_some() => {}
            made => return made,
        }
    }
}

/// How often an unfinished file may be removed by others.
const MOST_TRIES: usize = 10;

fn make_once(path: &Path, holder: &Holder) -> io::Result<Option<File>> {
    let text = serde_json::to_string(holder).map_err(io::Error::other)?;
    let unfinished = unfinished_beside(path);
    let made = write_new(&unfinished, &text)?;
    let linked = fs::hard_link(&unfinished, path);
    // One that stays is removed by who writes here next.
    let _ = fs::remove_file(&unfinished);
    match (made, linked) {
        (Some(file), Ok(())) => Ok(Some(file)),
        // Where NFS loses an answer and asks again, it finds the link that it has made.
        (made, Err(error)) if error.kind() == ErrorKind::AlreadyExists => {
            let is_ours = look(path)?.is_some_and(|it| it.holder.as_ref() == Some(holder));
            Ok(made.filter(|_| is_ours))
        }
        (_, Err(error)) if error.kind() == ErrorKind::NotFound => Err(error),
        // Not every file system has links.
        _ => write_new(path, &text),
    }
}

/// Writes a file that is not there. None if it is.
fn write_new(path: &Path, text: &str) -> io::Result<Option<File>> {
    let mut file = match OpenOptions::new().write(true).create_new(true).open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::AlreadyExists => return Ok(None),
        Err(error) => return Err(error),
    };
    match file.write_all(text.as_bytes()) {
        Ok(()) => Ok(Some(file)),
        Err(error) => {
            let _ = fs::remove_file(path);
            Err(error)
        }
    }
}

/// Removes a file, unless it is gone already.
fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// Looks at the file of a lease. None if it is not there. It is opened, for only then do network
/// file systems ask the server.
fn look(path: &Path) -> io::Result<Option<Seen>> {
    let mut file = match File::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    };
    let mut text = Vec::new();
    file.read_to_end(&mut text)?;
    Ok(Some(Seen {
        holder: serde_json::from_slice(&text).ok(),
        changed: file.metadata()?.modified().ok(),
    }))
}

#[cfg(test)]
mod tests;
