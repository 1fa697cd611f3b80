"""Files are written whole, in place of what may be there, or not at all."""

import errno
import fcntl
import os
import stat
import threading
from pathlib import Path

import pytest

from lepp import InputError
from study.results.files import leftovers, replacing, write_text

pytestmark = pytest.mark.skipif(os.name != "posix", reason="the file system is POSIX's")


@pytest.fixture
def umask():
    before = os.umask(0o077)
    yield
    os.umask(before)


def mode_of(path):
    return stat.S_IMODE(path.stat().st_mode)


def names_in(directory):
    return sorted(path.name for path in directory.iterdir())


def test_text_is_written_as_it_is(tmp_path):
    path = tmp_path / "a.txt"
    write_text(path, "é\r\n\n")
    assert path.read_bytes() == "é\r\n\n".encode()
    assert names_in(tmp_path) == ["a.txt"]


@pytest.mark.parametrize("mask", [0o077, 0o027, 0o002])
def test_a_new_file_has_the_permissions_of_the_umask(tmp_path, umask, mask):
    os.umask(mask)
    write_text(tmp_path / "a", "x")
    assert mode_of(tmp_path / "a") == 0o666 & ~mask


def test_an_old_file_keeps_its_permissions(tmp_path, umask):
    path = tmp_path / "a"
    path.touch()
    path.chmod(0o664)
    write_text(path, "x")
    assert mode_of(path) == 0o664
    assert path.read_text() == "x"


def test_the_target_of_a_link_is_written(tmp_path):
    (tmp_path / "there").mkdir()
    link = tmp_path / "link"
    link.symlink_to(tmp_path / "there" / "a")
    for text in ("new", "replaced"):  # at first the target does not exist
        write_text(link, text)
        assert link.is_symlink()
        assert (tmp_path / "there" / "a").read_text() == text
    assert names_in(tmp_path / "there") == ["a"]


def test_a_pipe_is_written_through(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    read = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_text()), daemon=True)
    reader.start()
    write_text(pipe, "text")
    reader.join(30)
    assert read == ["text"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="makes a device")
def test_a_device_stays_a_device(tmp_path):
    device = tmp_path / "null"
    try:
        os.mknod(device, stat.S_IFCHR | 0o666, os.makedev(1, 3))
        device.write_text("x")
    except OSError as error:
        pytest.skip(f"no devices can be made here: {error}")
    write_text(device, "text")
    assert stat.S_ISCHR(device.stat().st_mode)
    link = tmp_path / "link"
    link.symlink_to(device)
    write_text(link, "text")
    assert stat.S_ISCHR(device.stat().st_mode)
    assert link.is_symlink()


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="needs names of open files")
def test_what_is_open_is_written_into(tmp_path):
    with (tmp_path / "a").open("wb") as file:
        write_text(Path(f"/dev/fd/{file.fileno()}"), "text")
    assert (tmp_path / "a").read_text() == "text"


def test_a_full_disk_is_told_and_leaves_what_was_there(tmp_path, monkeypatch):
    path = tmp_path / "a"
    write_text(path, "old")

    def full(self, *arguments, **options):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_text", full)
    with pytest.raises(InputError, match=r"^Cannot write .*a: No space left on device\.$"):
        write_text(path, "new")
    assert path.read_text() == "old"
    assert names_in(tmp_path) == ["a"]


@pytest.mark.parametrize("step", ["fsync", "replace"])
def test_any_failure_leaves_what_was_there(tmp_path, monkeypatch, step):
    path = tmp_path / "a"
    write_text(path, "old")

    def fail(*arguments):
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr(os, step, fail)
    with pytest.raises(InputError, match="Input/output error"):
        write_text(path, "new")
    monkeypatch.undo()
    with pytest.raises(ZeroDivisionError), replacing(path):
        raise ZeroDivisionError
    assert path.read_text() == "old"
    assert names_in(tmp_path) == ["a"]


def test_a_place_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    for path in (tmp_path / "folder", tmp_path / "none" / "a", tmp_path / "file" / "a"):
        with pytest.raises(InputError, match=f"^Cannot write {path}: "):
            write_text(path, "x")
    assert names_in(tmp_path) == ["file", "folder"]


def test_what_a_killed_writer_leaves_is_known(tmp_path):
    class Killed(BaseException):
        pass

    path = tmp_path / "a.json"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Path, "unlink", lambda *_, **__: None)
        with pytest.raises(Killed), replacing(path):
            raise Killed
    assert [str(left) for left in leftovers(path)] == [str(p) for p in tmp_path.iterdir()] != []


@pytest.fixture
def windows(monkeypatch):
    """Handle files as Windows does: its rules that POSIX does not have."""
    fsync, replace, open_ = os.fsync, os.replace, os.open

    def fsync_writable(handle):
        if fcntl.fcntl(handle, fcntl.F_GETFL) & os.O_ACCMODE == os.O_RDONLY:
            raise OSError(errno.EBADF, os.strerror(errno.EBADF))
        fsync(handle)

    def replace_closed(source, target):
        opened = {os.path.realpath(f"/proc/self/fd/{fd}") for fd in os.listdir("/proc/self/fd")}
        if {os.path.realpath(source), os.path.realpath(target)} & opened:
            raise PermissionError(errno.EACCES, "The process cannot access the file")
        replace(source, target)

    def open_file(path, *arguments, **options):
        if os.path.isdir(path):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        return open_(path, *arguments, **options)

    monkeypatch.setattr(os, "fsync", fsync_writable)
    monkeypatch.setattr(os, "replace", replace_closed)
    monkeypatch.setattr(os, "open", open_file)


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="looks up what is open")
def test_files_are_written_as_windows_wants_it(tmp_path, windows):
    path = tmp_path / "a"
    for text in ("one", "two"):
        write_text(path, text)
        assert path.read_text() == text
    with path.open("rb"), pytest.raises(InputError, match="cannot access the file"):
        write_text(path, "three")
    assert path.read_text() == "two"
    assert names_in(tmp_path) == ["a"]


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="looks up what is open")
def test_a_run_is_stored_as_windows_wants_it(tmp_path, windows):
    from test_store import TASKS, fill, load

    fill(tmp_path / "run")
    assert len(load(tmp_path / "run")["results"]) == len(TASKS)
    assert not (tmp_path / "run" / "journal.jsonl").exists()
