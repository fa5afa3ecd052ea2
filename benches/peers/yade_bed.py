# A bed at rest in an open tank: Hertz contacts and Mindlin's friction; damping by a restitution.
#     yade -n -x -j1 yade_bed.py SPHERES.csv RADIUS_OF_TANK PARAMETERS.json
import json
import sys
import time
from math import atan, cos, pi

spheres, tank, parameters = sys.argv[1], float(sys.argv[2]), json.load(open(sys.argv[3]))
material = O.materials.append(
    FrictMat(
        young=parameters["young_modulus"],
        poisson=parameters["poisson_ratio"],
        frictionAngle=atan(parameters["friction"]),
        density=parameters["density"],
    )
)
places = [tuple(map(float, line.split(",")[:3])) for line in open(spheres).read().split()[1:]]
ids = [O.bodies.append(sphere(place, parameters["radius"], material=material)) for place in places]
# There is no inside of a cylinder: facets whose inscribed circle is the tank's.
facets = 48
O.bodies.append(
    geom.facetCylinder(
        center=(0, 0, tank),
        radius=tank / cos(pi / facets),
        height=2 * tank,
        segmentsNumber=facets,
        wallMask=4,
        material=material,
    )
)
O.bodies.append(utils.wall(0.0, axis=2, material=material))
O.dt = parameters["dt"]
O.engines = [
    ForceResetter(),
    InsertionSortCollider(
        [Bo1_Sphere_Aabb(), Bo1_Facet_Aabb(), Bo1_Wall_Aabb()],
        verletDist=0.2 * parameters["radius"],
    ),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_MindlinPhys(en=0.3, es=0.3)],
        [Law2_ScGeom_MindlinPhys_Mindlin()],
    ),
    NewtonIntegrator(gravity=(0, 0, -9.8), damping=0.0),
]
O.run(parameters["warm"], True)
started = time.process_time()
O.run(parameters["steps"], True)
seconds = time.process_time() - started
states = [O.bodies[i].state for i in ids if O.bodies[i]]
kinetic = sum(0.5 * state.mass * state.vel.squaredNorm() for state in states)
height = sum(state.pos[2] for state in states) / len(states)
print("\nSTATE", len(states), kinetic, height, seconds, flush=True)
