#!/usr/bin/env bash
# watched.sh WHAT COMMAND...: run a command; show WHAT, the seconds so far and its last line. If it fails, show all its output.
set -euo pipefail

what=$1
shift
log=$(mktemp)
"$@" >"$log" 2>&1 &
command=$!
trap 'rm -f "$log"' EXIT
# A process in the background ignores Ctrl-C.
trap 'kill "$command" 2>/dev/null || true; wait "$command" || true; exit 130' INT TERM

shown=-3
while kill -0 "$command" 2>/dev/null; do
    line=$(tail -n 9 "$log" | tr '\r' '\n' | grep -v uninstall | tail -n 1 | cut -c 1-70 || true)
    if [ -t 1 ]; then
        printf '\r\033[K%s: %d s  %s' "$what" "$SECONDS" "$line"
    elif [ $((SECONDS - shown)) -ge 3 ]; then
        shown=$SECONDS
        printf '%s: %d s  %s\n' "$what" "$SECONDS" "$line"
    fi
    sleep 1
done
[ ! -t 1 ] || printf '\r\033[K'
code=0
wait "$command" || code=$?
if [ "$code" -eq 0 ]; then
    echo "$what: done in $SECONDS s"
else
    cat "$log" >&2
fi
exit "$code"
