"""Files are complete or absent, and an earlier file stays until the new one is complete."""

import errno
import os
import re
import stat

import pytest

from rocking.model.files import (
    Made,
    WriteError,
    check_folder,
    check_replaceable,
    check_writable,
    replacing,
    replacing_folder,
)
from rocking.survey.store_access import wrap_write_errors


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_file_appears_under_its_name_only_once_complete(tmp_path):
    target = tmp_path / "table.csv"
    with replacing(target) as temporary:
        assert temporary.suffix == ".csv"
        assert temporary.parent == tmp_path
        temporary.write_text("whole")
        assert not target.exists()
    assert names(tmp_path) == ["table.csv"]
    assert target.read_text() == "whole"


def test_longest_name_that_a_file_may_have_is_written(tmp_path):
    target = tmp_path / ("n" * 251 + ".csv")
    with replacing(check_writable("--csv", target)) as temporary:
        temporary.write_text("whole")
    assert names(tmp_path) == [target.name]
    write_folder(tmp_path / ("n" * 255), "whole")
    assert names(tmp_path) == [target.name, "n" * 255]


def test_paths_that_cannot_exist_are_refused_in_one_line(tmp_path, monkeypatch):
    for check in (check_writable, check_folder, lambda name, path: check_replaceable(name, path, MADE)):
        for path in (tmp_path / ("n" * 256), tmp_path / "nul\0.csv"):
            with pytest.raises(OSError, match=r"^--out must be a path that can exist; got '.*': [^\n]+$"):
                check("--out", path)
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    for check in (check_writable, check_folder, lambda name, path: check_replaceable(name, path, MADE)):
        with pytest.raises(OSError, match="got 'a': the working directory does not exist any more$"):
            check("--out", "a")
        assert check("--out", tmp_path / "a") == tmp_path / "a"


@pytest.mark.parametrize("failure", [OSError(errno.ENOSPC, "No space left on device"), AttributeError("pos")])
@pytest.mark.parametrize("writing", [replacing, lambda path: replacing_folder("folder", path, MADE)])
def test_refusal_of_the_system_names_what_cannot_be_written(tmp_path, writing, failure):
    """Also where a library stumbles over it and says something else."""

    def fail():
        with writing(tmp_path / "out"):
            try:
                raise OSError(errno.ENOSPC, "No space left on device")
            except OSError:
                raise failure from None

    told = (
        f"{str(tmp_path / 'out')!r} cannot be written: No space left on device; existing data are unchanged"
    )
    with pytest.raises(WriteError, match=re.escape(told)):
        fail()
    assert names(tmp_path) == []


@pytest.mark.parametrize(
    "number, first",
    [(errno.ENOSPC, "free some space, or "), (errno.EROFS, "give permission to write, or "), (errno.EIO, "")],
)
def test_remedy_of_a_failed_write_fits_its_error(tmp_path, number, first):
    def fail(opened):
        with opened:
            raise OSError(number, os.strerror(number))

    told = (
        f" cannot be written: {os.strerror(number)}; existing data are unchanged ({first}give another path)"
    )
    for opened in (replacing(tmp_path / "out"), wrap_write_errors(tmp_path / "out")):
        with pytest.raises(OSError) as caught:
            fail(opened)
        assert str(caught.value).endswith(f"{str(tmp_path / 'out')!r}{told}")


def test_failure_that_is_none_of_the_system_is_raised_as_it_is(tmp_path):
    for failure in (OSError("the store is damaged"), ValueError("no number")):
        with pytest.raises(type(failure), match=str(failure)) as caught, replacing(tmp_path / "out"):
            raise failure
        assert caught.value is failure


@pytest.mark.parametrize("failure", [RuntimeError, KeyboardInterrupt, SystemExit])
def test_failure_leaves_the_old_file_and_nothing_else(tmp_path, failure):
    target = tmp_path / "table.csv"
    target.write_text("old")

    def fail():
        with replacing(target) as temporary:
            temporary.write_text("half")
            raise failure

    with pytest.raises(failure):
        fail()
    assert names(tmp_path) == ["table.csv"]
    assert target.read_text() == "old"


def test_link_is_followed(tmp_path):
    (tmp_path / "real.csv").write_text("old")
    (tmp_path / "link.csv").symlink_to("real.csv")
    with replacing(tmp_path / "link.csv") as temporary:
        temporary.write_text("new")
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "real.csv").read_text() == "new"


def test_new_file_is_readable_by_those_whom_the_umask_allows(tmp_path):
    (tmp_path / "plain").write_text("")
    with replacing(tmp_path / "ours") as temporary:
        temporary.write_text("")
    assert (tmp_path / "ours").stat().st_mode == (tmp_path / "plain").stat().st_mode


def access(path):
    found = path.stat()
    return stat.S_IMODE(found.st_mode), found.st_uid, found.st_gid


OWNER = (65_534, 65_533) if os.geteuid() == 0 else (os.getuid(), os.getgid())


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o444, 0o666])
def test_file_or_folder_that_replaces_one_keeps_its_permissions_and_its_owner(tmp_path, mode):
    file, folder = tmp_path / "table.csv", tmp_path / "map"
    file.write_text("old")
    write_folder(folder, "old")
    before = file.stat().st_mtime_ns
    for path, allowed in ((file, mode), (folder, mode | 0o300), (folder / "mark", mode)):
        path.chmod(allowed)
        os.chown(path, *OWNER)
    with replacing(file) as temporary:
        temporary.write_text("new")
        assert access(temporary)[0] == 0o600  # nobody else reads it meanwhile
    with replacing_folder("folder", folder, MADE) as partial:
        (partial / "mark").write_text("new")
        assert access(partial)[0] == 0o700
    assert [access(path) for path in (file, folder, folder / "mark")] == [
        (mode, *OWNER), (mode | 0o300, *OWNER), (mode, *OWNER)
    ]  # fmt: skip
    assert file.stat().st_mtime_ns > before


@pytest.mark.parametrize("number", [errno.EPERM, errno.EINVAL])  # EINVAL: unknown in the user namespace
def test_group_that_cannot_be_kept_leaves_another_group_what_all_others_may(tmp_path, monkeypatch, number):
    def refuse(path, owner, group):
        raise OSError(number, os.strerror(number))

    def change(path, mode, **how):
        modes.append(mode)
        chmod(path, mode, **how)

    chmod, modes = os.chmod, []
    group = OWNER[1] if os.geteuid() == 0 else os.getgroups()[-1]
    for mode, left in ((0o664, 0o644), (0o640, 0o600), (0o604, 0o604)):
        file = tmp_path / f"{mode:o}.csv"
        file.touch()
        os.chown(file, -1, group)
        file.chmod(mode)
        with monkeypatch.context() as patch:
            patch.setattr(os, "chown", refuse)
            patch.setattr(os, "chmod", change)
            with replacing(file) as temporary:
                temporary.write_text("new")
        assert access(file)[0] == modes.pop() == (left if group != os.getegid() else mode)
        assert modes == []  # not for a moment more


def test_writable_path_is_returned_and_not_created(tmp_path):
    assert check_writable("--csv", tmp_path / "A.CSV", (".csv",)) == tmp_path / "A.CSV"
    assert names(tmp_path) == []


def test_unwritable_paths_are_refused_in_one_line(tmp_path):
    (tmp_path / "folder.csv").mkdir()
    for path, message in {
        tmp_path / "a.txt": "--csv must end in .csv; got ",
        tmp_path / "none" / "a.csv": "--csv must lie in an existing folder; got ",
        tmp_path / "folder.csv": "--csv must be the path of a file; got ",
    }.items():
        with pytest.raises((ValueError, OSError)) as caught:
            check_writable("--csv", path, (".csv",))
        assert str(caught.value).startswith(message + repr(str(path)))
        assert len(str(caught.value).splitlines()) == 1


def test_folder_that_takes_no_files_is_refused_whatever_its_permissions_say(tmp_path, monkeypatch):
    def refuse(**where):
        raise OSError(30, "Read-only file system", str(where))

    monkeypatch.setattr("rocking.model.files.TemporaryFile", refuse)
    with pytest.raises(PermissionError, match=r"^--csv must be writable; got .*a\.csv', which is not$"):
        check_writable("--csv", tmp_path / "a.csv", (".csv",))
    with pytest.raises(OSError, match=r"^--output must be a folder that can be written; got '"):
        check_folder("--output", tmp_path)


def test_folder_may_exist_or_be_made_later(tmp_path):
    for folder in (tmp_path, tmp_path / "new" / "deeper"):
        assert check_folder("--output", folder) == folder
    assert names(tmp_path) == []


def test_folder_inside_a_file_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    for path in (tmp_path / "file", tmp_path / "file" / "folder"):
        with pytest.raises(OSError, match=r"^--output must be a folder that can be written; got '"):
            check_folder("--output", path)


MADE = Made("mark", others="", folders="", sign="")


def write_folder(target, text):
    with replacing_folder("folder", target, MADE) as temporary:
        (temporary / "mark").write_text(text)
        assert not (target / "mark").exists() or (target / "mark").read_text() != text


def test_folder_appears_only_once_complete_and_replaces_the_one_before(tmp_path):
    target = tmp_path / "made" / "here"
    for text in ("first", "second"):
        write_folder(target, text)
        assert (target / "mark").read_text() == text
        assert names(target.parent) == ["here"]


@pytest.mark.parametrize("failure", [RuntimeError, KeyboardInterrupt])
def test_failure_leaves_the_old_folder_and_nothing_else(tmp_path, failure):
    write_folder(tmp_path / "kept", "old")

    def fail():
        with replacing_folder("folder", tmp_path / "kept", MADE) as temporary:
            (temporary / "half").touch()
            raise failure

    with pytest.raises(failure):
        fail()
    assert names(tmp_path) == ["kept"]
    assert names(tmp_path / "kept") == ["mark"]


def test_folder_that_was_not_written_here_is_refused_and_an_empty_one_taken(tmp_path):
    (tmp_path / "empty").mkdir()
    write_folder(tmp_path / "empty", "new")
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "notes").touch()
    with pytest.raises(
        OSError,
        match="folder must be new, empty, or hold only an earlier mark with its files; got '.*other'",
    ):
        write_folder(tmp_path / "other", "new")
    assert names(tmp_path / "other") == ["notes"]


def test_a_page_beside_a_link_or_a_folder_of_the_user_is_not_replaced(tmp_path):
    for name, put in (
        ("link", lambda place: place.symlink_to(tmp_path)),
        ("folder", lambda place: place.mkdir()),
    ):
        page = tmp_path / name
        write_folder(page, "old")
        put(page / "own")
        with pytest.raises(OSError, match="folder must be new, empty, or hold only an earlier mark"):
            write_folder(page, "new")
        assert names(page) == ["mark", "own"]
