"""Build backend: setuptools, and the compiled kernels in the wheel or, for an editable install, in the checkout.

`--config-settings classes=x86-64-v3,x86-64-v4` names the classes of processors. Default: that of this machine.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

from setuptools import build_meta
from setuptools.build_meta import build_sdist, get_requires_for_build_sdist

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]

ROOT = Path(__file__).parents[2]
SOURCES = str(ROOT / "src")
BUILT = ROOT / "build" / "lib"
prepare_metadata_for_build_wheel = build_meta.prepare_metadata_for_build_wheel
prepare_metadata_for_build_editable = build_meta.prepare_metadata_for_build_editable


def compiler():
    """Return the packages that compile, in exact versions; the linker of ziglang only where there is no C compiler.

    The last digits of results depend on the versions, and the constraints of pip do not reach an isolated build.
    """
    if sys.version_info < (3, 11):  # noqa: UP036 (pip asks before it has read the metadata)
        sys.exit("the package needs Python 3.11 or newer")
    sys.path.insert(0, SOURCES)
    from rocking.kernels.library.processor import COMPILER, reason_against

    if reason := reason_against():
        sys.exit(reason)
    pinned = [f"{name}=={version}" for name, version in COMPILER.items()]
    linker = any(map(shutil.which, ("cc", "gcc", "clang")))
    return [*pinned, "numpy>=2.0", *([] if linker else ["ziglang"])]


def get_requires_for_build_wheel(config_settings=None):
    """Return the packages that build a wheel."""
    return [*build_meta.get_requires_for_build_wheel(without_classes(config_settings)), *compiler()]


def get_requires_for_build_editable(config_settings=None):
    """Return the packages that prepare an editable install."""
    return [*build_meta.get_requires_for_build_editable(without_classes(config_settings)), *compiler()]


def without_classes(config_settings):
    """Return the settings for setuptools."""
    return {key: value for key, value in (config_settings or {}).items() if key != "classes"}


def compile_kernels(config_settings, *options):
    """Compile the kernels from the sources beside this file, for the classes that the settings name."""
    given = (config_settings or {}).get("classes", [])
    classes = ",".join([given] if isinstance(given, str) else given).split(",")
    path = os.pathsep.join(filter(None, (SOURCES, os.environ.get("PYTHONPATH"))))
    command = [sys.executable, "-m", "rocking.kernels", *options, *filter(None, classes)]
    if code := subprocess.run(
        command, cwd=ROOT, env=os.environ | {"PYTHONPATH": path}, check=False
    ).returncode:
        sys.exit(code)  # the message was printed


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Build a wheel for this platform, with the compiled kernels."""
    shutil.rmtree(BUILT, ignore_errors=True)  # setuptools packs whatever lies there
    compile_kernels(config_settings, "--into", str(BUILT / "rocking/kernels/compiled"))
    settings = without_classes(config_settings)
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    given = settings.get("--build-option", [])
    settings["--build-option"] = [*([given] if isinstance(given, str) else given), "--plat-name", platform]
    return build_meta.build_wheel(wheel_directory, settings, metadata_directory)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """Prepare an editable install: the compiled kernels lie in the checkout."""
    compile_kernels(config_settings)
    return build_meta.build_editable(wheel_directory, without_classes(config_settings), metadata_directory)
