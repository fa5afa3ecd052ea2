//! The packing that drainages start with.

use phase::particles::vector::Vector;
use phase::spot::Parameters;
use phase::spot::packing::{packing_fraction, random_packing};

/// Pairs of centres nearer than a diameter of 1 m.
fn overlaps(centres: &[Vector]) -> usize {
    let mut by_height = centres.to_vec();
    by_height.sort_by(|one, other| one.z.total_cmp(&other.z));
    let near = |(place, centre): (usize, &Vector)| {
        let above = by_height[place + 1..].iter();
        let above = above.take_while(|it| it.z - centre.z < 1.0);
        above.filter(|it| (**it - *centre).norm() < 1.0).count()
    };
    by_height.iter().enumerate().map(near).sum()
}

/// Rycroft, Wong and Bazant (2010) start from a packing fraction of 0.64 in the bulk. The lid stops
/// at 0.64, or where spheres jam.
#[test]
#[ignore = "takes two to five minutes"]
fn the_full_box_is_as_dense_as_the_papers_and_without_overlap() {
    let parameters = Parameters::figure_2(1.0);
    let centres = random_packing(&parameters, 55_000, 1, 2).unwrap();
    let fraction = packing_fraction(&parameters, &centres);
    assert!((fraction - 0.64).abs() < 0.005, "{fraction}");
    assert_eq!(overlaps(&centres), 0);
}
