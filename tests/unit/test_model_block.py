"""A block in metres and seconds against rigid-body mechanics written out independently: Yim & Lin 1991, eqs. (1)-(4)."""

import math

import attrs
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import rocking as rk

GRAVITY = 9.80665
BLOCK = rk.Block(height=2.0, width=0.5)


def piecewise_solution(system, time):
    """Θ and Θ' of eq. (5) on the positive side, from Θ = 0.2, Θ' = 0.3 at τ = 0."""
    forcing = system.forcing
    beta = forcing.amplitude / (1 + forcing.frequency**2)
    psi = forcing.frequency * time + forcing.phase
    b = 0.2 - 1 - beta * math.cos(forcing.phase)
    a = 0.3 + beta * forcing.frequency * math.sin(forcing.phase)
    angle = a * np.sinh(time) + b * np.cosh(time) + 1 + beta * np.cos(psi)
    return angle, a * np.cosh(time) + b * np.sinh(time) - beta * forcing.frequency * np.sin(psi)


@pytest.mark.parametrize("inertia_ratio", [4 / 3, 1.6])
def test_normalised_solution_converted_to_si_obeys_equation_1a(inertia_ratio):
    height, width, acceleration, hertz, phase = 3.1, 0.7, 2.5, 1.3, 0.4
    block = rk.Block(height, width, restitution=0.9, inertia_ratio=inertia_ratio)
    system = block.system(acceleration=acceleration, frequency_hz=hertz, phase=phase)

    radius, critical = math.sqrt(height**2 + width**2) / 2, math.atan(width / height)

    def equation_1a(t, state):
        base = acceleration * math.cos(2 * math.pi * hertz * t + phase)
        moment = radius * base + GRAVITY * radius * (critical - state[0])
        return state[1], -moment / (inertia_ratio * radius**2)

    seconds = np.linspace(0, 1.5, 31)
    start = [block.radians(0.2), block.radians_per_second(0.3)]
    integrated = solve_ivp(
        equation_1a, (0, 1.5), start, method="DOP853", rtol=1e-12, atol=1e-14, t_eval=seconds
    ).y
    angle, velocity = piecewise_solution(system, block.time(seconds))
    # The integrator keeps 1e-12 a step; the saddle amplifies that by e^{αt} < 30, some hundred steps add up.
    np.testing.assert_allclose(block.radians(angle), integrated[0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(block.radians_per_second(velocity), integrated[1], rtol=0, atol=1e-8)


@pytest.mark.parametrize(("height", "width"), [(2.0, 0.5), (1.0, 0.9), (30.0, 1.0)])
@pytest.mark.parametrize("inertia_ratio", [1.0, 4 / 3, 2.5])
def test_housners_restitution_conserves_angular_momentum_about_the_corner_that_is_hit(
    height, width, inertia_ratio
):
    squared_radius = (height**2 + width**2) / 4
    central = (inertia_ratio - 1) * squared_radius  # per unit mass, about the centre
    from_old, from_new = np.array([-width / 2, height / 2]), np.array([width / 2, height / 2])
    velocity = np.array(
        [-from_old[1], from_old[0]]
    )  # of the centre, turning about the old corner at unit rate
    before = central + from_new[0] * velocity[1] - from_new[1] * velocity[0]
    expected = before / (central + squared_radius)
    found = rk.Block(height, width, restitution=0.5, inertia_ratio=inertia_ratio).housner_restitution
    assert found == pytest.approx(expected, abs=4e-16)


def test_uniform_rectangle_has_frequency_parameter_from_its_moment_of_inertia():
    about_corner = (2.0**2 + 0.5**2) / 3  # Io/M of a uniform rectangle
    assert BLOCK.frequency_parameter == pytest.approx(
        math.sqrt(GRAVITY * BLOCK.radius / about_corner), rel=4e-16, abs=0
    )


def test_restitution_is_housners_unless_chosen_and_the_repr_says_which():
    assert BLOCK.restitution == pytest.approx(1 - 1.5 * 0.25 / 4.25, rel=1e-15, abs=0)
    assert repr(BLOCK) == "Block(height=2.0 m, width=0.5 m, restitution=0.911765 by Housner's formula)"
    chosen = attrs.evolve(BLOCK, restitution=0.9)
    assert chosen.restitution == 0.9
    assert repr(chosen) == "Block(height=2.0 m, width=0.5 m, restitution=0.9 as chosen)"
    assert chosen.system(acceleration=1, period_s=1).restitution == 0.9


def test_evolved_block_gets_the_housner_restitution_of_its_new_shape():
    assert attrs.evolve(BLOCK, width=0.25) == rk.Block(2.0, 0.25)


CONVERSIONS = {
    "degrees": (BLOCK.degrees, lambda x: BLOCK.angle(degrees=x)),
    "radians": (BLOCK.radians, lambda x: BLOCK.angle(radians=x)),
    "top displacement": (BLOCK.top_displacement, lambda x: BLOCK.angle(top_displacement=x)),
    "angular velocity": (BLOCK.radians_per_second, BLOCK.velocity),
    "time": (BLOCK.seconds, BLOCK.time),
    "frequency": (BLOCK.hertz, BLOCK.frequency),
    "acceleration": (BLOCK.acceleration, BLOCK.amplitude),
}


@pytest.mark.parametrize("name", CONVERSIONS)
@given(st.floats(-3, 3))
def test_conversion_to_si_and_back_is_the_identity(name, value):
    there, back = CONVERSIONS[name]
    assert back(there(value)) == pytest.approx(value, rel=1e-13, abs=1e-300)


@pytest.mark.parametrize("name", CONVERSIONS)
def test_conversions_keep_the_shape_of_arrays(name):
    there, back = CONVERSIONS[name]
    values = np.linspace(-1, 1, 6).reshape(2, 3)
    assert there(values).shape == (2, 3)
    np.testing.assert_allclose(back(there(values)), values, rtol=1e-13)
    assert isinstance(there(1), float)


def test_units_of_conversions():
    assert BLOCK.degrees(1.0) == pytest.approx(math.degrees(math.atan(0.25)))
    assert BLOCK.top_displacement(1.0) == pytest.approx(2.0 * 0.5 / math.hypot(2.0, 0.5))  # H sin θcr
    assert BLOCK.acceleration(1.0) == pytest.approx(GRAVITY * math.atan(0.25))
    assert BLOCK.seconds(BLOCK.frequency_parameter) == pytest.approx(1.0)


def test_base_motion_is_the_same_however_it_is_given():
    reference = BLOCK.system(acceleration=3.0, frequency_hz=1.25).forcing
    omega = 2 * math.pi * 1.25
    for given_as in (
        {"acceleration_g": 3.0 / GRAVITY, "frequency_hz": 1.25},
        {"displacement": 3.0 / omega**2, "period_s": 0.8},
    ):
        forcing = BLOCK.system(**given_as).forcing
        assert forcing.amplitude == pytest.approx(reference.amplitude, rel=1e-15, abs=0)
        assert forcing.frequency == pytest.approx(reference.frequency, rel=1e-15, abs=0)


@pytest.mark.parametrize("end", [0, 1])
def test_ends_of_the_normalised_ranges_are_allowed_in_si(end):
    hertz = BLOCK.hertz((1e-3, 1e3)[end])
    acceleration = BLOCK.acceleration((0.0, 1e3)[end])
    for rate in ({"frequency_hz": hertz}, {"period_s": 1 / hertz}):
        forcing = BLOCK.system(acceleration=acceleration, **rate).forcing
        assert (forcing.amplitude, forcing.frequency) == pytest.approx(((0.0, 1e3)[end], (1e-3, 1e3)[end]))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rk.Block(0, 1), "height must lie in [0.001, 1000] m; got 0"),
        (lambda: rk.Block(1, -0.5), "width must lie in [0.001, 1000] m; got -0.5"),
        (lambda: rk.Block(2, 0.5, inertia_ratio=0.5), "inertia_ratio must lie in [1, 10]; got 0.5"),
        (lambda: rk.Block(2, 0.5, restitution=1.2), "restitution must lie in [0, 1]; got 1.2"),
        (
            lambda: rk.Block(1, 2),
            (
                "restitution must lie in [0, 1]; got -0.2 by Housner's formula for a block 1 m high and 2 m wide "
                "(are height and width swapped, or in another unit? If not, give restitution)"
            ),
        ),
        (
            lambda: BLOCK.system(acceleration=-1, period_s=1),
            "acceleration must lie in [0, 2402.42] m/s²; got -1",
        ),
        (
            lambda: BLOCK.system(displacement=math.inf, period_s=1),
            "displacement must lie in [0, 60.854] m; got inf",
        ),
        (
            lambda: BLOCK.system(acceleration_g=1, period_s=0),
            "period_s must lie in [0.00235218, 2352.18] s; got 0",
        ),
        (
            lambda: BLOCK.system(acceleration=1, displacement=0.1, period_s=1),
            "give exactly one of acceleration, acceleration_g, displacement; got acceleration=1 and displacement=0.1",
        ),
        (lambda: BLOCK.system(acceleration=1), "give exactly one of frequency_hz, period_s; got none"),
        (lambda: BLOCK.degrees("x"), "angle must be a real number or an array of real numbers; got 'x'"),
        (lambda: BLOCK.seconds(True), "time must be a real number or an array of real numbers; got True"),
        (
            lambda: BLOCK.angle(top_displacement=[0, 3]),
            "top_displacement must lie in [-2, 2] m, the height; got [0, 3]",
        ),
        (BLOCK.angle, "give exactly one of radians, degrees, top_displacement; got none"),
    ],
)
def test_refusals_name_the_argument_its_value_and_what_is_allowed(call, message):
    with pytest.raises((ValueError, TypeError)) as caught:
        call()
    assert str(caught.value) == message


def test_squat_block_is_accepted_with_a_chosen_restitution():
    assert rk.Block(1, 2, restitution=0.3).restitution == 0.3
