#!/bin/sh
# What scree-view draws, on a display in memory: tiles of different rungs without cracks between them, and cracks
# without stitching (so that the test can fail); smaller steps from rung to rung with geomorphing than without; the
# same rungs for perspective and orthogonal cameras at the same metres a pixel. And what it says when it cannot draw.
# Usage: viewer_screens.sh; environment: TOP_SRCDIR, TOP_BUILDDIR, SANITIZE.
set -u
. "$TOP_SRCDIR/tests/view.sh"

# ---- words, before there is any display ----

expect 0 '^  w  *wireframe' --help
expect 2 'which terrain'
expect 2 "no option '--sovs'" out --sovs 3
expect 2 "wants PX, not 'x'" out --tolerance x
expect 1 nowhere "$folder/nowhere" --screenshot "$folder/none.png"

"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/dem.tif" --size 700 --epsg 32611 &&
    "$TOP_BUILDDIR/scree" build "$folder/dem.tif" --profile local -q -o "$folder/out" || exit 1
DISPLAY='' expect 1 'no display\|DISPLAY' "$folder/out" --screenshot "$folder/none.png"
[ ! -e "$folder/none.png" ] || fail "a picture was written without a display"

if ! display_begin >"$folder/reason"; then
    echo "the pictures are skipped: $(cat "$folder/reason")"
    [ "$failed" = 0 ] && exit 77
    exit 1
fi

# ---- pictures ----

shoot() { # NAME OPTION...: a picture, and its tiles as a table
    name=$1
    shift
    "$view" "$folder/out" --screenshot "$folder/$name.png" --size 320x256 --trace-tiles "$folder/$name.csv" "$@" \
        >"$folder/said" 2>&1 || fail "no picture: scree-view $*"
    [ ! -s "$folder/said" ] || fail "scree-view is not quiet: $*"
}
holes() { "$picture" count "$folder/$1.png" ff00ff; }
# From the coarsest rung to the finest of a table.
rungs_apart() { awk -F, 'NR > 1 { if (NR == 2 || $6 < low) low = $6; if (NR == 2 || $6 > high) high = $6 }
                         END { print high - low }' "$folder/$1.csv"; }

shoot overview
[ "$("$picture" spread "$folder/overview.png")" -gt 500 ] || fail "the overview shows no terrain"
shoot away --camera=-118.01,34.42,2600,20,80 --background ff00ff
[ "$(holes away)" = 81920 ] || fail "above the terrain is more than sky"

# Cracks: cameras whose whole picture is terrain, tiles of different rungs in it.
cracks=0
for camera in -118.01,34.42,2600,20,-40 -118.03,34.41,2400,45,-35; do
    for tolerance in 8 24; do
        shoot closed --camera=$camera --tolerance $tolerance --background ff00ff
        shoot open --camera=$camera --tolerance $tolerance --background ff00ff --no-stitch
        [ "$(holes closed)" = 0 ] || fail "camera $camera, $tolerance pixels: $(holes closed) pixels of cracks"
        [ "$(rungs_apart closed)" -ge 2 ] && cracks=$((cracks + $(holes open)))
    done
done
[ "$cracks" -gt 0 ] || fail "without stitching there are no cracks: the test cannot see any"
echo "cracks: none with stitching, $cracks pixels without"

# From one rung to the next in four steps: the largest step, as a mean difference of colours, in thousandths.
largest_step() { # OPTION...
    largest=0
    before=
    for step in 0 1 2 3 4; do
        svo=$(awk "BEGIN { print 20 * 2 ^ ($step / 16) }")
        shoot "step$step" --camera=-118.01,34.42,4200,20,-50 --svo "$svo" --colour plain "$@"
        if [ -n "$before" ]; then
            largest=$("$picture" differ "$folder/$before.png" "$folder/step$step.png" |
                awk -v most="$largest" '{ step = int(1000 * $1); print (step > most ? step : most) }')
        fi
        before=step$step
    done
    echo "$largest"
}
smooth=$(largest_step)
popping=$(largest_step --no-morph)
echo "from a rung to the next in steps: at most $smooth with geomorphing, $popping without"
if [ "$popping" -le 0 ] || [ $((smooth * 3)) -ge "$popping" ]; then
    fail "geomorphing does not make smaller steps"
fi

# Straight down, from so far away that all distances are nearly the same: tiles that share some ground, of which one may
# be of a coarser zoom than the other, are not more than a rung apart.
for tolerance in 0.1 0.4; do
    for kind in perspective orthogonal; do
        option=
        [ "$kind" = perspective ] || option=--orthogonal
        # shellcheck disable=SC2086 # no option is none
        shoot $kind --camera=-117.97,34.43,60000,0,-90 --tolerance $tolerance $option
    done
    awk -F, 'FNR == 1 { next }
             NR == FNR { zoom[++count] = $3; x[count] = $4; y[count] = $5; rung[count] = $6; next }
             { for (i = 1; i <= count; i++) {
                   a = $3 > zoom[i] ? 2 ^ ($3 - zoom[i]) : 1; b = $3 < zoom[i] ? 2 ^ (zoom[i] - $3) : 1
                   if (int($4 / a) != int(x[i] / b) || int($5 / a) != int(y[i] / b)) continue
                   pairs++
                   if (rung[i] - $6 > 1 || $6 - rung[i] > 1) apart++ } }
             END { print pairs + 0, "pairs of tiles,", apart + 0, "of them more than a rung apart"
                   exit !(pairs > 0 && apart == 0) }' "$folder/perspective.csv" "$folder/orthogonal.csv" ||
        fail "perspective and orthogonal cameras choose different rungs at $tolerance pixels"
done

# A short flight with its table, its pictures and its sum.
printf '0 -118.04 34.37 6000 30 -35\n1 -117.98 34.42 3500 60 -30\n' >"$folder/flight.txt"
"$view" "$folder/out" --fly "$folder/flight.txt" --frames 12 --benchmark --trace "$folder/frames.csv" \
    --size 160x120 --memory 16 --pictures "$folder/pictures" --every 4 >"$folder/said" 2>&1 ||
    fail "no flight"
[ "$(wc -l <"$folder/frames.csv")" = 13 ] || fail "the table of 12 frames has $(wc -l <"$folder/frames.csv") lines"
[ "$(find "$folder/pictures" -name '*.png' | wc -l)" = 3 ] || fail "not three pictures of the flight"
grep -q '^frames  *12 in' "$folder/said" || fail "the benchmark does not tell of 12 frames"
expect 1 'line 1' "$folder/out" --fly "$folder/frames.csv" --benchmark

# A stream that ends in its middle: the coarser mesh is drawn.
tile=$(find "$folder/out/stream/2" -name '*.scree' | LC_ALL=C sort | head -n 1)
head -c 9000 "$tile" >"$folder/cut" && cp "$folder/cut" "$tile"
"$view" "$folder/out" --screenshot "$folder/cut.png" --size 320x256 --tolerance 0.5 >"$folder/said" 2>&1 ||
    fail "a stream that was cut off ends the program"
exit $failed
