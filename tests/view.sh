# To be sourced by tests of what scree-view draws: skips where it cannot, a folder of their own, and what is expected of
# runs. They call display_begin before the first picture and end with `exit $failed`.
view=$TOP_BUILDDIR/scree-view
picture=$TOP_BUILDDIR/tests/picture
if [ ! -x "$view" ]; then
    echo "skipped: scree-view was not built (no OpenSceneGraph)"
    exit 77
fi
if [ -n "${SANITIZE:-}" ]; then
    echo "skipped: the graphics driver does not pass the sanitizers; the plain build draws these pictures"
    exit 77
fi
# shellcheck source=samples/display.sh
. "$TOP_SRCDIR/samples/display.sh"
folder=$(mktemp -d) || exit 99
trap 'display_end; rm -rf "$folder"' EXIT
failed=0
fail() {
    echo "$1"
    [ ! -s "$folder/said" ] || cat "$folder/said"
    failed=1
}
# expect CODE PATTERN ARGUMENT...: ends with this code, and says what fits; in one line when it fails.
expect() {
    code=$1 pattern=$2
    shift 2
    "$view" "$@" >"$folder/said" 2>&1
    got=$?
    [ "$got" = "$code" ] || fail "scree-view $*: exit code $got instead of $code"
    grep -q -e "$pattern" "$folder/said" || fail "scree-view $*: does not say '$pattern'"
    [ "$code" = 0 ] || [ "$(wc -l <"$folder/said")" = 1 ] || fail "scree-view $*: not one line"
}
