"""Attractors of initial states, distinguished by their orbits and not only by their periods."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from attrs import evolve

from rocking.kernels import batch
from rocking.kernels.classify import verdict
from rocking.model.survey_results import Attractor
from rocking.model.system import NO_BRACES, State, System, quantities, system_of
from rocking.model.verdict import Kind, Verdict
from rocking.motion.simulate import simulate
from rocking.response.classify import budget, classify
from rocking.survey.measurement import Arrays, Measurement, Variable
from rocking.survey.spec import Points, points
from rocking.survey.verdict_measures import VARIABLES, anchors, averages, grouped, variables_of, verdicts

SAME = 1e-6
"""Largest distance on the section of orbits that count as one."""
KEPT = ("kind", "evidence", "response_period", "impacts_per_period", "brace_hits_per_period", "symmetric")
ANCHORS = tuple(
    Variable(
        f"orbit_{what}",
        "float64",
        math.inf,
        {
            "long_name": f"{what} of the representative state of the attractor in units of {unit}",
            "units": "1",
            "comment": f"at {batch.SECTION:.6g} of a forcing cycle; NaN: neither periodic nor at rest",
        },
    )
    for what, unit in (("angle", "theta_cr"), ("velocity", "alpha theta_cr"))
)
AVERAGES = (
    Variable(
        "mean_angle",
        "float64",
        math.inf,
        {
            "long_name": "mean angle on the section in units of theta_cr",
            "units": "1",
            "comment": "NaN: not chaotic, or undamped",
        },
    ),
    Variable(
        "mean_angle_error",
        "float64",
        math.inf,
        {"long_name": "standard error of the mean angle", "units": "1", "comment": "NaN: none"},
    ),
)
CLASS = ("kind", "response_period", "impacts_per_period", "brace_hits_per_period", "symmetric")
"""Properties of an attractor other than its states."""


def destination(max_cycles: int, max_period: int, title: str) -> Measurement:
    """Return the measurement of the verdict and a representative state of the attractor."""
    by_name = {each.name: each for each in VARIABLES}
    variables = (
        *(by_name[name] for name in KEPT),
        *ANCHORS,
        *AVERAGES,
        by_name["transient"],
        by_name["cycles"],
    )
    return Measurement(title, attractor_of_each, variables, budget(max_cycles, max_period), batch.METHOD)


def classify_with_anchor(
    values: Mapping[str, np.ndarray],
    fixed: Mapping[str, float],
    max_cycles: int,
    max_period: int,
    stop: np.ndarray,
) -> Arrays | None:
    """Return the classification at points with the representative state of each orbit.

    The state is in `orbit_angle` and `orbit_velocity`. Returns None if another thread sets `stop`.
    """
    spec = points(values, fixed)
    arrays = verdicts(spec, {"max_cycles": max_cycles, "max_period": max_period}, stop)
    if arrays is None:
        return None
    angles, velocities = anchors(spec, arrays).T
    return variables_of(arrays) | {"orbit_angle": angles, "orbit_velocity": velocities}


def attractor_of_each(points: Points, options: Mapping[str, int], stop: np.ndarray) -> Arrays | None:
    """Return the classification with the representative state and the chaotic mean of each attractor."""
    arrays = verdicts(points, options, stop)
    if arrays is None:
        return None
    states = anchors(points, arrays)
    # an undamped system has no attractor, and its mean angle does not converge in any practical time
    means = averages(points, (arrays.kind == verdict.CHAOTIC) & ~points.lossless, options["max_cycles"], stop)
    if stop[0]:
        return None
    answers = variables_of(arrays)
    columns = zip((*ANCHORS, *AVERAGES), (*states.T, *means.T), strict=True)
    return {name: answers[name] for name in (*KEPT, "transient", "cycles")} | {
        each.name: np.ascontiguousarray(column) for each, column in columns
    }


def label_attractors(system: System, answers: Mapping[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Assign initial states to attractors, in descending order of the number of initial states.

    Two orbits of one class (kind, period, impacts, symmetry) are the same attractor in two cases. Their representative
    states coincide, or the representative state of one is a state of the other. Chaotic responses are the same
    attractor if their means agree within their errors.

    Returns
    -------
    tuple of (array (n,) of int, array (m,) of int)
        Attractor of each initial state; index of one initial state per attractor.
    """
    named_by = (*CLASS, *(each.name for each in (*ANCHORS, *AVERAGES)))
    flat = {name: np.asarray(answers[name]).ravel() for name in named_by}
    columns = [flat[name].astype(float) for name in CLASS]
    anchors = np.column_stack([flat["orbit_angle"], flat["orbit_velocity"]])
    unanchored = np.isnan(anchors).any(axis=1)
    # + 0.0 removes negative zeros, whose bytes differ
    rounded = np.where(unanchored[:, None], 0.0, np.round(anchors / SAME)) + 0.0
    means = grouped(flat["mean_angle"], flat["mean_angle_error"])
    keys = np.column_stack([*columns, unanchored, means, rounded])
    distinct, first, groups = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    joined = _joined(system, distinct, anchors[first])[groups.ravel()]
    _, first, labels, counts = np.unique(joined, return_index=True, return_inverse=True, return_counts=True)
    order = np.argsort(-counts, kind="stable")
    ranks = np.empty_like(order)
    ranks[order] = np.arange(order.size)
    return ranks[labels.ravel()], first[order]


def _joined(system: System, distinct: np.ndarray, anchors: np.ndarray) -> np.ndarray:
    """Return a number for each distinct row, the same for rows of one attractor."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    classes = np.unique(distinct[:, : len(CLASS) + 1], axis=0, return_inverse=True)[1].ravel()
    pairs = [np.empty((0, 2), int)]
    for number in range(classes.max() + 1):
        members = np.flatnonzero(classes == number)
        if members.size < 2 or np.isnan(anchors[members]).any():
            continue
        pairs.append(members[pairs_of_equal_states(anchors[members], anchors[members])])
        period = int(distinct[members[0], 1])
        # a class of thousands of orbits lies near a torus and is no list of attractors
        if period > 1 and members.size <= 1000:
            pairs.append(_shared(system, members, anchors, period))
    links = np.concatenate(pairs)
    graph = coo_array((np.ones(len(links)), (links[:, 0], links[:, 1])), shape=(len(distinct),) * 2)
    return connected_components(graph, directed=False)[1]


def _shared(system: System, members: np.ndarray, anchors: np.ndarray, period: int) -> np.ndarray:
    """Return pairs of orbits of one period in which the representative state of one is a state of the other."""
    states = np.concatenate([section_of(system, anchors[each], period) for each in members])
    rows, others = pairs_of_equal_states(states, anchors[members]).T
    return np.column_stack([np.repeat(members, period)[rows], members[others]])


def pairs_of_equal_states(states: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Return pairs (m, 2) of rows of `states` (n, 2) and `others` (k, 2) at a distance of at most SAME."""
    from scipy.spatial import cKDTree

    near = cKDTree(states).query_ball_point(others, SAME)
    counts = [len(places) for places in near]
    rows = np.concatenate([np.empty(0, int), *near]).astype(int)
    return np.column_stack([rows, np.repeat(np.arange(len(others)), counts)])


def section_of(system: System, anchor: np.ndarray, period: int) -> np.ndarray:
    """Return the states (n, 2) of an orbit on the section, beginning with its representative state."""
    phase = system.periodic.phase + math.tau * batch.SECTION
    clocked = system_of(NO_BRACES | quantities(system) | {"phase": phase})
    clocked = evolve(clocked, restitution_table=system.restitution_table)
    return np.asarray(simulate(clocked, State(*anchor), cycles=period, record="section").section()[:period])


def make_attractors(
    system: System, starts: np.ndarray, first: np.ndarray, max_cycles: int, max_period: int
) -> tuple[Attractor, ...]:
    """Return the attractors of the initial states with indices `first`, each with a unique name."""
    verdicts = [classify(system, State(*starts[k]), max_cycles, max_period) for k in first]
    plain = [_name(each) for each in verdicts]
    names, seen = [], dict.fromkeys(plain, 0)
    for name in plain:
        letter = f" ({_letters(seen[name])})" if plain.count(name) > 1 else ""
        seen[name] += 1
        names.append(name + letter)
    return tuple(Attractor(name, verdict) for name, verdict in zip(names, verdicts, strict=True))


def _name(verdict: Verdict) -> str:
    if verdict.orbit is None:
        leans = verdict.kind is Kind.REST and verdict.steady_peak
        return "leaning" if leans else str(verdict.kind)
    return f"period {verdict.period}, {'symmetric' if verdict.symmetric else 'asymmetric'}"


def _letters(number: int) -> str:
    """Return the letters of a number: a, b, …, z, aa, ab, …."""
    before, last = divmod(number, 26)
    return (_letters(before - 1) if before else "") + "abcdefghijklmnopqrstuvwxyz"[last]
