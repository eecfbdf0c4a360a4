"""Results and errors of a pool's worker process arrive in the calling process."""

import subprocess
import sys

import pytest

# Each pool is given one call that fails and one that does not: a pool that lost a process answers neither.
BEGIN = """
import multiprocessing, sys
from concurrent.futures import ProcessPoolExecutor

import rocking as rk

chaotic = rk.System(rk.Harmonic(15.0, period=2.0), 0.925, rk.Braces(1.0))
section = rk.simulate(chaotic, cycles=1000, record="section").section()
free = rk.System(rk.Harmonic(0.0, period=1.0), 0.9)  # which loses energy, and so has no orbit


def told(result):
    try:
        return result()
    except rk.TooShort as error:
        return f"TooShort {type(error.estimate).__name__}"
    except rk.NoOrbit as error:
        return f"NoOrbit {type(error.state).__name__} {error.residual >= 0.0}"


if __name__ == "__main__":
    method = multiprocessing.get_context(sys.argv[1])
"""
SHOWN = """
        print(told(short), told(missing), told(fine), sep="; ")
"""
POOL = f"""
    with method.Pool(1) as pool:
        short, missing, fine = (
            pool.apply_async(rk.correlation_dimension, (section,)).get,
            pool.apply_async(rk.find_orbit, (free, rk.State(angle=0.5), 1)).get,
            pool.apply_async(rk.simulate, (free,)).get,
        )
{SHOWN}"""
EXECUTOR = f"""
    with ProcessPoolExecutor(1, mp_context=method) as pool:
        short, missing, fine = (
            pool.submit(rk.correlation_dimension, section).result,
            pool.submit(rk.find_orbit, free, rk.State(angle=0.5), 1).result,
            pool.submit(rk.simulate, free).result,
        )
{SHOWN}"""


@pytest.mark.parametrize("method", ["fork", "spawn"])
@pytest.mark.parametrize("pool", [POOL, EXECUTOR], ids=["pool", "executor"])
def test_refusal_in_a_process_arrives_with_what_it_carries(pool, method, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(BEGIN + pool)
    done = subprocess.run(
        [sys.executable, script, method], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.stderr == ""
    assert (
        done.stdout
        == "TooShort CorrelationDimension; NoOrbit State True; at-rest over 200 cycles; 0 impacts, peak |Θ| 0\n"
    )
