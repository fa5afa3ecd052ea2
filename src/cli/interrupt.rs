//! Ctrl-C and requests to end.

use super::console::Console;
use super::exit::{Exit, Failure};
use signal_hook::consts::{SIGINT, SIGTERM};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by the first signal.
static STOP: AtomicBool = AtomicBool::new(false);

/// Whether signals are listened to: twice would take one signal for two.
static LISTENS: AtomicBool = AtomicBool::new(false);

/// From now on the first signal sets the flag that is returned; another Ctrl-C ends the program at
/// once. Requests to end may come twice: Slurm sends one to all processes of a task, and the script
/// of the task hands its own on. A signal that was ignored when the program started stays ignored:
/// `nohup` ignores the hang-up, and a shell the Ctrl-C of what it runs in the background.
pub(crate) fn stop_on_signal(console: &Console) -> Result<&'static AtomicBool, Failure> {
    if LISTENS.swap(true, Ordering::Relaxed) {
        return Ok(&STOP);
    }
    let speaker = Console::new(console.is_quiet(), console.is_verbose(), false);
    let ignored = ignored_signals();
    let wanted = SIGNALS.iter().filter(|&&signal| !ignored.contains(signal));
    listen(wanted.copied().collect(), move |signal| {
        if STOP.swap(true, Ordering::Relaxed) {
            if signal == SIGINT {
                phase::external::kill_all();
                std::process::exit(Exit::Interrupted as i32);
            }
            return;
        }
        // On a terminal the cursor stands behind the bar.
        let line = if std::io::stderr().is_terminal() {
            "\n"
        } else {
            ""
        };
        speaker.note(format_args!(
            "{line}stopping; interrupt again to end at once"
        ));
    })
    .map_err(|error| Failure::failed(format!("cannot listen for Ctrl-C: {error}")))?;
    Ok(&STOP)
}

/// From now on a file that grows beyond the limit of the system (`ulimit -f`) is a reported error
/// of writing, not a signal that ends the program silently.
pub(crate) fn report_too_large_files() {
    #[cfg(unix)]
    {
        let seen = std::sync::Arc::new(AtomicBool::new(false));
        // If this is refused, the signal ends the program, as before.
        let _ = signal_hook::flag::register(signal_hook::consts::signal::SIGXFSZ, seen);
    }
}

#[cfg(unix)]
const SIGNALS: [i32; 3] = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];

#[cfg(not(unix))]
const SIGNALS: [i32; 2] = [SIGINT, SIGTERM];

/// Calls `act` with each signal, on a thread of its own.
#[cfg(unix)]
fn listen(signals: Vec<i32>, act: impl Fn(i32) + Send + 'static) -> std::io::Result<()> {
    let mut signals = signal_hook::iterator::Signals::new(signals)?;
    std::thread::Builder::new().spawn(move || signals.forever().for_each(act))?;
    Ok(())
}

/// The same where a signal can only set a flag, which a thread looks at.
#[cfg(not(unix))]
fn listen(signals: Vec<i32>, act: impl Fn(i32) + Send + 'static) -> std::io::Result<()> {
    let mut flags = Vec::new();
    for signal in signals {
        let flag = std::sync::Arc::new(AtomicBool::new(false));
        signal_hook::flag::register(signal, std::sync::Arc::clone(&flag))?;
        flags.push((signal, flag));
    }
    std::thread::Builder::new().spawn(move || {
        loop {
            std::thread::sleep(std::time::Duration::from_millis(50));
            for (signal, flag) in &flags {
                if flag.swap(false, Ordering::Relaxed) {
                    act(*signal);
                }
            }
        }
    })?;
    Ok(())
}

/// Signals that were ignored before, as a set of bits.
struct Ignored(u64);

impl Ignored {
    fn contains(&self, signal: i32) -> bool {
        self.0 >> (signal - 1) & 1 == 1
    }
}

/// The signals that the process ignores, if the system says so (Linux); otherwise none.
fn ignored_signals() -> Ignored {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    Ignored(mask.unwrap_or(0))
}
