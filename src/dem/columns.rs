//! Further columns of contacts, in runs that ask for them.

use super::system::{Engine, Partner, SeenContact};
use super::wall_loads::WallLoads;
use crate::document::lasting;
use crate::measure::{LayerOfScene, ShearSums, TankLayer};
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::{FurtherColumn, Scene, WallColumn};
use crate::simulation::Column;

/// The columns of contacts that a scene asks for.
pub(super) struct ContactColumns {
    columns: Vec<FurtherColumn>,
    declared: Vec<Column>,
    layer: Option<LayerOfScene>,
    /// Absent if forces on walls are not asked for.
    walls: Option<WallLoads>,
    /// Density of the spheres (kg/m3).
    density: f64,
    /// Mean diameter of all spheres of the scene (m).
    diameter: f64,
    /// What each sphere touches, kept for its memory.
    touched: Vec<Touched>,
}

/// What a sphere touches.
#[derive(Clone, Copy, Default)]
struct Touched {
    anything: bool,
    wall: bool,
}

/// Sums over the contacts of a frame.
#[derive(Default)]
struct ContactSums {
    /// Contacts of all spheres. A contact between two of them counts twice.
    count: f64,
    stress: Stress,
    shear: ShearSums,
}

/// Sum of force times branch and of momentum times velocity (J), a row for each axis of forces.
#[derive(Clone, Copy, Default)]
struct Stress([[f64; 3]; 3]);

impl Stress {
    /// Adds the product of two vectors with a factor.
    fn add(&mut self, factor: f64, row: Vector, column: Vector) {
        let column = [column.x, column.y, column.z];
        for (sums, row) in self.0.iter_mut().zip([row.x, row.y, row.z]) {
            for (sum, column) in sums.iter_mut().zip(column) {
                *sum += factor * row * column;
            }
        }
    }

    fn pressure(&self) -> f64 {
        (self.0[0][0] + self.0[1][1] + self.0[2][2]) / 3.0
    }
}

impl ContactColumns {
    /// Those of a scene whose spheres have this mean radius (m); `None` if it asks for none.
    pub(super) fn new(scene: &Scene, mean_radius: f64) -> Option<Self> {
        let asked = scene.output.columns.iter().copied();
        let own = asked.filter(|it| it.is_of_contacts() && !it.is_usual_in(scene));
        let mut columns: Vec<FurtherColumn> = own.collect();
        columns.sort_unstable();
        let walls = scene.output.walls.then(|| WallLoads::new(scene));
        let of_walls = walls.iter().flat_map(|_| scene.wall_columns());
        let declared = columns.iter().map(|&column| column.into());
        let declared: Vec<Column> = declared.chain(of_walls.map(column_of_wall)).collect();
        (!declared.is_empty()).then(|| Self {
            declared,
            columns,
            walls,
            layer: LayerOfScene::new(scene),
            density: scene.spheres.density,
            diameter: 2.0 * mean_radius,
            touched: Vec::new(),
        })
    }

    /// Their declarations.
    pub(super) fn declared(&self) -> &[Column] {
        &self.declared
    }

    /// Their values at the present positions and velocities.
    pub(super) fn values(&mut self, engine: &mut dyn Engine) -> Vec<f64> {
        let particles = engine.particles();
        let fixed = particles.fixed;
        let stress = self.columns.iter().any(|it| it.is_of_forces());
        let layer = self.layer.filter(|_| stress);
        let layer = layer.map(|layer| layer.at(height_mean(particles)));
        let mut sums = ContactSums::default();
        if let Some(layer) = &layer {
            sums.add_motion(particles, layer);
        }
        let touched = &mut self.touched;
        touched.clear();
        touched.resize(particles.len() - fixed, Touched::default());
        let walls = &mut self.walls;
        if let Some(walls) = walls {
            walls.begin(&engine.walls_that_act());
        }
        engine.see_contacts(stress || walls.is_some(), &mut |contact| {
            let one = &mut touched[contact.sphere - fixed];
            one.anything = true;
            one.wall |= matches!(contact.partner, Partner::Wall(_));
            sums.count += contact.weight;
            if let Partner::Sphere(other) = contact.partner {
                touched[other - fixed].anything = true;
                sums.count += 1.0;
            }
            if let Some(layer) = &layer {
                sums.add_force(&contact, layer);
            }
            if let (Some(walls), Partner::Wall(touch)) = (walls.as_mut(), &contact.partner) {
                walls.add(touch, contact.force);
            }
        });
        let volume = layer.map_or(f64::NAN, |layer| layer.volume());
        let columns = self.columns.iter();
        let of_walls = self.walls.iter().flat_map(WallLoads::values);
        let values = columns.map(|&it| self.value(it, &sums, volume));
        values.chain(of_walls).collect()
    }

    /// A value, from the sums and the layer's volume (m3).
    fn value(&self, column: FurtherColumn, sums: &ContactSums, volume: f64) -> f64 {
        let touched = &self.touched;
        let share = |is_counted: fn(&Touched) -> bool| {
            let counted = touched.iter().filter(|it| is_counted(it)).count();
            counted as f64 / touched.len() as f64
        };
        let stress = |row: usize, column: usize| sums.stress.0[row][column] / volume;
        let pressure = sums.stress.pressure() / volume;
        match column {
            FurtherColumn::Coordination => sums.count / touched.len() as f64,
            FurtherColumn::ShareWithoutContact => share(|it| !it.anything),
            FurtherColumn::ShareAtWall => share(|it| it.wall),
            FurtherColumn::Pressure => pressure,
            FurtherColumn::StressXx => stress(0, 0),
            FurtherColumn::StressXy => stress(0, 1),
            FurtherColumn::StressXz => stress(0, 2),
            FurtherColumn::StressYx => stress(1, 0),
            FurtherColumn::StressYy => stress(1, 1),
            FurtherColumn::StressYz => stress(1, 2),
            FurtherColumn::StressZx => stress(2, 0),
            FurtherColumn::StressZy => stress(2, 1),
            FurtherColumn::StressZz => stress(2, 2),
            FurtherColumn::InertialNumber if pressure > 0.0 => {
                sums.shear.rate() * self.diameter / (pressure / self.density).sqrt()
            }
            // The observer measures all others.
            _ => f64::NAN,
        }
    }
}

impl ContactSums {
    /// Adds what the spheres with their centres in a layer contribute.
    fn add_motion(&mut self, particles: &Particles, layer: &TankLayer) {
        let all = particles.fixed..particles.len();
        let inside = all.filter(|&i| layer.contains(particles.position[i].z));
        let (mut mass, mut momentum) = (0.0, Vector::ZERO);
        for i in inside.clone() {
            mass += particles.mass[i];
            momentum += particles.velocity[i] * particles.mass[i];
        }
        for i in inside {
            let velocity = particles.velocity[i];
            let height = particles.position[i].z - layer.bottom;
            self.shear.add(height, [velocity.x, velocity.y]);
            let relative = velocity - momentum * (1.0 / mass);
            self.stress.add(particles.mass[i], relative, relative);
        }
    }

    /// Adds the part of a contact that is in a layer.
    fn add_force(&mut self, contact: &SeenContact, layer: &TankLayer) {
        let SeenContact {
            height,
            branch,
            force,
            ..
        } = *contact;
        let share = layer.share_of_line([height, height - branch.z]);
        self.stress.add(share, force, branch);
    }
}

fn column_of_wall(column: WallColumn) -> Column {
    Column {
        name: lasting(&column.name),
        unit: column.unit,
        description: lasting(&column.description),
    }
}

/// Mean height of the centres of the spheres that move (m).
fn height_mean(particles: &Particles) -> f64 {
    let moving = particles.fixed..particles.len();
    let sum: f64 = moving.clone().map(|i| particles.position[i].z).sum();
    sum / moving.len() as f64
}
