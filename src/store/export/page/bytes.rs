//! Positions as few bytes.
//!
//! Whole numbers are written in groups of seven bits, the lowest first; the eighth bit of a byte
//! says that another follows (LEB128). A number v that may be negative is written as 2 v, or as
//! -2 v - 1 below zero. For every state there follow
//!
//! 1. how many spheres came in since the state before, then the index of the first and the
//!    differences from each to the next;
//! 2. the same for those that left;
//! 3. for every sphere that is in, in the order of their indices, by how many quanta each
//!    coordinate differs from the state before, or from zero for one that came in. Behind a zero
//!    stands how many more zeros there would be, and these are left out.

use ndarray::Array2;

/// Writes one state after the other.
pub(super) struct Writer<'a> {
    axes: &'a [usize],
    quantum: f64,
    /// Coordinates (quanta) of every sphere that is in.
    before: Vec<Option<Vec<i64>>>,
    bytes: Vec<u8>,
}

impl<'a> Writer<'a> {
    /// A writer of that many spheres and these of their coordinates.
    pub(super) fn new(spheres: usize, axes: &'a [usize], quantum: f64) -> Self {
        Self {
            axes,
            quantum,
            before: vec![None; spheres],
            bytes: Vec::new(),
        }
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Writes a state. A sphere without numbers is not in.
    pub(super) fn add(&mut self, position: &Array2<f64>) {
        let rows = position.rows().into_iter();
        let now: Vec<Option<Vec<i64>>> = rows
            .map(|centre| {
                let is_in = centre.iter().all(|value| value.is_finite());
                let quanta = |&axis: &usize| (centre[axis] / self.quantum).round() as i64;
                is_in.then(|| self.axes.iter().map(quanta).collect())
            })
            .collect();
        let both = || self.before.iter().zip(&now).enumerate();
        let came = both().filter(|(_, (before, now))| before.is_none() && now.is_some());
        let came: Vec<usize> = came.map(|(sphere, _)| sphere).collect();
        let left = both().filter(|(_, (before, now))| before.is_some() && now.is_none());
        let left: Vec<usize> = left.map(|(sphere, _)| sphere).collect();
        let differences: Vec<i64> = both()
            .filter_map(|(_, (before, now))| Some((before, now.as_ref()?)))
            .flat_map(|(before, now)| {
                let from = |axis: usize| before.as_ref().map_or(0, |before| before[axis]);
                let difference = |(axis, now): (usize, &i64)| now - from(axis);
                now.iter().enumerate().map(difference).collect::<Vec<_>>()
            })
            .collect();
        self.indices(&came);
        self.indices(&left);
        self.differences(&differences);
        self.before = now;
    }

    fn indices(&mut self, spheres: &[usize]) {
        self.number(spheres.len() as u64);
        let mut before = 0;
        for &sphere in spheres {
            self.number((sphere - before) as u64);
            before = sphere;
        }
    }

    fn differences(&mut self, differences: &[i64]) {
        let mut rest = differences;
        while let Some((&first, after)) = rest.split_first() {
            // The sign goes to the lowest bit.
            self.number(((first << 1) ^ (first >> 63)) as u64);
            rest = after;
            if first == 0 {
                let zeros = after.iter().take_while(|it| **it == 0).count();
                self.number(zeros as u64);
                rest = &after[zeros..];
            }
        }
    }

    fn number(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.bytes.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.bytes.push(value as u8);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    #[test]
    fn bytes_are_as_described() {
        let mut writer = Writer::new(3, &[0, 2], 0.1);
        let gone = [f64::NAN; 3];
        writer.add(&array![gone, [0.1, 9.0, -0.2], gone]);
        // One came in, it is the one of index 1; nobody left; +1 and -2.
        assert_eq!(writer.bytes(), [1, 1, 0, 2, 3]);
        writer.add(&array![gone, [0.1, 9.0, -0.2], [0.0, 0.0, 10.0]]);
        // The one of index 2 came in; three zeros; 100, of which 200 = 0x48 + 0x80.
        assert_eq!(writer.bytes()[5..], [1, 2, 0, 0, 2, 0xc8, 1]);
        writer.add(&array![gone, gone, [0.0, 0.0, 10.0]]);
        assert_eq!(writer.bytes()[12..], [0, 1, 1, 0, 1]);
    }
}
