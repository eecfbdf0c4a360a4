"""Comparison of a motion of the slender block with that of the full one, on request."""

import math

import pytest

import rocking as rk

BLOCK = rk.Block(height=2.0, width=1.0)
BASES = {
    "harmonic": {"acceleration": 6.0, "frequency_hz": 1.2},
    "ground motion": {"ground": rk.synthetic_ground_motions(1, seed=3)[0].scaled(pga=8.0)},
    "pulse": {"ground": rk.Pulse("one-sine", amplitude=8.0, duration=0.8)},
}


def system(name, model):
    given = dict(BASES[name])
    base = given.pop("ground", None)
    return BLOCK.system(model=model, **given) if base is None else BLOCK.system(base, model=model)


@pytest.mark.parametrize("name", BASES)
def test_comparison_is_a_simulation_of_the_full_block(name):
    cycles = {"cycles": 30} if name == "harmonic" else {}
    slender, full = (rk.simulate(system(name, model), **cycles) for model in ("slender", "full"))
    found = slender.validity(BLOCK, full=True)
    assert found.full_outcome == full.outcome
    expected = math.inf if full.outcome == "overturned" else BLOCK.critical_angle * full.peak
    assert found.full_angle == pytest.approx(expected, rel=1e-12)
    line = next(line for line in str(found).splitlines() if line.startswith("full equation of motion: "))
    assert str(full.outcome) in line
    if full.outcome != "overturned" != slender.outcome:
        assert f"{full.peak / slender.peak - 1:+.1%} from that of the slender block" in line


def test_comparison_of_a_fall_says_that_the_full_block_overturns_too():
    found = rk.simulate(BLOCK.system(acceleration=40.0, frequency_hz=0.5)).validity(BLOCK, full=True)
    assert found.full_angle == math.inf
    assert "full equation of motion: overturned" in str(found).splitlines()


def test_energy_decides_the_comparison_without_losses():
    """The full block comes down with more energy than its barrier has, after the pulse; the slender one with less."""
    block = rk.Block(height=2.0, width=1.0, restitution=1.0)
    base, start = rk.Pulse("half-sine", amplitude=1e-4, duration=0.1), rk.State(0.3, -0.698)
    slender, full = (
        rk.simulate(rk.System(base, 1.0, critical_angle=angle), start)
        for angle in (None, block.critical_angle)
    )
    assert (slender.outcome, full.outcome) == ("bounded", "overturned")
    assert slender.validity(block, full=True).full_outcome == "overturned"


def test_without_the_request_nothing_is_compared():
    found = rk.simulate(system("harmonic", "slender"), cycles=10).validity(BLOCK)
    assert (found.full_angle, found.full_outcome) == (None, None)
    assert "full equation" not in str(found)


def test_motion_of_a_full_block_is_not_compared_with_itself():
    with pytest.raises(ValueError, match="full must be False for a motion by the full equation; got True"):
        rk.simulate(system("harmonic", "full"), cycles=10).validity(BLOCK, full=True)
