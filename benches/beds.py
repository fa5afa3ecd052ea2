"""Beds of spheres at rest: in an open tank, of any size, made by `phase` from `bed.toml`, or in a box."""

import csv
import itertools
import math
import os
from collections import deque

from common import FOLDER, output

LAWS = {
    "none": None,
    "mindlin": 'law = "mindlin"\ncoefficient = 0.3',
    "coulomb": 'law = "coulomb"\ncoefficient = 0.3\nregularisation = 1e-3',
}
RADIUS, DENSITY, YOUNG, POISSON, DISSIPATION, MU, DT = 0.004, 1e4, 2e5 * math.sqrt(2), 0.3, 1e-3, 0.3, 1e-4
MASS = 4 / 3 * math.pi * RADIUS**3 * DENSITY


def states(table):
    """The states of a table of spheres that was exported from a record, as lists of rows by column."""
    rows = csv.DictReader(open(table))
    return (list(state) for _, state in itertools.groupby(rows, lambda row: row["time"]))


def last_rows(folder):
    """The spheres of the last state of a record that was exported to CSV files there, as rows by column."""
    tables = sorted(folder.glob("*.csv"))
    return deque(states([path for path in tables if "observ" not in path.name][-1]), maxlen=1).pop()


def write_lammps(path, spheres, radius, density, box, fixed=()):
    """A data file of LAMMPS: spheres of type 1 with all their motion, if it is given, and fixed ones of type 2."""
    sides = "".join(f"{low} {high} {axis}lo {axis}hi\n" for axis, (low, high) in zip("xyz", box))
    numbered = list(enumerate([*((1, sphere) for sphere in spheres), *((2, sphere) for sphere in fixed)], 1))
    text = f"spheres\n\n{len(numbered)} atoms\n{2 if fixed else 1} atom types\n\n{sides}\nAtoms\n\n"
    atom, motion = "%d %d %r %r %r %r %r\n", "%d" + 6 * " %r" + "\n"
    text += "".join(atom % (i, kind, 2 * radius, density, *sphere[:3]) for i, (kind, sphere) in numbered)
    if len(spheres[0]) > 3:
        text += "\nVelocities\n\n"
        text += "".join(motion % (i, *(sphere[3:] or 6 * [0.0])) for i, (_, sphere) in numbered)
    path.write_text(text)


class Bed:
    """Spheres at rest: their places, and the files from which programs start with them."""

    columns = ["x", "y", "z"]
    radius, density, dt, laws, weight = RADIUS, DENSITY, DT, ["mindlin", "coulomb"], 9.8 * MASS
    # The most kinetic energy of a sphere at rest, over its weight times its radius. A deep bed creeps where nothing
    # but viscous friction holds it: some centimetres in a second in LAMMPS.
    stir = {"mindlin": 1e-3, "coulomb": 1e-2}
    # Spheres that may leave while steps are measured.
    leaving = 0

    def __init__(self, size, phase, folder):
        """A size is a number of spheres, or NUMBER=RECORD.h5 of as many that have come to rest."""
        count, _, record = size.partition("=")
        self.count = count = int(count)
        self.folder = folder
        self.scale = (count / 256) ** (1 / 3)
        self.tank = 0.06 * self.scale
        base = (FOLDER / "bed.toml").read_text()
        changes = {"count = 256": f"count = {count}", "radius = 0.06": f"radius = {self.tank!r}"}
        self.text = self.replaced(base, changes | {"z_max = 0.04": f"z_max = {0.04 * self.scale!r}"})
        sides = [1.2 * self.tank] * 2
        if record:
            self.take(phase, record, sides)
            return
        # Deep ones take longer to come to rest.
        settle = self.replaced(self.text, {"duration = 2.0": f"duration = {max(1.0, 0.1 * round(5 * self.scale))!r}"})
        (folder / "settle.toml").write_text(settle)
        output([phase, "run", folder / "settle.toml", "--out", folder / "settle.h5", "--threads", str(os.cpu_count() or 1)])
        self.take(phase, folder / "settle.h5", sides)

    def take(self, phase, record, sides):
        """Takes the last spheres of a record, and writes them down within these sides (m)."""
        output([phase, "export", record, "--to", "csv", "--out", self.folder / "settled"])
        self.spheres = self.last_spheres(self.folder / "settled")
        with open(self.folder / "bed.csv", "w") as file:
            csv.writer(file, lineterminator="\n").writerows([self.columns] + self.spheres)
        self.write_lammps(sides)

    @staticmethod
    def replaced(text, changes):
        for old, new in changes.items():
            assert old in text, old
            text = text.replace(old, new, 1)
        return text

    def last_spheres(self, folder):
        return [tuple(float(row[column]) for column in self.columns) for row in last_rows(folder)]

    def write_lammps(self, sides):
        (x, y), top = sides, max(sphere[2] for sphere in self.spheres) + 20 * self.radius
        box = [(-x, x), (-y, y), (-2 * self.radius, top)]
        write_lammps(self.folder / "bed.data", self.spheres, self.radius, self.density, box)

    def lammps(self, law):
        """LAMMPS's input for it, and its variables."""
        kn = 2 * YOUNG / (3 * (1 - POISSON**2))
        shear = YOUNG / (2 * (1 + POISSON)) / (2 * (2 - POISSON))
        damping = kn * DISSIPATION / MASS
        variables = dict(R=self.tank, skin=0.25 * RADIUS, kn=kn, kt=8 * shear, mu=MU, law=law)
        return "in.bed.lammps", variables | dict(gamma=2 * damping, gamma_wall=damping)

    def scene(self, law, steps):
        """The scene of the measurement, of one frame, from the spheres that are given."""
        path = self.folder / f"{law}-{steps}.toml"
        path.write_text(self.from_file(self.of_one_frame(law, steps)))
        return path

    @staticmethod
    def from_file(text):
        """The scene with the spheres that were taken last."""
        start, end = text.index("[start]"), text.index("[gravity]")
        return text[:start] + '[start]\nkind = "file"\npath = "bed.csv"\n\n' + text[end:]

    def of_one_frame(self, law, steps):
        friction = f"[friction]\n{LAWS[law]}" if LAWS[law] else ""
        changes = {f"[friction]\n{LAWS['mindlin']}": friction, "duration = 2.0": f"duration = {steps * DT!r}"}
        changes |= {"frame_interval = 0.1": f"frame_interval = {steps * DT!r}"}
        return self.replaced(self.text, changes) + "\n[output]\nsnapshot_interval = 0.0\n"


class Box(Bed):
    """The spheres of `box-55000.toml`, from a record of a run that has come to rest."""

    radius, dt, laws, weight = 0.5, 1e-4, ["silbert"], 1.0
    # Half of what carries the spheres is friction, whose springs begin without load.
    stir = {"silbert": 0.1}

    def __init__(self, record, phase, folder):
        self.folder = folder
        self.text = (FOLDER.parent / "sweeps/scenes/box-55000.toml").read_text()
        self.count, self.density = 55000, 6 / math.pi
        self.take(phase, record, [25.0, 4.0])

    def lammps(self, law):
        return "in.box.lammps", dict(skin=0.1)

    def of_one_frame(self, law, steps):
        changes = {"duration = 60.0": f"duration = {steps * self.dt!r}"}
        changes |= {"frame_interval = 0.05": f"frame_interval = {steps * self.dt!r}"}
        return self.replaced(self.text, changes)


class Drainage(Box):
    """The same box while it drains, from the last state of a record of `dem-drainage.toml`, with all its motion."""

    columns = ["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz"]
    # Spheres that fall out are the fastest.
    stir, leaving = {"silbert": 10.0}, 50

    def __init__(self, record, phase, folder):
        self.folder, self.density = folder, 6 / math.pi
        text = (FOLDER.parent / "sweeps/scenes/dem-drainage.toml").read_text()
        # The orifice is open from the start.
        text = self.replaced(text, {"[door]\nopens = 20.0    # s\n\n": ""})
        self.text = self.replaced(text, {"snapshot_interval = 2.0": "snapshot_interval = 0.0"})
        self.take(phase, record, [25.0, 4.0])
        self.count = len(self.spheres)
        self.text = self.replaced(self.text, {"count = 55000": f"count = {self.count}"})

    def last_spheres(self, folder):
        """Without those that are on their way out: no program starts with spheres below a floor."""
        return [sphere for sphere in super().last_spheres(folder) if sphere[2] >= 0.0]

    def lammps(self, law):
        return "in.drainage.lammps", dict(skin=0.1)

    def of_one_frame(self, law, steps):
        changes = {"duration = 200.0": f"duration = {steps * self.dt!r}"}
        return self.replaced(self.text, changes | {"frame_interval = 0.1": f"frame_interval = {steps * self.dt!r}"})


class Chute(Bed):
    """The chute of LAMMPS's benchmark while it flows, from the last state of a run of `chute.toml`, with all its motion."""

    columns = Drainage.columns
    radius, density, dt, laws, weight = 0.5, 1.0, 1e-4, ["hooke"], math.pi / 6
    stir = {"hooke": 100.0}
    # Frozen spheres along x and y, a diameter apart; the slope in degrees.
    frozen, slope = (40, 20), 26.0

    def __init__(self, count, phase, folder):
        self.folder, self.count = folder, int(count)
        nx, ny = self.frozen
        self.bottom = places = [(i - (nx - 1) / 2, j - (ny - 1) / 2, 0.0) for i in range(nx) for j in range(ny)]
        walls = ",\n".join(f"    {{ position = [{x}, {y}, {z}], radius = 0.5 }}" for x, y, z in places)
        geometry = f"[geometry]\nkind = \"list\"\nwalls = [\n{walls},\n]\n"
        text = self.replaced((FOLDER / "chute.toml").read_text(), {"count = 31200": f"count = {self.count}"})
        before, after = text.split("# geometry", 1)
        text = before + geometry + after.split("\n", 1)[1]
        height = 1.0 + self.count * math.pi / 6 / (0.25 * math.prod(self.frozen))
        text = self.replaced(text, {"z_max = 90.0": f"z_max = {height!r}", "x = 40.0": f"x = {nx}.0", "y = 20.0": f"y = {ny}.0"})
        self.text = self.replaced(text, {"tilt = 0.0": f"tilt = {math.radians(self.slope)!r}"})
        # They fall, and then flow.
        record = self.run(phase, "settled", self.replaced(text, self.times(20.0)))
        self.take(phase, record, [side / 2 for side in self.frozen])
        flowing = self.from_file(self.replaced(self.text, self.times(20.0)))
        self.take(phase, self.run(phase, "flowing", flowing), [side / 2 for side in self.frozen])

    @staticmethod
    def times(duration, dt=2e-4):
        return {"dt = 1e-4": f"dt = {dt!r}", "duration = 1.0": f"duration = {duration!r}", "frame_interval = 1.0": f"frame_interval = {duration!r}"}

    def run(self, phase, name, text):
        (self.folder / f"{name}.toml").write_text(text)
        record = self.folder / f"{name}.h5"
        output([phase, "run", self.folder / f"{name}.toml", "--out", record, "--threads", str(os.cpu_count() or 1)])
        return record

    def lammps(self, law):
        return "in.chute.lammps", dict(skin=0.1)

    def of_one_frame(self, law, steps):
        return self.replaced(self.text, self.times(steps * self.dt, self.dt))

    def write_lammps(self, sides):
        """As others, with the frozen spheres as a second type."""
        (x, y), top = sides, max(sphere[2] for sphere in self.spheres) + 5.0
        box = [(-x, x), (-y, y), (-1.0, top)]
        write_lammps(self.folder / "bed.data", self.spheres, self.radius, self.density, box, self.bottom)
