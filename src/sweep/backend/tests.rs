use super::*;
use crate::run;
use crate::sweep::{Sweep, work};
use std::io;
use std::io::ErrorKind;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Results of which seed 2 cannot be written, for this reason.
struct Faulty {
    folder: PathBuf,
    kind: ErrorKind,
    have_own_files: bool,
}

impl Results for Faulty {
    fn have_own_files(&self) -> bool {
        self.have_own_files
    }

    fn keep(&self, job: &Job, _: &RunRecord) -> Result<(), StoreError> {
        match job.seed {
            2 => Err(StoreError::writing(
                &self.folder.join(&job.id),
                self.kind.into(),
            )),
            _ => Ok(()),
        }
    }

    fn checkpoints(&self, job: &Job) -> Checkpoints {
        Checkpoints::beside(&self.folder.join(&job.id), Duration::from_mins(1))
    }

    fn note_failures(&self, _: &[Failure]) -> Result<(), StoreError> {
        match self.kind {
            ErrorKind::IsADirectory => Err(StoreError::writing(
                &self.folder.join("failed.csv"),
                io::Error::from(self.kind),
            )),
            _ => Ok(()),
        }
    }
}

/// A sweep of four jobs with seeds 1 to 4.
fn sweep() -> Sweep {
    Sweep {
        seeds: vec![1, 2, 3, 4],
        ..Sweep::of_falling_sphere()
    }
}

fn record(job: &Job) -> RunRecord {
    run::run(&job.scene(), &mut |_| ControlFlow::Continue(())).unwrap()
}

/// What became of four jobs one after the other on a backend.
fn report_of(kind: ErrorKind, have_own_files: bool, backend: &dyn Backend) -> Report {
    let place = tempfile::tempdir().unwrap();
    let jobs = sweep().jobs().unwrap();
    let results = Faulty {
        folder: place.path().to_owned(),
        kind,
        have_own_files,
    };
    Batch::new(&jobs, &results, Wishes::default()).run_on(backend)
}

fn report(kind: ErrorKind, have_own_files: bool) -> Report {
    report_of(kind, have_own_files, &LocalThreads::new(1))
}

#[test]
fn a_result_that_cannot_be_written_fails_its_job() {
    for kind in [
        ErrorKind::PermissionDenied,
        ErrorKind::InvalidFilename,
        ErrorKind::FileTooLarge,
        ErrorKind::IsADirectory,
    ] {
        let report = report(kind, true);
        assert_eq!((report.finished, report.left), (3, 0), "{kind}");
        assert_eq!(report.failures.len(), 1);
        assert_eq!(report.failures[0].seed, 2);
        assert!(report.halted.is_none());
        // That the failure could not be noted stops nothing.
        assert_eq!(report.unnoted.is_some(), kind == ErrorKind::IsADirectory);
    }
}

#[test]
fn a_full_disk_or_one_table_of_all_ends_the_work() {
    for (kind, have_own_files) in [
        (ErrorKind::StorageFull, true),
        (ErrorKind::PermissionDenied, false),
    ] {
        let report = report(kind, have_own_files);
        assert_eq!((report.finished, report.left), (1, 3), "{kind}");
        assert!(report.halted.is_some() && report.failures.is_empty());
    }
}

/// A backend that does with each job what the function says.
struct Each<F>(F);

impl<F: Fn(&Batch<'_>, &Job) -> Result<(), BackendError> + Sync> Backend for Each<F> {
    fn run(&self, batch: &Batch<'_>) -> Result<(), BackendError> {
        batch.jobs().iter().try_for_each(|job| self.0(batch, job))
    }
}

fn permit<'b>(batch: &'b Batch<'b>, job: &'b Job) -> Permit<'b> {
    match batch.claim(job) {
        Claim::Granted(permit) => permit,
        _ => panic!("the job is to be run here"),
    }
}

/// Symptom: a job that failed and was handed in again made the number of those left overflow.
#[test]
fn a_job_is_handed_in_once() {
    let backend = Each(|batch: &Batch<'_>, job: &Job| {
        let first = permit(batch, job);
        // Claimed, it is nobody else's, unless the permit is given back.
        assert!(matches!(batch.claim(job), Claim::Refused));
        drop(first);
        permit(batch, job).fail("first");
        assert!(matches!(batch.claim(job), Claim::Refused));
        Ok(())
    });
    let report = report_of(ErrorKind::Other, true, &backend);
    assert_eq!(
        (report.failures.len(), report.finished, report.left),
        (4, 0, 0)
    );
    assert!(report.failures.iter().all(|it| it.reason == "first"));
}

/// Symptom: the record of one job was stored under the name of another.
#[test]
fn the_record_of_another_job_is_refused() {
    let mut scene = sweep().jobs().unwrap()[0].scene();
    scene.seed = 7;
    let other = Job::alone(scene.identity(), Vec::new(), scene);
    let backend = Each(|batch: &Batch<'_>, job: &Job| {
        assert!(matches!(batch.claim(&other), Claim::Refused));
        let made = if job.seed == 3 { &other } else { job };
        permit(batch, job).finish(&record(made));
        Ok(())
    });
    let report = report_of(ErrorKind::PermissionDenied, true, &backend);
    assert_eq!((report.finished, report.failures.len()), (2, 2));
    let reason = &report.failures[1].reason;
    let names = [report.failures[1].id.as_str(), other.id.as_str()];
    assert!(names.iter().all(|it| reason.contains(it)), "{reason}");
}

/// Symptom: the error of a backend threw away the report of what it had done, and a panic ended the
/// program.
#[test]
fn a_backend_that_cannot_go_on_halts_the_batch() {
    for (seed, message) in [
        (1, "no answer"),
        (2, "the queue is gone"),
        (3, "a bug in the backend: lost count"),
    ] {
        let backend = Each(|batch: &Batch<'_>, job: &Job| match (job.seed, seed) {
            (3, 1) => Err(BackendError::new("no answer")),
            (3, 2) => {
                batch.halt(BackendError::new("the queue is gone"));
                assert!(batch.is_over() && !batch.is_stopped());
                Ok(())
            }
            (3, 3) => panic!("lost count"),
            _ => {
                if let Claim::Granted(permit) = batch.claim(job) {
                    permit.finish(&record(job));
                }
                Ok(())
            }
        });
        let report = report_of(ErrorKind::PermissionDenied, true, &backend);
        assert_eq!((report.finished, report.failures.len()), (1, 1));
        assert_eq!(report.left, 2);
        assert_eq!(report.halted.unwrap().to_string(), message);
    }
}

/// Results in memory. One job is made by another process, which ends after some looks at it.
#[derive(Default)]
struct Shared {
    /// The seed of that job, and whether the process leaves a result.
    elsewhere: Option<(u64, bool)>,
    looks: AtomicUsize,
}

impl Results for Shared {
    fn have_own_files(&self) -> bool {
        true
    }

    fn claim(&self, job: &Job) -> Result<Claim<Option<Lease>>, StoreError> {
        Ok(match self.elsewhere {
            Some((seed, leaves_result)) if seed == job.seed => {
                match (self.looks.load(Ordering::Relaxed), leaves_result) {
                    (0..3, _) => Claim::Elsewhere,
                    (_, true) => Claim::Made,
                    (_, false) => Claim::Granted(None),
                }
            }
            _ => Claim::Granted(None),
        })
    }

    fn is_made_elsewhere(&self, job: &Job) -> bool {
        assert_eq!(self.elsewhere.map(|it| it.0), Some(job.seed));
        self.looks.fetch_add(1, Ordering::Relaxed) < 3
    }

    fn keep(&self, _: &Job, _: &RunRecord) -> Result<(), StoreError> {
        Ok(())
    }

    fn checkpoints(&self, job: &Job) -> Checkpoints {
        Checkpoints::beside(
            &PathBuf::from("nowhere").join(&job.id),
            Duration::from_mins(1),
        )
    }
}

/// What another process has begun is waited for, and run if that process leaves no result.
#[test]
fn jobs_made_elsewhere_are_waited_for_and_taken_over() {
    for leaves_result in [true, false] {
        let results = Shared {
            elsewhere: Some((1, leaves_result)),
            ..Shared::default()
        };
        let told = Mutex::new(Vec::new());
        let watch = |event: Event<'_>| {
            let (what, number) = match event {
                Event::Elsewhere(job) => ("elsewhere", job.seed),
                Event::Made(job) => ("made", job.seed),
                Event::Waiting(jobs) => ("waiting", jobs as u64),
                Event::Started(job) => ("started", job.seed),
                _ => return,
            };
            told.lock().unwrap().push((what, number));
        };
        let wishes = Wishes {
            watch: &watch,
            ..Wishes::default()
        };
        let jobs = sweep().jobs().unwrap();
        let report = Batch::new(&jobs, &results, wishes).run_on(&LocalThreads::new(1));
        assert_eq!(
            (report.left, report.elsewhere),
            (0, usize::from(leaves_result))
        );
        assert_eq!(report.finished, 4 - report.elsewhere);
        let last = if leaves_result { "made" } else { "started" };
        let expected = [
            ("elsewhere", 1),
            ("started", 2),
            ("started", 3),
            ("started", 4),
            ("waiting", 1),
            (last, 1),
        ];
        assert_eq!(*told.lock().unwrap(), expected);
    }
}

/// A backend need not tell how far a job is; what it tells is not counted twice.
#[test]
fn work_that_was_told_is_not_counted_again() {
    let left = Mutex::new(Vec::new());
    let watch = |event: Event<'_>| {
        if let Event::Finished(job, _, work) = event {
            left.lock().unwrap().push((job.seed, job.work() - work));
        }
    };
    let wishes = Wishes {
        watch: &watch,
        ..Wishes::default()
    };
    let backend = Each(|batch: &Batch<'_>, job: &Job| {
        let permit = permit(batch, job);
        match job.seed {
            1 => {}
            2 => batch.tell(Event::Advanced(job, 3)),
            _ => {
                batch.tell(Event::Resumed(job, 2));
                batch.tell(Event::Advanced(job, 1));
            }
        }
        permit.finish(&record(job));
        Ok(())
    });
    let jobs = sweep().jobs().unwrap();
    let report = Batch::new(&jobs, &Shared::default(), wishes).run_on(&backend);
    assert_eq!((report.finished, report.resumed), (4, 2));
    assert_eq!(*left.lock().unwrap(), [(1, 0), (2, 3), (3, 3), (4, 3)]);
}

/// A part of a batch may be run by another backend: jobs that were claimed are left out.
#[test]
fn two_backends_share_a_batch() {
    struct Both;

    impl Backend for Both {
        fn run(&self, batch: &Batch<'_>) -> Result<(), BackendError> {
            let fits = |job: &&&Job| job.seed.is_multiple_of(2);
            let ours = batch.jobs().iter().filter(fits);
            let permits: Vec<_> = ours.map(|job| permit(batch, job)).collect();
            LocalThreads::new(2).run(batch)?;
            work::each(2, &permits, |permit| {
                assert!(permit.job().seed.is_multiple_of(2));
            })
            .map_err(BackendError::new)?;
            for permit in permits {
                let made = record(permit.job());
                permit.finish(&made);
            }
            Ok(())
        }
    }
    let report = report_of(ErrorKind::Other, true, &Both);
    assert_eq!(
        (report.finished, report.failures.len(), report.left),
        (3, 1, 0)
    );
}
