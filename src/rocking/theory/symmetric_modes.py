"""Symmetric (1, n) modes in closed form: Spanos & Koh (1984); Yim & Lin (1991), Eqs. (8)–(10).

The modes themselves are computed in ``rocking.kernels.orbits.modes``. This module computes the amplitudes between
which they exist and are stable.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking.kernels import system as numbers
from rocking.kernels.orbits import floquet
from rocking.kernels.orbits import modes as kernel
from rocking.model.orbit import Mode
from rocking.model.quantity import AMPLITUDE, PERIOD, RESTITUTION
from rocking.model.validation import Refusal, whole
from rocking.theory.arguments import MAX_CYCLES, frequencies, odd, plain, restitutions, together


def existence_amplitude(period: Any, restitution: Any, n: Any) -> Any:
    """Amplitude A_E, above which symmetric (1, n) modes exist: the fold at which two of them emerge.

    Parameters
    ----------
    period : float or array
        Forcing period T, in [0.00628, 6283].
    restitution : float or array
        Coefficient of restitution e, in [0, 1].
    n : int or array
        Number of forcing cycles per response period: odd, 1 to 9,999. The arguments broadcast.

    Returns
    -------
    float or ndarray
        A_E; 0 at e = 1, where modes exist at every A > 0; NaN at e = 0, where there are none.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If an argument lies outside its range.

    See Also
    --------
    symmetric_modes : The modes themselves.
    symmetry_breaking_amplitude : Stability limit of the faster mode.
    slower_mode_amplitude : Limit of the slower mode.

    Notes
    -----
    A_E = (1+Ω²) t² (1−e)/√((1+e)² + Ω²t²(1−e)²), t = tanh(nπ/2Ω), from Eq. (8) of Yim & Lin (1991). A mode that exists need not be
    stable (`symmetry_breaking_amplitude`) or admissible (`symmetric_modes`).

    Examples
    --------
    >>> round(existence_amplitude(1.0, 0.8, 1), 6)
    0.26593
    >>> existence_amplitude([1.0, 2.0], [[0.8], [0.9]], 3).shape
    (2, 2)
    """
    omega, e, half = together(
        period=frequencies(period), restitution=restitutions(restitution), n=0.5 * odd(n)
    )
    t = np.tanh(half * math.pi / omega)
    swept = t * np.where(e > 0.0, 1.0 - e, np.nan)
    return plain((1.0 + omega * omega) * t * swept / np.hypot(1.0 + e, omega * swept))


def symmetry_breaking_amplitude(period: Any, restitution: Any, n: Any) -> Any:
    """Amplitude A_SB, up to which the faster symmetric (1, n) mode is stable: two asymmetric orbits branch off there.

    This is the "upper bound" of figures 11 and 12 of Yim & Lin (1991), where the trace of Eq. (10) is −(1 + e²).

    Parameters
    ----------
    period, restitution, n : float or array
        T, e and n as in `existence_amplitude`.

    Returns
    -------
    float or ndarray
        A_SB; NaN at e = 0. It may exceed the amplitude at which the mode ceases to be admissible.

    Raises
    ------
    TypeError, ValueError
        As in `existence_amplitude`.

    See Also
    --------
    symmetric_modes : The modes themselves.
    existence_amplitude : Lowest amplitude with symmetric modes.
    rocking.plot.thresholds : Plot amplitudes over the period.

    Notes
    -----
    ``V_SB = e(1+e)S/(2eC − (1+e²) + St(1−e)²(1+Ω²)/2)`` with S, C = sinh, cosh of nπ/Ω. A_SB follows from V_SB by Eq. (8).
    At e = 1 it is (1+Ω²)(1/t − t)/Ω.

    Examples
    --------
    >>> round(symmetry_breaking_amplitude(1.0, 0.8, 1), 9)
    19.070505363
    """
    omega, e, h = together(
        period=frequencies(period), restitution=restitutions(restitution), n=math.pi * odd(n)
    )
    h = h / omega
    e = np.where(e > 0.0, e, np.nan)
    square, lost = 1.0 + omega * omega, (1.0 - e) ** 2
    t, cosech = np.tanh(0.5 * h), -2.0 * np.exp(-h) / np.expm1(-2.0 * h)
    kept, swept = (1.0 + e) ** 2, omega * omega * t * t * lost
    # in units of 1/4e²: a = (kept + swept), t²k₋ = 2e t²(1 − e)
    fastest = e * (1.0 + e) / (t * (2.0 * e + 0.5 * lost * square) - lost * cosech)
    fold = 2.0 * e * t * (1.0 + e) / (kept + swept)
    beyond = fastest * fold * 2.0 * (1.0 + e * e) * cosech / (e * (1.0 + e))
    scale = np.sqrt(kept + swept)
    return plain(square * np.hypot(t * t * (1.0 - e) / scale, scale * beyond / (2.0 * e * omega)))


def slower_mode_amplitude(period: Any, n: Any) -> Any:
    """Amplitude t(1+Ω²)/Ω at which the slower symmetric (1, n) mode ends with zero speed: two modes below, one above.

    Parameters
    ----------
    period, n : float or array
        T and n as in `existence_amplitude`. The amplitude does not depend on e.

    Returns
    -------
    float or ndarray
        Amplitude A, with t = tanh(nπ/2Ω).

    Raises
    ------
    TypeError, ValueError
        As in `existence_amplitude`.

    See Also
    --------
    symmetric_modes : The modes themselves.
    existence_amplitude : Lowest amplitude with symmetric modes.

    Examples
    --------
    >>> round(slower_mode_amplitude(1.0, 1), 6)
    1.577849
    """
    omega, half = together(period=frequencies(period), n=0.5 * odd(n))
    return plain(np.tanh(half * math.pi / omega) * (1.0 + omega * omega) / omega)


def symmetric_modes(amplitude: float, period: float, restitution: float, n: int) -> list[Mode]:
    """Return all symmetric (1, n) modes of a system, the faster first: Yim & Lin (1991), Eqs. (8)–(10).

    Parameters
    ----------
    amplitude, period : float
        Amplitude A, in [0, 1000], and forcing period T, in [0.00628, 6283].
    restitution : float
        Coefficient of restitution e, in (0, 1].
    n : int
        Number of forcing cycles per response period: odd, 1 to 9,999.

    Returns
    -------
    list of Mode
        Empty below `existence_amplitude`, two modes up to `slower_mode_amplitude`, one above. Empty at A = 0, where the
        forcing phase is undefined.

    Raises
    ------
    TypeError
        If an argument is not a real number.
    ValueError
        If an argument lies outside its range, or if n is even.

    See Also
    --------
    existence_amplitude : Lowest amplitude with symmetric modes.
    symmetry_breaking_amplitude : Stability limit of the faster mode.
    slower_mode_amplitude : Limit of the slower mode.
    rocking.find_orbit : Periodic orbits of any kind.
    rocking.plot.modes : Plot the modes.

    Notes
    -----
    Stability follows from the closed form. The slower mode has a trace above 1 + e² and is never stable. A mode is *admissible*
    if Θ > 0 for the whole half cycle. This is proved by the search for the first crossing that `simulate` uses.

    Examples
    --------
    >>> import rocking as rk
    >>> for mode in rk.theory.symmetric_modes(6.5, 0.4, 0.925, 3):
    ...     print(mode)
    (1, 3) mode: V = 0.658253, φ = -1.87161, stable, admissible
    >>> rk.theory.symmetric_modes(0.2, 1.0, 0.8, 1)
    []
    """
    amplitude = AMPLITUDE.checked(amplitude)
    omega = math.tau / PERIOD.checked(period)
    e = RESTITUTION.checked(restitution)
    if e == 0.0:
        remedy = "an impact that stops the block leaves no mode"
        raise Refusal("restitution", "lie in (0, 1] for symmetric modes", restitution, remedy)
    odd(whole("n", n, 1, MAX_CYCLES))
    beta = numbers.harmonic_parameters(amplitude, omega, period, 0.0, e).forcing.response
    modes = []
    for faster in (True, False):
        speed, phase, trace = kernel.closed_form(omega, beta, e, n, faster)
        if amplitude > 0.0 and speed > 0.0:
            modes.append(_mode(amplitude, period, e, n, speed, phase, trace))
    return modes


def _mode(
    amplitude: float, period: float, e: float, n: int, speed: float, phase: float, trace: float
) -> Mode:
    """Return one root with its derived quantities."""
    omega = math.tau / period
    p = numbers.harmonic_parameters(amplitude, omega, period, phase, e)
    length = n * math.pi / omega
    common = -1.0 / (1.0 + math.exp(-length))
    other = p.forcing.response * math.cos(phase) / math.expm1(-length)
    up, peak = kernel.half_cycle(p, speed, common + other, common - other, length)
    known = 0.5 * trace, (0.5 * trace - e) * (0.5 * trace + e), e * e
    return Mode(
        amplitude=amplitude,
        period=float(period),
        restitution=e,
        n=int(n),
        velocity=speed,
        phase=phase,
        trace=trace,
        half_multipliers=floquet.complex_multipliers(*known, False),
        multipliers=floquet.complex_multipliers(*known, True),
        admissible=bool(up),
        peak=peak if up else None,
    )
