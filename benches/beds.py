"""Beds of spheres at rest in an open tank, of any size, made by `phase` from `bed.toml`."""

import csv
import math

from common import FOLDER, output

LAWS = {
    "none": None,
    "mindlin": 'law = "mindlin"\ncoefficient = 0.3',
    "coulomb": 'law = "coulomb"\ncoefficient = 0.3\nregularisation = 1e-3',
}
RADIUS, DENSITY, YOUNG, POISSON, DISSIPATION, MU, DT = 0.004, 1e4, 2e5 * math.sqrt(2), 0.3, 1e-3, 0.3, 1e-4
MASS = 4 / 3 * math.pi * RADIUS**3 * DENSITY


class Bed:
    """Spheres at rest: their places, and the files from which programs start with them."""

    def __init__(self, count, phase, folder):
        self.count, self.folder = count, folder
        self.scale = (count / 256) ** (1 / 3)
        self.tank = 0.06 * self.scale
        base = (FOLDER / "bed.toml").read_text()
        self.text = self.replaced(base, {"count = 256": f"count = {count}", "radius = 0.06": f"radius = {self.tank!r}"})
        settle = self.replaced(self.text, {"z_max = 0.04": f"z_max = {0.04 * self.scale!r}", "duration = 2.0": "duration = 1.0"})
        (folder / "settle.toml").write_text(settle)
        output([phase, "run", folder / "settle.toml", "--out", folder / "settle.h5"])
        output([phase, "export", folder / "settle.h5", "--to", "csv", "--out", folder / "settled"])
        self.spheres = self.last_spheres(folder / "settled")
        with open(folder / "bed.csv", "w") as file:
            file.write("x,y,z\n" + "".join("%r,%r,%r\n" % place for place in self.spheres))
        self.write_lammps()

    @staticmethod
    def replaced(text, changes):
        for old, new in changes.items():
            assert old in text, old
            text = text.replace(old, new, 1)
        return text

    def last_spheres(self, folder):
        tables = sorted(folder.glob("*.csv"))
        rows = list(csv.DictReader(open([path for path in tables if "observ" not in path.name][-1])))
        return [tuple(float(row[axis]) for axis in "xyz") for row in rows[-self.count :]]

    def write_lammps(self):
        side, top = 1.2 * self.tank, max(z for _, _, z in self.spheres) + 20 * RADIUS
        head = f"bed\n\n{self.count} atoms\n1 atom types\n\n{-side} {side} xlo xhi\n{-side} {side} ylo yhi\n"
        head += f"{-RADIUS} {top} zlo zhi\n\nAtoms\n\n"
        atom = "%d 1 %r %r %r %r %r\n"
        lines = (atom % (i, 2 * RADIUS, DENSITY, *place) for i, place in enumerate(self.spheres, 1))
        (self.folder / "bed.data").write_text(head + "".join(lines))

    def scene(self, law, steps):
        """The scene of the measurement, of one frame."""
        start, end = self.text.index("[start]"), self.text.index("[gravity]")
        text = self.text[:start] + '[start]\nkind = "file"\npath = "bed.csv"\n\n' + self.text[end:] + "\n[output]\nsnapshot_interval = 0.0\n"
        friction = f"[friction]\n{LAWS[law]}" if LAWS[law] else ""
        changes = {f"[friction]\n{LAWS['mindlin']}": friction, "duration = 2.0": f"duration = {steps * DT!r}"}
        text = self.replaced(text, changes | {"frame_interval = 0.1": f"frame_interval = {steps * DT!r}"})
        path = self.folder / f"{law}-{steps}.toml"
        path.write_text(text)
        return path
