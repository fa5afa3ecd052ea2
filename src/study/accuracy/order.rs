//! The order of a method: with which power of the step its error falls.

/// Orders that are looked for.
const ORDERS: [f64; 2] = [0.1, 8.0];

/// An order this near to an end of the range is the end: the errors ask for one beyond it.
const AT_END: f64 = 1e-6;

/// With which power of the step errors fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// With this power.
    Power(f64),
    /// With a lower power than this or none, which is no influence that could be measured.
    Below(f64),
    /// With a higher power than this.
    Above(f64),
}

impl Order {
    fn of([low, high]: [f64; 2], power: f64) -> Self {
        match power {
            power if power < low + AT_END => Self::Below(low),
            power if power > high - AT_END => Self::Above(high),
            power => Self::Power(power),
        }
    }

    /// The power; `None` if only a bound of it is known.
    pub fn power(self) -> Option<f64> {
        match self {
            Self::Power(power) => Some(power),
            Self::Below(_) | Self::Above(_) => None,
        }
    }

    /// The order with `decimals` decimals, as words after "order".
    pub fn in_words(self, decimals: usize) -> String {
        match self {
            Self::Power(power) => format!("{power:.decimals$}"),
            Self::Below(_) => "none, no measurable influence".to_owned(),
            Self::Above(bound) => format!("above {bound}"),
        }
    }
}

/// The order p and the largest misfit of ln(error) of the errors c |h^p - h_ref^p| at steps h,
/// where the reference that they were measured from has the step `reference` of the same method.
/// None with fewer than two steps, or errors that are zero or no numbers.
///
/// With a finest rung as reference the errors fall faster than h^p near it; left out, that would
/// pass for a higher order.
pub fn fitted_order(points: &[(f64, f64)], reference: Option<f64>) -> Option<(Order, f64)> {
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
    Some((Order::of(ORDERS, order), largest))
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
            let off = found.0.power().unwrap() - order;
            assert!(off.abs() < 1e-6 && found.1 < 1e-6, "{found:?}");
            let finest = 1.25e-4_f64;
            let error = |step: f64| 7.0 * (libm::pow(step, order) - libm::pow(finest, order));
            let relative = steps.map(|step| (step, error(step)));
            let found = fitted_order(&relative, Some(finest)).unwrap();
            let off = found.0.power().unwrap() - order;
            assert!(off.abs() < 1e-6 && found.1 < 1e-6, "{found:?}");
        }
    }

    /// Symptom: a key without influence had "order 0.10", one of steep errors "order 8.00". Cause:
    /// an end of the range of the search passed for what was found in it.
    #[test]
    fn an_end_of_the_range_is_no_order() {
        let steps = [1e-3, 5e-4, 2.5e-4];
        let order = |power: f64| {
            let points = steps.map(|step| (step, libm::pow(step, power)));
            fitted_order(&points, None).unwrap().0
        };
        assert_eq!(order(0.0), Order::Below(0.1));
        assert_eq!(order(0.05), Order::Below(0.1));
        assert_eq!(order(-1.0), Order::Below(0.1));
        assert_eq!(order(9.0), Order::Above(8.0));
        assert!(order(0.11).power().is_some() && order(7.9).power().is_some());
        assert_eq!(
            Order::Below(0.1).in_words(2),
            "none, no measurable influence"
        );
        assert_eq!(Order::Above(8.0).in_words(2), "above 8");
        assert_eq!(Order::Power(1.004).in_words(2), "1.00");
    }

    #[test]
    fn too_little_is_no_order() {
        assert_eq!(fitted_order(&[(1e-3, 1e-4)], None), None);
        assert_eq!(fitted_order(&[(1e-3, 0.0), (1e-4, 0.0)], None), None);
        assert_eq!(fitted_order(&[(1e-3, 1.0), (1e-4, f64::NAN)], None), None);
    }
}
