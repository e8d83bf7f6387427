#!/bin/sh
# Streams from build to mesh: info, extract and verify on a set that build made; when a stream is lost, spoilt or cut
# off, one promise is told to be broken in a line that names it, and the exit code is 1.
set -u
. "$TOP_SRCDIR/tests/expect.sh"
# lines N: so many were printed by the last command.
lines() {
    [ "$(wc -l <"$folder/printed")" -eq "$1" ] && return
    echo "not $1 line(s) but:"
    cat "$folder/printed"
    failed=1
}

"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/dem.tif" --size 700 --rows 500 --epsg 32611 --spacing-m 10 || exit 99
"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/other.tif" --size 700 --rows 500 --epsg 32611 --spacing-m 10 --seed 2 ||
    exit 99
"$scree" build "$folder/dem.tif" -o "$folder/out" --profile local --error 50 -q || exit 1
mkdir "$folder/alone" && cp -R "$folder/out/stream" "$folder/alone/" || exit 99
out=$folder/alone
tile=$out/stream/2/1/1.scree

# info: of a stream, of streams alone, of both products
expect 0 'stream version 1 of tile 2/1/1, local profile' info "$tile"
expect 0 '^  rung  *SVO m  *max error m  *vertices  *triangles  *bytes so far$' info "$tile"
[ "$(grep -c '^ *[0-9-][0-9]* ' "$folder/printed")" -ge 5 ] || failed=1
last=$(tail -n 1 "$folder/printed" | awk '{print $NF}')
[ "$last" -eq "$(wc -c <"$tile")" ] || { echo "the last rung ends at $last bytes, the file elsewhere"; failed=1; }
expect 0 '"bytes_so_far"' info "$tile" --format json
expect 0 '^[^ ]*: streams, local profile, zooms 0 to 2, rungs -4 to 16' info "$out"
expect 0 '"streams": {' info "$out" --format json
expect 0 'quantized-mesh terrain' info "$folder/out"
expect 0 'streams, local profile' info "$folder/out"
expect 1 'neither static tiles (layer.json) nor streams (scree.json)' info "$folder"
lines 1

# extract: at every kind of scale, to every format, of the set and of a tile
for ending in ply obj stl off; do
    expect 0 'rung 16 of zoom 2, 6 tiles' extract "$out" -o "$folder/mesh.$ending"
    [ -s "$folder/mesh.$ending" ] || failed=1
    expect 0 'rung 6 of zoom 2, ' extract "$out" -o "$folder/mesh.$ending" --rung 6
    expect 0 'is the coarsest with an SVO of at most 400 m' extract "$out" -o "$folder/mesh.$ending" --svo 400
    expect 0 'is the coarsest with a max error of at most 20 m' extract "$out" -o "$folder/mesh.$ending" --error 20
done
expect 0 'rung -2 of zoom 0, 1 tile,' extract "$out" -o "$folder/mesh.ply" --rung -2
expect 0 'rung 4 of zoom 1, ' extract "$out/stream/scree.json" -o "$folder/mesh.ply" --rung 4
expect 0 'rung 6 of zoom 2, 1 tile,' extract "$tile" -o "$folder/mesh.ply" --rung 6
expect 0 'rung 6 of zoom 2, 1 tile,' extract "$out" -o "$folder/mesh.ply" --rung 6 --tile 2/1/1
"$scree" extract "$out" -o "$folder/mesh.ply" --svo 400 -q >"$folder/printed" 2>&1 && lines 0
expect 0 '^[^ ]*: zoom 1, ' extract "$folder/out" -o "$folder/mesh.ply" --zoom 1
expect 1 'no rung is as fine as 99' extract "$out" -o "$folder/mesh.ply" --rung 99
expect 1 'no rung has a max error of at most 0.001 m' extract "$out" -o "$folder/mesh.ply" --error 0.001
expect 1 'no tile 2/9/9' extract "$out" -o "$folder/mesh.ply" --tile 2/9/9
expect 1 'has no static tiles' extract "$out" -o "$folder/mesh.ply" --zoom 1
expect 1 'static tiles have no rungs' extract "$folder/out/terrain" -o "$folder/mesh.ply" --rung 1
expect 1 'leave --tile out' extract "$tile" -o "$folder/mesh.ply" --tile 2/1/1
expect 2 'exclude' extract "$out" -o "$folder/mesh.ply" --rung 1 --svo 5
expect 2 'wants a rung' extract "$out" -o "$folder/mesh.ply" --rung 1.5

# The static tiles of zoom Z are the streams at rung 4 Z.
"$scree" extract "$folder/out" -o "$folder/zoom.off" --zoom 1 -q || failed=1
"$scree" extract "$folder/out" -o "$folder/rung.off" --rung 4 -q || failed=1
[ "$(sed -n 2p "$folder/zoom.off")" = "$(sed -n 2p "$folder/rung.off")" ] || {
    echo "zoom 1 has $(sed -n 2p "$folder/zoom.off"), rung 4 has $(sed -n 2p "$folder/rung.off")"
    failed=1
}

# verify
expect 0 'All promises hold' verify "$out"
expect 0 'no post or point is farther off than its stream says' verify "$out" --against "$folder/dem.tif"
expect 0 '"ok": true' verify "$folder/out" --against "$folder/dem.tif" --format json
grep -q '"streams": {' "$folder/printed" || failed=1
expect 1 'BROKEN .*no post or point is farther off' verify "$out" --against "$folder/other.tif" -q
"$scree" verify "$out" -q >"$folder/printed" 2>&1 && lines 0

# what is lost, spoilt or cut off
cp "$tile" "$folder/kept" || exit 99
size=$(wc -c <"$folder/kept")
spoil() { # at so many bytes from the beginning
    cp "$folder/kept" "$tile"
    byte=$(od -An -tu1 -j "$1" -N 1 "$folder/kept")
    printf "$(printf '\\%03o' $((255 - byte)))" | dd of="$tile" bs=1 seek="$1" conv=notrunc 2>/dev/null
}
for at in 0 60 $((size / 2)) $((size - 1)); do
    spoil "$at"
    expect 1 "$tile: " verify "$out" -q
    [ "$(grep -c "$tile: " "$folder/printed")" -eq 1 ] || failed=1
    expect 1 "$tile: " extract "$out" -o "$folder/mesh.ply"
    lines 1
done
expect 0 'stream version 1' info "$tile" # the last byte is none of the header's
head -c $((size / 2)) "$folder/kept" >"$tile"
expect 0 "The file ends after $((size / 2)) of $size bytes: " info "$tile"
expect 0 '"whole": false' info "$tile" --format json
expect 1 "$tile: ends after $((size / 2)) of $size bytes" extract "$tile" -o "$folder/mesh.ply"
lines 1
expect 1 "$tile: ends after $((size / 2)) of $size bytes" verify "$out" -q
head -c 40 "$folder/kept" >"$tile"
expect 1 "$tile: ends within its header, after 40 bytes" info "$tile"
lines 1
cp "$out/stream/2/0/1.scree" "$tile"
expect 1 'tile 2/1/1: its header says that it is 2/0/1' verify "$out" -q
rm "$tile"
expect 1 '2/1/1 is listed in scree.json and is not there' verify "$out" -q
cp "$folder/kept" "$tile"
expect 0 'All promises hold' verify "$out"
printf '{"format": "scree-stream", "format_version": 9}' >"$out/stream/scree.json"
expect 1 'scree.json: its format_version is 9' info "$out"
lines 1
exit $failed
