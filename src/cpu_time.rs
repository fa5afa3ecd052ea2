//! Processor time.

/// Processor time that the calling thread has used (s); only differences mean anything. Where the
/// system does not tell, the time of day stands in for it.
pub(crate) fn of_this_thread() -> f64 {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    }
    #[cfg(not(unix))]
    {
        let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
        since.map_or(0.0, |since| since.as_secs_f64())
    }
}

#[cfg(test)]
mod tests {
    use super::of_this_thread;

    #[test]
    #[cfg(unix)]
    fn sleep_takes_none() {
        let start = of_this_thread();
        std::thread::sleep(std::time::Duration::from_millis(50));
        assert!(of_this_thread() - start < 0.04);
        while of_this_thread() == start {
            std::hint::black_box(start);
        }
    }
}
