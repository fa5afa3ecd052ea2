//! Texts that are refused, and how.

use super::{MOST, read_bytes};
use phase::external::table::read;
use phase::scene::TableFormat::{self, Csv, Text};
use std::path::Path;

/// A name, the bytes and the names that are given, and the message without the name.
pub(crate) type Case<'c> = (&'c str, &'c [u8], &'c [&'c str], &'c str);

pub(crate) fn check(format: TableFormat, cases: &[Case<'_>]) {
    for (name, bytes, names, expected) in cases {
        let error = read_bytes(name, bytes, format, names, MOST).unwrap_err();
        assert_eq!(error.to_string(), format!("{name}{expected}"));
    }
}

const CSV: &[Case<'_>] = &[
    (
        "word.csv",
        b"t,m2\n0,1\n1,abc\n",
        &[],
        ":3: \"abc\" in the column \"m2\" is no number; write a number, or nan where there is none",
    ),
    (
        "comments.csv",
        b"# by x\r\n\r\nt,m2\r\n# so far\r\n\r\n0,1\r\n#\r\n1,-\r\n",
        &[],
        ":8: \"-\" in the column \"m2\" is no number; write a number, or nan where there is none",
    ),
    (
        "short.csv",
        b"t,e,k\n0,1,2\n1,2\n3,4,5\n",
        &[],
        ":3: this row has 2 entries, but the table has 3 columns; give every row one entry for \
         each column",
    ),
    (
        "long.csv",
        b"t\n0,1\n",
        &[],
        ":2: this row has 2 entries, but the table has 1 column; give every row one entry for \
         each column",
    ),
    (
        "unfinished.csv",
        b"t,e\n0,1\n1",
        &[],
        ":3: the last line is unfinished: it has 1 of 2 entries; the program was stopped while \
         it wrote: run it again, or remove this line",
    ),
    (
        "cut-number.csv",
        b"t,e\n0,1\n1,2.5e-",
        &[],
        ":3: \"2.5e-\" in the column \"e\" is no number; the program was stopped while it wrote: \
         run it again, or remove this line",
    ),
    (
        "no-names.csv",
        b"0,1\n1,2\n",
        &[],
        ":1: the file has no names for its 2 columns; write a line of names before this one, or \
         give `header = [...]` with one name for each column",
    ),
    (
        "one-name.csv",
        b"0,1\n1,2\n",
        &["t"],
        ":1: the file has 2 columns, but `header` lists 1 name; write a line of names before this \
         one, or give `header = [...]` with one name for each column",
    ),
    (
        "twice.csv",
        b"t,e,t\n0,1,2\n",
        &[],
        ":1: two columns have the name \"t\"; give each column a name of its own",
    ),
    (
        "given-twice.csv",
        b"0,1\n",
        &["t", "t"],
        ": two columns have the name \"t\"; give each column a name of its own",
    ),
    (
        "empty.csv",
        b"",
        &[],
        ": it is empty; write a line of names and rows, whose entries commas separate",
    ),
    (
        "only-comment.csv",
        b"# t,e",
        &[],
        ": it is empty; write a line of names and rows, whose entries commas separate",
    ),
    (
        "only-names.csv",
        b"t,e\n",
        &[],
        ": it has no rows; check whether the program ran long enough to write one",
    ),
    (
        "semicolons.csv",
        b"t;e\n0;1,5\n",
        &[],
        ":1: \";\" stands between these names instead of a comma; separate the entries by \
         commas, and write 0.5 with a point",
    ),
    (
        "tabs.csv",
        b"t\te\n0\t1\n",
        &[],
        ":1: \"\\t\" stands between these names instead of a comma; separate the entries by \
         commas, or say the format `text`",
    ),
    (
        "quote.csv",
        b"t,e\n0,\"1\n2,3\n",
        &[],
        ":2: a quotation mark that opens here does not close in its line; write the entry in one \
         line, with both quotation marks or without",
    ),
    (
        "comma.csv",
        b"t,e\n\"0,5\",1\n",
        &[],
        ":2: \"0,5\" in the column \"t\" is no number; write 0.5 with a point; if commas \
         separate the entries, the format is `csv`",
    ),
    (
        "latin.csv",
        b"t,e\n0,1\n\xb5,2\n",
        &[],
        ":3: this line is no text in UTF-8; save it as UTF-8, or say another format if it is no \
         text",
    ),
    (
        "hexadecimal.csv",
        b"t,e\n0x1F,1\n",
        &[],
        ":2: \"0x1F\" in the column \"t\" is no number; write a number, or nan where there is none",
    ),
];

#[test]
fn csv() {
    check(Csv, CSV);
}

const TEXT: &[Case<'_>] = &[
    (
        "word.txt",
        b"# t e\n0 1\n\n1 abc\n",
        &[],
        ":4: \"abc\" in the column \"e\" is no number; write a number, or nan where there is none",
    ),
    (
        "units.txt",
        b"t e\n[s] [J]\n0 1\n",
        &[],
        ":2: \"[s]\" in the column \"t\" is no number; write a number, or nan where there is none",
    ),
    (
        "short.txt",
        b"# t e\n0 1\n2\n3 4\n",
        &[],
        ":3: this row has 1 entry, but the table has 2 columns; give every row one entry for \
         each column",
    ),
    (
        "unfinished.txt",
        b"t e\n0 1\n2",
        &[],
        ":3: the last line is unfinished: it has 1 of 2 entries; the program was stopped while \
         it wrote: run it again, or remove this line",
    ),
    (
        "unfinished-at-once.txt",
        b"t e\n0",
        &[],
        ":2: the last line is unfinished: it has 1 of 2 entries; the program was stopped while \
         it wrote: run it again, or remove this line",
    ),
    (
        "no-names.txt",
        b"# done by x\n0 1\n",
        &[],
        ":2: the file has no names for its 2 columns; write them before the first row as `# time \
         energy`, or give `header = [...]` with one name for each column",
    ),
    (
        "other-names.txt",
        b"0 1\n",
        &["a", "b", "c"],
        ":1: the file has 2 columns, but `header` lists 3 names; write them before the first row \
         as `# time energy`, or give `header = [...]` with one name for each column",
    ),
    (
        "row-numbers.txt",
        b"   t  e\n0  1  2\n",
        &[],
        ":2: this row has 3 entries, but line 1 has 2 names; give each column one name without \
         spaces; to leave out row numbers, write `index=False` with pandas",
    ),
    (
        "spaces.txt",
        b"kinetic energy of all\n0 1\n",
        &[],
        ":2: this row has 2 entries, but line 1 has 4 names; give each column one name without \
         spaces; to leave out row numbers, write `index=False` with pandas",
    ),
    (
        "twice.txt",
        b"# e e\n0 1\n",
        &[],
        ":1: two columns have the name \"e\"; give each column a name of its own",
    ),
    (
        "given-twice.txt",
        b"0 1\n",
        &["e", "e"],
        ": two columns have the name \"e\"; give each column a name of its own",
    ),
    (
        "only-names.txt",
        b"t e\n",
        &[],
        ": it has no rows; check whether the program ran long enough to write one",
    ),
    (
        "empty.txt",
        b"\n\n# t e\n",
        &[],
        ": it has no rows; write rows of numbers, whose entries spaces separate",
    ),
    (
        "commas.txt",
        b"t,e\n0,1\n",
        &[],
        ":2: \"0,1\" in the column \"t,e\" is no number; write 0.5 with a point; if commas \
         separate the entries, the format is `csv`",
    ),
];

#[test]
fn text() {
    check(Text, TEXT);
}

#[test]
fn paths() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().display();
    let error = read(folder.path(), Csv, &[], MOST).unwrap_err().to_string();
    let expected = format!("{path}: it is a folder or a device; give the path of a file");
    assert_eq!(error, expected);
    let error = read(Path::new("no.csv"), Csv, &[], MOST)
        .unwrap_err()
        .to_string();
    let expected = "no.csv: the program left no such file; check the name in [[program.read]], and \
                    what the program writes";
    assert_eq!(error, expected);
    let error = read_bytes("large.csv", b"t\n12\n", Csv, &[], 4).unwrap_err();
    let expected = "large.csv: it has 5 bytes, but at most 4 are read; let the program write fewer \
                    rows, or raise the limit";
    assert_eq!(error.to_string(), expected);
}

/// A message does not repeat all of a long line.
#[test]
fn messages_are_short() {
    let long = "x".repeat(100_000);
    let text = format!("t\n{long}\n");
    let message = read_bytes("a", text.as_bytes(), Csv, &[], MOST)
        .unwrap_err()
        .to_string();
    assert!(message.len() < 300, "{message}");
}
