#!/bin/sh
# build --fit: static tiles are fitted and keep their promises, on any number of threads; streams do not change.
set -u
# shellcheck source=tests/builds.sh
. "$TOP_SRCDIR/tests/builds.sh"

# triangles OUT: of all its static tiles.
triangles() {
    "$scree" info "$1/terrain" --format json | sed -n 's/.*"triangles": \([0-9]*\).*/\1/p' | awk '{ n += $1 } END { print n }'
}

"$TOP_BUILDDIR/tests/fractal_dem" -o dem.tif --size 300 --rows 280 --epsg 32611 --spacing-m 10 || exit 99
# builds PROFILE OPTION...: with and without.
builds() {
    profile=$1
    shift
    "$scree" build dem.tif -o plain -q --profile "$profile" "$@" || fail "$profile: no build"
    "$scree" build dem.tif -o fitted -q --profile "$profile" "$@" --fit -j 1 || fail "$profile: no build with --fit"
    "$scree" verify fitted --against dem.tif >printed || fail "$profile: $(grep BROKEN printed)"
    before=$(triangles plain) after=$(triangles fitted)
    [ "$before" -gt 1000 ] && [ "$after" -lt $((before - before / 20)) ] ||
        fail "$profile: $before triangles became $after"
}
builds local --error 10
"$scree" build dem.tif -o threads -q --profile local --error 10 --fit -j 3 || fail 'no build on three threads'
diff -r fitted threads >printed || fail "other bytes on three threads: $(head -n 3 printed)"
diff -r plain/stream fitted/stream >printed || fail "streams have changed: $(head -n 3 printed)"
rm -rf plain fitted
builds geodetic --error 40000 --products terrain --finest-octaves 0

# refuses WORD ARGUMENT...: exit code 2 and one line that has the word.
refuses() {
    word=$1
    shift
    "$scree" build dem.tif -o refused "$@" >printed 2>&1
    [ $? -eq 2 ] && grep -q -e "$word" printed && [ ! -e refused ] || fail "$*: $(cat printed)"
}
refuses 'not for --method' --fit --method greedy
refuses 'for static tiles' --fit --products stream
exit $failed
