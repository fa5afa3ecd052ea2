//! The identity of a run: a hash of everything that determines its motion.

use super::{Neighbours, Output, Scene};

impl Scene {
    /// Sixteen hexadecimal digits that stand for everything which determines the motion: all keys
    /// but `title`, `neighbours` and `output`. Runs of equal identity have equal bits, and every
    /// random number of a run derives from it.
    pub fn identity(&self) -> String {
        let scene = Scene {
            title: None,
            neighbours: Neighbours::default(),
            output: Output::default(),
            ..self.clone()
        };
        // Field order is that of the struct and numbers are written shortest-round-trip, so
        // the text is canonical. It goes to the hash as it is written: a start of a million spheres
        // would make a long one.
        let mut hasher = blake3::Hasher::new();
        serde_json::to_writer(&mut hasher, &scene).expect("a scene holds no map with odd keys");
        hasher.finalize().to_hex()[..16].to_owned()
    }

    /// The random stream of this run that serves one `purpose`. Streams of different
    /// purposes or of different runs are independent.
    pub fn random_stream(&self, purpose: &str) -> rand_pcg::Pcg64 {
        use rand::SeedableRng;
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.identity().as_bytes());
        hasher.update(purpose.as_bytes());
        rand_pcg::Pcg64::from_seed(*hasher.finalize().as_bytes())
    }
}
