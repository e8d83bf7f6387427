#!/bin/sh
# What every command line promises: help on standard output, errors as one line on standard error, exit codes 0, 1, 2.
set -u
scree=$TOP_BUILDDIR/scree
scratch=$(mktemp -d) || exit 99
trap 'rm -rf "$scratch"' EXIT
failed=0
fail() {
    echo "$1"
    cat "$scratch/out" "$scratch/err"
    failed=1
}
# expect CODE ARGUMENT...: runs scree; its outputs are in out and err afterwards.
expect() {
    wanted=$1
    shift
    "$scree" "$@" >"$scratch/out" 2>"$scratch/err"
    got=$?
    [ $got -eq "$wanted" ] || fail "scree $*: exit code $got, not $wanted"
}
silent() { [ ! -s "$scratch/$1" ] || fail "nothing was expected on std$1"; }
one_line() { [ "$(wc -l <"$scratch/err")" -eq 1 ] || fail "one line was expected on stderr"; }
says() { grep -q -- "$2" "$scratch/$1" || fail "'$2' was expected on std$1"; }

expect 2
silent out
says err 'Usage: scree COMMAND'
expect 0 --help
silent err
says out 'Usage: scree COMMAND'
expect 2 bild
silent out
one_line
says err "'bild'"

expect 0 --version
silent err
for library in scree GDAL PROJ zlib OpenMesh; do
    says out "^$library [0-9][0-9.]*$"
done

commands=$("$scree" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
for command in $commands; do
    expect 0 "$command" --help
    silent err
    says out "Usage: scree $command"
    expect 2 "$command"
    silent out
    says err "scree $command"
    expect 2 "$command" --no-such-option
    silent out
    says err 'no-such-option'
done

if [ -c /dev/full ]; then
    "$scree" --help >/dev/full 2>"$scratch/err"
    got=$?
    : >"$scratch/out"
    [ $got -eq 1 ] || fail "help into a full disk: exit code $got, not 1"
    one_line
fi
exit $failed
