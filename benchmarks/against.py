"""`python -m benchmarks.against REF`: the speed of this working tree against that of the commit REF, case by case."""

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
from contextlib import ExitStack, contextmanager
from pathlib import Path
from statistics import median
from typing import NamedTuple

from rich.console import Console
from rich.table import Table
from scipy.stats import binom

from benchmarks.timed import CASES

ROOT = Path(__file__).parents[1]
WORKER = Path(__file__).with_name("timed.py")
MIN_PAIRS, MAX_PAIRS = 15, 60
TURNS = 3
"""Runs of either side in a pair, in turn: the quickest counts."""
CONFIDENCE = 0.95
SLOWER = 1.03
"""An interval wholly above this ratio is a loss of speed; one wholly below its inverse is a gain."""
MAX_HALF_WIDTH = 0.03
EXPLANATION = f"""\
ratio: new / REF, median of the pairs, quickest of {TURNS} runs each, in processor time;
interval: of that median, {CONFIDENCE:.0%}, from order statistics, without assumption on the distribution
slower: interval wholly above {SLOWER}; faster: wholly below 1/{SLOWER}; equal: neither
undecided: interval still wider than ±{MAX_HALF_WIDTH:.0%} after {MAX_PAIRS} pairs"""


class Side(NamedTuple):
    """Sources of the package, and the settings of the processes that run them."""

    source: Path
    environment: dict[str, str]


class Worker:
    """Separate process that runs cases of one side on request."""

    def __init__(self, side, core="any"):
        # Ctrl-C is for the parent process; this process ends with its input.
        self.process = subprocess.Popen(
            [sys.executable, "-P", WORKER, side.source, str(core)],
            env=side.environment | {"PYTHONPATH": str(side.source)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()

    def request(self, name):
        print(name, file=self.process.stdin, flush=True)

    def seconds(self):
        line = self.process.stdout.readline()
        if not line:
            raise ChildProcessError("a process that runs the cases has ended early: its message stands above")
        return float(line)

    def measure(self, name):
        self.request(name)
        return self.seconds()


def git(root, *arguments):
    done = subprocess.run(["git", "-C", root, *arguments], check=True, capture_output=True, text=True)
    return done.stdout.strip()


@contextmanager
def checked_out(root, commit):
    """Check a commit out into a temporary folder, as the side REF; its machine code is written there too."""
    with tempfile.TemporaryDirectory(prefix="rocking-against-") as folder:
        tree = Path(folder, "tree")
        git(root, "worktree", "add", "--detach", str(tree), commit)
        try:
            yield Side(tree / "src", os.environ | {"NUMBA_CACHE_DIR": f"{folder}/machine-code"})
        finally:
            git(root, "worktree", "remove", "--force", str(tree))


def has_library(side):
    """Return whether the kernels of a side are one library in its sources; those of older commits are cached files."""
    return (side.source / "rocking/kernels/library/build.py").exists()


def compile_kernels(sides, names):
    """Compile the kernels of both sides, each in its own way. Older commits compile what the cases call, then the rest."""
    with ExitStack() as stack:
        workers = [stack.enter_context(Worker(side)) for side in sides if not has_library(side)]
        for name in names:
            for worker in workers:
                worker.request(name)
            for worker in workers:
                worker.seconds()
    for side in sides:
        if (side.source / "rocking/kernels/__main__.py").exists():
            run_to_end([sys.executable, "-P", "-m", "rocking.kernels"], side)


def run_to_end(command, side):
    """Run a command of a side. If this process is interrupted, the command ends first, and removes its files."""
    environment = side.environment | {"PYTHONPATH": str(side.source)}
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.DEVNULL, start_new_session=True
    ) as process:
        try:
            code = process.wait()
        except BaseException:
            process.send_signal(signal.SIGINT)
            process.wait()
            raise
    if code:
        raise ChildProcessError(f"the kernels of {side.source} were not compiled: the message stands above")


def measure_pairs(sides, names, order):
    """Measure (REF, new) seconds of each case once, in separate processes on one core.

    The memory layout of a process changes its speed by some per cent, so new processes make the pairs independent.
    """
    core = max(os.sched_getaffinity(0))
    with Worker(sides[0], core) as ref, Worker(sides[1], core) as new:
        pairs = {}
        for name in names:
            taken = {ref: [], new: []}
            for worker in order.sample([ref, new], 2) * TURNS:
                taken[worker].append(worker.measure(name))
            pairs[name] = min(taken[ref]), min(taken[new])
    return pairs


def interval_of_median(values):
    """Compute the distribution-free interval of the median: two order statistics that enclose it with the confidence."""
    rank = int(binom.ppf((1 - CONFIDENCE) / 2, len(values), 0.5))
    ordered = sorted(values)
    return ordered[rank - 1], ordered[len(values) - rank]


def is_wide(interval):
    low, high = interval
    return (high - low) / 2 > MAX_HALF_WIDTH


def judge(interval):
    low, high = interval
    if low > SLOWER:
        return "slower"
    if is_wide(interval):
        return "undecided"
    return "faster" if high < 1 / SLOWER else "equal"


def ratios(pairs):
    return [new / ref for ref, new in pairs]


def compare(root, commit, names, seed, console):
    """Measure the pairs of each case: at least 15, and more while the interval is too wide."""
    order, pairs = random.Random(seed), {name: [] for name in names}
    with checked_out(root, commit) as ref:
        sides = ref, Side(root / "src", dict(os.environ))
        with console.status("compiling both sides: some minutes"):
            compile_kernels(sides, names)
        open_cases = list(names)
        while open_cases:
            done = max(map(len, pairs.values()))
            cap = MIN_PAIRS if done < MIN_PAIRS else MAX_PAIRS
            with console.status(f"pair {done + 1} of {cap} at most: {', '.join(open_cases)}"):
                for name, pair in measure_pairs(sides, open_cases, order).items():
                    pairs[name].append(pair)
            if done + 1 >= MAX_PAIRS:
                break
            if done + 1 >= MIN_PAIRS:
                open_cases = [name for name in open_cases if is_wide(interval_of_median(ratios(pairs[name])))]
    return pairs


def table_of(pairs):
    """Return the table, and the result of each case."""
    table, answers = Table(box=None, pad_edge=False), {}
    table.add_column("case", min_width=20)
    for title in ("REF, ms", "new, ms", "ratio", "interval", "pairs"):
        table.add_column(title, justify="right", min_width=8)
    table.add_column("speed")
    for name, found in pairs.items():
        milliseconds = [1e3 * median(side) for side in zip(*found, strict=True)]
        interval = interval_of_median(ratios(found))
        answers[name] = judge(interval)
        row = [f"{value:.0f}" for value in milliseconds] + [f"{median(ratios(found)):.3f}"]
        row += ["{:.3f} to {:.3f}".format(*interval), str(len(found))]
        table.add_row(name, *row, answers[name])
    return table, answers


def end_on_signals():
    """Let Ctrl-C and `kill` end the comparison in order. A process in the background ignores Ctrl-C by default."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)


def main(arguments=None):
    """Print one row per case; return 0 only if none is slower or undecided."""
    parser = argparse.ArgumentParser("python -m benchmarks.against", description=__doc__.partition(": ")[2])
    parser.add_argument("ref", metavar="REF", help="a commit, a branch or a tag")
    parser.add_argument(
        "--seed", type=int, default=random.randrange(10**6), help="of the order within each pair"
    )
    options = parser.parse_args(arguments)
    try:
        commit = git(ROOT, "rev-parse", "--verify", "--quiet", f"{options.ref}^{{commit}}")
    except subprocess.CalledProcessError:
        parser.error(f"REF must be a commit of this repository; got {options.ref!r}")
    console = Console(width=100, highlight=False)
    console.print(
        f"This working tree (new) against {options.ref} (REF, {commit[:7]}); order by seed {options.seed}\n"
    )
    table, answers = table_of(compare(ROOT, commit, list(CASES), options.seed, console))
    console.print(table, "", EXPLANATION, sep="\n")
    lost = [f"{name}: {answer}" for name, answer in answers.items() if answer in ("slower", "undecided")]
    console.print("", "not of equal speed: " + "; ".join(lost) if lost else "no case is slower")
    return 1 if lost else 0


if __name__ == "__main__":
    end_on_signals()
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit("interrupted: the commit's folder is removed")
