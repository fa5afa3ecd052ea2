//! Scene and sweep files: the shipped ones load, the good ones load, the bad ones give exactly the
//! message that they carry.
#[test]
fn x() {
    for f in std::fs::read_dir("sweeps").unwrap() {
        let p = f.unwrap().path();
        if p.is_dir() {
            continue;
        }
        let t = std::time::Instant::now();
        let r = phase::sweep::load(&p);
        println!("{} {:?}", p.display(), t.elapsed());
        match r {
            Ok(s) => {
                let t = std::time::Instant::now();
                let j = s.jobs().unwrap();
                println!("{} jobs {:?}", j.len(), t.elapsed());
                for l in phase::dem::timestep::limits(&s.scene) {
                    println!("{} {:.3e} {}", l.name, l.seconds, l.decisive);
                }
            }
            Err(e) => println!("error: {e}"),
        }
    }
}
