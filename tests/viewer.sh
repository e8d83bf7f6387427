#!/bin/sh
# The viewer's suite, over streams of a small fractal that are made here.
# Usage: viewer.sh [NAME]; environment: TOP_BUILDDIR.
set -u
if [ ! -x "$TOP_BUILDDIR/tests/viewer_suite" ]; then
    echo "skipped: the viewer was not built (no OpenSceneGraph or no CUnit)"
    exit 77
fi
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/dem.tif" --size 700 --epsg 32611 &&
    "$TOP_BUILDDIR/scree" build "$folder/dem.tif" --profile local --products stream --finest-octaves 0 -q \
        -o "$folder/out" || exit 1
SCREE_STREAMS=$folder/out "$TOP_BUILDDIR/tests/viewer_suite" "$@"
