"""Compiled code: what the library gives and takes, edits that are noticed, and resumed marches without a trace."""

import itertools
import math
import re
import shutil

import mpmath
import numpy as np
import pytest
from elftools.elf.elffile import ELFFile

from rocking.kernels import event_kinds
from rocking.kernels.library import load
from rocking.kernels.library.emit import C_LIBRARY
from rocking.kernels.library.export import ENTRY_POINTS
from rocking.kernels.library.kernel import import_all
from rocking.kernels.library.load import SOURCES, TEXTS, path_of
from rocking.kernels.library.processor import processor_class
from rocking.kernels.motion import march as kernel
from rocking.kernels.motion.march import Recording
from rocking.kernels.motion.observers import EVENT_ROW
from rocking.kernels.numerics import elementary
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.system import harmonic_parameters

import_all()


def march(p, cycles, angle=0.0, velocity=0.0):
    progress, _ = kernel.begin_march(p, angle, velocity)
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
    assert {name for name in called if not re.search("lanes6scalar", name)} == set()


def test_an_edit_of_any_source_is_noticed(tmp_path, monkeypatch):
    """This holds for a new file in a subpackage too."""
    package = tmp_path / "kernels"
    shutil.copytree(load.KERNELS, package, ignore=shutil.ignore_patterns("__pycache__", "*.so"))
    found = [load.hash_sources()]
    monkeypatch.setattr(load, "KERNELS", package)
    assert load.hash_sources.__wrapped__() == found[0]
    for path in ("block/impact.py", "library/lower.py", "inner/new.py"):
        source = package / path
        source.parent.mkdir(exist_ok=True)
        source.write_text((source.read_text() if source.exists() else "") + "\nx = 1\n")
        found.append(load.hash_sources.__wrapped__())
    assert len(set(found)) == 4


def test_marching_in_pieces_is_marching_in_one_go():
    # a regular motion: what an arc renewed at the end of a piece changes is rounding
    p = harmonic_parameters(6.5, 5.0 * math.pi, 0.4, 0.0, 0.925)
    whole = march(p, 300)[1]
    pieces, _ = kernel.begin_march(p, 0.0, 0.0)
    for until in range(7, 300, 7):
        pieces = kernel.march(p, pieces, until, Recording())[1]
    pieces = kernel.march(p, pieces, 300, Recording())[1]
    assert (pieces.cycle, pieces.impacts) == (whole.cycle, whole.impacts)
    assert abs(pieces.arc.angle - whole.arc.angle) < 1e-14
    assert abs(pieces.arc.velocity - whole.arc.velocity) < 1e-14


def test_a_full_buffer_of_events_loses_none():
    p = harmonic_parameters(15.0, math.pi, 2.0, 0.0, 0.925, 1.0, 1.0)

    def times(room):
        progress, _ = kernel.begin_march(p, 0.0, 0.0)
        found, status = [], kernel.PAUSED
        while status == kernel.PAUSED:
            rows = np.empty(room, EVENT_ROW)
            status, progress, _, written = kernel.march(p, progress, 40, Recording(events=rows))
            found.append(rows[:written])
        return np.concatenate(found)

    np.testing.assert_array_equal(times(3), times(10_000))


def test_ten_million_cycles_lose_no_phase():
    # The stable (1,1) orbit is the same after 10**7 cycles as after 10**4, impact by impact.
    p = harmonic_parameters(2.0, 2.0 * math.pi, 1.0, 0.0, 0.925)
    early, late = march(p, 10_000)[1], march(p, 10_000_000)[1]
    assert late.impacts - early.impacts == 2 * (10_000_000 - 10_000)
    assert abs(late.arc.angle - early.arc.angle) < 1e-14
    assert abs(late.arc.velocity - early.arc.velocity) < 1e-14


@pytest.mark.parametrize("name", ["hyperbolic", "circular"])
def test_functions_of_an_arc_keep_their_relative_accuracy_from_the_shortest_arc_on(name):
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


def _of_any_size(random, least, greatest):
    return 10.0 ** random.uniform(least, greatest, 1000) * random.choice([-1.0, 1.0], 1000)


def _near(random, low, high):
    return random.uniform(low, high, 1000)


@pytest.mark.parametrize(
    ("function", "exact", "inputs", "units"),
    [
        (elementary.exponential, mpmath.exp, [(_near, -745.0, 709.7), (_near, -1.0, 1.0), (_of_any_size, -18.0, 0.0)], 2.0),
        (elementary.logarithm, mpmath.log, [(_near, 0.5, 2.0), (_near, 0.0, 1e-307), (_near, 1.0, 1e300)], 1.0),
        (elementary.logarithm_2, lambda x: mpmath.log(x, 2), [(_near, 0.5, 2.0), (_near, 1.0, 1e9)], 2.0),
        (elementary.logarithm_10, mpmath.log10, [(_near, 0.5, 2.0), (_near, 0.0, 1e-3)], 2.0),
        (elementary.sine_of, mpmath.sin, [(_near, -10.0, 10.0), (_of_any_size, -9.0, 6.0)], 1.5),
        (elementary.cosine_of, mpmath.cos, [(_near, -10.0, 10.0), (_of_any_size, -9.0, 6.0)], 1.5),
        (elementary.tangent_of, mpmath.tan, [(_near, -1.57, 1.57), (_of_any_size, -9.0, 0.0)], 2.0),
        (elementary.arctangent, mpmath.atan, [(_near, -4.0, 4.0), (_of_any_size, -9.0, 9.0)], 2.0),
        (elementary.arccosine, mpmath.acos, [(_near, -1.0, 1.0), (_near, 1.0 - 1e-9, 1.0)], 3.0),
        (elementary.artanh, mpmath.atanh, [(_near, -0.9999, 0.9999), (_of_any_size, -9.0, -1.0)], 4.0),
        (elementary.hyperbolic_tangent, mpmath.tanh, [(_near, -25.0, 25.0), (_of_any_size, -9.0, 1.0)], 3.0),
    ],
    ids=lambda value: getattr(getattr(value, "py_func", None), "__name__", None),
)  # fmt: skip
def test_elementary_functions_are_accurate_to_the_last_digits(function, exact, inputs, units):
    random = np.random.default_rng(11)
    with mpmath.workdps(40):
        for draw, low, high in inputs:
            for x in draw(random, low, high).tolist():
                true = exact(mpmath.mpf(x))
                assert abs(function(x) - true) <= units * math.ulp(float(true)), x


def test_functions_of_a_point_are_accurate_whatever_its_size():
    random = np.random.default_rng(12)
    with mpmath.workdps(40):
        for least, greatest in ((-1.0, 1.0), (-300.0, 300.0)):
            points = zip(*(_of_any_size(random, least, greatest).tolist() for _ in range(2)), strict=True)
            for y, x in points:
                length, angle = mpmath.hypot(x, y), mpmath.atan2(y, x)
                assert abs(elementary.hypotenuse(x, y) - length) <= 2.0 * math.ulp(float(length)), (x, y)
                assert abs(elementary.angle_of(y, x) - angle) <= 3.0 * math.ulp(float(angle)), (x, y)


def test_sine_and_cosine_of_a_large_angle_are_accurate_to_the_rounding_error_of_one():
    random = np.random.default_rng(13)
    with mpmath.workdps(60):
        for x in _of_any_size(random, 6.0, 15.0).tolist():
            assert abs(elementary.sine_of(x) - mpmath.sin(x)) <= 4e-16, x
            assert abs(elementary.cosine_of(x) - mpmath.cos(x)) <= 4e-16, x


def test_elementary_functions_have_the_values_of_the_c_library_at_the_ends_of_their_ranges():
    ends = [0.0, -0.0, 1.0, -1.0, math.inf, -math.inf, math.nan]
    with np.errstate(all="ignore"):
        for name, function, others in (
            ("exp", elementary.exponential, [800.0, -800.0]),
            ("log", elementary.logarithm, [5e-324]),
            ("arctan", elementary.arctangent, []),
            ("arccos", elementary.arccosine, [1.5, -1.5]),
            ("arctanh", elementary.artanh, [1.5]),
            ("tanh", elementary.hyperbolic_tangent, []),
        ):
            inputs = np.array(ends + others)
            np.testing.assert_allclose(
                [function(x) for x in inputs.tolist()], getattr(np, name)(inputs), rtol=1e-15
            )
        for y, x in itertools.product(ends[:4], repeat=2):
            assert elementary.angle_of(y, x) == math.atan2(y, x)
            assert math.copysign(1.0, elementary.angle_of(y, x)) == math.copysign(1.0, math.atan2(y, x))


def test_rough_logarithms_and_powers_of_two_are_as_accurate_as_they_say():
    random = np.random.default_rng(3)
    exponents = np.concatenate([random.uniform(-1000.0, 1000.0, 3000), np.arange(-40.0, 40.0, 0.5)])
    for y in exponents:
        assert abs(elementary.rough_log2(2.0**y) - y) <= 0.0431, y
        assert abs(elementary.rough_exp2(y) / 2.0**y - 1.0) <= 0.002, y


def test_modes_and_events_are_told_by_name():
    assert [mode.name for mode in event_kinds.MotionMode] == ["FLIGHT", "REST", "LEAN"]
    assert event_kinds.Event(event_kinds.LIFT_OFF).name == "LIFT_OFF"


def test_a_field_that_a_tuple_does_not_have_cannot_be_replaced():
    with pytest.raises(ValueError, match="Recording has no field peek"):
        replacing(Recording, "peak", "peek")
