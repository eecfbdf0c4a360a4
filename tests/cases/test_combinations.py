"""Every cell of the tables of the page on combinations: a tiny call returns, or refuses with the sentence of its letter."""

import re
from functools import cache
from pathlib import Path

import attrs
import numpy as np
import pytest

import rocking as rk
from rocking.orbits.special_points import SpecialPoint

PAGE = (Path(__file__).parents[2] / "docs" / "combinations.md").read_text(encoding="utf-8")


def tables():
    """Return the rows of every table of the page, each a dict by the heading of the column."""
    for lines in re.findall(r"(?:^\|.*\|\n)+", PAGE, re.MULTILINE):
        heading, _, *rows = (
            [cell.strip() for cell in line.strip("|\n").split(" | ")] for line in lines.splitlines()
        )
        yield [
            dict(
                zip(
                    (each.strip("| ") for each in heading),
                    (c.strip("| `") if k else c.strip("| ") for k, c in enumerate(row)),
                    strict=True,
                )
            )
            for row in rows
        ]


REASONS, _, HARMONIC, FINITE, BLOCKS = tables()
SENTENCES = {row["Letter"]: row["The sentence begins with"] for row in REASONS}

WAVE = rk.Harmonic(2.0, period=1.0)
WALL = rk.Wall(0.5)
BRACES, LEFT = rk.Braces(0.5, 0.9), rk.LeftSide(1.3, 0.99, 0.87)
KINDS = {
    "slender": {},
    "full": {"critical_angle": 0.25},
    "slender, braces": {"braces": BRACES},
    "full, braces": {"critical_angle": 0.25, "braces": BRACES},
    "full, table": {"critical_angle": 0.25, "restitution_table": [(1.0, 0.8)]},
    "slender, unsymmetric": {"left": LEFT},
    "full, unsymmetric": {"critical_angle": 0.25, "left": LEFT},
    "slender, wall": {"left": WALL, "restitution": 0.5},
    "full, wall": {"critical_angle": 0.25, "left": WALL, "restitution": 0.5},
    "full, restrained": {"critical_angle": 0.25, "stiffness_ratio": 0.3, "prestress_ratio": 0.2},
    "slender, restrained": {"block": rk.Block(2.0, 0.5, 0.9).restrained(4e4, 900.0, mass=600.0)},
}
AMPLITUDES = np.array([1.5, 2.0, 2.5])
FEW = {"samples": 10, "max_cycles": 200}


def of(kind, **changed):
    """Return the system of a kind under a harmonic base motion."""
    return rk.System(**{"forcing": WAVE, "restitution": 0.9, **KINDS[kind], **changed})


@cache
def orbit(kind):
    return rk.classify(of(kind)).orbit


@cache
def special(kind, wanted="symmetry-breaking"):
    """Return a special point; of blocks whose branches hold none in reach, one made by hand."""
    if of(kind).has_chains:
        followed = orbit(kind)
        if kind == "slender, braces":  # one that hits them
            near = rk.find_orbits(of(kind, forcing=rk.Harmonic(4.0, period=1.0)), 1, effort=0.1)
            followed = next(each for each in near if each.symmetric and each.brace_hits)
        branch = rk.continue_orbit(followed, "amplitude", (1.5, 40.0))
        first = branch.special[0]
        if wanted == "symmetry-breaking":
            return first
        born = rk.switch_branch(first, (1.5, 40.0))[0]
        return next(each for each in born.special if each.kind == wanted)
    return SpecialPoint(
        kind=wanted, parameter=2.0, orbit=orbit(kind), name="amplitude", index=0, chain=None, row=np.empty(0)
    )


def saddle(kind):
    """Return an unstable orbit of a block that has one with impacts, else the stable one."""
    if not of(kind).has_chains or kind == "slender, braces":
        return orbit(kind)
    system = of(kind, forcing=rk.Harmonic(amplitude=5.5, period=0.5), restitution=0.925)
    return next(each for each in rk.find_orbits(system, 3) if abs(each.multipliers[0]) > 1 and each.impacts)


PLANE = {"amplitude": [1.5, 2.0], "period": [0.8, 1.0]}
CALLS = {
    "`simulate`": lambda kind: rk.simulate(of(kind), cycles=20),
    "`classify`": lambda kind: rk.classify(of(kind)),
    "`lyapunov`": lambda kind: rk.lyapunov(of(kind), cycles=64),
    "`spectral_density`": lambda kind: rk.spectral_density(rk.simulate(of(kind), cycles=1000), transient=200),
    "`impact_section`": lambda kind: rk.impact_section(of(kind), cycles=10),
    "`find_orbit`": lambda kind: rk.find_orbit(of(kind), orbit(kind).start, 1),
    "`find_orbits`": lambda kind: rk.find_orbits(of(kind), 1, effort=0.01),
    "`continue_orbit`": lambda kind: rk.continue_orbit(orbit(kind), "amplitude", (1.99, 2.01), step=0.1),
    "`orbit_diagram`": lambda kind: rk.orbit_diagram(of(kind), amplitude=AMPLITUDES, transient=20, cycles=5),
    "`response_diagram`": lambda kind: rk.response_diagram(of(kind), amplitude=AMPLITUDES, max_cycles=200),
    "`parametric_map`": lambda kind: rk.parametric_map(of(kind), **PLANE, max_cycles=200),
    "`basin_map`": lambda kind: rk.basin_map(
        of(kind, forcing=rk.Harmonic(0.5, period=1.0)),
        angle=[-0.1, 0.1],
        velocity=[-0.1, 0.1],
        max_cycles=200,
        boundary_runs=0,
    ),
    "`safe_basin`": lambda kind: rk.safe_basin(of(kind), amplitude=[1.5, 2.0], angle=(-0.3, 0.3), **FEW),
    "`chaos_share`": lambda kind: rk.chaos_share(of(kind), **FEW),
    "`repeatability`": lambda kind: rk.repeatability(of(kind), **FEW),
    "`repeatability_map`": lambda kind: rk.repeatability_map(of(kind), **PLANE, **FEW),
    "`overturning_amplitude`": lambda kind: rk.overturning_amplitude(
        of(kind), amplitude=[2.0, 9.0, 40.0], phases=2, max_cycles=100
    ),
    "`switch_branch`": lambda kind: rk.switch_branch(special(kind), (1.6, 30.0)),
    "`bifurcation_curve`": lambda kind: rk.bifurcation_curve(
        special(kind), "amplitude", "period", ((1.5, 40.0), (0.9, 1.1)), step=0.1
    ),
    "`cascade`": lambda kind: rk.cascade(special(kind, "period-doubling"), (1.6, 40.0), doublings=2),
    "`bifurcation_set`": lambda kind: rk.bifurcation_set(
        of(kind), 1, grid=2, amplitude=(1.9, 2.1), period=(0.95, 1.05)
    ),
    "`frequency_response`": lambda kind: rk.frequency_response(
        of(kind), period=[0.9, 1.0, 1.1], modes=(1,), max_cycles=500
    ),
    "`saddle_manifolds`": lambda kind: rk.saddle_manifolds(of(kind), cycles=1),
    "`orbit_manifolds`": lambda kind: rk.orbit_manifolds(saddle(kind), length=0.01),
    "`tangency_amplitude`": lambda kind: rk.tangency_amplitude(of(kind)),
    "`horseshoe`": lambda kind: rk.horseshoe(of(kind)),
    "`prove`": lambda kind: rk.prove(orbit(kind)),
    "`simulate` under a pulse": lambda kind: rk.simulate(
        of(kind, forcing=rk.Pulse("one-sine", amplitude=2.0, duration=1.0))
    ),
    "`simulate` under samples": lambda kind: rk.simulate(
        of(kind, forcing=rk.PiecewiseLinear([0.0, 2.0, -2.0, 0.0], step=0.5))
    ),
    "`simulate` under samples, with vertical motion": lambda kind: rk.simulate(
        of(
            kind,
            forcing=rk.PiecewiseLinear([0.0, 2.0, -2.0, 0.0], step=0.5),
            vertical=rk.PiecewiseLinear([0.0, -0.3, 0.4, 0.0], step=0.5),
        )
    ),
    "`simulate` under a pulse, with vertical motion": lambda kind: rk.simulate(
        of(
            kind,
            forcing=rk.Pulse("one-sine", amplitude=2.0, duration=1.0),
            vertical=rk.PiecewiseLinear([0.0, -0.3, 0.4, 0.0], step=0.5),
        )
    ),
    "`overturning_spectrum`": lambda kind: rk.overturning_spectrum(
        of(kind, forcing=rk.Pulse("ricker", amplitude=2.0, duration=1.0)),
        amplitude=[1.0, 3.0],
        frequency=[3.0, 5.0],
    ),
}

RECORDS = rk.synthetic_ground_motions(2, seed=3)
LEVELS = [2.0, 6.0]


def block_of(kind):
    wall = WALL if "wall" in kind else None
    block = rk.Block(2.0, 0.5, offset=0.05 if "unsymmetric" in kind else 0.0, wall=wall)
    return block.restrained(4e4, 900.0, mass=600.0) if "restrained" in kind else block


def of_records(survey, **more):
    """Return the call of a survey of records in the kind of a column."""
    return lambda kind: survey(
        RECORDS, block_of(kind), LEVELS, intensity="pga", model=kind.split(",")[0], **more
    )


def valid(kind):
    block = block_of(kind)
    ground = RECORDS[0].scaled(pga=3.0)
    return rk.simulate(block.system(ground, model=kind.split(",")[0])).validity(block)


CALLS_OF_BLOCKS = {
    "`simulate` with `Motion.validity`": valid,
    "`rocking_spectrum`": of_records(rk.rocking_spectrum),
    "`incremental_dynamic_analysis`": of_records(rk.incremental_dynamic_analysis),
    "`overturning_set`": of_records(rk.overturning_set),
    "`fragility`": of_records(rk.fragility, replicates=100),
    "`fragility` of an uncertain block": of_records(
        rk.fragility, replicates=100, samples=2, width_spread=0.1
    ),
    "`sensitivity`": of_records(rk.sensitivity),
    "`assess`": of_records(rk.assess),
}
CELLS = [
    (row["Function"], kind, cell)
    for row in (*HARMONIC, *FINITE, *BLOCKS)
    for kind, cell in row.items()
    if kind != "Function"
]


def test_every_function_and_kind_of_the_page_is_tried():
    assert {name for name, _, _ in CELLS} == CALLS.keys() | CALLS_OF_BLOCKS.keys()
    assert {kind for _, kind, _ in CELLS} == KINDS.keys()
    assert {cell for _, _, cell in CELLS} == {"yes", *SENTENCES}


@pytest.mark.parametrize(("name", "kind", "cell"), CELLS, ids=lambda each: each.replace("`", ""))
def test_cell(name, kind, cell):
    call = (CALLS_OF_BLOCKS if name in CALLS_OF_BLOCKS else CALLS)[name]
    if cell == "yes":
        assert call(kind) is not None
        return
    with pytest.raises((TypeError, ValueError)) as caught:
        call(kind)
    sentence = str(caught.value)
    assert sentence.startswith(SENTENCES[cell])
    assert "\n" not in sentence


def test_unsymmetric_block_has_neither_braces_nor_a_table():
    for more in ({"braces": BRACES}, {"critical_angle": 0.25, "restitution_table": [(1.0, 0.8)]}):
        with pytest.raises(ValueError, match="left must be omitted with"):
            attrs.evolve(of("slender"), left=LEFT, **more)
