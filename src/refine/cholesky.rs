//! Cholesky factors of symmetric positive definite matrices.

/// A square matrix, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Matrix {
    size: usize,
    entries: Vec<f64>,
}

impl Matrix {
    /// The symmetric matrix with these entries; only entries on and below the diagonal are
    /// computed.
    pub(crate) fn symmetric(size: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let mut entries = vec![0.0; size * size];
        for row in 0..size {
            for column in 0..=row {
                let value = entry(row, column);
                entries[row * size + column] = value;
                entries[column * size + row] = value;
            }
        }
        Self { size, entries }
    }

    /// Number of rows.
    pub(crate) fn size(&self) -> usize {
        self.size
    }

    /// A row.
    pub(crate) fn row(&self, row: usize) -> &[f64] {
        &self.entries[row * self.size..(row + 1) * self.size]
    }

    /// The product with a vector.
    pub(crate) fn times(&self, vector: &[f64]) -> Vec<f64> {
        (0..self.size)
            .map(|row| dot(self.row(row), vector))
            .collect()
    }
}

/// The lower triangle L with L Lᵀ = A. Row `i` starts at `i * size`.
#[derive(Clone, Debug)]
pub(crate) struct Cholesky(Matrix);

impl Cholesky {
    /// Factors the matrix with these entries on and below the diagonal. A pivot that rounding makes
    /// smaller than 1e-12 is replaced by 1e-12: callers pass matrices with pivots of 1 or more, or
    /// with noise added on the diagonal.
    pub(crate) fn new(size: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let mut entries = vec![0.0; size * size];
        for row in 0..size {
            let (above, own) = entries.split_at_mut(row * size);
            let own = &mut own[..size];
            for column in 0..row {
                let other = &above[column * size..(column + 1) * size];
                let rest = entry(row, column) - dot(&own[..column], &other[..column]);
                own[column] = rest / other[column];
            }
            let rest = entry(row, row) - dot(&own[..row], &own[..row]);
            own[row] = rest.max(1e-12).sqrt();
        }
        Self(Matrix { size, entries })
    }

    /// x with L x = b, in place.
    pub(crate) fn solve_lower(&self, vector: &mut [f64]) {
        for row in 0..self.0.size {
            let own = self.0.row(row);
            vector[row] = (vector[row] - dot(&own[..row], &vector[..row])) / own[row];
        }
    }

    /// x with L Lᵀ x = b, in place.
    pub(crate) fn solve(&self, vector: &mut [f64]) {
        self.solve_lower(vector);
        for row in (0..self.0.size).rev() {
            let own = self.0.row(row);
            let value = vector[row] / own[row];
            vector[row] = value;
            for (entry, factor) in vector[..row].iter_mut().zip(&own[..row]) {
                *entry -= factor * value;
            }
        }
    }

    /// Logarithm of the determinant of A.
    pub(crate) fn log_determinant(&self) -> f64 {
        let size = self.0.size;
        let diagonal = (0..size).map(|row| libm::log(self.0.entries[row * size + row]));
        2.0 * diagonal.sum::<f64>()
    }

    /// x with L x = b for several b side by side, in place: the entries of one row are adjacent.
    /// All b are 0 before row `first`, where the vectors start.
    pub(crate) fn solve_lower_lanes(&self, first: usize, vectors: &mut [Lanes]) {
        for row in first..self.0.size {
            let own = self.0.row(row);
            let (before, rest) = vectors.split_at_mut(row - first);
            let mut sums = rest[0];
            for (factor, entries) in own[first..row].iter().zip(before) {
                for lane in 0..LANES {
                    sums[lane] -= factor * entries[lane];
                }
            }
            rest[0] = sums.map(|sum| sum / own[row]);
        }
    }

    /// Diagonal of the inverse of A: the squared lengths of the columns of the inverse of L.
    pub(crate) fn inverse_diagonal(&self) -> Vec<f64> {
        let size = self.0.size;
        let mut diagonal = Vec::with_capacity(size + LANES);
        let mut columns = Vec::with_capacity(size);
        for first in (0..size).step_by(LANES) {
            columns.clear();
            columns.resize(size - first, [0.0; LANES]);
            for (lane, column) in columns.iter_mut().take(LANES).enumerate() {
                column[lane] = 1.0;
            }
            self.solve_lower_lanes(first, &mut columns);
            diagonal.extend(squared_lengths(&columns));
        }
        diagonal.truncate(size);
        diagonal
    }
}

/// Number of vectors that are solved side by side.
pub(crate) const LANES: usize = 8;

/// The entries of one row of these vectors.
pub(crate) type Lanes = [f64; LANES];

/// Squared lengths of vectors side by side.
pub(crate) fn squared_lengths(vectors: &[Lanes]) -> Lanes {
    let mut sums = [0.0; LANES];
    for entries in vectors {
        for lane in 0..LANES {
            sums[lane] += entries[lane] * entries[lane];
        }
    }
    sums
}

/// Sum of products, in eight partial sums of fixed order, so that compilers can use vectors of any
/// width without changing bits.
pub(crate) fn dot(one: &[f64], other: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (blocks, rest) = one.as_chunks::<8>();
    let (other_blocks, other_rest) = other.as_chunks::<8>();
    for (one, other) in blocks.iter().zip(other_blocks) {
        for lane in 0..8 {
            sums[lane] += one[lane] * other[lane];
        }
    }
    for lane in 0..rest.len().min(other_rest.len()) {
        sums[lane] += rest[lane] * other_rest[lane];
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (b + f)) + ((c + g) + (d + h))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A positive definite matrix without structure.
    fn matrix(size: usize) -> Matrix {
        Matrix::symmetric(size, |i, j| {
            let far = (i * 7 % 11) as f64 - (j * 7 % 11) as f64;
            libm::exp(-0.1 * far * far) + if i == j { 0.5 } else { 0.0 }
        })
    }

    #[test]
    fn solutions_solve() {
        for size in [1, 2, 9, 30] {
            let matrix = matrix(size);
            let factor = Cholesky::new(size, |i, j| matrix.row(i)[j]);
            let wanted: Vec<f64> = (0..size).map(|i| i as f64 - 3.0).collect();
            let mut found = matrix.times(&wanted);
            factor.solve(&mut found);
            for (found, wanted) in found.iter().zip(&wanted) {
                assert!((found - wanted).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn the_inverse_and_the_determinant_agree_with_solutions() {
        let size = 20;
        let matrix = matrix(size);
        let factor = Cholesky::new(size, |i, j| matrix.row(i)[j]);
        for (index, found) in factor.inverse_diagonal().iter().enumerate() {
            let mut unit = vec![0.0; size];
            unit[index] = 1.0;
            factor.solve(&mut unit);
            assert!((unit[index] - found).abs() < 1e-9);
        }
        let two = Cholesky::new(2, |i, j| [[4.0, 1.0], [1.0, 3.0]][i][j]);
        assert!((two.log_determinant() - libm::log(11.0)).abs() < 1e-14);
    }
}
