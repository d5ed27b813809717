"""What compiled loops read of glTF files is what NumPy reads, to a rounding; what is refused is refused in
the same words.
"""

from __future__ import annotations

import json
import random
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.formats import gltf_columns, gltf_loops, stray_poses
from metagraph.formats.gltf import read_gltf_clips, write_glb
from metagraph.formats.gltf_columns import ChannelTable, PlainAccessors
from metagraph.formats.gltf_sampling import Grid, sample
from metagraph.formats.gltf_values import Document
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from sample_clips.make.mannequin_skeleton import mannequin_skeleton

gltf_kernels = pytest.importorskip("metagraph.formats.gltf_kernels")
json_kernels = pytest.importorskip("metagraph.formats.json_kernels")
stray_kernels = pytest.importorskip("metagraph.formats.stray_kernels")

Array = Any
CLOSE = 1.2e-7  # a rounding of numbers up to 1


@pytest.fixture(autouse=True)
def nothing_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gltf_loops, "_read", [gltf_loops.MANY])
    monkeypatch.setattr(stray_poses, "_measured_so_far", [stray_poses.MANY])
    for loops in (gltf_loops.TEXT, gltf_loops.KEYS, stray_poses.COMPILED):
        monkeypatch.setattr(loops, "now", None)


@pytest.fixture
def loaded(monkeypatch: pytest.MonkeyPatch) -> Callable[[bool], None]:
    """Turns loops on, and off."""

    def turn(on: bool) -> None:
        gltf_loops.TEXT.now = json_kernels if on else None
        gltf_loops.KEYS.now = gltf_kernels if on else None
        stray_poses.COMPILED.now = stray_kernels if on else None

    return turn


def outcome(path: Path) -> list[Clip] | str:
    try:
        return read_gltf_clips(path)
    except FileError as error:
        return str(error)


def same(one: list[Clip] | str, other: list[Clip] | str) -> None:
    if isinstance(one, str) or isinstance(other, str):
        assert one == other
        return
    for a, b in zip(one, other, strict=True):
        assert (a.name, a.fps, a.translated, a.morphs) == (b.name, b.fps, b.translated, b.morphs)
        assert (a.notes, a.repairs, a.skeleton) == (b.notes, b.repairs, b.skeleton)
        assert a.frames == b.frames
        np.testing.assert_allclose(a.rotations, b.rotations, 0, CLOSE)
        np.testing.assert_allclose(a.translations, b.translations, CLOSE, CLOSE)
        assert a.weights is not None and b.weights is not None
        assert a.weights.tobytes() == b.weights.tobytes()


def test_files_of_studios_are_read_as_without_loops(
    zoo_files: dict[str, Path], loaded: Callable[[bool], None]
) -> None:
    files = [path for path in zoo_files.values() if path.suffix in (".glb", ".gltf", ".vrm")]
    assert files
    plain = [outcome(path) for path in files]
    loaded(True)
    for path, clips in zip(files, plain, strict=True):
        same(outcome(path), clips)


def test_real_files_are_read_as_without_loops(shared_data: Path, loaded: Callable[[bool], None]) -> None:
    files = sorted([*shared_data.rglob("*.glb"), *shared_data.rglob("*.gltf")])
    plain = [outcome(path) for path in files]
    loaded(True)
    for path, clips in zip(files, plain, strict=True):
        same(outcome(path), clips)


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], bytes]:
    """The JSON and the numbers of a file of three takes, each with thinned keys and morphs."""
    skeleton = mannequin_skeleton()
    takes = []
    for n, frames in enumerate((9, 30, 2)):
        t = np.arange(frames)[:, None] / 30
        turns = rotation.from_axis_angle(
            np.broadcast_to([0, 0.6, 0.8], (frames, len(skeleton), 3)),
            np.sin(3 * t + np.arange(len(skeleton))),
        )
        root = skeleton.rest_translations[0] + t * [1, 0, 0]
        smile = ("smile",), np.linspace(0, 1, frames)[:, None]
        takes.append(Clip(f"take {n}", skeleton, 30, turns, root[:, None], (0,), *smile))
    path = tmp_path_factory.mktemp("small") / "small.glb"
    write_glb(path, takes, quantize=False)
    data = path.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def glb(said: Any, numbers: bytes) -> bytes:
    head = json.dumps(said).encode() if not isinstance(said, bytes) else said
    head += b" " * (-len(head) % 4)
    return b"".join(
        (
            struct.pack("<4sIIII", b"glTF", 2, 28 + len(head) + len(numbers), len(head), 0x4E4F534A),
            head,
            struct.pack("<II", len(numbers), 0x004E4942),
            numbers,
        )
    )


def places(value: Any) -> Iterator[tuple[Any, Any]]:
    """Yield where a document's numbers, texts, objects and lists are: what holds each, and under what."""
    for key, inner in list(value.items() if isinstance(value, dict) else enumerate(value)):
        yield value, key
        if isinstance(inner, dict | list):
            yield from places(inner)


def test_documents_with_something_wrong_have_the_same_outcome(
    tmp_path: Path, small: tuple[dict[str, Any], bytes], loaded: Callable[[bool], None]
) -> None:
    chance = random.Random(5)
    wrong = (
        -1,
        0,
        1,
        3,
        2**15,
        10**17,
        2**64,
        1.5,
        2.0,
        True,
        None,
        "rotation",
        "x\\u00e9",
        "é",
        {},
        [],
        [{}],
    )
    path = tmp_path / "wrong.glb"
    refused = 0
    for _ in range(250):
        said = json.loads(json.dumps(small[0]))
        spots = [spot for name in ("animations", "accessors", "bufferViews") for spot in places(said[name])]
        for holder, key in chance.sample(spots, chance.choice((1, 1, 2))):
            if chance.random() < 0.3 and isinstance(holder, dict):
                holder.pop(key, None)
            else:
                holder[key] = chance.choice(wrong)
        text = json.dumps(said, ensure_ascii=chance.random() < 0.5, indent=chance.choice((None, 1))).encode()
        path.write_bytes(glb(text, small[1]))
        loaded(False)
        plain = outcome(path)
        loaded(True)
        same(outcome(path), plain)
        refused += isinstance(plain, str)
    assert 20 < refused < 230


def test_numbers_that_are_none_are_refused_in_the_same_words(
    tmp_path: Path, small: tuple[dict[str, Any], bytes], loaded: Callable[[bool], None]
) -> None:
    chance = random.Random(6)
    path = tmp_path / "wrong.glb"
    for _ in range(60):
        numbers = np.frombuffer(small[1], "<f4").copy()
        for place in chance.sample(range(len(numbers)), 2):
            numbers[place] = chance.choice((np.nan, np.inf, -np.inf, 1e30, 0, -3))
        path.write_bytes(glb(small[0], numbers.tobytes()))
        loaded(False)
        plain = outcome(path)
        loaded(True)
        same(outcome(path), plain)


@given(
    st.lists(
        st.fixed_dictionaries(
            {"componentType": st.sampled_from([5126, 5121]), "count": st.integers(0, 9)},
            optional={
                "type": st.sampled_from(["VEC3", "SCALAR", "VEC4", "VEC9"]),
                "bufferView": st.integers(0, 4),
                "byteOffset": st.integers(0, 40),
                "normalized": st.booleans(),
                "name": st.text(st.characters(codec="utf-8")),
                'a "quoted\\ name': st.lists(st.lists(st.floats(allow_nan=False, allow_infinity=False))),
                "extras": st.dictionaries(
                    st.text(st.characters(codec="utf-8")), st.text(st.characters(codec="utf-8"))
                ),
            },
        )
    ),
    st.lists(
        st.fixed_dictionaries(
            {"buffer": st.integers(0, 1), "byteLength": st.integers(0, 200)},
            optional={"byteStride": st.sampled_from([12, 16, 20]), "byteOffset": st.integers(0, 9)},
        )
    ),
    st.sampled_from([None, 0, 3]),
)
@settings(max_examples=150, deadline=None)
def test_columns_are_the_same_from_text_and_from_values(
    accessors: list[Any], views: list[Any], indent: int | None
) -> None:
    said = json.dumps(
        {"accessors": accessors, "bufferViews": views}, indent=indent, ensure_ascii=False
    ).encode()
    try:
        plain = msgspec.json.decode(said, type=Document)
    except msgspec.ValidationError:
        plain = None
    gltf_loops.TEXT.now = json_kernels
    try:
        document = gltf_columns.decoded(said)
    except msgspec.ValidationError:
        document = None
    finally:
        gltf_loops.TEXT.now = None
    assert (document is None) == (plain is None)
    if document is None or plain is None:
        return
    assert list(document.accessors) == plain.accessors
    assert list(document.buffer_views) == plain.buffer_views
    one, other = PlainAccessors.of(document), PlainAccessors.of(plain)
    assert one.begins.tolist() == other.begins.tolist()
    there = one.begins >= 0
    assert one.counts[there].tolist() == other.counts[there].tolist()
    assert one.widths[there].tolist() == other.widths[there].tolist()


FIELDS = sorted(
    {
        *gltf_columns._ACCESSOR, *gltf_columns._VIEW, *gltf_columns._CHANNEL, *gltf_columns._TARGET,
        *gltf_columns._SAMPLER, *gltf_columns.WIDTHS, *gltf_columns.PATHS, *gltf_columns.MODES,
    }
)  # fmt: skip


@pytest.mark.parametrize("name", FIELDS)
def test_no_other_word_is_taken_for_one_that_is_known(
    small: tuple[dict[str, Any], bytes], loaded: Callable[[bool], None], name: str
) -> None:
    """Words are told by a digest: those that differ in one letter or two neighbours, least of all."""
    known = gltf_columns._digest(name)
    for at in range(len(name) - 1):
        for first in range(33, 127):
            others = (name[:at] + chr(first) + chr(second) + name[at + 2 :] for second in range(33, 127))
            assert not [other for other in others if other != name and gltf_columns._digest(other) == known]
    for other in ("~" + name[1:], name[:-1], name + " ", "\0" + name, name + "\0"):
        text = json.dumps(small[0]).replace(f'"{name}"', f'"{other}"').encode()
        found = []
        for on in (True, False):
            loaded(on)
            try:
                document = gltf_columns.decoded(text)
                found.append([list(document.accessors), list(document.buffer_views)])
            except msgspec.MsgspecError as error:
                found.append([str(error)])
        assert found[0] == found[1], other


def test_channels_are_the_same_from_text_and_from_values(small: tuple[dict[str, Any], bytes]) -> None:
    text = json.dumps(small[0]).encode()
    gltf_loops.TEXT.now = json_kernels
    rows = gltf_columns.decoded(text).animations
    assert isinstance(rows[0].channels, gltf_columns.Rows)
    one, other = ChannelTable.of(rows), ChannelTable.of(msgspec.json.decode(text, type=Document).animations)
    for name in ("begins", "samplers", "nodes", "paths", "inputs", "modes", "outputs"):
        assert getattr(one, name).tolist() == getattr(other, name).tolist()
    assert len(one.paths) > 100 and not one.odd - {0, 1, 2}


@given(st.integers(0, 10_000), st.sampled_from(["frames", "any", "one"]), st.booleans())
@settings(max_examples=60, deadline=None)
def test_turns_between_keys_are_those_of_numpy(seed: int, kind: str, still: bool) -> None:
    chance = np.random.default_rng(seed)
    grid = Grid(1.5 + np.arange(int(chance.integers(1, 25))) / 30, 30.0)
    times = {
        "frames": grid.times,
        "any": np.sort(chance.uniform(1.4, grid.times[-1] + 0.2, 7)),
        "one": grid.times[:1],
    }[kind]
    keys = rotation.normalize(chance.normal(size=(3, len(times), 4)).astype(np.float32))
    if still:
        keys[:] = keys[:, :1]
    frames = len(grid.times)
    expected = np.asarray(sample(times, keys, grid, "LINEAR", True), np.float32).transpose(1, 0, 2)
    out = np.zeros((frames, 3, 4), np.float32)
    one = np.zeros(1, np.int64)
    numbers = np.frombuffer(keys.tobytes(), np.float32)
    starts, joints = 4 * len(times) * np.arange(3), np.arange(3)
    at = grid.times, one + frames, np.array([grid.near])
    gltf_kernels.turn(numbers, starts, joints, one + 3, one, times, one + len(times), *at, out)
    np.testing.assert_allclose(out, expected, 0, CLOSE)
    none = np.zeros(0, np.int64), np.zeros((0, 4), np.float32)
    assert gltf_kernels.finish(out, one + frames, *none) == -1
    np.testing.assert_allclose(out, rotation.continuous(rotation.normalize(expected)), 0, CLOSE)


@pytest.mark.parametrize("long", [3, 2000])  # from so many frames on two threads share a take
def test_measures_of_stray_poses_are_those_of_numpy(monkeypatch: pytest.MonkeyPatch, long: int) -> None:
    monkeypatch.setattr(stray_poses, "LONG", long)
    skeleton = mannequin_skeleton()
    chance = np.random.default_rng(8)
    takes = []
    for frames in (1, 7):
        turns = rotation.normalize(chance.normal(size=(frames, len(skeleton), 4)))
        takes.append(Clip("t", skeleton, 30, turns, chance.normal(size=(frames, 2, 3)), (0, 5)))
    weights = stray_poses._weights(skeleton, [0, 5])
    plain = stray_poses._measured(skeleton, takes, [0, 5], weights)
    stray_poses.COMPILED.now = stray_kernels
    apart = [0]  # the way from one take to the next means nothing
    for n, (a, b) in enumerate(
        zip(stray_poses._measured(skeleton, takes, [0, 5], weights), plain, strict=True)
    ):
        if n < 2:
            np.testing.assert_allclose(a, b, 0, 1e-6)
        else:
            np.testing.assert_allclose(np.delete(a[: len(b)], apart), np.delete(b, apart), 0, 1e-6)


@given(st.lists(st.floats(0, 1e3), min_size=1, max_size=60))
def test_the_usual_step_is_numpys_quantile(steps: list[float]) -> None:
    assert stray_poses._usual(steps) == np.quantile(steps, 0.95)
