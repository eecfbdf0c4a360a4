"""Normal forms: power series against known ones, the equations against the kernel, and derivatives by differences."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.orbits import normal_form
from rocking.orbits.event_chain import chain_of, equations
from rocking.orbits.normal_form import cosine_and_sine, exponential, product, quotient

BRACED = rk.System(rk.Harmonic(4.0, period=1.0), 0.8, rk.Braces(0.3, 0.7))
DAMPED = rk.System(rk.Harmonic(2.2, period=2.0), 0.91)


def chains(system, period):
    return [
        chain_of(orbit)
        for orbit in rk.find_orbits(system, period)
        if (orbit.impacts or orbit.brace_hits) and not orbit.superstable
    ]


@pytest.fixture(scope="module")
def found():
    """Chains of two systems, each with its parameters in a row."""
    return [
        (chain, np.append(chain.phases, [system.forcing.period, system.forcing.amplitude])[None])
        for system in (BRACED, DAMPED)
        for chain in chains(system, 3)
    ]


def test_series_are_those_of_taylor():
    t = np.zeros((1, 6))
    t[0, 1] = 1.0
    factorials = np.array([math.factorial(m) for m in range(6)], float)
    powers = np.arange(6)
    np.testing.assert_allclose(exponential(2.0 * t)[0], 2.0**powers / factorials, rtol=1e-15)
    cosine, sine = cosine_and_sine(t)
    np.testing.assert_allclose(cosine[0] * factorials, [1, 0, -1, 0, 1, 0], atol=1e-15)
    np.testing.assert_allclose(sine[0] * factorials, [0, 1, 0, -1, 0, 1], atol=1e-15)
    one = np.eye(1, 6)
    np.testing.assert_allclose(quotient(one, one - t)[0], np.ones(6))
    np.testing.assert_allclose(product(one - t, one + t)[0], [1, 0, -1, 0, 0, 0])


def test_series_of_the_equations_are_those_of_the_kernel(found):
    assert {chain.mirrored for chain, _ in found} == {True, False}
    for chain, row in found:
        many = normal_form.chains_of(chain, ("period", "amplitude"), row)
        wanted = equations(chain, "amplitude", np.append(chain.phases, row[0, -1]))[0][:, :-1]
        np.testing.assert_allclose(
            normal_form.jacobians(many)[0], wanted, rtol=0, atol=1e-12 * np.abs(wanted).max()
        )
        assert np.abs(normal_form.residuals(many, many.phases[..., None])).max() < 1e-10


def test_higher_derivatives_are_those_of_the_exact_jacobian_by_differences(found):
    """Central differences of the Jacobian of the kernel, of the best of several steps."""
    random = np.random.default_rng(3)
    for chain, row in found:
        many = normal_form.chains_of(chain, ("period", "amplitude"), row)
        direction = random.standard_normal(len(chain.phases))
        series = np.zeros((1, len(direction), 4))
        series[0, :, 0], series[0, :, 1] = chain.phases, direction
        second, third = (normal_form.residuals(many, series)[0, :, m] for m in (2, 3))
        shortest = equations(chain, "amplitude", np.append(chain.phases, row[0, -1]))[1]["time"].min()

        def jacobian(step, chain=chain, row=row, direction=direction):
            there = np.append(chain.phases + step * direction, row[0, -1])
            return equations(chain, "amplitude", there)[0][:, :-1]

        off = []
        for h in shortest * np.array([1e-2, 3e-3, 1e-3, 3e-4]):
            slope = (jacobian(h) - jacobian(-h)) @ direction / (2.0 * h)
            bend = (jacobian(h) + jacobian(-h) - 2.0 * jacobian(0.0)) @ direction / h**2
            off.append(
                max(
                    np.abs(0.5 * slope - second).max() / np.abs(second).max(),
                    np.abs(bend / 6.0 - third).max() / np.abs(third).max(),
                )
            )
        assert min(off) < 1e-4


def test_determinant_is_the_test_function_times_a_product(found):
    for chain, row in found:
        there = np.append(chain.phases, row[0, -1])
        jacobian, links, trace, determinant = equations(chain, "amplitude", there)
        slopes = links["arrives"] / (chain.system.forcing.frequency * links["sinh"])
        sign = (-1.0) ** (len(slopes) - 1)
        wanted = sign * np.prod(slopes) * (1.0 - trace + determinant)
        assert np.linalg.det(jacobian[:, :-1]) == pytest.approx(wanted, rel=1e-9)


def test_sign_of_a_fold_is_kept_along_its_curve():
    folds = [
        special
        for system in (BRACED, DAMPED)
        for orbit in rk.find_orbits(system, 2)
        if orbit.impacts
        for special in rk.continue_orbit(orbit, "amplitude", (0.3, 15.0)).special
        if special.kind == "fold"
    ]
    assert folds
    for special in folds:
        curve = rk.bifurcation_curve(special, "period", "amplitude", ((0.8, 2.5), (0.5, 8.0)), max_points=500)
        cusps = [point.index for point in curve.special if point.kind == "cusp"]
        assert (np.flatnonzero(np.diff(np.sign(curve.coefficients))) + 1).tolist() == cusps


def test_without_a_length_of_an_arc_there_is_no_value():
    chain, row = next(
        (chain, np.append(chain.phases, [2.0, 2.2])[None])
        for chain in chains(DAMPED, 2)
        if len(chain.kinds) > 1
    )
    row = row.copy()
    row[0, 1] = row[0, 0]
    with np.errstate(all="ignore"):
        found = normal_form.doublings(normal_form.chains_of(chain, ("period", "amplitude"), row))
    assert np.isnan(found.values).all()
