"""Table of the commands: for each its options and files, the function that it calls, and the report of the result."""

from __future__ import annotations

from typing import NamedTuple

import click

from rocking.cli.options import (
    AMPLITUDES,
    AXIS,
    CHANNEL,
    COMPONENT,
    FILMS,
    FOLDER,
    FORCED,
    FREQUENCIES,
    FRICTION,
    INERTIA_RATIO,
    JSON,
    LAW,
    MASS_CENTRE,
    MODEL,
    NETCDF,
    NORMALISED_BY,
    NUMBER,
    ONE_AXIS,
    ONE_RANGE,
    ONE_VALUE,
    PICTURES,
    POLARITY,
    PROVE,
    RANGE,
    READING,
    RECORD,
    REPAIR,
    RESTRAINER,
    SOURCES,
    STANDING,
    START,
    STEP,
    STORE,
    SURVEY_NETCDF,
    SYSTEM,
    TEXT,
    VALUES,
    VARIABLE,
    Names,
    PathType,
    Port,
    RecordFile,
    Word,
    csv,
    interval,
    levels,
    make,
    max_cycles,
    max_period,
    number,
    output,
    plot,
    quantities,
    scaling,
    switch,
)


class Command(NamedTuple):
    """Command of the command line."""

    name: str
    about: str
    """First sentence of its help."""
    function: str
    """Path of the function that it calls."""
    inputs: str = ""
    """Function in `rocking.cli` that makes the arguments of `function` from the options."""
    report: str = ""
    """Report in `rocking.cli`; without one, `function` takes the options themselves."""
    options: tuple[click.Parameter, ...] = ()
    outputs: tuple[click.Parameter, ...] = ()
    """Options of the output, which `--study` precedes."""
    details: str = ""
    examples: str = ""
    survey: bool = False
    """Whether the entries of a study file are checked as values of a survey."""
    progress: bool = False
    """Whether `function` shows its progress."""


PULSES = (
    "rectangular, triangular, trapezoidal, half-sine, one-sine, one-cosine, ricker or antisymmetric-ricker"
)
AXIS_TEXT = "AXIS is START:STOP:COUNT: COUNT evenly spaced values, both ends included. COUNT is optional. Default: 200."
AN_AXIS = (
    "AXIS, START:STOP:COUNT: COUNT evenly spaced values, both ends included. COUNT is optional. Default: 200."
)
LEVELS_TEXT = AXIS_TEXT.replace("values", "levels")
MOTION_CSV = output(
    "csv",
    "Write time, angle and velocity at equal time steps (.csv). An overturning motion ends at |Θ| = 3, "
    "that of a full block when it lies flat.",
    ".csv",
)
UNSCATTERED = LAW[:2]
"""Options of the law of restitution of an analysis of recurrent motions, which takes no scatter."""
BLOCK = (*quantities("height", "width", "restitution", *STANDING), *LAW)
ALL_RECORDS = (POLARITY, MODEL, NORMALISED_BY, *READING, COMPONENT)
"""Options of the motions under every record of a set."""
RECORDS_AND_LEVELS = (SOURCES, *BLOCK, *quantities("angle"), *levels(), INERTIA_RATIO, *ALL_RECORDS)
"""Options of the motions of one block under every record at every level."""
RANDOM_SEED = number("seed", "Random seed. Default: 0.")
SURVEY_COUNTS = (
    number("max_cycles", "Maximum number of forcing cycles. Default: 10,000."),
    number("max_period", "Longest response period sought, in forcing cycles. Default: 64."),
)


def of_survey(picture: str, rows: str) -> tuple[click.Parameter, ...]:
    """Return the options of the output of a survey: its store, a plot, a table, and the result in two formats."""
    return STORE, REPAIR, plot(picture), csv(rows), SURVEY_NETCDF, JSON


COMMANDS = (
    Command(
        "simulate",
        "Simulate one block and summarise its motion.",
        function="rocking.cli.reports_motion.run",
        inputs="requests.simulation",
        report="reports_motion.SIMULATE",
        options=(
            *quantities(*SYSTEM, "wall", *RESTRAINER, *START),
            make(
                "pulse",
                TEXT,
                "KIND",
                f"One pulse instead of harmonic motion: {PULSES}. Its duration is the period; for a half-sine, half of it.",
            ),
            number("cycles", "Without --pulse: the number of forcing cycles to simulate. Default: 200."),
            *LAW,
            FRICTION,
            MODEL,
            NORMALISED_BY,
        ),
        outputs=(
            output(
                "plot",
                "Plot the time history and phase portrait, for a long run the last 30 cycles (.png .svg .pdf), or write an "
                "animation (.gif .mp4).",
                *PICTURES,
                *FILMS,
            ),
            MOTION_CSV,
            NETCDF,
            JSON,
        ),
        examples="""
# Normalised input.
rocking simulate --amplitude 2 --period 1 --restitution 0.925 \\
    --plot motion.png
# A block of 2 m × 0.5 m, in SI units.
rocking simulate --height 2 --width 0.5 --acceleration 3 --frequency-hz 1.2
# A stout block, whose angle is not small.
rocking simulate --height 2 --width 1 --acceleration 6 --frequency-hz 1.2 \\
    --model full
# The same block under one pulse.
rocking simulate --pulse one-sine --height 2 --width 0.5 \\
    --acceleration-g 0.5 --frequency-hz 1
""",
    ),
    Command(
        "record",
        "Simulate a block under a recorded ground motion.",
        function="rocking.cli.reports_motion.run",
        inputs="record_requests.record",
        report="reports_motion.RECORD",
        options=(
            RECORD,
            *quantities(
                "height", "width", "restitution", *STANDING, "brace_angle", "brace_restitution", *START
            ),
            *LAW,
            INERTIA_RATIO,
            FRICTION,
            POLARITY,
            *scaling(
                NUMBER, "the record is", "Factor of the record; a negative one reverses it. Default: 1."
            ),
            CHANNEL,
            *READING,
            number(
                "azimuth_deg",
                "Direction of shaking, degrees from the channel towards the other horizontal one: that of the file, or of --second.",
            ),
            make(
                "second", RecordFile(), "FILE", "File of the other horizontal component, for --azimuth-deg."
            ),
            make(
                "vertical",
                RecordFile(),
                "FILE",
                "File of the vertical component, positive upwards, with the step of the record. It is scaled as the record is, and both "
                "end with the shorter one.",
            ),
            number(
                "floor_period",
                "Period of a floor, s: the block stands on a linear oscillator on this ground.",
            ),
            number("floor_damping", "Damping ratio of the floor. Default: 0.05."),
            MODEL,
            NORMALISED_BY,
        ),
        outputs=(
            plot("Plot the time history, the base acceleration and the phase portrait"),
            output("animate", "Write an animation of the block on its moving base (.gif .mp4).", *FILMS),
            MOTION_CSV,
            NETCDF,
            JSON,
        ),
        details="The run ends when the block is at rest permanently, or when overturning is certain. Without losses, at the base or "
        "at braces, it ends with the record. The block, the record and the report are in SI units, the initial state is in units "
        "of θcr and α θcr.",
        examples="""
# The record that comes with the package.
rocking record example --height 2 --width 0.5 --plot record.png
# The same, scaled to 1.5 g: the block overturns.
rocking record example --height 2 --width 0.5 --pga-g 1.5 \\
    --animate fall.gif --csv fall.csv
""",
    ),
    Command(
        "slide",
        "Follow a block that slides on the ground and does not rock.",
        function="rocking.motion.sliding.slide",
        inputs="record_requests.sliding",
        report="reports_motion.SLIDE",
        options=(
            RECORD,
            number("friction", "Coefficient of friction μ between block and ground, in [0.001, 10]."),
            *scaling(
                NUMBER, "the record is", "Factor of the record; a negative one reverses it. Default: 1."
            ),
            CHANNEL,
            *READING,
        ),
        outputs=(
            plot("Plot the slip over time"),
            csv("Write time, slip, its velocity and the acceleration of the ground"),
            NETCDF,
            JSON,
        ),
        details="The slip is exact for straight segments between samples. It does not depend on the size of the block. A block whose "
        "width is less than μ times its height rocks before it slides.",
        examples="""
# The record that comes with the package, scaled to 0.5 g.
rocking slide example --friction 0.3 --pga-g 0.5 --plot slip.png
""",
    ),
    Command(
        "spectrum",
        "Follow blocks of many sizes under ground motions.",
        function="rocking.survey.spectra.rocking_spectrum",
        inputs="record_requests.spectrum",
        report="reports_records.SPECTRUM",
        options=(
            SOURCES,
            *quantities("height", "width", *MASS_CENTRE, "wall"),
            interval(
                "size",
                VALUES,
                "Distance R from a corner to the centre of mass, m: half the diagonal. Default: that of --height and --width.",
            ),
            interval(
                "slenderness_deg",
                VALUES,
                "Critical angle θcr, degrees: the arc tangent of width over height. Default: that of --height and --width.",
            ),
            interval(
                "restitution",
                VALUES,
                "Coefficient of restitution e. Default: Housner's value for each slenderness.",
            ),
            *LAW,
            INERTIA_RATIO,
            *scaling(VALUES, "each record is", "Factor of the records. Default: 1."),
            *ALL_RECORDS,
        ),
        outputs=of_survey("Plot the largest angle over the size", "Write one row per run"),
        details=AXIS_TEXT,
        progress=True,
        examples="""
# Blocks of 100 sizes and a slenderness of 10° under a record scaled to 0.5 g.
rocking spectrum example --size 0.5:5:100 --slenderness-deg 10 \\
    --pga-g 0.5 --plot spectrum.png
# The shape of a cabinet of 2 m × 0.5 m, at many sizes and two intensities.
rocking spectrum example --height 2 --width 0.5 --size 0.5:5:50 \\
    --pga-g 0.6:1.2:2 --csv spectrum.csv
""",
    ),
    Command(
        "classify",
        "Classify the response and report the evidence.",
        function="rocking.response.classify.classify",
        inputs="requests.response",
        report="reports_verdict.CLASSIFY",
        options=(*quantities(*SYSTEM, *START), *UNSCATTERED, MODEL, max_cycles(100_000), max_period(), PROVE),
        outputs=(
            plot("Plot the last cycles, the phase portrait, the Poincaré section and the verdict"),
            JSON,
        ),
        examples="""
# Normalised input.
rocking classify --amplitude 6.5 --period 0.4 --restitution 0.925 \\
    --plot verdict.png
# The same, proved.
rocking classify --amplitude 6.5 --period 0.4 --restitution 0.925 --prove
# A block of 2 m × 0.5 m, in SI units.
rocking classify --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2
""",
    ),
    Command(
        "lyapunov",
        "Measure both Lyapunov exponents with their errors.",
        function="rocking.response.lyapunov.lyapunov",
        inputs="requests.response",
        report="reports_verdict.LYAPUNOV",
        options=(
            *quantities(*SYSTEM, *START),
            *UNSCATTERED,
            MODEL,
            number("cycles", "Number of forcing cycles of the average, at least 32.", 10_000),
            number("transient", "Forcing cycles discarded before the average. Default: a tenth of --cycles."),
        ),
        outputs=(
            plot("Plot the running estimate of the largest exponent"),
            csv("Write the running estimates of both exponents, with their errors"),
            NETCDF,
            JSON,
        ),
        examples="""
# Normalised input.
rocking lyapunov --amplitude 10.103037 --period 1.721328 \\
    --restitution 0.8 --cycles 20000 --plot exponent.png
# A block of 2 m × 0.5 m, in SI units.
rocking lyapunov --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2 \\
    --csv exponents.csv
""",
    ),
    Command(
        "modes",
        "Compute the symmetric (1, n) modes in closed form.",
        function="rocking.cli.reports_verdict.find",
        inputs="requests.one_system",
        report="reports_verdict.MODES",
        options=(*quantities(*FORCED), number("n", "Response period in forcing cycles: 1, 3, 5, ….", 1)),
        outputs=(
            plot("Plot the velocity and phase of the modes over the amplitude"),
            csv("Write one row per mode"),
            JSON,
        ),
        details="Prints their velocity and phase at impact, their stability and their admissibility.",
        examples="""
# The (1, 3) modes, plotted over the amplitude.
rocking modes --amplitude 6.5 --period 0.4 --restitution 0.925 -n 3 \\
    --plot modes.png
# The (1, 1) modes of a block of 2 m × 0.5 m, in SI units.
rocking modes --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2 \\
    --csv modes.csv
""",
    ),
    Command(
        "map",
        "Classify the response at each point of a grid.",
        function="rocking.survey.parametric_map.parametric_map",
        inputs="requests.parametric_map",
        report="reports_surveys.MAP",
        options=(
            *quantities(*SYSTEM, *START, kind=VALUES, varied=VARIABLE),
            *UNSCATTERED,
            MODEL,
            *SURVEY_COUNTS,
        ),
        outputs=(
            STORE,
            REPAIR,
            plot("Plot the map, with area fractions"),
            make(
                "curves",
                Names(),
                "NAMES",
                "Theoretical curves to overlay, separated by commas: symmetry-breaking-1, symmetry-breaking-3, existence-1, "
                "existence-3, melnikov, heteroclinic.",
            ),
            make(
                "symbols",
                TEXT,
                "SET",
                "Draw symbols instead of cells: kinds, or the symbols of figure 10, 11 or 13b of Yim & Lin (1991).",
            ),
            make(
                "tiles",
                FOLDER,
                "DIR",
                "Write image tiles and a page that pans and zooms them without a server.",
            ),
            SURVEY_NETCDF,
            csv("Write one row per point"),
            JSON,
        ),
        details=f"Give exactly two options as an {AN_AXIS}",
        survey=True,
        progress=True,
        examples="""
# Responses over amplitude and period, plotted.
rocking map --amplitude 0:16:100 --period 0.2:3:100 --restitution 0.925 \\
    --plot map.png
# A block of 2 m × 0.5 m, in SI units. Repeat the command to resume it.
rocking map --height 2 --width 0.5 --acceleration 1:8:50 \\
    --frequency-hz 0.5:3:50 --store block.zarr
""",
    ),
    Command(
        "basins",
        "Compute basins of attraction.",
        function="rocking.survey.basins.basin_map",
        inputs="requests.basins",
        report="reports_surveys.BASINS",
        options=(
            *quantities(*SYSTEM),
            interval(
                "angle",
                AXIS,
                "Initial angles Θ, in units of the critical angle θcr, not in degrees. Default: -1:1:200, or the range between "
                "narrower braces.",
            ),
            interval(
                "velocity", AXIS, "Initial angular velocities Θ', in units of α θcr. Default: -1:1:200."
            ),
            number(
                "samples",
                "Number of random initial states in these ranges; replaces the grid. COUNT is ignored.",
            ),
            RANDOM_SEED,
            *UNSCATTERED,
            MODEL,
            *SURVEY_COUNTS,
            number(
                "boundary_runs",
                "Number of runs used for the uncertainty exponents; 0 disables them. Default: 100,000.",
            ),
            number(
                "boundary_width",
                "Largest width of the intervals of these exponents; runs are added until they are narrower. Default: no further "
                "runs.",
            ),
        ),
        outputs=of_survey(
            "Plot the basins, one colour per attractor, with their area fractions",
            "Write one row per initial state",
        ),
        details="The initial states form a grid over --angle and --velocity. The uncertainty exponents of the boundaries between the "
        f"basins are also estimated. {AXIS_TEXT}",
        survey=True,
        progress=True,
        examples="""
# A grid of 300 × 300 initial states, plotted.
rocking basins --amplitude 5.5 --period 1 --restitution 0.8 \\
    --angle=-1:1:300 --velocity=-1:1:300 --plot basins.png
# 10,000 random initial states.
rocking basins --amplitude 5.5 --period 1 --restitution 0.8 \\
    --samples 10000 --csv basins.csv
""",
    ),
    Command(
        "safe-basin",
        "Estimate the safe fraction of initial states.",
        function="rocking.survey.basins.safe_basin",
        inputs="requests.safe_basin",
        report="reports_surveys.SAFE_BASIN",
        options=(
            *quantities(*SYSTEM, kind=AXIS, varied=AMPLITUDES),
            interval(
                "angle",
                RANGE,
                "Range START:STOP of the initial angles Θ, in units of the critical angle θcr, not in degrees. Default: -1:1, or "
                "the range between narrower braces.",
            ),
            interval(
                "velocity",
                RANGE,
                "Range START:STOP of the initial angular velocities Θ', in units of α θcr. Default: -1:1.",
            ),
            number(
                "samples",
                "Number of random initial states in these ranges, the same ones at each amplitude. Default: 10,000.",
            ),
            RANDOM_SEED,
            *UNSCATTERED,
            MODEL,
            *SURVEY_COUNTS,
        ),
        outputs=of_survey(
            "Plot the safe fraction over the amplitude, with its intervals and the thresholds",
            "Write one row per amplitude",
        ),
        details="It is the fraction of the initial states that do not overturn, at each amplitude, with its 95 % confidence interval. "
        f"Give the amplitude as an {AN_AXIS}",
        survey=True,
        progress=True,
        examples="""
# The safe fraction over the amplitude, plotted with both thresholds.
rocking safe-basin --amplitude 2:16:29 --period 1 --restitution 0.8 \\
    --samples 2000 --plot safe.png
# Initial states near rest only.
rocking safe-basin --amplitude 2:16:29 --period 1 --restitution 0.8 \\
    --angle=-0.2:0.2 --velocity=-0.2:0.2 --samples 2000
# A block of 2 m × 0.5 m, in SI units.
rocking safe-basin --height 2 --width 0.5 --acceleration 2:10:20 \\
    --frequency-hz 1.2 --samples 2000 --csv safe.csv
""",
    ),
    Command(
        "overturning",
        "Find the lowest amplitude that overturns a block.",
        function="rocking.survey.overturning_amplitude.overturning_amplitude",
        inputs="requests.overturning",
        report="reports_surveys.OVERTURNING",
        options=(
            *quantities(
                "period",
                "frequency",
                "height",
                "width",
                "frequency_hz",
                "period_s",
                "restitution",
                "critical_angle",
                *MASS_CENTRE,
                kind=VALUES,
                varied=VARIABLE,
            ),
            interval(
                "amplitude",
                AXIS,
                "Amplitudes A of the base acceleration to scan, in units of g θcr. Default: 1:16:301.",
            ),
            interval(
                "acceleration",
                AXIS,
                "Amplitudes of the base acceleration to scan, m/s². Default: 1:16:301 times g θcr.",
            ),
            interval("acceleration_g", AXIS, "Amplitudes to scan, in units of g; replaces --acceleration."),
            number("phases", "Number of initial forcing phases. Default: 16."),
            *UNSCATTERED,
            MODEL,
            number("max_cycles", "Maximum number of forcing cycles per run. Default: 1,000."),
            SURVEY_COUNTS[1],
        ),
        outputs=of_survey(
            "Plot the lowest amplitude and the fraction of phases that overturn",
            "Write one row per forcing period, frequency or restitution",
        ),
        details="The block is initially at rest. The minimum is taken over the initial phases of the forcing. "
        + AXIS_TEXT,
        survey=True,
        progress=True,
        examples="""
# The lowest overturning amplitude over the forcing period, plotted.
rocking overturning --period 0.4:3:50 --restitution 0.925 \\
    --plot overturning.png
# One period, one phase, a fine scan of the amplitude.
rocking overturning --period 1 --restitution 0.925 --amplitude 1:16:1501 \\
    --phases 1 --json
# A block of 2 m × 0.5 m, in SI units.
rocking overturning --height 2 --width 0.5 --frequency-hz 1:2:10 \\
    --csv overturning.csv
""",
    ),
    Command(
        "overturning-set",
        "Find the levels at which records overturn a block.",
        function="rocking.survey.overturning_set.overturning_set",
        inputs="record_requests.overturning_set",
        report="reports_records.OVERTURNING_SET",
        options=RECORDS_AND_LEVELS,
        outputs=of_survey("Plot the intervals of overturning levels, a row per record", "Write the switches"),
        details="Overturning is not monotone: a stronger motion can spare a block that a weaker one overturns. Every interval wider "
        f"than the distance of two levels is found. {LEVELS_TEXT}",
        examples="""
# Peak accelerations at which the record of the package overturns a block.
rocking overturning-set example --height 2 --width 0.5 --pga-g 0.1:2:400 \\
    --plot overturning-set.png --csv overturning-set.csv
""",
    ),
    Command(
        "ida",
        "Follow a block under records at many levels.",
        function="rocking.survey.incremental_dynamic_analysis.incremental_dynamic_analysis",
        inputs="record_requests.incremental_dynamic_analysis",
        report="reports_records.IDA",
        options=RECORDS_AND_LEVELS,
        outputs=of_survey(
            "Plot the level over the largest angle of each record, with fractiles",
            "Write one row per run",
        ),
        details="Incremental dynamic analysis: each record is scaled to each level. The report has fractiles of the largest angle over "
        f"the records. {LEVELS_TEXT}",
        progress=True,
        examples="""
# The record of the package at 30 levels; name a folder or a table instead.
rocking ida example --height 2 --width 0.5 --pga-g 0.1:1.5:30 \\
    --plot ida.png --csv ida.csv
""",
    ),
    Command(
        "overturning-spectrum",
        "Find the pulses that overturn a block.",
        function="rocking.survey.spectra.overturning_spectrum",
        inputs="requests.overturning_spectrum",
        report="reports_surveys.OVERTURNING_SPECTRUM",
        options=(
            *quantities(
                "height", "width", "restitution", "critical_angle", *STANDING, kind=VALUES, varied=VARIABLE
            ),
            make(
                "pulse",
                TEXT,
                "KIND",
                f"Form of the pulse: {PULSES}. Its duration is one period of the frequency; for a half-sine, half of it.",
            ),
            interval("amplitude", AXIS, "Amplitudes A of the base acceleration, in units of g θcr."),
            interval("frequency", AXIS, "Frequencies Ω of the pulse, in units of α."),
            interval("acceleration", AXIS, "Amplitudes of the base acceleration, m/s²."),
            interval(
                "acceleration_g",
                AXIS,
                "Amplitudes of the base acceleration, in units of g; replaces --acceleration.",
            ),
            interval("frequency_hz", AXIS, "Frequencies of the pulse, Hz."),
            *LAW,
            MODEL,
            NORMALISED_BY,
        ),
        outputs=of_survey(
            "Plot the outcomes, with the mode of overturning in colour",
            "Write one row per run",
        ),
        details="The block is initially at rest. The mode of overturning is the number of impacts since the block last rested. "
        + AXIS_TEXT,
        survey=True,
        progress=True,
        examples="""
# Outcomes under one sine over amplitude and frequency, plotted.
rocking overturning-spectrum --pulse one-sine --amplitude 1:12:100 \\
    --frequency 0.5:8:100 --restitution 0.9 --plot pulses.png
# A block of 2 m × 0.5 m, in SI units.
rocking overturning-spectrum --pulse ricker --height 2 --width 0.5 \\
    --acceleration-g 0.2:2:50 --frequency-hz 0.3:3:50 --csv pulses.csv
""",
    ),
    Command(
        "fragility",
        "Estimate how likely ground motions overturn a block.",
        function="rocking.survey.fragility.fragility",
        inputs="record_requests.fragility",
        report="reports_records.FRAGILITY",
        options=(
            SOURCES,
            *BLOCK,
            *levels(VALUES),
            number(
                "limit",
                "Limit of |Θ|, in units of θcr; may be repeated. Overturning always follows.",
                multiple=True,
            ),
            INERTIA_RATIO,
            number("samples", "Number of samples of an uncertain block per record. Default: 1."),
            number("height_spread", "Standard deviation of ln H. Default: 0."),
            number("width_spread", "Standard deviation of ln B. Default: 0."),
            number(
                "restitution_spread",
                "Half the width of the uniform distribution of e about its value. Default: 0.",
            ),
            number("replicates", "Number of bootstrap replicates. Default: 1,000."),
            number("seed", "Random seed of samples and bootstrap. Default: 0."),
            make(
                "hazard",
                PathType(),
                "FILE",
                "Hazard of the site: a CSV file of levels and annual rates of exceedance. Adds the annual rate.",
            ),
            *ALL_RECORDS,
        ),
        outputs=of_survey(
            "Plot the probabilities with intervals and lognormal fits",
            "Write the probabilities and their intervals as a table",
        ),
        details="""\
A curve is the probability of overturning, or of exceeding a limit of the angle, over the intensity of the ground motion.
--scale 1 alone gives the probability under the records as they are.

All intervals are at 95 % and clustered by record: runs of the same record are not independent. AXIS is START:STOP:COUNT:
COUNT evenly spaced values, both ends included.

--hazard names a table of two columns: levels, in the unit of the axis unless a title such as "PGA (g)" states another one, and
the annual rates at which the site exceeds them.""",
        progress=True,
        examples="""
# The record of the package; name a folder or a table instead.
rocking fragility example --height 2 --width 0.5 --pga-g 0.1:1.5:15 \\
    --limit 0.5 --plot fragility.png
# The records as they are.
rocking fragility example --height 2 --width 0.5 --scale 1
# An uncertain block: 20 samples per record.
rocking fragility example --height 2 --width 0.5 --pga-g 0.1:1.5:15 \\
    --samples 20 --width-spread 0.1 --csv fragility.csv
# Annual rate of overturning, and its probability in 50 years, at a site.
rocking fragility records --height 2 --width 0.5 --pga-g 0.1:1.5:15 \\
    --hazard hazard.csv
""",
    ),
    Command(
        "sensitivity",
        "Count the verdicts that small changes reverse.",
        function="rocking.survey.sensitivity.sensitivity",
        inputs="record_requests.sensitivity",
        report="reports_records.SENSITIVITY",
        options=(
            SOURCES,
            *BLOCK,
            *levels(),
            INERTIA_RATIO,
            number("seed", "Random seed of the bootstrap. Default: 0."),
            *ALL_RECORDS,
        ),
        outputs=(STORE, REPAIR, csv("Write one row per change"), SURVEY_NETCDF, JSON),
        details="A verdict is whether the block overturns. Every run is repeated with five changes: the amplitude ± 1 %, sampling half "
        "a step later, and the coefficient of restitution ± 0.02. All intervals are at 95 % and clustered by record. "
        + LEVELS_TEXT,
        examples="""
# The record of the package at 30 levels; name a folder or a table instead.
rocking sensitivity example --height 2 --width 0.5 --pga-g 0.5:1.5:30 \\
    --csv sensitivity.csv
""",
    ),
    Command(
        "assess",
        "Write one page on a block under records, for a client.",
        function="rocking.cli.assess.run",
        options=(
            click.Argument(
                ["file"],
                type=PathType(),
                metavar="FILE",
                help="TOML file with the blocks, the records and the levels. `example` is the one that comes with the package; it is "
                "written beside the page, to be copied.",
            ),
            make(
                "output",
                FOLDER,
                "DIR",
                "Folder in which the files are written. Default: that of FILE, for `example` the current one.",
            ),
            JSON,
        ),
        details="Writes FILE as .html, which prints on A4, its tables as .csv and, with the extra `excel`, as .xlsx. FILE has the "
        "sections [block], [records] and [levels], and may have [hazard] and [uncertain]. The names of its keys state the units. "
        "The records act as recorded; on a block with unequal sides, or against a wall, they act in both directions, of which the worse "
        "one counts. The key polarity chooses. The default of --polarity in the other commands is + for any block.",
        examples="""
# The example, and its file to copy.
rocking assess example --output cabinet
# The copy, with your own numbers.
rocking assess cabinet/example.toml
""",
    ),
    Command(
        "fit-restitution",
        "Fit the coefficient of restitution to the times of impacts.",
        function="rocking.response.fit_restitution.fit_restitution",
        inputs="requests.fit_restitution",
        report="reports_motion.FIT_RESTITUTION",
        options=(
            click.Argument(
                ["times"],
                type=PathType(),
                metavar="FILE",
                help="Text file with the times of successive impacts of a free rocking test, in s; lines with # are left out.",
            ),
            *quantities("height", "width"),
            number(
                "frequency_parameter",
                "Frequency parameter p, 1/s. Default: that of the block; without one, it is fitted.",
            ),
            number("angle", "Largest |Θ| before the first impact, in units of θcr. Default: it is fitted."),
            number("release", "Time of the release from rest, s. Default: not known."),
            make(
                "model",
                Word("MODELS"),
                "MODEL",
                "Equation of motion: slender, for small angles, or full. Default: full with --height and --width, else slender.",
            ),
        ),
        outputs=(
            plot("Plot the coefficient of each impact over its speed"),
            csv("Write one row per impact"),
            NETCDF,
            JSON,
        ),
        details="The block rocks freely on a base at rest. The intervals at 95 % hold for independent errors of the times.",
        examples="""
# Times of a test of a block of 2 m × 0.5 m.
rocking fit-restitution times.txt --height 2 --width 0.5 --plot fit.png
# A block whose frequency parameter is not known.
rocking fit-restitution times.txt --json
""",
    ),
    Command(
        "orbits",
        "Search for all periodic orbits up to a period.",
        function="rocking.orbits.find_orbits.find_orbits",
        inputs="requests.one_system",
        report="reports_orbits.ORBITS",
        options=(
            *quantities(*SYSTEM),
            *UNSCATTERED,
            MODEL,
            max_period(3),
            number(
                "effort",
                "Number of initial guesses per map in the first round, in units of 2048, in [0.01, 1000].",
                1.0,
            ),
            number("seed", "First index of the sequence of initial guesses.", 0),
            PROVE,
        ),
        outputs=(STORE, REPAIR, csv("Write one row per orbit, with its state at τ = 0"), NETCDF, JSON),
        progress=True,
        details="Stable and unstable orbits are listed, each once. Completeness is not guaranteed: the search may miss orbits.",
        examples="""
# Orbits of a period up to 3 forcing cycles, stable and unstable.
rocking orbits --amplitude 5.5 --period 0.5 --restitution 0.925 \\
    --csv orbits.csv
# A block of 2 m × 0.5 m, in SI units.
rocking orbits --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2
# A stout block, whose angle is not small.
rocking orbits --height 2 --width 1 --acceleration 6 --frequency-hz 1.2 \\
    --model full --max-period 1
""",
    ),
    Command(
        "continue",
        "Follow a periodic orbit through a parameter.",
        function="rocking.cli.requests.follow",
        inputs="requests.continuation",
        report="reports_orbits.CONTINUE",
        options=(
            *quantities(
                *SYSTEM,
                kind=ONE_RANGE,
                varied=tuple(name for name in VARIABLE if name not in ("phase", *START)),
            ),
            *quantities(*START),
            *UNSCATTERED,
            MODEL,
            number(
                "at",
                "Value of the option with the range at which the orbit is found. Default: START of the range.",
            ),
            number(
                "response_period",
                "Find an orbit of this number of forcing cycles near the initial state, stable or unstable. Default: the orbit "
                "that the response from the initial state approaches.",
            ),
            STEP,
        ),
        outputs=(
            plot("Plot the largest |Θ| over the parameter"),
            csv("Write one row per point of the branch"),
            NETCDF,
            JSON,
        ),
        details="The branch is followed in both directions, through folds, to its ends within the range. Its special points are "
        "located. Give exactly one option as a RANGE, START:STOP.",
        examples="""
# The response from rest at an amplitude of 7, followed down to its fold.
rocking continue --amplitude 7:0.1 --period 1.721328 --restitution 0.8 \\
    --plot branch.png
# The response at an amplitude of 15, followed in both directions.
rocking continue --amplitude 10:30 --at 15 --period 1 --restitution 0.9
# An unstable orbit of period 3, from an approximate state at τ = 0.
rocking continue --amplitude 5:6.5 --at 5.5 --period 0.5 \\
    --restitution 0.925 --response-period 3 --angle 0.064 --velocity 0.054
# A block of 2 m × 0.5 m, in SI units.
rocking continue --height 2 --width 0.5 --acceleration 4:2 \\
    --frequency-hz 1.2 --csv branch.csv
""",
    ),
    Command(
        "frequency-response",
        "Compute the frequency response of (1, n) orbits.",
        function="rocking.orbits.frequency_response.frequency_response",
        inputs="requests.frequency_response",
        report="reports_orbits.FREQUENCY_RESPONSE",
        progress=True,
        options=(
            *quantities(
                *(name for name in FORCED if name != "displacement"), kind=ONE_AXIS, varied=FREQUENCIES
            ),
            number(
                "modes",
                "Number n of forcing cycles per response period: 1, 3, 5, …; may be repeated. Default: 1 and 3.",
                multiple=True,
            ),
            STEP,
            max_cycles(10_000),
        ),
        outputs=(
            STORE,
            REPAIR,
            plot("Plot the largest |Θ| over period or frequency"),
            csv("Write one row per point of the branches, and one per response from rest"),
            NETCDF,
            JSON,
        ),
        details="The branches of these orbits are followed, and the response from rest is classified at each value. Give the period or "
        f"the frequency as an {AN_AXIS}",
        examples="""
# The (1, 1) and (1, 3) orbits over the forcing period.
rocking frequency-response --amplitude 2 --period 0.5:2.5:100 \\
    --restitution 0.925 --plot response.png
# The (1, 1) orbits of a block of 2 m × 0.5 m, in SI units.
rocking frequency-response --height 2 --width 0.5 --acceleration 4 \\
    --frequency-hz 0.5:3:50 --modes 1 --csv response.csv
""",
    ),
    Command(
        "orbit-diagram",
        "Compute an orbit (bifurcation) diagram.",
        function="rocking.orbits.diagrams.orbit_diagram",
        inputs="requests.sweep",
        report="reports_orbits.ORBIT_DIAGRAM",
        progress=True,
        options=(
            *quantities(*SYSTEM, kind=ONE_VALUE, varied=VARIABLE),
            *quantities(*START),
            *UNSCATTERED,
            MODEL,
            make(
                "sweep",
                TEXT,
                "DIRECTION",
                "Sweep direction: up, down or both (each run starts from the previous end state), or rest (each run starts from the "
                "initial state).",
                "both",
            ),
            number("transient", "Transient cycles discarded at each parameter value.", 300),
            number("cycles", "Cycles recorded at each parameter value, one point per cycle.", 100),
            number(
                "section_phase", "Forcing phase of the Poincaré section, rad. Default: the value of --phase."
            ),
        ),
        outputs=(
            STORE,
            REPAIR,
            plot("Plot the points over the parameter"),
            csv("Write one row per point, nan in runs that overturned"),
            NETCDF,
            JSON,
        ),
        details=f"Give exactly one option as an {AN_AXIS}",
        examples="""
# Vary the amplitude, upwards and downwards.
rocking orbit-diagram --amplitude 7:10.9:1000 --period 1.721328 \\
    --restitution 0.8 --plot diagram.png
# A block of 2 m × 0.5 m, in SI units, from rest at each acceleration.
rocking orbit-diagram --height 2 --width 0.5 --acceleration 2:6 \\
    --frequency-hz 1.2 --sweep rest
""",
    ),
    Command(
        "explore",
        "Open the interactive explorer in the browser.",
        function="rocking.cli.explore.explore",
        options=(
            make("port", Port(), "NUMBER", "Port of the local server; 0 selects a free port.", 5006),
            switch("no_browser", "Print the address without opening a browser."),
        ),
        details="Shows a map of responses. For each point of the map: time history, Poincaré section, spectrum, basins and verdict. "
        "Other users of the computer cannot open the page: its address contains a token. The server runs until Ctrl-C.",
    ),
    Command(
        "paper",
        "Reproduce figures and numbers of papers on rocking.",
        function="rocking.cli.paper.paper",
        options=(
            click.Argument(
                ["figures"],
                nargs=-1,
                metavar="[FIGURE]...",
                help="Name of the report: yim-lin-1991 (default) or pulses-and-earthquakes. Then figures, tables or additional figures "
                "of it. For yim-lin-1991: 1 to 12, 13a, 13b, exponents, claims, chaos, cascade, crisis, threshold, coexistence, zoom, "
                "bifurcations. For pulses-and-earthquakes: 1 to 5, claims. Default: all of them, and an HTML report.",
            ),
            make(
                "output",
                PathType(),
                "DIR",
                "Folder in which the files are written. Default: results/yim-lin-1991. Default of another report: its own name in "
                "results.",
            ),
            switch("list", "Print the names of the reports and exit."),
        ),
        examples="""
# Figures 1 and 4 of Yim & Lin (1991) only.
rocking paper 1 4 --output figures
# Figure 2 of the report on pulses and earthquakes.
rocking paper pulses-and-earthquakes 2 --output pulses
# Names of the reports.
rocking paper --list
""",
    ),
    Command(
        "cite", "Print BibTeX entries of the package and its sources.", function="rocking.cli.paper.cite"
    ),
)
