"""Basins: each initial state leads to the end of its own motion, and orbits distinguish attractors."""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import rocking as rk
from surveyed import system_with

# a symmetric orbit and a pair of mirror images, found by marching from many initial states
PAIR = rk.System(rk.Harmonic(amplitude=8.0, period=1.721328), 0.8, rk.Braces(1.0, 0.8))
SMOOTH = rk.System(rk.Harmonic(amplitude=3.5, period=1.0), 0.8)
MANY = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), 0.925)
RESTING = rk.System(rk.Harmonic(amplitude=0.378, period=2.0), 0.925)
LEANING = rk.System(rk.Harmonic(amplitude=0.5, period=1.0), 0.5, rk.Braces(3.0, 0.3))
LATE = 600


def grid(system, reach=0.97, count=9, **options):
    starts = np.linspace(-reach, reach, count)
    return rk.basin_map(system, angle=starts, velocity=starts, boundary_runs=0, **options)


def late_states(system, start, phase):
    """States of the motion itself at that phase, after its transient."""
    return rk.simulate(system, start, cycles=LATE, record="section").section(phase)[-64:]


@pytest.mark.parametrize("system", [PAIR, MANY], ids=["pair", "many"])
def test_every_start_ends_on_the_orbit_of_its_attractor_and_on_no_other(system):
    found = grid(system)
    data = found.dataset
    for index in np.ndindex(data.attractor.shape):
        velocity, angle = data.velocity.values[index[0]], data.angle.values[index[1]]
        mine = int(data.attractor.transpose("velocity", "angle").values[index])
        start = rk.State(float(angle), float(velocity))
        if found.attractors[mine].kind == "overturned":
            assert rk.simulate(system, start, cycles=LATE, record="none").outcome == "overturned"
            continue
        for number, each in enumerate(found.attractors):
            if each.orbit is None:
                continue
            states = late_states(system, start, each.orbit.phase)
            away = np.hypot(
                states[:, 0] - each.orbit.state.angle, states[:, 1] - each.orbit.state.velocity
            ).min()
            # the slowest of these orbits has multipliers of size .9 a cycle: e^-60 of the transient is left
            assert (away < 1e-8) == (number == mine), (start, each.name)


def test_two_mirror_images_are_two_attractors():
    found = grid(PAIR, count=15)
    a, b = (each.orbit for each in found.attractors if each.name.startswith("period 1, asymmetric ("))
    forcing = PAIR.forcing
    half_later = rk.System(
        rk.Harmonic(forcing.amplitude, period=forcing.period, phase=a.phase + math.pi), 0.8, PAIR.braces
    )
    # the mirror image of a motion is a motion half a forcing cycle later
    mirror = rk.simulate(half_later, rk.State(-a.state.angle, -a.state.velocity), cycles=40)
    states = mirror.section(b.phase)[-5:]
    assert np.abs(states - [b.state.angle, b.state.velocity]).max() < 1e-9
    same = rk.System(rk.Harmonic(forcing.amplitude, period=forcing.period, phase=a.phase), 0.8, PAIR.braces)
    own = rk.simulate(same, a.state, cycles=40).section(b.phase)[-5:]
    assert np.abs(own - [b.state.angle, b.state.velocity]).max() > 0.1


# just before a cascade of doublings ends: chaos around either of two mirror images
CHAOTIC_PAIR = rk.System(rk.Harmonic(amplitude=10.74, period=1.721328), 0.8)


def test_two_chaotic_attractors_that_are_mirror_images_are_two():
    found = grid(CHAOTIC_PAIR, 0.9, 16, max_cycles=10_000)
    pair = [each for each in found.attractors if each.kind == "chaotic"]
    assert sorted(each.name for each in pair) == ["chaotic (a)", "chaotic (b)"]
    labels = {each.name: number for number, each in enumerate(found.attractors)}
    means, mirrored = [], []
    for each in pair:
        mine = found.dataset.attractor.values == labels[each.name]
        means.append(found.dataset.mean_angle.values[mine])
        motion = rk.simulate(CHAOTIC_PAIR, each.verdict.start, cycles=20_000)
        mirrored.append(-motion.section(math.pi)[10_000:, 0].mean())
    assert min(map(len, means)) >= 3
    # means of 5,000 cycles scatter by some 1e-4
    assert max(map(np.ptp, means)) < 0.005
    assert np.mean(means[0]) == pytest.approx(mirrored[1], abs=0.005)
    assert np.mean(means[1]) == pytest.approx(mirrored[0], abs=0.005)
    assert abs(mirrored[0] - mirrored[1]) > 1.0


def test_one_chaotic_attractor_is_one_from_wherever_it_is_reached():
    """Between braces there is one, which is its own mirror image."""
    braced = rk.System(rk.Harmonic(amplitude=15.0, period=2.0), 0.925, rk.Braces(1.0))
    found = grid(braced, 0.9, 3, max_cycles=100_000)
    assert [each.name for each in found.attractors] == ["chaotic"]


def test_a_mirrored_base_has_mirrored_basins():
    one = grid(MANY, count=25)
    turned = rk.System(rk.Harmonic(amplitude=2.0, period=1.0, phase=math.pi), 0.925)
    other = grid(turned, count=25)
    kinds, mirrored = (each.dataset.response_period.values for each in (one, other))
    # but where the motion rounds otherwise: at a boundary
    assert np.mean(kinds == mirrored[::-1, ::-1]) > 0.99


def test_rest_is_one_attractor_and_leaning_on_either_brace_is_another():
    assert "rest" in {each.name for each in grid(RESTING, count=25).attractors}
    names = {each.name: each for each in grid(LEANING, 2.5, 15).attractors}
    assert {"rest", "leaning (a)", "leaning (b)"} <= names.keys()
    ends = [rk.simulate(LEANING, names[f"leaning ({c})"].verdict.start, cycles=200).final.angle for c in "ab"]
    assert sorted(ends) == [-3.0, 3.0]


def test_fractions_count_the_starts_and_flags_name_the_attractors():
    found = grid(MANY, count=21)
    places = found.dataset.attractor
    assert [share.count for share in found.fractions] == np.bincount(places.values.ravel()).tolist()
    assert sum(share.count for share in found.fractions) == 441 == found.fractions[0].of
    assert places.attrs["flag_meanings"].split()[0] == found.attractors[0].name.replace(", ", "-")
    fallen = np.count_nonzero(found.dataset.kind.values == 4)
    assert found.safe.count == 441 - fallen
    assert str(found).startswith("441 initial states: ")


def test_what_is_undetermined_may_lead_to_any_of_the_others():
    found = grid(CHAOTIC_PAIR, 0.9, 9, max_cycles=100)
    shares = {each.name: share for each, share in zip(found.attractors, found.fractions, strict=True)}
    undetermined = shares.pop("undetermined")
    assert 0 < undetermined.count < 81
    assert undetermined.unknown == 0
    assert {share.unknown for share in shares.values()} == {undetermined.count}


def test_random_starts_are_those_of_the_seed_whoever_computes():
    how = {"angle": (-1, 1), "velocity": (-0.5, 0.5), "samples": 3000, "boundary_runs": 2000}
    one = rk.basin_map(MANY, **how, seed=4)
    with ThreadPoolExecutor(3) as pool:
        other = rk.basin_map(MANY, **how, seed=4, executor=pool)
    assert one.dataset.identical(other.dataset)
    assert one.uncertainty_exponent == other.uncertainty_exponent
    assert not one.dataset.identical(rk.basin_map(MANY, **how, seed=5).dataset)
    drawn = one.dataset
    assert abs(drawn.angle.values).max() <= 1
    assert abs(drawn.velocity.values).max() <= 0.5


def test_a_basin_map_in_a_store_is_the_same(tmp_path):
    starts = np.linspace(-1, 1, 40)
    how = {"angle": starts, "velocity": starts, "boundary_runs": 0}
    kept, plain = rk.basin_map(MANY, **how, store=tmp_path / "basins.zarr"), rk.basin_map(MANY, **how)
    assert kept.fractions == plain.fractions
    assert (kept.dataset.attractor.values == plain.dataset.attractor.values).all()


def test_the_safe_area_is_what_the_motions_themselves_say():
    random = np.random.default_rng(7)
    starts = random.uniform((-1, -1), (1, 1), (60, 2))
    found = rk.safe_basin(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.8), amplitude=[3.3, 5.5], samples=60, seed=7
    )
    for amplitude, share in zip((3.3, 5.5), found.shares, strict=True):
        system = rk.System(rk.Harmonic(amplitude=amplitude, period=1.0), 0.8)
        outcomes = [
            rk.simulate(system, rk.State(*each), cycles=500, record="none").outcome for each in starts
        ]
        assert share.count == sum(each != "overturned" for each in outcomes)


def test_the_safe_area_is_that_of_the_frequency_the_phase_and_the_box_asked_for():
    starts = np.random.default_rng(5).uniform((-0.4, -0.9), (0.3, 0.2), (60, 2))
    system = system_with(frequency=5.0, phase=1.0, restitution=0.8)
    found = rk.safe_basin(
        system, amplitude=[0.5, 6.0], angle=(-0.4, 0.3), velocity=(-0.9, 0.2), samples=60, seed=5
    )
    for amplitude, share in zip((0.5, 6.0), found.shares, strict=True):
        system = rk.System(rk.Harmonic(amplitude, frequency=5.0, phase=1.0), 0.8)
        outcomes = [
            rk.simulate(system, rk.State(*each), cycles=500, record="none").outcome for each in starts
        ]
        assert 0 < share.count == sum(each != "overturned" for each in outcomes) < 60


def test_between_braces_every_start_is_safe():
    braced = system_with(restitution=0.8, brace_angle=0.5, brace_restitution=0.7)
    asked = {"system": braced, "amplitude": [3.0, 6.0], "samples": 20}
    found = rk.safe_basin(**asked, angle=(-0.5, 0.5), max_cycles=200)
    assert [share.count for share in found.shares] == [20, 20]
    assert found.dataset.attrs["brace_restitution"] == 0.7
    assert np.isnan([found.heteroclinic_amplitude, found.melnikov_amplitude]).all()
    assert "A*" not in str(found)
    assert [line.get_gid() for line in rk.plot.safe_basin(found).lines] == ["safe"]
    with pytest.raises(
        ValueError, match=r"^angle must be a pair \(low, high\) in \[-0.5, 0.5\] with low < high"
    ):
        rk.safe_basin(**asked)


@pytest.mark.parametrize("kind", [{"critical_angle": 0.25}, {"left": rk.LeftSide(1.3, 0.99, 0.8)}], ids=str)
def test_closed_forms_are_those_of_the_slender_symmetric_block_alone(kind):
    system = rk.System(rk.Harmonic(4.0, period=1.0), 0.8, **kind)
    found = rk.safe_basin(system, amplitude=[3.0, 6.0], samples=20, max_cycles=100)
    assert np.isnan([found.heteroclinic_amplitude, found.melnikov_amplitude]).all()
    assert "A*" not in str(found)


def test_the_safe_area_need_not_fall_above_the_tangency():
    tangency = rk.theory.heteroclinic_amplitude(1.0, 0.8)
    found = rk.safe_basin(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.8),
        amplitude=tangency * np.array([0.9, 1.0, 1.5, 2.0, 3.0]),
        max_cycles=1000,
    )
    # areas known to two digits, from a grid
    for share, known in zip(found.shares, (0.70, 0.69, 0.65, 0.63, 0.68), strict=True):
        assert share.low - 0.005 <= known <= share.high + 0.005
    assert found.shares[4].low > found.shares[3].high
    assert found.heteroclinic_amplitude == tangency
    assert found.melnikov_amplitude == rk.theory.melnikov_amplitude(1.0, 0.8)
    assert found.dataset.attrs["heteroclinic_amplitude"] == tangency


def test_a_safe_basin_needs_amplitudes():
    with pytest.raises(TypeError, match="amplitude must be an axis, an ascending array"):
        rk.safe_basin(system_with(restitution=0.8), amplitude=1.0)
    with pytest.raises(TypeError, match="a safe basin needs one quantity as an array; got none"):
        rk.safe_basin(system_with(restitution=0.8), amplitude=None)


def test_what_is_drawn_at_random_can_be_drawn_again_from_what_the_dataset_says():
    asked = {"angle": (-0.4, 0.3), "velocity": (-0.2, 0.5), "samples": 20, "seed": 7}
    told = rk.safe_basin(system_with(restitution=0.8), amplitude=[3.0, 6.0], **asked).dataset.attrs
    assert {name: told[name] for name in ("samples", "seed", "angle_range", "velocity_range")} == {
        "samples": 20,
        "seed": 7,
        "angle_range": [-0.4, 0.3],
        "velocity_range": [-0.2, 0.5],
    }
    system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), 0.925)
    found = rk.basin_map(system, **asked, boundary_runs=0).dataset
    assert found.attrs["seed"] == 7


def test_runs_are_added_until_the_intervals_are_as_narrow_as_wanted(capsys):
    how = {"angle": (-1, 1), "velocity": (-1, 1), "samples": 500, "seed": 2}
    few = rk.basin_map(SMOOTH, **how, boundary_runs=6_000)
    more = rk.basin_map(SMOOTH, **how, boundary_runs=6_000, boundary_width=0.3)
    widths = [
        max(
            one.high - one.low
            for one in (found.uncertainty_exponent, found.attractor_exponent)
            if one is not None
        )
        for found in (few, more)
    ]
    assert widths[0] > 0.3 >= widths[1]
    counts = [found.attractor_exponent.uncertain[0].of for found in (few, more)]
    assert counts[0] == 6_000 // 24 < counts[1]
    enough = [
        rk.basin_map(SMOOTH, **how, boundary_runs=30_000, boundary_width=width) for width in (None, 1.0)
    ]
    assert enough[0].attractor_exponent == enough[1].attractor_exponent
    assert capsys.readouterr().err == ""


@pytest.mark.long
def test_no_runs_are_added_that_do_not_narrow_an_interval():
    """The fractions of this system follow no power law. So the interval is as wide as they scatter, however many runs there are."""
    found = rk.basin_map(
        MANY, angle=(-1, 1), velocity=(-1, 1), samples=500, seed=2, boundary_runs=6_000, boundary_width=0.05
    )
    assert found.attractor_exponent.misfit > 2
    assert found.attractor_exponent.uncertain[0].of < 100_000


def test_progress_shows_random_states_and_boundary_runs(terminal):
    rk.basin_map(MANY, angle=(-1, 1), velocity=(-1, 1), samples=500, boundary_runs=3_000, progress=True)
    title, states, runs = terminal()
    assert title.startswith("500 points in ")
    assert "100 % in 0:00" in states
    assert "boundary runs 100 %" in runs


def test_progress_of_a_safe_basin_counts_the_states_of_all_amplitudes(terminal):
    given = {"system": system_with(restitution=0.8), "amplitude": [3.0, 6.0], "samples": 300}
    quiet = rk.safe_basin(**given)
    assert terminal() == [""]
    assert rk.safe_basin(**given, progress=True).shares == quiet.shares
    title, last = terminal()
    assert title.startswith("600 points in ")
    assert "100 % in 0:00" in last
