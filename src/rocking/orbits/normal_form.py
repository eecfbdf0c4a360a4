"""Coefficients of the normal forms of folds, period doublings and symmetry breakings, from the equations of the chain of events.

The equations are singular at a bifurcation. The reduction of Lyapunov and Schmidt gives a polynomial in the amplitude s of the change
of the phases (Golubitsky and Schaeffer 1985). Its coefficients are those of a power series along a curve of phases. The arcs are
closed forms, Yim & Lin (1991), Eq. (5), so that these are exact to rounding, without differences.

A truncated power series is an array whose last axis holds its coefficients, of equal length in all arguments
(Griewank and Walther 2008, ch. 13).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from rocking.model.system import NO_BRACES, quantities
from rocking.orbits.event_chain import BRACE, IMPACT, Chain, sides_of


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the product of two series."""
    out = np.zeros_like(a * b)
    for m in range(out.shape[-1]):
        out[..., m] = (a[..., : m + 1] * b[..., m::-1]).sum(axis=-1)
    return out


def quotient(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the quotient of two series."""
    out = np.array(a)
    for m in range(out.shape[-1]):
        known = (b[..., 1 : m + 1] * out[..., :m][..., ::-1]).sum(axis=-1)
        out[..., m] = (out[..., m] - known) / b[..., 0]
    return out


def exponential(a: np.ndarray) -> np.ndarray:
    """Return the exponential function of a series."""
    out, slope = np.zeros_like(a), a * np.arange(a.shape[-1])
    out[..., 0] = np.exp(a[..., 0])
    for m in range(1, a.shape[-1]):
        out[..., m] = (slope[..., 1 : m + 1] * out[..., :m][..., ::-1]).sum(axis=-1) / m
    return out


def cosine_and_sine(a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the cosine and the sine of a series."""
    cosine, sine, slope = np.zeros_like(a), np.zeros_like(a), a * np.arange(a.shape[-1])
    cosine[..., 0], sine[..., 0] = np.cos(a[..., 0]), np.sin(a[..., 0])
    for m in range(1, a.shape[-1]):
        cosine[..., m] = -(slope[..., 1 : m + 1] * sine[..., :m][..., ::-1]).sum(axis=-1) / m
        sine[..., m] = (slope[..., 1 : m + 1] * cosine[..., :m][..., ::-1]).sum(axis=-1) / m
    return cosine, sine


class Chains(NamedTuple):
    """Chains of the same events for many systems: phases of shape (n, k), parameters of shape (n, 1)."""

    chain: Chain  # events; neither its system nor its phases count
    phases: np.ndarray
    parameters: dict[str, np.ndarray]

    @property
    def twice(self) -> Chains:
        """Chains traversed twice: the whole of a symmetric orbit, or an orbit of twice the period."""
        chain = self.chain
        both = chain._replace(
            period=chain.period if chain.mirrored else 2 * chain.period,
            mirrored=False,
            kinds=np.tile(chain.kinds, 2),
        )
        return Chains(both, np.hstack([self.phases, self.phases + chain.turn]), self.parameters)


class Reduced(NamedTuple):
    """Reduced equation at bifurcations, divided by the factor of its linear term, and the critical directions.

    The linear term is the test function 1 − trace + determinant of the return map; of a period doubling, of the map applied twice.
    """

    values: np.ndarray  # (n,): coefficient of s² at a fold, of s³ at a period doubling
    directions: np.ndarray  # (n, k), of mean square 1


def chains_of(chain: Chain, names: tuple[str, str], rows: np.ndarray) -> Chains:
    """Return the chains at rows of phases and two parameters, shape (n, k + 2)."""
    result = NO_BRACES | quantities(chain.system)
    parameters = {name: np.full((len(rows), 1), value) for name, value in result.items()}
    for name, values in zip(names, rows.T[-2:], strict=True):
        parameters[name] = values[:, None]
        if name in ("period", "frequency"):
            other = "frequency" if name == "period" else "period"
            parameters[other] = math.tau / values[:, None]
    return Chains(chain, rows[:, :-2], parameters)


def speeds(chains: Chains, phases: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the speeds away from Θ = 0 at both ends of each arc, and 1/sinh of its length, as power series.

    Parameters
    ----------
    chains : Chains
        Events and parameters.
    phases : ndarray, shape (n, k, m)
        Phases of the events as power series.

    Returns
    -------
    tuple of ndarray, shape (n, k, m)
        Speeds at the start and the end of each arc; 1/sinh of its length.
    """
    chain, parameters = chains.chain, {name: value[..., None] for name, value in chains.parameters.items()}
    frequency = parameters["frequency"]
    last = phases[:, :1].copy()
    last[..., 0] += chain.turn
    ends = np.concatenate([phases[:, 1:], last], axis=1)
    swing = parameters["amplitude"] / (1.0 + frequency**2) * sides_of(chain)[:, None]
    held = chain.kinds == BRACE
    places = (
        np.where(held, chains.parameters["brace_angle"], 0.0) if held.any() else np.zeros(phases.shape[:2])
    )
    (cosine, sine), (cosine_end, sine_end) = cosine_and_sine(phases), cosine_and_sine(ends)
    start, end = -swing * cosine, -swing * cosine_end
    start[..., 0] += places - 1.0
    end[..., 0] += np.roll(places, -1, axis=1) - 1.0
    time = (ends - phases) / frequency
    decay = exponential(-time)
    squared = product(decay, decay)
    one_less, one_more = -squared, squared.copy()
    one_less[..., 0] = -np.expm1(-2.0 * time[..., 0])
    one_more[..., 0] += 1.0
    coth, inverse_sinh = quotient(one_more, one_less), quotient(2.0 * decay, one_less)
    leaves = product(end, inverse_sinh) - product(start, coth) - swing * frequency * sine
    arrives = product(end, coth) - product(start, inverse_sinh) - swing * frequency * sine_end
    return leaves, arrives, inverse_sinh


def residuals(chains: Chains, phases: np.ndarray) -> np.ndarray:
    """Return the equations of chains as power series, shape (n, k, m): speed after each event, less that of the arc after it."""
    leaves, arrives, _ = speeds(chains, phases)
    parameters = chains.parameters
    law = np.where(chains.chain.kinds == IMPACT, parameters["restitution"], parameters["brace_restitution"])
    return np.asarray(-law[..., None] * np.roll(arrives, 1, axis=1) - leaves)


def jacobians(chains: Chains) -> np.ndarray:
    """Return the derivatives of the equations by the phases, shape (n, k, k)."""
    (_, k), still = chains.phases.shape, chains.phases
    columns = [
        residuals(chains, np.stack([still, np.broadcast_to(unit, still.shape)], axis=-1))[..., 1]
        for unit in np.eye(k)
    ]
    return np.stack(columns, axis=-1)


def folds(chains: Chains) -> Reduced:
    """Return the reduced equations at folds; their signs are those of the directions, which have none of their own."""
    left, directions, factors, _ = _singular(chains)
    second = residuals(chains, _series(chains, directions))[..., 2]
    return Reduced((left * second).sum(axis=1) / factors, directions)


def doublings(chains: Chains) -> Reduced:
    """Return the reduced equations at period doublings, or at symmetry breakings of chains of half an orbit.

    A value is positive if the orbits that bifurcate exist where the original one is unstable.
    """
    both = chains.twice
    left, directions, factors, inverses = _singular(both)
    second = residuals(both, _series(both, directions))[..., 2]
    curved = -np.einsum("nij,nj->ni", inverses, second)
    third = residuals(both, _series(both, directions, curved))[..., 3]
    return Reduced((left * third).sum(axis=1) / factors, directions)


def _series(chains: Chains, directions: np.ndarray, curved: np.ndarray | None = None) -> np.ndarray:
    """Return the phases along directions as power series to the third order, with a quadratic part."""
    none = np.zeros_like(directions)
    return np.stack([chains.phases, directions, none if curved is None else curved, none], axis=-1)


def _singular(chains: Chains) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the null vectors of the Jacobians, the factors of the test function, and the inverses on the other directions.

    The determinant of the Jacobian of k equations is (−1)ᵏ⁻¹ Π γ times the test function (Molinari 2008, Linear Algebra Appl. 429,
    2221). Here γ is the derivative of an equation by the phase of the next event.
    """
    matrices = jacobians(chains)
    finite = np.isfinite(matrices).all(axis=(1, 2))  # not where two events coincide
    left, sizes, right = np.linalg.svd(np.where(finite[:, None, None], matrices, np.eye(matrices.shape[1])))
    _, arrives, inverse_sinh = (each[..., 0] for each in speeds(chains, chains.phases[..., None]))
    k = sizes.shape[1]
    others = np.linalg.det(left) * np.linalg.det(right) * np.prod(sizes[:, :-1], axis=1)
    next_event = arrives * inverse_sinh / chains.parameters["frequency"]
    factors = np.where(
        finite, (-1.0) ** (k - 1) * np.prod(next_event, axis=1) / others * math.sqrt(k), np.nan
    )
    inverses = np.einsum("nji,nj,nlj->nil", right[:, :-1], 1.0 / sizes[:, :-1], left[..., :-1])
    return left[..., -1], right[:, -1] * math.sqrt(k), factors, inverses
