"""`python -m benchmarks`: one table, every ratio from the same run."""

from benchmarks import (
    closed_forms,
    explorer,
    full_block,
    lanes,
    one_block,
    orbits,
    processes,
    records,
    survey,
    verdicts,
)
from benchmarks.table import Report


def main():
    report = Report()
    report.section("One block: time per impact, and ratio of the peers' time to it", one_block.speed())
    report.section("Error after 20 cycles against 40 digits", one_block.accuracy())
    report.section("Two threads against one", one_block.threads())
    report.section("Ground motions: time per run, and ratio of the others' time to it", records.speed())
    report.section("The full block: time, and ratio of the others' time to it", full_block.speed())
    report.section("The library of compiled kernels", processes.library())
    report.section("Whole processes", processes.commands())
    report.section("A long run", processes.long_run())
    report.section("Classification over the paper's map", verdicts.maps())
    report.section("Lanes", lanes.against_one())
    report.section("Maps", survey.maps())
    report.section("Maps: workers, stores, memory", survey.engines())
    report.section("Periodic orbits", orbits.following())
    report.section("Proofs", orbits.proofs())
    report.section("Dimension", verdicts.dimension())
    report.section("Closed forms of the theory", closed_forms.amplitudes())
    report.section("Explorer in a browser", explorer.page())
    report.close()


if __name__ == "__main__":
    main()
