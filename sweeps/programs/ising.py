"""Anisotropic Ising model on periodic L x L and 2L x 2L lattices: moments of the magnetisation by
Swendsen-Wang updates. A set of sites is one integer; its bit x + y * size is the site (x, y)."""
import math, random

J1, J2 = @{J1}, @{J2}  # coupling over the temperature of the horizontal and the vertical bonds
L, measurements = @{L}, @{measurements}
random_bits = random.Random(@{seed32}).getrandbits

def biased_bits(p, sites):  # each bit is 1 with probability p, following the 20 binary digits of p
    bits = 0
    for digit in reversed(f"{round(p * 2**20):020b}"):
        bits = bits | random_bits(sites) if digit == "1" else bits & random_bits(sites)
    return bits

def simulate(size):  # yields m^2 and m^4 of each sweep, averaged over the signs of the clusters
    sites = size * size
    right = sum(1 << size * y + size - 1 for y in range(size))  # the last column
    top = sum(1 << sites - size + x for x in range(size))  # the last row
    forward = lambda s, step, edge: (s & ~edge) << step | (s & edge) >> step * (size - 1)
    back = lambda s, step, edge: s >> step & ~edge | s << step * (size - 1) & edge
    spins = random_bits(sites)
    while True:
        bonds1 = biased_bits(1 - math.exp(-2 * J1), sites) & ~(spins ^ back(spins, 1, right))
        bonds2 = biased_bits(1 - math.exp(-2 * J2), sites) & ~(spins ^ back(spins, size, top))
        rest = bonds1 | forward(bonds1, 1, right) | bonds2 | forward(bonds2, size, top)
        spins ^= random_bits(sites) & ~rest  # a site without bonds is a cluster of size 1
        sum2 = sum4 = sites - rest.bit_count()  # sums of the cluster sizes to the powers 2 and 4
        while rest:
            grown, cluster = rest & -rest, 0  # start at the lowest site that is left
            while grown != cluster:
                cluster = grown
                grown |= forward(grown & bonds1, 1, right) | back(grown, 1, right) & bonds1
                grown |= forward(grown & bonds2, size, top) | back(grown, size, top) & bonds2
            rest, spins = rest ^ cluster, spins ^ cluster * random_bits(1)
            sum2 += cluster.bit_count()**2
            sum4 += cluster.bit_count()**4
        yield sum2 / sites**2, (3 * sum2**2 - 2 * sum4) / sites**4

small, large = simulate(L), simulate(2 * L)
with open("binder.csv", "w") as file:
    print("block,m2_small,m4_small,m2_large,m4_large", file=file)
    for block in range(-4, 20):  # the first four come before equilibrium
        sweeps = [next(small) + next(large) for _ in range(measurements // 20)]
        if block >= 0:
            print(block, *[sum(m) / len(sweeps) for m in zip(*sweeps)], sep=",", file=file)
