#!/bin/sh
# scree build --method: every method in the list builds a local pyramid that ends within cells and one of the globe with
# a root that no data touch; all promises hold, and any number of threads gives the same bytes. Wrong options are told
# in a line that names them.
set -u
. "$TOP_SRCDIR/tests/expect.sh"

"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/local.tif" --size 130 --rows 300 --epsg 32611 --spacing-m 30 || exit 99
"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/globe.tif" --size 60 --rows 50 --west 11.3 --south 44.9 \
    --spacing-deg 0.05 || exit 99

"$scree" build --method list >"$folder/list" || failed=1
methods=$(sed -n 's/^\([a-z-]*\): .*/\1/p' "$folder/list")
for method in greedy qem; do
    echo "$methods" | grep -q "^$method\$" || { echo "the list lacks $method"; failed=1; }
done

for method in $methods; do
    out=$folder/$method
    expect 0 'million posts a second' build "$folder/local.tif" -o "$out" --profile local --method "$method" -j 1
    expect 0 'All promises hold' verify "$out" --against "$folder/local.tif"
    grep -q "\"method\": *\"$method\"" "$out/terrain/layer.json" || { echo "layer.json lacks $method"; failed=1; }
    [ ! -e "$out/stream" ] || { echo "$method left streams"; failed=1; }
    expect 0 'million posts' build "$folder/local.tif" -o "$out-3" --profile local --method "$method" -j 3
    diff -r "$out" "$out-3" >"$folder/printed" || { echo "$method depends on threads:"; cat "$folder/printed"; failed=1; }
    expect 0 'million posts' build "$folder/globe.tif" -o "$out-globe" --method "$method" --max-zoom 2
    expect 0 'All promises hold' verify "$out-globe" --against "$folder/globe.tif"
    rm -rf "$out" "$out-3" "$out-globe"
done

# options: more error, fewer triangles; by zoom in every form
triangles() { awk '$1 == "'"$2"'" { print $4 }' "$1"; }
build() { expect 0 'million posts' build "$folder/local.tif" -o "$folder/o" --profile local --method greedy "$@"; }
build
cp "$folder/printed" "$folder/plain"
build --method-option g_e=1000
[ "$(triangles "$folder/printed" 1)" -lt "$(triangles "$folder/plain" 1)" ] || { echo 'g_e=1000 changes nothing'; failed=1; }
build --method-option g_e=200 --method-option g_g=0:30,1:0
cp "$folder/printed" "$folder/list"
build --method-option g_e=200/2
[ "$(triangles "$folder/printed" 1)" -gt "$(triangles "$folder/list" 1)" ] || { echo 'g_e=200/2 does not halve'; failed=1; }
[ "$(triangles "$folder/printed" 0)" -lt "$(triangles "$folder/list" 0)" ] || { echo 'g_g=0:30 has no grid'; failed=1; }

# wrong ones
wrong() {
    words=$1 code=$2
    shift 2
    expect "$code" "$words" build "$folder/local.tif" -o "$folder/wrong" --profile local "$@"
    [ "$(wc -l <"$folder/printed")" -eq 1 ] || { echo "not one line:"; cat "$folder/printed"; failed=1; }
    [ ! -e "$folder/wrong" ] || { echo "something was built"; failed=1; }
}
wrong 'there is no method greddy; there are: greedy, ' 2 --method greddy
wrong 'method greedy has no option g_x' 2 --method greedy --method-option g_x=1
wrong 'option g_e of method greedy: -1 at zoom 0; it takes 0 to 1e+07' 2 --method greedy --method-option g_e=-1
wrong 'option g_e of method greedy: a is no value' 2 --method greedy --method-option g_e=a
wrong 'option g_e of method greedy: 5:1,3:2 is no value' 2 --method greedy --method-option g_e=5:1,3:2
wrong 'there is no value for zoom 0, the list begins at zoom 1' 1 --method greedy --method-option g_e=1:5
wrong 'option g_g of method greedy: 10000 at zoom 1; it takes 0 to 8192' 1 --method greedy --method-option 'g_g=5000*2'
wrong 'written NAME=VALUE, not g_e' 2 --method greedy --method-option g_e
wrong 'bound=0 wants vertices' 1 --method qem --method-option bound=0
wrong 'which method?' 2 --method-option g_e=1
wrong 'ask for --products terrain' 2 --method greedy --products terrain,stream
wrong 'a value is missing behind --method' 2 --method
exit $failed
