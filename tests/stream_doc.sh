#!/bin/sh
# The worked example of docs/stream.md is the file that it says it is, byte by byte.
set -u
documented=$(sed -n 's/^ \{4,6\}[0-9]\{1,3\}  \([0-9a-f ]*\)|.*/\1/p' "$TOP_SRCDIR/docs/stream.md" | tr -d ' \n')
file=$(od -An -v -tx1 "$TOP_SRCDIR/tests/corpus/stream/good-example.scree" | tr -d ' \n')
if [ -z "$file" ] || [ "$documented" != "$file" ]; then
    echo "docs/stream.md: the example is not tests/corpus/stream/good-example.scree"
    printf 'documented %s\nfile       %s\n' "$documented" "$file"
    exit 1
fi
echo "${#file} digits agree"
