"""What was read of clip files is kept, comes back as it was, and never in place of something else."""

from __future__ import annotations

import json
import shutil
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.common.wording import phrase
from metagraph.errors import FileError
from metagraph.formats import motion_cache, store
from metagraph.formats.clips import digest, read_clips
from metagraph.formats.motion_cache import finish, read_or_kept
from metagraph.motion.clip import Clip, Repair

SAMPLE = Path(__file__).resolve().parents[2] / "sample_clips"
CLIP = sorted((SAMPLE / "clips").glob("*.glb"))[0]
REAL = ("bandai-namco-1/*.bvh", "kaykit*/**/*.glb", "sumerian*/**/*.glb", "**/*.fbx")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    place = tmp_path / "kept"
    monkeypatch.setenv("METAGRAPH_MOTION_CACHE", str(place))
    motion_cache._cache.cache_clear()
    return place


def read(path: Path, as_is: tuple[str, ...] = ()) -> list[Clip]:
    return read_or_kept(path, digest(path), as_is)


def assert_same(one: list[Clip], other: list[Clip]) -> None:
    assert len(one) == len(other)
    for a, b in zip(one, other, strict=True):
        for field in fields(Clip):
            x, y = getattr(a, field.name), getattr(b, field.name)
            if isinstance(x, np.ndarray):
                assert x.dtype == y.dtype and x.shape == y.shape and x.tobytes() == y.tobytes(), field.name
                assert not y.flags.writeable
            else:
                assert x == y, field.name
        for name in ("rest_rotations", "rest_translations", "parents"):
            assert getattr(a.skeleton, name).tobytes() == getattr(b.skeleton, name).tobytes()
        assert a.skeleton.names == b.skeleton.names


def files(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.is_file()]


def barred(*_: object) -> list[Clip]:
    raise AssertionError("it was read anew")


def test_what_was_read_comes_back_to_the_bit_and_the_file_is_not_read_again(
    monkeypatch: pytest.MonkeyPatch, folder: Path
) -> None:
    first = read(CLIP)
    finish()
    assert [p.suffix for p in files(folder)] == [".motion"]
    monkeypatch.setattr(motion_cache, "read_clips", barred)
    assert_same(first, read(CLIP))
    assert_same(first, read_clips(CLIP))


def test_clips_are_kept_whose_notes_know_their_template(monkeypatch: pytest.MonkeyPatch) -> None:
    repair = Repair("unit", phrase("{n} frames were joined", n=2))
    noted = [replace(read_clips(CLIP)[0], notes=(phrase("{n} gaps were filled", n=3),), repairs=(repair,))]
    monkeypatch.setattr(motion_cache, "read_clips", lambda *_: noted)
    read(CLIP)
    finish()
    monkeypatch.setattr(motion_cache, "read_clips", barred)
    assert_same(noted, read(CLIP))


def test_clips_of_a_project_share_a_skeleton(monkeypatch: pytest.MonkeyPatch) -> None:
    store.open_project(SAMPLE / "practice.metagraph.yaml")
    finish()
    monkeypatch.setattr(motion_cache, "read_clips", barred)
    again = store.open_project(SAMPLE / "practice.metagraph.yaml")
    motions = [e.motion for e in again.project.clips.values()]
    assert len(motions) > 5 and all(m is not None for m in motions)
    assert len({id(m.skeleton) for m in motions if m is not None}) == 1


@pytest.mark.parametrize("pattern", REAL)
def test_clips_of_others_come_back_to_the_bit(pattern: str, shared_data: Path) -> None:
    found = sorted(shared_data.glob(pattern), key=lambda p: p.stat().st_size)[:3]
    if not found:
        pytest.skip(f"no {pattern} there")
    for path in found:
        try:
            first = read(path)
        except FileError:
            continue
        finish()
        assert_same(first, read(path))


def test_a_name_another_content_or_what_is_left_as_it_is_makes_another(tmp_path: Path, folder: Path) -> None:
    other = tmp_path / "other name.glb"
    shutil.copy(CLIP, other)
    read(CLIP), read(other), read(CLIP, ("scale",))
    read_or_kept(CLIP, "another content", ())
    finish()
    assert len(files(folder)) == 4


@pytest.mark.parametrize("harm", ["nothing", "half", "a bit", "zeros", "another mark", "a folder"])
def test_what_is_broken_is_read_anew_and_mended(harm: str, folder: Path) -> None:
    first = read(CLIP)
    finish()
    (place,) = files(folder)
    good = place.read_bytes()
    content = bytearray(good)
    if harm == "a folder":
        place.unlink()
        place.mkdir()
    else:
        content[len(content) // 2] ^= 1
        whole = {"nothing": b"", "half": content[: len(content) // 2], "a bit": content}
        broken = {"zeros": bytes(len(content)), "another mark": b"x" + content[1:]}
        place.write_bytes((whole | broken)[harm])
    assert_same(first, read(CLIP))
    finish()
    if harm != "a folder":
        assert place.read_bytes() == good


def test_a_file_that_names_others_is_never_kept(tmp_path: Path, folder: Path) -> None:
    content = CLIP.read_bytes()
    length = int.from_bytes(content[12:16], "little")
    data = json.loads(content[20 : 20 + length])
    start = 20 + length + 8
    (tmp_path / "motion.bin").write_bytes(content[start : start + data["buffers"][0]["byteLength"]])
    data["buffers"][0]["uri"] = "motion.bin"
    apart = tmp_path / "apart.gltf"
    apart.write_text(json.dumps(data))
    assert read(apart)
    chunk = json.dumps(data).encode()
    chunk += b" " * (-len(chunk) % 4)
    binary = tmp_path / "apart.glb"
    head = b"glTF" + (2).to_bytes(4, "little") + (20 + len(chunk)).to_bytes(4, "little")
    binary.write_bytes(head + len(chunk).to_bytes(4, "little") + b"JSON" + chunk)
    assert read(binary)
    finish()
    assert not folder.exists()


def test_other_programs_that_read_are_another_cache(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    read(CLIP)
    monkeypatch.setattr(motion_cache, "_readers", lambda: "newer")
    read(CLIP)
    finish()
    assert len(files(folder)) == 2


def test_where_nothing_can_be_kept_it_is_read(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, folder: Path
) -> None:
    folder.write_text("a file where the folder should be")
    assert read(CLIP)
    finish()
    monkeypatch.setenv("METAGRAPH_MOTION_CACHE", "")
    assert read(CLIP)
    monkeypatch.delenv("METAGRAPH_MOTION_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "caches"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "caches"))
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    kept = motion_cache.find_motion_cache_folder()
    assert kept is not None and kept.name == "motion" and kept.is_relative_to(tmp_path)


def test_an_unreadable_file_is_told_as_ever(tmp_path: Path) -> None:
    bad = tmp_path / "bad.bvh"
    bad.write_text("HIERARCHY")
    with pytest.raises(FileError):
        read_or_kept(bad, "x", ())
