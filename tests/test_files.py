"""Files: whole or not there, with the mode and behind the link that the user made; inputs that cannot block."""

from __future__ import annotations

import os
import stat
import threading
from pathlib import Path

import pytest

from antnav import files
from antnav.errors import OutputError
from antnav.files import open_regular, write_whole

POSIX = pytest.mark.skipif(os.name != "posix", reason="needs modes, links and pipes")


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


@POSIX
@pytest.mark.parametrize("mask", [0o022, 0o077, 0o002])
def test_a_new_file_has_the_mode_of_the_umask(tmp_path: Path, mask: int) -> None:
    before = os.umask(mask)
    try:
        write_whole(tmp_path / "new", b"x")
    finally:
        os.umask(before)
    assert mode(tmp_path / "new") == 0o666 & ~mask


@POSIX
def test_the_umask_is_never_touched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It belongs to the process: another thread's file would become writeable for all."""
    monkeypatch.setattr(os, "umask", lambda _: pytest.fail("set"))
    write_whole(tmp_path / "new", b"x")


@POSIX
@pytest.mark.parametrize("kept", [0o600, 0o640, 0o664])
def test_an_old_file_keeps_its_mode(tmp_path: Path, kept: int) -> None:
    path = tmp_path / "old"
    path.write_bytes(b"old")
    path.chmod(kept)
    write_whole(path, b"new")
    assert (path.read_bytes(), mode(path)) == (b"new", kept)


@POSIX
@pytest.mark.parametrize("exists", [True, False])
def test_a_link_stays_and_its_target_is_written(tmp_path: Path, exists: bool) -> None:
    (tmp_path / "there").mkdir()
    target, link = tmp_path / "there" / "target", tmp_path / "link"
    if exists:
        target.write_bytes(b"old")
    link.symlink_to(Path("there") / "target")
    write_whole(link, b"new")
    assert link.is_symlink()
    assert target.read_bytes() == b"new"
    assert list(target.parent.iterdir()) == [target]


@POSIX
def test_pipes_and_devices_are_left_alone(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", Path(os.devnull), tmp_path):
        before = path.stat().st_mode
        with pytest.raises(OutputError, match="a folder, a pipe or a device"):
            write_whole(path, b"x")
        with pytest.raises(OSError, match="a folder, a pipe or a device"):
            open_regular(path)
        assert path.stat().st_mode == before


@pytest.mark.parametrize("name", [None, 5, b"\xff", "a\0b", "", "missing/file", "x" * 300, ["a"]])
def test_names_that_are_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: object) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(OutputError):
        write_whole(name, b"x")
    with pytest.raises(OSError):
        open_regular(name)
    assert not list(tmp_path.iterdir())


def test_an_error_on_the_way_leaves_the_old_file_and_nothing_else(tmp_path: Path, monkeypatch) -> None:
    path = tmp_path / "old"
    path.write_bytes(b"old")
    for error in (OSError(28, "No space left on device"), KeyboardInterrupt()):

        def fail(*_: object, error: BaseException = error) -> None:
            raise error

        with monkeypatch.context() as patch, pytest.raises((OutputError, KeyboardInterrupt)):
            patch.setattr(os, "replace", fail)
            write_whole(path, b"new")
        assert [file.read_bytes() for file in tmp_path.iterdir()] == [b"old"]


def test_readers_see_the_old_or_the_new(tmp_path: Path) -> None:
    path, done = tmp_path / "file", threading.Event()
    write_whole(path, b"0" * 100_000)
    seen = set()

    def read() -> None:
        while not done.is_set():
            with open_regular(path) as stream:
                content = stream.read()
            seen.add((len(content), len(set(content))))

    reader = threading.Thread(target=read)
    reader.start()
    for number in range(50):
        write_whole(path, str(number % 10).encode() * 100_000)
    done.set()
    reader.join()
    assert seen == {(100_000, 1)}


def test_what_was_closed_is_never_open_on_the_way(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, seen = tmp_path / "closed", []
    path.write_bytes(b"old")
    path.chmod(0o600)
    take_over = files._take_over
    monkeypatch.setattr(files, "_take_over", lambda new, old: seen.append(mode(new)) or take_over(new, old))
    write_whole(path, b"new")
    assert seen == [0o600]
