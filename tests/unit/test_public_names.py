"""Public names: all are exported, and each is imported only when it is used."""

import inspect
import json
import pickle
import subprocess
import sys
from importlib import import_module
from importlib.metadata import version

import pytest

import rocking
from rocking.model.validation import REMEDIES

HEAVY = {
    "attrs",
    "click",
    "distributed",
    "h5netcdf",
    "matplotlib",
    "numba",
    "numpy",
    "pandas",
    "scipy",
    "xarray",
    "zarr",
}


def loaded_after(code):
    """Packages and rooms that a fresh interpreter has loaded after `code`."""
    code += "\nimport json, sys; print(json.dumps(sorted(sys.modules)), file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(json.loads(done.stderr.splitlines()[-1]))


@pytest.mark.parametrize("package", ["rocking", "rocking.plot"])
def test_importing_a_package_of_public_names_loads_the_table_of_names_alone(package):
    loaded = loaded_after(f"import {package}")
    assert not HEAVY & loaded
    names = {name for name in loaded if name.startswith("rocking")}
    assert names == {"rocking", "rocking.model", "rocking.model.public_names", package}


def test_a_value_loads_no_kernel_and_no_picture():
    loaded = loaded_after("import rocking; rocking.State()")
    assert not {"h5netcdf", "matplotlib", "numba", "pandas", "scipy", "xarray", "click"} & loaded


@pytest.mark.parametrize("name", ["simulate", "find_orbits", "continue_orbit", "orbit_diagram", "theory"])
def test_scipy_is_loaded_where_it_is_used(name):
    """Its optimisation takes as long to load as all else."""
    assert not {"scipy", "matplotlib", "xarray"} & loaded_after(f"import rocking; rocking.{name}")


@pytest.mark.parametrize(
    "arguments",
    [["--help"], *([name, "--help"] for name in ("simulate", "classify", "modes", "orbit-diagram", "map"))],
)
def test_help_loads_only_what_shows_it(arguments):
    code = f"""
import sys
from rocking.cli.main import main
sys.argv = ["rocking", *{arguments}]
try:
    main()
except SystemExit as exit:
    assert exit.code == 0
"""
    assert HEAVY & loaded_after(code) == {"click"}


@pytest.mark.parametrize("name", rocking.__all__)
def test_every_public_name_is_there(name):
    assert getattr(rocking, name) is getattr(rocking, name)
    assert name in dir(rocking)


@pytest.mark.parametrize("name", rocking.theory.__all__)
def test_every_name_of_the_theory_is_there_and_says_what_it_is(name):
    assert getattr(rocking.theory, name).__doc__


def test_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="^module 'rocking' has no attribute 'simulatee'$"):
        rocking.simulatee  # noqa: B018


MOVED = [(name, module) for module, names in rocking._MOVED.items() for name in names.split()]


@pytest.mark.parametrize(("name", "module"), MOVED, ids=[name for name, _ in MOVED])
def test_name_of_an_earlier_version_is_refused_with_its_place(name, module):
    message = f"^rocking.{name} is {module}.{name} since version 0.2$"
    with pytest.raises(AttributeError, match=message):
        getattr(rocking, name)
    assert hasattr(import_module(module), name)


def test_version_is_that_of_the_installed_package():
    assert rocking.__version__ == version("rocking")


def test_citations_are_bibtex_with_balanced_braces():
    text = rocking.cite()
    assert text.count("{") == text.count("}")
    # a bibliography style prints a note, and does not print an annote
    assert " note = " not in text
    assert text.count(" annote = ") == text.count("\n@")
    assert text.count("\n@article{") == 17
    assert "@misc" not in text  # each source has a title, and the place where it stands
    assert f"version = {{{rocking.__version__}}}" in text
    for source in (
        "yim-lin-1991",
        "spanos-koh-1984",
        "housner-1963",
        "hogan-1989",
        "benettin-1980",
        "grassberger-procaccia-1983",
        "theiler-1986",
        "das-2017",
        "mcdonald-1985",
        "wilson-1927",
        "shi-1996",
        "makris-roussos-2000",
        "zhang-makris-2001",
        "makris-konstantinidis-2003",
    ):
        assert f"{{{source}," in text


SYSTEM = rocking.System(rocking.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
LISTED = "simulate() has no argument 't_end' (it has: system, start, cycles, record, duration)"
UNKNOWN = {
    "far": (lambda: rocking.simulate(SYSTEM, t_end=3), LISTED),
    "near": (lambda: rocking.Block(2.0, 0.5, restituion=1), "Block() has no argument 'restituion' (did you mean 'restitution'?)"),
    "begun": (lambda: rocking.Block(h=2.0), "Block() has no argument 'h' (did you mean 'height'?)"),
    "method": (lambda: rocking.Block(2.0, 0.5).system(accel=3), "system() has no argument 'accel' (did you mean 'acceleration'?)"),
    "theory": (lambda: rocking.theory.energy(angel=1), "energy() has no argument 'angel' (did you mean 'angle'?)"),
    "plot": (lambda: rocking.plot.modes(1.0, 0.9, amp=2.0), "modes() has no argument 'amp' (did you mean 'amplitude'?)"),
    "none": (lambda: rocking.cite(style=1), "cite() has no argument 'style' (it has none)"),
    "renamed": (
        lambda: rocking.rocking_spectrum([], scale=1, model="slender"),
        "rocking_spectrum() has no argument 'scale' (since version 0.2 it is levels)",
    ),
    "replaced": (
        lambda: rocking.overturning_spectrum(kind="one-sine", amplitude=[1, 2], frequency=[1, 2]),
        "overturning_spectrum() has no argument 'kind' (since version 0.2 it is system, with an rk.Pulse of that kind)",
    ),
    "a name": (
        lambda: rocking.orbit_diagram(SYSTEM, "amplitude", [1, 2]),
        "orbit_diagram() takes these arguments without a name: system, start (give the others by name, such as amplitude=…)",
    ),
    "values": (
        lambda: rocking.response_diagram(SYSTEM, "amplitude", values=[1, 2]),
        "response_diagram() has no argument 'values' (since version 0.2 it is the quantity by its name, such as amplitude=values)",
    ),
    "no system": (lambda: rocking.parametric_map(amplitude=[1, 2]), f"parametric_map() needs system ({REMEDIES['System']})"),
    "no system and another name": (
        lambda: rocking.safe_basin(amplitude=[1, 2], period=1.0),
        f"safe_basin() needs system ({REMEDIES['System']})",
    ),
    "a similar name": (lambda: rocking.simulate(sytem=SYSTEM), "simulate() has no argument 'sytem' (did you mean 'system'?)"),
    "any name": (
        lambda: rocking.bifurcation_set(period=(1, 2), amplitude=(1, 2)),
        f"bifurcation_set() needs system ({REMEDIES['System']})",
    ),
}  # fmt: skip


@pytest.mark.parametrize("call, told", UNKNOWN.values(), ids=UNKNOWN)
def test_call_that_does_not_fit_is_answered_by_what_it_needs(call, told):
    with pytest.raises(TypeError) as caught:  # noqa: PT011
        call()
    assert str(caught.value) == told


def test_error_within_a_call_is_not_taken_for_one_of_its_keywords():
    with pytest.raises(TypeError, match="^amplitude must be a real number"):
        rocking.Harmonic("2", period=1.0)
    with pytest.raises(TypeError, match="missing 1 required positional argument: 'max_period'"):
        rocking.bifurcation_set(SYSTEM, period=(1, 2), amplitude=(1, 2))


@pytest.mark.parametrize("space", [rocking, rocking.theory, rocking.plot], ids=lambda space: space.__name__)
def test_public_names_are_pickled_by_name_and_keep_signature_and_docstring(space):
    for name in space.__all__:
        value = getattr(space, name)
        if inspect.isfunction(value):
            assert pickle.loads(pickle.dumps(value)) is value
            inner = inspect.unwrap(value)
            assert inspect.signature(value) == inspect.signature(inner)
            assert value.__doc__ == inner.__doc__
