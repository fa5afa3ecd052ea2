//! Windows that slide over the frames of a run, each step in constant time.

use super::ClassifyError;

/// Number of frames in a window (s).
pub(super) fn frames(window: f64, interval: f64) -> usize {
    (window / interval).round() as usize
}

/// Whether the threshold `key` is a duration (s) of at least one frame.
pub(super) fn check(key: &'static str, window: f64, interval: f64) -> Result<(), ClassifyError> {
    check_of(key, window, interval, 1)
}

/// Whether the threshold `key` is a duration (s) of at least so many frames.
pub(super) fn check_of(
    key: &'static str,
    window: f64,
    interval: f64,
    least: usize,
) -> Result<(), ClassifyError> {
    let valid = window.is_finite() && frames(window, interval) >= least;
    valid.then_some(()).ok_or_else(|| ClassifyError::Threshold {
        key,
        value: window,
        expected: match least {
            1 => format!("a duration of at least one frame, {interval} s"),
            _ => format!("a duration of at least {least} frames of {interval} s"),
        },
    })
}

/// Whether the threshold `key` is above 0 and at most 1.
pub(super) fn check_share(key: &'static str, share: f64) -> Result<(), ClassifyError> {
    let valid = share > 0.0 && share <= 1.0;
    valid.then_some(()).ok_or_else(|| ClassifyError::Threshold {
        key,
        value: share,
        expected: "above 0 and at most 1".to_owned(),
    })
}

/// Largest number of hits in any `window` consecutive frames.
pub(super) fn most_hits(hits: &[bool], window: usize) -> usize {
    let (mut inside, mut most) = (0, 0);
    for (frame, &hit) in hits.iter().enumerate() {
        inside += usize::from(hit);
        if frame >= window {
            inside -= usize::from(hits[frame - window]);
        }
        most = most.max(inside);
    }
    most
}

/// Largest share of hits in any window that may reach beyond the frames, where nothing hits.
/// None if there are too few frames for the share `needed`, hits or not.
pub(super) fn largest_share(hits: &[bool], window: usize, needed: f64) -> Option<f64> {
    let share = |count: usize| count as f64 / window as f64;
    (share(hits.len()) >= needed).then(|| share(most_hits(hits, window)))
}

/// Sum of every `window` consecutive values, by their first.
///
/// Sums from the front and from the back of blocks of one window, put together: unlike a running
/// sum, which subtracts what leaves, a sum holds no trace of values outside its window.
pub(super) fn sums(values: &[f64], window: usize) -> Vec<f64> {
    let mut from_back = values.to_vec();
    for block in from_back.chunks_mut(window) {
        for index in (1..block.len()).rev() {
            block[index - 1] += block[index];
        }
    }
    let mut sums = Vec::new();
    let mut from_front = 0.0;
    for (last, value) in values.iter().enumerate() {
        if last % window == 0 {
            from_front = 0.0;
        }
        from_front += value;
        let end = last + 1;
        if end >= window {
            let whole_block = end % window == 0;
            let front = if whole_block { 0.0 } else { from_front };
            sums.push(from_back[end - window] + front);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_window_is_rounded_to_whole_frames() {
        assert_eq!(frames(0.5, 1e-3), 500);
        assert_eq!(frames(0.0124, 0.005), 2);
        assert!(check("settle.window", 6e-4, 1e-3).is_ok());
        for window in [4e-4, 0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(check("settle.window", window, 1e-3).is_err());
        }
    }

    #[test]
    fn what_left_a_window_leaves_no_trace() {
        let sums = sums(&[1e20, 1e-3, 2e-3, 3e-3, f64::INFINITY, 1.0, 2.0], 2);
        assert_eq!(sums[1..3], [3e-3, 5e-3]);
        assert_eq!(sums[5], 3.0);
    }

    proptest! {
        #[test]
        fn windows_agree_with_their_definition(
            values in prop::collection::vec(0_u32..9, 0..60),
            window in 1_usize..20,
        ) {
            let real: Vec<f64> = values.iter().copied().map(f64::from).collect();
            let expected: Vec<f64> = real.windows(window).map(|it| it.iter().sum()).collect();
            prop_assert_eq!(sums(&real, window), expected);

            let hits: Vec<bool> = values.iter().map(|value| value % 2 == 0).collect();
            let most = (0..hits.len())
                .map(|first| hits[first..].iter().take(window).filter(|hit| **hit).count())
                .max()
                .unwrap_or(0);
            prop_assert_eq!(most_hits(&hits, window), most);
        }
    }
}
