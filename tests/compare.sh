#!/bin/sh
# scree compare: every file is there with its columns, the figures are those of build and verify, a seed gives them
# again, numbers of triangles are met, and what makes no sense is refused in one line.
set -u
scree=$TOP_BUILDDIR/scree
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 99
failed=0
fail() {
    echo "$1"
    cat out err
    failed=1
}
# compares OPTION...: it does, and says nothing on stderr.
compares() {
    "$scree" compare dem.tif -q "$@" >out 2>err || fail "compare $*: fails"
    [ ! -s err ] || fail "compare $*: nothing was expected on stderr"
}
# refuses CODE WORDS ARGUMENT...: one line with these words, and no report.
refuses() {
    wanted=$1 words=$2
    shift 2
    rm -rf to
    "$scree" compare -q "$@" >out 2>err
    got=$?
    [ $got -eq "$wanted" ] || fail "compare $*: exit code $got, not $wanted"
    [ "$(wc -l <err)" -eq 1 ] || fail "compare $*: one line was expected on stderr"
    grep -q -- "$words" err || fail "compare $*: '$words' was expected on stderr"
    [ ! -e to/compare.csv ] || fail "compare $*: there is a report"
}
# field ROW NAME: of compare.csv, row 1 being the first below the names.
field() {
    awk -F, -v row="$1" -v name="$2" 'NR == 1 {for (i = 1; i <= NF; i++) at[$i] = i}
        NR == row + 1 {print $at[name]}' to/compare.csv
}
# close A B SHARE: whether two numbers differ by no more than this share.
close() {
    awk -v a="$1" -v b="$2" -v share="$3" 'BEGIN {d = a - b; if (d < 0) d = -d; exit !(d <= share * b)}'
}

"$TOP_BUILDDIR/tests/fractal_dem" -o dem.tif --size 600 --rows 530 --epsg 32611 --spacing-m 30 || exit 99
options='--profile local --error 80'

# The files, and the same figures twice.
# shellcheck disable=SC2086 # options are words
compares $options -o to --methods greedy,random --picture-px 64
for file in compare.md compare.csv tiles.csv hausdorff.svg error.svg mesh-z2-posts.png mesh-z2-greedy.png; do
    [ -s to/$file ] || fail "there is no $file"
done
for file in to/.scree-tmp-*; do
    [ ! -e "$file" ] || fail "$file is left behind"
done
[ "$(head -n 1 to/compare.csv)" = "zoom,method,options,wanted_triangles,tiles,cpu_s,vertices,triangles,hausdorff_m,\
hausdorff_max_m,mean_distance_m,max_error_m,rms_error_m,bytes" ] || fail 'other columns than expected'
[ "$(wc -l <to/compare.csv)" -eq 5 ] || fail 'two zooms and two methods are four lines'
[ "$(field 3 zoom) $(field 3 method) $(field 3 tiles)" = '2 greedy 4' ] || fail 'the third line is of another kind'
[ "$(wc -l <to/tiles.csv)" -eq 11 ] || fail 'ten lines of tiles were expected'
grep -q '## Zoom 2, 4 full tiles of 9' to/compare.md || fail 'the page does not tell the tiles'
grep -q '</svg>' to/hausdorff.svg || fail 'the chart of distances has no end'
grep -q '</svg>' to/error.svg || fail 'the chart of errors has no end'
cut -d, -f1-5,7- to/compare.csv >first
# shellcheck disable=SC2086
compares $options -o to --methods greedy,random --picture-px 0
cut -d, -f1-5,7- to/compare.csv | cmp -s - first || fail 'another run has other figures'

# What build and verify say: the four full tiles of zoom 2 are all that there is in a crop to them.
"$scree" build dem.tif -o built -q --profile local --error 80 --method greedy || fail 'build does not'
bytes=0
for y in 0 1; do
    for x in 0 1; do bytes=$((bytes + $(wc -c <built/terrain/2/$x/$y.terrain))); done
done
close "$(field 3 bytes)" $((bytes / 4)) 0.001 || fail "tiles of $(field 3 bytes) bytes; those built have $bytes in all"
largest=$("$scree" verify built --against dem.tif --format json |
    awk '/"zoom": 2,/ {here = 1} here && /"height": / {sub(/.*"max_m": /, ""); sub(/,.*/, ""); print; exit}')
close "$(field 3 max_error_m)" "$largest" 0.01 ||
    fail "the max error is $(field 3 max_error_m) m, verify finds $largest m over all tiles"

# Numbers of triangles.
# shellcheck disable=SC2086
compares $options -o to --methods greedy,quadtree --triangles 1500,6000 --zooms 2 --picture-px 0
for row in 1 2 3 4; do
    close "$(field $row triangles)" "$(field $row wanted_triangles)" 0.02 || fail "line $row has other triangles"
done
[ "$(field 3 wanted_triangles)" = 6000 ] || fail 'the second half is of the other number'
awk -v a="$(field 2 rms_error_m)" -v b="$(field 4 rms_error_m)" 'BEGIN {exit !(a > b && b > 0)}' ||
    fail 'more triangles are no better'
# shellcheck disable=SC2086
"$scree" compare dem.tif $options -o to --methods greedy --zooms 1-2 --picture-px 0 -q --format json >out 2>err ||
    fail 'no JSON'
grep -q '"hausdorff_m": ' out || fail 'the JSON has no distances'
grep -q '"tiles_compared": 4' out || fail 'the JSON does not tell the tiles'
# Twice the same method, the second time by another option.
# shellcheck disable=SC2086
compares $options -o to --methods greedy,by-grid=greedy --method-option by-grid:g_g=? --method-option by-grid:g_e=1e6 \
    --triangles 3000 --zooms 2 --picture-px 0
close "$(field 2 triangles)" 3000 0.1 || fail 'the grid has other triangles'
awk -v a="$(field 1 rms_error_m)" -v b="$(field 2 rms_error_m)" 'BEGIN {exit !(a < b)}' || fail 'a grid is no worse'

# A raster that is smaller than a tile, and degrees.
"$TOP_BUILDDIR/tests/fractal_dem" -o small.tif --size 90 --rows 70 --epsg 32611 --spacing-m 30 || exit 99
"$scree" compare small.tif -q -o to --profile local --methods greedy --picture-px 0 >out 2>err || fail 'not a small one'
grep -q "one tile, which the raster's border cuts" to/compare.md || fail 'the page does not tell that it is cut'
"$TOP_BUILDDIR/tests/fractal_dem" -o degrees.tif --size 700 --spacing-deg 0.0006 --west 10 --south 47 || exit 99
"$scree" compare degrees.tif -q -o to --methods greedy --zooms 10 --picture-px 0 >out 2>err || fail 'not in degrees'
grep -q '^10,greedy' to/compare.csv || fail 'no zoom of degrees'

refuses 2 'which DEM' -o to
refuses 2 'where to' dem.tif
refuses 2 'no option --frobnicate' dem.tif -o to --frobnicate 3
refuses 2 'no option --method' dem.tif -o to --method greedy
refuses 2 'a value is missing' dem.tif -o to --methods
refuses 2 'there is no method nothing' dem.tif -o to --methods greedy,nothing
refuses 2 'greedy twice' dem.tif -o to --methods greedy,greedy
refuses 2 'zooms wants' dem.tif -o to --zooms 4-2
refuses 2 'zooms wants' dem.tif -o to --zooms 23
refuses 2 'triangles wants' dem.tif -o to --triangles 1
refuses 2 'triangles wants' dem.tif -o to --triangles 500,x
refuses 2 'METHOD:NAME=VALUE' dem.tif -o to --methods greedy --method-option g_e=5
refuses 2 'not among' dem.tif -o to --methods greedy --method-option random:r_r=5
refuses 2 'no option h' dem.tif -o to --methods greedy --method-option greedy:h=5
refuses 2 'no option h' dem.tif -o to --methods greedy --method-option greedy:h=?
refuses 2 'without : and /' dem.tif -o to --methods a/b=greedy
refuses 2 'r_r of method random: 101' dem.tif -o to --methods random --method-option random:r_r=101
refuses 2 'picture-px wants' dem.tif -o to --picture-px 5
refuses 2 'format wants' dem.tif -o to --format xml
refuses 2 'seed wants' dem.tif -o to --seed -1
refuses 1 'nothing.tif' nothing.tif -o to
refuses 1 'zoom 0 has no tile' dem.tif -o to --profile local --methods greedy --zooms 0
refuses 1 'no value for zoom' dem.tif -o to --profile local --methods greedy --method-option greedy:g_e=2:5
refuses 1 'no zoom has a tile' small.tif -o to --methods greedy
rm -rf to
: >file
refuses 1 'file' dem.tif -o file/to --profile local --methods greedy
exit $failed
