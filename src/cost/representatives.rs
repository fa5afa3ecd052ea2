//! The few jobs of a grid that are tried to forecast the cost of all.

use crate::scene::Integrator;
use crate::sweep::Job;

/// A job that stands for those nearest to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Representative<'a> {
    /// The job.
    pub(super) job: &'a Job,
    /// Number of jobs that it stands for, itself among them.
    pub(super) jobs: usize,
    /// Their work.
    pub(super) work: u64,
}

/// The jobs at the corners and in the middle of the grid, of the first seed and each integrator.
/// The others, of all seeds, are shared out among them: each to the nearest, counted in steps of
/// the grid over its width.
pub(super) fn representatives(jobs: &[Job]) -> Vec<Representative<'_>> {
    let (Some(first), Some(last)) = (jobs.first(), jobs.last()) else {
        return Vec::new();
    };
    let mut chosen: Vec<&Job> = Vec::new();
    let is_end =
        |(axis, value): (usize, &f64)| *value == first.values[axis] || *value == last.values[axis];
    let of_first_seed: Vec<&Job> = jobs.iter().filter(|job| job.seed == first.seed).collect();
    for &job in &of_first_seed {
        if job.values.iter().enumerate().all(is_end) {
            chosen.push(job);
        }
    }
    // A study goes over the grid once with each integrator.
    for integrator in Integrator::ALL {
        let own = |job: &&Job| job.integrator() == integrator;
        let of_it: Vec<&Job> = of_first_seed.iter().copied().filter(own).collect();
        let Some(&middle) = of_it.get(of_it.len() / 2) else {
            continue;
        };
        if !chosen.iter().any(|job| job.id == middle.id) {
            chosen.push(middle);
        }
    }
    let axes = axes(jobs);
    let places: Vec<Vec<f64>> = chosen.iter().map(|job| place(job, &axes)).collect();
    let mut standing: Vec<_> = chosen
        .into_iter()
        .map(|job| Representative {
            job,
            jobs: 0,
            work: 0,
        })
        .collect();
    for job in jobs {
        let here = place(job, &axes);
        let distances = places.iter().map(|it| distance_squared(it, &here));
        let nearest = distances
            .enumerate()
            .min_by(|(_, a), (_, b)| a.total_cmp(b));
        if let Some((nearest, _)) = nearest {
            standing[nearest].jobs += 1;
            standing[nearest].work += job.work();
        }
    }
    standing
}

/// The values on each axis, in the grid's order.
fn axes(jobs: &[Job]) -> Vec<Vec<f64>> {
    let mut axes = vec![Vec::new(); jobs.first().map_or(0, |job| job.values.len())];
    for job in jobs {
        for (axis, value) in axes.iter_mut().zip(&job.values) {
            if !axis.contains(value) {
                axis.push(*value);
            }
        }
    }
    axes
}

/// Where a job is on each axis, from 0 to 1.
fn place(job: &Job, axes: &[Vec<f64>]) -> Vec<f64> {
    let along = |(axis, value): (&Vec<f64>, &f64)| {
        let index = axis.iter().position(|it| it == value).unwrap_or(0);
        index as f64 / (axis.len().max(2) - 1) as f64
    };
    let place = axes.iter().zip(&job.values).map(along);
    // Whatever the axes, no job stands for one of another integrator.
    let integrator = (2 * axes.len() * job.integrator() as usize) as f64;
    place.chain([integrator]).collect()
}

fn distance_squared(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    const SCENE: &str = r#"
        spheres = { count = 3, radius = 0.004, density = 1000.0 }
        start = { kind = "random", z_min = 0.01, z_max = 0.05 }
        time = { dt = 1e-4, duration = 0.1, frame_interval = 1e-3 }
    "#;

    fn grid(values: usize, seeds: u64) -> Vec<Job> {
        let scene: Scene = toml::from_str(SCENE).unwrap();
        let mut jobs = Vec::new();
        for x in 0..values {
            for y in 0..values {
                for seed in 1..=seeds {
                    let id = format!("{x} {y} {seed}");
                    // Far from even, as a logarithmic axis.
                    let values = vec![x as f64, (1_u64 << (3 * y)) as f64];
                    jobs.push(Job::alone(
                        id,
                        values,
                        Scene {
                            seed,
                            ..scene.clone()
                        },
                    ));
                }
            }
        }
        jobs
    }

    #[test]
    fn corners_and_middle_stand_for_the_grid() {
        let jobs = grid(3, 2);
        let chosen = representatives(&jobs);
        let values: Vec<_> = chosen.iter().map(|it| it.job.values.clone()).collect();
        let corners = [[0.0, 1.0], [0.0, 64.0], [2.0, 1.0], [2.0, 64.0]];
        assert_eq!(values[..4], corners);
        assert_eq!(values[4..], [[1.0, 8.0]]);
        assert!(chosen.iter().all(|it| it.job.seed == 1));
    }

    #[test]
    fn every_job_is_stood_for_once() {
        let jobs = grid(9, 3);
        let chosen = representatives(&jobs);
        let steps: u64 = chosen.iter().map(|it| it.work).sum();
        assert_eq!(steps, 9 * 9 * 3 * 3 * 1000);
        assert_eq!(chosen.iter().map(|it| it.jobs).sum::<usize>(), 9 * 9 * 3);
        // The middle has those less than four steps away, 1 + 4 + 8 + 12 points; at four steps
        // corners are as near, and come first.
        assert_eq!(chosen[4].jobs, 25 * 3);
    }

    /// Symptom: the forecast of a study depended on the order of its integrators. Cause: jobs of
    /// all of them were given to the first.
    #[test]
    fn jobs_of_an_integrator_stand_for_its_own() {
        let mut jobs = Vec::new();
        for integrator in [Integrator::VelocityVerlet, Integrator::AdaptiveVerlet] {
            for job in grid(3, 1) {
                let mut scene = job.scene();
                scene.time.integrator = integrator;
                jobs.push(Job::alone(
                    format!("{integrator:?} {}", job.id),
                    job.values,
                    scene,
                ));
            }
        }
        let chosen = representatives(&jobs);
        assert_eq!(chosen.len(), 10);
        for integrator in [Integrator::VelocityVerlet, Integrator::AdaptiveVerlet] {
            let own = chosen.iter().filter(|it| it.job.integrator() == integrator);
            assert_eq!(own.map(|it| it.jobs).sum::<usize>(), 9);
        }
    }

    #[test]
    fn a_single_job_stands_for_itself() {
        let jobs = grid(1, 1);
        let chosen = representatives(&jobs);
        assert_eq!((chosen.len(), chosen[0].jobs), (1, 1));
    }
}
