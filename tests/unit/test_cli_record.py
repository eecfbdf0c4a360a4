"""`rocking record`: report and files of a block under a recorded ground motion."""

import csv
import json
import math

import attrs
import numpy as np
import pytest

import record_files as write
import rocking as rk
from rocking.records.read import FILE as EXAMPLE_FILE

SIZE = "--height 2 --width 0.5"
BLOCK = rk.Block(2.0, 0.5)
PULSE = "time (s), acceleration (m/s²)\n0, 0\n0.2, 4\n0.4, -5\n0.6, 3\n0.8, 0\n"
PUSH = "time (s), acceleration (m/s²)\n0, 0\n0.5, 12\n1, 0\n"
GENTLE = "time (s), acceleration (m/s²)\n0, 0\n0.5, 1\n1, 0\n"


@pytest.fixture(autouse=True)
def records(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in {
        "pulse.csv": PULSE,
        "push.csv": PUSH,
        "gentle.csv": GENTLE,
        "bare.txt": "0\n4\n-4\n0\n",
    }.items():
        (tmp_path / name).write_text(text, encoding="utf-8")


def simulated(name, scale=1.0, block=BLOCK):
    return rk.simulate(block.system(rk.read_ground_motion(name).scaled(scale)))


def told(rocking, line):
    code, message, out = rocking(f"record {line}")
    assert (code, message) == (0, "")
    return out.splitlines()[0], " ".join(out.split())


def test_report_describes_record_block_and_motion_in_si(rocking):
    ground = rk.example_ground_motion().scaled(pga=0.6 * 9.80665)
    motion = rk.simulate(BLOCK.system(ground))
    first, text = told(rocking, f"example {SIZE} --pga-g 0.6")
    assert first == f"at rest permanently from t = {BLOCK.seconds(motion.events['time'][-1]):.4g} s"
    for shown in (
        "PGA 5.884 m/s² = 0.6 g",
        f"PGV {ground.pgv:.4g} m/s",
        f"drift {ground.displacement[-1]:.4g} m at the end",
        f"Arias intensity {ground.arias_intensity:.4g} m/s",
        f"significant duration {ground.significant_duration:.4g} s",
        f"impacts {motion.impacts} ",
        f"largest |θ| {BLOCK.degrees(motion.peak):.4g}°, top {BLOCK.top_displacement(motion.peak):.4g} m, {motion.peak:.4g} θcr",
        f"margin K₊ {motion.margin:.4g}: at t = {BLOCK.seconds(motion.margin_time):.4g} s the block lacked ",
        f"friction required {motion.validity(BLOCK).friction:.4g} (motion, t = ",
    ):
        assert shown in text
    assert "cycle" not in text
    assert "τ" not in text


def test_overturning_is_told_with_its_time_and_is_a_success(rocking):
    motion = simulated("push.csv")
    assert motion.outcome == "overturned"
    first, text = told(rocking, f"push.csv {SIZE}")
    assert first == f"overturned: certain from t = {BLOCK.seconds(motion.overturning.time):.4g} s"
    assert "more than it needed to overturn" in text
    assert "largest |θ|" not in text


def test_overturned_block_that_lacked_speed_before_says_so():
    from rocking.cli.reports_motion import margin_text

    motion = simulated("push.csv")
    early = margin_text(attrs.evolve(motion, margin=-0.1), BLOCK)
    assert early.endswith("°/s to overturn, but overturned later")
    stands = attrs.evolve(motion, margin=-0.1, outcome=rk.Outcome.BOUNDED)
    assert margin_text(stands, BLOCK).endswith("°/s to overturn")


def test_full_equation_of_motion_says_that_rounding_errors_are_not_assessed(rocking):
    motion = rk.simulate(BLOCK.system(rk.read_ground_motion("push.csv"), model="full"))
    first, text = told(rocking, f"push.csv {SIZE} --model full")
    doubt = "(proved for the computed motion; its rounding errors are not assessed)"
    assert first == f"overturned from t = {BLOCK.seconds(motion.overturning.time):.4g} s {doubt}"
    assert "largest |θ|" not in text
    assert "certain" not in text
    assert str(motion).startswith(f"{first}; ")
    assert told(rocking, f"pulse.csv {SIZE} --model full")[0].endswith(doubt)
    bounded = told(rocking, f"pulse.csv {SIZE} --model full --restitution 1")[0]
    assert bounded.endswith("(rounding errors are not assessed)")


def test_equation_of_motion_has_a_row_with_its_errors(rocking):
    error = 100 * (1 / math.cos(BLOCK.critical_angle) - 1)
    small = f"equation of motion small angles; moments overestimated by up to {error:.1f} %"
    assert f"{small} (--model full avoids this) time unit" in told(rocking, f"pulse.csv {SIZE}")[1]
    assert f"{small} time unit" in told(rocking, f"pulse.csv {SIZE} --brace-angle 0.5")[1]
    assert "equation of motion full time unit" in told(rocking, f"pulse.csv {SIZE} --model full")[1]


def test_block_that_never_moves_has_no_margin(rocking):
    first, text = told(rocking, f"gentle.csv {SIZE}")
    assert first == "at rest throughout"
    assert "margin K₊ undefined for a block that never moves" in text


def test_motion_without_losses_is_followed_for_the_length_of_the_record(rocking):
    first, text = told(rocking, f"pulse.csv {SIZE} --restitution 1 --brace-angle 0.5")
    assert first == "bounded over 0.8 s (neither rest nor overturning was proved)"
    assert "restitution e = 1, as given" in text
    assert "braces 7.018°, r = 1" in text
    assert "margin K₊ undefined between braces" in text


def test_undecided_outcome_is_said_in_the_first_line_and_in_a_warning():
    from rocking.cli.reports_motion import record_outcome, undecided

    motion = simulated("gentle.csv")
    doubtful = attrs.evolve(motion, certified=False)
    assert (
        record_outcome(doubtful, BLOCK) == f"{record_outcome(motion, BLOCK)} (undecided in double precision)"
    )
    assert list(undecided(motion)) == []
    assert len(list(undecided(doubtful))) == 1


@pytest.mark.parametrize(
    ("line", "motion"),
    [
        ("--scale 1.5", lambda: simulated("pulse.csv", 1.5)),
        ("--scale=-1.5", lambda: simulated("pulse.csv", -1.5)),
        ("--pga-g 0.7", lambda: simulated("pulse.csv", 0.7 * 9.80665 / 5)),
        ("--restitution 0.5", lambda: simulated("pulse.csv", block=rk.Block(2.0, 0.5, 0.5))),
        ("--inertia-ratio 1.5", lambda: simulated("pulse.csv", block=rk.Block(2.0, 0.5, inertia_ratio=1.5))),
        (
            "--angle 0.2 --velocity=-0.1",
            lambda: rk.simulate(BLOCK.system(rk.read_ground_motion("pulse.csv")), rk.State(0.2, -0.1)),
        ),
        (
            "--baseline mean",
            lambda: rk.simulate(BLOCK.system(rk.read_ground_motion("pulse.csv", baseline="mean"))),
        ),
    ],
)
def test_options_are_the_arguments_of_the_package(rocking, line, motion):
    code, _, out = rocking(f"record pulse.csv {SIZE} {line} --json")
    found, expected = json.loads(out, parse_constant=pytest.fail), motion()
    assert code == 0
    assert found["outcome"] == expected.outcome
    assert found["impacts"] == expected.impacts > 0
    data = expected.to_dict()
    for name in ("peak_rad", "margin_rad_per_s", "duration_s"):
        assert found[name] == pytest.approx(data[name], rel=1e-9)


def test_json_is_strict_and_has_no_cycles(rocking):
    motion = simulated("push.csv")
    code, _, out = rocking(f"record push.csv {SIZE} --json")
    found = json.loads(out, parse_constant=pytest.fail)
    assert code == 0
    assert "cycle" not in out
    assert found["overturning_time_s"] == pytest.approx(BLOCK.seconds(motion.overturning.time))
    assert found["certified"] is True
    assert found["ground_motion"]["pga_m_per_s2"] == 12.0
    assert len(found["ground_motion"]["file"]["sha256"]) == 64
    assert found["peak_rad"] == pytest.approx(BLOCK.radians(motion.peak))
    assert found["validity"]["overturned"] is True
    still = json.loads(rocking(f"record gentle.csv {SIZE} --json")[2], parse_constant=pytest.fail)
    assert (still["margin_rad_per_s"], still["margin_time_s"]) == (None, None)
    assert "overturning_time_s" not in still


def test_csv_has_a_row_per_sample_of_the_record_at_least(rocking, tmp_path):
    assert rocking(f"record example {SIZE} --pga-g 0.5 --csv motion.csv")[0] == 0
    with (tmp_path / "motion.csv").open(encoding="utf-8") as file:
        heading, *rows = csv.reader(file)
    table = dict(zip(heading, np.array(rows, float).T, strict=True))
    assert "time [s]" in table
    assert not any("cycle" in name for name in heading)
    motion = rk.simulate(BLOCK.system(rk.example_ground_motion().scaled(pga=0.5 * 9.80665)))
    np.testing.assert_allclose(table["time [s]"], 0.005 * np.arange(6001), rtol=0, atol=1e-9)
    angle, _ = motion.at(np.minimum(BLOCK.time(table["time [s]"]), motion.duration))
    np.testing.assert_allclose(table["angle [rad]"], BLOCK.radians(angle), rtol=1e-9, atol=1e-12)


def test_coarse_samples_are_divided_into_whole_parts(rocking, tmp_path):
    assert rocking(f"record pulse.csv {SIZE} --csv motion.csv")[0] == 0
    times = np.loadtxt(tmp_path / "motion.csv", delimiter=",", skiprows=1)[:, 0]
    assert times[1] <= BLOCK.seconds(1 / 32)
    assert 0.2 / times[1] == pytest.approx(round(0.2 / times[1]), abs=1e-9)


def test_netcdf_in_si_has_no_cycle_and_no_phase(rocking, tmp_path):
    import xarray as xr

    assert rocking(f"record pulse.csv {SIZE} --netcdf motion.nc")[0] == 0
    motion = simulated("pulse.csv")
    with xr.open_dataset(tmp_path / "motion.nc", engine="h5netcdf") as written:
        xr.testing.assert_allclose(written.load(), motion.to_xarray(block=BLOCK), rtol=1e-12, atol=1e-12)
        assert not {
            name for name in (*written.variables, *written.attrs) if "cycle" in name or "phase" in name
        }
        assert "cycle" not in written.attrs["comment"]
        assert written.attrs["margin_rad_per_s"] == pytest.approx(BLOCK.radians_per_second(motion.margin))
        assert written.base_acceleration.units == "m s-2"
        assert float(np.abs(written.base_acceleration).max()) == pytest.approx(5.0)


def test_header_that_contradicts_its_samples_is_a_warning(rocking, tmp_path):
    text = EXAMPLE_FILE.read_text(encoding="latin-1")
    stated = "0.1044078E+03"
    assert stated in text
    (tmp_path / "other.smc").write_text(text.replace(stated, "0.2222222E+03"), encoding="latin-1")
    _, said = told(rocking, f"other.smc {SIZE}")
    assert "PGA in the header 2.222 m/s², differs from the samples, 1.044 m/s²" in said
    assert "warning: other.smc: the samples have a PGA of 1.0441 m/s²" in said


def test_vertical_channel_is_a_warning(rocking, tmp_path):
    lines = "\n".join(write.csmip_v1([0.3 * np.sin(np.arange(60))] * 3)).replace("270 Deg", "Up")
    (tmp_path / "three.v1").write_text(lines, encoding="utf-8")
    said = "warning: the component Up is vertical, and the base moves horizontally: choose a horizontal component"
    assert said in told(rocking, f"three.v1 --channel 3 {SIZE}")[1]
    assert "vertical" not in told(rocking, f"three.v1 --channel 2 {SIZE}")[1]


def test_drift_is_a_warning_with_the_baseline_as_remedy(rocking, tmp_path):
    times = 0.01 * np.arange(6_000)
    shaken = rk.synthetic_ground_motions(1, seed=3, duration=59.99)[0].acceleration
    rows = ["time (s), acceleration (m/s²)", *map("{:.2f}, {:.6f}".format, times, shaken + 0.05)]
    (tmp_path / "drift.csv").write_text("\n".join(rows), encoding="utf-8")
    text = told(rocking, f"drift.csv {SIZE}")[1]
    assert (
        "warning: the PGV and PGD are those of a drift, because no baseline is removed and the velocity at"
        in text
    )
    assert "for example --baseline='linear'" in text
    assert "drift of" not in told(rocking, f"drift.csv {SIZE} --baseline linear")[1]
    assert "those of a drift" not in told(rocking, f"example {SIZE}")[1]


def test_more_events_than_are_kept_are_counted_and_refused_only_to_a_file(rocking, monkeypatch):
    monkeypatch.setattr("rocking.motion.march_loop.MAX_RECORDED", 10)
    first, text = told(rocking, f"pulse.csv {SIZE}")
    assert first == "at rest permanently"
    assert "warning: sliding and jumping of the block were not checked: too many events to keep" in text
    assert rocking(f"record pulse.csv {SIZE} --csv a.csv")[:2] == (2, "too many events for --csv: omit --csv")


def test_file_named_like_an_option_keeps_its_name(rocking, tmp_path):
    (tmp_path / "step.txt").write_text("0\n1\n", encoding="utf-8")
    assert rocking(f"record step.txt {SIZE}")[1].startswith("step.txt: the file does not state the unit")


def test_margin_has_the_sign_of_what_it_says():
    from rocking.cli.reports_motion import margin_text

    for motion in (simulated_pulse(scale) for scale in (1.0, 3.0)):
        said = margin_text(motion, BLOCK)
        assert ("lacked" in said) == (motion.margin < 0)
        speed = math.degrees(BLOCK.radians_per_second(abs(motion.margin)))
        assert f"{speed:.4g}°/s" in said


def simulated_pulse(scale):
    return rk.simulate(BLOCK.system(rk.GroundMotion([0.0, 4.0, -5.0, 3.0, 0.0], step=0.2).scaled(scale)))
