"""Compiled code: what the library gives and takes, edits that are noticed, and resumed marches without a trace."""

import math
import re
import shutil

import mpmath
import numpy as np
import pytest
from elftools.elf.elffile import ELFFile

from rocking.kernels import event_kinds
from rocking.kernels.deferred import import_all
from rocking.kernels.entry_point import ENTRY_POINTS
from rocking.kernels.forcing.harmonic import parameters
from rocking.kernels.library import load
from rocking.kernels.library.emit import C_LIBRARY
from rocking.kernels.library.load import SOURCES, TEXTS, path_of
from rocking.kernels.library.processor import processor_class
from rocking.kernels.march import initial_state
from rocking.kernels.march import march as kernel
from rocking.kernels.march.event_rows import EVENT_ROW
from rocking.kernels.march.progress import Recording
from rocking.kernels.numerics import elementary, estimates
from rocking.kernels.numerics.replace_fields import replacing

import_all()


def march(p, cycles, angle=0.0, velocity=0.0):
    progress, _ = initial_state.begin_march(p, angle, velocity)
    status = kernel.PAUSED
    while status == kernel.PAUSED:
        found = kernel.march(p, progress, cycles, Recording())
        status, progress, _, _ = found
    return found


def test_library_exports_the_entry_points_and_calls_the_c_library_alone():
    """It allocates no array, raises nothing and needs neither numba nor Python."""
    with path_of(processor_class()).open("rb") as stream:
        symbols = list(ELFFile(stream).get_section_by_name(".dynsym").iter_symbols())
    taken = {symbol.name for symbol in symbols if symbol["st_shndx"] == "SHN_UNDEF"} - {""}
    given = {symbol.name for symbol in symbols if symbol["st_shndx"] != "SHN_UNDEF"}
    assert taken <= C_LIBRARY
    assert given == {entry.symbol for entry in ENTRY_POINTS.values()} | {SOURCES, TEXTS}


def test_functions_of_vectors_stand_in_the_loop_over_lanes():
    """A call would write its vectors to memory. In one module with the other kernels, this made a map four times as slow."""
    with path_of(processor_class()).open("rb") as stream:
        names = [symbol.name for symbol in ELFFile(stream).get_section_by_name(".symtab").iter_symbols()]
    assert any("classify_batch_lanes" in name for name in names)
    called = {name for name in names if "numerics4simd" in name or "kernels5lanes" in name}
    assert {name for name in called if not re.search("lanes(15scalar_fallback|3log)", name)} == set()


def test_an_edit_of_any_source_is_noticed(tmp_path, monkeypatch):
    """This holds for a new file in a subpackage too."""
    package = tmp_path / "kernels"
    shutil.copytree(load.KERNELS, package, ignore=shutil.ignore_patterns("__pycache__", "*.so"))
    found = [load.hash_sources()]
    monkeypatch.setattr(load, "KERNELS", package)
    assert load.hash_sources.__wrapped__() == found[0]
    for path in ("march/impact_law.py", "library/lower.py", "inner/new.py"):
        source = package / path
        source.parent.mkdir(exist_ok=True)
        source.write_text((source.read_text() if source.exists() else "") + "\nx = 1\n")
        found.append(load.hash_sources.__wrapped__())
    assert len(set(found)) == 4


def test_marching_in_pieces_is_marching_in_one_go():
    # a regular motion: what an arc renewed at the end of a piece changes is rounding
    p = parameters.harmonic_parameters(6.5, 5.0 * math.pi, 0.4, 0.0, 0.925)
    whole = march(p, 300)[1]
    pieces, _ = initial_state.begin_march(p, 0.0, 0.0)
    for until in range(7, 300, 7):
        pieces = kernel.march(p, pieces, until, Recording())[1]
    pieces = kernel.march(p, pieces, 300, Recording())[1]
    assert (pieces.cycle, pieces.impacts) == (whole.cycle, whole.impacts)
    assert abs(pieces.arc.angle - whole.arc.angle) < 1e-14
    assert abs(pieces.arc.velocity - whole.arc.velocity) < 1e-14


def test_a_full_buffer_of_events_loses_none():
    p = parameters.harmonic_parameters(15.0, math.pi, 2.0, 0.0, 0.925, 1.0, 1.0)

    def times(room):
        progress, _ = initial_state.begin_march(p, 0.0, 0.0)
        found, status = [], kernel.PAUSED
        while status == kernel.PAUSED:
            rows = np.empty(room, EVENT_ROW)
            status, progress, _, written = kernel.march(p, progress, 40, Recording(events=rows))
            found.append(rows[:written])
        return np.concatenate(found)

    np.testing.assert_array_equal(times(3), times(10_000))


def test_ten_million_cycles_lose_no_phase():
    # The stable (1,1) orbit is the same after 10**7 cycles as after 10**4, impact by impact.
    p = parameters.harmonic_parameters(2.0, 2.0 * math.pi, 1.0, 0.0, 0.925)
    early, late = march(p, 10_000)[1], march(p, 10_000_000)[1]
    assert late.impacts - early.impacts == 2 * (10_000_000 - 10_000)
    assert abs(late.arc.angle - early.arc.angle) < 1e-14
    assert abs(late.arc.velocity - early.arc.velocity) < 1e-14


@pytest.mark.parametrize("name", ["hyperbolic", "circular"])
def test_elementary_functions_keep_their_relative_accuracy_from_the_shortest_arc_on(name):
    random = np.random.default_rng(7)
    worst = np.zeros(4)
    with mpmath.workdps(80):
        for _ in range(4000):
            t, rate = 10.0 ** random.uniform(-12, 1.5), 10.0 ** random.uniform(-1.3, 2.3)
            if name == "hyperbolic":
                found, z = elementary.hyperbolic(t), mpmath.mpf(t)
                exact = (
                    mpmath.sinh(z),
                    mpmath.cosh(z) - 1,
                    mpmath.sinh(z) - z,
                    mpmath.cosh(z) - 1 - z * z / 2,
                )
            else:
                found, z = elementary.circular(rate, t), mpmath.mpf(rate) * mpmath.mpf(t)
                exact = (mpmath.sin(z), 1 - mpmath.cos(z), z - mpmath.sin(z), z * z / 2 - 1 + mpmath.cos(z))
                if rate * t >= elementary.SHORT:  # the last is for short arguments only
                    found, exact = (*found[:3], 1.0), (*exact[:3], 1.0)
            # of 1 - cos x far from 0 what counts is its error against 1
            scales = exact if name == "hyperbolic" or z < 1 else (exact[0], max(exact[1], 1), *exact[2:])
            worst = np.maximum(
                worst, [abs(float((f - e) / s)) for f, e, s in zip(found, exact, scales, strict=True)]
            )
    assert np.all(worst <= 8 * 2.0**-53)


def test_rough_logarithms_and_powers_of_two_are_as_accurate_as_they_say():
    random = np.random.default_rng(3)
    exponents = np.concatenate([random.uniform(-1000.0, 1000.0, 3000), np.arange(-40.0, 40.0, 0.5)])
    for y in exponents:
        assert abs(estimates.rough_log2(2.0**y) - y) <= 0.0431, y
        assert abs(estimates.rough_exp2(y) / 2.0**y - 1.0) <= 0.002, y


def test_modes_and_events_are_told_by_name():
    assert [mode.name for mode in event_kinds.MotionMode] == ["FLIGHT", "REST", "LEAN"]
    assert event_kinds.Event(event_kinds.LIFT_OFF).name == "LIFT_OFF"


def test_a_field_that_a_tuple_does_not_have_cannot_be_replaced():
    with pytest.raises(ValueError, match="Recording has no field peek"):
        replacing(Recording, "peak", "peek")
