//! Seeds as files write them.

use super::MOST_JOBS;
use crate::document::Problem;
use crate::scene::LARGEST_SEED;
use schemars::JsonSchema;
use serde::Deserialize;

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

impl SeedsEntry {
    /// The first seed of a refined sweep, whose table `[refine]` says how many there are.
    pub(crate) fn first_of_refined(&self, problems: &mut Vec<Problem>) -> u64 {
        let given = [
            ("count", self.count.is_some()),
            ("list", self.list.is_some()),
        ];
        for (key, _) in given.iter().filter(|(_, is_given)| *is_given) {
            let message = format!("`seeds.{key}` has no effect in a refined sweep");
            let help = "remove it; `refine.replicates` says how many seeds a point has at most";
            let problem = Problem::new(format!("seeds.{key}"), message);
            problems.push(problem.help(help).at_key());
        }
        self.first.unwrap_or(1)
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
                    let message = format!("duplicate seed {seed}");
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
