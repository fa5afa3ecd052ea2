//! Seeds as files write them.

use super::load::MOST_JOBS;
use crate::document::Problem;
use crate::scene::LARGEST_SEED;
use schemars::JsonSchema;
use serde::Deserialize;

/// The seeds of a sweep.
#[derive(Deserialize, JsonSchema)]
pub(super) struct SweepSeeds {
    #[serde(flatten)]
    pub(super) of_all: SeedsEntry,
    /// Number of seeds of points beside a point with another label. Those that they have more than
    /// all points follow the largest one, and run last. Absent: no more.
    at_borders: Option<u64>,
}

/// Seeds as files write them: a list, or the first and their number.
#[derive(Deserialize, JsonSchema)]
pub(crate) struct SeedsEntry {
    /// The first seed (default 1); the others follow.
    first: Option<u64>,
    /// Number of seeds (default 1).
    #[schemars(range(min = 1))]
    count: Option<u64>,
    /// All seeds one by one, in place of `first` and `count`.
    list: Option<Vec<u64>>,
}

impl SweepSeeds {
    /// The first seed of a refined sweep, whose table `[refine]` says how many there are.
    pub(super) fn first_of_refined(&self, problems: &mut Vec<Problem>) -> u64 {
        let given = [
            ("count", self.of_all.count.is_some()),
            ("list", self.of_all.list.is_some()),
        ];
        for (key, _) in given.iter().filter(|(_, is_given)| *is_given) {
            let message = format!("`seeds.{key}` has no effect in a refined sweep");
            let help = "remove it; `refine.replicates` says how many seeds a point has at most";
            let problem = Problem::new(format!("seeds.{key}"), message);
            problems.push(problem.help(help).at_key());
        }
        if self.at_borders.is_some() {
            let message = "`seeds.at_borders` has no effect in a refined sweep, which gives the \
                           points at borders more seeds itself";
            let problem = Problem::new("seeds.at_borders", message);
            let help = "remove it, or the table [refine]";
            problems.push(problem.help(help).at_key());
        }
        self.of_all.first.unwrap_or(1)
    }

    /// The seeds that only points at borders have: those after the `seeds` of all points.
    pub(super) fn more_at_borders(&self, seeds: &[u64], problems: &mut Vec<Problem>) -> Vec<u64> {
        let Some(number) = self.at_borders else {
            return Vec::new();
        };
        let mut refuse = |message: String, help: &str| {
            problems.push(Problem::new("seeds.at_borders", message).help(help));
            Vec::new()
        };
        let (Some(&last), count) = (seeds.iter().max(), seeds.len() as u64) else {
            return Vec::new();
        };
        if number <= count {
            let message = format!("all points have {count} seeds, so that {number} are not more");
            return refuse(message, "take a larger number, or remove the key");
        }
        let more = number - count;
        if last.saturating_add(more) > LARGEST_SEED {
            let message = format!("the seeds would go beyond {LARGEST_SEED}, the largest one");
            return refuse(message, "begin with a lower one");
        }
        if more > MOST_JOBS as u64 {
            let message = format!("{number} seeds are too many");
            return refuse(message, &format!("{MOST_JOBS} jobs are the most"));
        }
        (last + 1..=last + more).collect()
    }
}

/// The seeds of a file; seed 1 alone if it says nothing.
pub(crate) fn expand_seeds(entry: Option<&SeedsEntry>, problems: &mut Vec<Problem>) -> Vec<u64> {
    match entry {
        None => vec![1],
        Some(SeedsEntry {
            list: Some(list),
            first: None,
            count: None,
        }) => {
            if list.is_empty() {
                let problem = Problem::new("seeds.list", "there are no seeds");
                problems.push(problem.help("list at least one"));
            }
            for (index, seed) in list.iter().enumerate() {
                if list[..index].contains(seed) {
                    let path = format!("seeds.list[{index}]");
                    let message = format!("the seed {seed} is there twice");
                    let help = "equal seeds give equal runs; remove one";
                    problems.push(Problem::new(path, message).help(help));
                }
            }
            list.clone()
        }
        Some(SeedsEntry { list: Some(_), .. }) => {
            let message = "`list` and `first` or `count` exclude each other";
            let problem = Problem::new("seeds.list", message).at_key();
            problems.push(problem.help("keep the list, or the range"));
            Vec::new()
        }
        Some(SeedsEntry { first, count, .. }) => {
            let (first, count) = (first.unwrap_or(1), count.unwrap_or(1));
            if first.saturating_add(count) > LARGEST_SEED {
                let message = format!("the seeds would go beyond {LARGEST_SEED}, the largest one");
                problems.push(Problem::new("seeds.first", message).help("begin with a lower one"));
                return Vec::new();
            }
            if count > MOST_JOBS as u64 {
                let message = format!("{count} seeds are too many");
                let help = format!("{MOST_JOBS} jobs are the most");
                problems.push(Problem::new("seeds.count", message).help(help));
                return Vec::new();
            }
            (first..first + count).collect()
        }
    }
}
