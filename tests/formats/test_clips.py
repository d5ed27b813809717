"""Reading files of any format, one by one and in bulk."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.bvh.file import write_bvh
from metagraph.formats.clip_readers import list_clip_suffixes
from metagraph.formats.clips import digest, find_clip_files, import_clips, read_clips
from metagraph.formats.gltf.reader import write_glb
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from sample_clips.make.mannequin_skeleton import mannequin_skeleton
from tests import zoo

SKELETON = mannequin_skeleton()


def clip(name: str = "wave", frames: int = 8) -> Clip:
    rotations = rotation.make_identity_rotations((frames, len(SKELETON)))
    rotations[:, 3] = rotation.from_axis_angle(np.tile([0, 1.0, 0], (frames, 1)), 0.1 * np.arange(frames))
    return Clip(name, SKELETON, 30, rotations, np.tile(SKELETON.rest_translations[:1], (frames, 1, 1)))


def test_every_format_reads_through_one_door(tmp_path: Path) -> None:
    write_glb(tmp_path / "a.GLB", [clip("one"), clip("two")])
    write_bvh(clip(), tmp_path / "b.bvh")
    assert [c.name for c in read_clips(tmp_path / "a.GLB")] == ["one", "two"]
    assert [c.name for c in read_clips(tmp_path / "b.bvh")] == ["b"]


def test_a_second_person_in_a_file_is_told(tmp_path: Path) -> None:
    count = len(SKELETON)
    both = Skeleton(
        (*SKELETON.names, *(f"B_{name}" for name in SKELETON.names)),
        np.concatenate([SKELETON.parents, np.where(SKELETON.parents < 0, -1, SKELETON.parents + count)]),
        np.tile(SKELETON.rest_rotations, (2, 1)),
        np.concatenate([SKELETON.rest_translations, SKELETON.rest_translations]),
    )
    one = clip()
    rotations = np.tile(one.rotations, (1, 2, 1))
    write_bvh(Clip("wave", both, 30, rotations, one.translations), tmp_path / "two.bvh")
    write_bvh(one, tmp_path / "one.bvh")
    told = [n for n in read_clips(tmp_path / "two.bvh")[0].notes if "several figures" in n]
    root = SKELETON.names[0]
    assert len(told) == 1 and f"below '{root}' is played, not 'B_{root}'" in told[0]
    assert not any("several figures" in n for n in read_clips(tmp_path / "one.bvh")[0].notes)


def test_nameless_bind_poses_of_one_frame_are_skipped_with_a_note_and_others_kept_last(
    tmp_path: Path,
) -> None:
    write_glb(tmp_path / "a.glb", [clip("sit", 1), clip("walk"), clip("Take 001", 1)])
    clips = read_clips(tmp_path / "a.glb")
    assert [c.name for c in clips] == ["walk", "sit"]
    assert any("skipped 'a'" in note for note in clips[0].notes)
    assert any("'sit'" in note for note in clips[1].notes)


def test_a_file_of_nothing_but_poses_keeps_them(tmp_path: Path) -> None:
    write_glb(tmp_path / "a.glb", [clip("sit", 1), clip("stand", 1)])
    assert len(read_clips(tmp_path / "a.glb")) == 2


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.fbx", b"HIERARCHY\nROOT", ("BVH", "Rename")),
        ("a.bvh", b"glTF\2\0\0\0", ("glTF", "Rename")),
        ("a.glb", b"Kaydara FBX Binary  \0", ("FBX", "Rename")),
        ("a.bvh", b"", ("empty",)),
        ("a.glb", b"version https://git-lfs.github.com/spec/v1\n", ("LFS",)),
        ("a.glb", b"<!DOCTYPE html>", ("web page",)),
        ("a.bvh", b"\xff\xfb\x90\x44", ("another kind of file",)),
        ("a.txt", b"hello", ("extension", ".bvh")),
        ("a", b"hello", ("extension",)),
    ],
)
def test_a_file_that_is_not_what_its_ending_says_is_refused_with_a_remedy(
    tmp_path: Path, name: str, content: bytes, words: tuple[str, ...]
) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(FileError) as caught:
        read_clips(tmp_path / name)
    assert caught.value.remedy
    for word in words:
        assert word in str(caught.value)


def test_a_missing_file_and_a_folder_are_refused(tmp_path: Path) -> None:
    (tmp_path / "folder.bvh").mkdir()
    for name in ("none.bvh", "folder.bvh"):
        with pytest.raises(FileError, match="cannot be read"):
            read_clips(tmp_path / name)


def test_clip_files_are_found_below_a_folder_in_a_stable_order(tmp_path: Path) -> None:
    for name in ("b.bvh", "A.glb", "sub/c.FBX", ".hidden/d.bvh", "e.txt", ".f.glb"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(b"")
    assert [p.relative_to(tmp_path).as_posix() for p in find_clip_files(tmp_path)] == [
        "A.glb",
        "b.bvh",
        "sub/c.FBX",
    ]
    assert ".vrm" in list_clip_suffixes()


def test_a_bad_file_among_many_fails_alone_with_its_reason(tmp_path: Path) -> None:
    for i in range(5):
        write_bvh(clip(), tmp_path / f"{i}.bvh")
    (tmp_path / "2.bvh").write_text("HIERARCHY\n")
    steps: list[tuple[int, int, str]] = []
    report = import_clips(
        find_clip_files(tmp_path), lambda done, total, path: steps.append((done, total, path.name))
    )
    assert [p.name for p, _, _ in report.clips] == ["0.bvh", "1.bvh", "3.bvh", "4.bvh"]
    assert [f.path.name for f in report.failures] == ["2.bvh"]
    assert steps == [(i, 5, f"{i}.bvh") for i in range(5)] + [(5, 5, "4.bvh")]
    assert len({id(c.skeleton) for _, _, c in report.clips}) == 1
    assert any(note.startswith("0.bvh: units") for note in report.notes)
    assert not report.cancelled


def test_an_import_stops_when_asked_and_keeps_what_it_has(tmp_path: Path) -> None:
    for i in range(5):
        write_bvh(clip(), tmp_path / f"{i}.bvh")
    asked = iter([False, False, True, True])
    report = import_clips(find_clip_files(tmp_path), cancelled=lambda: next(asked))
    assert report.cancelled and len(report.clips) == 2


def test_importing_nothing_gives_an_empty_report() -> None:
    report = import_clips([])
    assert report.clips == () and report.failures == () and not report.cancelled


def test_takes_are_numbered_within_their_file(tmp_path: Path) -> None:
    write_glb(tmp_path / "a.glb", [clip("one"), clip("two")])
    assert [(n, c.name) for _, n, c in import_clips([tmp_path / "a.glb"]).clips] == [(0, "one"), (1, "two")]


def test_the_digest_is_the_sha_256_of_the_content(tmp_path: Path) -> None:
    (tmp_path / "a.bvh").write_bytes(b"content")
    assert digest(tmp_path / "a.bvh") == hashlib.sha256(b"content").hexdigest()
    with pytest.raises(FileError):
        digest(tmp_path / "none")


@pytest.mark.parametrize("name", zoo.ANIMALS)
def test_units_axes_rests_and_bind_poses_of_the_zoo_are_seen_through(
    zoo_files: dict[str, Path], name: str
) -> None:
    animal, clips = zoo.ANIMALS[name], read_clips(zoo_files[name])
    assert [c.name for c in clips] == (list(zoo.TAKES) if animal.kind == ".glb" else [name])
    for clip, take in zip(clips, zoo.TAKES, strict=False):
        assert clip.fps == pytest.approx(animal.fps) and clip.duration == pytest.approx(zoo.SECONDS)
        _, positions = clip.skeleton.globals(clip.poses())
        for joint in zoo.joints_of(animal):
            found = positions[:, clip.skeleton.index(str(animal.called(joint)))]
            assert np.abs(found - zoo.places(name, joint, take)).max() < 1e-3, joint


@pytest.mark.nightly
def test_all_real_files_are_read_or_refused_in_words(shared_data: Path) -> None:
    files = [
        f
        for f in find_clip_files(shared_data)
        if f.suffix != ".fbx" and ("bandai" not in str(f) or "_sad_" in f.name)
    ]
    report = import_clips(files)
    assert len(report.clips) > 250
    # Four files hold a mesh and no motion.
    assert sorted(f.path.name for f in report.failures) == [
        "alien.gltf",
        "fox.glb",
        "human-mannequin.glb",
        "seagull.glb",
    ]
    assert all("no animation" in f.cause for f in report.failures)
    animals = {
        c.skeleton.fingerprint
        for p, _, c in report.clips
        if p.name in ("bird-animations.glb", "quad-creature-animations.glb")
    }
    people = {c.skeleton.fingerprint for p, _, c in report.clips if p.name == "human-addon-animations.glb"}
    assert len(animals) == 2 and not animals & people
