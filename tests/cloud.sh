#!/bin/sh
# Point clouds: LAS and text become terrain that keeps its promises, on any number of threads; bad ones are refused.
set -u
# shellcheck source=tests/builds.sh
. "$TOP_SRCDIR/tests/builds.sh"

"$TOP_BUILDDIR/tests/fractal_las" -o trees.las --points 40000 --spacing-m 3 || exit 99
"$scree" build trees.las --class 2 --grid 4 -o out -q -j 1 || fail 'no build'
"$scree" verify out --against trees.las --class 2 --grid 4 >printed || fail "LAS: $(grep BROKEN printed)"
"$scree" verify out --against trees.las --class 5 --grid 4 >printed && fail 'trees are as high as the ground'
"$scree" build trees.las --class 2 --grid 4 -o threads -q -j 3 || fail 'no build on three threads'
diff -r out threads >printed || fail "other bytes on three threads: $(head -n 3 printed)"

# The same by another way: returns in place of classes.
"$scree" build trees.las --returns only --grid 4 -o returns -q || fail 'no build of returns'
diff -r out returns >printed || fail "other bytes by returns: $(head -n 3 printed)"
"$scree" build trees.las --thin 6 --outliers 60 --max-edge 40 -o thin -q --profile local || fail 'no thin build'
"$scree" verify thin --against trees.las --thin 6 --outliers 60 --max-edge 40 >printed ||
    fail "thin: $(grep BROKEN printed)"

# Text: a plane, whose heights stay what they are.
awk 'BEGIN { print "x,y,z"; for (i = 0; i < 3600; i++) print i % 60 * 3, int(i / 60) * 3, i % 60 }' OFS=, >plane.csv
"$scree" build plane.csv --s_srs EPSG:32611 --grid 3 --profile local -o plane -q || fail 'no build of text'
"$scree" verify plane --against plane.csv --s_srs EPSG:32611 --grid 3 >printed || fail "text: $(grep BROKEN printed)"

refuses 2 '--grid wants' trees.las --grid 0
refuses 2 '--class wants' trees.las --class 2,,9
refuses 2 '--returns wants' trees.las --returns second
refuses 1 'let through' trees.las --class 44
refuses 1 '--memory' trees.las --memory 1
refuses 1 'too little' trees.las --grid 5000
refuses 1 'only LAS' plane.csv --s_srs EPSG:32611 --class 2
head -c 60000 trees.las >short.las
refuses 1 'cut off' short.las
{ head -c 104 trees.las && printf '\201' && tail -c +106 trees.las; } >trees.laz
refuses 1 'laszip -i' trees.laz
{ cat plane.csv && echo 5,6; } >ragged.csv
refuses 1 'line 3602' ragged.csv --s_srs EPSG:32611 --grid 3

page clouds.md 3

if [ -r "$data/quebec_topography_ground_water.las" ]; then
    cloud=$data/quebec_topography_ground_water.las
    "$scree" build "$cloud" --class 2,9 --grid 2 -o real -q || fail 'no build of a real cloud'
    "$scree" verify real --against "$cloud" --class 2,9 --grid 2 >printed || fail "real: $(grep BROKEN printed)"
    for profile in local geodetic; do
        "$scree" build "$cloud" --class 2,9 --block 2000 --profile $profile -o kept -q || fail "no triangles: $profile"
        "$scree" verify kept --against "$cloud" --class 2,9 >printed || fail "$profile: $(grep BROKEN printed)"
    done
else
    echo "skipped: no real cloud in $data (SCREE_TEST_DATA names the folder)"
fi
exit $failed
