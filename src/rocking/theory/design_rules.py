"""Design rules for rocking: FEMA 356 and Priestley, pulses, Ishiyama's levels, equal displacements. They are no exact solutions.

Also the restitution of an impact between the centre and the corner of the base, and the rocking frame.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking.model.block import RECTANGLE, Block, symmetric_block
from rocking.model.block_formulas import GRAVITY
from rocking.model.ground_motion import GroundMotion
from rocking.model.validation import Refusal, Text, instance, one_of, refuse_if, within
from rocking.theory.arguments import between, plain, restitutions, together
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
    (0.632, 0.508)
    """
    instance("ground", ground, GroundMotion)
    symmetric_block(block)
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


ISHIYAMA = 0.4
"""Fraction of the velocity v₀ in Ishiyama's rule."""


def ishiyama_levels(block: Block) -> tuple[float, float]:
    """Lowest PGA and PGV of a ground motion that overturns a block, by Ishiyama's rule: (B/H) g and 0.4 v₀.

    v₀ is the step of the base velocity that just overturns a block at rest: the block starts with ω = v₀ cos α/(rR), by its angular
    momentum, and needs the energy mgR(1 − cos α). So v₀ = √(2rgR(1 − cos α))/cos α with the inertia ratio r, which is 4/3 for
    Ishiyama's uniform block: v₀ = √(8gR(1 − cos α)/(3 cos²α)).

    Parameters
    ----------
    block : Block
        Block. It is symmetric.

    Returns
    -------
    pga : float
        Acceleration of lift-off in m/s². A lower PGA never moves the block.
    pgv : float
        0.4 v₀ in m/s.

    Raises
    ------
    TypeError
        If `block` is not a Block.
    ValueError
        If it is unsymmetric.

    See Also
    --------
    rocking.overturning_set : The levels of a record that overturn the block.

    Notes
    -----
    **Limits.** The rule is necessary in PGA, and it is not in PGV: 0.4 is a fractile of records, not a bound. Of 60 synthetic records
    (``synthetic_ground_motions(60, seed=1)``, full equation) three overturn a block of 4 m × 1 m below 0.4 v₀, the first one at
    0.376 v₀, and none a block of 2 m × 0.5 m, with the lowest at 0.410 v₀. Nor is the rule sufficient: half of the records need more
    than about 0.6 v₀.

    References
    ----------
    Ishiyama, Earthquake Eng. Struct. Dyn. 10, 635–650 (1982).

    Examples
    --------
    >>> import rocking as rk
    >>> pga, pgv = ishiyama_levels(rk.Block(height=4.0, width=1.0))
    >>> round(pga, 4), round(pgv, 4)
    (2.4517, 0.5231)
    """
    angle = symmetric_block(block).critical_angle
    step = math.sqrt(2.0 * block.inertia_ratio * GRAVITY * block.radius * (1.0 - math.cos(angle)))
    return GRAVITY * math.tan(angle), ISHIYAMA * step / math.cos(angle)


SAME_SHAPE = 1e-6
"""Relative difference of two critical angles up to which blocks are similar."""


def equal_displacement_angle(angle: Any, block: Block, other: Block) -> Any:
    """Largest angle of a block by that of a similar one of another size: both have the same displacement of their tops.

    At an angle |θ| the upper corner over the centre of rotation has moved sideways by d = 2R (sin θcr − sin(θcr − |θ|)). The rule
    replaces the larger block by the smaller one under the same ground motion, or the reverse.

    Parameters
    ----------
    angle : float or array
        Largest angle |Θ| of `block`, in units of θcr, in [0, 1].
    block : Block
        Block whose angle is known. It is symmetric.
    other : Block
        Block of the same slenderness, whose angle the rule estimates.

    Returns
    -------
    float or ndarray
        Angle |Θ| of `other`, in units of θcr, in the shape of `angle`. Infinite where its displacement would exceed its
        width, at which it stands on its critical angle.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If an angle lies outside its range, if a block is unsymmetric, or if their slendernesses differ.

    See Also
    --------
    rocking.rocking_spectrum : The angles of blocks of many sizes.

    Notes
    -----
    **Limits.** The rule holds for blocks that are not close to overturning, and for the median of many records. It does not hold for
    one record. Under 60 synthetic records (``synthetic_ground_motions(60, seed=1)``, full equation) with a PGA of twice the lift-off,
    blocks of tan θcr = 0.2 and R = 4 m and 8 m have a ratio of displacements with the median 0.97, and 68 % of the ratios lie
    between 0.60 and 1.18. With R = 2 m and 4 m and a PGA of three times the lift-off, 47 records overturn the smaller block.
    Of the 12 others half have a ratio above 1.45.

    References
    ----------
    Reggiani Manzo & Vassiliou, Earthquake Eng. Struct. Dyn. 48, 1613–1629 (2019).

    Examples
    --------
    >>> import rocking as rk
    >>> small, large = rk.Block(2.0, 0.4), rk.Block(4.0, 0.8)
    >>> equal_displacement_angle([0.2, 1.0], small, large).round(4).tolist()
    [0.1002, 0.5024]
    >>> equal_displacement_angle(0.9, large, small)
    inf
    """
    known = np.asarray(between("angle", angle, 0.0, 1.0))
    for name, each in (("block", block), ("other", other)):
        symmetric_block(each, name)
    slope, requested = block.critical_angle, other.critical_angle
    refuse_if(
        abs(slope - requested) > SAME_SHAPE * slope,
        "other",
        f"have the slenderness of the block, {math.degrees(slope):.6g}°",
        Text(f"{math.degrees(requested):.6g}°"),
    )
    moved = block.radius / other.radius * (math.sin(slope) - np.sin(slope * (1.0 - known)))
    sine = math.sin(slope) - moved
    stands = np.where(sine >= 0.0, 1.0 - np.arcsin(np.maximum(sine, 0.0)) / slope, np.inf)
    return plain(np.where(block.radius == other.radius, known, stands))


def contact_restitution(critical_angle: Any, fraction: Any) -> Any:
    """Coefficient of restitution of a uniform block whose impact acts at a fraction k of half its width.

    The angular momentum about the point of impact is conserved. The block then rotates about its corner:
    e = (4 − 3(1 + k) sin²θcr)/(4 − 3(1 − k) sin²θcr). k = 1 is an impact at the corner, Housner's value 1 − (3/2) sin²θcr. k = 0 is
    one at the centre of the base, without loss.

    Parameters
    ----------
    critical_angle : float or array
        Critical angle θcr in rad, in [0, π/2].
    fraction : float or array
        Distance k of the impact from the centre of the base, in units of half the width, in [0, 1]. The arguments broadcast.

    Returns
    -------
    float or ndarray
        e.

    Raises
    ------
    TypeError
        If an argument is not a real number or an array of real numbers.
    ValueError
        If an argument lies outside its range, or if e is negative, for a squat block.

    See Also
    --------
    equivalent_damping : Damping ratio that design rules derive from e.
    rocking.Block : A block with any restitution.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(height=2.0, width=0.5)
    >>> contact_restitution(block.critical_angle, [0.0, 0.5, 1.0]).round(6).tolist()
    [1.0, 0.954887, 0.911765]
    """
    angle = between("critical_angle", critical_angle, 0.0, math.pi / 2)
    angle, k = together(critical_angle=angle, fraction=between("fraction", fraction, 0.0, 1.0))
    square = np.sin(angle) ** 2
    result = np.asarray((4.0 - 3.0 * (1.0 + k) * square) / (4.0 - 3.0 * (1.0 - k) * square))
    if (result < 0.0).any():
        first = float(np.broadcast_to(angle, result.shape)[result < 0.0].flat[0])
        allowed = "give a restitution that is not negative"
        raise Refusal("critical_angle", allowed, first, "the block is too squat to rock on")
    return plain(result)


MAX_MASS_RATIO = 1e6


def rocking_frame(height: float, width: float, mass_ratio: float) -> Block:
    """Block that moves like a frame of equal columns with a rigid beam on their tops.

    The columns rock together, and the beam moves without rotation. With γ = m_b/(N m_c), of a beam and N columns,

    - α̂ = α √((1 + 2γ)/(1 + 3γ)), by the inertia ratio (4/3)(1 + 3γ)/(1 + 2γ);
    - ê = (1 − (3/2) sin²θcr + 3γ cos 2θcr)/(1 + 3γ), by the angular momentum of the frame at an impact.

    The critical angle and the acceleration of lift-off are those of a column. A heavy beam makes the frame slower, so that it is
    harder to overturn.

    Parameters
    ----------
    height, width : float
        Height and width of a column in metres, in [0.001, 1000].
    mass_ratio : float
        γ, mass of the beam over that of all columns, in [0, 10⁶]. 0 gives the column alone.

    Returns
    -------
    Block
        Block with the size of a column, the inertia ratio and the restitution of the frame.

    Raises
    ------
    TypeError
        If a value is not a real number.
    ValueError
        If a value lies outside its range, or if the restitution is negative, for squat columns.

    See Also
    --------
    rocking.Block : A block with any inertia ratio and restitution.
    contact_restitution : Restitution of other impacts.

    References
    ----------
    Makris & Vassiliou (2013).

    Examples
    --------
    >>> import rocking as rk
    >>> column, frame = rk.Block(9.6, 1.6), rocking_frame(9.6, 1.6, mass_ratio=4.0)
    >>> round(frame.frequency_parameter / column.frequency_parameter, 4)
    0.8321
    >>> round(column.restitution, 4), round(frame.restitution, 4)
    (0.9595, 0.9470)
    """
    ratio = within("mass_ratio", mass_ratio, 0.0, MAX_MASS_RATIO)
    angle = Block(height, width, restitution=1.0).critical_angle
    column = 1.0 - 1.5 * math.sin(angle) ** 2
    restitution = (column + 3.0 * ratio * math.cos(2.0 * angle)) / (1.0 + 3.0 * ratio)
    inertia_ratio = RECTANGLE * (1.0 + 3.0 * ratio) / (1.0 + 2.0 * ratio)
    return Block(height, width, restitution=restitution, inertia_ratio=inertia_ratio)
