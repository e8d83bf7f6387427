#!/bin/sh
# The experiment with the points of an island (samples/island_experiment.sh, docs/island.md), with four scales as models
# of their own and without pictures: what the page claims holds, and the text and the LAS file of the points are one
# cloud.
set -u
# shellcheck source=tests/builds.sh
. "$TOP_SRCDIR/tests/builds.sh"

SCREE_BUILD=$TOP_BUILDDIR ISLAND_LEVELS=4 ISLAND_PICTURES=no \
    sh "$TOP_SRCDIR/samples/island_experiment.sh" "$folder/made" >printed 2>&1 || fail "$(tail -n 12 printed)"
[ "$(grep -c '^  ok .* [0-9.]*$' printed)" -ge 6 ] || fail "fewer claims than there were: $(tail -n 12 printed)"

# What the page says of the factors is what the experiment checks.
for factor in plain_factor gzipped_factor; do
    number=$(sed -n "s/^$factor=//p" "$TOP_SRCDIR/samples/island_experiment.sh")
    grep -q "at least $number times" "$TOP_SRCDIR/docs/island.md" || fail "docs/island.md does not claim $number times"
done

"$TOP_BUILDDIR/tests/island_cloud" -o island.las || fail 'no LAS file'
"$TOP_BUILDDIR/scree" build island.las --profile local --products stream -q -o las || fail 'no build of the LAS file'
diff -r las/stream/1 made/terrain/stream/1 >differences || fail "LAS is not what text is: $(head -n 3 differences)"
exit $failed
