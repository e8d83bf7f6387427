#!/bin/sh
# The house rules' own test: each is fed a small tree with one fault and has to find it, and a clean one and has to
# pass it. Usage: planted_faults.sh [DIRECTORY_OF_THE_SCRIPTS]; environment: CC, CXX.
set -u
if [ -n "${SANITIZE:-}" ]; then
    echo "skipped: the plain build has this check"
    exit 77
fi
scripts=$(cd "${1:-$TOP_SRCDIR/tests}" && pwd) || exit 99
scratch=$(mktemp -d) || exit 99
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 99
CPPFLAGS=
export CC CXX CPPFLAGS
failed=0

clean_tree() {
    rm -rf tree
    mkdir -p tree/include tree/stream/.libs tree/lod tree/src
    echo 'int half(int n);' >tree/stream/half.h
    printf '#include "stream/half.h"\nint half(int n) { return n / 2; }\n' >tree/stream/half.c
}
compile() {
    $CC -std=c17 -O1 -fPIC -Itree -c tree/stream/half.c -o tree/stream/.libs/libstream_la-half.o || exit 99
}
expect() { # expect pass|fail WHAT COMMAND...
    wanted=$1 what=$2
    shift 2
    if "$@" >output 2>&1; then got=pass; else got=fail; fi
    if [ $got = "$wanted" ]; then
        echo "ok: $what"
    else
        echo "$what: expected $wanted, got $got"
        cat output
        failed=1
    fi
}

clean_tree
compile
expect pass "a clean tree's headers" sh "$scripts/headers.sh" tree
expect pass "a clean tree's objects" sh "$scripts/purity.sh" tree
expect pass "a clean tree's sources" sh "$scripts/sources.sh" tree

echo 'size_t half(size_t n);' >tree/stream/half.h
expect fail "a header that needs another one" sh "$scripts/headers.sh" tree
echo 'int half(int class);' >tree/stream/half.h
expect fail "a header that is not C++" sh "$scripts/headers.sh" tree

impure() { # impure WHAT SOURCE
    clean_tree
    printf '%s\n' "$2" >tree/stream/half.c
    compile
    expect fail "$1" sh "$scripts/purity.sh" tree
}
impure "a counter that outlives the call" 'int half(int n) { static int calls; calls += n; return calls; }'
impure "an initialised global" 'int divisor = 2; int half(int n) { return n / divisor++; }'
impure "a thread's own global" 'static _Thread_local int calls; int half(int n) { return calls += n; }'
impure "a file" '#include <stdio.h>
int half(int n) { FILE *f = fopen("half", "r"); return f == NULL ? n : n / 2; }'
impure "a print" '#include <stdio.h>
int half(int n) { printf("%d\n", n); return n / 2; }'
impure "a clock" '#include <time.h>
int half(int n) { return n / 2 + (int)time(NULL); }'
impure "an exit" '#include <stdlib.h>
int half(int n) { if (n < 0) exit(1); return n / 2; }'

says() { # says WHAT FILE TEXT
    clean_tree
    printf '%s\n' "$3" >"tree/$2"
    expect fail "$1" sh "$scripts/sources.sh" tree
}
says "stream that includes lod" stream/half.c '#include "lod/mesh.h"'
says "lod that includes src" lod/mesh.c '#include "src/raster_io.h"'
says "an include without its folder" lod/mesh.c '#include "mesh.h"'
says "GDAL in a pure file" src/lattice.c '#include <gdal.h>'
says "strcpy" src/name.c 'void name(char *to) { strcpy (to, "x"); }'
says "atoi behind a comment" src/name.c 'int n(void) { return /* a
 number */ atoi(text); }'

clean_tree
printf '%s\n' '/* not sprintf(), which' ' * knows no bounds */ const char *text = "strcpy(";' >tree/src/name.c
expect pass "banned names in comments and strings" sh "$scripts/sources.sh" tree
exit $failed
