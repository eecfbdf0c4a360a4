"""Response diagrams: verdict, largest exponent and rotation number over the values of a parameter."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import ArrayLike

from rocking.model.system import State, System, check_periodic
from rocking.model.validation import check_progress, instance, one_of
from rocking.model.verdict import Verdict
from rocking.orbits.parameter import PARAMETERS, ordered_values, with_value
from rocking.orbits.response_diagram_result import ResponseDiagram
from rocking.response.classify import MeanImpacts, budget, classify, mean_impacts

MAX_VALUES = 100_000


def response_diagram(
    system: System,
    parameter: str,
    values: ArrayLike,
    start: State | None = None,
    max_cycles: int = 100_000,
    max_period: int = 64,
    progress: Callable[[int], object] | None = None,
) -> ResponseDiagram:
    """Compute a response diagram: type of response, exponent and rotation number over the values of a parameter.

    Each value is classified by `classify`, from the same initial state. The exponent is that of the verdict. The rotation
    number is the mean number of impacts per forcing cycle. Where it is constant over an interval of the parameter, the
    response is locked to the forcing.

    Parameters
    ----------
    system : System
        Block, base motion and braces. Its value of the parameter is not used.
    parameter : {"amplitude", "period", "frequency", "phase", "restitution", "brace_angle", "brace_restitution", "critical_angle"}
        Varied parameter.
    values : array_like
        Values of the parameter, in any order, at most 100,000.
    start : State, optional
        Initial state (Θ, Θ') at τ = 0 of each motion. Default: at rest.
    max_cycles, max_period : int
        As in `classify`. Default: 100,000 and 64.
    progress : callable, optional
        Function called with the number of values completed since its last call.

    Returns
    -------
    ResponseDiagram
        Verdicts with their evidence, exponents and rotation numbers with their errors.

    Raises
    ------
    TypeError
        If an argument is of the wrong type, or the base motion is not periodic.
    ValueError
        If an argument, or one of the values, lies outside its range.

    See Also
    --------
    classify : Classify one response.
    orbit_diagram : Record section points over a parameter.
    parametric_map : Vary two quantities.
    rocking.plot.response_diagram : Plot the diagram.

    Notes
    -----
    The rotation number comes from

    - periodic: the orbit, as impacts per period over the period, without an error;
    - quasi-periodic: the weighted average of the times between impacts over 20,000 cycles, as in `rotation_number`. The error
      is the difference of the averages over both halves;
    - chaotic: the number of impacts in 20,000 cycles after 2,000, with a standard error;
    - at rest: 0.

    It is NaN if the block overturns, if the response is undetermined, or if infinitely many impacts precede rest. Half of it
    is the mean number of turns of (Θ, Θ') about the origin per forcing cycle.

    Limits: another initial state may lead to another response. Narrow intervals between two values are not found. The run whose
    impacts are counted rounds differently from `classify`, and may follow another chaotic transient.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=9.0, period=1.721328), restitution=0.8)
    >>> found = rk.response_diagram(system, "amplitude", [10.2, 10.5, 10.7, 10.9])
    >>> found.kind.tolist(), found.period.tolist()
    (['periodic', 'periodic', 'periodic', 'overturned'], [1, 2, 4, 0])
    >>> found.rotation.tolist()
    [2.0, 2.0, 2.0, nan]
    """
    instance("system", system, System)
    check_progress(progress)
    parameter = one_of("parameter", parameter, PARAMETERS)
    ordered = ordered_values(values, MAX_VALUES)
    limits = budget(max_cycles, max_period)
    systems = [with_value(system, parameter, value) for value in ordered.tolist()]
    # A value that is refused is refused before the first verdict.
    for each in systems:
        check_periodic(each, start)
    start = State() if start is None else start

    def respond(each: System) -> tuple[Verdict, MeanImpacts]:
        verdict = classify(each, start, max_cycles, max_period)
        return verdict, mean_impacts(verdict)

    found = []
    with ThreadPoolExecutor() as pool:
        for pair in pool.map(respond, systems):
            found.append(pair)
            if progress is not None:
                progress(1)
    verdicts, means = zip(*found, strict=True)
    return ResponseDiagram(
        system=system,
        parameter=parameter,
        values=ordered,
        start=start,
        verdicts=verdicts,
        rotation=np.array([mean.value for mean in means]),
        rotation_error=np.array([mean.error for mean in means]),
        rotation_numbers=tuple(mean.rotation for mean in means),
        **limits,
    )
