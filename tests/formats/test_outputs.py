"""What a command may write over: its own earlier outputs, and nothing else unless told."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from metagraph.errors import FileError
from metagraph.formats import outputs as o
from metagraph.formats.atomic import write_atomically, write_together
from metagraph.formats.locking import Lock, make_owner
from metagraph.formats.outputs import Outputs, check_outputs


@pytest.fixture(autouse=True)
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("METAGRAPH_DATA", str(tmp_path / "data"))
    return tmp_path / "data"


def write(
    path: Path, content: bytes = b"made", overwrite: bool = False, command: str = "render", **reads: Path
) -> None:
    with check_outputs(Outputs(overwrite, command)) as outputs:
        outputs.reads(*reads.values())
        outputs.claim(path)
        write_atomically(path, content)


def test_a_new_file_and_an_own_earlier_output_are_written(tmp_path: Path) -> None:
    path = tmp_path / "a.bvh"
    write(path, b"1")
    write(path, b"2")
    assert path.read_bytes() == b"2"


@pytest.mark.parametrize("what", ["somebody's", "changed by hand", "of another command", "forgotten"])
def test_other_files_are_left_with_the_way_to_replace_them(tmp_path: Path, data: Path, what: str) -> None:
    path = tmp_path / "a.bvh"
    if what == "somebody's":
        path.write_bytes(b"work")
    else:
        write(path, command="speech" if what == "of another command" else "render")
        if what == "changed by hand":
            path.write_bytes(b"made, and more")
        elif what == "forgotten":
            for note in (data / "written").iterdir():
                note.write_text("{")
    before = path.read_bytes()
    with pytest.raises(FileError, match="--overwrite"):
        write(path, b"new")
    assert path.read_bytes() == before
    write(path, b"new", overwrite=True)
    write(path, b"again")
    assert path.read_bytes() == b"again", "from then on it is the command's own"


@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize(
    "way", ["itself", "a link", "a hard link", "another spelling", "through a linked folder"]
)
def test_an_input_is_never_written_by_any_name(tmp_path: Path, way: str, overwrite: bool) -> None:
    source = tmp_path / "in" / "clip.bvh"
    source.parent.mkdir()
    source.write_bytes(b"motion")
    path = tmp_path / "out.bvh"
    if way == "itself":
        path = source
    elif way == "a link":
        path.symlink_to(source)
    elif way == "a hard link":
        os.link(source, path)
    elif way == "another spelling":
        path = source.parent / ".." / "in" / "clip.bvh"
    else:
        (tmp_path / "linked").symlink_to(source.parent)
        path = tmp_path / "linked" / "clip.bvh"
    with pytest.raises(FileError):
        write(path, b"new", overwrite, source=source)
    assert source.read_bytes() == path.read_bytes() == b"motion"


def test_an_input_that_is_missing_is_not_made_up(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="this very command"):
        write(tmp_path / "gone.bvh", source=tmp_path / "gone.bvh")


def test_files_of_a_folder_that_is_read_stay_reports_in_it_may_be_replaced(tmp_path: Path) -> None:
    folder = tmp_path / "study"
    (folder / "report").mkdir(parents=True)
    for name in ("log.jsonl", "report/page.json", "old.html"):
        (folder / name).write_bytes(b"there")
    with pytest.raises(FileError):
        write(folder / "log.jsonl", overwrite=True, study=folder)
    write(folder / "old.html", overwrite=True, study=folder)
    with check_outputs(Outputs(True, "report")) as outputs:
        outputs.reads(folder)
        outputs.claim(folder / "report")  # a folder of its own below
        write_atomically(folder / "report" / "page.json", b"new")
    write(folder / "new.jsonl", study=folder)
    write(folder / "new.jsonl", b"again", study=folder)


def test_what_a_gltf_names_is_read_with_it(tmp_path: Path) -> None:
    (tmp_path / "a.gltf").write_text(
        '{"buffers": [{"uri": "my%20data.bin"}], "images": [{"uri": "data:x"}, {}]}'
    )
    (tmp_path / "my data.bin").write_bytes(b"motion")
    with pytest.raises(FileError):
        write(tmp_path / "my data.bin", overwrite=True, clip=tmp_path / "a.gltf")


def test_an_input_that_becomes_known_after_the_claim_is_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / "clip.bvh"
    path.write_bytes(b"motion")
    with check_outputs(Outputs(True)) as outputs:
        outputs.claim(path)
        with pytest.raises(FileError):
            outputs.reads(path)


@pytest.mark.parametrize("overwrite", [False, True])
def test_a_project_that_is_open_elsewhere_stays(tmp_path: Path, overwrite: bool) -> None:
    path = tmp_path / "my.metagraph.yaml"
    path.write_bytes(b"work")
    lock = Lock(path, make_owner())
    assert lock.acquire() is None
    for name in (path, tmp_path / "link.metagraph.yaml"):
        if name != path:
            name.symlink_to(path)
        with pytest.raises(FileError, match="is open in"):
            write(name, overwrite=overwrite)
    lock.release()
    assert path.read_bytes() == b"work"


def test_it_is_looked_again_at_the_moment_of_writing(tmp_path: Path) -> None:
    path = tmp_path / "a.bvh"
    with check_outputs(Outputs()) as outputs:
        outputs.claim(path)
        path.write_bytes(b"somebody was faster")
        with pytest.raises(FileError, match="--overwrite"):
            write_atomically(path, b"new")
    assert path.read_bytes() == b"somebody was faster"


def test_the_same_bytes_take_nothing_away(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_bytes(b"same")
    with check_outputs(Outputs()):
        write_atomically(tmp_path / "a.json", b"same")


def test_pipes_and_devices_are_written_without_questions(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with check_outputs(Outputs()) as outputs:
        for path in (tmp_path / "pipe", Path("/dev/null"), Path("/dev/stdout")):
            outputs.check(path)


def test_all_files_or_none_are_written_together(tmp_path: Path) -> None:
    (tmp_path / "b").write_bytes(b"work")
    with check_outputs(Outputs()), pytest.raises(FileError):
        write_together(tmp_path, {"a": b"1", "b": b"2"})
    assert sorted(p.name for p in tmp_path.iterdir()) == ["b"]


def test_where_nothing_can_be_remembered_it_is_written_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_bytes(b"")
    monkeypatch.setenv("METAGRAPH_DATA", str(tmp_path / "file" / "below"))
    write(tmp_path / "a.bvh")
    with pytest.raises(FileError, match="--overwrite"):
        write(tmp_path / "a.bvh", b"other")


def test_the_oldest_of_too_many_notes_go(tmp_path: Path, data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(o, "MOST", 3)
    for n in range(6):
        write(tmp_path / f"{n}.bvh")
    assert len(list((data / "written").iterdir())) == 3


def test_outside_of_a_command_nothing_is_checked(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"old")
    write_atomically(tmp_path / "a", b"new")
    assert (tmp_path / "a").read_bytes() == b"new"
