# To be sourced by tests of a command that makes one thing: a folder of their own to work in, and what is expected of
# runs. They set `verb` (the command, with options) and `made` (what it makes there), and end with `exit $failed`.
scree=$TOP_BUILDDIR/scree
scratch=$(mktemp -d) || exit 99
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 99
failed=0
fail() {
    echo "$1"
    cat out err
    failed=1
}
# does ARGUMENT...: it works, without a word on stderr; what it says is in out.
does() {
    # shellcheck disable=SC2086 # words on purpose
    "$scree" $verb "$@" >out 2>err || fail "$verb $*: does not"
    [ ! -s err ] || fail "$verb $*: nothing was expected on stderr"
}
says() { grep -q -- "$1" out || fail "'$1' was expected on stdout"; }
# refuses CODE WORDS ARGUMENT...: it fails with that code and says that in one line; nothing was made.
refuses() {
    wanted=$1 words=$2
    shift 2
    rm -rf "${made%%/*}"
    # shellcheck disable=SC2086 # words on purpose
    "$scree" $verb "$@" >out 2>err
    got=$?
    [ $got -eq "$wanted" ] || fail "$verb $*: exit code $got, not $wanted"
    [ "$(wc -l <err)" -eq 1 ] || fail "$verb $*: one line was expected on stderr"
    grep -q -- "$words" err || fail "$verb $*: '$words' was expected on stderr"
    [ ! -e "$made" ] || fail "$verb $*: there is a $made"
}
