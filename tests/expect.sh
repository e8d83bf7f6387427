# To be sourced by tests of the command line: a folder that goes with the shell, and expect. They end with
# `exit $failed`.
scree=$TOP_BUILDDIR/scree
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT
failed=0
# expect CODE WORD ARGUMENT...: the exit code, and a word in what is printed.
expect() {
    code=$1 word=$2
    shift 2
    "$scree" "$@" >"$folder/printed" 2>&1
    got=$?
    if [ $got -ne "$code" ] || ! grep -q -e "$word" "$folder/printed"; then
        echo "scree $*: exit code $got (wanted $code), and '$word' was wanted in:"
        cat "$folder/printed"
        failed=1
    fi
}
