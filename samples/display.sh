# shellcheck shell=sh
# To be sourced: a display to draw on. Where DISPLAY names none, Xvfb makes one, until the shell that sourced this calls
# display_end (from its trap). display_begin says why and returns 1 where there is neither.

display_process=
display_folder=

display_begin() {
    [ -z "${DISPLAY:-}" ] || return 0
    if ! command -v Xvfb >/dev/null; then
        echo "there is no display: set DISPLAY, or install the package xvfb"
        return 1
    fi
    display_folder=$(mktemp -d) || return 1
    Xvfb -displayfd 3 -screen 0 1280x1024x24 -nolisten tcp 3>"$display_folder/number" >"$display_folder/log" 2>&1 &
    display_process=$!
    for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
        [ -s "$display_folder/number" ] && break
        sleep 0.5
    done
    if [ ! -s "$display_folder/number" ]; then
        echo "there is no display: Xvfb does not start: $(tail -n 1 "$display_folder/log")"
        display_end
        return 1
    fi
    DISPLAY=:$(cat "$display_folder/number")
    export DISPLAY
}

display_end() {
    [ -z "$display_process" ] || { kill "$display_process"; wait "$display_process"; } 2>/dev/null
    [ -z "$display_folder" ] || rm -rf "$display_folder"
    display_process=
    display_folder=
}
