//! What browsers show: SVG pictures, and a page that plays a run.
//!
//! The script of a page is tried with node. Where it is absent the test says that it was skipped;
//! with `PHASE_NEED_READERS=1` in the environment it fails.

use crate::support::{Workplace, scene_file, silo_file};
use base64::Engine as _;
use phase::observe::Snapshot;
use phase::record::RunRecord;
use phase::store::read_record;
use std::io::Write as _;
use std::path::Path;
use std::process::Command;

fn silo(more: &[&str]) -> (Workplace, RunRecord) {
    let place = Workplace::new();
    place.write("silo.toml", &silo_file());
    let arguments = ["run", "silo.toml", "--out", "run.h5"];
    place.phase(&[&arguments[..], more].concat()).code(0);
    let record = read_record(&place.path("run.h5")).unwrap();
    (place, record)
}

fn tank() -> (Workplace, RunRecord) {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(0);
    let record = read_record(&place.path("run.h5")).unwrap();
    (place, record)
}

/// The spheres that are in.
fn inside(state: &Snapshot) -> Vec<usize> {
    let spheres = 0..state.position.nrows();
    spheres
        .filter(|&sphere| !state.position[[sphere, 0]].is_nan())
        .collect()
}

/// Centres and radii (x, z, r) of the circles of a group, as they are on the screen: x to the right
/// and z up, in the units of the view box.
fn circles(document: &str, group: &str) -> Vec<[f64; 3]> {
    let Some((_, rest)) = document.split_once(&format!("<g id=\"{group}\"")) else {
        return Vec::new();
    };
    let (group, _) = rest.split_once("</g>").unwrap();
    let circles = group.split("<circle ").skip(1);
    let number = |circle: &str, name: &str| -> f64 {
        let (_, rest) = circle.split_once(&format!("{name}=\"")).unwrap();
        rest.split_once('"').unwrap().0.parse().unwrap()
    };
    circles
        .map(|it| [number(it, "cx"), -number(it, "cy"), number(it, "r")])
        .collect()
}

#[track_caller]
fn same(found: &[[f64; 3]], expected: &[[f64; 3]]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        for (a, b) in found.iter().zip(expected) {
            assert!((a - b).abs() <= 5.1e-5, "{found:?} {expected:?}");
        }
    }
}

#[test]
fn svg_shows_what_is_in_to_scale() {
    let (place, record) = silo(&[]);
    place
        .phase(&["export", "run.h5", "--to", "svg", "--out", "out"])
        .code(0)
        .says("out/run");
    assert_eq!(
        std::fs::read_dir(place.path("out/run")).unwrap().count(),
        19
    );
    let fixed = record.scene.dem.geometry.as_ref().unwrap().spheres();
    let plain = |it: &phase::scene::FixedSphere| [it.position[0], it.position[2], it.radius];
    let walls: Vec<_> = fixed.walls.iter().map(plain).collect();
    let door: Vec<_> = fixed.door.iter().map(plain).collect();
    let mut boxes = Vec::new();
    for (frame, state) in record.snapshots.iter().enumerate() {
        let document = place.read(&format!("out/run/frame_{frame:05}.svg"));
        let tree = resvg::usvg::Tree::from_str(&document, &resvg::usvg::Options::default());
        let size = tree.unwrap().size();
        // All of them have one size, with the proportions of the view box.
        let (_, rest) = document.split_once("viewBox=\"").unwrap();
        let (view, _) = rest.split_once('"').unwrap();
        let view: Vec<f64> = view.split(' ').map(|it| it.parse().unwrap()).collect();
        let ratio = f64::from(size.width() / size.height()) / (view[2] / view[3]);
        assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
        let grains: Vec<_> = inside(state)
            .into_iter()
            .map(|i| {
                [
                    state.position[[i, 0]],
                    state.position[[i, 2]],
                    record.radius[i],
                ]
            })
            .collect();
        same(&circles(&document, "grains"), &grains);
        same(&circles(&document, "walls"), &walls);
        let is_open = state.time >= 1.83;
        same(
            &circles(&document, "door"),
            if is_open { &[] } else { &door },
        );
        for [x, z, r] in grains {
            assert!(x - r > view[0] && x + r < view[0] + view[2]);
            assert!(-z - r > view[1] && -z + r < view[1] + view[3]);
        }
        let time = (state.time * 1e6).round() / 1e6;
        let title = format!("<title>Small &lt;silo&gt; &amp; more, t = {time} s</title>");
        assert!(document.contains(&title), "{title}");
        boxes.push(view);
    }
    boxes.dedup();
    assert_eq!(boxes.len(), 1);
    let document = place.read("out/run/frame_00010.svg");
    assert!(
        document.contains("12 grains are in, 0 have left, 0 are still to come; the door is open")
    );
    for [group, color] in [["walls", "#d02b2b"], ["grains", "#3f7fd0"]] {
        assert!(document.contains(&format!("<g id=\"{group}\" fill=\"{color}\"")));
    }

    // Fewer would leave frames that belong to another time.
    let fewer = [
        "export", "run.h5", "--to", "svg", "--out", "out", "--every", "2",
    ];
    place
        .phase(&fewer)
        .code(2)
        .complains("frame_00010.svg: this frame is left over");
}

#[test]
fn svg_of_a_tank_is_its_view_from_the_side() {
    let (place, record) = tank();
    place.phase(&["export", "run.h5", "--to", "svg"]).code(0);
    let document = place.read("run/frame_00002.svg");
    let state = &record.snapshots[2];
    let mut spheres: Vec<usize> = (0..8).collect();
    // Those in front, where y is low, are drawn last.
    spheres.sort_by(|&a, &b| state.position[[b, 1]].total_cmp(&state.position[[a, 1]]));
    let expected: Vec<_> = spheres
        .into_iter()
        .map(|i| {
            [
                state.position[[i, 0]],
                state.position[[i, 2]],
                record.radius[i],
            ]
        })
        .collect();
    same(&circles(&document, "grains"), &expected);
    let (_, path) = document.split_once("<path id=\"tank\" d=\"").unwrap();
    assert!(path.starts_with("M-0.03 0L-0.03 -"), "{path}");
    assert!(document.contains("L0.03 0\""));
}

/// What the script of a page is told.
fn told(page: &str) -> serde_json::Value {
    let (_, rest) = page
        .split_once("<script type=\"application/json\" id=\"run\">")
        .unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

/// A second decoder of the positions of a page, which knows nothing of the script's: the spheres
/// that are in, with their coordinates (quanta), for every state.
fn decoded(run: &serde_json::Value) -> Vec<Vec<(usize, Vec<i64>)>> {
    let text = run["positions"].as_str().unwrap();
    let bytes = base64::engine::general_purpose::STANDARD
        .decode(text)
        .unwrap();
    let mut bytes = bytes.into_iter();
    let mut number = || {
        let mut value = 0_u64;
        for shift in (0..).step_by(7) {
            let byte = bytes.next().unwrap();
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                break;
            }
        }
        value
    };
    let axes = run["axes"].as_u64().unwrap() as usize;
    let mut places = std::collections::BTreeMap::<usize, Vec<i64>>::new();
    let mut states = Vec::new();
    for _ in run["times"].as_array().unwrap() {
        for comes in [true, false] {
            let mut sphere = 0;
            for _ in 0..number() {
                sphere += number() as usize;
                if comes {
                    assert!(places.insert(sphere, vec![0; axes]).is_none());
                } else {
                    assert!(places.remove(&sphere).is_some());
                }
            }
        }
        let mut zeros = 0;
        for coordinate in places.values_mut().flatten() {
            if zeros > 0 {
                zeros -= 1;
                continue;
            }
            let value = number();
            *coordinate += (value >> 1) as i64 ^ -((value & 1) as i64);
            if value == 0 {
                zeros = number();
            }
        }
        assert_eq!(zeros, 0);
        states.push(places.clone().into_iter().collect());
    }
    assert_eq!(bytes.next(), None);
    states
}

/// That a page holds the states of a record to within half a quantum; returns what it tells.
fn check(page: &str, record: &RunRecord) -> serde_json::Value {
    let run = told(page);
    let quantum = run["quantum"].as_f64().unwrap();
    let axes = [0, 2, 1];
    let states = decoded(&run);
    assert_eq!(states.len(), record.states().all().len());
    for (found, state) in states.iter().zip(record.states().all()) {
        let spheres: Vec<usize> = found.iter().map(|(sphere, _)| *sphere).collect();
        assert_eq!(spheres, inside(state));
        for (sphere, place) in found {
            for (axis, value) in axes.iter().zip(place) {
                let expected = state.position[[*sphere, *axis]];
                assert!((*value as f64 * quantum - expected).abs() < 0.5001 * quantum);
            }
        }
    }
    run
}

#[test]
fn a_page_holds_the_whole_run() {
    let (place, record) = silo(&["--snapshot-interval", "0.05"]);
    place
        .phase(&["export", "run.h5", "--to", "page"])
        .code(0)
        .says("run.html");
    let page = place.read("run.html");
    assert!(
        page.starts_with("<!doctype html>")
            && page.contains("<title>Small &lt;silo&gt; &amp; more</title>")
    );
    let run = check(&page, &record);
    assert_eq!((&run["axes"], &run["quantum"]), (&2.into(), &1e-4.into()));
    assert_eq!(run["title"], "Small <silo> & more");
    assert_eq!(run["opened"], 1.83);
    let names = ["filled", "at rest", "door opened", "emptied"];
    let milestones = run["milestones"].as_array().unwrap();
    assert!(milestones.iter().map(|it| &it[0]).eq(names.iter()));
    let released = &record.observations.released;
    let told: Vec<f32> = run["released"]
        .as_array()
        .unwrap()
        .iter()
        .map(|it| it.as_f64().unwrap() as f32)
        .collect();
    assert_eq!(&told, released);
    // A page is written anew, anything else stays.
    place.phase(&["export", "run.h5", "--to", "page"]).code(0);
    place.write("run.html", "mine");
    place
        .phase(&["export", "run.h5", "--to", "page"])
        .code(2)
        .complains("run.html: this is not a page of a run");
}

#[test]
fn a_page_of_a_tank_has_three_coordinates() {
    let (place, record) = tank();
    place.phase(&["export", "run.h5", "--to", "page"]).code(0);
    let run = check(&place.read("run.html"), &record);
    assert_eq!((&run["axes"], &run["quantum"]), (&3.into(), &1e-5.into()));
    assert_eq!(run["lines"].as_array().unwrap().len(), 3);
}

/// Whether there is node; says so if not.
fn node() -> bool {
    if Command::new("node").arg("--version").output().is_ok() {
        return true;
    }
    let required = std::env::var_os("PHASE_NEED_READERS").is_some();
    assert!(!required, "node is needed but absent");
    // Not eprintln!, which the test runner hides.
    let message = b"SKIPPED a check of pages: node is absent\n";
    std::io::stderr().write_all(message).unwrap();
    false
}

#[test]
fn the_script_of_a_page_plays_it() {
    if !node() {
        return;
    }
    for (place, record) in [silo(&[]), tank()] {
        place.phase(&["export", "run.h5", "--to", "page"]).code(0);
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/read_page.js");
        let page = place.path("run.html");
        let output = Command::new("node").args([script, page]).output().unwrap();
        let complaint = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{complaint}");
        let run = told(&place.read("run.html"));
        let quantum = run["quantum"].as_f64().unwrap();
        let lines = String::from_utf8(output.stdout).unwrap();
        let states = decoded(&run);
        assert_eq!(lines.lines().count(), record.snapshots.len());
        for (line, expected) in lines.lines().zip(states) {
            let line: serde_json::Value = serde_json::from_str(line).unwrap();
            let (spheres, places): (Vec<_>, Vec<_>) = expected.into_iter().unzip();
            assert_eq!(line["index"], serde_json::json!(spheres));
            let places = places.into_iter().flatten();
            let places: Vec<f64> = places.map(|quanta| quanta as f64 * quantum).collect();
            assert_eq!(line["place"], serde_json::json!(places));
        }
    }
}
