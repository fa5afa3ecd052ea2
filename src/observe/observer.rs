//! Measures a simulation at every frame.

mod rising;
mod totals;

use super::Observations;
use super::columns::SphereColumns;
use super::reduce::Sum;
use crate::scene::Scene;
use crate::simulation::{Column, Frame, FrameView, Ledger};
use ndarray::{Array2, Array3};
use rising::{Previous, Rising};
use serde::{Deserialize, Serialize};
use totals::Totals;

/// Measures a simulation at every frame: what its scene needs, and what its model declares.
///
/// Observables that refer to the axis (hole, rotation, fluctuation) are measured in a round tank or
/// in swirling air; the speed of the air in swirling air; elastic energy with contacts; flow if
/// spheres come and go; the energy ledger and further columns on request. Sums run over the spheres
/// in the order of their indices, so equal states give equal bits.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Observer {
    /// Components along x and z of gravity minus buoyancy, 0 without gravity (m/s2).
    gravity: [f64; 2],
    /// Inertial mass over mass.
    inertial_factor: f64,
    /// |Omega| of the swirling air, 0 without swirl (rad/s).
    air_rotation: f64,
    /// Whether what refers to an axis about which spheres may turn is recorded.
    has_axis: bool,
    has_air: bool,
    has_contacts: bool,
    /// Whether walls slide in themselves.
    has_moving_walls: bool,
    /// Whether energies are recorded: in the spot model velocities are only mean displacements.
    has_energies: bool,
    /// Whether motion relative to the mean is recorded.
    has_fluctuation: bool,
    /// Whether the mean speed is recorded.
    has_speed: bool,
    /// Whether there are spheres at all: another program has its own columns only.
    has_spheres: bool,
    /// Whether the box is shaken.
    is_shaken: bool,
    bins: usize,
    bin_width: f64,
    /// Least rises per frame relative to the mean, in radii of the sphere.
    rises: Vec<f64>,
    /// Distances from the axis within which spheres count (m).
    distances: Vec<f64>,
    /// Frames per second, at least one.
    second: usize,
    observations: Observations,
    /// Further columns, whose series are the first of the observations' own.
    further: SphereColumns,
    /// Rows of `Observations::profile`, one after the other.
    profile: Vec<f32>,
    /// Entries of `Observations::rising`, one frame after the other.
    rising: Vec<u16>,
    /// Distance of each centre of a block from the axis (m).
    #[serde(skip)]
    distance: Vec<f64>,
    previous: Option<Previous>,
    /// Energy balance at the first frame (J).
    balance: Option<f64>,
}

impl Observer {
    /// An observer of one run of `scene`, whose spheres have these radii (m).
    ///
    /// Without a tank radius R the surface profile has no bins and rising spheres are counted
    /// within no radius: both arrays have a length of 0 there.
    pub fn new(scene: &Scene, radius: &[f64]) -> Self {
        let output = &scene.output;
        // Comparison with the previous frame needs the same spheres in both.
        let tank = scene.tank.as_ref().filter(|_| !scene.has_flow());
        let tank_radius = tank.and_then(|tank| tank.radius);
        let of_profile = tank_radius.filter(|_| output.records("profile"));
        let of_rising = tank_radius.filter(|_| output.records("rising"));
        let mean_radius = radius.iter().sum::<f64>() / radius.len() as f64;
        let (bins, bin_width) = of_profile.map_or((0, 0.0), |tank_radius| {
            let natural = (tank_radius / (2.0 * mean_radius)).round() as usize;
            let bins = output.profile_bins.unwrap_or(natural).max(1);
            (bins, tank_radius / bins as f64)
        });
        let distances: Vec<f64> = of_rising.map_or_else(Vec::new, |tank_radius| {
            let within = |share: &f64| share * tank_radius;
            output.rise_radii.iter().map(within).collect()
        });
        let further = SphereColumns::new(scene, mean_radius);
        // The sums of a group cost the same for one column as for all.
        let any = |names: &[&str]| names.iter().any(|name| output.records(name));
        let energies = ["kinetic", "rotational", "gravitational", "elastic"];
        let about_axis = ["hole_radius", "rotation", "air_speed_mean", "profile"];
        let fluctuation = any(&["fluctuation", "rising"]);
        let has_axis = !scene.has_flow()
            && (tank_radius.is_some() || scene.dem.effects.swirl.is_some())
            && (fluctuation || any(&about_axis));
        let per_frame = |speed: &f64| speed * scene.time.frame_interval;
        Self {
            gravity: scene
                .gravity_in_fluid()
                .map_or([0.0; 2], |it| it.components()),
            inertial_factor: scene.inertial_factor(),
            has_axis,
            has_air: has_axis && scene.dem.effects.swirl.is_some(),
            has_fluctuation: has_axis && fluctuation,
            has_speed: output.records("speed_mean"),
            has_contacts: scene.dem.contact.is_some(),
            has_moving_walls: scene.has_moving_walls(),
            has_energies: scene.spot.is_none() && (output.ledger || any(&energies)),
            has_spheres: !scene.is_external(),
            is_shaken: scene.dem.effects.shaking.is_some(),
            air_rotation: scene
                .dem
                .effects
                .swirl
                .as_ref()
                .map_or(0.0, |it| it.omega.abs()),
            bins,
            bin_width,
            rises: output.rise_speeds.iter().map(per_frame).collect(),
            distances,
            second: ((1.0 / scene.time.frame_interval).round() as usize).max(1),
            observations: Observations {
                own: further.declared().collect(),
                ..Observations::default()
            },
            further,
            profile: Vec::new(),
            rising: Vec::new(),
            distance: Vec::new(),
            previous: None,
            balance: None,
        }
    }

    /// The same with the columns that the model of the scene declares.
    #[must_use]
    pub fn with_own(mut self, columns: &[Column]) -> Self {
        let own = &mut self.observations.own;
        own.truncate(self.further.count());
        own.extend(columns.iter().map(|&column| column.into()));
        self
    }

    /// Notes the values of the model's own columns at the frame that is observed next.
    pub fn observe_own(&mut self, values: &[f64]) {
        let own = self.observations.own.iter_mut();
        for (series, value) in own.skip(self.further.count()).zip(values) {
            series.values.push(*value as f32);
        }
    }

    /// Measures one frame at `time` (s). Frames are one frame interval of the scene apart, and
    /// the first is the start.
    pub fn observe(&mut self, time: f64, frame: &dyn Frame) {
        self.observations.time.push(time);
        if !self.has_spheres {
            return;
        }
        let totals = self.first_look(frame);
        self.note_energies(&totals);
        self.note_distances(&totals);
        self.note_heights(&totals);
        self.note_flow(&totals);
        let means = self.note_velocities(&totals);
        self.second_look(frame, &means);
        let series = self.observations.own.iter_mut();
        for (series, value) in series.zip(self.further.values(frame)) {
            series.values.push(value as f32);
        }
    }

    /// The observables of all frames so far, without `profile` and `rising`.
    pub(crate) fn observations(&self) -> &Observations {
        &self.observations
    }

    /// The observables of all frames so far.
    pub fn finish(mut self) -> Observations {
        self.observations.place_own();
        let frames = self.observations.frames();
        let rising = (frames, self.distances.len(), self.rises.len());
        Observations {
            profile: Array2::from_shape_vec((frames, self.bins), self.profile)
                .expect("every frame adds one value per bin"),
            rising: Array3::from_shape_vec(rising, self.rising)
                .expect("every frame adds one count per distance and speed"),
            ..self.observations
        }
    }

    /// Computes everything that does not depend on a mean.
    fn first_look(&mut self, frame: &dyn Frame) -> Totals {
        let start = self.profile.len();
        self.profile.resize(start + self.bins, f32::NAN);
        let mut totals = Totals::default();
        frame.show(&mut |block| {
            totals.add(block);
            if self.has_energies {
                totals.add_energies(block, self.gravity);
            }
            if self.has_speed {
                totals.add_speeds(block);
            }
            if self.has_axis {
                find_distances(block, &mut self.distance);
                totals.add_about_axis(block, &self.distance);
            }
            let tops = &mut self.profile[start..];
            if tops.is_empty() {
                return;
            }
            for (&distance, &z) in self.distance.iter().zip(block.position[2]) {
                let top = &mut tops[bin(distance, self.bin_width, self.bins)];
                // `max` of a number and the NaN of an empty bin is the number.
                *top = top.max(z as f32);
            }
        });
        totals
    }

    fn note_energies(&mut self, totals: &Totals) {
        let kinetic = totals.kinetic.total() * self.inertial_factor;
        let rotational = totals.rotational.total();
        let gravitational = totals.gravitational.total();
        if !self.has_energies {
            return;
        }
        let observations = &mut self.observations;
        observations.kinetic.push(kinetic as f32);
        observations.rotational.push(rotational as f32);
        observations.gravitational.push(gravitational as f32);
        if self.has_contacts {
            observations.elastic.push(totals.elastic_energy as f32);
        }
        let energy = kinetic + rotational + gravitational + totals.elastic_energy;
        if let Some(ledger) = &totals.ledger {
            self.note_ledger(ledger, energy);
        }
    }

    fn note_ledger(&mut self, ledger: &Ledger, energy: f64) {
        let balance = energy + ledger.springs + ledger.damping + ledger.friction
            - ledger.air
            - ledger.brought
            - ledger.shaking
            - ledger.walls;
        let start = *self.balance.get_or_insert(balance);
        let observations = &mut self.observations;
        observations.springs.push(ledger.springs as f32);
        observations
            .dissipated_by_damping
            .push(ledger.damping as f32);
        observations
            .dissipated_by_friction
            .push(ledger.friction as f32);
        observations.work_of_air.push(ledger.air as f32);
        if self.is_shaken {
            observations.work_of_shaking.push(ledger.shaking as f32);
        }
        if self.has_moving_walls {
            observations.work_of_walls.push(ledger.walls as f32);
        }
        observations.energy_brought.push(ledger.brought as f32);
        observations.residual.push((balance - start) as f32);
    }

    fn note_flow(&mut self, totals: &Totals) {
        let Some(flow) = &totals.flow else { return };
        let observations = &mut self.observations;
        observations.released.push(flow.released as f32);
        observations.discharged.push(flow.discharged as f32);
        observations.spilled.push(flow.spilled as f32);
        let now = observations.discharged.len() - 1;
        let before = now.saturating_sub(self.second);
        let left = flow.discharged as f32 - observations.discharged[before];
        let time = observations.time[now] - observations.time[before];
        let rate = if time > 0.0 { left / time as f32 } else { 0.0 };
        observations.discharge_rate.push(rate);
        if self.has_contacts {
            let coordination = flow.contacts as f64 / totals.count as f64;
            observations.coordination.push(coordination as f32);
        }
        observations.mass_inside.push(totals.mass.total() as f32);
    }

    fn note_distances(&mut self, totals: &Totals) {
        let mean = totals.distance.total() / totals.count as f64;
        let observations = &mut self.observations;
        if self.has_axis {
            observations.hole_radius.push(totals.nearest as f32);
        }
        if self.has_air {
            let speed = (self.air_rotation * mean) as f32;
            observations.air_speed_mean.push(speed);
        }
    }

    fn note_heights(&mut self, totals: &Totals) {
        let mean = totals.height.total() / totals.count as f64;
        self.observations.height_mean.push(mean as f32);
        self.observations.height_max.push(totals.highest as f32);
    }

    fn note_velocities(&mut self, totals: &Totals) -> Means {
        let count = totals.count as f64;
        let inertia = totals.inertia.total();
        // Spheres that all lie on the axis do not rotate about it.
        let rotation = if inertia > 0.0 {
            totals.momentum.total() / inertia
        } else {
            0.0
        };
        let speed = totals.speed.total() / count;
        let observations = &mut self.observations;
        if self.has_speed {
            observations.speed_mean.push(speed as f32);
        }
        if self.has_axis {
            observations.rotation.push(rotation as f32);
        }
        Means {
            count,
            rotation,
            rise: totals.rise.total() / count,
            height: totals.height.total() / count,
        }
    }

    /// Computes what depends on means. All of it refers to the axis.
    fn second_look(&mut self, frame: &dyn Frame, means: &Means) {
        if !self.has_fluctuation {
            return;
        }
        let (rotation, rise) = (means.rotation, means.rise);
        let mut fluctuation = Sum::default();
        let mut rising = Rising::new(self, frame.count(), means.height);
        frame.show(&mut |block| {
            let ([x, y, _], [vx, vy, vz]) = (block.position, block.velocity);
            fluctuation.add([x, y, vx, vy, vz], |[x, y, vx, vy, vz]| {
                let x_part = vx + rotation * y;
                let y_part = vy - rotation * x;
                let z_part = vz - rise;
                x_part * x_part + y_part * y_part + z_part * z_part
            });
            if let Some(rising) = &mut rising {
                rising.count(block);
            }
        });
        let fluctuation = fluctuation.total() / means.count;
        self.observations
            .fluctuation
            .push(fluctuation.sqrt() as f32);
    }
}

/// Means of a frame that other observables refer to.
struct Means {
    /// Number of spheres.
    count: f64,
    /// Rotation rate of the spheres about the axis (rad/s).
    rotation: f64,
    /// Vertical velocity (m/s).
    rise: f64,
    /// Height (m).
    height: f64,
}

/// Distances of the spheres of a block from the axis (m).
fn find_distances(block: &FrameView<'_>, distance: &mut Vec<f64>) {
    let [x, y, _] = block.position;
    distance.clear();
    distance.extend(x.iter().zip(y).map(|(x, y)| (x * x + y * y).sqrt()));
}

/// Index of the bin of this `distance` from the axis. Bin j reaches from j widths (excluded) to j +
/// 1 widths (included). The innermost includes the axis, and the outermost everything beyond it,
/// such as a sphere pressed into a soft wall.
fn bin(distance: f64, width: f64, bins: usize) -> usize {
    let widths = distance / width;
    let below = widths as u32;
    let on_edge = widths == f64::from(below) && below > 0;
    (below as usize - usize::from(on_edge)).min(bins - 1)
}

#[cfg(test)]
mod tests;
