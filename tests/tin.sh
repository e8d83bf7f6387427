#!/bin/sh
# TINs: mesh files of all formats become the same terrain, on any number of threads, and what is none is refused.
set -u
# shellcheck source=tests/builds.sh
. "$TOP_SRCDIR/tests/builds.sh"

# A hill of 40 x 40 points, in centimetres, with a hole and a corner off.
awk 'BEGIN {
    print "ply\nformat ascii 1.0\nelement vertex 1600\nproperty double x\nproperty double y\nproperty double z"
    for (y = 0; y < 39; y++) for (x = 0; x < 39; x++) if (!is_out(x, y)) {
        a = 40 * y + x
        faces = faces "3 " a " " a + 1 " " a + 41 "\n3 " a " " a + 41 " " a + 40 "\n"
        count += 2
    }
    print "element face " count "\nproperty list uchar int vertex_indices\nend_header"
    for (y = 0; y < 40; y++) for (x = 0; x < 40; x++)
        printf "%.2f %.2f %.2f\n", 500000 + 5 * x + (7 * x * y) % 3 / 2, 4000000 + 5 * y + (5 * x + y * y) % 4 / 3,
            100 + 60 * exp(-((x - 20) ^ 2 + (y - 18) ^ 2) / 90) + (x * y) % 7 / 10
    printf "%s", faces
}
function is_out(x, y) { return (x > 8 && x < 14 && y > 25 && y < 30) || x + y > 70 }' >hill.ply

build() { "$scree" build "$@" -q; }
build hill.ply --profile local --block 500 -o out -j 1 || fail 'no build'
build hill.ply --profile local --block 500 -o threads -j 3 || fail 'no build on three threads'
diff -r out threads >printed || fail "other bytes on three threads: $(head -n 3 printed)"
"$scree" verify out --against hill.ply >printed || fail "$(grep BROKEN printed)"
build hill.ply --s_srs EPSG:32611 -o globe || fail 'no build on the globe'
"$scree" verify globe --against hill.ply --s_srs EPSG:32611 >printed || fail "globe: $(grep BROKEN printed)"
build hill.ply --grid 5 --profile local -o posts || fail 'no posts'
"$scree" verify posts --against hill.ply --grid 5 >printed || fail "posts: $(grep BROKEN printed)"

# Measured against something else: other points, posts where triangles were and triangles where posts were.
# another WORD ARGUMENT...: verify fails, and says so.
another() {
    word=$1
    shift
    "$scree" verify "$@" >printed 2>&1 && fail "verify $*: $(tail -n 1 printed)"
    grep -q -e "$word" printed || fail "verify $*: $(tail -n 1 printed)"
}
sed 's/ \(1[0-9][0-9]\)\.\([0-9]*\)$/ \1.9\2/' hill.ply >higher.ply
sed 's/^\(50[0-9]*\)\./\10./' hill.ply >wider.ply
another 'BROKEN .*finest zoom is within' out --against higher.ply
another 'BROKEN .*no post or point' out --against higher.ply
another 'use the same inputs' out --against wider.ply
another 'use the same inputs' out --against hill.ply --grid 5
another 'use the same inputs' globe --against hill.ply --s_srs EPSG:32611 --grid 5
another 'use the same inputs' posts --against hill.ply

# One triangle, most of whose tiles have nothing of it: with a fine base these have to meet the others all the same.
printf 'v 500000 4000000 0\nv 510000 4000000 0\nv 500001 4010000 1\nf 1 2 3\n' >one.obj
for base in 20% 100% 1; do
    build one.obj --s_srs EPSG:32611 --base $base -o one || fail 'no build of one triangle'
    "$scree" verify one >printed || fail "one triangle, --base $base: $(grep BROKEN printed)"
done

# The other formats, by way of what is extracted. Numbers of texts are those of floats, to nine digits.
for format in ply obj stl off; do
    "$scree" extract out -o mesh.$format -q || fail "no mesh.$format"
    build mesh.$format --profile local --products stream -o from_$format || fail "$format: no build"
    "$scree" verify from_$format --against mesh.$format >printed || fail "$format: $(grep BROKEN printed)"
done
diff -r from_ply from_stl >printed || fail "STL: other bytes than from PLY: $(head -n 3 printed)"

# The base: a share, a number, a scale.
# coarsest_of: the last table's vertices at the coarsest rungs, and the SVO there, of the coarsest zoom.
coarsest_of() { "$scree" info base | awk '/coarsest rungs/ { seen = NR } seen && NR == seen + 2 { print $6, $7 }'; }
whole=$("$scree" info out | awk 'END { print $(NF - 2) }')
for base in 20% 600 1.2m; do
    build hill.ply --profile local --products stream --block 500 --base $base -o base || fail "--base $base: no build"
    "$scree" verify base >printed || fail "--base $base: $(grep BROKEN printed)"
    coarsest_of | awk -v base=$base -v whole="$whole" '{
        fine = base == "20%" ? $1 < 0.25 * whole && $1 > 0.1 * whole : base == "600" ? $1 < 400 && $1 > 200 : $2 >= 1.2 && $2 < 1.9
        exit !fine }' || fail "--base $base: $(coarsest_of) of $whole"
done

triangles() {
    printf 'OFF\n%d %d 0\n' "$(echo "$1" | tr ';' '\n' | wc -l)" "$(echo "$2" | tr ';' '\n' | wc -l)"
    echo "$1;$2" | tr ';' '\n'
}
triangles '0 0 0;9 0 0;0 9 0;9 9 0;4 9 5' '3 0 1 2;3 1 3 2;3 1 2 4' >book.off
triangles '0 0 0;9 0 0;0 9 0;0 0 7;9 0 7' '3 0 1 2;3 0 4 1;3 0 3 4' >cliff.off
triangles '0 0 0;9 0 0;0 9 0;9 9 0;1 1 5;4 1 5;1 4 5' '3 0 1 2;3 1 3 2;3 4 5 6' >bridge.off
triangles '0 0 0;9 0 0;0 nan 0' '3 0 1 2' >nan.off
triangles '0 0 0;9 0 0;0 9 0' '3 0 1 7' >seven.off
"$TOP_BUILDDIR/tests/fractal_las" -o trees.las --points 40000 || exit 99
refuses 1 '3 triangles share the edge from 0 9 0 to 9 0 0' book.off --profile local
refuses 1 'vertical face at' cliff.off --profile local
refuses 1 'one above the other at' bridge.off --profile local
refuses 1 'nan.off' nan.off --profile local
refuses 1 'seven.off' seven.off --profile local
refuses 1 's_srs' hill.ply
refuses 1 'more --memory than 1 MB' trees.las --profile local --memory 1
refuses 1 'max-zoom' hill.ply --profile local --max-zoom 2
refuses 1 'method' hill.ply --profile local --method greedy
refuses 1 'base' hill.ply --profile local --grid 5 --base 20%
refuses 2 'base wants' hill.ply --base 0%
refuses 2 'base wants' hill.ply --base many
refuses 2 'block wants' hill.ply --block 3
head -c 30000 hill.ply >short.ply
refuses 1 'short.ply' short.ply --profile local
build cliff.off --grid 1 --profile local -o cliff || fail '--grid takes no cliff'

page tins.md 6
exit $failed
