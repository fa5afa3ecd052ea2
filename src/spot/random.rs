//! Named streams of random numbers that can be resumed.

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// A stream of random numbers. Streams of different names or seeds are independent.
#[derive(Clone, Debug)]
pub(crate) struct RandomStream {
    generator: Pcg64,
    drawn: u64,
}

impl RandomStream {
    /// The stream of this name.
    pub(crate) fn new(name: &str, seed: u64) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(name.as_bytes());
        hasher.update(&seed.to_le_bytes());
        Self {
            generator: Pcg64::from_seed(*hasher.finalize().as_bytes()),
            drawn: 0,
        }
    }

    /// The stream of this name after some draws.
    pub(crate) fn resumed(name: &str, seed: u64, drawn: u64) -> Self {
        let mut stream = Self::new(name, seed);
        stream.generator.advance(u128::from(drawn));
        stream.drawn = drawn;
        stream
    }

    /// Number of draws so far.
    pub(crate) fn drawn(&self) -> u64 {
        self.drawn
    }

    /// 64 random bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.drawn += 1;
        self.generator.next_u64()
    }

    /// Uniform in 0 <= x < 1.
    pub(crate) fn uniform(&mut self) -> f64 {
        const UNIT: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.bits() >> 11) as f64 * UNIT
    }

    /// One of the numbers below `count`, which is positive.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }

    /// Exponentially distributed, of mean 1.
    pub(crate) fn exponential(&mut self) -> f64 {
        -libm::log(1.0 - self.uniform())
    }

    /// Poisson distributed: how many exponential waiting times fit into the mean.
    pub(crate) fn poisson(&mut self, mean: f64) -> u64 {
        let (mut count, mut time) = (0, self.exponential());
        while time <= mean {
            count += 1;
            time += self.exponential();
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::RandomStream;

    #[test]
    fn a_resumed_stream_goes_on() {
        let mut stream = RandomStream::new("walk", 7);
        (0..10).for_each(|_| assert!(stream.exponential() >= 0.0));
        let mut resumed = RandomStream::resumed("walk", 7, stream.drawn());
        assert_eq!(stream.bits(), resumed.bits());
        assert_ne!(
            RandomStream::new("walk", 7).bits(),
            RandomStream::new("walk", 8).bits()
        );
        assert_ne!(
            RandomStream::new("walk", 7).bits(),
            RandomStream::new("other", 7).bits()
        );
    }

    #[test]
    fn poisson_numbers_have_equal_mean_and_variance() {
        let mut stream = RandomStream::new("poisson", 1);
        let numbers: Vec<f64> = (0..20_000).map(|_| stream.poisson(13.4) as f64).collect();
        let mean = numbers.iter().sum::<f64>() / 2e4;
        let variance = numbers
            .iter()
            .map(|it| (it - mean) * (it - mean))
            .sum::<f64>()
            / 2e4;
        assert!((mean - 13.4).abs() < 0.1, "mean {mean}");
        assert!((variance - 13.4).abs() < 0.6, "variance {variance}");
    }
}
