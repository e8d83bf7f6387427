#!/bin/sh
# Fuzzes the decoder of streams and the readers of files with libFuzzer under AddressSanitizer and
# UndefinedBehaviorSanitizer, in the folder `fuzz` of the build folder; each gets half of the time. Passes with a line
# where clang or its runtime is missing.
# Usage: fuzz.sh TOP_SOURCE_DIR TOP_BUILD_DIR; environment: FUZZ_SECONDS (default 60), MAKE.
set -eu
source=$1 build=$2/fuzz
mkdir -p "$build/found" "$build/found-files"
cd "$build"
printf '#include <stddef.h>\nint LLVMFuzzerTestOneInput(const unsigned char *d, size_t n) { return d == 0 && n > 0; }\n' >probe.c
if ! clang -fsanitize=fuzzer,address,undefined -o probe probe.c 2>/dev/null; then
    echo "fuzz: skipped: clang with libFuzzer is not installed (Debian: clang, libclang-rt-dev)"
    exit 0
fi
[ -e Makefile ] || "$source/configure" --quiet CC=clang CXX=clang++ --enable-fuzz
"${MAKE:-make}" tests/fuzz_stream tests/fuzz_files
# New inputs are kept in found/ and tried again next time; a finding is left as finding-* with a trace above it.
half=$(((${FUZZ_SECONDS:-60} + 1) / 2))
tests/fuzz_stream -max_total_time=$half -max_len=1500 -timeout=5 -print_final_stats=1 \
    -artifact_prefix=finding- found "$source/tests/corpus/stream"
tests/fuzz_files -max_total_time=$half -max_len=5000 -timeout=5 -print_final_stats=1 -dict="$source/tests/fuzz_files.dict" \
    -artifact_prefix=finding- found-files "$source/tests/corpus/files"
