#!/bin/sh
# The frame rate while scales change, as in Ai et al. 2019, Figure 15, with the Jacksboro sample: in two minutes the scale
# of all tiles is played from the base to the finest and back, as fast as frames come.
#   frames.csv    a row a frame: its time, its parts outside of drawing, triangles, splits, bytes
#   frames.png    frames a second, and the CPU time outside of drawing, over time
#   summary.txt   minimum, median and 99th percentile
# Usage: samples/frame_experiment.sh [FOLDER [SECONDS [FRAMES]]]   (build/experiments/frames, 120, as many as there are);
# environment: SCREE_BUILD (build).
set -eu
cd "$(dirname "$0")/.."
build=${SCREE_BUILD:-build}
folder=${1:-build/experiments/frames}
seconds=${2:-120}
# shellcheck source=samples/display.sh
. samples/display.sh
for program in scree scree-view; do
    [ -x "$build/$program" ] || { echo "there is no $build/$program: run ./bootstrap first"; exit 1; }
done
trap display_end EXIT
display_begin || exit 1
mkdir -p "$folder"

"$build/scree" build samples/jacksboro.vrt --profile local --finest-octaves 4 -q -o "$folder/terrain"
set -- --play "$seconds" ${3:+--frames "$3"}
"$build/scree-view" "$folder/terrain" --benchmark "$@" --size 960x600 --trace "$folder/frames.csv" >"$folder/summary.txt"
if command -v gnuplot >/dev/null; then
    gnuplot -e "folder = '$folder'" samples/frame_experiment.gnuplot
else
    echo "the plot is skipped: gnuplot is not installed"
fi
cat "$folder/summary.txt"
echo "in $folder: frames.csv summary.txt, and with gnuplot frames.png"
