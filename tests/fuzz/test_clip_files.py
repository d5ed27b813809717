"""Broken and hostile files: a reader returns a value or raises a FileError that helps; nothing else, and in
little memory.
"""

from __future__ import annotations

import copy
import json
import random
import struct
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from metagraph.errors import FileError
from metagraph.formats.bvh.file import read_bvh, write_bvh
from metagraph.formats.clips import read_clips
from metagraph.formats.gltf.reader import read_character, read_gltf_clips, read_vrm_roles, write_glb
from metagraph.motion import rotation
from metagraph.motion.character_mesh import CharacterMesh, MeshMaterial, Surface
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton

MEMORY = 400 << 20  # bytes: a small file may cost this much at its very worst


def sample() -> tuple[Clip, CharacterMesh]:
    names = ("Hips", "Spine", "Head", "LeftUpLeg", "LeftLeg", "LeftFoot")
    offsets = np.array([[0, 1, 0], [0, 0.4, 0], [0, 0.3, 0], [0.1, 0, 0], [0, -0.45, 0], [0, -0.45, 0]])
    skeleton = Skeleton(names, np.array([-1, 0, 1, 0, 3, 4]), rotation.make_identity_rotations((6,)), offsets)
    rotations = rotation.make_identity_rotations((6, 6))
    rotations[:, 2] = rotation.from_axis_angle(np.tile([0, 1.0, 0], (6, 1)), 0.2 * np.arange(6))
    root = offsets[0] + 0.1 * np.arange(6)[:, None]
    clip = Clip(
        "nod",
        skeleton,
        30,
        rotations,
        root[:, None],
        morphs=("smile",),
        weights=np.linspace(0, 1, 6)[:, None],
    )
    character = CharacterMesh(
        "c",
        skeleton,
        np.eye(3, dtype=np.float32),
        np.eye(3, dtype=np.float32),
        np.zeros((3, 2), np.float32),
        np.zeros((3, 4), np.uint16),
        np.tile(np.float32([1, 0, 0, 0]), (3, 1)),
        np.array([[0, 1, 2]]),
        (MeshMaterial("m", image=b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1" + b"\0" * 9),),
        (Surface(0, 1, 0),),
        ("smile",),
        np.full((1, 3, 3), 0.1, np.float32),
    )
    return clip, character


@pytest.fixture(scope="module")
def seeds(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """A sound file of each format."""
    folder = tmp_path_factory.mktemp("seeds")
    clip, character = sample()
    write_bvh(clip, folder / "a.bvh")
    write_glb(folder / "a.glb", [clip], character)
    return {".bvh": (folder / "a.bvh").read_bytes(), ".glb": (folder / "a.glb").read_bytes()}


def survives(reader: Callable[[Path], Any], path: Path) -> None:
    """Run a reader; it may only succeed or raise a FileError with all its parts."""
    try:
        reader(path)
    except FileError as error:
        assert error.cause and error.where and error.remedy, repr(error)
        assert str(error).isprintable(), repr(str(error))
        assert len(str(error)) < 2000


def all_readers(suffix: str) -> list[Callable[[Path], Any]]:
    return [read_clips, read_bvh] if suffix == ".bvh" else [read_clips, read_character, read_vrm_roles]


def check(tmp_path: Path, suffix: str, data: bytes) -> None:
    path = tmp_path / f"fuzz{suffix}"
    path.write_bytes(data)
    for reader in all_readers(suffix):
        survives(reader, path)


@pytest.mark.parametrize("suffix", [".bvh", ".glb"])
def test_files_cut_off_anywhere(tmp_path: Path, seeds: dict[str, bytes], suffix: str) -> None:
    data = seeds[suffix]
    for end in {*range(0, len(data), max(1, len(data) // 150)), *range(40), len(data) - 1}:
        check(tmp_path, suffix, data[:end])


@pytest.mark.nightly
@pytest.mark.parametrize("suffix", [".bvh", ".glb"])
def test_files_with_bytes_changed(tmp_path: Path, seeds: dict[str, bytes], suffix: str) -> None:
    rng = random.Random(1)
    for _ in range(250):
        data = bytearray(seeds[suffix])
        for _ in range(rng.choice((1, 1, 2, 8, 64))):
            data[rng.randrange(len(data))] = rng.randrange(256)
        check(tmp_path, suffix, bytes(data))


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.binary(max_size=300),
    st.sampled_from([".bvh", ".glb", ".gltf"]),
    st.sampled_from([b"", b"HIERARCHY\nROOT a\n{", b"glTF\2\0\0\0", b"{"]),
)
def test_noise(tmp_path: Path, data: bytes, suffix: str, head: bytes) -> None:
    check(tmp_path, suffix, head + data)


# --- glTF: every value replaced by a hostile one

HOSTILE = (
    -1,
    0,
    1,
    3,
    255,
    1 << 31,
    (1 << 63) - 1,
    1 << 70,
    1e308,
    -1e30,
    0.5,
    None,
    "",
    "VEC4",
    "x" * 300,
    [],
    {},
    [0] * 5,
    [[]],
    True,
)


def places(value: Any) -> Iterator[tuple[Any, Any]]:
    items: Any = (
        value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    )
    for key, inner in list(items):
        yield value, key
        yield from places(inner)


def packed(document: Any, body: bytes) -> bytes:
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(body), len(text), 0x4E4F534A)
    return head + text + struct.pack("<II", len(body), 0x004E4942) + body


def unpacked(data: bytes) -> tuple[Any, bytes]:
    size = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + size]), data[28 + size :]


@pytest.mark.nightly
def test_every_value_of_a_gltf_file_may_be_hostile(tmp_path: Path, seeds: dict[str, bytes]) -> None:
    document, body = unpacked(seeds[".glb"])
    rng = random.Random(2)
    count = len(list(places(document)))
    chosen = [[i] for i in range(count)] + [[rng.randrange(count) for _ in range(3)] for _ in range(150)]
    for numbers in chosen:
        mutant = copy.deepcopy(document)
        spots = list(places(mutant))
        for number in numbers:
            holder, key = spots[number]
            if rng.random() < 0.15 and isinstance(holder, dict):
                holder.pop(key, None)
            else:
                holder[key] = rng.choice(HOSTILE)
        check(tmp_path, ".glb", packed(mutant, body))


@pytest.mark.nightly
def test_keys_and_vertices_may_be_any_bits(tmp_path: Path, seeds: dict[str, bytes]) -> None:
    document, body = unpacked(seeds[".glb"])
    rng = np.random.default_rng(3)
    for _ in range(60):
        noise = rng.integers(0, 256, len(body), np.uint8)
        mixed = np.where(
            rng.random(len(body)) < rng.choice([0.01, 0.1, 1.0]), noise, np.frombuffer(body, np.uint8)
        )
        check(tmp_path, ".glb", packed(document, mixed.astype(np.uint8).tobytes()))
    for special in (np.nan, np.inf, 3e38, 1e-45):
        check(tmp_path, ".glb", packed(document, np.full(len(body) // 4, special, "<f4").tobytes()))


def peak(reader: Callable[[Path], Any], path: Path) -> int:
    tracemalloc.start()
    try:
        survives(reader, path)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def hostile_documents() -> dict[str, Any]:
    """Small files that ask for the world."""
    base = {"asset": {"version": "2.0"}, "nodes": [{"name": "a"}]}
    turn = {
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
        "samplers": [{"input": 0, "output": 1}],
    }
    many = 1 << 22
    empty = {"componentType": 5126, "count": many, "type": "VEC4"}
    times = {"componentType": 5126, "count": many, "type": "SCALAR"}
    mesh = {"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}] * 5000}]}
    chain = [{"name": "a", "children": [i + 1]} for i in range(20000)] + [{"name": "a"}]
    two = {"componentType": 5126, "count": 2, "type": "SCALAR", "bufferView": 0}
    key = {"componentType": 5126, "count": 2, "type": "VEC4", "bufferView": 1}
    views = [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteLength": 32, "byteOffset": 8}]
    return {
        "zeros": {**base, "animations": [turn] * 50, "accessors": [times, empty]},
        "many takes of six hours": {
            **base,
            "animations": [turn] * 2000,
            "accessors": [two, key],
            "bufferViews": views,
        },
        "morphs": {
            **base,
            "nodes": [{"mesh": 0}],
            "meshes": [mesh],
            "accessors": [{**empty, "type": "VEC3", "count": 1 << 18}],
        },
        "a long chain": {
            **base,
            "nodes": chain,
            "animations": [turn],
            "accessors": [two, key],
            "bufferViews": views,
        },
        "a joint named a million times": {**base, "skins": [{"joints": [0] * 1000000}]},
        "a mesh in a thousand nodes": {
            **base,
            "nodes": [{"mesh": 0}] * 1000,
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{**empty, "type": "VEC3", "count": 1 << 16}],
        },
    }


@pytest.mark.parametrize("name", hostile_documents())
def test_a_small_file_cannot_ask_for_the_world(tmp_path: Path, name: str) -> None:
    body = np.array([0, 21000, *[0, 0, 0, 1] * 2], "<f4").tobytes()
    document = hostile_documents()[name]
    document["buffers"] = [{"byteLength": len(body)}]
    path = tmp_path / "bomb.glb"
    path.write_bytes(packed(document, body))
    for reader in (read_gltf_clips, read_character):
        assert peak(reader, path) < MEMORY + 100 * path.stat().st_size


def test_takes_that_are_too_long_together_are_refused_before_any_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def made(*_: Any) -> None:
        raise AssertionError("a take was made")

    monkeypatch.setattr("metagraph.formats.gltf.clips._clips", made)
    body = np.array([0, 21000, *[0, 0, 0, 1] * 2], "<f4").tobytes()
    document = hostile_documents()["many takes of six hours"]
    document["buffers"] = [{"byteLength": len(body)}]
    path = tmp_path / "bomb.glb"
    path.write_bytes(packed(document, body))
    with pytest.raises(FileError, match="memory"):
        read_gltf_clips(path)


def test_deeply_nested_json_is_refused(tmp_path: Path) -> None:
    for inner in (b"[" * 100_000, b'{"a":' * 100_000):
        check(tmp_path, ".gltf", b'{"asset":{"version":"2.0"},"nodes":' + inner)
        check(tmp_path, ".gltf", b'{"asset":{"version":"2.0"},"nodes":[{"extras":' + inner)


# --- BVH: every word replaced by a hostile one

WORDS = (
    "",
    "{",
    "}",
    "-1",
    "0",
    "3",
    "99999999999",
    "1e999",
    "nan",
    "ROOT",
    "JOINT",
    "End",
    "OFFSET",
    "CHANNELS",
    "MOTION",
    "Xrotation",
    "\x00",
    "é",
)


@pytest.mark.nightly
def test_every_word_of_a_bvh_file_may_be_hostile(tmp_path: Path, seeds: dict[str, bytes]) -> None:
    words = seeds[".bvh"].decode().replace("\n", " \n ").split(" ")
    rng = random.Random(4)
    header = words.index("MOTION") + 8
    for i in [*range(header), *(rng.randrange(header, len(words)) for _ in range(40))]:
        mutant = list(words)
        mutant[i] = rng.choice(WORDS)
        check(tmp_path, ".bvh", " ".join(mutant).encode())


@pytest.mark.parametrize(
    "text",
    [
        "HIERARCHY\n"
        + "ROOT a { OFFSET 0 0 0 CHANNELS 1 Xrotation\n"
        + "JOINT b { OFFSET 0 0 0 CHANNELS 0\n" * 3000
        + "}" * 3001,
        "HIERARCHY\nROOT " + "a " * 100000,
        "HIERARCHY\nROOT a { OFFSET 0 0 0 CHANNELS 99999999999999999999 Xrotation }",
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\nFrames: "
        "99999999999999999999\nFrame Time: 1\n1\n",
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\nFrames: 1\nFrame Time: "
        "1e-300\n1\n",
        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 0\n}\nMOTION\nFrames: 1\nFrame Time: 1\n1\n",
    ],
)
def test_hostile_bvh_files(tmp_path: Path, text: str) -> None:
    for motion in ("", "\nMOTION\nFrames: 1\nFrame Time: 0.1\n1\n"):
        check(tmp_path, ".bvh", (text + motion).encode())
