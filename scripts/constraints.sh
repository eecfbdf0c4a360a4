#!/usr/bin/env bash
# constraints.sh PYTHON...: write constraints/python-X.Y.txt for each, with the newest versions that install and import together.
set -euo pipefail
cd "$(dirname "$0")/.."

export PIP_DISABLE_PIP_VERSION_CHECK=1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

for python in "${@:?name the interpreters, for example python3.11 python3.12}"; do
    version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    target=constraints/python-$version.txt
    inside=$scratch/$version/bin/python
    "$python" -m venv "$scratch/$version"
    "$inside" -m pip install --quiet --upgrade pip setuptools
    "$inside" -m pip install --quiet --editable '.[distributed,docs,excel,explorer,film,kernels,lint,netcdf,obspy,proof,report,store,test]'
    "$inside" - <<'PYTHON'
from importlib import import_module
from importlib.metadata import packages_distributions

for module, packages in sorted(packages_distributions().items()):
    if module.isidentifier() and not {"rocking", "pip", "setuptools"}.intersection(packages):
        import_module(module)
PYTHON
    {
        echo "# Versions that install and import together on Python $version; written by \`make constraints\`."
        "$inside" -m pip freeze --all --exclude rocking
    } >"$target.partial"
    mv "$target.partial" "$target"
    echo "$target"
done
