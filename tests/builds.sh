# To be sourced by tests of scree build: a folder of their own to work in, and what is expected of builds. They end with
# `exit $failed`.
scree=$TOP_BUILDDIR/scree
data=${SCREE_TEST_DATA:-$TOP_SRCDIR/../shared/data}
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 99
failed=0
fail() {
    echo "$*"
    failed=1
}
# refuses CODE WORD ARGUMENT...: one line that has the word, and nothing is written.
refuses() {
    code=$1 word=$2
    shift 2
    rm -rf refused
    "$scree" build "$@" -o refused >printed 2>&1
    [ $? -eq "$code" ] && grep -q -e "$word" printed && [ "$(wc -l <printed)" -eq 1 ] && [ ! -e refused ] ||
        fail "$*: $(cat printed)"
}
# page NAME LEAST: the commands of docs/NAME run as they are written there, at least so many builds; those of other
# people's programs and of make apart.
page() {
    mkdir page && ln -s "$TOP_BUILDDIR" page/build || exit 99
    sed -n 's/^    \(build\/.*\)/\1/p' "$TOP_SRCDIR/docs/$1" >page/commands
    [ "$(grep -c 'scree build' page/commands)" -ge "$2" ] || fail "docs/$1 has fewer commands than it had"
    (cd page && sh -e commands) >printed 2>&1 || fail "docs/$1: $(tail -n 3 printed)"
}
