"""Without an extra: one line that says what to install, before any computation. All else works in the plain installation."""

import subprocess
import sys

import pytest

import rocking as rk
from rocking.assessment.tables import write_xlsx
from rocking.kernels.library.export import EntryPoint
from rocking.model.package import EXTRAS
from rocking.papers.catalogue import YIM_LIN_1991
from rocking.papers.report.reproduce import reproduce
from rocking.records.text_file import TEXTS
from rocking.survey.export import to_netcdf

SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
MOTION = rk.simulate(SYSTEM, cycles=3)
BLOCK = "--height 2 --width 0.5"
RUN = "--amplitude 2 --period 1 --restitution 0.925"
MAP = "map --amplitude 1:2:2 --period 1:2:2 --restitution 0.925"
SYSTEM = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
GRID = {"system": SYSTEM, "amplitude": [1.0, 2.0], "period": [1.0, 2.0]}
STORES = "stores need Zarr and numcodecs"
NETCDF = "netCDF files need h5netcdf and h5py"
FILM = "MP4 files need imageio-ffmpeg"
EXPLORER = "the explorer needs Bokeh, h5netcdf, h5py and Jinja"
REPORT = "the report needs Jinja and WeasyPrint"
EXCEL = "XLSX files need openpyxl"
PROOF = "proofs need python-flint"


@pytest.mark.parametrize(
    "extra, module, act, message",
    [
        ("store", "zarr", f"{MAP} --store map.zarr", STORES),
        ("store", "zarr", lambda: rk.parametric_map(**GRID, store="map.zarr"), STORES),
        ("store", "numcodecs", lambda: rk.parametric_map(**GRID, store="map.zarr"), STORES),
        ("store", "zarr", lambda: rk.plot.parametric_map("made"), STORES),
        ("netcdf", "h5netcdf", f"{MAP} --netcdf map.nc", NETCDF),
        ("netcdf", "h5netcdf", lambda: to_netcdf(None, "map.nc"), NETCDF),
        ("netcdf", "h5py", f"record example {BLOCK} --netcdf record.nc", NETCDF),
        ("film", "imageio_ffmpeg", f"record example {BLOCK} --animate block.mp4", FILM),
        ("film", "imageio_ffmpeg", f"simulate {RUN} --plot block.mp4", FILM),
        ("film", "imageio_ffmpeg", lambda: rk.plot.animation(MOTION, "block.mp4"), FILM),
        ("explorer", "bokeh", "explore --port 0 --no-browser", EXPLORER),
        ("report", "weasyprint", "paper", REPORT),
        ("report", "jinja2", lambda: reproduce(YIM_LIN_1991, "results"), REPORT),
        ("excel", "openpyxl", lambda: write_xlsx("a.xlsx", []), EXCEL),
        ("proof", "flint", f"classify {RUN} --prove", PROOF),
        ("proof", "flint", lambda: rk.horseshoe(SYSTEM), PROOF),
        ("obspy", "obspy", f"record made/a.sac {BLOCK}", f"a.sac: a binary file; {TEXTS}; ObsPy reads more formats"),
    ],
)  # fmt: skip
def test_missing_extra_is_named_before_the_computation(
    rocking, tmp_path, monkeypatch, extra, module, act, message
):
    (tmp_path / "made" / "level-0").mkdir(parents=True)
    (tmp_path / "made" / "a.sac").write_bytes(b"\0\1\2\n")
    monkeypatch.setitem(sys.modules, module, None)
    monkeypatch.delitem(sys.modules, "rocking.explorer", raising=False)
    for name in ("__call__", "load"):
        monkeypatch.setattr(EntryPoint, name, None)
    if isinstance(act, str):
        code, told, out = rocking(act)
        assert (code, out) == (2, "")
    else:
        with pytest.raises(ImportError) as caught:
            act()
        told = str(caught.value)
    assert told == f"{message}: run pip install '.[{extra}]' in a copy of the repository"
    assert [path.name for path in tmp_path.iterdir()] == ["made"]


PLAIN = """
import importlib, pkgutil, sys
blocked = sys.argv[1:]
sys.modules |= dict.fromkeys(blocked)
import rocking as rk
own = "rocking.kernels.", "rocking.explorer", "rocking.proof.", "rocking.survey.zarr_", "rocking.__main__"
for module in pkgutil.walk_packages(rk.__path__, "rocking."):
    if not module.name.startswith(own):
        importlib.import_module(module.name)
system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
found = rk.parametric_map(system, amplitude=[1.0, 2.0], period=[1.0, 2.0])
print(*found.dataset.kind.values.ravel(), rk.plot.tiles(found, "tiles").name)
print(rk.plot.animation(rk.simulate(system, cycles=1), "block.gif", seconds=0.1).name)
"""


def test_plain_installation_loads_every_module_and_computes_a_map_with_its_tiles_and_a_gif(tmp_path):
    blocked = sorted({module for _, modules in EXTRAS.values() for module in modules})
    line = [sys.executable, "-c", PLAIN, *blocked, "numba", "distributed", "tornado", "imageio"]
    done = subprocess.run(line, cwd=tmp_path, check=False, capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("0 0 1 1 index.html\nblock.gif\n", "")
