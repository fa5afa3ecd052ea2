//! Ctrl-C and requests to end.

use super::console::Console;
use super::exit::{Exit, Failure};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by the first signal.
static STOP: AtomicBool = AtomicBool::new(false);

/// From now on the first signal sets the flag that is returned; the second ends the program at
/// once.
pub(crate) fn stop_on_signal(console: &Console) -> Result<&'static AtomicBool, Failure> {
    let speaker = Console::new(console.is_quiet(), console.is_verbose(), false);
    ctrlc::set_handler(move || {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(Exit::Interrupted as i32);
        }
        // On a terminal the cursor stands behind the bar.
        let line = if std::io::stderr().is_terminal() {
            "\n"
        } else {
            ""
        };
        speaker.note(format_args!("{line}stopping; once more ends at once"));
    })
    .map_err(|error| Failure::failed(format!("cannot listen for Ctrl-C: {error}")))?;
    Ok(&STOP)
}
