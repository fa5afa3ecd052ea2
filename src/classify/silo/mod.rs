//! Silos: grains that leave (Remmers, 2009). Their sieves look at what leaves once the door is
//! open.

pub(super) mod arching;
pub(super) mod flowing;
mod order;
pub(super) mod outflow;
#[cfg(test)]
mod synthetic;

pub use arching::ArchingSieve;
pub use flowing::FlowingSieve;

pub(super) use outflow::Outflow;

use super::lengths::check_lengths;
use super::rules::rule;
use super::sieve::values;
use super::sieves::SILO_SIEVES;
use super::{ClassifyError, Family, Label, Sieves};
use crate::record::RunRecord;
use crate::scene::Tank;
use order::SiloOrder;

/// Scenes with a door or an outlet, but no opening in the floor of a tank.
pub static SILO: Family = Family {
    name: "silo",
    rules: &[rule!(
        Label::EMPTIED,
        "emptied",
        "discharged_share >= 0.95 or arching_margin >= 0 and over_opening == 0"
    )],
    sieves: SILO_SIEVES,
    without_sieve: &[Label::UNSTABLE, Label::UNSETTLED],
    order: SiloOrder::MEASURES,
    default_figures: &["phase", "discharge-rate"],
    takes: |scene| {
        let is_drainage = scene.tank.as_ref().is_some_and(Tank::has_opening);
        !is_drainage && (scene.dem.door.is_some() || scene.dem.outlet.is_some())
    },
    check: |_, scene| match scene.dem.outlet {
        Some(_) => Ok(()),
        None => Err(ClassifyError::NoOutlet),
    },
    judge,
    measured: &[],
    base: None,
};

impl Label {
    /// (Nearly) all grains have left a silo, or all that could.
    pub const EMPTIED: Self = Self::new(8, "emptied", 0xe2_bd_6c);
}

/// The first sieve that says yes decides, of a silo that is not empty.
fn judge(record: &RunRecord, sieves: &Sieves) -> Result<(Label, Vec<Option<f64>>), ClassifyError> {
    check_lengths(record)?;
    let mut run = Outflow::new(record)?;
    let sifted = sieves.sift_silo(&mut run);
    let label = sifted.iter().find_map(|it| it.label);
    let order = SiloOrder::measure(&run);
    Ok((
        label.unwrap_or(Label::UNSETTLED),
        values(sifted, order.values()),
    ))
}

#[cfg(test)]
mod tests {
    use super::synthetic::{draining, judge};
    use super::*;
    use crate::classify::{Rules, classify};
    use crate::scene::LabelRule;

    #[test]
    fn the_share_itself_is_enough_to_be_empty() {
        // Of 200 grains, 190 are 95 %.
        let emptied = judge(&draining(190, 1.0).at_rest(30.0));
        assert_eq!(emptied.label, Label::EMPTIED);
        assert_eq!(emptied.value("emptied_margin"), Some(0.0));
        let arching = judge(&draining(189, 1.0).at_rest(30.0));
        assert_eq!(arching.label, Label::ARCHING);
        assert!(arching.value("emptied_margin").unwrap() < 0.0);
        assert_eq!(arching.value("emptied_value"), Some(189.0 / 200.0));
        assert_eq!(arching.value("emptied_threshold"), Some(0.95));
    }

    #[test]
    fn an_empty_silo_is_empty_however_late_its_last_grain_left() {
        let verdict = judge(&draining(200, 0.05));
        assert_eq!(verdict.label, Label::EMPTIED);
        assert!(verdict.value("flowing_margin").unwrap() >= 0.0);
    }

    #[test]
    fn a_rule_of_a_file_takes_the_place_of_the_rule_of_its_name() {
        let record = draining(150, 1.0).at_rest(30.0);
        assert_eq!(judge(&record).label, Label::ARCHING);
        let rule = |name: &str, when: &str| LabelRule {
            name: name.to_owned(),
            when: when.to_owned(),
            over: None,
            color: None,
        };
        let labelled = |labels: Vec<LabelRule>| {
            let rules = Rules {
                labels,
                measures: Vec::new(),
                sieves: true,
            };
            assert!(rules.problems(&record.scene, &[]).is_empty());
            let sieves = Sieves {
                rules,
                ..Sieves::default()
            };
            classify(&record, &sieves).unwrap()
        };
        let sooner = labelled(vec![rule("emptied", "discharged_share >= 0.7")]);
        assert_eq!(sooner.label, Label::EMPTIED);
        assert_eq!(sooner.value("emptied_threshold"), Some(0.7));
        let columns = |family: &Family| family.measures().map(|it| it.name).collect::<Vec<_>>();
        assert_eq!(columns(sooner.family), columns(&SILO));
        // Where no rule holds, the sieves decide.
        let other = labelled(vec![rule("half", "discharged_share < 0.5")]);
        assert_eq!(other.label, Label::ARCHING);
        assert!(other.family.extends(&SILO));
    }
}
