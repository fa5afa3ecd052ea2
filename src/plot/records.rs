//! Records beside each other, without a sweep: what figures take, and what names them.

use super::{captions as names, text};
use crate::record::RunRecord;
use crate::scene::Scene;
use crate::store::DataSet;

/// Records of one family that a figure shows beside each other, one or more. Several are named by
/// the keys in which their scenes differ.
#[derive(Clone, Copy)]
pub struct RecordSet<'a> {
    /// The records.
    pub records: &'a [RunRecord],
    /// What names them instead, one each. Empty for the keys.
    pub labels: &'a [String],
    /// First and last time (s) of the states that count. None for the choice of the figure.
    pub times: Option<[f64; 2]>,
    /// Curves of other sources beside them.
    pub data: &'a [DataSet],
}

impl<'a> RecordSet<'a> {
    /// These records, with the names, states and curves that a figure shows by itself.
    pub fn of(records: &'a [RunRecord]) -> Self {
        Self {
            records,
            labels: &[],
            times: None,
            data: &[],
        }
    }
}

/// What names each of several records, without markup: the keys in which their scenes differ.
pub fn captions(records: &[&RunRecord]) -> Vec<Vec<String>> {
    let scenes: Vec<&Scene> = records.iter().map(|it| &it.scene).collect();
    plainly(names::of(&scenes))
}

/// The values of each of several records, without markup, of the keys in which their scenes differ
/// but for those that are `told` otherwise. Nothing where the scenes differ in no other.
pub fn differences(records: &[&RunRecord], told: &[&str]) -> Vec<Vec<String>> {
    let scenes: Vec<&Scene> = records.iter().map(|it| &it.scene).collect();
    plainly(names::differences(&scenes, told))
}

fn plainly(captions: Vec<Vec<String>>) -> Vec<Vec<String>> {
    let plainly = |parts: Vec<String>| parts.iter().map(|it| text::plain(it)).collect();
    captions.into_iter().map(plainly).collect()
}
