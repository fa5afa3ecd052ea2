//! Files that are read.

use super::{MOST, data, owned, read_bytes};
use phase::scene::TableFormat::{self, Csv, LammpsAverage, LammpsLog, Numpy, Text};

const NAN: f64 = f64::NAN;
const INFINITY: f64 = f64::INFINITY;

type Names<'c> = &'c [&'c str];
type Columns<'c> = &'c [&'c [f64]];

/// A text, the names that are given, and those and the columns that are read.
type Case<'c> = (&'c str, Names<'c>, Names<'c>, Columns<'c>);

/// The columns, in a form in which NaN is equal to itself.
fn check(text: &[u8], format: TableFormat, given: &[&str], names: &[&str], columns: &[&[f64]]) {
    let shown = String::from_utf8_lossy(text);
    let table = read_bytes("file", text, format, given, MOST);
    let table = table.unwrap_or_else(|error| panic!("{error}\n{shown}"));
    assert_eq!(table.names, owned(names), "{shown}");
    assert_eq!(
        format!("{:?}", table.columns),
        format!("{columns:?}"),
        "{shown}"
    );
    assert_eq!(table.rows(), columns[0].len());
    assert_eq!(table.column("no such column"), None);
}

#[test]
fn csv() {
    let cases: &[Case<'_>] = &[
        (
            "t,e\n0,1\n1,2.5\n",
            &[],
            &["t", "e"],
            &[&[0.0, 1.0], &[1.0, 2.5]],
        ),
        (
            "t,e\n0,1\n1,2.5",
            &[],
            &["t", "e"],
            &[&[0.0, 1.0], &[1.0, 2.5]],
        ),
        (
            "\u{feff}t,e\r\n0,1\r\n\r\n1,2\r\n",
            &[],
            &["t", "e"],
            &[&[0.0, 1.0], &[1.0, 2.0]],
        ),
        (
            "# by x\nt , e\n# so far\n 0 , -1e-3 \n",
            &[],
            &["t", "e"],
            &[&[0.0], &[-1e-3]],
        ),
        (
            "\"t, s\", \"e\"\n\"0\",1\n",
            &["given", "names"],
            &["t, s", "e"],
            &[&[0.0], &[1.0]],
        ),
        (
            "t,e\n,nan\nNaN,inf\n-inf,-nan\n",
            &[],
            &["t", "e"],
            &[&[NAN, NAN, -INFINITY], &[NAN, INFINITY, NAN]],
        ),
        (
            "0,1\n2,3\n",
            &["t", "e"],
            &["t", "e"],
            &[&[0.0, 2.0], &[1.0, 3.0]],
        ),
        (
            "# made by x\n\n# t,e\n0,1\n",
            &[],
            &["t", "e"],
            &[&[0.0], &[1.0]],
        ),
        (
            "# made by x\n0,1\n",
            &["t", "e"],
            &["t", "e"],
            &[&[0.0], &[1.0]],
        ),
        ("kinetic energy\n7\n", &[], &["kinetic energy"], &[&[7.0]]),
        (
            ",,e\n0,1,2\n",
            &[],
            &["", "", "e"],
            &[&[0.0], &[1.0], &[2.0]],
        ),
        ("t,2\n0,1\n", &[], &["t", "2"], &[&[0.0], &[1.0]]),
    ];
    for (text, given, names, columns) in cases {
        check(text.as_bytes(), Csv, given, names, columns);
    }
}

#[test]
fn text() {
    let cases: &[Case<'_>] = &[
        (
            "# t e\n0 1\n1 2\n",
            &[],
            &["t", "e"],
            &[&[0.0, 1.0], &[1.0, 2.0]],
        ),
        (
            "#t e\n\n0\t1\r\n\n\n1 2",
            &[],
            &["t", "e"],
            &[&[0.0, 1.0], &[1.0, 2.0]],
        ),
        (
            "# by x\n# t e\n#\n  0 1 # so\n# 1 2\n",
            &[],
            &["t", "e"],
            &[&[0.0], &[1.0]],
        ),
        ("t e\n0 nan\n", &["a", "b"], &["t", "e"], &[&[0.0], &[NAN]]),
        (
            "# written by x on a day\n0 1\n",
            &["t", "e"],
            &["t", "e"],
            &[&[0.0], &[1.0]],
        ),
        ("7\n8", &["t"], &["t"], &[&[7.0, 8.0]]),
    ];
    for (text, given, names, columns) in cases {
        check(text.as_bytes(), Text, given, names, columns);
    }
}

/// Files of NumPy 2 and pandas 3.
#[test]
fn python() {
    let (time, energy) = (
        &[0.0, 0.1, 0.2, 0.30000000000000004][..],
        &[1.5, -2.25, NAN, INFINITY],
    );
    let short = &[0.0, 0.1, 0.2, 0.3][..];
    let count = &[1.0, 2.0, 3.0, 4.0][..];
    let row = &[0.0, 1.0, 2.0, 3.0][..];
    let both = &["time", "energy"][..];
    let cases: &[(&str, TableFormat, Names<'_>, Names<'_>, Columns<'_>)] = &[
        ("savetxt.csv", Csv, &[], both, &[time, energy]),
        (
            "pandas.csv",
            Csv,
            &[],
            &["", "time", "energy"],
            &[row, time, energy],
        ),
        ("savetxt.txt", Text, &[], both, &[time, energy]),
        ("pandas.txt", Text, &[], both, &[short, energy]),
        ("one.npy", Numpy, &["energy"], &["energy"], &[energy]),
        ("rows.npy", Numpy, both, both, &[time, energy]),
        ("fortran.npy", Numpy, both, both, &[time, energy]),
        (
            "stored.npz",
            Numpy,
            &["x"],
            &["time", "energy", "count"],
            &[time, energy, count],
        ),
        (
            "packed.npz",
            Numpy,
            &[],
            &["time", "energy", "count"],
            &[time, energy, count],
        ),
    ];
    for (file, format, given, names, columns) in cases {
        check(&data(file), *format, given, names, columns);
    }
    for (kind, middle) in [
        ("f4", 3.0),
        ("f8", 3.0),
        ("i2", 3.0),
        ("i8", 3.0),
        ("u1", 3.0),
        ("b1", 1.0),
    ] {
        let bytes = data(&format!("type-{kind}.npy"));
        check(&bytes, Numpy, &["n"], &["n"], &[&[1.0, 0.0, middle]]);
    }
}

#[test]
fn ave_time() {
    let table = read_bytes("a", &data("average.txt"), LammpsAverage, &["x"], MOST).unwrap();
    assert_eq!(table.names, ["TimeStep", "c_t", "v_two"]);
    let steps: Vec<f64> = (1..=8).map(|it| f64::from(it) * 50.0).collect();
    assert_eq!(table.column("TimeStep"), Some(&steps[..]));
    assert_eq!(table.columns[2][..3], [1.58546, 1.5671, 1.47593]);
    let table = read_bytes("a", &data("granular.txt"), LammpsAverage, &[], MOST).unwrap();
    assert_eq!((table.rows(), table.columns[2][14]), (15, 0.000470412));
    // Two runs that append to one file.
    let text = "# Time-averaged data for fix a\n# TimeStep c_t\n5 1\n".repeat(2);
    check(
        text.as_bytes(),
        LammpsAverage,
        &[],
        &["TimeStep", "c_t"],
        &[&[5.0; 2], &[1.0; 2]],
    );
}

#[test]
fn thermo() {
    let table = read_bytes("a", &data("two-runs.log"), LammpsLog, &[], MOST).unwrap();
    assert_eq!(
        table.names,
        ["Step", "Temp", "E_pair", "E_mol", "TotEng", "Press"]
    );
    let steps: Vec<f64> = (0..=6).map(|it| f64::from(it) * 50.0).collect();
    assert_eq!(table.column("Step"), Some(&steps[..]));
    let pressure = [
        -5.0309253,
        0.24891201,
        -0.4235712,
        0.33147872,
        0.069537898,
        -0.15529275,
    ];
    assert_eq!(table.columns[5][..6], pressure);
    let table = read_bytes("a", &data("granular.log"), LammpsLog, &[], MOST).unwrap();
    assert_eq!(table.names, ["Step", "Time", "Atoms", "c_k", "c_r"]);
    assert_eq!((table.rows(), table.columns[3][15]), (16, 0.00096668989));
}

/// Lines between rows, a restart of the steps, names as new versions place them, no final line end,
/// and a comment of the input in Latin-1.
#[test]
fn thermo_with_other_lines() {
    let text = b"# Schr\xf6dinger\nStep by step\nPer MPI rank memory allocation (min) = 3 Mbytes\n\
        WARNING: Too few (../thermo.cpp:1)\n   Step          v_x     \n         0   1\n\
        WARNING: Bond stretched (../x.cpp:9)\nFor more see https://docs.lammps.org/err1\n\
        Fix halt condition for fix-id 5 met on step 10\n        10   -nan\nLoop time of 1 on 1\n\n\
        reset_timestep 0\nMemory usage per processor = 3 Mbytes\nStep v_x\n0 3\n0 4\n\
        Loop time of 2";
    check(
        text,
        LammpsLog,
        &[],
        &["Step", "v_x"],
        &[&[0.0, 10.0, 0.0, 0.0], &[1.0, NAN, 3.0, 4.0]],
    );
    let text = b"Per MPI rank memory allocation\nv_x\n1\nLoop time of 1\n\
        Per MPI rank memory allocation\nv_x\n1\nLoop time of 1\n";
    check(text, LammpsLog, &[], &["v_x"], &[&[1.0, 1.0]]);
}

#[test]
fn a_file_of_the_most_bytes_is_read() {
    let text = b"t\n1\n";
    assert!(read_bytes("a.csv", text, Csv, &[], 4).is_ok());
    assert!(read_bytes("a.csv", text, Csv, &[], 3).is_err());
}
