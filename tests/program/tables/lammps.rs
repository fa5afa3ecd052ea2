//! Files of LAMMPS that are refused, and how.

use super::bad::{Case, check};
use super::data;
use phase::scene::TableFormat::{self, LammpsAverage, LammpsLog};

/// Checks the messages of files in `tests/data`.
fn check_data(format: TableFormat, cases: &[(&str, &str)]) {
    for (name, expected) in cases {
        check(format, &[(name, &data(name), &[], expected)]);
    }
}

const THERMO_FILES: &[(&str, &str)] = &[
    (
        "killed.log",
        ":17: the log ends within a run, without a line `Loop time of ...`; LAMMPS was stopped \
         or still computes: let it come to its end",
    ),
    (
        "lost-atoms.log",
        ":11: LAMMPS failed: \"ERROR: Lost atoms: original 108 current 0 (src/thermo.cpp:439)\"; \
         correct the input of LAMMPS and run it again",
    ),
    (
        "multi.log",
        ":9: this run has the thermo style `multi`, which is not read; write `thermo_style \
         custom` and `thermo_modify line one` in the input",
    ),
    (
        "other-columns.log",
        ":27: run 3 of the log has the columns \"Step\", \"Temp\", \"PotEng\", but those before \
         have \"Step\", \"Temp\", \"E_pair\", \"E_mol\", \"TotEng\", \"Press\"; keep one \
         `thermo_style` for all runs, or write a log for each",
    ),
    (
        "average.txt",
        ": it has no run: no line begins with `Per MPI rank memory allocation`; give the whole \
         log of LAMMPS, not a part of it",
    ),
];

const THERMO: &[Case<'_>] = &[
    (
        "yaml.log",
        b"Memory usage per processor\n---\nkeywords: ['Step']\ndata:\n  - [0]\n",
        &[],
        ":2: this run has the thermo style `yaml`, which is not read; write `thermo_style \
         custom` and `thermo_modify line one` in the input",
    ),
    (
        "empty.log",
        b"",
        &[],
        ": it has no run: no line begins with `Per MPI rank memory allocation`; give the whole \
         log of LAMMPS, not a part of it",
    ),
    (
        "no-loop-time.log",
        b"Memory usage per processor\nStep v_x\n0 1\n",
        &[],
        ":3: the log ends within a run, without a line `Loop time of ...`; LAMMPS was stopped or \
         still computes: let it come to its end",
    ),
    (
        "no-names.log",
        b"Memory usage per processor\n",
        &[],
        ":1: the log ends within a run, without a line `Loop time of ...`; LAMMPS was stopped or \
         still computes: let it come to its end",
    ),
    (
        "long-row.log",
        b"Memory usage per processor\nStep v_x\n0 1 2\n",
        &[],
        ":3: this row has 3 entries, but the table has 2 columns; give every row one entry for \
         each column",
    ),
    (
        "word.log",
        b"Memory usage per processor\nStep v_x\n0 1\n1 a1\n",
        &[],
        ":4: \"a1\" in the column \"v_x\" is no number; write a number, or nan where there is none",
    ),
    (
        "no-rows.log",
        b"Memory usage per processor\nStep v_x\nLoop time of 1\n",
        &[],
        ": it has no rows; check whether the program ran long enough to write one",
    ),
    (
        "begun-again.log",
        b"Memory usage per processor\nStep v_x\n0 1\nMemory usage per processor\n",
        &[],
        ":4: a run begins before the last one has its `Loop time of`; give the log of one \
         LAMMPS, which ran to its end",
    ),
    (
        "shortened.log",
        b"Memory usage per processor\n0 1\nLoop time of 1\n",
        &[],
        ":2: the names of columns should be here, but \"0\" is; give the log as LAMMPS wrote it",
    ),
    (
        "twice.log",
        b"Memory usage per processor\nStep Temp Temp\n0 1 1\nLoop time of 1\n",
        &[],
        ":2: two columns have the name \"Temp\"; give each column a name of its own",
    ),
];

#[test]
fn thermo() {
    check_data(LammpsLog, THERMO_FILES);
    check(LammpsLog, THERMO);
}

const AVE_TIME_FILES: &[(&str, &str)] = &[
    (
        "vector.txt",
        ":2: this file is one of `fix ave/time` with `mode vector`, which has a block of rows \
         per step; use `mode scalar` and name single entries, such as c_1[2]",
    ),
    (
        "histogram.txt",
        ":1: this file is one of `fix ave/histo`, which has a block of rows per step; write what \
         you need as a scalar, such as c_1[2], with `fix ave/time`",
    ),
    (
        "correlation.txt",
        ":1: this file is one of `fix ave/correlate`, which has a block of rows per step; write \
         what you need as a scalar, such as c_1[2], with `fix ave/time`",
    ),
    (
        "two-runs.log",
        ":1: \"LAMMPS (29 Sep 2021 - Update 2)\" stands before `# TimeStep` and the names of \
         columns; leave out `title2` of `fix ave/time`, or say the format `text`",
    ),
];

const AVE_TIME: &[Case<'_>] = &[
    (
        "chunk.txt",
        b"# Chunk-averaged data for fix b and group all\n# Timestep Number-of-chunks\n",
        &[],
        ":1: this file is one of `fix ave/chunk`, which has a block of rows per step; write what \
         you need as a scalar, such as c_1[2], with `fix ave/time`",
    ),
    (
        "empty.txt",
        b"",
        &[],
        ": it has no rows; check whether the program ran long enough to write one",
    ),
    (
        "no-names.txt",
        b"0 1\n",
        &[],
        ":1: \"0 1\" stands before `# TimeStep` and the names of columns; leave out `title2` of \
         `fix ave/time`, or say the format `text`",
    ),
    (
        "other-title.txt",
        b"# mean\n# step v\n1 2\n",
        &[],
        ":3: \"1 2\" stands before `# TimeStep` and the names of columns; leave out `title2` of \
         `fix ave/time`, or say the format `text`",
    ),
    (
        "a.yaml",
        b"---\nkeywords: [",
        &[],
        ":1: this file is YAML, which LAMMPS writes if the file is named so; give the file of \
         `fix ave/time` a name without .yaml",
    ),
    (
        "unfinished.txt",
        b"# TimeStep c_t v_two\n50 0.79 1.5\n100 0.7",
        &[],
        ":3: the last line is unfinished: it has 2 of 3 entries; the program was stopped while \
         it wrote: run it again, or remove this line",
    ),
    (
        "cut-number.txt",
        b"# TimeStep c_t\n50 0.79\n100 0.7",
        &[],
        ":3: the last line has no line end, so that its last number may be cut short; the \
         program was stopped while it wrote: run it again, or remove this line",
    ),
    (
        "word.txt",
        b"# TimeStep c_t\n50 x\n",
        &[],
        ":2: \"x\" in the column \"c_t\" is no number; write a number, or nan where there is none",
    ),
    (
        "no-rows.txt",
        b"# TimeStep c_t\n",
        &[],
        ": it has no rows; check whether the program ran long enough to write one",
    ),
    (
        "other-names.txt",
        b"# TimeStep c_t\n1 2\n# TimeStep c_u\n2 3\n",
        &[],
        ":3: the columns become \"TimeStep\", \"c_u\" here, but were \"TimeStep\", \"c_t\" \
         before; write every run to a file of its own",
    ),
];

#[test]
fn ave_time() {
    check_data(LammpsAverage, AVE_TIME_FILES);
    check(LammpsAverage, AVE_TIME);
}
