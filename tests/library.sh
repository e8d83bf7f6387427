#!/bin/sh
# The library as others get it: installed into a folder of its own, found by pkg-config, shared and static. It shows the
# symbols of tests/exported_symbols.txt and no others, wants zlib, libm and libc only, and the sample player that is
# linked with it plays a tile that build made, up and down again.
# Usage: library.sh; environment: TOP_SRCDIR, TOP_BUILDDIR, CC, MAKE, SANITIZE, and as options NM, READELF.
set -u
: "${NM:=nm}" "${READELF:=readelf}" "${MAKE:=make}"
for tool in pkg-config "$READELF"; do
    if ! command -v "$tool" >/dev/null; then
        echo "skipped: $tool is not installed"
        exit 77
    fi
done
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
failed=0
fail() {
    echo "$1"
    failed=1
}

# The make that runs this test has its own jobs and targets.
unset MAKEFLAGS MFLAGS MAKELEVEL
"$MAKE" -s -C "$TOP_BUILDDIR" DESTDIR="$folder/stage" install-libLTLIBRARIES install-screeincludeHEADERS \
    install-pkgconfigDATA >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
description=$(find "$folder/stage" -name scree-stream.pc)
if [ ! -f "$description" ]; then
    echo "no scree-stream.pc was installed"
    exit 1
fi
PKG_CONFIG_PATH=$(dirname "$description")
PKG_CONFIG_SYSROOT_DIR=$folder/stage
export PKG_CONFIG_PATH PKG_CONFIG_SYSROOT_DIR
libraries=$(dirname "$PKG_CONFIG_PATH")
headers=$(find "$folder/stage" -name scree -type d)
for header in "$TOP_SRCDIR"/include/scree/*.h; do
    [ -f "$headers/$(basename "$header")" ] || fail "$header is not installed"
done

shared=$(find "$libraries" -name 'libscree-stream.so.*' -type f)
if [ -n "$shared" ] && [ -z "${SANITIZE:-}" ]; then
    $NM -D --defined-only "$shared" | awk '{print $NF}' | LC_ALL=C sort >"$folder/symbols"
    diff "$TOP_SRCDIR/tests/exported_symbols.txt" "$folder/symbols" ||
        fail "the library's symbols (>) are not those of tests/exported_symbols.txt (<)"
    foreign=$($READELF -d "$shared" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | grep -vE '^(libz|libm|libc|ld-linux.*)\.so')
    [ -z "$foreign" ] || fail "the library wants $foreign"
fi

"$TOP_BUILDDIR/tests/fractal_dem" -o "$folder/dem.tif" --size 300 --rows 280 --epsg 32611 --spacing-m 10 || exit 99
"$TOP_BUILDDIR/scree" build "$folder/dem.tif" -o "$folder/out" --profile local --error 50 -q || exit 1
# play NAME FLAGS...: the sample, linked in one way, on every tile and on none.
play() {
    name=$1
    shift
    # Flags are lists of words on purpose.
    # shellcheck disable=SC2086
    $CC -std=c17 -Wall -Wextra -Werror "$TOP_SRCDIR/samples/play.c" -o "$folder/$name" ${SANITIZE:-} "$@" ||
        { fail "samples/play.c: does not link with the $name library"; return; }
    tiles=0
    for tile in $(find "$folder/out/stream" -name '*.scree'); do
        tiles=$((tiles + 1))
        LD_LIBRARY_PATH=$libraries "$folder/$name" "$tile" >"$folder/printed" || fail "$name: $tile does not play"
        grep -q 'coarsest mesh: identical' "$folder/printed" || { cat "$folder/printed"; failed=1; }
    done
    [ $tiles -gt 1 ] || fail "build made $tiles streams"
    if LD_LIBRARY_PATH=$libraries "$folder/$name" "$folder/dem.tif" >/dev/null 2>"$folder/printed"; then
        fail "$name: a GeoTIFF plays as a stream"
    fi
    grep -q 'not a Scree stream' "$folder/printed" || fail "$name: $(cat "$folder/printed")"
}
flags=$(pkg-config --cflags scree-stream)
# shellcheck disable=SC2046,SC2086
[ -z "$shared" ] || play shared $flags $(pkg-config --libs scree-stream)
archive=$libraries/libscree-stream.a
# shellcheck disable=SC2086
[ ! -f "$archive" ] || play static $flags "$archive" -lz -lm
[ -n "$shared" ] || [ -f "$archive" ] || fail "neither a shared nor a static library was installed"
exit $failed
