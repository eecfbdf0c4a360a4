"""Design rules for rocking: the loop of FEMA 356 and of Priestley, and pulses that overturn. They are no exact results."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking.model import Block, GroundMotion, instance, one_of, within
from rocking.theory.arguments import between, plain, restitutions
from rocking.theory.free_rocking import free_quarter_period

LOGARITHMIC, LINEAR = 0.34, 0.4
DAMPINGS = ("fema-356", "priestley")
MAX_STEPS, CLOSE = 500, 1e-10
# Angle in units of θcr below which the loop ends at 0: the periods of smaller angles are out of range.
NEGLIGIBLE = 1e-5
SLOPES = {"half-sine": 1 / 2, "one-sine": 1 / 6, "one-cosine": 1 / 4}
MAX_RATIO = 3.0
MAX_DAMPING = 0.99  # of a response spectrum


def equivalent_damping(restitution: Any, rule: str = "fema-356") -> Any:
    """Damping ratio of the linear oscillator by which a design rule replaces a rocking block.

    With r = e², the ratio of the kinetic energies after and before an impact, the rules are

    - FEMA 356: β = 0.4 (1 − √r);
    - Priestley: β = −0.34 ln r.

    Parameters
    ----------
    restitution : float or array
        Coefficient of restitution e, in [0, 1].
    rule : {"fema-356", "priestley"}
        Rule. Default: "fema-356".

    Returns
    -------
    float or ndarray
        β, in the shape of `restitution`; infinite by Priestley's rule at e = 0.

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If an argument lies outside its range.

    See Also
    --------
    design_angle : Rocking angle by such a rule.

    References
    ----------
    Makris & Konstantinidis, Earthquake Eng. Struct. Dyn. (2003).

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(height=2.0, width=0.5)
    >>> [round(100 * equivalent_damping(block.restitution, rule), 2) for rule in ("fema-356", "priestley")]
    [3.53, 6.28]
    """
    e = np.asarray(restitutions(restitution))
    if one_of("rule", rule, DAMPINGS) == "fema-356":
        return plain(LINEAR * (1.0 - e))
    with np.errstate(divide="ignore"):
        return plain(-2.0 * LOGARITHMIC * np.log(e) + 0.0)


def design_angle(ground: GroundMotion, block: Block, rule: str = "fema-356", *, start: float = 0.5) -> float:
    """Largest angle of a block by the loop of FEMA 356 or of Priestley, to compare with `simulate`.

    The loop replaces the block by a linear oscillator of the period of free rocking, T = (4/α) arcosh(1/(1 − Θ)). It reads the
    displacement Δ(T, β) of the elastic response spectrum, and continues with the angle Δ/(R cos θcr). It ends where the angle
    no longer changes. Its error is not bounded. For one record and block, Makris & Konstantinidis (2003) find 0.25 rad by the loop, and
    0.08 rad by integration.

    Parameters
    ----------
    ground : GroundMotion
        Ground motion.
    block : Block
        Block.
    rule : {"fema-356", "priestley"}
        Rule of the damping ratio β, as in `equivalent_damping`. Default: "fema-356".
    start : float
        Angle Θ from which the loop starts, in [0.001, 0.999]. Another start may end at another angle. Default: 0.5.

    Returns
    -------
    float
        Angle Θ, in units of θcr. Infinite if the loop reaches the critical angle, which means overturning. NaN if it does not
        converge in 500 steps, which is frequent where the response spectrum is rough.

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If an argument lies outside its range, or if β exceeds 0.99.

    See Also
    --------
    equivalent_damping : Damping ratio of the rule.
    rocking.simulate : The motion itself.
    rocking.GroundMotion : Its response spectrum.

    References
    ----------
    Makris & Konstantinidis, Earthquake Eng. Struct. Dyn. (2003).

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> pulse = 5.0 * np.append(np.sin(np.pi * np.arange(61) / 30), np.zeros(400))
    >>> ground, block = rk.GroundMotion(pulse, step=0.01), rk.Block(height=3.0, width=0.8)
    >>> round(design_angle(ground, block), 3), round(rk.simulate(block.system(ground)).peak, 3)
    (0.632, 0.537)
    """
    instance("ground", ground, GroundMotion)
    instance("block", block, Block)
    damping = within("β", float(equivalent_damping(block.restitution, rule)), 0.0, MAX_DAMPING)
    angle = within("start", start, 1e-3, 0.999)
    lever = block.radius * math.cos(block.critical_angle) * block.critical_angle
    for _ in range(MAX_STEPS):
        period = 4.0 * block.seconds(free_quarter_period(angle))
        following = ground.response_spectrum(period, damping) * (period / math.tau) ** 2 / lever
        if following >= 1.0:
            return math.inf
        if abs(following - angle) <= CLOSE * max(following, angle):
            return float(following)
        if following <= NEGLIGIBLE:
            return 0.0
        angle = following
    return math.nan


def pulse_overturning_rule(kind: str, frequency: Any) -> Any:
    """Amplitude of a pulse that overturns a block, by the rules of Makris & Roussos: 1 + Ω/2, 1 + Ω/6, 1 + Ω/4.

    The rules approximate the smallest overturning amplitude of slender blocks, for Ω < 3. `simulate` gives the exact outcome.

    Parameters
    ----------
    kind : {"half-sine", "one-sine", "one-cosine"}
        Pulse, as for `Pulse`.
    frequency : float or array
        Ω = ω/α, angular frequency of the pulse over the frequency parameter, in [0, 3]. A half-sine lasts π/Ω, the others 2π/Ω.

    Returns
    -------
    float or ndarray
        Amplitude in units of g θcr, in the shape of `frequency`.

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If an argument lies outside its range.

    See Also
    --------
    rocking.Pulse : The pulses.
    rocking.simulate : The exact outcome.

    References
    ----------
    Makris & Roussos (2000), Eqs. (28), (41), (43) and (45).

    Examples
    --------
    >>> pulse_overturning_rule("half-sine", [1.0, 2.0]).tolist()
    [1.5, 2.0]
    """
    slope = SLOPES[one_of("kind", kind, tuple(SLOPES))]
    return plain(1.0 + slope * np.asarray(between("frequency", frequency, 0.0, MAX_RATIO)))
