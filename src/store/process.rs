//! Which process this is, on which machine, and whether a process still lives.

use serde::{Deserialize, Serialize};
use std::env;
use std::sync::LazyLock;

/// A process that may share a folder with others, on this machine or on another one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ProcessIdentity {
    /// The name of its machine.
    pub host: String,
    /// Its number.
    #[serde(rename = "process")]
    pub number: u32,
    /// The task of a batch system that it belongs to, such as `slurm 71_3`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub task: Option<String>,
    /// The start of the machine, and the table of processes that has its number: machines and
    /// containers may share a name. Linux tells it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) system: Option<String>,
    /// When it was started, in ticks of that system: numbers are given again.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) started: Option<u64>,
}

impl ProcessIdentity {
    /// This process.
    pub fn this() -> &'static Self {
        static THIS: LazyLock<ProcessIdentity> = LazyLock::new(|| {
            let number = std::process::id();
            ProcessIdentity {
                host: host(),
                number,
                task: task(),
                system: system(),
                started: started(number),
            }
        });
        &THIS
    }

    /// Whether it lives, seen from another process. None if that process cannot tell.
    pub(super) fn is_alive_for(&self, other: &Self) -> Option<bool> {
        if self.host != other.host || self.system != other.system {
            return None;
        }
        match self.system {
            Some(_) => Some(is_alive(self.number) && started(self.number) == self.started),
            // A container may have the name of its host: only a process that is there tells.
            None if cfg!(unix) => is_alive(self.number).then_some(true),
            None => None,
        }
    }
}

/// The name of this machine.
fn host() -> String {
    #[cfg(unix)]
    let name = rustix::system::uname()
        .nodename()
        .to_string_lossy()
        .into_owned();
    #[cfg(not(unix))]
    let name = env::var("COMPUTERNAME").unwrap_or_default();
    name
}

/// The task of Slurm or HyperQueue that this process belongs to.
fn task() -> Option<String> {
    let of = |name: &str| env::var(name).ok().filter(|it| !it.is_empty());
    let pair = |system: &str, job: &str, mark: &str, task: &str| {
        Some(format!("{system} {}{mark}{}", of(job)?, of(task)?))
    };
    pair("slurm", "SLURM_ARRAY_JOB_ID", "_", "SLURM_ARRAY_TASK_ID")
        .or_else(|| Some(format!("slurm {}", of("SLURM_JOB_ID")?)))
        .or_else(|| pair("hyperqueue", "HQ_JOB_ID", ".", "HQ_TASK_ID"))
}

/// The start of this machine and its table of processes.
fn system() -> Option<String> {
    let boot = std::fs::read_to_string("/proc/sys/kernel/random/boot_id").ok()?;
    let table = std::fs::read_link("/proc/self/ns/pid").ok()?;
    Some(format!("{} {}", boot.trim(), table.display()))
}

/// When a process of this machine was started: the 22nd field of its `stat`. The second one is a
/// name in brackets, which may hold spaces and brackets. None if it has ended, though its parent
/// may not know yet.
fn started(process: u32) -> Option<u64> {
    let text = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let (_, fields) = text.rsplit_once(')')?;
    let mut fields = fields.split_whitespace();
    if matches!(fields.next()?, "Z" | "X") {
        return None;
    }
    fields.nth(18)?.parse().ok()
}

/// Whether this machine has such a process, as far as the system tells.
pub(super) fn is_alive(process: u32) -> bool {
    #[cfg(unix)]
    {
        let process = i32::try_from(process).ok();
        let process = process.and_then(rustix::process::Pid::from_raw);
        // A process of another user exists, too, although it may not be signalled.
        process.is_some_and(|process| {
            rustix::process::test_kill_process(process) != Err(rustix::io::Errno::SRCH)
        })
    }
    #[cfg(not(unix))]
    {
        let _ = process;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_knows_who_lives_on_its_machine() {
        let this = ProcessIdentity::this();
        assert_eq!(this.is_alive_for(this), Some(true));
        let elsewhere = ProcessIdentity {
            host: format!("not-{}", this.host),
            ..this.clone()
        };
        assert_eq!(elsewhere.is_alive_for(this), None);
        if this.system.is_none() {
            return;
        }
        // A container or a machine of the same name, and a number that was given again.
        let container = ProcessIdentity {
            system: Some("another".to_owned()),
            ..this.clone()
        };
        assert_eq!(container.is_alive_for(this), None);
        let earlier = ProcessIdentity {
            started: this.started.map(|ticks| ticks - 1),
            ..this.clone()
        };
        assert_eq!(earlier.is_alive_for(this), Some(false));
    }
}
