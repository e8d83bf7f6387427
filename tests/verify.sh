#!/bin/sh
# verify, info and extract on a terrain that build made: all promises hold; when a tile is lost, spoilt or foreign, one
# of them is told to be broken and the exit code is 1.
set -u
. "$TOP_SRCDIR/tests/expect.sh"

"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/dem.tif" --size 700 --rows 500 --epsg 32611 --spacing-m 10 || exit 99
"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/other.tif" --size 700 --rows 500 --epsg 32611 --spacing-m 10 --seed 2 ||
    exit 99
"$scree" build "$folder/dem.tif" -o "$folder/out" --profile local --error 50 -q || exit 1
tile=$folder/out/terrain/2/1/1.terrain

expect 0 'All promises hold' verify "$folder/out"
expect 0 'All promises hold' verify "$folder/out/terrain/layer.json" --against "$folder/dem.tif"
expect 0 '"ok": true' verify "$folder/out" --against "$folder/dem.tif" --format json
expect 1 'BROKEN .*tolerance' verify "$folder/out" --against "$folder/other.tif" -q
expect 1 'no such file\|No such file' verify "$folder/out" --against "$folder/none.tif"
[ "$(wc -l <"$folder/printed")" -eq 1 ] || failed=1
expect 2 'against wants' verify "$folder/out" --against
expect 2 'wants a value' verify "$folder/out" -r
"$scree" verify "$folder/out" -q >"$folder/printed" 2>&1 && [ ! -s "$folder/printed" ] || failed=1

expect 0 'local profile, zooms 0 to 2' info "$folder/out"
expect 0 '"svo_m"' info "$folder/out" --format json
expect 0 'quantized-mesh-1.0 tile' info "$tile"
expect 0 '"triangles"' info --format json "$tile"
expect 1 'layer.json' info "$folder"

for ending in ply obj stl off; do
    expect 0 'zoom 2, ' extract "$folder/out/terrain" -o "$folder/mesh.$ending"
    [ -s "$folder/mesh.$ending" ] || failed=1
done
expect 0 'zoom 0, ' extract "$folder/out/terrain" -o "$folder/mesh.ply" --error 100000
expect 0 'zoom 1, ' extract "$folder/out" -o "$folder/mesh.ply" --zoom 1
expect 0 'zoom 2, ' extract "$tile" -o "$folder/mesh.ply"
expect 1 'that fine' extract "$folder/out/terrain" -o "$folder/mesh.ply" --error 0.001
expect 1 'no tile 2/9/9' extract "$folder/out/terrain" -o "$folder/mesh.ply" --tile 2/9/9
expect 2 'exclude' extract "$folder/out" -o "$folder/mesh.ply" --zoom 1 --error 5
expect 2 'zoom/x/y' extract "$folder/out" -o "$folder/mesh.ply" --tile 2/1

# Fine posts on high ground: a tile's side is shorter than the wall at the end of the data is high.
"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/high.tif" --size 40 --spacing-deg 0.00001 --west 10 --south 47 || exit 99
"$scree" build "$folder/high.tif" -o "$folder/high" --max-zoom 18 -q || failed=1
expect 0 'All promises hold' verify "$folder/high" --against "$folder/high.tif"
rm -rf "$folder/high"

cp "$tile" "$folder/kept" || exit 99
cp "$folder/out/terrain/2/0/1.terrain" "$tile"
expect 1 'BROKEN  neighbours meet' verify "$folder/out"
head -c 500 "$folder/kept" >"$tile"
expect 1 'BROKEN  every tile is quantized-mesh' verify "$folder/out"
rm "$tile"
expect 1 '2/1/1 is listed in layer.json and is not there' verify "$folder/out" -q
cp "$folder/kept" "$tile"
cp "$tile" "$folder/out/terrain/2/1/3.terrain"
expect 1 '2/1/3 ' verify "$folder/out" -q
rm "$folder/out/terrain/2/1/3.terrain"
expect 0 'All promises hold' verify "$folder/out"
exit $failed
