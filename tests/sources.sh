#!/bin/sh
# What the sources may say: arrows between the rooms (src -> lod -> stream <- viewer), GDAL and PROJ behind *_io.c,
# includes written from the top, no function that knows no bounds.
# Usage: sources.sh [TOP_SOURCE_DIR]
set -u
cd "${1:-$TOP_SRCDIR}" || exit 99
failed=0
fail() {
    echo "$1"
    failed=1
}

# Room, and the rooms that it may include.
arrows='stream:stream
lod:lod stream
src:src lod stream
viewer:viewer stream'

count=0
for file in $(find include stream lod src viewer -type f \( -name '*.[ch]' -o -name '*.cc' \) 2>/dev/null | LC_ALL=C sort); do
    count=$((count + 1))
    room=${file%%/*}
    allowed=$(printf '%s\n' "$arrows" | sed -n "s/^$room://p")
    for included in $(sed -n 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*"\([^"]*\)".*/\1/p' "$file"); do
        [ "$included" = config.h ] && continue
        case $included in
        */*) ;;
        *) fail "$file: \"$included\" is to be written from the top, with its folder" && continue ;;
        esac
        case " $allowed " in
        *" ${included%%/*} "*) ;;
        *) fail "$file: $room may not include $included" ;;
        esac
    done
    case $file in
    *_io.[ch] | *_io.cc | src/main.c | src/cmd_*.c) ;;
    *)
        foreign=$(grep -nE '^[[:space:]]*#[[:space:]]*include[[:space:]]*<(gdal|ogr|cpl_|proj)' "$file")
        [ -z "$foreign" ] || fail "$file: GDAL and PROJ belong into a file that ends in _io.c: $foreign"
        ;;
    esac
done

for file in $(find include stream lod src viewer tests samples -type f \( -name '*.[ch]' -o -name '*.cc' \) 2>/dev/null |
    LC_ALL=C sort); do
    # Comments and strings may name what code may not call.
    banned=$(sed -e 's/"\([^"\\]\|\\.\)*"//g' -e 's://.*$::' "$file" |
        awk '{ line = $0
               while (1) {
                   if (inside) { at = index(line, "*/"); if (!at) { line = ""; break }
                                 line = substr(line, at + 2); inside = 0 }
                   at = index(line, "/*"); if (!at) break
                   kept = kept substr(line, 1, at - 1); line = substr(line, at + 2); inside = 1 }
               print NR ":" kept line; kept = "" }' |
        grep -E '(^|[^A-Za-z0-9_])(sprintf|vsprintf|strcpy|strcat|gets|atoi|rand|setlocale)[[:space:]]*\(')
    [ -z "$banned" ] || fail "$file: a banned function: $banned"
done
echo "$count files of the rooms looked at"
[ "$count" -gt 0 ] || failed=1
exit $failed
