#!/usr/bin/env bash
# Runs the drainages of analysis/spot.md, by spots and by discrete elements, in some hours of one
# core. It may be interrupted, and goes on.
#
#   analysis/drainage.sh [FOLDER [RUN...]]
#
# Records go to FOLDER (scratch/drainage). Without names all runs are made.
set -euo pipefail
cd "$(dirname "$0")/.."
phase=${PHASE:-target/release/phase}
folder=${1:-scratch/drainage}
shift || true
mkdir -p "$folder"

# All spheres are relaxed once per step: cheap.
global="spot.relaxation.method=global spot.relaxation.ratio=1"
# NAME, the scene, then the keys that the run has in place of the scene's.
runs=$(cat <<RUNS
dem dem-drainage time.dt=4e-4
dem-wall0.1 dem-drainage time.dt=4e-4 time.duration=140 tank.friction_coefficient=0.1
dem-wall0.2 dem-drainage time.dt=4e-4 time.duration=140 tank.friction_coefficient=0.2
dem-wall0.3 dem-drainage time.dt=4e-4 time.duration=140 tank.friction_coefficient=0.3
dt1 dem-small time.dt=1e-4
dt2 dem-small time.dt=2e-4
dt4 dem-small time.dt=4e-4
dt8 dem-small time.dt=8e-4
seed2 dem-small time.dt=4e-4 seed=2
wall0.1 dem-small time.dt=4e-4 tank.friction_coefficient=0.1
wall0.3 dem-small time.dt=4e-4 tank.friction_coefficient=0.3
wall0.7 dem-small time.dt=4e-4 tank.friction_coefficient=0.7
wall0.9 dem-small time.dt=4e-4 tank.friction_coefficient=0.9
none spot-drainage time.duration=200 spot.relaxation.method=off
random100 spot-drainage time.duration=200 spot.relaxation.method=at-random spot.relaxation.ratio=100
random10 spot-drainage time.duration=200 spot.relaxation.method=at-random spot.relaxation.ratio=10
counted10 spot-drainage time.duration=200 spot.relaxation.method=counted spot.relaxation.ratio=10
global1 spot-drainage time.duration=200 $global
global10 spot-drainage time.duration=200 spot.relaxation.method=global spot.relaxation.ratio=10
base spot-drainage time.duration=300
coarse spot-drainage time.duration=300 $global
walk1 spot-drainage time.duration=300 $global spot.walk.bias=1
bias1 spot-drainage time.duration=300 $global spot.walk.bias=1 spot.weighting.above=30
bias3 spot-drainage time.duration=300 $global spot.walk.bias=3 spot.weighting.above=30
bias10 spot-drainage time.duration=300 $global spot.walk.bias=10 spot.weighting.above=30
walk spot-drainage time.duration=300 $global spot.walk.bias=3
weighting spot-drainage time.duration=300 $global spot.weighting.above=30
newest spot-drainage time.duration=120 spot.schedule=steps-newest-first
dw0.5 spot-drainage time.duration=180 $global spot.wall_distance=0.5
dw0 spot-drainage time.duration=180 $global spot.wall_distance=0
dw-1.5 spot-drainage time.duration=180 $global spot.wall_distance=-1.5
reflection spot-drainage time.duration=180 $global spot.wall_distance=0 spot.reflection=true
RUNS
)

while read -r name scene keys; do
    if [ $# -gt 0 ] && [[ " $* " != *" $name "* ]]; then continue; fi
    if [ -e "$folder/$name.h5" ]; then continue; fi
    echo "== $name"
    # Each key is a word.
    # shellcheck disable=SC2046,SC2086
    "$phase" run "sweeps/scenes/$scene.toml" $(printf -- '--set %s ' $keys) \
        --resume --out "$folder/$name.h5" </dev/null
done <<<"$runs"
