//! What spheres do in each of several bins.

use crate::measure::TankLayer;
use crate::scene::{ColumnProfile, ProfileAxis, ProfiledQuantity};
use crate::simulation::{Frame, FrameView};

/// Sums over the spheres in a bin.
#[derive(Clone, Copy, Default)]
struct BinSums {
    count: f64,
    velocity: [f64; 3],
    squares: f64,
    /// Angular momentum about the axis (kg m2/s) and moment of inertia of the centres (kg m2).
    momentum: f64,
    inertia: f64,
    /// Volume of the parts of spheres that are in the bin (m3).
    volume: f64,
}

/// The values of a profile at a frame, a bin after the other, in a tank of this cross-section (m2)
/// whose spheres move in so many dimensions.
pub(super) fn values(
    profile: &ColumnProfile,
    frame: &dyn Frame,
    area: f64,
    dimensions: f64,
) -> Vec<f64> {
    let mut bins = vec![BinSums::default(); profile.bins];
    frame.show(&mut |block| match profile.of {
        ProfiledQuantity::PackingFraction => add_volumes(profile, block, area, &mut bins),
        _ => add_spheres(profile, block, &mut bins),
    });
    let width = (profile.to - profile.from) / profile.bins as f64;
    let bins = bins.into_iter();
    bins.map(|bin| {
        let [x, y, z] = bin.velocity.map(|sum| sum / bin.count);
        match profile.of {
            ProfiledQuantity::Count => bin.count,
            ProfiledQuantity::VelocityX => x,
            ProfiledQuantity::VelocityY => y,
            ProfiledQuantity::VelocityZ => z,
            ProfiledQuantity::AngularVelocity => bin.momentum / bin.inertia,
            ProfiledQuantity::GranularTemperature => {
                let mean_square = bin.squares / bin.count;
                (mean_square - (x * x + y * y + z * z)) / dimensions
            }
            ProfiledQuantity::PackingFraction => bin.volume / (area * width),
        }
    })
    .collect()
}

fn add_spheres(profile: &ColumnProfile, block: &FrameView<'_>, bins: &mut [BinSums]) {
    let ([x, y, z], [vx, vy, vz]) = (block.position, block.velocity);
    let scale = profile.bins as f64 / (profile.to - profile.from);
    for i in 0..z.len() {
        let at = match profile.over {
            ProfileAxis::Height => z[i],
            ProfileAxis::Radius => (x[i] * x[i] + y[i] * y[i]).sqrt(),
        };
        let place = (at - profile.from) * scale;
        // Not a number is in no bin.
        if !(place >= 0.0 && place < profile.bins as f64) {
            continue;
        }
        let bin = &mut bins[place as usize];
        bin.count += 1.0;
        for (sum, velocity) in bin.velocity.iter_mut().zip([vx[i], vy[i], vz[i]]) {
            *sum += velocity;
            bin.squares += velocity * velocity;
        }
        bin.momentum += block.mass[i] * (x[i] * vy[i] - y[i] * vx[i]);
        bin.inertia += block.mass[i] * (x[i] * x[i] + y[i] * y[i]);
    }
}

fn add_volumes(profile: &ColumnProfile, block: &FrameView<'_>, area: f64, bins: &mut [BinSums]) {
    for (number, bin) in bins.iter_mut().enumerate() {
        let [bottom, top] = profile.ends(number);
        let layer = TankLayer {
            bottom,
            top,
            area,
            period: None,
        };
        for (z, radius) in block.position[2].iter().zip(block.radius) {
            bin.volume += layer.part_of_sphere(*z, *radius);
        }
    }
}
