"""Sets of ground motions: names, columns and digest; folders, lists and tables of record files, and their errors."""

import re
import warnings
from itertools import starmap
from pathlib import Path

import numpy as np
import pytest

import record_files as write
import rocking as rk

pytestmark = [
    pytest.mark.filterwarnings("ignore:.*several horizontal components of 1 station"),
    pytest.mark.filterwarnings("ignore:.*a PGA of .* is unusual"),
    pytest.mark.filterwarnings("ignore:.*each copy counts"),
]
G = 9.80665
WAVE = np.round(np.sin(np.arange(40)) * np.exp(-np.arange(40) / 9), 3)


def motion(samples=(0.0, 1.0, -2.0, 0.0), **more):
    return rk.GroundMotion(samples, **({"step": 0.01} | more))


def saved(path, lines):
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


@pytest.fixture
def folder(tmp_path):
    """Two files that state their units, one of three channels, and what accompanies them."""
    place = tmp_path / "records"
    place.mkdir()
    saved(place / "b.AT2", write.peer(WAVE))
    saved(place / "a.V1", write.csmip_v1([WAVE, WAVE[:30], -WAVE]))
    saved(place / "README.md", ["Source and terms."])
    saved(place / "LICENSE", ["Terms."])
    saved(place / ".hidden", ["hidden"])
    return place


def test_set_is_a_sequence_of_its_motions_with_their_names():
    first, second, third = motion(name="a", component="90°"), motion(), motion(name="a", component="0°")
    records = rk.RecordSet([first, second, third])
    assert (len(records), list(records), records[-1]) == (3, [first, second, third], third)
    assert records.names == ("a, 90°", "record 2", "a, 0°")
    assert rk.RecordSet(first).names == ("a, 90°",)
    assert repr(records) == "RecordSet(3 records)"


def test_copies_of_a_record_are_told(tmp_path):
    for name, samples in {
        "a": WAVE,
        "b": -0.3 * WAVE,
        "c": WAVE[1:],
        "d": WAVE,
        "e": 0 * WAVE,
        "f": WAVE[::-1],
    }.items():
        saved(tmp_path / f"{name}.AT2", write.peer(samples))
    copies = "b.AT2, 180 holds the samples of a.AT2, 180, perhaps with a factor, and 1 other record likewise: each copy counts"
    with pytest.warns(rk.InputWarning, match=f"^{re.escape(tmp_path.name)}: {copies}"):
        rk.read_record_set(tmp_path)
    with warnings.catch_warnings(action="error", category=rk.InputWarning):
        rk.read_record_set([tmp_path / "a.AT2", tmp_path / "c.AT2"], component="first")


def test_columns_hold_a_number_per_record_and_stay_as_they_are():
    records = rk.RecordSet([motion(name="a"), motion(name="b")], columns={"magnitude": [6, 7.5]})
    assert records.columns["magnitude"].tolist() == [6.0, 7.5]
    assert repr(records) == "RecordSet(2 records, columns magnitude)"
    with pytest.raises(ValueError, match="read-only"):
        records.columns["magnitude"][0] = 1.0


@pytest.mark.parametrize(
    "change",
    [
        {"acceleration": [0.0, 1.0, -2.0, 1e-300]},
        {"acceleration": [0.0, 1.0, -2.0]},
        {"acceleration": [0.0, 1.0, -2.0, 0.0, 0.0]},
        {"step": 0.02},
        {"factor": -1.0},
        {"factor": np.nextafter(1.0, 2.0)},
        {"factor": 0.0},
        {"baseline": "mean"},
    ],
    ids=str,
)
def test_digest_changes_with_samples_step_and_factor(change):
    plain, given = motion(), {"acceleration": [0.0, 1.0, -2.0, 0.0], "step": 0.01} | change
    changed = rk.RecordSet(rk.GroundMotion(**given)).digest
    assert len(changed) == 64
    assert changed != rk.RecordSet(plain).digest
    assert changed == rk.RecordSet(rk.GroundMotion(**given)).digest


def test_digest_is_that_of_the_motions_in_their_order_whatever_their_names():
    first, second = motion(), motion([1.0, 2.0])
    assert rk.RecordSet([first, second]).digest != rk.RecordSet([second, first]).digest
    assert rk.RecordSet(motion(name="a")).digest == rk.RecordSet(first).digest
    # A factor of which the inverse rounds, or lies outside the range of factors, changes no sample.
    for factor in (0.1, 49.0, 1e-9):
        assert rk.RecordSet(first.scaled(factor)).digest == rk.RecordSet(motion(factor=factor)).digest
    # Samples that pass from one motion to its neighbour are not the same set.
    parts = ([0.0, 1.0], [2.0, 3.0]), ([0.0, 1.0, 2.0], [3.0])
    assert len({rk.RecordSet(list(map(motion, each))).digest for each in parts}) == 2


@pytest.mark.parametrize(
    ("values", "columns", "error", "message"),
    [
        (
            [],
            {},
            ValueError,
            "records must hold ground motions, one at least; got [] (read them with rk.read",
        ),
        (
            "a",
            {},
            TypeError,
            "records must hold ground motions, one at least; got 'a' (read them with rk.read",
        ),
        (
            Path("a"),
            {},
            TypeError,
            "records must hold ground motions, one at least; got PosixPath('a') (read them with rk.read",
        ),
        ([1.0], {}, TypeError, "records must hold ground motions, one at least; got 1.0 (read them"),
        (
            [motion(name="a")] * 2,
            {},
            ValueError,
            "records must have distinct names; got 'a twice' (attrs.evolve(",
        ),
        (
            motion(),
            {"m": [1.0, 2.0]},
            ValueError,
            "columns['m'] must hold 1 number, one per record; got [1.0, 2.0]",
        ),
        (
            motion(),
            {"m": ["x"]},
            TypeError,
            "columns['m'] must be a real number or an array of real numbers; got ['x']",
        ),
        (
            motion(),
            [1.0],
            TypeError,
            "columns must be a mapping of names to one number per record; got [1.0]",
        ),
    ],
)
def test_values_that_are_no_set_are_refused_in_one_line(values, columns, error, message):
    with pytest.raises(error, match=f"^{re.escape(message)}") as caught:
        rk.RecordSet(values, columns)
    assert "\n" not in str(caught.value)


def test_folder_gives_all_channels_of_its_files_sorted_by_name(folder):
    records = rk.read_record_set(folder)
    assert records.names == ("a.V1, 90°", "a.V1, 180°", "a.V1, 270°", "b.AT2, 180")
    # Components of different length are motions of their own.
    assert [each.acceleration.size for each in records] == [40, 30, 40, 40]
    for each, samples in zip(records, (WAVE, WAVE[:30], -WAVE, WAVE), strict=True):
        np.testing.assert_allclose(each.acceleration, G * samples, rtol=1e-12)
    assert [each.file.name for each in records] == ["a.V1", "a.V1", "a.V1", "b.AT2"]
    assert rk.read_record_set(str(folder)).digest == records.digest


def test_baseline_is_removed_from_each_file(folder):
    for each in rk.read_record_set(folder, baseline="linear"):
        assert abs(each.acceleration.mean()) < 1e-15 < abs(rk.read_record_set(folder)[0].acceleration.mean())


def test_list_keeps_its_order_and_one_path_is_a_set_of_its_channels(folder):
    assert rk.read_record_set([folder / "b.AT2", folder / "a.V1"]).names[0] == "b.AT2, 180"
    assert len(rk.read_record_set(folder / "a.V1")) == 3
    assert len(rk.read_record_set(str(path) for path in folder.glob("?.*"))) == 4


def test_files_of_one_name_in_two_folders_are_named_by_their_paths(folder, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    saved(other / "b.AT2", write.peer(2 * WAVE))
    paths = [folder / "b.AT2", other / "b.AT2"]
    assert rk.read_record_set(paths).names == tuple(f"{path.as_posix()}, 180" for path in paths)


def test_channels_of_equal_components_are_told_apart_by_their_numbers(tmp_path):
    lines = [line.replace("180 Deg", "90 Deg") for line in write.csmip_v1([WAVE, -WAVE])]
    records = rk.read_record_set(saved(tmp_path / "a.V1", lines))
    assert records.names == ("a.V1, 90°, channel 1", "a.V1, 90°, channel 2")
    np.testing.assert_allclose(records[1].acceleration, -G * WAVE, rtol=1e-12)


def test_table_chooses_channels_scales_names_and_gives_numbers(folder):
    table = ["File,channel,scale,name,magnitude,distance", "a.V1,2,-0.5,,6.5,10", "", "b.AT2,,,Town,7.25,"]
    for delimiter in ",;\t":
        path = saved(folder / "set.csv", [line.replace(",", delimiter) for line in table])
        records = rk.read_record_set(path)
        assert records.names == ("a.V1, 180°", "Town, 180")
        np.testing.assert_allclose(records[0].acceleration, -0.5 * G * WAVE[:30], rtol=1e-12)
        assert records.columns["magnitude"].tolist() == [6.5, 7.25]
        np.testing.assert_array_equal(records.columns["distance"], [10.0, np.nan])


def test_row_without_a_channel_gives_its_numbers_to_all_channels(folder):
    records = rk.read_record_set(saved(folder / "set.csv", ["file,magnitude", "b.AT2,7", "a.V1,6.5"]))
    assert records.columns["magnitude"].tolist() == [7.0, 6.5, 6.5, 6.5]


def test_rows_of_one_file_are_told_apart_by_their_channels(folder):
    records = rk.read_record_set(saved(folder / "set.csv", ["file,channel", "a.V1,1", "a.V1,2"]))
    assert records.names == ("a.V1, channel 1, 90°", "a.V1, channel 2, 180°")


def test_table_states_units_and_steps_of_files_that_do_not(folder):
    for name in ("c.txt", "d.txt"):
        saved(folder / name, [f"{value}" for value in WAVE])
    table = ["file,units,step", "c.txt,g,0.02", "d.txt,,"]
    records = rk.read_record_set(saved(folder / "set.csv", table), units="cm/s²", step=0.005)
    assert [each.step for each in records] == [0.02, 0.005]
    assert [each.pga for each in records] == pytest.approx(
        [G * np.abs(WAVE).max(), 0.01 * np.abs(WAVE).max()]
    )


def test_table_alone_may_name_its_column_alone(folder):
    assert len(rk.read_record_set(saved(folder / "set.csv", ["file", "b.AT2"]))) == 1


def test_folder_without_records_is_said(tmp_path):
    saved(tmp_path / "readme.txt", ["Source."])
    with pytest.raises(
        rk.RecordError,
        match=f"^{re.escape(str(tmp_path))}: the folder holds no record file; formats: PEER",
    ):
        rk.read_record_set(tmp_path)


VELOCITY = write.peer(WAVE, title="VELOCITY TIME SERIES IN UNITS OF CM/S")


def test_velocities_and_displacements_beside_records_are_left_out_with_a_warning(folder):
    digest = rk.read_record_set(folder).digest
    others = ["b.DT2", "b.VT2", "_SearchResults.csv", "c.vt2"]
    for count, name in enumerate(others, 1):
        saved(folder / name, VELOCITY)
        named = "; ".join(sorted(others[:count])[:3]) + "; …" * (count > 3)
        message = f"{folder}: {count} file{'s' * (count > 1)} without acceleration left out: {named}"
        with pytest.warns(rk.InputWarning, match=f"^{re.escape(message)}$") as caught:
            assert rk.read_record_set(folder).digest == digest
        assert [each.filename for each in caught] == [__file__] * 3


def test_velocities_alone_are_no_records_and_refused_if_named(tmp_path):
    path = saved(tmp_path / "b.VT2", VELOCITY)
    with pytest.raises(rk.RecordError, match="the folder holds no record file"):
        rk.read_record_set(tmp_path)
    with pytest.raises(rk.RecordError, match=r"acceleration expected, but the file holds velocity"):
        rk.read_record_set([path])


def test_record_without_its_line_of_the_unit_beside_others_has_the_table_as_way_out(folder):
    lines = write.peer(WAVE)
    saved(folder / "c.AT2", [*lines[:2], *lines[3:]])
    with pytest.raises(
        rk.RecordError,
        match="units='g' for all files that do not state it; a table with a column 'units' gives",
    ):
        rk.read_record_set(folder)


@pytest.mark.parametrize("name", ["notes.txt", "inner"])
def test_file_or_folder_that_is_no_record_is_named_with_the_way_out(folder, name):
    path = folder / name
    path.mkdir() if name == "inner" else saved(path, ["Some words."])
    with pytest.raises(rk.RecordError) as caught:
        rk.read_record_set(folder)
    message = str(caught.value)
    assert re.match(rf"^(\S*/)?{name}[:,] ", message)
    assert message.endswith(
        "; if it is no record, move it, or list the record files instead of the folder records"
    )
    assert "\n" not in message


def test_file_without_a_unit_beside_others_is_named_with_argument_and_table(folder):
    saved(folder / "c.txt", [f"{value}" for value in WAVE])
    with pytest.raises(rk.RecordError) as caught:
        rk.read_record_set(folder)
    assert str(caught.value).startswith(
        "c.txt: the file does not state the unit of its samples; give it, for example units='m/s²' for all files that do not "
        "state it; a table with a column 'units' gives it for each file; if it is no record"
    )


@pytest.mark.parametrize(
    "lines, argument",
    [
        (WAVE, "units"),
        (["time (s),acc (m/s2)", "0,0.1", "0.10,0.2", "0.50,0.3", "0.60,0.4"], "step"),
        (["letter", "of words"], ""),
    ],
)
def test_error_names_the_argument_that_a_file_lacks_and_of_several_files_the_column(folder, lines, argument):
    saved(folder / "c.csv", map(str, lines))
    with pytest.raises(rk.RecordError) as alone:
        rk.read_ground_motions(folder / "c.csv")
    with pytest.raises(rk.RecordError) as several:
        rk.read_record_set(folder)
    assert alone.value.argument == argument
    assert (f"a table with a column {argument!r} gives it for each file" in str(several.value)) == bool(
        argument
    )


def test_unit_and_step_of_several_files_are_those_of_the_files_that_state_none(folder):
    saved(folder / "c.txt", [f"{value}" for value in WAVE])
    saved(folder / "b.txt", ["acc (g)", *(f"{value}" for value in WAVE[1:])])
    files = sorted(folder.glob("?.*"))
    alone = [motion for path in files[:-2] for motion in rk.read_ground_motions(path)]
    alone.append(rk.read_ground_motion(files[-2], step=0.02))
    alone.append(rk.read_ground_motion(files[-1], units="cm/s²", step=0.02))
    together = rk.read_record_set(files, units="cm/s²", step=0.02)
    assert [each.step for each in together] == [each.step for each in alone]
    for one, other in zip(together, alone, strict=True):
        np.testing.assert_array_equal(one.acceleration, other.acceleration)


def test_all_files_that_cannot_be_read_are_told_at_once(folder):
    saved(folder / "c.txt", map(str, WAVE))
    saved(folder / "d.txt", ["letter", "of words"])
    with pytest.raises(rk.RecordError) as caught:
        rk.read_record_set(folder)
    told = str(caught.value)
    assert told.startswith("2 of 4 files cannot be read: (1) c.txt: the file does not state the unit")
    assert " (2) d.txt: neither a record nor a table" in told
    assert "\n" not in told


def test_step_for_all_files_is_not_that_of_files_with_times(folder):
    """In a folder, in a list and in a table; a cell of the table is for its file alone, and contradicts its times."""
    for name, step in (("t.csv", 0.02), ("u.csv", 0.01)):
        saved(
            folder / name,
            ["time (s),acc (cm/s2)", *(f"{k * step:.2f},{value}" for k, value in enumerate(WAVE))],
        )
    saved(folder / "v.txt", ["(cm/s2)", *map(str, WAVE)])
    names = "t.csv", "u.csv", "v.txt"
    saved(folder / "set.csv", ["file", *names])
    for source in ([folder / name for name in names], folder / "set.csv"):
        assert [each.step for each in rk.read_record_set(source, step=0.01)] == [0.02, 0.01, 0.01]
    saved(folder / "set.csv", ["file,step", "t.csv,0.01"])
    with pytest.raises(rk.RecordError, match="line 2: t.csv: the times give a step of 0.02 s; omit step"):
        rk.read_record_set(folder / "set.csv")


TABLES = {
    "missing file": (
        ["file", "x.AT2"],
        "set.csv, line 2: .*x.AT2: cannot be read: No such file or directory",
    ),
    "empty file": (
        ["file,scale", ",2"],
        "set.csv, line 2: the column 'file' is empty; give the path of a record",
    ),
    "text": (
        ["file,magnitude", "b.AT2,6", "b.AT2,big"],
        "set.csv, line 3: column 'magnitude' must hold numbers; got 'big'; remove the column if it is no number",
    ),
    "infinite": (["file,m", "b.AT2,inf"], "set.csv, line 2: column 'm' must hold numbers; got 'inf'"),
    "text in scale": (
        ["file,scale", "b.AT2,x"],
        "set.csv, line 2: column 'scale' must hold numbers; got 'x'$",
    ),
    "scale 0": (["file,scale", "b.AT2,0"], "set.csv, line 2: scale must not be 0; leave the cell empty for"),
    "large scale": (
        ["file,scale", "b.AT2,1e9"],
        "set.csv, line 2: factor must be a finite real number of size",
    ),
    "channel": (
        ["file,channel", "b.AT2,2"],
        "set.csv, line 2: channel must be 1 to 1, the channels of b.AT2; got 2",
    ),
    "half a channel": (
        ["file,channel", "b.AT2,1.5"],
        "set.csv, line 2: channel must be a whole number from 1; got 1.5",
    ),
    "units": (["file,units", "b.AT2,feet"], "set.csv, line 2: units must be one of"),
    "stated twice": (
        ["file,units", "b.AT2,g"],
        "set.csv, line 2: b.AT2: the file states the unit of its samples, g",
    ),
    "same rows": (
        ["file", "b.AT2", "b.AT2"],
        "set.csv: b.AT2, 180 occurs 2 times; give distinct names in the column 'name'$",
    ),
    "same names": (
        ["file,name", "b.AT2,x", "a.V1,x", "b.AT2,x"],
        "set.csv: x, 180 occurs 2 times; give distinct",
    ),
    "same columns": (
        ["file,m,m", "b.AT2,1,2"],
        "set.csv: columns must have distinct names; got 'm' in column 3",
    ),
    "no name": (["file,,m", "b.AT2,1,2"], "set.csv: columns must have distinct names; got '' in column 2"),
    "more cells": (
        ["file,m", "b.AT2,1,2"],
        "set.csv, line 2: 3 cells under 2 columns; put a text with commas in",
    ),
    "no rows": (["file,m"], "set.csv: the table has no rows$"),
    "no end of a quote": (
        ["file,name", 'b.AT2,"', *["x" * 9_000] * 15],
        r"set.csv, line \d+: field larger than field limit \(131072\); check the quotes$",
    ),
}


@pytest.mark.parametrize("table", TABLES)
def test_wrong_table_is_refused_with_its_line(folder, table):
    lines, message = TABLES[table]
    with pytest.raises(rk.RecordError, match=f"^{message}") as caught:
        rk.read_record_set(saved(folder / "set.csv", lines))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("source", "error", "message"),
    [
        ([], ValueError, r"source must name one record file at least; got \[\]$"),
        (
            7,
            TypeError,
            "source must be a folder, a table with a column 'file', or paths of record files; got 7$",
        ),
        (
            [7],
            TypeError,
            "source must be a folder, a table with a column 'file', or paths of record files; got 7$",
        ),
        ("nowhere", rk.RecordError, "nowhere: cannot be read: No such file or directory; check the path$"),
    ],
)
def test_source_that_is_none_is_refused(source, error, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error, match=f"^{message}"):
        rk.read_record_set(source)


def test_file_given_twice_is_refused(folder):
    path = folder / "b.AT2"
    with pytest.raises(rk.RecordError, match=r"b\.AT2, 180 occurs 2 times; name each file once$"):
        rk.read_record_set([path, path])


def test_peak_that_differs_from_the_header_is_a_warning(tmp_path):
    lines = write.smc([100.0, -200.0, 50.0])
    wrong = [line.replace("2.0000000E+02", "9.0000000E+02") for line in lines]
    assert wrong != lines
    with pytest.warns(
        rk.InputWarning, match=r"^a\.smc: the samples have a PGA of 2 m/s², the header states 9 m/s²$"
    ):
        rk.read_record_set(saved(tmp_path / "a.smc", wrong))


def test_names_of_a_set_are_those_that_the_motions_have(folder):
    records = rk.read_record_set(folder)
    assert records.names == tuple(starmap("{}, {}".format, [(each.name, each.component) for each in records]))


DEPENDENT = "their results depend on each other, and intervals that take them as independent are too narrow"
DEPENDENT += "; take one of each, for example component='first'"


@pytest.fixture
def three(tmp_path):
    """A file of two horizontal channels, of different length, and a vertical one, and a vertical one alone."""
    lines = "\n".join(write.csmip_v1([WAVE, WAVE[:30], WAVE[::-1]])).replace("270 Deg", "Up").split("\n")
    saved(tmp_path / "a.V1", lines)
    saved(tmp_path / "b.asc", "\n".join(write.esm(100 * WAVE)).replace("HNE", "HNZ").split("\n"))
    return tmp_path


def warnings_of(source):
    with pytest.warns(rk.InputWarning) as caught:
        records = rk.read_record_set(source)
    assert {each.filename for each in caught} == {__file__}
    return records, sorted(str(each.message) for each in caught)


def test_vertical_channels_are_left_out_of_a_set_with_a_warning(three):
    both = f"several horizontal components of 1 station (a.V1, 90°; a.V1, 180°): {DEPENDENT}"
    folder = three.name
    records, said = warnings_of(three)
    assert records.names == ("a.V1, 90°", "a.V1, 180°")
    assert said == [
        f"{folder}: 2 vertical channels left out: a.V1, Up; b.asc, HNZ",
        f"{folder}: {both}",
    ]
    assert warnings_of([three / "a.V1"])[1] == [
        "source: 1 vertical channel left out: a.V1, Up",
        f"source: {both}",
    ]
    records, said = warnings_of(saved(three / "set.csv", ["file,m", "a.V1,6", "b.asc,7"]))
    assert records.columns["m"].tolist() == [6.0, 6.0]
    assert said[0] == "set.csv: 2 vertical channels left out: a.V1, Up; b.asc, HNZ"


def test_vertical_channel_that_a_table_chooses_stays_with_a_warning(three):
    records, said = warnings_of(saved(three / "set.csv", ["file,channel", "a.V1,3", "a.V1,1", "a.V1,2"]))
    assert len(records) == 3
    assert said == [
        f"set.csv: several horizontal components of 1 station (a.V1, channel 1, 90°; a.V1, channel 2, 180°): {DEPENDENT}",
        "the component a.V1, channel 3, Up is vertical, and the base moves horizontally: choose a horizontal component",
    ]


def test_set_without_a_horizontal_channel_is_refused(three):
    with pytest.raises(
        rk.RecordError,
        match=r"^b.asc: no channel is horizontal, and the base of a block moves hor.*: b.asc, HNZ$",
    ):
        rk.read_record_set(three / "b.asc")


def test_components_of_one_station_in_two_files_are_told(tmp_path):
    first = write.peer(WAVE)
    saved(tmp_path / "a.AT2", first)
    saved(tmp_path / "b.AT2", [line.replace(", 180", ", 270") for line in write.peer(WAVE[::-1])])
    saved(
        tmp_path / "c.AT2", [line.replace("Valley-02", "Valley-03") for line in write.peer(np.roll(WAVE, 2))]
    )
    assert warnings_of(tmp_path)[1] == [
        f"{tmp_path.name}: several horizontal components of 1 station (a.AT2, 180; b.AT2, 270): {DEPENDENT}"
    ]


@pytest.mark.parametrize(
    "use",
    [
        lambda motion: rk.Block(2.0, 0.5).system(motion, model="slender"),
        lambda motion: rk.RecordSet([motion]),
        lambda motion: rk.rocking_spectrum(
            motion, size=[1.0, 2.0], slenderness=0.2, progress=False, model="slender"
        ),
    ],
)
def test_vertical_motion_that_shakes_a_block_is_a_warning(use):
    with pytest.warns(
        rk.InputWarning, match=r"^the component (a, )?Up is vertical, and the base moves hor"
    ) as caught:
        use(motion(name="a", component="Up"))
    assert [each.filename for each in caught] == [__file__]


@pytest.mark.parametrize(
    ("components", "vertical"),
    [
        (
            [
                "Up",
                "UP",
                "DOWN",
                "DWN",
                "-V",
                "VERT",
                "Vertical",
                "U-D",
                "UD2",
                "U-D 1",
                "HNZ",
                "Z",
                "Up, channel 3",
            ],
            True,
        ),
        (["", "360°", "N28W", "HNE", "HN1", "E-W", "270", "S62W", "radial", "FN"], False),
    ],
)
def test_vertical_components_are_known_by_their_names(components, vertical):
    assert [motion(component=each).vertical for each in components] == [vertical] * len(components)
