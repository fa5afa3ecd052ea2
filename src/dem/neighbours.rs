//! The Verlet list: pairs that may interact before anything has moved by half the skin, a rotation
//! of all spheres about the axis not counted.
//!
//! One list serves the contacts and the updraught's counting shield. Pairs stand in
//! order of their indices (i < j, then by j). The order in which forces are summed is therefore
//! that of the indices alone, so that neither the skin, nor the moment of a rebuild, nor the cells
//! behind it can change a bit of the motion.

use super::particles::Particles;
use super::vector::Vector;

/// Which pairs a list must hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Pairs that may touch.
    Contact,
    /// Pairs in one another's vertical column, |dx| and |dy| within the larger diameter, at any
    /// height; they include all that may touch.
    Column,
}

/// The Verlet list.
#[derive(Clone, Debug)]
pub struct VerletList {
    reach: Reach,
    skin: f64,
    /// Entries of sphere i are `start[i]..start[i + 1]`.
    start: Vec<u32>,
    neighbour: Vec<u32>,
    /// Positions at the latest build.
    reference: Vec<Vector>,
    /// Rotation rate about the z axis at the latest build (rad/s).
    rotation: f64,
    /// Half the diagonal of the largest sphere's shielding box, plus the skin (m).
    half_diagonal: f64,
    cells: Cells,
    builds: u64,
}

impl VerletList {
    /// A list that is not built yet.
    pub fn new(reach: Reach, skin: f64) -> Self {
        Self {
            reach,
            skin,
            start: vec![0],
            neighbour: Vec::new(),
            reference: Vec::new(),
            rotation: 0.0,
            half_diagonal: 0.0,
            cells: Cells::default(),
            builds: 0,
        }
    }

    /// The displacements that the list allows `time` (s) after its build.
    pub fn allowance(&self, time: f64) -> Allowance {
        let angle = self.rotation * time;
        // The shield's box does not turn with the pair: that moves a partner relative to the box
        // by at most the angle times the box's half diagonal.
        let turned = match self.reach {
            Reach::Contact => 0.0,
            Reach::Column => angle.abs() * self.half_diagonal,
        };
        let displacement = (0.5 * (self.skin - turned)).max(0.0);
        let (sine, cosine) = libm::sincos(angle);
        Allowance {
            sine,
            cosine,
            displacement_squared: displacement * displacement,
        }
    }

    /// Positions at the latest build.
    #[inline]
    pub fn reference(&self) -> &[Vector] {
        &self.reference
    }

    /// How often the list was built.
    pub fn builds(&self) -> u64 {
        self.builds
    }

    /// Number of listed pairs.
    pub fn pairs(&self) -> usize {
        self.neighbour.len()
    }

    /// Bounds of the entries of each sphere: `start[i]..start[i + 1]`.
    #[inline]
    pub fn start(&self) -> &[u32] {
        &self.start
    }

    /// The partner of each entry.
    #[inline]
    pub fn neighbour(&self) -> &[u32] {
        &self.neighbour
    }

    /// Builds the list anew for the present positions, which must be finite.
    pub fn build(&mut self, particles: &Particles) {
        let count = particles.len();
        let largest = particles.largest_radius();
        self.cells
            .fill(particles, 2.0 * largest + self.skin, self.reach);
        self.start.clear();
        self.neighbour.clear();
        self.start.push(0);
        for i in 0..count {
            let first = self.neighbour.len();
            match self.reach {
                Reach::Contact => {
                    self.cells
                        .contacts_of(i, particles, self.skin, &mut self.neighbour)
                }
                Reach::Column => self
                    .cells
                    .column_of(i, particles, self.skin, &mut self.neighbour),
            }
            self.neighbour[first..].sort_unstable();
            self.start.push(self.neighbour.len() as u32);
        }
        self.reference.clone_from(&particles.position);
        self.rotation = mean_rotation(particles);
        self.half_diagonal = std::f64::consts::SQRT_2 * (2.0 * largest + self.skin);
        self.builds += 1;
    }
}

/// How far spheres may have moved since the build of a list, rigid rotation about the z axis not
/// counted: that leaves the distances of all pairs as they are.
#[derive(Clone, Copy, Debug)]
pub struct Allowance {
    sine: f64,
    cosine: f64,
    displacement_squared: f64,
}

impl Allowance {
    /// Whether a sphere at `position` is still near enough to its `reference`. Not so if a
    /// coordinate is not a number.
    #[inline(always)]
    pub fn holds(&self, position: Vector, reference: Vector) -> bool {
        let turned = Vector::new(
            self.cosine * reference.x - self.sine * reference.y,
            self.sine * reference.x + self.cosine * reference.y,
            reference.z,
        );
        (position - turned).norm_squared() <= self.displacement_squared
    }
}

/// Rotation rate of the centres about the z axis (rad/s).
fn mean_rotation(particles: &Particles) -> f64 {
    let (mut momentum, mut inertia) = (0.0, 0.0);
    for (x, v) in particles.position.iter().zip(&particles.velocity) {
        momentum += x.x * v.y - x.y * v.x;
        inertia += x.x * x.x + x.y * x.y;
    }
    if inertia > 0.0 {
        momentum / inertia
    } else {
        0.0
    }
}

/// Spheres sorted into cells at least as wide as the reach of a pair.
#[derive(Clone, Debug, Default)]
struct Cells {
    shape: [usize; 3],
    /// Spheres of cell c are `first[c]..first[c + 1]` of the sorted arrays.
    first: Vec<u32>,
    cell_of: Vec<u32>,
    index: Vec<u32>,
    position: Vec<Vector>,
    radius: Vec<f64>,
}

impl Cells {
    fn fill(&mut self, particles: &Particles, width: f64, reach: Reach) {
        let count = particles.len();
        let (low, high) = bounds(&particles.position);
        let extent = high - low;
        // Cells beyond a few per sphere would only cost time and memory.
        let most = 4 * count + 64;
        let mut width = width;
        loop {
            let height = if reach == Reach::Column {
                0.0
            } else {
                extent.z
            };
            self.shape = [extent.x, extent.y, height]
                .map(|extent| ((extent / width) as usize).saturating_add(1));
            let [nx, ny, nz] = self.shape;
            if nx.saturating_mul(ny).saturating_mul(nz) <= most {
                break;
            }
            // The smallest of numbers would not grow.
            width = (1.25 * width).max(f64::MIN_POSITIVE);
        }
        let inverse = 1.0 / width;
        let [nx, ny, nz] = self.shape;
        let cell = |offset: f64, cells: usize| ((offset * inverse) as usize).min(cells - 1);
        self.cell_of.clear();
        self.cell_of
            .extend(particles.position.iter().map(|&centre| {
                let offset = centre - low;
                let (column, row, layer) =
                    (cell(offset.x, nx), cell(offset.y, ny), cell(offset.z, nz));
                ((layer * ny + row) * nx + column) as u32
            }));
        self.sort(particles);
    }

    /// Counting sort by cell; within a cell spheres stay in order of their index.
    fn sort(&mut self, particles: &Particles) {
        let count = particles.len();
        let cells = self.shape.iter().product::<usize>();
        self.first.clear();
        self.first.resize(cells + 1, 0);
        for &cell in &self.cell_of {
            self.first[cell as usize + 1] += 1;
        }
        for cell in 0..cells {
            self.first[cell + 1] += self.first[cell];
        }
        self.index.resize(count, 0);
        self.radius.resize(count, 0.0);
        self.position.resize(count, Vector::ZERO);
        // `first[c]` walks through its cell and ends at the start of the next one.
        for i in 0..count {
            let slot = &mut self.first[self.cell_of[i] as usize];
            let at = *slot as usize;
            *slot += 1;
            self.index[at] = i as u32;
            self.radius[at] = particles.radius[i];
            self.position[at] = particles.position[i];
        }
        for cell in (0..cells).rev() {
            self.first[cell + 1] = self.first[cell];
        }
        self.first[0] = 0;
    }

    /// Calls `visit` with the sorted range of every row of cells about sphere `i`.
    #[inline]
    fn rows_about(&self, i: usize, mut visit: impl FnMut(std::ops::Range<usize>)) {
        let [nx, ny, nz] = self.shape;
        let cell = self.cell_of[i] as usize;
        let (column, row, layer) = (cell % nx, cell / nx % ny, cell / (nx * ny));
        let (left, right) = (column.saturating_sub(1), (column + 1).min(nx - 1));
        for layer in layer.saturating_sub(1)..=(layer + 1).min(nz - 1) {
            for row in row.saturating_sub(1)..=(row + 1).min(ny - 1) {
                let base = (layer * ny + row) * nx;
                visit(self.first[base + left] as usize..self.first[base + right + 1] as usize);
            }
        }
    }

    fn contacts_of(&self, i: usize, particles: &Particles, skin: f64, found: &mut Vec<u32>) {
        let centre = particles.position[i];
        let reach = particles.radius[i] + skin;
        self.rows_about(i, |row| {
            for at in row {
                let offset = self.position[at] - centre;
                let distance = reach + self.radius[at];
                if self.index[at] as usize > i && offset.norm_squared() < distance * distance {
                    found.push(self.index[at]);
                }
            }
        });
    }

    fn column_of(&self, i: usize, particles: &Particles, skin: f64, found: &mut Vec<u32>) {
        let (centre, radius) = (particles.position[i], particles.radius[i]);
        self.rows_about(i, |row| {
            for at in row {
                let reach = 2.0 * radius.max(self.radius[at]) + skin;
                if self.index[at] as usize > i
                    && (self.position[at].x - centre.x).abs() < reach
                    && (self.position[at].y - centre.y).abs() < reach
                {
                    found.push(self.index[at]);
                }
            }
        });
    }
}

/// Corners of the smallest box that holds all points.
fn bounds(points: &[Vector]) -> (Vector, Vector) {
    let mut low = Vector::new(f64::INFINITY, f64::INFINITY, f64::INFINITY);
    let mut high = -low;
    for point in points {
        low = Vector::new(low.x.min(point.x), low.y.min(point.y), low.z.min(point.z));
        high = Vector::new(
            high.x.max(point.x),
            high.y.max(point.y),
            high.z.max(point.z),
        );
    }
    (low, high)
}
