//! Patterns of the names of dumps.

use super::dumps::{rows, swept_and_exported};
use phase::store::DumpName;
use phase::sweep::NamePattern;
use proptest::prelude::*;

#[test]
fn patterns_that_are_not_clear_are_refused() {
    for (pattern, expected) in [
        (
            "dump.npy",
            "it has no mark of a value; write marks where the values are, such as \
             `@{spheres.radius}`",
        ),
        (
            "@@{radius}_@{name}.npy",
            "it has no mark of a value; write marks where the values are, such as \
             `@{spheres.radius}`",
        ),
        (
            "r@{radius}_r@{radius}.npy",
            "it has `@{radius}` twice; leave one of them out",
        ),
        (
            "r@{radius}@{density}.npy",
            "two marks have no text between them; write a text between them, such as `_`",
        ),
        (
            "r@{radius}[_s@{seed}]@{density}.npy",
            "two marks have no text between them; write a text between them, such as `_`",
        ),
        (
            "r@{radius}[@{seed}].npy",
            "two marks have no text between them; write a text between them, such as `_`",
        ),
        (
            "r@{radius}2d.npy",
            "the text `2d.npy` behind a mark could belong to its number; begin it with another \
             sign, such as `_`",
        ),
        (
            "r@{radius}.@{density}.npy",
            "the text `.` behind a mark could belong to its number; begin it with another sign, \
             such as `_`",
        ),
        (
            "r@{radius}e@{density}.npy",
            "the text `e` behind a mark could belong to its number; begin it with another sign, \
             such as `_`",
        ),
        (
            "r@{radius.npy",
            "the mark `@{radius.npy` has no end; write `}` behind its key",
        ),
        (
            "r@{radius}[_s@{seed}.npy",
            "it has a `[` without a `]` behind it; write what may be missing between `[` and `]`",
        ),
        (
            "r@{radius}_s@{seed}].npy",
            "it has a `]` without a `[` before it; write what may be missing between `[` and `]`",
        ),
        (
            "r@{radius}[_p@{density}].npy",
            "only a seed or a name may be missing; write `[_s@{seed}]` or `[_@{name}]`, and no \
             brackets around other marks",
        ),
        (
            "r@{radius}[_x].npy",
            "only a seed or a name may be missing; write `[_s@{seed}]` or `[_@{name}]`, and no \
             brackets around other marks",
        ),
        (
            "@{name}_r@{radius}.npy",
            "a mark stands behind `@{name}`, which is any text; make `@{name}` the last mark",
        ),
        (
            "r@{radius}.h5",
            "it does not end in `.npy` or `.npz`; write the whole name of a file of an array",
        ),
        (
            "r@{radius}",
            "it does not end in `.npy` or `.npz`; write the whole name of a file of an array",
        ),
    ] {
        let error = NamePattern::parse(pattern).unwrap_err();
        assert_eq!(error.to_string(), expected, "{pattern}");
    }
}

/// What a pattern reads of a name: values and seed.
fn read(pattern: &str, name: &str) -> Option<(Vec<f64>, u64)> {
    let run = NamePattern::parse(pattern).unwrap().read(name)?;
    Some((run.values, run.seed))
}

#[test]
fn names_say_values_and_seeds() {
    let of_thesis = NamePattern::OF_THESIS;
    let run = [0.003, 3750.0, 6.0];
    for (pattern, name, values, seed) in [
        (of_thesis, "dump_r00.003_p03750.0_f006.0.npy", &run[..], 1),
        (of_thesis, "dump_r0.003_p3750_f6.npy", &run, 1),
        (of_thesis, "dump_r3e-3_p3.75E+3_f+6_s12.npy", &run, 12),
        (
            of_thesis,
            "dump_r.003_p3750_f6_s1_as it was_s2.npy",
            &run,
            1,
        ),
        ("@{a}-@{b}.npz", "-5--6.npz", &[-5.0, -6.0], 1),
        ("@{a} m[-@{seed}][_@{name}].npy", "5 m-7.npy", &[5.0], 7),
        ("@{a} m[-@{seed}][_@{name}].npy", "5 m_7.npy", &[5.0], 1),
        ("@{a} m[-@{seed}][_@{name}].npy", "5 m.npy", &[5.0], 1),
        ("@@{@{a}}.npy", "@{5}.npy", &[5.0], 1),
        ("@{seed}.npy", "18446744073709551615.npy", &[], u64::MAX),
    ] {
        assert_eq!(read(pattern, name), Some((values.to_vec(), seed)), "{name}");
    }
    for name in [
        "dump_r00.00_p03750.0_f006.0.h5",
        "dump_r0.1_p1_fnan.npy",
        "dump_r0.1_p1_f1e999.npy",
        "dump_r0.1_p1_f.npy",
        "dump_r0.1_p1_f1..npy",
        "dump_r0.1_p1_f1_sx.npy",
        "dump_r0.1_p1_f1_s1_.npy",
        "dump_r0.1_p1_f1_s18446744073709551616.npy",
        "a dump_r0.1_p1_f1.npy",
        "position.npy",
    ] {
        assert_eq!(read(of_thesis, name), None, "{name}");
    }
}

fn number() -> impl Strategy<Value = f64> {
    any::<u64>()
        .prop_map(f64::from_bits)
        .prop_filter("a finite number", |it| it.is_finite())
}

proptest! {
    #[test]
    fn names_keep_every_bit(
        texts in prop::collection::vec("[_a-dx-z-][a-z0-9_-]{0,3}", 1..5),
        numbers in prop::collection::vec(number(), 4),
        seed in prop::option::of(any::<u64>()),
    ) {
        let (mut pattern, mut name) = (String::new(), String::new());
        for (place, text) in texts.iter().enumerate() {
            pattern += &format!("{text}@{{key{place}}}");
            name += &format!("{text}{:?}", numbers[place]);
        }
        pattern += "[_s@{seed}].npy";
        if let Some(seed) = seed {
            name += &format!("_s{seed}");
        }
        let (values, found) = read(&pattern, &format!("{name}.npy")).unwrap();
        let bits = |values: &[f64]| values.iter().map(|it| it.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&values), bits(&numbers[..texts.len()]));
        prop_assert_eq!(found, seed.unwrap_or(1));
    }

    #[test]
    fn names_of_exports_keep_every_bit(
        (radius, density, omega) in (1e-9..1e3, 1e-3..1e6, -1e6..1e6),
        seed: u64,
        run in prop::option::of("[a-z_0-9]{1,8}"),
    ) {
        let name = DumpName { radius, density, omega, seed, run }.to_string();
        let expected = Some((vec![radius, density, omega], seed));
        prop_assert_eq!(read(NamePattern::OF_THESIS, &name), expected);
    }

    #[test]
    fn any_text_is_a_pattern_or_refused(
        words in prop::collection::vec(prop::sample::select(&WORDS[..]), 0..12),
    ) {
        if let Ok(pattern) = NamePattern::parse(&(words.concat() + ".npy")) {
            let _ = pattern.read("_5_5_x.npy");
        }
    }
}

const WORDS: [&str; 9] = ["@{a}", "@{seed}", "@{name}", "[", "]", "_", "5", "@{", "."];

/// Dumps whose names are in an order and with numbers of their own, one of them in an archive.
#[test]
fn names_of_any_pattern_give_the_same_labels() {
    let place = swept_and_exported();
    let classify = |more: &[&str]| {
        place.phase(&[&["classify", "dumps", "--scene", "scene.toml"], more].concat())
    };
    classify(&["--sweep", "tiny.toml"]).code(0);
    let expected = rows(&place, "dumps/labels.csv", "omega");
    for entry in std::fs::read_dir(place.path("dumps")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        match NamePattern::parse(NamePattern::OF_THESIS)
            .unwrap()
            .read(name)
        {
            Some(run) => {
                let renamed = format!("seed {}, omega {}.npy", run.seed, run.values[2]);
                std::fs::rename(&path, path.with_file_name(renamed)).unwrap();
            }
            None => std::fs::remove_file(&path).unwrap(),
        }
    }
    let names = ["--names", "seed @{seed}, omega @{omega}.npy"];
    classify(&[&names[..], &["--sweep", "tiny.toml"]].concat())
        .code(0)
        .says("8 runs labelled");
    let found = rows(&place, "dumps/labels.csv", "omega");
    assert!(place.read("dumps/labels.csv").starts_with("id,omega,seed,"));
    assert!(found.keys().eq(expected.keys()));
    for (found, expected) in found.values().zip(expected.values()) {
        assert_eq!(found.verdict, expected.verdict, "{}", found.id);
    }

    classify(&[])
        .code(1)
        .complains("its name does not fit `dump_r@{spheres.radius}_p@{spheres.density}")
        .complains("give the pattern of the names with --names");
    classify(&["--names", "seed @{seed}, omega @{omgea}.npy"])
        .code(2)
        .complains("--names seed @{seed}, omega @{omgea}.npy: `omgea` is not a numeric key")
        .complains("did you mean `omega`?");
    classify(&["--names", "@{omega}_@{swirl.omega}.npy"])
        .code(2)
        .complains("two of its marks stand for `swirl.omega`; leave one of them out");
    classify(&["--names", "@{omega}.npz"])
        .code(2)
        .complains("holds no .npz files");
    place
        .phase(&["classify", "results/tiny", "--names", "@{omega}.npy"])
        .code(2)
        .complains("--scene");
}
