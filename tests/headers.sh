#!/bin/sh
# Every header compiles alone, as C17 and as C++17; those of viewer/, which are C++, as the latter, where
# OpenSceneGraph is there.
# Usage: headers.sh [TOP_SOURCE_DIR]; environment: CC, CXX, CPPFLAGS (of the libraries), SANITIZE (not
# empty: skip).
set -u
top=${1:-$TOP_SRCDIR}
if [ -n "${SANITIZE:-}" ]; then
    echo "skipped: the plain build has this check"
    exit 77
fi
scratch=$(mktemp -d) || exit 99
trap 'rm -rf "$scratch"' EXIT
warnings='-Wall -Wextra -Werror -fsyntax-only'
defines='-D_XOPEN_SOURCE=700 -D_DEFAULT_SOURCE'
failed=0
count=0
for header in $(cd "$top" && find include stream lod src viewer tests -name '*.h' 2>/dev/null | sort); do
    printf '#include "%s"\nextern int scree_nothing;\n' "$header" >"$scratch/alone.c"
    cp "$scratch/alone.c" "$scratch/alone.cc"
    # The compilers and their flags are lists of words on purpose.
    case $header in
    viewer/*)
        pkg-config --exists openscenegraph || continue
        ;;
    *)
        # shellcheck disable=SC2086
        $CC -std=c17 $warnings $defines -I"$top" -I"$top/include" $CPPFLAGS "$scratch/alone.c" ||
            { echo "$header: does not compile alone as C17"; failed=1; }
        ;;
    esac
    # shellcheck disable=SC2086
    $CXX -std=c++17 $warnings $defines -I"$top" -I"$top/include" $CPPFLAGS "$scratch/alone.cc" ||
        { echo "$header: does not compile alone as C++17"; failed=1; }
    count=$((count + 1))
done
echo "$count headers looked at"
[ "$count" -gt 0 ] || failed=1
exit $failed
