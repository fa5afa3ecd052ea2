#!/usr/bin/env bash
# Draws the figures of analysis/spot.md, and writes their tables, from the records of
# analysis/drainage.sh, and the figure of costs from those of `benches/fidelity --keep FIDELITY`.
#
#   analysis/drainage-figures.sh [FOLDER [RESULTS [FIDELITY]]]
set -euo pipefail
cd "$(dirname "$0")/.."
phase=${PHASE:-target/release/phase}
folder=${1:-scratch/drainage}
results=${2:-results/drainage}
fidelity=${3:-scratch/fidelity}

# Records and their labels from RECORD=LABEL...
take() {
    records=() labels=()
    local pair
    for pair in "$@"; do
        records+=("$folder/${pair%%=*}.h5")
        labels+=(--label "${pair#*=}")
    done
}

# A picture of records beside each other: picture NAME "OPTIONS" RECORD=LABEL...
picture() {
    take "${@:3}"
    # Options are several words.
    # shellcheck disable=SC2086
    "$phase" view "${records[@]}" "${labels[@]}" $2 --cut --palette --out "$results/$1.png" -q
}

# The numbers of records: table NAME TIMES RECORD=LABEL...
table() {
    take "${@:3}"
    "$phase" compare "${records[@]}" "${labels[@]}" --times "$2" --out "$results/$1.csv" -q
}

# Draws figures of records: figures NAME "FIGURES" TIMES RECORD=LABEL...; the name may be empty.
figures() {
    local name=$1 list=$2 times=$3
    take "${@:4}"
    [ -z "$name" ] || labels+=(--name "$name")
    "$phase" plot "${records[@]}" "${labels[@]}" --figure "$list" --times "$times" --out "$results" -q
}

relaxation=(base="every move" random10="at random, 1 in 10" global1="all spheres, k = 1")
never=(none="never")
others=(random100="at random, 1 in 100" counted10="every 10th" global10="all spheres, k = 10")
figures "" outflow,bond-angles 40,120 "${relaxation[@]}" "${never[@]}"
figures "" radial-distribution 40,200 "${relaxation[@]}" "${others[@]}" "${never[@]}"
figures "" badness 40,160 "${relaxation[@]}" "${others[@]}" "${never[@]}"
figures "" mixing,diffusion,retention 40,120 "${relaxation[@]}"
# Markup of figures, not variables.
# shellcheck disable=SC2016
figures "" cross-profile 80,180 coarse='$d_w$ = $d$' dw0.5='$d_w$ = $d$/2' dw0='$d_w$ = 0' \
    reflection='$d_w$ = 0, reflection' dw-1.5='$d_w$ = −3$d$/2'
figures "" surface-angle 20,300 coarse="no bias" walk1="bias 1" walk="bias 3" weighting="weighted" \
    bias1="bias 1, weighted" bias3="bias 3, weighted" bias10="bias 10, weighted"

pair=(dem="discrete elements" base="spots")
figures pair outflow,surface-angle,radial-distribution,bond-angles 40,120 "${pair[@]}"
figures pair velocity-profile,cross-profile 80,180 "${pair[@]}"
figures pair mixing,diffusion,velocity-correlation,retention,residence 40,120 "${pair[@]}"
figures pair packing-map 20,120 "${pair[@]}" newest="spots, newest first"
figures walls cross-profile 5,30 wall0.1="wall friction 0.1" wall0.3="0.3" dt4="0.5" wall0.7="0.7" wall0.9="0.9"
figures walls velocity-profile 40,120 dem="wall friction 0.5" dem-wall0.3="wall friction 0.3" dem-wall0.1="wall friction 0.1"
folder=$fidelity figures fidelity cost-error 5,30 fidelity-0="discrete elements, Δt = 10⁻⁴ τ" \
    fidelity-1="4 times the step" fidelity-2="spots, every move" fidelity-3="1 in 10" fidelity-4="every 10th" \
    fidelity-5="1 in 100" fidelity-6="all, k = 1" fidelity-7="all, k = 10" fidelity-8="never" \
    fidelity-9="fitted, every move" fidelity-10="fitted, k = 1"

table pair 40,120 "${pair[@]}"
table relaxation 40,160 "${relaxation[@]}" "${others[@]}" "${never[@]}"
table steps 5,30 dt1="step 1e-4" dt2="step 2e-4" dt4="step 4e-4" dt8="step 8e-4" seed2="step 4e-4, seed 2"
table walls 5,30 wall0.1="wall friction 0.1" wall0.3="wall friction 0.3" dt4="wall friction 0.5" \
    wall0.7="wall friction 0.7" wall0.9="wall friction 0.9"
table walls-full 40,120 dem="wall friction 0.5" dem-wall0.3="wall friction 0.3" \
    dem-wall0.2="wall friction 0.2" dem-wall0.1="wall friction 0.1"
"$phase" fit "$folder/dem.h5" --times 40,120
picture pair-layers "--color layer --time 0,60,120 --since-opening --width 170" "${pair[@]}"
surfaces=(walk1="bias 1" walk="bias 3" bias1="bias 1, weighted" bias3="bias 3, weighted")
picture surface-layers "--color layer --time 300 --width 150" "${surfaces[@]}"
picture surface-packing "--color packing-fraction --time 300 --window=-25,25,50,90 --width 220" "${surfaces[@]}"
picture relaxation-layers "--color layer --time 120 --window=-15,15,0,40 --width 170" base="every move" \
    random100="at random, 1 in 100" global10="all, k = 10" none="never"
# These would be large.
rm -f "$results"/{pair-packing-map,pair-velocity-profile,walls-velocity-profile,walls-cross-profile}.svg
