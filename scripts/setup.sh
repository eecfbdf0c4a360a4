#!/usr/bin/env bash
# setup.sh [EXTRA...]: make .venv with the pinned versions, or bring it up to date; without changes, do nothing.
# Each EXTRA, such as docs, is installed when it is first requested, and stays up to date from then on.
# PYTHON=... names the interpreter. Default: the newest one with a constraint file.
set -euo pipefail
cd "$(dirname "$0")/.."

readonly STAMP=.venv/made-from EXTRAS=.venv/extras
export PIP_DISABLE_PIP_VERSION_CHECK=1

# Print the minor version of an interpreter; fail if it is missing or cannot make environments.
version_of() {
    "$1" -c 'import sys, venv, ensurepip; print("%d.%d" % sys.version_info[:2])' 2>/dev/null
}

pinned_versions() {
    ls constraints | sed -n 's/^python-\(.*\)\.txt$/\1/p' | sort -V -r
}

# Print the path of the repository, which the scripts in .venv contain, and a checksum of all inputs of .venv.
fingerprint() {
    pwd
    cat pyproject.toml scripts/setup.sh constraints/*.txt | cksum
}

choose_python() {
    if [ -n "${PYTHON:-}" ]; then
        echo "$PYTHON"
        return
    fi
    local candidate
    for candidate in $(pinned_versions | sed 's/^/python/') python3; do
        if version_of "$candidate" >/dev/null; then
            echo "$candidate"
            return
        fi
    done
    # Debian has a part of Python's venv in a separate package.
    scripts/debian.sh python3 python3-venv >&2 && echo python3
}

# Print the file for this version, or the newest file for a Python that is newer than all of them.
constraints_for() {
    local newest
    newest=$(pinned_versions | head -n 1)
    if [ -e "constraints/python-$1.txt" ]; then
        echo "constraints/python-$1.txt"
    elif [ "$(printf '%s\n' "$1" "$newest" | sort -V | tail -n 1)" = "$1" ]; then
        echo "constraints/python-$newest.txt"
    else
        return 1
    fi
}

# Succeed if .venv is complete, in this place and with the requested Python; else it is made again.
is_usable() {
    [ -x .venv/bin/python ] && [ "$(head -n 1 "$STAMP" 2>/dev/null)" = "$(pwd)" ] || return 1
    [ -z "${PYTHON:-}" ] || [ "$(version_of "$PYTHON")" = "$(version_of .venv/bin/python)" ]
}

refuse() {
    echo "PYTHON must be an interpreter, version 3.11 or newer, with its module venv; got $1" >&2
    exit 1
}

# Run pip and show what it does.
pip_install() {
    local what=$1
    shift
    scripts/watched.sh "$what" .venv/bin/python -m pip install --progress-bar off --constraint "$constraints" "$@"
}

# Print the extras of .venv and the requested ones, separated by commas.
all_extras() {
    { [ ! -e "$EXTRAS" ] || cat "$EXTRAS"; printf '%s\n' kernels "$@"; } | sort -u | paste -s -d ,
}

wanted=$(fingerprint)
if is_usable; then
    if [ "$(cat "$STAMP")" = "$wanted" ] && [ "$(all_extras "$@")" = "$(all_extras)" ]; then
        exit 0
    fi
    python=.venv/bin/python
else
    python=$(choose_python)
fi
version=$(version_of "$python") || refuse "$python"
constraints=$(constraints_for "$version") || refuse "$python, version $version"

if ! is_usable; then
    rm -rf .venv
    scripts/watched.sh "Setting up .venv with Python $version" "$python" -m venv .venv
fi
extras=$(all_extras "$@")
pwd >"$STAMP" # if this is interrupted, the next call goes on with the same .venv
# pip hides the lines of a build. So the kernels are compiled before it builds the package, and it finds them.
linker=ziglang # this package has a linker, for machines without a C compiler
for compiler in cc gcc clang; do
    ! command -v "$compiler" >/dev/null || linker=
done
pip_install "Installing the compiler of the kernels" pip setuptools numba $linker
PYTHONPATH=src .venv/bin/python -m rocking.kernels
pip_install "Installing rocking [$extras]" --no-build-isolation --editable ".[$extras]"
tr , '\n' <<<"$extras" >"$EXTRAS"
echo "$wanted" >"$STAMP"
