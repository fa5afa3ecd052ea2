//! The frames of a run, from the tables that its program left.

use super::run_folder::RunFolder;
use super::table::{self, NumberTable};
use crate::document::{shown, suggest};
use crate::scene::{ExternalProgram, ProgramTable, TableFormat};

/// The rows that all tables have.
#[derive(Debug, PartialEq)]
pub(super) struct TableFrames {
    /// Time of each row; its number without a column of times.
    pub(super) time: Vec<f64>,
    /// The columns of all tables, in order, as the scene names them.
    pub(super) columns: Vec<Vec<f64>>,
}

impl TableFrames {
    /// Reads the tables, which lie in these files of the folder.
    pub(super) fn read(
        program: &ExternalProgram,
        files: &[String],
        run_folder: &RunFolder,
    ) -> Result<Self, String> {
        let mut all: Option<Self> = None;
        for (asked, file) in program.read.iter().zip(files) {
            let path = run_folder.path().join(file);
            let most = program.most_bytes as u64;
            let names = match asked.format {
                TableFormat::Hdf5 => &asked.sources(),
                _ => &asked.header,
            };
            let table = table::read(&path, asked.format, names, most);
            let own = Self::of(asked, table.map_err(|it| it.to_string())?)
                .map_err(|reason| format!("{}: {reason}", path.display()))?;
            all = Some(match all {
                None => own,
                Some(earlier) => earlier.join(own),
            });
        }
        match all {
            Some(frames) if !frames.time.is_empty() => Ok(frames),
            Some(_) if files.len() > 1 => {
                Err("the tables have no time in common; read them with the same rhythm".to_owned())
            }
            _ => Err(format!("{} holds no rows", files.join(", "))),
        }
    }

    /// The columns that are asked for of a table.
    fn of(asked: &ProgramTable, table: NumberTable) -> Result<Self, String> {
        let place = |name: &str| {
            let place = table.names.iter().position(|it| it == name);
            place.ok_or_else(|| {
                let known = table::list(&table.names);
                // Any two names of one or two letters are near.
                let names = table.names.iter().filter(|_| name.chars().count() > 2);
                let near = suggest(name, names.map(String::as_str));
                let near = near.map_or(String::new(), |near| {
                    format!("did you mean `{}`? ", shown(near))
                });
                format!(
                    "there is no column `{}`; {near}its columns are {known}",
                    shown(name)
                )
            })
        };
        let places: Vec<usize> = asked
            .columns
            .iter()
            .map(|column| place(column.source()))
            .collect::<Result<_, _>>()?;
        let rows = table.columns.first().map_or(0, Vec::len);
        let time = match &asked.time {
            Some(name) => table.columns[place(name)?].clone(),
            None => (0..rows).map(|row| row as f64).collect(),
        };
        let is_wrong = |pair: &[f64]| !(pair[1] > pair[0] && pair[1].is_finite());
        let wrong = time.windows(2).position(is_wrong).map(|row| row + 1);
        let first = time.first().is_some_and(|it| !it.is_finite()).then_some(0);
        if let Some(row) = first.or(wrong) {
            let name = asked.time.as_deref().unwrap_or("time");
            return Err(format!(
                "the time `{name}` does not grow in row {} ({}); it must grow from row to row",
                row + 1,
                time[row]
            ));
        }
        let columns = places.iter().map(|&place| table.columns[place].clone());
        Ok(Self {
            columns: columns.collect(),
            time,
        })
    }

    /// The rows that both have, with the columns of both.
    fn join(self, other: Self) -> Self {
        let (mut here, mut there) = (0, 0);
        let (mut kept, mut kept_there) = (Vec::new(), Vec::new());
        while let (Some(own), Some(others)) = (self.time.get(here), other.time.get(there)) {
            if own == others {
                kept.push(here);
                kept_there.push(there);
            }
            (here, there) = (
                here + usize::from(own <= others),
                there + usize::from(others <= own),
            );
        }
        let rows =
            |column: &Vec<f64>, rows: &[usize]| rows.iter().map(|&row| column[row]).collect();
        let own = self.columns.iter().map(|it| rows(it, &kept));
        let others = other.columns.iter().map(|it| rows(it, &kept_there));
        Self {
            columns: own.chain(others).collect(),
            time: rows(&self.time, &kept),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::ProgramColumn;

    fn frames(text: &str) -> Result<TableFrames, String> {
        let table = NumberTable {
            names: vec!["t".to_owned(), "x".to_owned()],
            columns: {
                let rows: Vec<Vec<f64>> = text
                    .lines()
                    .map(|it| it.split(' ').map(|it| it.parse().unwrap()).collect())
                    .collect();
                (0..2)
                    .map(|k| rows.iter().map(|row| row[k]).collect())
                    .collect()
            },
        };
        let asked = ProgramTable {
            file: "x.csv".to_owned(),
            format: TableFormat::Csv,
            header: Vec::new(),
            time: Some("t".to_owned()),
            columns: vec![ProgramColumn::Name("x".to_owned())],
        };
        TableFrames::of(&asked, table)
    }

    #[test]
    fn rows_of_two_tables_go_together_by_their_times() {
        let (fine, coarse) = (
            frames("0 1\n1 2\n2 3\n4 5").unwrap(),
            frames("1 7\n3 8\n4 9").unwrap(),
        );
        let joined = fine.join(coarse);
        assert_eq!(joined.time, [1.0, 4.0]);
        assert_eq!(joined.columns, [[2.0, 5.0], [7.0, 9.0]]);
    }

    #[test]
    fn times_must_grow() {
        for text in [
            "0 1\n0 2",
            "0 1\n2 1\n1 1",
            "nan 1\n1 1",
            "0 1\nnan 1",
            "0 1\ninf 1",
        ] {
            let error = frames(text).unwrap_err();
            assert!(error.contains("does not grow in row"), "{text}: {error}");
        }
    }
}
