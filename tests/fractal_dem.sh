#!/bin/sh
# The maker of fractal rasters: the same bytes every time, another terrain for another seed, and one line with the right
# exit code for what cannot be done.
set -u
dem=$TOP_BUILDDIR/tests/fractal_dem
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
failed=0
expect() { # expect CODE WORD ARGUMENT...: the exit code, and a word of the one line on standard error
    code=$1 word=$2
    shift 2
    "$dem" "$@" >/dev/null 2>"$folder/error"
    got=$?
    if [ "$got" != "$code" ]; then
        echo "fractal_dem $*: exit code $got, not $code"
        failed=1
    elif [ "$code" != 0 ] && { [ "$(wc -l <"$folder/error")" != 1 ] || ! grep -q -- "$word" "$folder/error"; }; then
        echo "fractal_dem $*: one line with '$word' was expected:"
        cat "$folder/error"
        failed=1
    fi
}

expect 0 '' -o "$folder/a.tif" --size 700 --rows 300
expect 0 '' -o "$folder/b.tif" --size 700 --rows 300
expect 0 '' -o "$folder/c.tif" --size 700 --rows 300 --seed 2
expect 0 '' -o "$folder/d.tif" --size 300 --type Float32 --compress NONE --epsg 32611 --spacing-m 10
cmp "$folder/a.tif" "$folder/b.tif" || failed=1
if cmp -s "$folder/a.tif" "$folder/c.tif"; then
    echo "another seed gave the same raster"
    failed=1
fi
pixels_bytes=$((300 * 300 * 4))
[ "$(wc -c <"$folder/d.tif")" -gt $pixels_bytes ] || { echo "d.tif is too small"; failed=1; }

expect 2 '-o FILE'
expect 2 '--size' -o "$folder/e.tif" --size 1
expect 2 '--size' -o "$folder/e.tif" --size 12x
expect 2 '--type' -o "$folder/e.tif" --type Byte
expect 2 '--colour' -o "$folder/e.tif" --colour red
expect 2 '--seed' -o "$folder/e.tif" --seed
expect 1 'e.tif' -o "$folder/nowhere/e.tif" --size 10
[ ! -e "$folder/e.tif" ] || { echo "a refused raster was made"; failed=1; }
exit $failed
