"""Stores: results equal those in memory, are never computed twice, and belong to one survey only."""

import errno
import gc
import json
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import zarr

import rocking as rk
from rocking.kernels.batch import METHOD
from rocking.survey import run_survey, zarr_store
from rocking.survey.memory import memory_size
from rocking.survey.store_access import ROOT
from rocking.survey.store_access import lock as lock_of_store
from rocking.survey.store_layout import check_same
from rocking.survey.zarr_files import Files
from stored_surveys import EVERY, OF_RECORDS, RECORDS
from surveyed import system_with

SIZE = 130
ASKED = {
    "system": system_with(restitution=0.9),
    "amplitude": np.linspace(0.0, 16.0, SIZE),
    "period": np.linspace(0.2, 3.0, SIZE),
    "max_cycles": 40,
}


@pytest.fixture(scope="module")
def plain():
    """The map in memory."""
    return rk.parametric_map(**ASKED).dataset


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The map in a store that tests must not change."""
    folder = tmp_path_factory.mktemp("made") / "map.zarr"
    rk.parametric_map(**ASKED, store=folder)
    return folder


@pytest.fixture
def copied(made, tmp_path):
    """Copy of the store, to be changed."""
    return shutil.copytree(made, tmp_path / "map.zarr")


@pytest.fixture
def computed(monkeypatch):
    """Points computed from here on."""
    count = []
    compute = run_survey.compute
    monkeypatch.setattr(
        run_survey, "compute", lambda batch, stop: count.append(batch.wanted.size) or compute(batch, stop)
    )
    return lambda: sum(count)


def level(folder, number):
    return xr.open_zarr(folder, group=f"level-{number}", chunks=None, consolidated=False)


def files(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_map_from_a_store_is_the_map_in_memory(plain, made):
    kept = rk.parametric_map(**ASKED, store=made).dataset
    assert kept.load().equals(plain)
    assert {name: kept.attrs[name] for name in plain.attrs} == plain.attrs


def test_every_level_is_a_plain_grid_that_opens_in_xarray(plain, made):
    for number, step in ((2, 1), (1, 2), (0, 4)):
        coarse = level(made, number).load()
        assert coarse.equals(plain.isel(amplitude=slice(None, None, step), period=slice(None, None, step)))
        assert coarse.kind.attrs["flag_meanings"].split() == [str(kind) for kind in rk.Kind]
        assert coarse.kind.dtype == np.uint8
    assert not (made / "level-3").exists()


def test_store_is_zarr_3_with_checksums_and_one_chunk_a_tile(made):
    array = zarr.open_array(made / "level-2" / "peak", mode="r")
    assert array.metadata.zarr_format == 3
    assert [type(codec).__name__ for codec in array.compressors] == ["BloscCodec", "Crc32cCodec"]
    assert len(list((made / "level-2" / "peak" / "c").rglob("*/*"))) == 16
    assert array.metadata.dimension_names == ("amplitude", "period")


def test_what_is_computed_is_never_the_value_of_what_is_not(made):
    for number in range(3):
        for name, array in zarr.open_group(made / f"level-{number}", mode="r").arrays():
            assert not (array[:] == array.fill_value).any(), name


def test_nothing_is_computed_twice(made, computed):
    before = files(made)
    rk.parametric_map(**ASKED, store=made)
    assert computed() == 0
    assert files(made) == before


def test_what_others_leave_in_its_folders_is_none_of_its_business(copied, computed):
    for folder in [each for each in copied.glob("level-*/cycles/**") if each.is_dir()]:
        (folder / ".listing").touch()
    rk.parametric_map(**ASKED, store=copied)
    assert computed() == 0


def test_every_point_is_computed_once(tmp_path, computed):
    rk.parametric_map(**ASKED, store=tmp_path / "map.zarr")
    assert computed() == SIZE**2


def test_block_that_never_moves_leaves_a_store_that_is_done(tmp_path, computed):
    asked = ASKED | {"amplitude": np.linspace(0.0, 0.9, 20), "store": tmp_path / "map.zarr"}
    assert (rk.parametric_map(**asked).dataset.kind == 0).all()
    rk.parametric_map(**asked)
    assert computed() == 20 * SIZE


def test_longer_axes_extend_it(copied, computed):
    longer = {name: np.append(ASKED[name], ASKED[name][-1] + step * np.arange(1, 31)) for name, step in
              (("amplitude", 16.0 / (SIZE - 1)), ("period", 2.8 / (SIZE - 1)))}  # fmt: skip
    extended = rk.parametric_map(**(ASKED | longer), store=copied).dataset.load()
    assert computed() == (SIZE + 30) ** 2 - SIZE**2
    assert extended.equals(rk.parametric_map(**(ASKED | longer)).dataset)
    again = rk.parametric_map(**(ASKED | longer), store=copied).dataset
    assert computed() == 2 * (SIZE + 30) ** 2 - SIZE**2
    assert again.load().equals(extended)


def test_axis_made_longer_that_rounds_otherwise_keeps_the_values_there(copied, computed):
    spacing = ASKED["period"][1] - ASKED["period"][0]
    longer = np.linspace(0.2, 3.0 + 4 * spacing, SIZE + 4)
    assert (longer[:SIZE] != ASKED["period"]).any()
    extended = rk.parametric_map(**(ASKED | {"period": longer}), store=copied).dataset
    assert computed() == 4 * SIZE
    assert np.array_equal(extended.period[:SIZE], ASKED["period"])


def test_half_the_spacing_refines_it(copied, computed, plain):
    closer = {
        "amplitude": np.linspace(0.0, 16.0, 2 * SIZE - 1),
        "period": np.linspace(0.2, 3.0, 2 * SIZE - 1),
    }
    refined = rk.parametric_map(**(ASKED | closer), store=copied).dataset.load()
    assert computed() == (2 * SIZE - 1) ** 2 - SIZE**2
    assert refined.isel(amplitude=slice(None, None, 2), period=slice(None, None, 2)).equals(plain)
    assert level(copied, 3).load().equals(rk.parametric_map(**(ASKED | closer)).dataset)
    assert level(copied, 2).load().equals(plain)


def test_one_axis_alone_is_refined_and_extended_at_once(copied, computed):
    changed = {"amplitude": np.linspace(0.0, 32.0, 4 * (SIZE - 1) + 1)}
    found = rk.parametric_map(**(ASKED | changed), store=copied).dataset.load()
    assert computed() == 4 * (SIZE - 1) * SIZE + SIZE - SIZE**2
    assert found.equals(rk.parametric_map(**(ASKED | changed)).dataset)


@pytest.mark.parametrize("step", [0, 1, 2, 7])
def test_extension_killed_between_its_steps_is_taken_up(copied, monkeypatch, step):
    longer = ASKED | {"period": np.append(ASKED["period"], [3.1, 3.2])}
    resize, left = zarr.Array.resize, [step]

    def killed(array, shape):
        left[0] -= 1
        return resize(array, shape) if left[0] >= 0 else 1 / 0

    with monkeypatch.context() as patch:
        patch.setattr(zarr.Array, "resize", killed)
        with pytest.raises(ZeroDivisionError):
            rk.parametric_map(**longer, store=copied)
    assert (
        rk.parametric_map(**longer, store=copied).dataset.load().equals(rk.parametric_map(**longer).dataset)
    )


@pytest.mark.parametrize(
    "written", [*(pytest.param(k, marks=pytest.mark.long) for k in (0, 1, 3, 37, 60)), 30, 44]
)
def test_extension_that_ends_between_two_files_is_resumed_to_the_same_bytes(
    made, copied, tmp_path, monkeypatch, written
):
    longer = ASKED | {"period": np.append(ASKED["period"], [3.1, 3.2])}
    whole = shutil.copytree(made, tmp_path / "undisturbed.zarr")
    rk.parametric_map(**longer, store=whole)
    write, left = Files.set_sync, [written]

    def killed(files, key, value):
        left[0] -= 1
        return write(files, key, value) if left[0] >= 0 else 1 / 0

    with monkeypatch.context() as patch:
        patch.setattr(Files, "set_sync", killed)
        with pytest.raises(ZeroDivisionError):
            rk.parametric_map(**longer, store=copied)
    rk.parametric_map(**longer, store=copied)
    assert files(copied) == files(whole)


LEFT_OUT = {
    "a tile": lambda folder: [path.unlink() for path in folder.glob("level-2/cycles/*/1/2")] and {},
    "longer axes": lambda folder: {"period": np.append(ASKED["period"], 3.1)},
    "a damaged tile": lambda folder: (folder / "level-1/peak/c/0/1").write_bytes(b"") or {"repair": True},
}


MOVES = {
    "renamed": lambda folder: folder.rename(folder.with_name("elsewhere")),
    "deleted": shutil.rmtree,
    "replaced": lambda folder: (folder.rename(folder.with_name("elsewhere")), folder.mkdir()),
}


@pytest.mark.parametrize("tiles", [1, 6, 21])
@pytest.mark.parametrize("how", MOVES)
def test_store_that_is_moved_or_deleted_during_the_run_ends_it_and_nothing_is_written_in_its_place(
    tmp_path, monkeypatch, how, tiles
):
    folder, write, left = tmp_path / "map.zarr", zarr_store.Store.write, [tiles]

    def moving(kept, tile, answers):
        write(kept, tile, answers)
        left[0] -= 1
        if left[0] == 0:
            MOVES[how](folder)

    monkeypatch.setattr(zarr_store.Store, "write", moving)
    message = (
        f"store {str(folder)!r} was moved, deleted or replaced during the run, which writes nothing more "
        "(run again with the folder in its place, or with another one)"
    )
    with pytest.raises(OSError, match=f"^{re.escape(message)}$"):
        rk.parametric_map(**ASKED, store=folder)
    assert how != "replaced" or not files(folder)
    assert how == "replaced" or not folder.exists()
    if how == "renamed":  # and it is good
        folder.with_name("elsewhere").rename(folder)
        rk.parametric_map(**ASKED, store=folder)


def test_file_that_is_lost_during_the_run_ends_it(copied, monkeypatch):
    monkeypatch.setattr(zarr_store, "MAX_HELD", 0)
    longer = ASKED | {"amplitude": np.linspace(0.0, 16.0, 2 * SIZE - 1)}
    run = run_survey.run

    def losing(*arguments):
        (copied / "level-2/peak/c/0/0").unlink()
        run(*arguments)

    monkeypatch.setattr("rocking.survey.run_survey.run", losing)
    with pytest.raises(OSError, match="lost files during the run \\(run again to recompute them\\)"):
        rk.parametric_map(**longer, store=copied)


@pytest.fixture
def locked(made, monkeypatch):
    """Copy of the store in a folder where this process can only read, as an ordinary user; `out` beside it takes files."""
    place = Path(tempfile.mkdtemp())
    folder = shutil.copytree(made, place / "map.zarr")
    (place / "out").mkdir()
    (place / "out").chmod(0o777)
    monkeypatch.chdir(place)

    def lock():
        for path in (*folder.rglob("*"), folder, place):
            path.chmod(0o555 if path.is_dir() else 0o444)
        if os.geteuid() == 0:
            os.seteuid(65_534)

    yield folder, lock
    os.seteuid(os.getuid())
    for path in (place, folder, *folder.rglob("*")):
        path.chmod(0o755)
    shutil.rmtree(place)


def map_line(folder):
    return f"map --amplitude 0:16:{SIZE} --period 0.2:3:{SIZE} --restitution 0.9 --max-cycles 40 --store {folder}"


def test_complete_store_where_nothing_can_be_written_is_read_and_drawn(locked, plain, rocking, computed):
    (folder, lock), before = locked, files(locked[0])
    os.chdir(folder.parent)
    # Python's own modules may be closed to the ordinary user, so they are loaded before.
    rocking(f"{map_line(folder)} --plot out/map.png --netcdf out/map.nc")
    lock()
    with lock_of_store(folder, shared=True):  # of another process that reads it
        code, message, _ = rocking(f"{map_line(folder)} --plot out/map.png --netcdf out/map.nc")
    assert (code, message) == (0, "")
    assert xr.load_dataset("out/map.nc").kind.equals(plain.kind)
    rk.plot.parametric_map(folder)
    assert (computed(), files(folder)) == (0, before)


@pytest.mark.parametrize("left_out", LEFT_OUT)
def test_incomplete_store_where_nothing_can_be_written_is_refused(locked, left_out, computed):
    folder, lock = locked
    changed = LEFT_OUT[left_out](folder)
    lock()
    message = f"store {str(folder)!r} lacks some of these points and cannot be resumed: its folder cannot be written"
    with pytest.raises(OSError, match=re.escape(message)):
        rk.parametric_map(**(ASKED | changed), store=folder)
    assert computed() == 0
    with pytest.raises(OSError, match="^store must be a folder that can be written; got 'new.zarr'$"):
        rk.parametric_map(**ASKED, store="new.zarr")


@pytest.mark.parametrize("written", [0, *(pytest.param(k, marks=pytest.mark.long) for k in (1, 3, 8)), 30])
def test_full_disk_while_a_store_is_made_is_said_once(tmp_path, monkeypatch, caplog, plain, written):
    write, left = Files.set_sync, [written]

    def full(files, key, value):
        left[0] -= 1
        if left[0] < 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        write(files, key, value)

    with monkeypatch.context() as patch:
        patch.setattr(Files, "set_sync", full)
        with pytest.raises(
            OSError,
            match=r"cannot be written: No space left on device; existing data are unchanged \(free some space, or give another path\)",
        ):
            rk.parametric_map(**ASKED, store=tmp_path / "map.zarr")
    gc.collect()
    assert not caplog.records, "of a task that was left alone asyncio tells"
    assert rk.parametric_map(**ASKED, store=tmp_path / "map.zarr").dataset.load().equals(plain)


def test_damaged_coordinate_is_written_again(copied, plain):
    (copied / "level-2" / "period" / "c" / "0").write_bytes(b"no number")
    assert rk.parametric_map(**ASKED, store=copied).dataset.load().equals(plain)


def test_who_interrupts_the_reading_of_a_store_is_told_that_it_is_complete(tmp_path, monkeypatch):
    def interrupt(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(zarr_store.Store, "dataset", interrupt)
    with pytest.raises(KeyboardInterrupt) as caught:
        rk.parametric_map(**ASKED, store=tmp_path / "map.zarr")
    told = f"The survey is complete in {str(tmp_path / 'map.zarr')!r}; run it again to read the results."
    assert caught.value.__notes__ == [told]


@pytest.mark.parametrize("name", EVERY)
def test_every_survey_that_is_interrupted_is_resumed_and_repaired_to_the_result_in_memory(
    name, tmp_path, monkeypatch, computed
):
    survey, arguments = EVERY[name]
    folder, write, left = tmp_path / "survey.zarr", zarr_store.Store.write, [1]
    with ThreadPoolExecutor(2) as threads:
        plain, whole = survey(**arguments, executor=threads).to_xarray().load(), computed()

    def interrupted(kept, tile, answers):
        left[0] -= 1
        if left[0] < 0:
            raise KeyboardInterrupt
        write(kept, tile, answers)

    with monkeypatch.context() as patch:
        patch.setattr(zarr_store.Store, "write", interrupted)
        with pytest.raises(KeyboardInterrupt) as caught:
            survey(**arguments, store=folder)
    assert "run it again to resume" in caught.value.__notes__[0]
    before = computed()
    assert survey(**arguments, store=folder).to_xarray().load().identical(plain)
    assert 0 < computed() - before < whole
    damaged = next(path for path in folder.glob("**/level-*/*/digests/**/*") if path.is_file())
    Path(str(damaged).replace("digests", "c")).write_bytes(b"")
    with pytest.raises(OSError, match="recompute these tiles with repair"):
        survey(**arguments, store=folder)
    before = computed()
    assert survey(**arguments, store=folder, repair=True).to_xarray().load().identical(plain)
    assert 0 < computed() - before < whole


@pytest.mark.parametrize(
    "name, changed",
    [
        ("safe basin", {"samples": 150, "amplitude": [4.0, 5.0, 6.0]}),
        ("basins", {"samples": 150}),
        ("experiment", {"samples": 150}),
        ("chaos", {"restitution": [0.5, 0.9, 0.95]}),
        ("overturning set", {"levels": np.append(OF_RECORDS["levels"], [4.1, 4.2])}),
        ("sensitivity", {"levels": np.append(OF_RECORDS["levels"], [4.1, 4.2])}),
    ],
)
def test_more_samples_and_more_levels_extend_a_store(name, changed, tmp_path, computed):
    survey, arguments = EVERY[name]
    survey(**arguments, store=tmp_path)
    before = computed()
    longer = survey(**(arguments | changed), store=tmp_path).to_xarray().load()
    added = computed() - before
    assert longer.identical(survey(**(arguments | changed)).to_xarray().load())
    assert 0 < added < computed() - before - added


def test_store_of_one_random_initial_state_is_read_again(tmp_path, computed):
    survey, arguments = EVERY["safe basin"]
    for _ in range(2):
        survey(**(arguments | {"samples": 1}), store=tmp_path)
    assert computed() == 2


OTHER_RECORDS = {
    "sensitivity": ({"records": RECORDS[0].scaled(2.0)}, "the ground motions are others"),
    "overturning set": (
        {"records": rk.synthetic_ground_motions(2, seed=4, duration=4.0)},
        "the ground motions are others (",
    ),
    "fragility": ({"samples": 3}, "samples is 2 there and 3 here ("),
    "safe basin": ({"angle": (-0.5, 1.0)}, "angle_range is [-1.0] there and [-0.5] here ("),
    "basins": ({"seed": 1}, "seed is 0 there and 1 here ("),
    "chaos": ({"samples": 110}, "samples is 100 there and 110 here ("),
    "experiment": ({"relative": 0.02}, "relative is 0.01 there and 0.02 here ("),
}


@pytest.mark.parametrize("name", OTHER_RECORDS)
def test_store_of_other_records_or_samples_is_refused_with_what_differs(name, tmp_path):
    (survey, arguments), (changed, differs) = EVERY[name], OTHER_RECORDS[name]
    survey(**arguments, store=tmp_path)
    with pytest.raises(ValueError, match=f"holds a different survey: .*{re.escape(differs)}"):
        survey(**(arguments | changed), store=tmp_path)


@pytest.mark.parametrize(
    "name, axis, values",
    [("overturning set", "levels", np.linspace(1.0, 4.0, 79)), ("chaos", "restitution", [0.5, 0.7, 0.9])],
)
def test_store_of_results_that_depend_on_their_neighbours_is_not_refined(name, axis, values, tmp_path):
    survey, arguments = EVERY[name]
    survey(**arguments, store=tmp_path)
    message = " are others (give these values; more values beyond the last are possible)"
    with pytest.raises(ValueError, match=f"the requested {len(values)} from .*{re.escape(message)}"):
        survey(**(arguments | {axis: values}), store=tmp_path)


STRANGERS = {
    "another restitution": (
        {"system": system_with(restitution=0.8)},
        "restitution is 0.9 there and 0.8 here",
    ),
    "a restitution with all its digits": (
        {"system": system_with(restitution=0.8925501432664756)},
        "restitution is 0.9 there and 0.89255 here (",
    ),
    "nearly the same restitution": (
        {"system": system_with(restitution=0.9 + 1e-9)},
        "restitution is 0.9 there and 0.900000001 here (",
    ),
    "more cycles, another start": (
        {"max_cycles": 50, "start": rk.State(0.1)},
        "angle is 0 there and 0.1 here; max_cycles is 40 there and 50 here",
    ),
    "braces": (
        {"system": system_with(restitution=0.9, brace_angle=1.0)},
        "brace_angle is not given there and 1 here; brace_restitution is not",
    ),
    "other axes": (
        {"period": None, "frequency": np.linspace(1.0, 2.0, 9)},
        "the axes are amplitude and period there and amplitude and frequency here",
    ),
}


@pytest.mark.parametrize("what", STRANGERS)
def test_store_of_another_survey_is_refused_with_what_differs(made, what):
    changed, differences = STRANGERS[what]
    before = files(made)
    with pytest.raises(ValueError, match=f"holds a different survey: {re.escape(differences)}"):
        rk.parametric_map(**(ASKED | changed), store=made)
    assert files(made) == before


def test_store_of_other_variables_is_told_by_those_that_only_one_has():
    there = {"survey": "map", "variables": [*"abcdefghij" * 9, "angle"], "fixed": {}, "options": {}}
    with pytest.raises(ValueError, match=r"variables is \['angle'\] there and \['peak'\] here"):
        check_same("map.zarr", there, there | {"variables": [*"abcdefghij" * 9, "peak"]})
    long = {"survey": "map" * 40 + "a"}
    with pytest.raises(ValueError, match="survey is one there and another here"):
        check_same("map.zarr", long, {"survey": "map" * 40 + "b"})


def stated(folder, **changed):
    """Change what a store says about its survey; None removes an entry."""
    root = folder / "zarr.json"
    described = json.loads(root.read_text())
    said = described["attributes"]["rocking_survey"] | changed
    described["attributes"]["rocking_survey"] = {
        name: each for name, each in said.items() if each is not None
    }
    root.write_text(json.dumps(described))


def outdated(folder, monkeypatch, what):
    """Make a store one of another method, or one of a format without digests; return what is said of it."""
    if what == "method":
        monkeypatch.setattr("rocking.kernels.batch.METHOD", METHOD + 1)
        return f"its results are those of method {METHOD}, and this version computes with method {METHOD + 1}"
    stated(folder, format=2)
    for level in folder.glob("level-*"):
        shutil.rmtree(level / "cycles" / "digests")
    return "its format 2 does not bind tiles to their survey, as format 3 does"


@pytest.mark.parametrize("what", ["method", "format"])
def test_complete_store_of_another_method_or_older_format_is_read_with_a_warning(
    copied, monkeypatch, what, computed, plain
):
    told = outdated(copied, monkeypatch, what)
    before = files(copied)
    with pytest.warns(rk.InputWarning, match=re.escape(f"read from store {str(copied)!r}: {told}")) as warned:
        kept = rk.parametric_map(**ASKED, store=copied).dataset
    assert warned[0].filename == __file__
    assert kept.load().equals(plain)
    assert kept.attrs["method"] == METHOD
    rk.plot.parametric_map(copied)
    assert level(copied, 2).load().equals(plain)
    assert (computed(), files(copied)) == (0, before)


def test_command_says_in_one_line_that_it_reads_a_store_of_an_older_format(copied, monkeypatch):
    told = outdated(copied, monkeypatch, "format")
    done = subprocess.run(
        [sys.executable, "-m", "rocking", *map_line(copied).split()],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (
        0,
        f"rocking: all results are read from store {str(copied)!r}: {told}\n",
    )


@pytest.mark.parametrize("left_out", LEFT_OUT)
@pytest.mark.parametrize("what", ["method", "format"])
def test_incomplete_store_of_another_method_or_older_format_is_drawn_and_not_resumed(
    copied, monkeypatch, what, left_out, computed
):
    told = outdated(copied, monkeypatch, what)
    changed = LEFT_OUT[left_out](copied)
    before = files(copied)
    message = f"store {str(copied)!r} lacks some of these points and cannot be resumed: {told} (give another folder;"
    with pytest.raises(OSError, match=re.escape(message)):
        rk.parametric_map(**(ASKED | changed), store=copied)
    assert (computed(), files(copied)) == (0, before)
    if left_out != "a damaged tile":
        rk.plot.parametric_map(copied)


def test_damage_of_a_store_that_cannot_be_resumed_is_named(copied, monkeypatch):
    outdated(copied, monkeypatch, "format")
    (copied / "level-1/peak/c/0/1").write_bytes(b"")
    with pytest.raises(
        OSError, match=r"is damaged at '.*/level-1/peak/c/0/1' \(restore these files, or give"
    ):
        rk.parametric_map(**ASKED, store=copied)


def test_store_of_a_format_that_cannot_be_read_is_refused(copied):
    stated(copied, format=None)
    before = files(copied)
    with pytest.raises(ValueError, match="holds a different survey: format is not given there and 3 here"):
        rk.parametric_map(**ASKED, store=copied)
    assert files(copied) == before


@pytest.mark.parametrize(
    "axis", [np.linspace(0.0, 16.0, SIZE - 1), np.linspace(0.1, 16.0, SIZE), np.linspace(-0.0, 15.9, SIZE)]
)
def test_axes_that_leave_out_what_is_there_are_refused(made, axis):
    with pytest.raises(
        ValueError, match="holds 130 values of amplitude from 0 to 16; the requested .* omit some of them"
    ):
        rk.parametric_map(**(ASKED | {"amplitude": axis}), store=made)


def test_repair_without_a_store_is_refused():
    with pytest.raises(ValueError, match="repair must be used with store, whose damaged tiles it recomputes"):
        rk.parametric_map(**ASKED, repair=True)


def refused(folder, message):
    with pytest.raises(OSError, match=f"^{re.escape(message)}$"):
        rk.parametric_map(**ASKED, store=folder)


def test_store_that_is_a_file_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("map.zarr").write_text("mine")
    refused("map.zarr", "store must be the path of a folder; got 'map.zarr', which is a file")
    refused("map.zarr/in", "store must be a folder that can be written; got 'map.zarr/in'")
    assert Path("map.zarr").read_text() == "mine"


def test_folder_of_a_run_killed_at_its_first_file_is_taken(tmp_path):
    (tmp_path / "map.zarr").mkdir()
    (tmp_path / "map.zarr" / f"zarr.{'0123' * 8}.partial").touch()
    rk.parametric_map(**ASKED, store=tmp_path / "map.zarr")
    assert not list(tmp_path.rglob("*.partial"))


@pytest.mark.parametrize(
    "name", ["thesis.tex.partial", "zarr.json.partial", f"zarr.{'0123' * 8}.partial.txt"]
)
def test_folder_of_somebodys_unfinished_files_is_refused_and_they_stay(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    Path("download").mkdir()
    Path("download", name).write_text("mine")
    with pytest.raises(
        OSError,
        match="^store must be a new folder, or the folder of an earlier survey; got 'download', which is",
    ):
        rk.parametric_map(**ASKED, store="download")
    assert [each.name for each in Path("download").iterdir()] == [name]
    assert Path("download", name).read_text() == "mine"


OWN = ("notes.partial", "level-0/notes.partial", "level-0/peak/c/0/0.partial", f"level-0/peak/c/0/peak.{'0123' * 8}.partial")  # fmt: skip
EMPTY = ("mine", "level-0/mine", "level-0/peak/mine", "level-0/x.partial", f"level-0/peak/c/0/0.{'0123' * 8}.partial")  # fmt: skip


def test_what_others_keep_in_a_store_stays_and_what_a_killed_run_left_goes(copied, computed):
    for name in OWN:
        (copied / name).write_text("mine")
    for name in EMPTY:
        (copied / name).mkdir()
    (copied / "level-0" / "lost").symlink_to("nowhere")
    (copied / "level-7" / "peak" / "c" / "0").mkdir(parents=True)
    for left in ("zarr", "level-0/zarr", "level-0/peak/zarr", "level-0/peak/c/0/1", "level-7/peak/c/0/12"):
        (copied / f"{left}.{'89ab' * 8}.partial").touch()
    rk.parametric_map(**ASKED, store=copied)
    assert computed() == 0
    assert [(copied / name).read_text() for name in OWN] == ["mine"] * len(OWN)
    assert all((copied / name).is_dir() for name in EMPTY)
    assert (copied / "level-0" / "lost").is_symlink()
    assert not list(copied.rglob(f"*.{'89ab' * 8}.partial"))
    assert not (copied / "level-7").exists()


def test_what_others_keep_in_a_store_is_passed_over_without_a_warning(copied, plain):
    for place in (copied, copied / "level-0", copied / "level-2", copied / "level-2" / "peak"):
        (place / "mine").mkdir()
        (place / "mine" / "notes.txt").write_text("mine")
        (place / "notes.txt").write_text("mine")
    assert rk.parametric_map(**ASKED, store=copied).dataset.load().equals(plain)


def test_store_of_another_survey_is_left_as_a_killed_run_left_it(copied):
    left = copied / f"zarr.{'0123' * 8}.partial"
    left.touch()
    with pytest.raises(ValueError, match="holds a different survey"):
        rk.parametric_map(**(ASKED | {"max_cycles": 50}), store=copied)
    assert left.exists()


def test_link_is_followed_to_a_store_that_is_not_there_yet(tmp_path, plain):
    (tmp_path / "link").symlink_to("map.zarr")
    assert rk.parametric_map(**ASKED, store=tmp_path / "link").dataset.load().equals(plain)
    assert (tmp_path / "map.zarr" / "zarr.json").is_file()


def test_path_that_no_folder_can_have_is_refused(tmp_path, monkeypatch):
    (tmp_path / "loop").symlink_to("loop")
    for path in (tmp_path / "loop", tmp_path / ("a" * 300), tmp_path / "\0"):
        with pytest.raises(OSError, match="^store must be a path that can exist; got ") as caught:
            rk.parametric_map(**ASKED, store=path)
        assert len(str(caught.value).splitlines()) == 1
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    refused(
        "map", "store must be a path that can exist; got 'map': the working directory does not exist any more"
    )


def test_folder_that_holds_something_else_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("map.zarr").mkdir()
    Path("map.zarr/notes.txt").write_text("mine")
    refused(
        "map.zarr",
        "store must be a new folder, or the folder of an earlier survey; got 'map.zarr', which is a folder that contains 'notes.txt'",
    )
    assert [path.name for path in Path("map.zarr").iterdir()] == ["notes.txt"]


def test_zarr_store_of_somebody_else_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    xr.Dataset({"rain": ("day", [1.0, 2.0])}).to_zarr("map.zarr", zarr_format=3, consolidated=False)
    before = files(Path("map.zarr"))
    refused(
        "map.zarr",
        "store must be a new folder, or the folder of an earlier survey; got 'map.zarr', which is a Zarr store of other data",
    )
    assert files(Path("map.zarr")) == before


def test_more_points_than_memory_holds_need_a_store():
    many = {"amplitude": np.linspace(0.0, 16.0, 1_000_000), "period": np.linspace(0.2, 3.0, 1_000_000)}
    with pytest.raises(
        ValueError, match=r"1,000,000,000,000 points take .* GB, too much .* \(give store, a folder"
    ):
        rk.parametric_map(**(ASKED | many))


def test_more_points_than_a_store_takes_are_refused_and_nothing_is_written(tmp_path):
    many = {"amplitude": np.linspace(0.0, 16.0, 1_000_000), "period": np.linspace(0.2, 3.0, 100_001)}
    with pytest.raises(
        ValueError, match=r"^store must hold 100,000,000,000 points at most; got 100,001,000,000"
    ):
        rk.parametric_map(**(ASKED | many), store=tmp_path / "map.zarr")
    assert not list(tmp_path.iterdir())


def test_limit_of_the_memory_of_the_process_counts(monkeypatch):
    monkeypatch.setattr(resource, "getrlimit", lambda which: (5 * 10**8, 10**12))
    many = {"amplitude": np.linspace(0.0, 16.0, 3_000), "period": np.linspace(0.2, 3.0, 3_000)}
    with pytest.raises(
        ValueError, match=r"0\.423 GB, too much for the memory that this process may use, 0\.5 GB"
    ):
        rk.parametric_map(**(ASKED | many))


def test_limit_of_the_memory_of_a_container_counts(tmp_path, monkeypatch):
    limits = [tmp_path / name for name in ("memory.max", "memory.limit_in_bytes", "missing")]
    monkeypatch.setattr("rocking.survey.memory.LIMITS", limits)
    for first, second in (("400000000\n", "9223372036854771712\n"), ("max\n", "400000000\n")):
        limits[0].write_text(first)
        limits[1].write_text(second)
        assert memory_size() == 4e8


def refusal(deep):
    with pytest.raises(OSError) as caught:
        rk.parametric_map(**ASKED, store=deep)
    return str(caught.value)


def test_messages_about_a_store_with_a_long_path_stay_short(made, tmp_path):
    deep = shutil.copytree(made, tmp_path / ("a" * 150) / "map.zarr")
    with lock_of_store(deep, shared=False):
        said = {"is in use by another run": refusal(deep)}
    for chunk in deep.glob("level-1/*/c/*/*"):
        chunk.write_bytes(b"")
    said["; … (recompute these tiles with repair)"] = refusal(deep)
    (deep / ROOT).write_text("{")
    said["is damaged: one of its files"] = refusal(deep)
    (deep / ROOT).unlink()
    said["which is a folder that contains"] = refusal(deep)
    for told, message in said.items():
        assert told in message
        assert "a" * 150 not in message


def test_store_that_does_not_fit_into_the_memory_is_not_called_damaged(made, monkeypatch):
    def fail(*_, **__):
        raise MemoryError

    for name, read in (
        ("zarr.open_group", lambda: rk.parametric_map(**ASKED, store=made)),
        ("xarray.Dataset.load", lambda: rk.plot.parametric_map(made)),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(name, fail)
            with pytest.raises(MemoryError):
                read()


DAMAGE = {
    "a bit": lambda data: data[:100] + bytes([data[100] ^ 1]) + data[101:],
    "cut short": lambda data: data[: len(data) // 2],
    "empty": lambda data: b"",
    "longer": lambda data: data + b"more",
    "missing": None,
}


@pytest.mark.parametrize("name", ["exponent/c", "cycles/c", "cycles/digests"])
@pytest.mark.parametrize("what", DAMAGE)
def test_damage_is_found_named_and_mended_on_request(copied, what, name, computed, plain):
    whole = files(copied)
    place = f"level-2/{name}/1/2"
    chunk = copied / place
    if what == "missing":
        chunk.unlink()
    else:
        chunk.write_bytes(DAMAGE[what](chunk.read_bytes()))
    if (what, name) != ("missing", "cycles/digests"):  # that is a tile which was never done
        if (what, name) == ("a bit", "cycles/digests"):
            place = "level-2/kind/c/1/2"  # whose digest is another one now
        with pytest.raises(
            OSError,
            match=f"is damaged at {re.escape(repr(str(copied / place)))} \\(recompute these tiles with repair\\)",
        ):
            rk.parametric_map(**ASKED, store=copied)
    assert rk.parametric_map(**ASKED, store=copied, repair=True).dataset.load().equals(plain)
    tile = math.prod(zarr.open_array(copied / "level-2" / "kind", mode="r").chunks)
    assert computed() <= tile - (tile**0.5 // 2) ** 2
    assert files(copied) == whole


@pytest.mark.parametrize("name", ["level-2/kind/c/1/2", "level-1/kind/c/0/0", "level-0/kind/zarr.json"])
@pytest.mark.parametrize("draw", [rk.plot.parametric_map, lambda store: rk.plot.tiles(store, "look")])
def test_damaged_store_is_not_drawn(copied, name, draw, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if name.startswith("level-1"):  # which serves where the finer one has nothing
        (copied / "level-2/kind/c/0/0").unlink()
    (copied / name).write_bytes(b"[]")
    message = (
        f"result must be the folder of a store that can be read; got {str(copied)!r}, which is damaged: "
    )
    with pytest.raises(OSError, match=re.escape(message) + "repeat the survey that made it with repair"):
        draw(copied)
    assert not Path("look").exists()


@pytest.mark.parametrize("name", ["zarr.json", "level-1/kind/zarr.json"])
def test_damaged_description_is_refused(copied, name):
    (copied / name).write_text("{")
    with pytest.raises(OSError, match="is damaged: one of its files zarr.json cannot be read"):
        rk.parametric_map(**ASKED, store=copied)


BROKEN = {
    "something else": lambda said: [1, 2],
    "no tiles": lambda said: {name: each for name, each in said.items() if name != "tiles"},
    "no list of tiles": lambda said: said | {"tiles": "x"},
    "tiles of other axes": lambda said: said | {"tiles": [each[:1] for each in said["tiles"]]},
    "tiles without points": lambda said: said | {"tiles": [[0, 0] for _ in said["tiles"]]},
    "nothing halved": lambda said: said | {"halved": None},
    "too little halved": lambda said: said | {"halved": said["halved"][1:]},
    "halved by words": lambda said: said | {"halved": [["yes", "no"] for _ in said["halved"]]},
    "fixed is a number": lambda said: said | {"fixed": 7},
    "options are a list": lambda said: said | {"options": [1]},
    "axes are a number": lambda said: said | {"axes": 3},
    "axes of words": lambda said: said | {"axes": said["axes"] | {"period": ["a", "b"]}},
    "axes that fall": lambda said: said | {"axes": said["axes"] | {"period": said["axes"]["period"][::-1]}},
    "another axis": lambda said: said | {"axes": {"phase": [0, 1], "period": said["axes"]["period"]}},
}


@pytest.mark.parametrize("what", BROKEN)
def test_store_whose_root_says_what_no_survey_writes_is_damaged(copied, what):
    root = copied / "zarr.json"
    described = json.loads(root.read_text())
    described["attributes"]["rocking_survey"] = BROKEN[what](described["attributes"]["rocking_survey"])
    root.write_text(json.dumps(described))
    before = files(copied)
    with pytest.raises(
        OSError, match=f"^store {str(copied)!r} is damaged: one of its files zarr.json cannot be read"
    ):
        rk.parametric_map(**ASKED, store=copied)
    assert files(copied) == before


def test_damage_in_a_coarse_level_is_mended_there(copied, plain):
    whole = files(copied)
    for chunk in ("level-0/peak/c/0/0", "level-1/kind/c/0/1"):
        (copied / chunk).write_bytes(b"")
    with pytest.raises(
        OSError, match="level-0/peak/c/0/0'; .*level-1/kind/c/0/1' \\(recompute these tiles with repair\\)$"
    ):
        rk.parametric_map(**ASKED, store=copied)
    rk.parametric_map(**ASKED, store=copied, repair=True)
    assert files(copied) == whole


OTHERS = (
    {"system": system_with(restitution=0.8)},
    {"amplitude": np.linspace(0.0, 8.0, SIZE)},
    {"start": rk.State(0.1)},
)


@pytest.fixture(scope="module")
def others(tmp_path_factory):
    """Stores of other surveys whose files have the same names."""
    folders = [tmp_path_factory.mktemp("other") / "map.zarr" for _ in OTHERS]
    for folder, changed in zip(folders, OTHERS, strict=True):
        rk.parametric_map(**(ASKED | changed), store=folder)
    return folders


def tile_files(folder):
    """Return the chunks of all variables and the digests of all tiles of a store, in order."""
    names = ("level-*/*/c/*/*", "level-*/cycles/digests/*/*")
    return sorted(path.relative_to(folder) for name in names for path in folder.glob(name))


def tile_of(path):
    return path.parts[0], path.parts[-2:]


def disturb(random, store, others, whole):
    """Change one file of a store, or all files of one tile, at random; return what was changed."""
    names = sorted(whole)
    of_a_tile = {tile_of(name): [each for each in names if tile_of(each) == tile_of(name)] for name in names}
    while True:
        name, other = names[random.integers(len(names))], names[random.integers(len(names))]
        kind = random.choice(["bit", "survey", "place", "whole tile of a survey", "whole tile of a place"])
        source = others[random.integers(len(others))] if "survey" in kind else store
        new = {}
        if kind == "bit":
            content = bytearray(whole[name])
            content[random.integers(len(content))] ^= 1 << random.integers(8)
            new = {name: bytes(content)}
        elif kind == "survey":
            new = {name: (source / name).read_bytes()}
        elif kind == "place" and name.parts[-3] == other.parts[-3]:
            new = {name: whole[other]}
        elif kind == "whole tile of a survey":
            new = {each: (source / each).read_bytes() for each in of_a_tile[tile_of(name)]}
        elif kind == "whole tile of a place":
            one, two = of_a_tile[tile_of(name)], of_a_tile[tile_of(other)]
            new = {each: whole[beside] for each, beside in zip(one, two, strict=True)}
        if any(content != whole[each] for each, content in new.items()):
            for each, content in new.items():
                (store / each).write_bytes(content)
            return kind, tile_of(name)


def check_noticed(copied, others, computed, count, seed):
    random, whole = np.random.default_rng(seed), files(copied)
    of_tiles = {name: whole[name] for name in tile_files(copied)}
    seen = set()
    for _ in range(count):
        kind, (where, index) = disturb(random, copied, others, of_tiles)
        seen.add(str(kind))
        with pytest.raises(OSError, match=f"is damaged at '.*/{where}/.*/{'/'.join(index)}'"):
            rk.parametric_map(**ASKED, store=copied)
        rk.parametric_map(**ASKED, store=copied, repair=True)
        assert files(copied) == whole, kind
    return seen


def test_chunks_of_another_survey_or_place_are_noticed_and_mended(copied, others, computed):
    check_noticed(copied, others, computed, count=12, seed=3)


@pytest.mark.long
def test_two_hundred_swaps_and_flips_are_all_noticed_and_mended(copied, others, computed):
    assert len(check_noticed(copied, others, computed, count=200, seed=200)) == 5
