"""Arguments that no survey can have are refused in one line, before anything is computed."""

import math

import pytest

import rocking as rk
from made_results import BLOCK, RECORDS
from surveyed import system_with

POLARITIES = '"+", "-", "both" or "worse", or 1, -1 or [-1, 1]'

SYSTEM = system_with(restitution=0.9)
BRACED = system_with(restitution=0.9, brace_angle=1.0)
PULSED = rk.System(rk.Pulse("one-sine", amplitude=1.0, duration=1.0), 0.9)
OF_RECORDS = {"records": RECORDS, "block": BLOCK, "levels": [1.0, 2.0]}
PLANE = {"system": SYSTEM, "amplitude": [1.0, 2.0], "period": [1.0, 2.0]}
BOX = {"system": SYSTEM, "angle": (0, 1), "velocity": (0, 1)}
USUAL = {
    "parametric_map": PLANE,
    "basin_map": BOX | {"samples": 5},
    "overturning_amplitude": {"system": SYSTEM},
    "overturning_spectrum": {"system": PULSED, "amplitude": [1.0, 2.0], "frequency": [1.0, 2.0]},
    "chaos_share": {"system": SYSTEM},
    "repeatability": {"system": SYSTEM},
    "repeatability_map": PLANE,
    "rocking_spectrum": {"records": RECORDS[0]},
    **dict.fromkeys(
        ("fragility", "overturning_set", "incremental_dynamic_analysis", "sensitivity"), OF_RECORDS
    ),
}
PERIODS = "period must hold two numbers or more in [0.00628319, 6283.19], ascending; got"
AMPLITUDES = "amplitude must hold two numbers or more in [0, 1000], ascending; got"
AXES = "a parametric map needs two quantities as arrays; got"
AXIS = "must be an axis, an ascending array in"
LIKE = "(such as np.linspace(start, stop, count))"
GIVEN_TWICE = "give exactly one of period, frequency;"
UNBRACED = "brace_restitution must be used with brace_angle or a braced system;"
LIMITS = "limits must hold numbers in (0, 10], ascending; got"
WRONG = {
    "parametric_map": [
        ({"amplitude": []}, f"{AMPLITUDES} an empty array"),
        ({"amplitude": [1.0]}, f"{AMPLITUDES} an array of shape (1,) (a quantity that does not vary is no axis)"),
        ({"period": [2.0, 1.0]}, f"{PERIODS} 2.0 before 1.0 at index 1"),
        ({"period": [1.0, 2.0, 2.0]}, f"{PERIODS} 2.0 before 2.0 at index 2"),
        ({"amplitude": [1.0, math.nan]}, f"{AMPLITUDES} nan at index 1"),
        ({"amplitude": [-1.0, 2.0]}, f"{AMPLITUDES} -1.0 at index 0"),
        ({"amplitude": [[1.0, 2.0]]}, f"{AMPLITUDES} an array of shape (1, 2)"),
        ({"amplitude": [1.0, [2.0, 3.0]]}, f"{AMPLITUDES} [1.0, [2.0, 3.0]]"),
        ({"amplitude": ["a", "b"]}, f"{AMPLITUDES} ['a', 'b']"),
        ({"amplitude": "1:2"}, f"amplitude {AXIS} [0, 1000]; got '1:2' {LIKE}"),
        ({"store": ""}, "store must be the path of a folder; got ''"),
        ({"restitution": 0.5}, f"restitution {AXIS} [0, 1]; got 0.5 (a number is that of the system)"),
        ({"angle": 0.5}, f"angle {AXIS} [-1000, 1000]; got 0.5 (a number is that of the initial state)"),
        ({"restitution": {0.5, 0.9}}, f"restitution {AXIS} [0, 1]; got {{0.5, 0.9}} {LIKE}"),
        ({"restitution": [0.8, 0.9]}, f"{AXES} amplitude and restitution and period (the others are those of the system)"),
        ({"amplitude": None}, f"{AXES} period"),
        ({"amplitude": None, "period": None}, f"{AXES} none"),
        ({"start": rk.State(velocity=2e3)}, "velocity must lie in [-1000, 1000]; got 2000.0"),
        ({"system": 3}, "system must be a System; got 3 (…"),
        ({"start": 0.1}, "start must be a State; got 0.1 (…"),
        ({"amplitude": None, "frequency": [1.0, 2.0]}, f"{GIVEN_TWICE} got period=[1.0, 2.0] and frequency=[1.0, 2.0]"),
        ({"amplitude": None, "brace_restitution": [0.5, 1.0]}, f"{UNBRACED} got [0.5, 1.0]"),
        ({"system": system_with(brace_angle=0.6), "start": rk.State(-0.7)}, "angle must lie between the braces, in [-0.6, 0.6]; got -0.7"),
        ({"max_cycles": 0}, "max_cycles must be a whole number in [1, 100000000]; got 0"),
        ({"store": 5}, "store must be the path of a folder; got 5"),
        ({"executor": 2}, "executor must be an Executor; got 2"),
        ({"max_period": 2.5}, "max_period must be a whole number in [1, 10000]; got 2.5"),
    ],
    "basin_map": [
        ({"samples": None, "angle": [0.0, 1.0], "velocity": 0.5}, f"velocity {AXIS} [-1000, 1000]; got 0.5 (such as np.linspace(…"),
        ({"samples": None, "angle": [1.0, 0.0], "velocity": [0.0, 1.0]}, "angle must hold two numbers or more…"),
        ({"angle": 1.0}, "angle must be a pair (low, high)…"),
        ({"angle": (1, 0)}, "angle must be a pair (low, high)…"),
        ({"samples": 0}, "samples must be a whole number in [1, 10000000]…"),
        ({"seed": -1}, "seed must be a whole number…"),
        ({"repair": True}, "repair must be used with store…"),
        ({"repair": "x"}, "repair must be a bool; got 'x'"),
        ({"samples": None, "boundary_runs": 0.5}, "boundary_runs must be a whole number…"),
        ({"boundary_width": 0}, "boundary_width must lie in…"),
        ({"boundary_width": "a"}, "boundary_width must be a real number…"),
        ({"boundary_width": 0.1, "boundary_runs": 0}, "boundary_runs must be positive to be added to; got 0…"),
        ({"system": BRACED, "angle": (0, 2)}, "angle must lie between the braces, in [-1, 1]; got 2…"),
    ],
    "overturning_amplitude": [
        ({"amplitude": 2.0}, f"amplitude {AXIS} [0, 1000]; got 2.0 (such as np.linspace(…"),
        ({"restitution": 0.9}, f"restitution {AXIS} [0, 1]; got 0.9 (a number is that of the…"),
        ({"phases": 0}, "phases must be a whole number in [1, 100000]; got 0"),
        ({"period": [1.0, 2.0], "frequency": [1.0, 2.0]}, "give exactly one of period, frequency; got period…"),
        ({"restitution": [0.5, 1.9]}, "restitution must hold two numbers or more in [0, 1], ascending; got 1.9…"),
        ({"period": [2.0, 1.0]}, "period must hold two numbers or more…"),
        ({"system": BRACED}, "system must have no braces: between them a block does not overturn…"),
    ],
    "overturning_spectrum": [
        ({"system": "one-sine"}, "system must be a System; got 'one-sine'…"),
        ({"system": SYSTEM}, "system must have a pulse as base motion, rk.Pulse; got Harmonic…"),
        ({"system": rk.System(PULSED.forcing, 0.9, rk.Braces(0.5))}, "system must have no braces for this survey…"),
        ({"amplitude": 2.0}, f"amplitude {AXIS} [0, 1000]; got 2.0 (such as np.linspace(…"),
        ({"frequency": None}, f"frequency {AXIS} [0.001, 1000]; got None…"),
        ({"frequency": [2.0, 1.0]}, "frequency must hold two numbers or more in [0.001, 1000], ascending…"),
        ({"restitution": 1.2}, f"restitution {AXIS} [0, 1]; got 1.2 (a number is…"),
    ],
    "chaos_share": [
        ({"restitution": 0.5}, f"restitution {AXIS} [0, 1]; got 0.5…"),
        ({"restitution": [0.5, 0.2]}, "restitution must hold two numbers or more…"),
        ({"period": 1.0}, "period must be a pair (low, high)…"),
        ({"amplitude": (3, 1)}, "amplitude must be a pair (low, high)…"),
        ({"samples": 1.5}, "samples must be a whole number…"),
    ],
    "repeatability": [
        ({"relative": 2}, "relative must lie in [0, 0.5]; got 2"),
        ({"system": 3}, "system must be a System; got 3…"),
    ],
    "repeatability_map": [({"samples": 1}, "samples must be a whole number in [2, 1000]; got 1")],
    "rocking_spectrum": [
        ({"size": 1.0, "slenderness": 0.2}, "size must be an array if nothing else varies and there is one record; got 1.0 (rk.simulate…"),
        ({"size": [1.0, 2.0]}, "a rocking spectrum needs slenderness (or give a block, which has both)"),
        ({}, "a rocking spectrum needs size and slenderness (or give a block, which has both)"),
    ],
    **{
        survey: [
            ({"levels": [2.0, 1.0]}, "levels must hold two numbers or more in [1e-09, 1e+06], ascending; got 2.0…"),
            ({"levels": [1.0]}, "levels must hold two numbers or more in…"),
            ({"intensity": "pgx"}, "intensity must be one of 'scale', 'pga'…"),
            ({"block": None}, "block must be a Block; got None…"),
            ({"records": []}, "records must hold ground motions, one at least; got []…"),
        ]
        for survey in ("overturning_set", "incremental_dynamic_analysis", "sensitivity")
    },
    "fragility": [
        ({"levels": 3.0}, "levels must be an array of levels, ascending; got 3.0…"),
        ({"levels": [3.0, 2.0]}, "levels must hold two numbers or more in…"),
        ({"limits": [0.5, 0.1]}, f"{LIMITS} [0.5, 0.1]…"),
        ({"limits": math.inf}, f"{LIMITS} inf (overturning follows…"),
        ({"samples": 4}, "samples must be 1 for a certain block; got 4 (give height_spread…"),
        ({"samples": 0}, "samples must be a whole number in [1, 10000]; got 0"),
        ({"width_spread": 0.6}, "width_spread must lie in [0, 0.5]; got 0.6"),
        ({"replicates": 10}, "replicates must be a whole number in [100, 100000]; got 10"),
        ({"seed": -1}, "seed must be a whole number in [0, 4294967295]; got -1"),
        ({"intensity": "pgx"}, "intensity must be one of 'scale', 'pga'…"),
        ({"block": 2.0}, "block must be a Block; got 2.0…"),
    ],
}  # fmt: skip
LEVELS = "levels must be an array of levels, ascending; got 2.0 (such as np.linspace(1, 10, 19))"
for survey in ("overturning_set", "incremental_dynamic_analysis"):
    WRONG[survey] += [
        ({"levels": 2.0}, LEVELS),
        ({"polarity": [1, -1]}, f"polarity must be {POLARITIES}; got [1, -1]"),
        ({"polarity": 0.5}, f"polarity must be {POLARITIES}; got 0.5"),
        ({"polarity": "up"}, f"polarity must be {POLARITIES}; got 'up'"),
        ({"angle": [0.0, 0.1]}, "angle must be one number; got [0.0, 0.1]"),
        ({"executor": 2}, "executor must be an Executor; got 2"),
    ]


@pytest.mark.parametrize(
    "survey, options, message", [(survey, *row) for survey, rows in WRONG.items() for row in rows]
)
def test_what_cannot_be_surveyed_is_refused_in_one_line(survey, options, message):
    given = {
        name: value
        for name, value in (USUAL[survey] | options).items()
        if value is not None or name in ("block", "frequency")
    }
    with pytest.raises((TypeError, ValueError)) as refused:
        getattr(rk, survey)(**given)
    told, (start, more, _) = str(refused.value), message.partition("…")
    assert told.startswith(start) if more else told == message
    assert "\n" not in told
