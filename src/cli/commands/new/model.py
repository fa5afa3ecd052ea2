"""An epidemic among 1000 people who meet at random. A person who is ill infects others at the rate
`infection` and recovers at the rate `recovery`, both per day."""
import math
import random

infection, recovery = @{infection}, @{recovery}
people, ill, recovered = 1000, 10, 0
numbers = random.Random(@{seed32})


def happens_to(count, rate):  # to how many of them, within a day
    return sum(numbers.random() < 1 - math.exp(-rate) for _ in range(count))


with open("epidemic.csv", "w") as table:
    print("day,ill,ever", file=table)
    for day in range(301):
        print(day, ill / people, (ill + recovered) / people, sep=",", file=table)
        infected = happens_to(people - ill - recovered, infection * ill / people)
        cured = happens_to(ill, recovery)
        ill, recovered = ill + infected - cured, recovered + cured
