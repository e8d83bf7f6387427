#!/bin/sh
# The OpenSceneGraph plugin in stock programs: osgconv reads a tile that build made, at the rung that the options ask
# for, with all of its vertices; what is no stream is refused with a reason.
# Usage: osg_plugin.sh; environment: TOP_BUILDDIR, SANITIZE.
set -u
plugin=$TOP_BUILDDIR/.libs/osgdb_scree.so
if ! command -v osgconv >/dev/null; then
    echo "skipped: osgconv is not installed (./bootstrap extra installs it)"
    exit 77
fi
if [ ! -f "$plugin" ]; then
    echo "skipped: the plugin was not built (no OpenSceneGraph)"
    exit 77
fi
if [ -n "${SANITIZE:-}" ]; then
    echo "skipped: osgconv is built without sanitizers and cannot load a plugin with them"
    exit 77
fi
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
OSG_LIBRARY_PATH=$TOP_BUILDDIR/.libs
export OSG_LIBRARY_PATH
failed=0
fail() {
    echo "$1"
    failed=1
}

"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/dem.tif" --size 200 --epsg 32611 &&
    "$TOP_BUILDDIR/scree" build "$folder/dem.tif" --profile local -q -o "$folder/out" || exit 1
tile=$folder/out/stream/0/0/0.scree

# Vertices of the mesh in an .osgt file.
vertices_of() {
    awk '/VertexArray/ { inside = 1 } inside && /vector/ { print $2; exit }' "$1"
}

"$TOP_BUILDDIR/scree" info "$tile" | awk '$1 ~ /^-?[0-9]+$/ && NF == 6 { print $1, $4 }' >"$folder/rungs"
[ "$(wc -l <"$folder/rungs")" -gt 8 ] || fail "scree info lists no rungs"
for line in 1 5 9; do
    rung=$(sed -n "${line}p" "$folder/rungs" | cut -d' ' -f1)
    wanted=$(sed -n "${line}p" "$folder/rungs" | cut -d' ' -f2)
    osgconv -O "rung=$rung" "$tile" "$folder/mesh.osgt" >"$folder/log" 2>&1 || fail "osgconv does not read rung $rung"
    found=$(vertices_of "$folder/mesh.osgt")
    [ "$found" = "$wanted" ] || fail "rung $rung has $wanted vertices, osgconv got ${found:-none}"
    rm -f "$folder/mesh.osgt"
done
osgconv "$tile" "$folder/mesh.osgt" >"$folder/log" 2>&1 || fail "osgconv does not read the finest rung"
[ "$(vertices_of "$folder/mesh.osgt")" = "$(tail -n 1 "$folder/rungs" | cut -d' ' -f2)" ] ||
    fail "without options osgconv does not get the finest rung"
rm -f "$folder/mesh.osgt"
osgconv "$tile" "$folder/mesh.ive" >"$folder/log" 2>&1 && osgconv "$folder/mesh.ive" "$folder/mesh.osgt" >>"$folder/log" 2>&1
[ "$(vertices_of "$folder/mesh.osgt")" = "$(tail -n 1 "$folder/rungs" | cut -d' ' -f2)" ] ||
    fail "an .ive file does not hold the tile: $(cat "$folder/log")"

head -c 700 "$tile" >"$folder/cut.scree"
rm -f "$folder/mesh.osgt"
osgconv "$folder/cut.scree" "$folder/mesh.osgt" >"$folder/log" 2>&1 && fail "half a stream is read"
grep -q 'cut off' "$folder/log" || { cat "$folder/log"; fail "osgconv does not say that the stream is cut off"; }
osgconv -O "svo=much" "$tile" "$folder/mesh.osgt" >"$folder/log" 2>&1 && fail "svo=much is a number"
exit $failed
