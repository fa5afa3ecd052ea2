#!/usr/bin/env bash
# Runs the drainages of analysis/spot.md, about two hours of one core. It may be interrupted, and goes on.
#
#   analysis/drainage.sh [FOLDER [RUN...]]
#
# Records go to FOLDER (scratch/spot). Without names all runs are made.
set -euo pipefail
cd "$(dirname "$0")/.."
phase=${PHASE:-target/release/phase}
folder=${1:-scratch/spot}
shift || true
mkdir -p "$folder"

# NAME, then the keys that the run has in place of the scene's.
runs=$(cat <<'RUNS'
none time.duration=200 spot.relaxation.method=off
random100 time.duration=200 spot.relaxation.method=at-random spot.relaxation.ratio=100
random10 time.duration=200 spot.relaxation.method=at-random spot.relaxation.ratio=10
counted10 time.duration=200 spot.relaxation.method=counted spot.relaxation.ratio=10
global1 time.duration=200 spot.relaxation.method=global spot.relaxation.ratio=1
global10 time.duration=200 spot.relaxation.method=global spot.relaxation.ratio=10
base time.duration=300
bias3 time.duration=300 spot.walk.bias=3 spot.weighting.above=30
bias10 time.duration=300 spot.walk.bias=10 spot.weighting.above=30
walk time.duration=300 spot.walk.bias=3
weighting time.duration=300 spot.weighting.above=30
newest time.duration=120 spot.schedule=steps-newest-first
dw0.5 time.duration=120 spot.wall_distance=0.5
dw0 time.duration=120 spot.wall_distance=0
dw-1.5 time.duration=120 spot.wall_distance=-1.5
reflection time.duration=120 spot.wall_distance=0 spot.reflection=true
RUNS
)

while read -r name keys; do
    if [ $# -gt 0 ] && [[ " $* " != *" $name "* ]]; then continue; fi
    if [ -e "$folder/$name.h5" ]; then continue; fi
    echo "== $name"
    # Each key is a word.
    # shellcheck disable=SC2086
    "$phase" run sweeps/scenes/spot-drainage.toml $(printf -- '--set %s ' $keys) \
        --set output.snapshot_interval=2 --resume --out "$folder/$name.h5" </dev/null
done <<<"$runs"
