#!/bin/sh
# Runs every file of the corpora through its fuzzing target: what was found once is not to come back.
set -u
cd "$TOP_BUILDDIR" || exit 99
./tests/fuzz_stream "$TOP_SRCDIR"/tests/corpus/stream/*.scree && ./tests/fuzz_files "$TOP_SRCDIR"/tests/corpus/files/*.*
