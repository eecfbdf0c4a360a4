"""`rocking orbits`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.input.study_option import with_study
from rocking.cli.option_names import ARGUMENTS, SYSTEM, computing, options

EXAMPLES = """\
# Orbits of a period up to 3 forcing cycles, stable and unstable.
rocking orbits --amplitude 5.5 --period 0.5 --restitution 0.925 \\
    --csv orbits.csv
# A block of 2 m × 0.5 m, in SI units.
rocking orbits --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2
# A stout block, whose angle is not small.
rocking orbits --height 2 --width 1 --acceleration 6 --frequency-hz 1.2 \\
    --model full --max-period 1"""

Effort = Annotated[
    float,
    ask.number_option(
        "--effort", "Number of initial guesses per map in the first round, in units of 2048, in [0.01, 1000]."
    ),
]
Seed = Annotated[int, ask.number_option("--seed", "First index of the sequence of initial guesses.")]
Csv = Annotated[
    Path | None, ask.file_option("--csv", "Write one row per orbit, with its state at τ = 0 (.csv).")
]


@with_study
@ask.with_options(*SYSTEM, phase=0.0)
def orbits(
    context: typer.Context,
    model: ask.Model = None,
    max_period: ask.MaxPeriod = 3,
    effort: Effort = 1.0,
    seed: Seed = 0,
    prove: ask.Prove = False,
    csv: Csv = None,
    netcdf: ask.Netcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Search for all periodic orbits up to a period.

    Stable and unstable orbits are listed, each once. Completeness is not guaranteed: the search may miss orbits.
    """
    from rocking.cli.output.files import check_files
    from rocking.cli.reports import orbits as report
    from rocking.orbits.find_orbits import find_orbits

    files = check_files({"csv": csv, "netcdf": netcdf})
    system, _, block = ask.question(context.params)
    with computing(ARGUMENTS | options("effort", "seed")):
        found = find_orbits(system, max_period, effort=effort, seed=seed, prove=prove)
    report.write(found, block, files)
    report.show(found, block, list(files.values()), as_json=json)
