"""The contact of a grazing is found on the arcs of the orbit, and its curve can be followed."""

import attrs
import numpy as np
import pytest

import rocking as rk

# orbits whose contact was not found in a simulation, which rounding takes off the orbit or past the contact
SYSTEMS = {
    "two arcs": (
        rk.System(rk.Harmonic(13.356028052237159, period=1.7307362242206676), 0.7),
        "amplitude",
    ),
    "short arcs": (rk.System(rk.Harmonic(3.0884761140766495, period=1.119917130517964), 0.9), "period"),
    "braces": (
        rk.System(
            rk.Harmonic(12.924870162281735, period=1.993808582737905),
            0.925,
            rk.Braces(0.6814481895860237, 0.8),
        ),
        "period",
    ),
}
RANGES = {"amplitude": (1.0, 16.0), "period": (0.3, 3.2)}


@pytest.fixture(scope="module", params=SYSTEMS)
def grazings(request):
    """The grazings of the branches of all orbits up to period 3 that have impacts at the contact."""
    system, name = SYSTEMS[request.param]
    found = []
    for orbit in rk.find_orbits(system, 3, effort=0.1):
        if not orbit.superstable and (orbit.impacts or orbit.brace_hits):
            branch = rk.continue_orbit(orbit, name, RANGES[name])
            found += [point for point in branch.special if point.kind == "grazing"]
    return [point for point in found if point.orbit.impacts or point.orbit.brace_hits]


def clearance(orbit):
    """Least distance of a turning point of the orbit from Θ = 0 or a brace, by dense samples of short motions."""
    phases = np.linspace(0.0, 2.0 * np.pi * orbit.period, 60 * orbit.period, endpoint=False)
    reach = np.inf if orbit.system.braces is None else orbit.system.braces.angle
    least = np.inf
    for phase in phases:
        start = orbit.at(phase)
        forcing = rk.Harmonic(orbit.system.forcing.amplitude, period=orbit.system.forcing.period, phase=phase)
        motion = rk.simulate(
            rk.System(forcing, orbit.system.restitution, orbit.system.braces), start, cycles=1
        )
        times = np.linspace(0.0, 2.2 * forcing.period / 60, 401)
        size = np.abs(motion.at(times)[0])
        inner = size[1:-1]
        turns = (inner - size[:-2]) * (inner - size[2:]) > 0.0
        events = motion.events["time"]
        slow = motion.events[(events < times[-1]) & (np.abs(motion.events["before"]) < 1e-3)]
        if len(slow):
            least = 0.0
        least = min([least, *inner[turns], *np.abs(reach - inner[turns])])
    return least


def test_each_grazing_touches_and_its_curve_is_followed(grazings):
    assert grazings
    for point in grazings[:12]:
        here = point.orbit.system.forcing
        bounds = tuple((0.98 * value, 1.02 * value) for value in (here.period, here.amplitude))
        curve = rk.bifurcation_curve(point, "period", "amplitude", bounds)
        assert len(curve) > 2
        assert clearance(point.orbit) < 1e-5


def test_a_grazing_without_a_contact_is_refused_for_this_reason_and_not_for_having_no_event(grazings):
    point = attrs.evolve(grazings[0], touch=None)
    with pytest.raises(ValueError, match="^special must be a grazing whose contact is located; it is not"):
        rk.bifurcation_curve(point, "period", "amplitude", ((0.3, 3.2), (1.0, 16.0)))
