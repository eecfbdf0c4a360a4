"""`rocking classify`: verdicts in JSON, what is said of a real block, and proofs."""

import json
import math

import pytest

import rocking as rk
from rocking.model.system import angle_doubt

PERIODIC = "--amplitude 5.5 --period 0.5 --restitution 0.925 --phase 1.8 --velocity 0.15"
TENTH = rk.System(rk.Harmonic(5.5, period=0.5, phase=1.8), 0.925), rk.State(velocity=0.15)
RESET = "--amplitude 1.0111 --period 4.7531 --restitution 0.925"
FALLING = "--amplitude 1.75 --period 2 --restitution 0.95"
CHAOTIC = "--amplitude 10.103037 --period 1.721328 --restitution 0.8"
SI = "--height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2"


def told(rocking, line):
    code, message, out = rocking(f"classify {line} --json")
    assert (code, message) == (0, "")
    return json.loads(out, parse_constant=pytest.fail)


def test_json_of_a_response_that_forgets_has_null_and_says_superstable(rocking):
    read = told(rocking, RESET)
    assert (read["exponent"], read["superstable"]) == (None, True)
    assert (read["impacts_per_period"], read["multiplier_1_real"], read["multiplier_2_real"]) == (
        None,
        0.0,
        0.0,
    )
    assert "largest Lyapunov exponent −∞ (superstable)" in " ".join(rocking(f"classify {RESET}")[2].split())


def test_json_of_an_overturned_block_has_neither_orbit_nor_exponent(rocking):
    read = told(rocking, FALLING)
    names = (
        "response_period",
        "multiplier_1_real",
        "exponent",
        "exponent_error",
        "section_angle",
        "symmetric",
    )
    assert [read[name] for name in names] == [None] * len(names)
    assert read["superstable"] is False
    assert "largest |Θ|" not in rocking(f"classify {FALLING}")[2]


def test_json_in_si_has_the_displacement_of_the_top(rocking):
    read = told(rocking, SI)
    assert read["peak_top_displacement_m"] == pytest.approx(2.0 * math.sin(read["peak_rad"]), rel=1e-15)


def test_way_out_is_named_as_it_is_typed(rocking):
    out = rocking(f"classify {CHAOTIC} --max-cycles 500")[2]
    assert out.startswith("undetermined: no orbit of period up to 64 was reached, and 500 cycles are too few")
    assert "Evidence: none, after 500 cycles; increase --max-cycles to 10,000 or more." in " ".join(
        out.split()
    )
    assert "max_cycles" not in out


def test_period_looked_for_can_be_bounded(rocking):
    assert told(rocking, f"{PERIODIC} --max-period 9 --max-cycles 1000")["kind"] == "undetermined"
    assert told(rocking, f"{PERIODIC} --max-period 10 --max-cycles 1000")["kind"] == "periodic"


def test_interrupted_verdict_says_so_and_leaves_no_file(interrupted, tmp_path):
    line = f"classify {CHAOTIC} --max-cycles 1e8 --plot a.png"
    assert interrupted(line, 1.5) == (130, b"", b"rocking: interrupted\n")
    assert not list(tmp_path.iterdir())


def test_real_block_is_judged_over_a_period_of_its_response(rocking):
    line = "--height 2 --width 2 --acceleration-g 1.2 --frequency-hz 1.5"
    out = rocking(f"classify {line}")[2]
    block = rk.Block(2.0, 2.0)
    orbit = rk.classify(block.system(acceleration_g=1.2, frequency_hz=1.5)).orbit
    begun = block.system(acceleration_g=1.2, frequency_hz=1.5, phase=orbit.phase)
    found = rk.simulate(begun, orbit.state, cycles=orbit.period).validity(block)
    assert found.reaction < 0
    assert "\nmodel validity over one response period (τ measured from its start):\n" in out
    assert str(found) in out
    assert told(rocking, line)["validity"]["warnings"] == list(found.warnings)


def test_real_block_whose_response_has_no_period_is_judged_from_its_start(rocking):
    line = "--height 2 --width 0.5 --acceleration 6 --frequency-hz 1.2"
    block = rk.Block(2.0, 0.5)
    motion = rk.simulate(block.system(acceleration=6.0, frequency_hz=1.2))
    out = rocking(f"classify {line}")[2]
    assert f"\nmodel validity over the first {motion.cycles} cycle" in out
    assert str(motion.validity(block)) in out


def test_block_that_rocks_in_the_model_alone_is_said_to_stand_still(rocking):
    out = rocking("classify --height 1.8 --width 0.6 --acceleration-g 0.33 --frequency-hz 1.5")[2]
    assert "3.236 m/s² = 0.33 g lies between, where the real block remains at rest" in out


def test_start_in_degrees_is_hinted_at(rocking):
    degrees = rk.Block(1.8, 0.6).angle(degrees=3)
    line = "--height 1.8 --width 0.6 --acceleration 4 --frequency-hz 1.5 --angle"
    for command in ("classify", "simulate"):
        out = rocking(f"{command} {line} 3")[2]
        assert f"\nwarning: --{angle_doubt(3, f'3° is --angle {degrees:.4g}')}\n" in out
        assert "warning: --angle" not in rocking(f"{command} {line} 1.9")[2]


def test_proof_of_the_full_block_is_refused(rocking):
    code, message, out = rocking(f"classify {SI} --model full --prove")
    assert (code, out) == (2, "")
    assert (
        message == "proofs are available for the slender block only (omit --critical-angle and --model full)"
    )
