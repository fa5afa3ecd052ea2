# %% [markdown]
# # From a dict to a border with its band
#
# A scene as a dict, one run, a phase diagram, and where its border lies. Run the cells one by one
# in an editor, or all with `python from_dict_to_border.py FOLDER`, which writes results and figures
# to the folder.

# %%
import pathlib
import sys

import matplotlib.pyplot as plt
import numpy

import phase

folder = pathlib.Path(sys.argv[1] if sys.argv[1:] else "from-dict-to-border")
folder.mkdir(parents=True, exist_ok=True)

# %% [markdown]
# ## A scene
#
# 48 spheres in a tank whose air turns. The keys are those of a scene file.

# %%
scene = {
    "spheres": {"count": 48, "radius": 0.004, "density": 3750.0},
    "tank": {"radius": 0.035, "floor": 0.0},
    "start": {"kind": "random", "z_min": 0.01, "z_max": 0.1, "speed": 0.005},
    "contact": {
        "law": "hertz",
        "young_modulus": 5.657e5,
        "poisson_ratio": 0.3,
        "dissipation_time": 1e-3,
    },
    "gravity": {"acceleration": 9.8},
    "drag": {"linear": 100.0, "law": "cross-section"},
    "swirl": {"omega": 20.0},
    "time": {"dt": 1e-4, "duration": 3.0, "frame_interval": 1e-3},
}
run = phase.run(scene, progress=False)
print(run.attrs["label"], "after", float(run.time[-1]), run.time.attrs["units"])

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
(1e3 * run.height_mean).plot(ax=left)
left.set(xlabel="time (s)", ylabel="mean height (mm)", title="They fall to the floor")
for x, y, _ in 1e3 * run.position.isel(snapshot=-1).values:
    right.add_patch(plt.Circle((x, y), 4.0, color="tab:blue", ec="white"))
right.add_patch(plt.Circle((0, 0), 35, fill=False))
right.set(aspect="equal", xlim=(-36, 36), ylim=(-36, 36), xlabel="x (mm)", ylabel="y (mm)")
right.set_title(f"From above: {run.attrs['label']}")
figure.savefig(folder / "run.png")

# %% [markdown]
# ## A diagram
#
# The same scene over its radius and the rotation of the air.

# %%
sweep = {
    "scene": scene,
    "axis": [
        {"key": "spheres.radius", "values": [0.0036, 0.004, 0.0044, 0.0048, 0.0052]},
        {"key": "swirl.omega", "from": 0.0, "to": 30.0, "step": 5.0},
    ],
}
runs = phase.sweep(sweep, out=folder / "grid", progress=False)
print(runs.label.isel(seed=0).to_pandas())


# %%
def draw_labels(runs, axes):
    """Draws the label of each run as a point in its colour, and gives the colours."""
    made = runs.label.isel(seed=0).stack(run=("radius", "omega"))
    made = made[made != ""]
    names = sorted(set(made.values))
    colours = dict(zip(names, ["tab:blue", "tab:orange", "tab:green", "tab:red"], strict=False))
    for name in names:
        points = made[made == name]
        axes.scatter(1e3 * points.radius, points.omega, color=colours[name], label=name)
    axes.set(xlabel="radius (mm)", ylabel="rotation (rad/s)")
    return colours


figure, axes = plt.subplots(figsize=(5, 4), layout="constrained")
draw_labels(runs, axes)
axes.set_title("35 runs")
axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
figure.savefig(folder / "diagram.png")

# %% [markdown]
# ## Questions
#
# A run is pinned with a hole of two radii of a sphere in half of two seconds. Which runs decide
# where this begins? Those whose hole is closest to that.

# %%
hole = (runs.hole_radius * scene["tank"]["radius"] / runs.radius).stack(run=runs.label.dims)
for place in abs(hole - 2.0).argsort()[:3].values:
    radius, omega, _ = hole.run.values[place]
    print(f"r = {radius} m, Omega = {omega} rad/s: a hole of {hole[place].item():.2f} radii")

# %% [markdown]
# What if only holes of three radii counted?

# %%
wider = phase.classify(runs, sieves={"pinned": {"hole": 3.0}})
print((wider.label != runs.label).sum().item(), "of", runs.label.size, "labels change")

# %% [markdown]
# ## A border with its band
#
# With a table `refine` only runs are made that the border needs, here 60 of 527 points.

# %%
refined = {
    "scene": scene,
    "axis": [
        {"key": "spheres.radius", "from": 0.0036, "to": 0.0052, "count": 17},
        {"key": "swirl.omega", "from": 0.0, "to": 30.0, "count": 31},
    ],
    "refine": {"budget": 60, "start": [5], "replicates": 1},
}
runs = phase.sweep(refined, out=folder / "refined", progress=False)
borders = phase.refine(folder / "refined").borders("omega")
print(borders[["radius", "omega", "below", "above", "low_95", "high_95"]].to_dataframe())

# %%
figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
pairs = sorted(set(zip(borders.below.values, borders.above.values, strict=True)))
for pair, colour in zip(pairs, ["black", "tab:purple", "tab:brown"], strict=False):
    border = borders.isel(crossing=(borders.below == pair[0]) & (borders.above == pair[1]))
    radius = 1e3 * border.radius
    name = f"{pair[0]} to {pair[1]}"
    axes.plot(radius, border.omega, color=colour, label=name)
    axes.fill_between(radius, border.low_95, border.high_95, color=colour, alpha=0.12)
draw_labels(runs, axes)
axes.set_title("60 runs: borders and their bands of 95 %")
axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
figure.savefig(folder / "border.png")

# %% [markdown]
# ## Any function
#
# The same for a function of Python: for which c does z -> z^2 + c stay bounded?


# %%
def bounded(x: float, y: float) -> bool:
    """Whether a point belongs to the Mandelbrot set, as far as 60 steps tell."""
    z = c = complex(x, y)
    for _ in range(60):
        if abs(z) > 2.0:
            return False
        z = z * z + c
    return True


grid = {"x": numpy.linspace(-1.6, 0.6, 56), "y": numpy.linspace(0.0, 1.2, 41)}
refinement = phase.refine(grid, budget=150)
while points := refinement.ask():
    for point in points:
        refinement.tell(point, bounded(**point))
labels = refinement.labels()
truth = numpy.array([[str(bounded(x, y)) for y in grid["y"]] for x in grid["x"]])
share = float((labels.label == truth).mean())
print(f"{refinement.runs} of {truth.size} calls, {100 * share:.1f} % of the labels are right")

# %%
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
labels.p_True.plot(x="x", y="y", ax=axes, cmap="Blues", vmin=0, vmax=1)
asked = labels.runs.stack(point=("x", "y"))
asked = asked[asked > 0]
axes.plot(asked.x, asked.y, "k.", markersize=3)
axes.contour(grid["x"], grid["y"], (truth == "True").T, levels=[0.5], colors="tab:red")
axes.set(aspect="equal", title="Probability from 150 calls (dots); the true border in red")
figure.savefig(folder / "function.png")
