//! The restitution of the viscoelastic contact law, and the dissipation time that gives it.
//!
//! With lengths in v T and times in T = (m_eff / K)^(2/5) v^(-1/5), the law
//! F = max(0, K (xi^1.5 + c A sqrt(xi) dxi/dt)) of a head-on impact has one parameter, b = c A / T,
//! so that the restitution e is a function of b alone (Ramirez et al., Phys. Rev. E 60, 4465
//! (1999), there for a force that may attract).

/// Steps per unit of the integration variable; the error of e is below 1e-10.
const STEPS: f64 = 400.0;

/// Largest damping parameter considered; e is below 0.004 there.
const MOST_DAMPING: f64 = 100.0;

/// Restitution of a head-on impact at the damping parameter b = c A / T.
pub fn restitution(damping: f64) -> f64 {
    // In q = sqrt(xi), with ds = dt / (2 q): dq/ds = v and dv/ds = -2 q^2 (q^2 + b v), smooth
    // from the first touch to the end of contact, where the force q (q^2 + b v) is back at zero.
    let slope = |[q, v]: [f64; 2]| [v, -2.0 * q * q * (q * q + damping * v)];
    let excess = |[q, v]: [f64; 2]| {
        // Without damping the force ends where the overlap does.
        if damping == 0.0 {
            q
        } else {
            q * q + damping * v
        }
    };
    let mut state = runge_kutta(slope, [0.0, 1.0], 1.0 / STEPS);
    loop {
        let next = runge_kutta(slope, state, 1.0 / STEPS);
        let [before, after] = [excess(state), excess(next)];
        if after <= 0.0 {
            let rest = before / (before - after) / STEPS;
            return -runge_kutta(slope, state, rest)[1];
        }
        state = next;
    }
}

/// One step of the classical fourth-order scheme.
fn runge_kutta(slope: impl Fn([f64; 2]) -> [f64; 2], state: [f64; 2], step: f64) -> [f64; 2] {
    let ahead =
        |slope: [f64; 2], step: f64| [state[0] + slope[0] * step, state[1] + slope[1] * step];
    let k1 = slope(state);
    let k2 = slope(ahead(k1, 0.5 * step));
    let k3 = slope(ahead(k2, 0.5 * step));
    let k4 = slope(ahead(k3, step));
    let mean = |i: usize| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0;
    ahead([mean(0), mean(1)], step)
}

/// The damping parameter b of a restitution, by bisection, so that it depends only on
/// multiplications, additions and divisions. At most 100: smaller restitutions give 100.
pub fn damping_parameter(target: f64) -> f64 {
    if target >= 1.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    while high < MOST_DAMPING && restitution(high) > target {
        (low, high) = (high, f64::min(2.0 * high, MOST_DAMPING));
    }
    loop {
        let middle = 0.5 * (low + high);
        if high - low <= 1e-13 * high || middle <= low || middle >= high {
            return middle;
        }
        if restitution(middle) > target {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// Time scale T = (m_eff / K)^(2/5) v^(-1/5) (s) of a Hertz contact: effective mass (kg),
/// K (N/m^1.5), relative speed (m/s).
pub fn time_scale(effective_mass: f64, stiffness: f64, speed: f64) -> f64 {
    libm::pow(effective_mass / stiffness, 0.4) / libm::pow(speed, 0.2)
}

/// The dissipation time A (s) with which a head-on impact of time scale `time_scale` (s) has this
/// restitution; `factor` is the c of the law.
pub fn dissipation_time_from_restitution(restitution: f64, time_scale: f64, factor: f64) -> f64 {
    damping_parameter(restitution) * time_scale / factor
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computed with an adaptive eighth-order scheme at a relative tolerance of 1e-12.
    const TABLE: [(f64, f64); 6] = [
        (0.05, 0.9443967792),
        (0.1, 0.8928588755),
        (0.2, 0.8009654681),
        (0.5, 0.5952515011),
        (1.0, 0.3939306032),
        (2.0, 0.2116460546),
    ];

    #[test]
    fn restitution_of_known_damping() {
        assert!((restitution(0.0) - 1.0).abs() < 1e-10);
        for (damping, expected) in TABLE {
            let found = restitution(damping);
            assert!((found - expected).abs() < 2e-10, "{damping}: {found}");
        }
    }

    #[test]
    fn damping_of_known_restitution() {
        assert_eq!(damping_parameter(1.0), 0.0);
        for (expected, restitution) in TABLE {
            let found = damping_parameter(restitution);
            assert!(
                (found / expected - 1.0).abs() < 1e-9,
                "{restitution}: {found}"
            );
        }
    }

    #[test]
    fn restitution_falls_with_damping_over_the_whole_range() {
        let values: Vec<f64> = (0..=100).map(|b| restitution(f64::from(b))).collect();
        assert!(values.windows(2).all(|pair| pair[1] < pair[0]));
        assert!(values[100] > 0.0 && values[100] < 0.01, "{}", values[100]);
    }
}
