#!/usr/bin/env bash
# debian.sh PACKAGE...: install missing Debian packages; without permission, name them in one line.
set -euo pipefail

missing=()
for package in "$@"; do
    dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if [ "$(id -u)" -ne 0 ] || ! command -v apt-get >/dev/null; then
    echo "missing on this machine: ${missing[*]} (names of Debian packages; there: sudo apt-get install ${missing[*]})" >&2
    exit 1
fi
export DEBIAN_FRONTEND=noninteractive
what="Installing ${missing[*]}"
"$(dirname "$0")/watched.sh" "$what (lists)" apt-get update -qq </dev/null
"$(dirname "$0")/watched.sh" "$what" apt-get install -qq --no-install-recommends "${missing[@]}" </dev/null
