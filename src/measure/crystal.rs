//! Which spheres are part of a crystal: bond order.

use super::{CellGrid, Centres};
use crate::particles::vector::Vector;

/// Two neighbours have similar bonds if their product is larger than this.
const ALIKE: f64 = 0.7;
/// Number of neighbours with similar bonds that make a sphere solid-like.
const FEWEST: usize = 8;

/// Whether each sphere is part of a crystal of any lattice: whether its bonds have directions
/// similar to the bonds of at least eight neighbours. Bonds are compared by the normalised product
/// of the spherical harmonics of degree 6 (ten Wolde, Ruiz-Montero and Frenkel, Faraday Discussions
/// 104, 93 (1996)); these products are sums of Legendre polynomials P6 of the angles between the
/// bonds of the two spheres.
///
/// In a random dense packing this holds for 1 % or less, in a crystal for all spheres but those at
/// its surface.
///
/// * `cutoff`: largest distance of a neighbour (m), usually 1.3 diameters
pub fn solid_like(centres: &Centres, cutoff: f64) -> Vec<bool> {
    let grid = CellGrid::new(&centres.place, cutoff);
    let places = centres.place.iter().enumerate();
    let bonds: Vec<Vec<(usize, Vector)>> = places
        .map(|(own, place)| {
            let mut bonds = Vec::new();
            grid.within(*place, cutoff, |other, away| {
                if other != own && away.norm_squared() > 0.0 {
                    bonds.push((other, away * (1.0 / away.norm())));
                }
            });
            bonds
        })
        .collect();
    let norms: Vec<f64> = bonds.iter().map(|it| product(it, it).sqrt()).collect();
    let is_alike = |own: usize, other: usize| {
        product(&bonds[own], &bonds[other]) > ALIKE * norms[own] * norms[other]
    };
    let alike = |own: usize| {
        let partners = bonds[own].iter();
        partners.filter(|(other, _)| is_alike(own, *other)).count()
    };
    (0..bonds.len()).map(|own| alike(own) >= FEWEST).collect()
}

/// Sum of P6 over all pairs of a bond of one sphere and one of another.
fn product(one: &[(usize, Vector)], other: &[(usize, Vector)]) -> f64 {
    let of_bond = |bond: &Vector| -> f64 {
        let products = other.iter().map(|(_, it)| legendre_6(bond.dot(*it)));
        products.sum()
    };
    one.iter().map(|(_, bond)| of_bond(bond)).sum()
}

fn legendre_6(x: f64) -> f64 {
    let square = x * x;
    (((231.0 * square - 315.0) * square + 105.0) * square - 5.0) / 16.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::{face_centred, ideal_gas};

    fn share(solid: &[bool]) -> f64 {
        solid.iter().filter(|it| **it).count() as f64 / solid.len() as f64
    }

    #[test]
    fn a_lattice_is_solid_and_a_gas_is_not() {
        let lattice = face_centred(6);
        let spacing = (lattice.place[1] - lattice.place[0]).norm();
        assert!(share(&solid_like(&lattice, 1.3 * spacing)) > 0.6);
        let gas = ideal_gas(2000, 10.0, "solid-like");
        assert!(share(&solid_like(&gas, 1.3)) < 0.02);
    }

    #[test]
    fn the_polynomial_has_its_values() {
        for (x, value) in [(1.0, 1.0), (-1.0, 1.0), (0.0, -5.0 / 16.0), (0.5, 0.323242)] {
            assert!((legendre_6(x) - value).abs() < 1e-6, "{x}");
        }
    }
}
