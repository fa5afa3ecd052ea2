//! Measures a simulation at every frame.

use super::reduce::{largest, least, sum};
use super::{FrameView, Observations};
use crate::scene::{Gravity, Scene};
use ndarray::{Array2, Array3};
use serde::{Deserialize, Serialize};

/// Measures a simulation at every frame.
///
/// Sums run over the spheres in the order of their indices, so equal states give equal bits.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Observer {
    /// Components of gravity along x and z, 0 without it (m/s2).
    gravity: [f64; 2],
    /// |Omega| of the swirling air, 0 without swirl (rad/s).
    air_rotation: f64,
    bins: usize,
    bin_width: f64,
    /// Rises per frame relative to the mean that count, in radii of the sphere.
    rises: Vec<f64>,
    /// Distances from the axis within which they count (m).
    distances: Vec<f64>,
    /// Frames in a second, one at least.
    second: usize,
    observations: Observations,
    /// Rows of `Observations::profile`, one after the other.
    profile: Vec<f32>,
    /// Entries of `Observations::rising`, one frame after the other.
    rising: Vec<u16>,
    /// Distance of each centre from the axis at this frame (m).
    #[serde(skip)]
    distance: Vec<f64>,
    previous: Option<Previous>,
    /// What all energy, dissipated and brought, came to at the first frame (J).
    balance: Option<f64>,
}

/// What the count of rising spheres needs of the frame before.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Previous {
    height: Vec<f64>,
    distance: Vec<f64>,
    height_mean: f64,
}

impl Observer {
    /// An observer of one run of `scene`, whose spheres have these radii (m).
    ///
    /// Without a tank radius R the surface profile has no bins and rising spheres are counted
    /// within no radius: both arrays have a length of 0 there.
    pub fn new(scene: &Scene, radius: &[f64]) -> Self {
        let output = &scene.output;
        // What compares a frame with the one before needs the same spheres in both.
        let tank = scene.tank.as_ref().filter(|_| !scene.has_flow());
        let tank_radius = tank.and_then(|tank| tank.radius);
        let mean_radius = radius.iter().sum::<f64>() / radius.len() as f64;
        let (bins, bin_width) = tank_radius.map_or((0, 0.0), |tank_radius| {
            let natural = (tank_radius / (2.0 * mean_radius)).round() as usize;
            let bins = output.profile_bins.unwrap_or(natural).max(1);
            (bins, tank_radius / bins as f64)
        });
        let distances: Vec<f64> = tank_radius.map_or_else(Vec::new, |tank_radius| {
            let within = |share: &f64| share * tank_radius;
            output.rise_radii.iter().map(within).collect()
        });
        let per_frame = |speed: &f64| speed * scene.time.frame_interval;
        Self {
            gravity: scene.gravity.as_ref().map_or([0.0; 2], Gravity::components),
            air_rotation: scene.swirl.as_ref().map_or(0.0, |it| it.omega.abs()),
            bins,
            bin_width,
            rises: output.rise_speeds.iter().map(per_frame).collect(),
            distances,
            second: ((1.0 / scene.time.frame_interval).round() as usize).max(1),
            observations: Observations::default(),
            profile: Vec::new(),
            rising: Vec::new(),
            distance: Vec::new(),
            previous: None,
            balance: None,
        }
    }

    /// Measures one frame at `time` (s). Frames are one frame interval of the scene apart, and
    /// the first is the start.
    pub fn observe(&mut self, time: f64, frame: &FrameView<'_>) {
        self.observations.time.push(time);
        self.measure_energies(frame);
        self.measure_velocities(frame);
        self.measure_distances(frame);
        self.measure_profile(frame);
        let height_mean = self.measure_heights(frame);
        self.measure_rising(frame, height_mean);
        self.measure_flow(frame);
    }

    /// The observables of all frames so far.
    pub fn finish(self) -> Observations {
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

    fn measure_energies(&mut self, frame: &FrameView<'_>) {
        let [vx, vy, vz] = frame.velocity;
        let kinetic = sum([frame.mass, vx, vy, vz], |[mass, x, y, z]| {
            0.5 * mass * (x * x + y * y + z * z)
        });
        let rotational = frame.spin.map_or(0.0, |[wx, wy, wz]| {
            sum([frame.inertia, wx, wy, wz], |[inertia, x, y, z]| {
                0.5 * inertia * (x * x + y * y + z * z)
            })
        });
        let [x, _, z] = frame.position;
        let [gx, gz] = self.gravity;
        let gravitational = sum([frame.mass, x, z], |[mass, x, z]| {
            -(mass * gx * x) - mass * gz * z
        });
        let observations = &mut self.observations;
        observations.kinetic.push(kinetic as f32);
        observations.rotational.push(rotational as f32);
        observations.gravitational.push(gravitational as f32);
        observations.elastic.push(frame.elastic_energy as f32);
        let energy = kinetic + rotational + gravitational + frame.elastic_energy;
        self.measure_ledger(frame, energy);
    }

    fn measure_ledger(&mut self, frame: &FrameView<'_>, energy: f64) {
        let Some(ledger) = &frame.ledger else { return };
        let balance = energy + ledger.springs + ledger.damping + ledger.friction
            - ledger.air
            - ledger.brought;
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
        observations.energy_brought.push(ledger.brought as f32);
        observations.residual.push((balance - start) as f32);
    }

    fn measure_flow(&mut self, frame: &FrameView<'_>) {
        let Some(flow) = &frame.flow else { return };
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
        let coordination = flow.contacts as f64 / frame.count() as f64;
        observations.coordination.push(coordination as f32);
        let mass = sum([frame.mass], |[mass]| mass);
        observations.mass_inside.push(mass as f32);
    }

    fn measure_velocities(&mut self, frame: &FrameView<'_>) {
        let count = frame.count() as f64;
        let [x, y, _] = frame.position;
        let [vx, vy, vz] = frame.velocity;
        let speed = sum(frame.velocity, |[x, y, z]| (x * x + y * y + z * z).sqrt()) / count;
        let rise = sum([vz], |[vz]| vz) / count;
        let momentum = sum([frame.mass, x, y, vx, vy], |[mass, x, y, vx, vy]| {
            mass * (x * vy - y * vx)
        });
        let inertia = sum([frame.mass, x, y], |[mass, x, y]| mass * (x * x + y * y));
        // Spheres that all lie on the axis do not rotate about it.
        let rotation = if inertia > 0.0 {
            momentum / inertia
        } else {
            0.0
        };
        let fluctuation = sum([x, y, vx, vy, vz], |[x, y, vx, vy, vz]| {
            let x_part = vx + rotation * y;
            let y_part = vy - rotation * x;
            let z_part = vz - rise;
            x_part * x_part + y_part * y_part + z_part * z_part
        }) / count;
        let observations = &mut self.observations;
        observations.speed_mean.push(speed as f32);
        observations.rotation.push(rotation as f32);
        observations.fluctuation.push(fluctuation.sqrt() as f32);
    }

    fn measure_distances(&mut self, frame: &FrameView<'_>) {
        let [x, y, _] = frame.position;
        self.distance.clear();
        self.distance
            .extend(x.iter().zip(y).map(|(x, y)| (x * x + y * y).sqrt()));
        let mean = sum([&self.distance], |[distance]| distance) / frame.count() as f64;
        let observations = &mut self.observations;
        observations.hole_radius.push(least(&self.distance) as f32);
        observations
            .air_speed_mean
            .push((self.air_rotation * mean) as f32);
    }

    /// Returns the mean height (m).
    fn measure_heights(&mut self, frame: &FrameView<'_>) -> f64 {
        let z = frame.position[2];
        let mean = sum([z], |[z]| z) / frame.count() as f64;
        self.observations.height_mean.push(mean as f32);
        self.observations.height_max.push(largest(z) as f32);
        mean
    }

    fn measure_profile(&mut self, frame: &FrameView<'_>) {
        if self.bins == 0 {
            return;
        }
        let start = self.profile.len();
        self.profile.resize(start + self.bins, f32::NAN);
        let tops = &mut self.profile[start..];
        for (&distance, &z) in self.distance.iter().zip(frame.position[2]) {
            let top = &mut tops[bin(distance, self.bin_width, self.bins)];
            // Of a number and the NaN of an empty bin, `max` takes the number.
            *top = top.max(z as f32);
        }
    }

    fn measure_rising(&mut self, frame: &FrameView<'_>, height_mean: f64) {
        let columns = self.rises.len();
        let cells = self.distances.len() * columns;
        if cells == 0 {
            return;
        }
        let start = self.rising.len();
        self.rising.resize(start + cells, 0);
        let z = frame.position[2];
        let Some(previous) = &mut self.previous else {
            self.previous = Some(Previous {
                height: z.to_vec(),
                distance: self.distance.clone(),
                height_mean,
            });
            return;
        };

        let counts = &mut self.rising[start..];
        let mean = height_mean - previous.height_mean;
        let least = self.rises.iter().copied().fold(f64::INFINITY, f64::min);
        for (i, &radius) in frame.radius.iter().enumerate() {
            let rise = (z[i] - previous.height[i] - mean) / radius;
            // Most spheres do not rise.
            if rise < least {
                continue;
            }
            for (row, &within) in counts.chunks_exact_mut(columns).zip(&self.distances) {
                if previous.distance[i] <= within {
                    for (count, &threshold) in row.iter_mut().zip(&self.rises) {
                        *count = count.saturating_add(u16::from(rise >= threshold));
                    }
                }
            }
        }
        previous.height.copy_from_slice(z);
        previous.distance.copy_from_slice(&self.distance);
        previous.height_mean = height_mean;
    }
}

/// Index of the bin of this `distance` from the axis. Bin j reaches from j widths (without) to
/// j + 1 widths (with); the innermost holds the axis, and the outermost also what is beyond it:
/// a sphere pressed into a soft wall.
fn bin(distance: f64, width: f64, bins: usize) -> usize {
    let widths = distance / width;
    let below = widths as u32;
    let on_edge = widths == f64::from(below) && below > 0;
    (below as usize - usize::from(on_edge)).min(bins - 1)
}

#[cfg(test)]
mod tests;
