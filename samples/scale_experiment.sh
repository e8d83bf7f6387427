#!/bin/sh
# The scale experiment of Ai et al. 2019, section 3, with the Jacksboro sample, whose four tiles are the sub-blocks:
#   table.csv      six states T1 .. T6 of the scale, set by hand: SVO, visual range, triangles and simplifications of
#                  each sub-block, as in their Table 2
#   states.csv     the same of 21 states, for states.png, as in their Figure 14 (sub-block I)
#   scales.png     the six states, as in their Figure 12
#   distances.png, distances.csv   six distances of the camera, each at the scale that it asks for, as in Figure 13
# A sub-block's visual range is the distance at which its smallest visible object is two pixels long.
# Usage: samples/scale_experiment.sh [FOLDER]   (build/experiments/scale); environment: SCREE_BUILD (build).
set -eu
cd "$(dirname "$0")/.."
build=${SCREE_BUILD:-build}
folder=${1:-build/experiments/scale}
# shellcheck source=samples/display.sh
. samples/display.sh
for program in scree scree-view; do
    [ -x "$build/$program" ] || { echo "there is no $build/$program: run ./bootstrap first"; exit 1; }
done
trap display_end EXIT
display_begin || exit 1
mkdir -p "$folder"

width=960
height=600
# Pixels of a metre at a distance of one metre: the view spans 45 degrees.
focal=$(awk "BEGIN { print $height / (2 * 0.41421356) }")
terrain=$folder/terrain
"$build/scree" build samples/jacksboro.vrt --profile local --min-zoom 1 --finest-octaves 4 -q -o "$terrain"

shot() { # NAME OPTION...
    name=$1
    shift
    "$build/scree-view" "$terrain" --size ${width}x$height --tolerance 2 --screenshot "$folder/$name.png" \
        --trace "$folder/$name.frame" --trace-tiles "$folder/$name.tiles" "$@"
}

# A place on the overview's line of sight: 1 is the overview itself, 0 the middle of the terrain.
shot overview
overview=$(tail -n 1 "$folder/overview.frame" | cut -d, -f 23-27)
place() { # PART
    echo "$overview" | awk -F, -v part="$1" '{
        printf "%.6f,%.6f,%.1f,%s,%s", -84.245833 + part * ($1 + 84.245833), 36.589583 + part * ($2 - 36.589583),
               500 + part * ($3 - 500), $4, $5 }'
}

# ---- the scale by hand ----

# The states are the rungs of sub-block I, from the finest to the coarsest: 21 of them, a little more than their SVO
# being the threshold for all.
"$build/scree" info "$terrain/stream/1/0/0.scree" | awk '$1 ~ /^-?[0-9]+$/ && NF == 6 { print $2 }' |
    sort -g >"$folder/thresholds"
rm -f "$folder"/state*.png
echo 'state,sub_block,threshold_m,svo_m,visual_range_m,triangles,simplifications,eye_distance_m' >"$folder/states.csv"
state=0
while read -r svo; do
    threshold=$(awk "BEGIN { print 1.001 * $svo }")
    shot state --svo "$threshold" --no-morph
    awk -F, -v state="$state" -v threshold="$threshold" -v focal="$focal" '
        BEGIN { split("I II III IV", name, " ") }
        NR > 1 { printf "%d,%s,%.4g,%.4g,%.2f,%d,%d,%.2f\n", state, name[NR - 1], threshold, $8, $8 * focal / 2,
                        $11, $13, $10 }' "$folder/state.tiles" >>"$folder/states.csv"
    if [ $((state % 4)) = 0 ]; then # with its triangles, from nearer by
        shot "scale$((state / 4 + 1))" --svo "$threshold" --no-morph --wireframe \
            --background ffffff --size 480x300 "--camera=$(place 0.22)"
    fi
    state=$((state + 1))
done <"$folder/thresholds"
awk -F, -v OFS=, 'NR == 1 || $1 % 4 == 0 { if (NR > 1) $1 = "T" ($1 / 4 + 1); print }' "$folder/states.csv" \
    >"$folder/table.csv"
awk -F, 'NR == 1 || $2 == "I"' "$folder/states.csv" >"$folder/block_one.csv"

# ---- the scale by the distance ----

echo 'step,distance_m,finest_svo_m,coarsest_svo_m,tiles,triangles' >"$folder/distances.csv"
for step in 1 2 3 4 5 6; do # from far to near
    camera=$(place "$(awk "BEGIN { print 2.5 / 1.6 ^ ($step - 1) }")")
    shot "distance$step" "--camera=$camera"
    distance=$(echo "$camera" | awk -F, '{ print ($3 - 500) / sin(-$5 * 0.0174532925) }')
    tail -n 1 "$folder/distance$step.frame" | awk -F, -v OFS=, -v step=$step -v distance="$distance" \
        '{ print step, distance, $20, $19, $9, $12 }' >>"$folder/distances.csv"
done

# ---- plots ----

if command -v gnuplot >/dev/null; then
    gnuplot -e "folder = '$folder'" samples/scale_experiment.gnuplot
else
    echo "the plots are skipped: gnuplot is not installed"
fi
rm -f "$folder"/*.frame "$folder"/*.tiles "$folder/thresholds" "$folder/block_one.csv"
column -s, -t "$folder/table.csv" 2>/dev/null || cat "$folder/table.csv"
echo "in $folder: table.csv states.csv distances.csv, and with gnuplot scales.png distances.png states.png"
