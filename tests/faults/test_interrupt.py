"""Ctrl-C in a simulation raises KeyboardInterrupt soon, and never ends the process."""

import signal
import subprocess
import sys
import time

import pytest

MANY_SHORT = "for _ in range(10**7): rk.simulate(system, cycles=3000, record='none')"
ONE_LONG = "rk.simulate(system, cycles=10**9, record='none')"
ONE_CYCLE_OF_MILLIONS = (
    "system = rk.System(rk.Harmonic(1000, period=6000), 0.9, rk.Braces(0.001));"
    "rk.simulate(system, cycles=10**6, record='none')"
)
SCRIPT = """
import rocking as rk

system = rk.System(rk.Harmonic(2, period=1), 0.925)
rk.simulate(system, cycles=10)
print("running", flush=True)
try:
    {run}
except KeyboardInterrupt:
    print("interrupted")
"""


@pytest.mark.parametrize(
    "delay", [0.3, *(pytest.param(each, marks=pytest.mark.long) for each in (0.71, 1.13))]
)
@pytest.mark.parametrize("run", [MANY_SHORT, ONE_LONG, ONE_CYCLE_OF_MILLIONS])
def test_interrupted_simulation_raises_keyboard_interrupt(run, delay):
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT.format(run=run)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    with process:
        assert process.stdout.readline() == "running\n"
        time.sleep(delay)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (0, "interrupted\n", "")
