"""Amplitudes at which one pulse overturns a slender block at rest: closed forms, up to the root of one equation."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from rocking.theory.arguments import between, plain, restitutions, together

DURATIONS = (1e-6, 1e6)
IMPACT_DURATIONS = (1e-3, 100.0)
HALVINGS = 100
"""Halvings of a bracket (0, π/2): all roots are larger than 1e-6, so that 100 halvings leave no number between its ends."""
TIGHT = {"xtol": 1e-300, "rtol": 4 * np.finfo(float).eps}


def rectangular_pulse_amplitude(duration: Any) -> Any:
    """Amplitude A = 1/(1 − e⁻ᵀ) above which a rectangular pulse overturns a block at rest.

    Parameters
    ----------
    duration : float or array
        Normalised duration T of the pulse, in [1e-6, 1e6].

    Returns
    -------
    float or ndarray
        A in units of g θcr, in the shape of `duration`, for any coefficient of restitution.

    Raises
    ------
    TypeError
        If `duration` is not a real number or an array of real numbers.
    ValueError
        If `duration` lies outside its range.

    See Also
    --------
    half_sine_pulse_amplitude : Threshold of half a period of a sine.
    rocking.Pulse : The pulse as a base motion.

    Notes
    -----
    Housner, Bull. Seismol. Soc. Am. 53, 403–417 (1963), Eq. (9), cosh T = 1 + 1/(2A(A − 1)), has the same solution.

    Examples
    --------
    >>> round(rectangular_pulse_amplitude(1.0), 12)
    1.581976706869
    """
    return plain(-1.0 / np.expm1(-between("duration", duration, *DURATIONS)))


def falling_triangle_pulse_amplitude(duration: Any) -> Any:
    """Amplitude A = 1/(1 − (1 − e⁻ᵀ)/T) above which a pulse that jumps to A and falls linearly to 0 overturns a block at rest.

    Parameters
    ----------
    duration : float or array
        Normalised duration T of the pulse, in [1e-6, 1e6].

    Returns
    -------
    float or ndarray
        A in units of g θcr, in the shape of `duration`, for any coefficient of restitution.

    Raises
    ------
    TypeError, ValueError
        As in `rectangular_pulse_amplitude`.

    See Also
    --------
    triangle_pulse_amplitude : Threshold of a pulse that rises as it falls.
    rocking.PiecewiseLinear : The pulse as a base motion, of the samples [A, 0].

    Notes
    -----
    A push in one direction overturns a slender block at rest if e^{t₀} ∫ e⁻ˣ a(x) dx > 1 from the lift-off at t₀ to its end.
    Here t₀ = 0. The lowest A is about 2/T of a short pulse, like any of its area, and 1 of a long one.

    Examples
    --------
    >>> round(falling_triangle_pulse_amplitude(0.5), 12), falling_triangle_pulse_amplitude(1.0) == math.e
    (4.693484498723, True)
    """
    from scipy.special import hyp1f1

    duration = between("duration", duration, *DURATIONS)
    # 1 − (1 − e⁻ᵀ)/T = (T/2) ₁F₁(1; 3; −T), without cancellation
    return plain(2.0 / (duration * hyp1f1(1.0, 3.0, -duration)))


def triangle_pulse_amplitude(duration: Any) -> Any:
    """Amplitude A above which a pulse that rises linearly to A, and falls so to 0, overturns a block at rest.

    A = T/(2t₀) with the time of lift-off t₀ = −ln(2e^{−T/2} − e⁻ᵀ).

    Parameters
    ----------
    duration : float or array
        Normalised duration T of the pulse, in [1e-6, 1e6].

    Returns
    -------
    float or ndarray
        A in units of g θcr, in the shape of `duration`, for any coefficient of restitution.

    Raises
    ------
    TypeError, ValueError
        As in `rectangular_pulse_amplitude`.

    See Also
    --------
    falling_triangle_pulse_amplitude : Threshold of a pulse that begins with its peak.
    rocking.PiecewiseLinear : The pulse as a base motion, of the samples [0, A, 0].

    Notes
    -----
    The condition of `falling_triangle_pulse_amplitude`, at its limit, is
    e^{t₀} k {[−(x + 1)e⁻ˣ] from t₀ to T/2 + [−(T − x − 1)e⁻ˣ] from T/2 to T} = 1 with the slope k = 2A/T and t₀ = 1/k.
    It reduces to e^{−t₀} = 2e^{−T/2} − e⁻ᵀ.

    Examples
    --------
    >>> [round(triangle_pulse_amplitude(duration), 12) for duration in (0.5, 2.0)]
    [4.983389430863, 1.960323544077]
    """
    half = 0.5 * between("duration", duration, *DURATIONS)
    with np.errstate(divide="ignore"):  # that of a long pulse is not used
        short = -np.log1p(-(np.expm1(-half) ** 2))
    return plain(half / np.where(half < 0.5, short, half - np.log(2.0 - np.exp(-half))))


def half_sine_pulse_amplitude(duration: Any) -> Any:
    """Amplitude A above which half a period of a sine overturns a block at rest, without an impact.

    With Ω = π/T, A = 1/sin ψ at the root of Ω sin ψ − cos ψ = exp(−(π − ψ)/Ω) in (0, π/2).

    Parameters
    ----------
    duration : float or array
        Normalised duration T of the pulse, in [1e-6, 1e6].

    Returns
    -------
    float or ndarray
        A in units of g θcr, in the shape of `duration`, for any coefficient of restitution.

    Raises
    ------
    TypeError, ValueError
        As in `rectangular_pulse_amplitude`.

    See Also
    --------
    one_sine_pulse_amplitude : Threshold of a whole period.
    rocking.Pulse : The pulse as a base motion.

    References
    ----------
    Shi et al. (1996); Makris & Roussos (2000), Eq. (27).

    Examples
    --------
    >>> round(half_sine_pulse_amplitude(math.pi), 11)
    1.32239659791
    """
    rate = math.pi / between("duration", duration, *DURATIONS)
    phase = _root(
        lambda psi: rate * np.sin(psi) - np.cos(psi) - np.exp(-(math.pi - psi) / rate), np.shape(rate)
    )
    return plain(1.0 / np.sin(phase))


def one_sine_pulse_amplitude(duration: Any) -> Any:
    """Amplitude A above which one period of a sine overturns a block at rest without an impact: mode 2.

    With Ω = 2π/T, A = 1/sin ψ at the root of Ω sin ψ − cos ψ = −exp(−(2π − ψ)/Ω) in (0, π/2).

    Parameters
    ----------
    duration : float or array
        Normalised duration T of the pulse, in [1e-6, 1e6].

    Returns
    -------
    float or ndarray
        A in units of g θcr, in the shape of `duration`, for any coefficient of restitution.

    Raises
    ------
    TypeError, ValueError
        As in `rectangular_pulse_amplitude`.

    See Also
    --------
    one_sine_impact_amplitudes : Amplitudes that overturn the block after an impact: mode 1.
    rocking.Pulse : The pulse as a base motion.

    References
    ----------
    Zhang & Makris, J. Eng. Mech. 127, 473–483 (2001), Eq. (47).

    Examples
    --------
    >>> round(one_sine_pulse_amplitude(2 * math.pi / 5), 12)
    7.168128797071
    """
    return plain(1.0 / np.sin(_without_impact(math.tau / between("duration", duration, *DURATIONS))))


def one_sine_impact_amplitudes(duration: Any, restitution: Any) -> tuple[Any, Any]:
    """Range of amplitudes at which one period of a sine overturns a block at rest after one impact: mode 1.

    The impact follows the end of the pulse. The block leaves it with the speed ew, w² = 1 + u'² − (u − 1)², and overturns if
    ew > 1. Here u and u' are the angle and the velocity at the end of the pulse, which have a closed form.

    Parameters
    ----------
    duration : float or array
        Normalised duration T of the pulse, in [0.001, 100].
    restitution : float or array
        Coefficient of restitution e, in [0, 1]. The arguments broadcast.

    Returns
    -------
    low, high : float or ndarray
        Ends of the range, in units of g θcr. NaN where no amplitude overturns the block in this way. `low` is NaN too if the
        block reaches its impact during the pulse at the lower end of the range.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If an argument lies outside its range.

    See Also
    --------
    one_sine_pulse_amplitude : Threshold without an impact: mode 2.
    rocking.Pulse : The pulse as a base motion.

    References
    ----------
    The two modes: Zhang & Makris, J. Eng. Mech. 127, 473–483 (2001).

    Examples
    --------
    >>> low, high = one_sine_impact_amplitudes(2 * math.pi / 5, 0.9)
    >>> round(low, 12), round(high, 6)
    (3.018599860872, 6.318071)
    """
    rate = math.tau / between("duration", duration, *IMPACT_DURATIONS)
    rate, e = np.broadcast_arrays(*together(duration=rate, restitution=restitutions(restitution)))
    result = np.array([_range(*pair) for pair in zip(rate.ravel().tolist(), e.ravel().tolist(), strict=True)])
    low, high = result.reshape(*rate.shape, 2)[..., 0], result.reshape(*rate.shape, 2)[..., 1]
    return plain(low), plain(high)


def one_cosine_pulse_amplitude(duration: Any) -> Any:
    """Amplitude A = (1 + Ω²)/(1 − e⁻ᵀ) above which one period of a cosine overturns a block at rest without an impact.

    Ω = 2π/T is the normalised frequency of the pulse.

    Parameters
    ----------
    duration : float or array
        Normalised duration T of the pulse, in [1e-6, 1e6].

    Returns
    -------
    float or ndarray
        A in units of g θcr, in the shape of `duration`. Smaller amplitudes may overturn the block after an impact.

    Raises
    ------
    TypeError, ValueError
        As in `rectangular_pulse_amplitude`.

    See Also
    --------
    one_sine_pulse_amplitude : Threshold of one period of a sine.
    rocking.Pulse : The pulse as a base motion.

    Notes
    -----
    Without an impact the condition of `falling_triangle_pulse_amplitude` holds for this pulse, too. Here t₀ = 0, and
    ∫ e⁻ˣ cos Ωx dx over one period is (1 − e⁻ᵀ)/(1 + Ω²).

    Examples
    --------
    >>> round(one_cosine_pulse_amplitude(2 * math.pi), 6)
    2.003742
    """
    duration = between("duration", duration, *DURATIONS)
    return plain(-(1.0 + (math.tau / duration) ** 2) / np.expm1(-duration))


def _without_impact(rate: Any) -> Any:
    """Return the phase ψ of the lift-off at the threshold of mode 2."""
    return _root(
        lambda psi: rate * np.sin(psi) - np.cos(psi) + np.exp(-(math.tau - psi) / rate), np.shape(rate)
    )


def _root(rising: Callable[[Any], Any], shape: tuple[int, ...]) -> Any:
    """Return the root in (0, π/2) of a function that is negative below it and positive above, by bisection."""
    low, high = np.zeros(shape), np.full(shape, math.pi / 2)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        below = rising(middle) < 0.0
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return high


def _end_of_pulse(psi: float, rate: float) -> tuple[float, float]:
    """Return u + u' − 1 and u − u' − 1 at the end of one sine; ψ is the phase of the lift-off. A = 1/sin ψ."""
    beta, time = 1.0 / (math.sin(psi) * (1.0 + rate * rate)), (math.tau - psi) / rate
    growing = -1.0 + beta * (math.sin(psi) + rate * math.cos(psi))
    decaying = -1.0 + beta * (math.sin(psi) - rate * math.cos(psi))
    return growing * math.exp(time) - beta * rate, decaying * math.exp(-time) + beta * rate


def _range(rate: float, e: float) -> tuple[float, float]:
    """Return the lowest and the highest amplitude of mode 1 with the impact after the pulse, or NaN."""
    from scipy.optimize import brentq, minimize_scalar

    def spare(psi: float) -> float:
        """Return (ew)² − 1: positive if the block overturns after its impact."""
        sum_, difference = _end_of_pulse(psi, rate)
        return e * e * (1.0 - sum_ * difference) - 1.0

    def before_impact(psi: float) -> bool:
        sum_, difference = _end_of_pulse(psi, rate)
        return sum_ + difference > -2.0

    first, last = float(_without_impact(rate)), math.pi / 2
    fastest = minimize_scalar(
        lambda psi: -spare(psi), bounds=(first, last), method="bounded", options={"xatol": 1e-12}
    ).x
    if spare(fastest) <= 0.0:
        return math.nan, math.nan
    high = first if spare(first) >= 0.0 else brentq(spare, first, fastest, **TIGHT)
    low = brentq(spare, fastest, last, **TIGHT) if spare(last) < 0.0 else math.nan
    ends = (psi if not math.isnan(psi) and before_impact(psi) else math.nan for psi in (low, high))
    low, high = (1.0 / math.sin(psi) if not math.isnan(psi) else math.nan for psi in ends)
    return low, high
