//! Checks of parameters.

use super::parameters::{Influence, Parameters, Relaxation, SpotOpening, Walk};

/// Insertions or moves per second above which a run cannot end.
const GREATEST_RATE: f64 = 1e9;

/// An invalid parameter.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{parameter} is {value}, but must be {requirement}")]
pub struct ParameterError {
    /// Name of the field of [`Parameters`].
    pub parameter: &'static str,
    /// Its value.
    pub value: f64,
    /// What it must be.
    pub requirement: String,
}

/// One condition on a parameter: name, value, whether it holds, and in words.
type SpotCondition = (&'static str, f64, bool, String);

impl Parameters {
    /// Finds the first invalid parameter.
    ///
    /// # Errors
    ///
    /// Its name, its value, and what it must be.
    pub fn check(&self) -> Result<(), ParameterError> {
        let conditions = [
            self.conditions_on_the_box(),
            self.conditions_on_the_opening(),
            self.conditions_on_spots(),
            self.conditions_on_modes(),
        ];
        first_broken(conditions.into_iter().flatten())
    }

    /// The same for the parameters of a packing: the box, and the spheres in it.
    pub(super) fn check_box(&self) -> Result<(), ParameterError> {
        first_broken(self.conditions_on_the_box())
    }

    fn conditions_on_the_box(&self) -> Vec<SpotCondition> {
        let d = self.diameter;
        vec![
            finite_above("diameter", d, 0.0),
            at_least("half_width", self.half_width, 0.5 * d),
            at_least("half_depth", self.half_depth, 0.5 * d),
        ]
    }

    fn conditions_on_the_opening(&self) -> Vec<SpotCondition> {
        let d = self.diameter;
        let (wide, deep) = (self.half_width, self.half_depth);
        let radius = self.spot_radius;
        let (name, opening, room) = match self.orifice {
            SpotOpening::Circle { radius } => ("orifice radius", radius, wide.min(deep)),
            SpotOpening::Slit { half_width } => ("orifice half-width", half_width, wide),
        };
        let room_for_spots = wide.min(deep);
        vec![
            at_most(name, opening, room, "half the box"),
            at_least(name, opening, 0.5 * d),
            at_most("spot_radius", radius, room_for_spots, "half the box"),
            (
                "wall_distance",
                self.wall_distance,
                self.wall_distance.abs() < room_for_spots,
                format!("between -{room_for_spots} m and {room_for_spots} m (half the box)"),
            ),
        ]
    }

    fn conditions_on_spots(&self) -> Vec<SpotCondition> {
        let d = self.diameter;
        let [x, y, z] = self.step;
        let (insertion, moves) = (self.insertion_rate, self.move_rate);
        let displacement = self.greatest_displacement();
        vec![
            finite_above("spot_radius", self.spot_radius, 0.5 * d),
            finite_above("relaxation_radius", self.relaxation_radius, 0.5 * d),
            finite_above("displacement_ratio", self.displacement_ratio, 0.0),
            at_least("step along x", x, 0.0),
            at_least("step along y", y, 0.0),
            finite_above("step along z", z, 0.0),
            finite_above("insertion_rate", insertion, 0.0),
            at_most("insertion_rate", insertion, GREATEST_RATE, "the limit"),
            finite_above("move_rate", moves, 0.0),
            at_most("move_rate", moves, GREATEST_RATE, "the limit"),
            finite_above("relaxation_strength", self.relaxation_strength, 0.0),
            at_most(
                "relaxation_strength",
                self.relaxation_strength,
                1.0,
                "the overlap",
            ),
            at_least("removal_height", self.removal_height, 0.0),
            at_most(
                "displacement of a sphere",
                displacement,
                0.5 * d,
                "half a diameter",
            ),
        ]
    }

    fn conditions_on_modes(&self) -> Vec<SpotCondition> {
        let mut all = Vec::new();
        if let Relaxation::AtRandom { ratio }
        | Relaxation::Counted { ratio }
        | Relaxation::Global { ratio } = self.relaxation
        {
            all.push(at_least("relaxation ratio", ratio as f64, 1.0));
        }
        if let Walk::Biased { exponent } = self.walk {
            all.push(at_least("walk exponent", exponent, 0.0));
            all.push(at_most("walk exponent", exponent, 100.0, "the limit"));
        }
        if let Influence::Weighted {
            volume_ratio,
            least_count,
            above,
        } = self.influence
        {
            all.push(finite_above("influence volume_ratio", volume_ratio, 0.0));
            all.push(at_least("influence least_count", least_count, 1.0));
            all.push(at_least("influence above", above, 0.0));
        }
        all
    }
}

/// An error for the first condition that does not hold.
fn first_broken(conditions: impl IntoIterator<Item = SpotCondition>) -> Result<(), ParameterError> {
    let mut conditions = conditions.into_iter();
    match conditions.find(|(_, _, holds, _)| !holds) {
        None => Ok(()),
        Some((parameter, value, _, requirement)) => Err(ParameterError {
            parameter,
            value,
            requirement,
        }),
    }
}

fn finite_above(name: &'static str, value: f64, limit: f64) -> SpotCondition {
    let holds = value.is_finite() && value > limit;
    (name, value, holds, format!("finite and above {limit}"))
}

fn at_least(name: &'static str, value: f64, limit: f64) -> SpotCondition {
    let holds = value.is_finite() && value >= limit;
    (name, value, holds, format!("finite and at least {limit}"))
}

fn at_most(name: &'static str, value: f64, limit: f64, what: &str) -> SpotCondition {
    (
        name,
        value,
        value <= limit,
        format!("at most {limit} ({what})"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(change: impl FnOnce(&mut Parameters)) -> &'static str {
        let mut parameters = Parameters::figure_2(1.0);
        change(&mut parameters);
        parameters.check().expect_err("refused").parameter
    }

    #[test]
    fn the_parameters_of_the_paper_pass_and_faults_are_named() {
        assert_eq!(Parameters::figure_2(1.0).check(), Ok(()));
        assert_eq!(refused(|it| it.spot_radius = 0.4), "spot_radius");
        assert_eq!(refused(|it| it.spot_radius = 4.5), "spot_radius");
        assert_eq!(
            refused(|it| it.displacement_ratio = 0.0),
            "displacement_ratio"
        );
        assert_eq!(refused(|it| it.wall_distance = 4.0), "wall_distance");
        assert_eq!(refused(|it| it.wall_distance = f64::NAN), "wall_distance");
        assert_eq!(refused(|it| it.move_rate = f64::INFINITY), "move_rate");
        let wide = SpotOpening::Circle { radius: 4.1 };
        assert_eq!(refused(|it| it.orifice = wide), "orifice radius");
        let never = Relaxation::Global { ratio: 0 };
        assert_eq!(refused(|it| it.relaxation = never), "relaxation ratio");
        assert_eq!(
            refused(|it| it.displacement_ratio = 1.5),
            "displacement of a sphere"
        );
    }
}
