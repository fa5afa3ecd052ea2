//! Measures a simulation at a frame.
use super::*;
use crate::scene::Scene;
#[derive(Clone, Copy, Debug)]
pub struct FrameView<'a> {
    pub position: [&'a [f64]; 3],
    pub velocity: [&'a [f64]; 3],
    pub spin: Option<[&'a [f64]; 3]>,
    pub radius: &'a [f64],
    pub mass: &'a [f64],
    pub inertia: &'a [f64],
    pub elastic_energy: f64,
}
/// Measures a simulation at every frame.
pub struct Observer(Observations);
impl Observer {
    pub fn new(_: &Scene, _: &[f64]) -> Self {
        Self(Default::default())
    }
    pub fn observe(&mut self, t: f64, _: &FrameView<'_>) {
        self.0.time.push(t)
    }
    pub fn finish(self) -> Observations {
        self.0
    }
}
impl Snapshot {
    pub fn take(time: f64, _: &FrameView<'_>) -> Self {
        Self {
            time,
            ..Default::default()
        }
    }
}
