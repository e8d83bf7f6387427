#!/bin/sh
# Plays every file of the corpus through the fuzzing target: what was found once is not to come back.
set -u
cd "$TOP_BUILDDIR" || exit 99
./tests/fuzz_stream "$TOP_SRCDIR"/tests/corpus/stream/*.scree
