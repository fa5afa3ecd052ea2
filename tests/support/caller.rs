//! Programs that the tests start inherit nothing from whoever started the tests: no ignored
//! signals, environment, mask of permissions or standard input.

use std::process::{Command, Stdio};
use std::sync::Once;

/// Variables that programs need to be found and to find a place for their files.
const KEPT: [&str; 4] = ["PATH", "TMPDIR", "LD_LIBRARY_PATH", "SystemRoot"];

/// A program that starts as from a fresh terminal of a user who has set nothing.
pub(crate) fn command(program: impl AsRef<std::ffi::OsStr>) -> Command {
    static SYSTEM: Once = Once::new();
    #[cfg(unix)]
    SYSTEM.call_once(unix::forget_caller);
    let mut command = Command::new(program);
    command.env_clear().stdin(Stdio::null());
    for name in KEPT {
        if let Some(value) = std::env::var_os(name) {
            command.env(name, value);
        }
    }
    command
}

#[cfg(unix)]
mod unix {
    use rustix::fs::Mode;
    use signal_hook::consts::{SIGCHLD, SIGHUP, SIGINT, SIGQUIT, SIGTERM};
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;

    /// The signals that callers ignore for programs in the background; and the end of a child, of
    /// which nobody learns where it is ignored.
    const SIGNALS: [i32; 5] = [SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGCHLD];

    /// A signal that is ignored stays so in a new program, but one that has a handler gets its
    /// default action there. Here the handlers do what the signals would do without them.
    pub(super) fn forget_caller() {
        let ignored = ignored_signals();
        for signal in SIGNALS {
            let acts = ignored >> (signal - 1) & 1 == 0;
            let acts = Arc::new(AtomicBool::new(acts));
            signal_hook::flag::register_conditional_default(signal, acts).unwrap();
        }
        rustix::process::umask(Mode::from_raw_mode(0o022));
    }

    /// A bit for each signal that was ignored, where the system tells (Linux); else none.
    fn ignored_signals() -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        mask.unwrap_or(0)
    }
}
