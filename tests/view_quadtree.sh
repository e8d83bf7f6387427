#!/bin/sh
# scree-view --quadtree, on a display in memory: a raster without cracks, a mesh that follows the camera, coarser with a
# larger threshold; and what it says when it cannot draw.
# Usage: view_quadtree.sh; environment: TOP_SRCDIR, TOP_BUILDDIR, SANITIZE.
set -u
. "$TOP_SRCDIR/tests/view.sh"

"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/dem.tif" --size 301 --rows 200 --epsg 32611 || exit 1
dem=$folder/dem.tif
expect 2 'and no terrain' out --quadtree "$dem"
expect 2 'goes with --quadtree' out --threshold 3
expect 2 '--svo does not go with' --quadtree "$dem" --svo 3
expect 2 "wants T, not '-1'" --quadtree "$dem" --threshold -1
expect 1 'no raster that GDAL reads' --quadtree "$folder/nowhere.tif" --screenshot "$folder/none.png"
head -c 300 "$dem" >"$folder/cut.tif"
expect 1 'cut.tif' --quadtree "$folder/cut.tif" --screenshot "$folder/none.png"
printf 'ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n-9 -9\n-9 -9\n' >"$folder/void.asc"
expect 1 'no heights' --quadtree "$folder/void.asc" --screenshot "$folder/none.png"
printf 'ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n7\n' >"$folder/one.asc"
expect 1 '2 to 32769 posts' --quadtree "$folder/one.asc" --screenshot "$folder/none.png"
DISPLAY='' expect 1 'no display\|DISPLAY' --quadtree "$dem" --screenshot "$folder/none.png"
[ ! -e "$folder/none.png" ] || fail "there is a picture of nothing"

if ! display_begin >"$folder/reason"; then
    echo "the pictures are skipped: $(cat "$folder/reason")"
    [ "$failed" = 0 ] && exit 77
    exit 1
fi
shoot() { # NAME OPTION...
    name=$1
    shift
    "$view" --quadtree "$dem" --screenshot "$folder/$name.png" --size 320x256 --background ff00ff "$@" \
        >"$folder/said" 2>&1 || fail "no picture: scree-view $*"
    [ ! -s "$folder/said" ] || fail "scree-view is not quiet: $*"
}
shoot overview
[ "$("$picture" spread "$folder/overview.png")" -gt 500 ] || fail "the overview shows no terrain"

# Down on its middle, so that the whole picture is terrain: leaves of all sizes, and no crack between them.
for threshold in 0.5 4 32; do
    shoot down --threshold $threshold --camera=-118.0386,34.3638,4000,10,-80
    [ "$("$picture" count "$folder/down.png" ff00ff)" = 0 ] || fail "threshold $threshold: pixels of cracks"
done

# Along a flight: fewer triangles with a larger threshold.
triangles() {
    "$view" --quadtree "$dem" --benchmark --frames 8 --size 160x120 --threshold "$1" >"$folder/said" 2>&1 ||
        fail "no flight"
    sed -n 's/^triangles  *\([0-9]*\),.*/\1/p' "$folder/said"
}
fine=$(triangles 1) coarse=$(triangles 8)
[ "$coarse" -gt 0 ] && [ "$fine" -gt $((2 * coarse)) ] || fail "$fine and $coarse triangles with thresholds 1 and 8"
printf '0 -118.03 34.36 3000 30 -35\n1 -117.99 34.40 3000 60 -30\n' >"$folder/flight.txt"
"$view" --quadtree "$dem" --fly "$folder/flight.txt" --frames 6 --pictures "$folder/pictures" --every 3 --size 160x120 \
    >"$folder/said" 2>&1 || fail "no pictures of a flight"
[ "$(find "$folder/pictures" -name '*.png' | wc -l)" = 2 ] || fail "not two pictures of the flight"
[ "$("$picture" differ "$folder/pictures/frame-000000.png" "$folder/pictures/frame-000003.png" |
    awk '{ print ($1 > 0.5) }')" = 1 ] || fail "the camera does not move"
expect 1 'flight' --quadtree "$dem" --fly "$folder/noflight.txt" --pictures "$folder/pictures"
exit $failed
