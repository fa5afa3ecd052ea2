//! Parts of the jobs of a sweep, for processes that need not talk to each other.

use super::Job;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};
use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Which jobs of a sweep, or of a round of a refined one, a process runs.
///
/// As text `3/64` is the third of 64 parts of equal work; `3f9a01c2d45e:0-31,40` lists jobs by
/// their places, behind a digest of all of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shard {
    /// One of several parts of equal work.
    Part {
        /// Its number, from 1.
        number: usize,
        /// How many there are.
        of: usize,
    },
    /// The jobs at these places.
    Listed {
        /// Digest of the identities of all jobs.
        digest: String,
        /// Places of the jobs in the order of the sweep, from 0.
        places: Vec<RangeInclusive<usize>>,
    },
}

/// A shard of other jobs.
#[derive(Debug, thiserror::Error)]
#[error(
    "`{0}` lists jobs of another version of the sweep, or of an earlier round; list them again \
     with `phase jobs`"
)]
pub struct ForeignShard(Shard);

crate::refusal::always!(true: ForeignShard);

impl Shard {
    /// Shards of jobs at these places, each in increasing order, of all jobs.
    pub fn of_places(jobs: &[Job], places: &[Vec<usize>]) -> Vec<Self> {
        let digest = digest(jobs);
        let shard = |places: &Vec<usize>| Self::Listed {
            digest: digest.clone(),
            places: ranges(places),
        };
        places.iter().map(shard).collect()
    }

    /// The part that each job belongs to, of so many, from 1.
    pub fn parts(jobs: &[Job], of: usize) -> Vec<usize> {
        let work: Vec<u64> = jobs.iter().map(Job::work).collect();
        deal(&work, of).into_iter().map(|part| part + 1).collect()
    }

    /// Identities of the shard's jobs: a function of the jobs alone. Parts are dealt from the
    /// longest job to the shortest, each to the part that has least work yet.
    ///
    /// # Errors
    /// If the shard lists places of other jobs.
    pub fn of<'a>(&self, jobs: &'a [Job]) -> Result<HashSet<&'a str>, ForeignShard> {
        match self {
            Self::Part { number, of } => {
                let dealt = Self::parts(jobs, *of).into_iter().zip(jobs);
                let own = dealt.filter(|(part, _)| part == number);
                Ok(own.map(|(_, job)| job.id.as_str()).collect())
            }
            Self::Listed { digest: of, places } => {
                let places = places.iter().cloned().flatten();
                let own = places.map(|place| Some(jobs.get(place)?.id.as_str()));
                let own = own.collect::<Option<_>>().filter(|_| *of == digest(jobs));
                own.ok_or_else(|| ForeignShard(self.clone()))
            }
        }
    }
}

/// The part that each job belongs to, from 0.
pub(super) fn deal(work: &[u64], parts: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..work.len()).collect();
    order.sort_by_key(|&place| Reverse(work[place]));
    let mut loads: BinaryHeap<Reverse<(u64, usize)>> = (0..parts.min(work.len()))
        .map(|part| Reverse((0, part)))
        .collect();
    let mut dealt = vec![0; work.len()];
    for place in order {
        if let Some(mut least) = loads.peek_mut() {
            let Reverse((load, part)) = &mut *least;
            dealt[place] = *part;
            // Jobs without work are dealt round, too.
            *load += work[place].max(1);
        }
    }
    dealt
}

/// Places in increasing order, as ranges.
fn ranges(places: &[usize]) -> Vec<RangeInclusive<usize>> {
    let runs = places.chunk_by(|a, b| a + 1 == *b);
    runs.filter_map(|run| Some(*run.first()?..=*run.last()?))
        .collect()
}

/// A digest of the identities of all jobs, in their order.
fn digest(jobs: &[Job]) -> String {
    let mut hasher = blake3::Hasher::new();
    for job in jobs {
        hasher.update(job.id.as_bytes());
    }
    hasher.finalize().to_hex()[..12].to_owned()
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Part { number, of } => write!(f, "{number}/{of}"),
            Self::Listed { digest, places } => {
                write!(f, "{digest}:")?;
                for (index, range) in places.iter().enumerate() {
                    let comma = if index > 0 { "," } else { "" };
                    match range.start() == range.end() {
                        true => write!(f, "{comma}{}", range.start())?,
                        false => write!(f, "{comma}{}-{}", range.start(), range.end())?,
                    }
                }
                Ok(())
            }
        }
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = match text.split_once(':') {
            Some((digest, places)) => parse_places(digest, places),
            None => parse_part(text),
        };
        parsed.ok_or_else(|| {
            "give a part and their number, such as 3/64, or a line that `phase jobs` printed"
                .to_owned()
        })
    }
}

fn parse_part(text: &str) -> Option<Shard> {
    let (number, of) = text.split_once('/')?;
    let (number, of) = (number.parse().ok()?, of.parse().ok()?);
    (1..=of)
        .contains(&number)
        .then_some(Shard::Part { number, of })
}

fn parse_places(digest: &str, places: &str) -> Option<Shard> {
    let is_digest = digest.len() == 12 && digest.bytes().all(|it| it.is_ascii_hexdigit());
    let range = |text: &str| {
        let (start, end) = text.split_once('-').unwrap_or((text, text));
        let (start, end) = (start.parse().ok()?, end.parse().ok()?);
        (start <= end).then_some(start..=end)
    };
    let places = places.split(',').map(range).collect::<Option<_>>()?;
    is_digest.then_some(Shard::Listed {
        digest: digest.to_owned(),
        places,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::Sweep;
    use proptest::prelude::*;

    fn jobs(number: usize) -> Vec<Job> {
        let mut sweep = Sweep::of_falling_sphere();
        sweep.seeds = (1..=number as u64).collect();
        sweep.jobs().unwrap()
    }

    proptest! {
        /// Every job belongs to one part, whatever the work, and no part has more than another by
        /// more than the longest job.
        #[test]
        fn parts_share_the_work(
            work in prop::collection::vec(0_u64..1000, 0..200),
            parts in 1_usize..40,
        ) {
            let dealt = deal(&work, parts);
            prop_assert_eq!(&dealt, &deal(&work, parts));
            let mut loads = vec![0; parts];
            for (part, work) in dealt.iter().zip(&work) {
                loads[*part] += work;
            }
            if work.len() >= parts {
                let (least, most) = (loads.iter().min().unwrap(), loads.iter().max().unwrap());
                let longest = work.iter().max().unwrap() + work.len() as u64;
                prop_assert!(most - least <= longest, "{loads:?}");
            }
        }

        #[test]
        fn shards_are_read_back(places in prop::collection::btree_set(0_usize..60, 1..40)) {
            let jobs = jobs(60);
            let places: Vec<usize> = places.into_iter().collect();
            let shard = &Shard::of_places(&jobs, std::slice::from_ref(&places))[0];
            prop_assert_eq!(&shard.to_string().parse::<Shard>().unwrap(), shard);
            let own = shard.of(&jobs).unwrap();
            let expected: HashSet<&str> = places.iter().map(|&it| jobs[it].id.as_str()).collect();
            prop_assert_eq!(own, expected);
        }
    }

    #[test]
    fn each_job_is_in_one_of_the_shards() {
        let jobs = jobs(7);
        for of in [1, 2, 3, 7, 9] {
            let mut seen = Vec::new();
            for number in 1..=of {
                seen.extend(Shard::Part { number, of }.of(&jobs).unwrap());
            }
            assert_eq!(seen.len(), 7, "{of}");
            assert_eq!(seen.into_iter().collect::<HashSet<_>>().len(), 7, "{of}");
        }
    }

    /// Places in a list say nothing of another list.
    #[test]
    fn a_list_of_other_jobs_is_refused() {
        let shard = &Shard::of_places(&jobs(5), &[vec![0, 1, 4]])[0];
        assert!(shard.to_string().ends_with(":0-1,4"));
        let error = shard.of(&jobs(6)).unwrap_err().to_string();
        assert!(
            error.contains("list them again with `phase jobs`"),
            "{error}"
        );
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        for text in [
            "",
            "0/4",
            "5/4",
            "1/0",
            "a/b",
            "3",
            "12:0-1",
            "3f9a01c2d45e:",
            "3f9a01c2d45e:4-2",
        ] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
        assert_eq!("2/3".parse(), Ok(Shard::Part { number: 2, of: 3 }));
    }
}
