"""Files that are packed: half as large, as near as they say, and refused with a place where damaged."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.errors import FileError
from metagraph.formats.gltf.reader import read_character, read_gltf_clips
from metagraph.formats.gltf.writer import write_glb
from metagraph.graph.model import Project

ROOT = Path(__file__).resolve().parents[3]
BODY = ROOT / "sample_clips" / "ada.glb"


def parts(path: Path) -> tuple[dict[str, Any], bytes]:
    data = path.read_bytes()
    (size,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def rewritten(path: Path, document: dict[str, Any], binary: bytes) -> Path:
    head = json.dumps(document).encode()
    head += b" " * (-len(head) % 4)
    whole = struct.pack("<4sIIII", b"glTF", 2, 28 + len(head) + len(binary), len(head), 0x4E4F534A) + head
    path.write_bytes(whole + struct.pack("<II", len(binary), 0x004E4942) + binary)
    return path


@pytest.fixture(scope="module")
def files(sample: Project, tmp_path_factory: pytest.TempPathFactory) -> dict[bool, Path]:
    """The same clips and character, as they are and packed."""
    folder = tmp_path_factory.mktemp("packed")
    body = read_character(BODY)
    clips = [e.motion for e in sample.clips.values() if e.motion is not None][:20]
    for compress in (False, True):
        write_glb(folder / f"{compress}.glb", clips, body, compress=compress)
    return {compress: folder / f"{compress}.glb" for compress in (False, True)}


def test_clips_come_back_as_near_as_said(files: dict[bool, Path]) -> None:
    plain, packed = (read_gltf_clips(files[compress]) for compress in (False, True))
    assert [clip.name for clip in packed] == [clip.name for clip in plain]
    for one, other in zip(plain, packed, strict=True):
        assert (one.frames, one.fps) == (other.frames, other.fps)
        a, b = one.rotations.astype(float), other.rotations.astype(float)
        apart = np.minimum(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
        assert np.degrees(2 * apart).max() < 0.012
        assert np.abs(one.translations - other.translations).max() < 1.6e-5


def test_a_character_comes_back_as_near_as_said(files: dict[bool, Path]) -> None:
    plain, packed = (read_character(files[compress]) for compress in (False, True))
    assert (np.asarray(plain.triangles) == packed.triangles).all()
    assert (np.asarray(plain.joints) == packed.joints).all()
    assert np.abs(plain.positions - packed.positions).max() < 1.6e-5
    assert np.abs(plain.uvs - packed.uvs).max() < 3.1e-5
    assert np.abs(plain.weights - packed.weights).max() < 3e-5
    assert np.abs(np.asarray(packed.weights).sum(1) - 1).max() < 1e-6
    assert (np.asarray(plain.normals) * packed.normals).sum(1).min() > 0.98
    assert plain.morph_positions is not None and packed.morph_positions is not None
    for one, other in zip(plain.morph_positions, packed.morph_positions, strict=True):
        assert np.abs(np.asarray(one) - other).max() < 4e-6


def test_it_is_smaller_and_says_what_whoever_reads_it_must_know(files: dict[bool, Path]) -> None:
    sizes = {compress: path.stat().st_size for compress, path in files.items()}
    assert sizes[True] < 0.6 * sizes[False]
    document, _ = parts(files[True])
    assert document["extensionsRequired"] == ["EXT_meshopt_compression", "KHR_mesh_quantization"]
    assert document["extensionsRequired"] == document["extensionsUsed"]
    binary, nowhere = document["buffers"]
    assert nowhere["extensions"]["EXT_meshopt_compression"] == {"fallback": True}
    for view in document["bufferViews"]:
        packed = view.get("extensions", {}).get("EXT_meshopt_compression")
        if packed is None:
            assert view["buffer"] == 0
            continue
        assert view["buffer"] == 1 and packed["buffer"] == 0
        assert view["byteOffset"] + view["byteLength"] <= nowhere["byteLength"]
        assert packed["byteOffset"] + packed["byteLength"] <= binary["byteLength"]
        assert packed["count"] * packed["byteStride"] == view["byteLength"]
        assert view.get("byteStride", packed["byteStride"]) == packed["byteStride"]
    assert "extensionsRequired" not in parts(files[False])[0]


def test_keys_of_a_kind_share_a_view_and_channels_alike_a_sampler(files: dict[bool, Path]) -> None:
    for path in files.values():
        document, _ = parts(path)
        sparse = sum("sparse" in accessor for accessor in document["accessors"])  # which have their own two
        assert len(document["bufferViews"]) - 2 * sparse < 30 < len(document["animations"]) * 10
        kinds: dict[int, set[str]] = {}
        for animation in document["animations"]:
            pairs = [(s["input"], s["output"]) for s in animation["samplers"]]
            assert len(set(pairs)) == len(pairs)
            for channel in animation["channels"]:
                output = animation["samplers"][channel["sampler"]]["output"]
                view = document["accessors"][output]["bufferView"]
                kinds.setdefault(view, set()).add(channel["target"]["path"])
        assert all(len(paths) == 1 for paths in kinds.values())


def test_only_a_packed_file_leaves_out_joints_that_stay_as_their_nodes_are(files: dict[bool, Path]) -> None:
    channels = {c: [len(a["channels"]) for a in parts(path)[0]["animations"]] for c, path in files.items()}
    assert sum(channels[True]) < sum(channels[False])
    assert min(channels[True]) > 0


def test_two_writings_are_the_same(files: dict[bool, Path], tmp_path: Path) -> None:
    clips = read_gltf_clips(files[True])
    for name in ("a.glb", "b.glb"):
        write_glb(tmp_path / name, clips, compress=True)
    assert (tmp_path / "a.glb").read_bytes() == (tmp_path / "b.glb").read_bytes()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"count": 1}, "of"),
        ({"byteLength": 40}, "short"),
        ({"byteOffset": 1 << 30}, "packed up to byte"),
        ({"filter": "WAVELET"}, "WAVELET"),
        ({"byteStride": 6}, "of"),
        ({"mode": "TRIANGLES"}, "indices"),
        ({"mode": "CUBES"}, "CUBES"),
        ({"buffer": 7}, "buffer 7"),
        ({"count": 1 << 40}, "of"),
    ],
)
def test_a_damaged_view_is_refused(
    files: dict[bool, Path], tmp_path: Path, change: dict[str, Any], words: str
) -> None:
    document, binary = parts(files[True])
    view = document["accessors"][document["animations"][0]["samplers"][0]["output"]]["bufferView"]
    document["bufferViews"][view]["extensions"]["EXT_meshopt_compression"] |= change
    with pytest.raises(FileError) as caught:
        read_gltf_clips(rewritten(tmp_path / "damaged.glb", document, binary))
    assert words in str(caught.value) and caught.value.where


def test_little_data_cannot_ask_for_much_room(files: dict[bool, Path], tmp_path: Path) -> None:
    document, binary = parts(files[True])
    view = document["accessors"][document["animations"][0]["samplers"][0]["output"]]["bufferView"]
    count = 1 << 29
    document["bufferViews"][view]["byteLength"] = 8 * count
    document["bufferViews"][view]["extensions"]["EXT_meshopt_compression"]["count"] = count
    with pytest.raises(FileError):
        read_gltf_clips(rewritten(tmp_path / "bomb.glb", document, binary))
