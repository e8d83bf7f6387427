#!/bin/sh
# Pure files stay pure: the object files of everything but *_io.c, main.c and cmd_*.c ask for no file, clock, random
# number, environment or terminal, never stop the process, and own no writable global.
# Usage: purity.sh [BUILD_DIR]; environment: NM (default nm), READELF (default readelf), SANITIZE (not empty: skip).
set -u
build=${1:-$TOP_BUILDDIR}
: "${NM:=nm}" "${READELF:=readelf}"
if [ -n "${SANITIZE:-}" ]; then
    echo "skipped: sanitizers add globals and calls of their own; the plain build has this check"
    exit 77
fi
if ! command -v "$READELF" >/dev/null; then
    echo "skipped: readelf is not installed"
    exit 77
fi
impure='open|open64|openat|openat64|creat|fopen|fopen64|fdopen|freopen|tmpfile|mkstemp|mkdtemp'
impure="$impure|read|write|pread|pwrite|pread64|pwrite64|close|fclose|fread|fwrite|fsync|rename|unlink|mkdir|stat|lstat"
impure="$impure|socket|connect|bind|send|recv|system|popen|fork|execve?"
impure="$impure|printf|vprintf|fprintf|vfprintf|__printf_chk|__fprintf_chk|puts|putchar|putc|fputs|fputc|perror|stdout|stderr"
impure="$impure|time|clock|clock_gettime|gettimeofday|nanosleep|usleep|sleep|rand|srand|random|drand48|getrandom"
impure="$impure|getenv|secure_getenv|setenv|setlocale|exit|_exit|quick_exit|abort|__assert_fail|sprintf|strcpy|strcat|gets|atoi"
impure="$impure|GDAL.*|OGR.*|OSR.*|OCT.*|CPL.*|VSI.*|proj_.*"
failed=0
count=0
for object in $(find "$build/stream" "$build/lod" "$build/src" -path '*/.libs/*.o' 2>/dev/null | LC_ALL=C sort); do
    file=$(basename "$object" .o | sed 's/^.*_la-//')
    case $file in *_io | main | cmd_*) continue ;; esac
    calls=$($NM -u "$object" | awk '{print $NF}' | sed 's/@.*//' | grep -Ex "$impure" | tr '\n' ' ')
    if [ -n "$calls" ]; then
        echo "$object: a pure file asks for $calls"
        failed=1
    fi
    # .data.rel.ro is written by the loader only: tables of constant pointers in position independent code.
    writable=$($READELF -SW "$object" | sed -n 's/^ *\[ *[0-9]*\] *//p' |
        awk '$1 ~ /^\.(data|bss|tdata|tbss)/ && $1 !~ /^\.data\.rel\.ro/ && $5 !~ /^0+$/ {print $1}' | tr '\n' ' ')
    if [ -n "$writable" ]; then
        echo "$object: a pure file owns writable globals in $writable"
        failed=1
    fi
    count=$((count + 1))
done
echo "$count object files looked at"
[ "$count" -gt 0 ] || failed=1
exit $failed
