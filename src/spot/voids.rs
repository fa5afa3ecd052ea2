//! The void model: Caram and Hong, Physical Review Letters 67 (1991) 828.
//!
//! Grains sit on the sites of a triangular lattice. A void that enters at the bottom changes places
//! with one of the two grains above it, each with probability 1/2. If only one of these sites has a
//! grain, it is chosen; if neither has, the void is at the surface and ends.

use super::random::RandomStream;

/// Distance of rows, in units of the distance of sites in a row.
pub const ROW_HEIGHT: f64 = 0.866_025_403_784_438_6;

/// A silo of grains on a lattice. Odd rows are shifted to the right by half a site.
#[derive(Clone, Debug)]
pub struct VoidSilo {
    columns: usize,
    /// First column of the orifice in row 0, and the number of its columns.
    orifice: [usize; 2],
    /// The grain of each site, row by row from below.
    grain: Vec<Option<u32>>,
    /// The site of each grain, until it has left.
    site: Vec<Option<u32>>,
    random: RandomStream,
}

impl VoidSilo {
    /// A full lattice with an orifice of some sites in the middle of the lowest row. `None` without
    /// sites or orifice, with an orifice wider than the silo, or with more than 2^32 sites.
    pub fn new(columns: usize, rows: usize, orifice: usize, seed: u64) -> Option<Self> {
        let sites = u32::try_from(columns.checked_mul(rows)?).ok()?;
        if sites == 0 || orifice == 0 || orifice > columns {
            return None;
        }
        Some(Self {
            columns,
            orifice: [(columns - orifice) / 2, orifice],
            grain: (0..sites).map(Some).collect(),
            site: (0..sites).map(Some).collect(),
            random: RandomStream::new("voids", seed),
        })
    }

    /// Lets voids enter, each after the previous one has reached the surface. Returns the number of
    /// grains that have left; a void that enters at an empty site takes none.
    pub fn drain(&mut self, voids: usize) -> usize {
        (0..voids).filter(|_| self.send_void()).count()
    }

    /// Place of a grain in units of the distance of sites in a row: along the row from the middle
    /// of the silo, and upwards. `None` if it has left or does not exist.
    pub fn place(&self, grain: usize) -> Option<[f64; 2]> {
        let site = (*self.site.get(grain)?)? as usize;
        let (row, column) = (site / self.columns, site % self.columns);
        let shift = if row.is_multiple_of(2) { 0.0 } else { 0.5 };
        let middle = 0.5 * (self.columns - 1) as f64;
        Some([column as f64 + shift - middle, row as f64 * ROW_HEIGHT])
    }

    /// Number of grains at the start.
    pub fn grains(&self) -> usize {
        self.site.len()
    }

    fn send_void(&mut self) -> bool {
        let [first, count] = self.orifice;
        let mut void = first + self.random.below(count);
        let Some(grain) = self.grain[void].take() else {
            return false;
        };
        self.site[grain as usize] = None;
        while let Some(from) = self.above(void) {
            let grain = self.grain[from].take();
            self.grain[void] = grain;
            if let Some(grain) = grain {
                self.site[grain as usize] = Some(void as u32);
            }
            void = from;
        }
        true
    }

    /// The site above to which a void goes; `None` at the surface.
    fn above(&mut self, void: usize) -> Option<usize> {
        let (row, column) = (void / self.columns, void % self.columns);
        let start = (row + 1) * self.columns;
        if start == self.grain.len() {
            return None;
        }
        let left = if row.is_multiple_of(2) {
            column.checked_sub(1)
        } else {
            Some(column)
        };
        let right = if row.is_multiple_of(2) {
            column
        } else {
            column + 1
        };
        let right = Some(right).filter(|&it| it < self.columns);
        let filled = |column: usize| self.grain[start + column].is_some();
        let [left, right] = [left, right].map(|it| it.filter(|&it| filled(it)));
        let chosen = match (left, right) {
            (Some(left), Some(right)) => [left, right][self.random.below(2)],
            (one, other) => one.or(other)?,
        };
        Some(start + chosen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grains_leave_one_per_void_until_the_slopes_are_stable() {
        let mut silo = VoidSilo::new(41, 30, 1, 1).expect("a silo");
        let left = silo.drain(100);
        assert_eq!(left, 100);
        let inside = |silo: &VoidSilo| {
            (0..silo.grains())
                .filter(|&it| silo.place(it).is_some())
                .count()
        };
        assert_eq!(inside(&silo), 41 * 30 - 100);
        let rest = silo.drain(100_000);
        assert_eq!(inside(&silo), 41 * 30 - 100 - rest);
        assert_eq!(silo.drain(10), 0);
        // The heaps on both sides have slopes of 60 degrees.
        assert!((500..1000).contains(&inside(&silo)), "{}", inside(&silo));
    }

    #[test]
    fn grains_spread_as_far_as_the_flow_does() {
        // A grain takes steps of half a site, one per row that it sinks: its variance grows by 1/4
        // per row. In the spot model the variance is hundreds of times smaller.
        let (columns, rows) = (121, 120);
        let (mut squares, mut sunk) = (0.0, 0.0);
        let mut silo = VoidSilo::new(columns, rows, columns, 5).expect("a silo");
        silo.drain(columns * 40);
        for grain in columns * 60..columns * 80 {
            let column = grain % columns;
            let start = column as f64 - 60.0 + if (grain / columns) % 2 == 0 { 0.0 } else { 0.5 };
            if let Some([x, z]) = silo.place(grain) {
                squares += (x - start) * (x - start);
                sunk += (grain / columns) as f64 - z / ROW_HEIGHT;
            }
        }
        let ratio = squares / sunk;
        assert!((ratio - 0.25).abs() < 0.05, "variance per row {ratio}");
    }

    #[test]
    fn impossible_silos_are_refused() {
        assert!(VoidSilo::new(0, 5, 1, 1).is_none());
        assert!(VoidSilo::new(5, 5, 6, 1).is_none());
        assert!(VoidSilo::new(5, 5, 0, 1).is_none());
    }
}
