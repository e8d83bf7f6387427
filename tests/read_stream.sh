#!/bin/sh
# A second reader, written from docs/stream.md alone, decodes every good stream of the corpus: the page tells all.
set -u
if ! command -v python3 >/dev/null; then
    echo "skipped: python3 is not installed"
    exit 77
fi
python3 "$TOP_SRCDIR/tests/read_stream.py" "$TOP_SRCDIR"/tests/corpus/stream/good-*.scree
