//! How many spheres came into a simulation and left it.

/// How many spheres came and went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Spheres of the scene.
    pub all: usize,
    /// Spheres that were in from the start.
    pub placed: usize,
    /// Spheres that came in, those from the start included.
    pub released: usize,
    /// Spheres that left properly, not while a door was closed.
    pub discharged: usize,
    /// Spheres that left while the door was still closed: over the rim, or never in the silo.
    pub spilled: usize,
    /// Whether a door is still to open.
    pub is_closed: bool,
    /// Whether spheres can leave.
    pub can_leave: bool,
}

impl Counts {
    /// Spheres that left, one way or the other.
    pub fn gone(&self) -> usize {
        self.discharged + self.spilled
    }

    /// The share of all entries and, if spheres can leave, exits that have happened. A sphere that
    /// was in from the start has no entry.
    pub fn share(&self) -> f64 {
        let in_done = self.released.saturating_sub(self.placed);
        let in_all = self.all.saturating_sub(self.placed);
        let (done, ways) = match self.can_leave {
            true => (in_done + self.gone(), in_all + self.all),
            false => (in_done, in_all),
        };
        match ways {
            0 => 0.0,
            _ => done as f64 / ways as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Symptom: a drainage of spheres that were all in at the start began at 50 %, and forecasts
    /// were far too long. Cause: their entries counted as done.
    #[test]
    fn spheres_that_were_in_have_no_way_in() {
        let counts = |placed, released, discharged| Counts {
            all: 100,
            placed,
            released,
            discharged,
            spilled: 0,
            is_closed: false,
            can_leave: true,
        };
        assert_eq!(counts(100, 100, 0).share(), 0.0);
        assert_eq!(counts(100, 100, 25).share(), 0.25);
        assert_eq!(counts(0, 100, 0).share(), 0.5);
        assert_eq!(counts(0, 100, 100).share(), 1.0);
        let closed = Counts {
            can_leave: false,
            ..counts(100, 100, 0)
        };
        assert_eq!(closed.share(), 0.0);
    }
}
