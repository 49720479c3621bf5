"""What is written whole, or not at all: files. Directories are written by sessions and reports."""

import os
from pathlib import Path

import pytest

from vbraille.errors import InputError, VbrailleError
from vbraille.files import whole_file, write_file, write_files


def names(folder):
    return [path.name for path in folder.iterdir()]


def test_a_file_is_never_written_over_and_leaves_nothing_half(tmp_path):
    write_file(tmp_path / "t.csv", b"one")
    with pytest.raises(InputError, match=r"t\.csv already exists"):
        write_file(tmp_path / "t.csv", b"two")
    assert names(tmp_path) == ["t.csv"]
    assert (tmp_path / "t.csv").read_bytes() == b"one"


def test_where_a_disk_has_no_links_a_file_is_written_too(tmp_path, monkeypatch):
    def no_links(*_):
        raise OSError(1, "Operation not permitted")

    monkeypatch.setattr("os.link", no_links)
    write_file(tmp_path / "t.csv", b"one")
    with pytest.raises(InputError, match="already exists"):
        write_file(tmp_path / "t.csv", b"two")
    assert (tmp_path / "t.csv").read_bytes() == b"one"
    assert names(tmp_path) == ["t.csv"]


def test_a_disk_that_is_full_leaves_the_old_file(tmp_path, monkeypatch):
    def full(_):
        raise OSError(28, "No space left on device")

    path = tmp_path / "t.csv"
    write_file(path, b"old")
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(VbrailleError, match="could not be written: No space left on device"):
            write_file(path, b"new", replace=True, durable=True)
    assert (path.read_bytes(), names(tmp_path)) == (b"old", ["t.csv"])
    write_file(path, b"new", replace=True, durable=True)
    assert (path.read_bytes(), names(tmp_path)) == (b"new", ["t.csv"])


@pytest.mark.parametrize("replace", [False, True])
def test_what_ends_the_writing_leaves_no_part(tmp_path, replace):
    def write():
        with whole_file(tmp_path / "t.csv", replace=replace) as partial:
            partial.write_bytes(b"ha")
            assert names(tmp_path) == [partial.name] == [".t.csv.partial"]
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write()
    assert names(tmp_path) == []


@pytest.mark.parametrize(
    ("path", "match"),
    [
        ("none/t.csv", "there is no directory"),
        ("busy", "busy cannot be written: Is a directory"),
    ],
)
def test_a_place_that_takes_no_file_is_told_in_a_sentence(tmp_path, path, match):
    (tmp_path / ".busy.partial").mkdir()
    with pytest.raises(InputError, match=match):
        write_file(tmp_path / path, b"")
    assert names(tmp_path) == [".busy.partial"]


def test_a_path_without_a_name_is_a_directory():
    with pytest.raises(InputError, match="is a directory"):
        write_file(Path("/"), b"")


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def set_in(folder, content=b"new", numbers="123"):
    return [(folder / number, content + number.encode()) for number in numbers]


@pytest.mark.parametrize("links", [True, False])
@pytest.mark.parametrize("replace", [False, True])
def test_several_files_are_written(tmp_path, monkeypatch, links, replace):
    def no_links(*_):
        raise OSError(1, "Operation not permitted")

    if not links:
        monkeypatch.setattr("os.link", no_links)
    if replace:
        (tmp_path / "2").write_bytes(b"old")
    write_files(set_in(tmp_path), replace=replace)
    assert contents(tmp_path) == {"1": b"new1", "2": b"new2", "3": b"new3"}


@pytest.mark.parametrize("links", [True, False])
def test_of_several_files_none_is_written_where_one_is_there(tmp_path, monkeypatch, links):
    def no_links(*_):
        raise OSError(1, "Operation not permitted")

    if not links:
        monkeypatch.setattr("os.link", no_links)
    (tmp_path / "2").write_bytes(b"old")
    with pytest.raises(InputError, match="2 already exists"):
        write_files(set_in(tmp_path))
    assert contents(tmp_path) == {"2": b"old"}


def test_several_files_leave_nothing_if_making_them_is_ended(tmp_path):
    def made():
        yield tmp_path / "1", b"one"
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_files(made())
    with pytest.raises(InputError, match="there is no directory"):
        write_files([(tmp_path / "1", b"one"), (tmp_path / "none" / "a", b"two")])
    assert names(tmp_path) == []
