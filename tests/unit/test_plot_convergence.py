"""Convergence figure of an exponent: running estimates, their errors and the final value."""

import numpy as np
import pytest
from attrs import evolve

import rocking as rk
from drawn import artist

BRACED = rk.System(rk.Harmonic(15.0, period=2.0), 0.925, rk.Braces(1.0, 1.0))


@pytest.fixture(scope="module")
def spectrum():
    return rk.lyapunov(BRACED, cycles=3_000)


@pytest.mark.parametrize("exponent", [1, 2])
def test_line_is_the_history_on_a_logarithmic_axis(spectrum, exponent):
    ax = rk.plot.convergence(spectrum, exponent=exponent)
    line = artist(ax, "running")
    np.testing.assert_array_equal(line.get_xdata(), spectrum.history["cycles"])
    np.testing.assert_array_equal(line.get_ydata(), spectrum.history["values"][:, exponent - 1])
    assert artist(ax, "final").get_ydata()[0] == spectrum.values[exponent - 1]
    assert ax.get_xscale() == "log"
    assert ax.get_ylabel() == rf"exponent $\lambda_{exponent}$ per $\tau$"


def test_band_is_the_error_where_there_is_one(spectrum):
    (path,) = artist(rk.plot.convergence(spectrum), "error").get_paths()
    known = spectrum.history[np.isfinite(spectrum.history["errors"][:, 0])]
    corners = path.vertices[np.isfinite(path.vertices).all(axis=1)]
    assert corners[:, 0].min() == known["cycles"][0] > 300
    last = corners[corners[:, 0] == 3_000][:, 1]
    value, error = spectrum.values[0], spectrum.errors[0]
    assert (last.min(), last.max()) == pytest.approx((value - error, value + error), rel=1e-12, abs=0)


def test_title_gives_the_value_to_the_second_digit_of_its_error(spectrum):
    value, error = spectrum.values[0], spectrum.errors[0]
    assert 0.01 < error < 0.1
    assert rk.plot.convergence(spectrum).get_title(loc="right") == rf"$\lambda_1$ = {value:.3f} ± {error:.3f}"


def test_title_has_the_minus_sign_of_the_axis():
    periodic = rk.lyapunov(rk.System(rk.Harmonic(2.0, period=1.0), 0.925), cycles=500)
    title = rk.plot.convergence(periodic).get_title(loc="right")
    assert title.startswith(r"$\lambda_1$ = −0.15")
    assert "-" not in title


def test_band_and_title_of_a_block_are_per_second(spectrum):
    block = rk.Block(2.0, 0.5)
    normal, physical = (rk.plot.convergence(spectrum, block=each) for each in (None, block))
    rate = block.frequency_parameter
    (path,), (scaled,) = (artist(ax, "error").get_paths() for ax in (normal, physical))
    np.testing.assert_allclose(scaled.vertices[:, 1], rate * path.vertices[:, 1], rtol=1e-14)
    value, error = rate * spectrum.values[0], rate * spectrum.errors[0]
    assert physical.get_title(loc="right") == rf"$\lambda_1$ = {value:.3f} ± {error:.3f}"


def test_zero_is_drawn_where_it_comes_into_view(spectrum):
    far = {child.get_gid() for child in rk.plot.convergence(spectrum).get_children()}
    assert "zero" not in far
    quasi_periodic = rk.lyapunov(rk.System(rk.Harmonic(4.0, period=0.4), 1.0), cycles=3_000)
    artist(rk.plot.convergence(quasi_periodic), "zero")


def test_estimate_without_an_error_is_drawn_and_says_so():
    ax = rk.plot.convergence(evolve(rk.lyapunov(BRACED, cycles=32), errors=np.full(2, np.inf)))
    assert "error unknown" in ax.get_title(loc="right")
    ax.figure.canvas.draw()


@pytest.mark.parametrize("exponent", [1, 2])
def test_exponent_of_minus_infinity_has_its_value_and_its_cause_but_no_line(exponent):
    resting = rk.lyapunov(rk.System(rk.Harmonic(1.05, period=3.0), 0.5), cycles=100)
    ax = rk.plot.convergence(resting, exponent=exponent)
    assert not ax.lines
    assert ax.get_title(loc="right") == rf"$\lambda_{exponent}$ = −∞"
    assert "perturbations vanish" in artist(ax, "cause").get_text()
    assert (ax.get_xlim(), ax.get_xscale()) == ((1.0, 100.0), "log")
    ax.figure.canvas.draw()
