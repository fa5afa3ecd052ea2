//! Which of those that are near each other touch: contacts are computed of these alone.

use super::meeting::Solid;
use super::wall_contacts::NearSphere;
use crate::dem::block::{ROWS, row, turned};
use crate::dem::neighbours::NearPair;
use crate::dem::particles::Particles;
use crate::dem::walls::Wall;
use fearless_simd::{Simd, SimdBase, SimdMask, f64x8};

/// Contacts that are looked at before those that touch are computed: few enough to stay at hand, so many that
/// few lanes are left over.
pub(super) const LOOK: usize = 1024;

/// Contacts that are looked at as the bits of one number.
const WORD: usize = 64;

/// A possible contact, which knows where its history is.
pub(super) trait Entry: Copy + Default {
    /// The same with its history there.
    fn at(self, entry: usize) -> Self;

    /// Where its history is.
    fn entry(self) -> usize;
}

impl Entry for NearPair {
    #[inline(always)]
    fn at(self, entry: usize) -> Self {
        let entry = entry as u32;
        Self { entry, ..self }
    }

    #[inline(always)]
    fn entry(self) -> usize {
        self.entry as usize
    }
}

impl Entry for NearSphere {
    #[inline(always)]
    fn at(self, entry: usize) -> Self {
        let entry = entry as u32;
        Self { entry, ..self }
    }

    #[inline(always)]
    fn entry(self) -> usize {
        self.entry as usize
    }
}

/// Contacts that touch, in the order of their list.
pub(super) struct Touching<C>(Box<[C; LOOK]>);

impl<C: Entry> Touching<C> {
    pub(super) fn new() -> Self {
        Self(Box::new([C::default(); LOOK]))
    }

    /// Finds who touches among these, up to [`LOOK`] of them, the first of which has its history `from`
    /// there on; histories of the others begin anew.
    #[inline(always)]
    fn find<H: Default>(
        &mut self,
        near: &[C],
        from: usize,
        histories: &mut [H],
        touch: impl Fn(&[C; ROWS]) -> u64,
    ) -> &[C] {
        let mut found = 0;
        for (first, word) in (0..).step_by(WORD).zip(near.chunks(WORD)) {
            let mut touching = 0;
            for (lane, contacts) in word.chunks(ROWS).enumerate() {
                let bits = match <&[C; ROWS]>::try_from(contacts) {
                    Ok(eight) => touch(eight),
                    Err(_) => {
                        let mut eight = [contacts[0]; ROWS];
                        eight[..contacts.len()].copy_from_slice(contacts);
                        touch(&eight) & ((1 << contacts.len()) - 1)
                    }
                };
                touching |= bits << (lane * ROWS);
            }
            if size_of::<H>() > 0 {
                let all = u64::MAX >> (WORD - word.len());
                for k in ones(all & !touching) {
                    histories[from + first + k] = H::default();
                }
            }
            for k in ones(touching) {
                self.0[found] = word[k].at(from + first + k);
                found += 1;
            }
        }
        &self.0[..found]
    }
}

impl Touching<NearPair> {
    /// [Finds](Self::find) pairs that touch; `alike` says what all spheres are like, if they are alike.
    #[inline(always)]
    pub(super) fn pairs<S: Simd, H: Default>(
        &mut self,
        simd: S,
        near: &[NearPair],
        from: usize,
        histories: &mut [H],
        particles: &Particles,
        alike: Option<Solid>,
    ) -> &[NearPair] {
        let Particles {
            position, radius, ..
        } = particles;
        let position = &position[..];
        self.find(
            near,
            from,
            histories,
            #[inline(always)]
            |eight| {
                let [x, y, z] = turned::<S>(
                    #[inline(always)]
                    |k| row(simd, position, eight[k].i) - row(simd, position, eight[k].j),
                );
                let sum = match alike {
                    Some(solid) => f64x8::splat(simd, solid.radius + solid.radius),
                    None => {
                        let mut sum = [0.0; ROWS];
                        for k in 0..ROWS {
                            let NearPair { i, j, .. } = eight[k];
                            sum[k] = radius[i as usize] + radius[j as usize];
                        }
                        f64x8::from_slice(simd, &sum)
                    }
                };
                (x * x + y * y + z * z).simd_lt(sum * sum).to_bitmask()
            },
        )
    }
}

impl Touching<NearSphere> {
    /// [Finds](Self::find) spheres that touch a wall.
    #[inline(always)]
    pub(super) fn spheres<W: Wall, H: Default>(
        &mut self,
        near: &[NearSphere],
        from: usize,
        histories: &mut [H],
        particles: &Particles,
        wall: W,
    ) -> &[NearSphere] {
        let Particles {
            position, radius, ..
        } = particles;
        self.find(
            near,
            from,
            histories,
            #[inline(always)]
            |eight| {
                let mut touching = 0;
                for (k, sphere) in eight.iter().enumerate() {
                    let i = sphere.i as usize;
                    let contact = wall.contact(position[i], radius[i]);
                    touching |= u64::from(contact.touches) << k;
                }
                touching
            },
        )
    }
}

/// The places of the ones among bits.
#[inline(always)]
fn ones(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(
        #[inline(always)]
        move || {
            let place = (bits != 0).then(|| bits.trailing_zeros() as usize);
            bits &= bits.wrapping_sub(1);
            place
        },
    )
}
