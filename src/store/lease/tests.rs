use super::*;
use std::sync::Barrier;
use std::sync::atomic::AtomicBool;

/// So far apart that a busy machine does not take who lives to be dead.
const BEAT_HERE: Duration = Duration::from_millis(30);
const PATIENCE_HERE: Duration = Duration::from_secs(1);

/// The leases of a process on a machine of that name.
fn on(host: &str, clock: fn() -> SystemTime) -> Leases {
    let process = ProcessIdentity {
        host: host.to_owned(),
        system: Some(format!("the system of {host}")),
        ..ProcessIdentity::this().clone()
    };
    Leases::new(process, BEAT_HERE, PATIENCE_HERE, clock)
}

fn days_ahead() -> SystemTime {
    SystemTime::now() + Duration::from_hours(1000)
}

fn days_behind() -> SystemTime {
    SystemTime::now() - Duration::from_hours(1000)
}

/// A lease whose holder was killed: its file stays as it was last touched.
fn killed(leases: Leases, path: &Path) {
    let lease = leases.take(path).unwrap().unwrap();
    drop(leases);
    std::mem::forget(lease);
}

fn files(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap();
    let name = |entry: io::Result<fs::DirEntry>| entry.unwrap().file_name();
    names
        .map(|entry| name(entry).into_string().unwrap())
        .collect()
}

#[test]
fn one_at_a_time_has_a_lease() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("0123");
    let path = folder.path().join("0123.lease");
    let first = Lease::take(&record).unwrap().unwrap();
    let holder: Holder = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    assert_eq!(&holder.process, ProcessIdentity::this());
    assert!(Lease::is_taken(&record));
    assert!(Lease::take(&record).unwrap().is_none());
    drop(first);
    assert!(!path.exists() && !Lease::is_taken(&record));
}

#[test]
fn a_dead_process_of_this_machine_has_none() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("0123");
    let mut dead = std::process::Command::new("true").spawn().unwrap();
    let number = dead.id();
    dead.wait().unwrap();
    let process = ProcessIdentity {
        number,
        ..ProcessIdentity::this().clone()
    };
    if process.system.is_none() {
        return;
    }
    killed(
        Leases::new(process, BEAT, PATIENCE, SystemTime::now),
        &file_of(&record),
    );
    assert!(!Lease::is_taken(&record));
    let lease = Lease::take(&record).unwrap();
    assert!(lease.is_some() && Lease::is_taken(&record));
    assert_eq!(files(folder.path()), ["0123.lease"]);
}

/// Two machines whose clocks differ by months, in both ways: who lives keeps the lease for longer
/// than the other's patience, and who is dead loses it, but not before.
#[test]
fn clocks_of_machines_may_differ() {
    for clocks in [
        [days_ahead, days_behind],
        [days_behind, days_ahead],
        [SystemTime::now, days_ahead],
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.lease");
        let first = on("first", clocks[0]);
        let second = on("second", clocks[1]);
        let lease = first.take(&path).unwrap().unwrap();
        let begun = Instant::now();
        while begun.elapsed() < 2 * PATIENCE_HERE {
            assert!(
                second.take(&path).unwrap().is_none(),
                "taken from who lives"
            );
            thread::sleep(BEAT_HERE / 3);
        }
        drop(lease);
        assert_eq!(second.tenure(&path).unwrap(), Tenure::Free);
        killed(first, &path);
        let begun = Instant::now();
        let lease = loop {
            if let Some(lease) = second.take(&path).unwrap() {
                break lease;
            }
            thread::sleep(BEAT_HERE / 3);
        };
        assert!(begun.elapsed() >= PATIENCE_HERE, "{:?}", begun.elapsed());
        assert_eq!(files(folder.path()), ["run.lease"]);
        drop(lease);
        assert!(files(folder.path()).is_empty());
    }
}

/// A holder that paused for so long that it lost its lease gives back nothing.
#[test]
fn who_lost_a_lease_leaves_it_to_its_new_holder() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.lease");
    let first = on("first", SystemTime::now);
    let lease = first.take(&path).unwrap().unwrap();
    lock(&first.held).clear();
    let second = on("second", SystemTime::now);
    let begun = Instant::now();
    let taken = loop {
        if let Some(lease) = second.take(&path).unwrap() {
            break lease;
        }
        assert!(begun.elapsed() < 20 * PATIENCE_HERE);
        thread::sleep(BEAT_HERE);
    };
    drop(lease);
    assert!(path.exists());
    assert!(first.take(&path).unwrap().is_none());
    drop(taken);
    assert!(!path.exists());
}

#[test]
fn watching_tells_who_lives() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.lease");
    let first = on("first", days_behind);
    let second = on("second", SystemTime::now);
    assert_eq!(second.watch(&path, &|_| panic!("free")), Tenure::Free);
    let lease = first.take(&path).unwrap().unwrap();
    let waited = AtomicBool::new(false);
    let wait = |_: &Holder| waited.store(true, Ordering::Relaxed);
    assert_eq!(
        second.watch(&path, &wait),
        Tenure::Held(Some(lease.holder.clone()))
    );
    assert!(waited.load(Ordering::Relaxed));
    let holder = lease.holder.clone();
    drop(lease);
    killed(first, &path);
    let Tenure::Stale(Some(dead)) = second.watch(&path, &wait) else {
        panic!("the holder is dead");
    };
    assert_eq!(dead.process, holder.process);
}

/// Whatever dead processes left behind, of many that want a lease at once exactly one has it, and
/// only its file remains.
#[test]
fn of_many_that_want_it_at_once_one_has_it() {
    let wanting: Vec<Leases> = (0..8)
        .map(|number| on(&format!("machine {number}"), SystemTime::now))
        .collect();
    for round in 0..8 {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.lease");
        // Nothing, a broken lease, and ones whose breakers died.
        for number in 0..round % 4 {
            killed(on("dead", SystemTime::now), &link(&path, number));
            // Nobody can read this one.
            if round % 3 == 0 {
                fs::write(link(&path, number), "left behind").unwrap();
            }
        }
        let start = Barrier::new(wanting.len());
        let is_over = AtomicBool::new(false);
        let leases: Vec<Lease> = thread::scope(|scope| {
            let threads: Vec<_> = wanting
                .iter()
                .map(|leases| {
                    let (start, is_over, path) = (&start, &is_over, &path);
                    scope.spawn(move || {
                        start.wait();
                        let mut taken = None;
                        while !is_over.load(Ordering::Relaxed) && taken.is_none() {
                            taken = leases.take(path).unwrap();
                            thread::sleep(Duration::from_millis(1));
                        }
                        if taken.is_some() {
                            // The others go on trying for a while.
                            thread::sleep(PATIENCE_HERE);
                            is_over.store(true, Ordering::Relaxed);
                        }
                        taken
                    })
                })
                .collect();
            let taken = threads.into_iter().map(|it| it.join().unwrap());
            taken.flatten().collect()
        });
        assert_eq!(leases.len(), 1, "{round}");
        assert_eq!(files(folder.path()), ["run.lease"], "{round}");
    }
}

/// Symptom: a process that was killed between making a lease and writing it left an empty file,
/// which nobody broke for two minutes of each process's own time. A lease appears whole.
#[test]
fn a_lease_appears_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.lease");
    let is_over = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            while !is_over.load(Ordering::Relaxed) {
                if let Ok(text) = fs::read(&path) {
                    let holder: Result<Holder, _> = serde_json::from_slice(&text);
                    assert!(holder.is_ok(), "{text:?}");
                }
            }
        });
        let leases = on("first", SystemTime::now);
        for _ in 0..2000 {
            drop(leases.take(&path).unwrap().unwrap());
        }
        is_over.store(true, Ordering::Relaxed);
    });
    assert!(files(folder.path()).is_empty());
}

/// A file that says nothing is taken to be stale after a while, too.
#[test]
fn what_cannot_be_read_is_watched_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.lease");
    fs::write(&path, "").unwrap();
    let leases = on("first", SystemTime::now);
    assert_eq!(leases.watch(&path, &|_| {}), Tenure::Stale(None));
    assert!(leases.take(&path).unwrap().is_some());
}

#[test]
fn names_of_leases_are_known_from_their_files() {
    for (file, name) in [
        ("0123.lease", Some("0123")),
        ("0123.lease.2", Some("0123")),
        ("0123.lease.h5", None),
        ("0123.h5", None),
    ] {
        assert_eq!(Lease::name_of(file), name, "{file}");
    }
}

/// Symptom: one of two processes that began a sweep at once ended with "No such file or directory".
/// Cause: the other one, alone in the folder, removed its unfinished lease with what killed
/// processes had left behind.
#[test]
fn who_cleans_up_does_not_fail_who_takes_a_lease() {
    let folder = tempfile::tempdir().unwrap();
    let done = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            while !done.load(Ordering::Relaxed) {
                crate::store::remove_leftovers(folder.path()).unwrap();
            }
        });
        for number in 0..500 {
            let taken = Lease::take(&folder.path().join(number.to_string()));
            let found = taken.map(|it| it.is_some());
            if !matches!(found, Ok(true)) {
                done.store(true, Ordering::Relaxed);
                panic!("{number}: {found:?}");
            }
        }
        done.store(true, Ordering::Relaxed);
    });
}
