"""Short polynomials that are as good as long ones on their range."""

import math

import mpmath as mp
import numpy as np
import pytest

from oracles.economised_series import chebyshev, economised
from rocking.kernels.numerics import elementary, simd

TIME, ANGLE = (0.5 * math.log(2.0)) ** 2, (0.25 * math.pi) ** 2


def test_chebyshev_polynomials_are_cosines_of_multiples():
    for n, coefficients in enumerate(chebyshev(9)):
        for angle in np.linspace(0.0, math.pi, 23):
            x = 0.5 * (1.0 + math.cos(angle))
            assert np.polyval(coefficients[::-1], x) == pytest.approx(math.cos(n * angle), abs=1e-9)


def test_one_power_less_costs_what_the_chebyshev_polynomial_is_high():
    """The error for x⁵ on [0, w] is w⁵/2⁹, as often above as below; no polynomial of degree 4 is nearer."""
    w = 0.7
    short = economised([0, 0, 0, 0, 0, 1], w, 5)
    turns = 0.5 * w * (1.0 + np.cos(np.arange(6) * math.pi / 5))
    assert len(short) == 5
    off = turns**5 - np.polyval(short[::-1], turns)
    assert off == pytest.approx((-1.0) ** np.arange(6) * w**5 / 2**9, rel=1e-9)


def test_the_coefficients_are_those_of_taylors_series_economised():
    odd, even = elementary.ODD, elementary.EVEN
    assert economised(odd, TIME, 5) == elementary.SINH_SERIES
    assert economised(even, TIME, 5) == elementary.COSH_SERIES
    assert economised([c * (-1) ** k for k, c in enumerate(odd)], ANGLE, 6) == simd.SIN_SERIES
    assert economised([c * (-1) ** k for k, c in enumerate(even)], ANGLE, 6) == simd.COS_SERIES
    assert economised([2.0 / k for k in range(1, 16, 2)], 1.0 / 9.0, 3) == simd.LOGARITHM


@pytest.mark.parametrize(
    ("ours", "first", "sign", "widest", "exact"),
    [
        (elementary.SINH_SERIES, 3, 1, TIME, lambda r: (mp.sinh(r) - r) / r**3),
        (elementary.COSH_SERIES, 4, 1, TIME, lambda r: (mp.cosh(r) - 1 - r**2 / 2) / r**4),
        (simd.SIN_SERIES, 3, -1, ANGLE, lambda r: (mp.sin(r) - r) / -(r**3)),
        (simd.COS_SERIES, 4, -1, ANGLE, lambda r: (mp.cos(r) - 1 + r**2 / 2) / r**4),
    ],
    ids=["sinh", "cosh", "sin", "cos"],
)
def test_the_series_of_the_lanes_are_good_to_rounding(ours, first, sign, widest, exact):
    """To 1.5 units of the last digit, where as many terms of Taylor's leave more than ten times that."""
    with mp.workdps(60):
        taylor = [mp.mpf(sign) ** n / mp.factorial(first + 2 * n) for n in range(len(ours))]
        squares = [mp.mpf(q) for q in np.linspace(1e-4, 1.0, 200) * widest]

        def worst(coefficients):
            sums = (sum(c * q**k for k, c in enumerate(coefficients)) for q in squares)
            return max(abs(found / exact(mp.sqrt(q)) - 1) for found, q in zip(sums, squares, strict=True))

        assert worst([mp.mpf(c) for c in ours]) < 1.5 * 2.0**-52
        assert worst(taylor) > 15 * 2.0**-52
