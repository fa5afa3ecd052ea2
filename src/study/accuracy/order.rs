//! The order of a method: with which power of the step its error falls.

/// Orders that are looked for.
const ORDERS: [f64; 2] = [0.1, 8.0];

/// The order p and the largest misfit of ln(error) of the errors c |h^p - h_ref^p| at steps h,
/// where the reference that they were measured from has the step `reference` of the same method.
/// None with fewer than two steps, or errors that are zero or no numbers.
///
/// With a finest rung as reference the errors fall faster than h^p near it; left out, that would
/// pass for a higher order.
pub fn fitted_order(points: &[(f64, f64)], reference: Option<f64>) -> Option<(f64, f64)> {
    let reference = reference.unwrap_or(0.0);
    let usable = |(step, error): &&(f64, f64)| *step > reference && error.is_finite();
    let points: Vec<(f64, f64)> = points.iter().filter(usable).copied().collect();
    if points.len() < 2 || points.iter().any(|(_, error)| *error <= 0.0) {
        return None;
    }
    let misfits = |order: f64| {
        let model = |step: f64| {
            let reference = match reference {
                0.0 => 0.0,
                step => libm::pow(step, order),
            };
            libm::log(libm::pow(step, order) - reference)
        };
        let misfits = points
            .iter()
            .map(|(step, error)| libm::log(*error) - model(*step));
        let misfits: Vec<f64> = misfits.collect();
        let mean = misfits.iter().sum::<f64>() / misfits.len() as f64;
        misfits
            .into_iter()
            .map(move |it| it - mean)
            .collect::<Vec<_>>()
    };
    let squares = |order: f64| misfits(order).iter().map(|it| it * it).sum::<f64>();
    let order = minimum(ORDERS, squares);
    let largest = misfits(order).into_iter().map(f64::abs).fold(0.0, f64::max);
    Some((order, largest))
}

/// Where a function of one valley is least, by the golden section.
fn minimum([mut low, mut high]: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..60 {
        let (first, second) = (high - ratio * (high - low), low + ratio * (high - low));
        if of(first) < of(second) {
            high = second;
        } else {
            low = first;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_of_known_errors_are_found() {
        for order in [1.0, 2.0, 4.0] {
            let steps = [1e-3, 5e-4, 2.5e-4];
            let plain = steps.map(|step: f64| (step, 7.0 * libm::pow(step, order)));
            let found = fitted_order(&plain, None).unwrap();
            assert!(
                (found.0 - order).abs() < 1e-6 && found.1 < 1e-6,
                "{found:?}"
            );
            let finest = 1.25e-4_f64;
            let error = |step: f64| 7.0 * (libm::pow(step, order) - libm::pow(finest, order));
            let relative = steps.map(|step| (step, error(step)));
            let found = fitted_order(&relative, Some(finest)).unwrap();
            assert!(
                (found.0 - order).abs() < 1e-6 && found.1 < 1e-6,
                "{found:?}"
            );
        }
    }

    #[test]
    fn too_little_is_no_order() {
        assert_eq!(fitted_order(&[(1e-3, 1e-4)], None), None);
        assert_eq!(fitted_order(&[(1e-3, 0.0), (1e-4, 0.0)], None), None);
        assert_eq!(fitted_order(&[(1e-3, 1.0), (1e-4, f64::NAN)], None), None);
    }
}
