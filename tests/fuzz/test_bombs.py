"""Small files that ask for the world: each is refused, or read in little memory, before anything is made of
what it says.
"""

from __future__ import annotations

import json
import struct
import tracemalloc
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph.common import budgets
from metagraph.common.pictures import read_picture_size
from metagraph.errors import FileError
from metagraph.formats.clips import read_clips
from metagraph.formats.elan import read_elan
from metagraph.formats.gltf.reader import read_character, read_gltf_clips, read_vrm_roles
from metagraph.formats.imports import import_files
from metagraph.formats.keypoints.reader import read_keypoints
from metagraph.graph.model import Project
from metagraph.speech.lines import make_voice_from_phones, read_line_voice
from tests.fuzz.spoiling import packed
from tests.wavs import wav

MEMORY = 300 << 20  # bytes that a file of kilobytes may cost


def refused(read: Callable[[Path], object], path: Path) -> FileError:
    tracemalloc.start()
    try:
        with pytest.raises(FileError) as caught:
            read(path)
        assert tracemalloc.get_traced_memory()[1] < MEMORY
    finally:
        tracemalloc.stop()
    assert caught.value.cause and caught.value.remedy
    return caught.value


def frugal(read: Callable[[Path], object], path: Path) -> None:
    tracemalloc.start()
    try:
        read(path)
        assert tracemalloc.get_traced_memory()[1] < MEMORY
    finally:
        tracemalloc.stop()


# --- speech


def grid(end: float, intervals: list[tuple[float, float]]) -> str:
    rows = "".join(f'{a}\n{b}\n"hello"\n' for a, b in intervals)
    return f'"ooTextFile"\n"TextGrid"\n0\n{end}\n<exists>\n1\n"IntervalTier"\n"words"\n0\n{end}\n{len(intervals)}\n{rows}'


@pytest.mark.parametrize("end", [1e5, 9_999_999])
def test_a_textgrid_of_a_day_is_no_line(tmp_path: Path, end: float) -> None:
    (tmp_path / "a.TextGrid").write_text(grid(end, [(0, end)]))
    assert "1800 s" in refused(make_voice_from_phones, tmp_path / "a.TextGrid").cause


@pytest.mark.nightly
def test_intervals_over_each_other_cost_no_more_than_in_turn(tmp_path: Path) -> None:
    """Kept apart, 800 sounds of 425 s would be 17 million shapes at 50 a second, of 32 bytes and more each."""
    (tmp_path / "a.TextGrid").write_text(grid(425, [(n * 1e-3, 425) for n in range(800)]))
    frugal(make_voice_from_phones, tmp_path / "a.TextGrid")


@pytest.mark.parametrize("rate", [400_000_000, 2_000_000_000, budgets.SOUND_RATES[1] + 1])
def test_a_sound_claims_no_rate_that_no_recorder_has(tmp_path: Path, rate: int) -> None:
    assert "sample rate" in refused(read_line_voice, wav(tmp_path / "a.wav", rate, bytes(4096))).cause


def test_a_sound_has_no_thousand_channels(tmp_path: Path) -> None:
    assert "channels" in refused(read_line_voice, wav(tmp_path / "a.wav", 48000, bytes(64000), 1000)).cause


def test_the_fastest_recorder_and_most_channels_are_still_read(tmp_path: Path) -> None:
    noise = np.random.default_rng(1).integers(-9000, 9000, 768_000 // 4, np.int16).tobytes()
    frugal(read_line_voice, wav(tmp_path / "a.wav", 768_000, noise))
    frugal(read_line_voice, wav(tmp_path / "b.wav", 16_000, noise, 64))


@pytest.mark.parametrize("value", [3e38, -1e30])
def test_samples_beyond_all_sense_are_refused_without_a_warning(tmp_path: Path, value: float) -> None:
    refused(
        read_line_voice,
        wav(tmp_path / "a.wav", 16000, np.full(4000, value, "<f4").tobytes(), kind=3, bits=32),
    )


def test_whole_numbers_written_as_floats_are_still_heard(tmp_path: Path) -> None:
    sound = (20000 * np.sin(np.arange(8000) * 0.1)).astype("<f4").tobytes()
    read_line_voice(wav(tmp_path / "a.wav", 16000, sound, kind=3, bits=32))


# --- motion

HEAD = "HIERARCHY\nROOT a\n{\nOFFSET 0 1 0\nCHANNELS 1 Xrotation\n"
END = "}\nMOTION\n"


@pytest.mark.parametrize(
    ("frames", "step"),
    [("2", "1e-9"), ("2", "1e-5"), ("2", "1e4"), ("1000000000", "0.03"), ("9" * 5000, "0.03")],
)
def test_a_bvh_s_claims_are_not_believed(tmp_path: Path, frames: str, step: str) -> None:
    (tmp_path / "a.bvh").write_text(f"{HEAD}{END}Frames: {frames}\nFrame Time: {step}\n0\n1\n")
    refused(read_clips, tmp_path / "a.bvh")


@pytest.mark.nightly
def test_joints_that_cost_a_file_nothing_are_paid_for(tmp_path: Path) -> None:
    still = "".join(f"JOINT j{n}\n{{\nOFFSET 0 1 0\nCHANNELS 0\n}}\n" for n in range(4000))
    (tmp_path / "a.bvh").write_text(f"{HEAD}{still}{END}Frames: 50000\nFrame Time: 0.03\n" + "0\n" * 50000)
    assert budgets.OUT_OF_PROPORTION in refused(read_clips, tmp_path / "a.bvh").cause


def test_a_number_of_channels_of_five_thousand_digits_is_none(tmp_path: Path) -> None:
    text = HEAD.replace("CHANNELS 1", f"CHANNELS {'1' * 5000}")
    (tmp_path / "a.bvh").write_text(f"{text}{END}Frames: 1\nFrame Time: 0.03\n0\n")
    refused(read_clips, tmp_path / "a.bvh")


def glb(path: Path, document: dict[str, Any], body: bytes) -> Path:
    document = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(body)}], **document}
    path.write_bytes(packed(document, body))
    return path


def skinned(inverse: list[float], **more: Any) -> tuple[dict[str, Any], bytes]:
    body = np.array([*inverse, 0, 1, 0, 0, 0, 1, 1, 0, 0, 0], "<f4").tobytes()
    return {
        "nodes": [{"name": "a"}],
        "skins": [{"joints": [0], "inverseBindMatrices": 0}],
        "bufferViews": [{"buffer": 0, "byteLength": 64}, {"buffer": 0, "byteOffset": 64, "byteLength": 8}, {"buffer": 0, "byteOffset": 72, "byteLength": 32}],
        "accessors": [
            {"componentType": 5126, "count": 1, "type": "MAT4", "bufferView": 0},
            {"componentType": 5126, "count": 2, "type": "SCALAR", "bufferView": 1},
            {"componentType": 5126, "count": 2, "type": "VEC4", "bufferView": 2},
        ],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}], "samplers": [{"input": 1, "output": 2}]}],
        **more,
    }, body  # fmt: skip


IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


@pytest.mark.parametrize("at", [(15,), (0,), (0, 5, 10), tuple(range(16))])
def test_a_bind_matrix_that_cannot_be_undone_is_passed_over(tmp_path: Path, at: tuple[int, ...]) -> None:
    inverse = [0.0 if n in at else float(x) for n, x in enumerate(IDENTITY)]
    path = glb(tmp_path / "a.glb", *skinned(inverse))
    assert read_gltf_clips(path)[0].frames > 1
    read = import_files(Project(), tmp_path, [path, glb(tmp_path / "b.glb", *skinned(IDENTITY))])
    assert len(read.loaded) == 2 and not read.failures


@pytest.mark.parametrize("bone", [[], {}, 7, None, ["hips"]])
def test_a_vrm_bone_may_be_anything(tmp_path: Path, bone: object) -> None:
    humanoid = {"humanBones": [{"bone": bone, "node": 0}, {"bone": "hips", "node": 0}, 3]}
    path = glb(tmp_path / "a.vrm", *skinned(IDENTITY, extensions={"VRM": {"humanoid": humanoid}}))
    assert [*read_vrm_roles(path)] == ["hips"]


def test_one_channel_may_not_move_a_node_ten_thousand_times(tmp_path: Path) -> None:
    document, body = skinned(IDENTITY)
    times = np.array([0, 20_000], "<f4").tobytes()
    one = document["animations"][0]["channels"]
    document["animations"][0]["channels"] = one * 10_000
    refused(read_gltf_clips, glb(tmp_path / "a.glb", document, body[:64] + times + body[72:]))


@pytest.mark.parametrize("what", ["targets", "nodes", "primitives"])
def test_vertices_named_again_and_again_are_paid_for_again(tmp_path: Path, what: str) -> None:
    count = 20_000
    body = np.random.default_rng(1).random((count, 3)).astype("<f4").tobytes()
    primitive: dict[str, Any] = {"attributes": {"POSITION": 0}}
    many = 3000
    if what == "targets":
        primitive["targets"] = [{"POSITION": 0}] * many
    document = {
        "nodes": [{"mesh": 0}] * (many if what == "nodes" else 1),
        "meshes": [{"primitives": [primitive] * (many if what == "primitives" else 1)}],
        "accessors": [{"componentType": 5126, "count": count, "type": "VEC3", "bufferView": 0}],
        "bufferViews": [{"buffer": 0, "byteLength": len(body)}],
    }
    assert budgets.OUT_OF_PROPORTION in refused(read_character, glb(tmp_path / "a.glb", document, body)).cause


def test_one_file_beside_another_is_read_once(tmp_path: Path) -> None:
    (tmp_path / "b.bin").write_bytes(bytes(4 << 20))
    document, _ = skinned(IDENTITY)
    document["buffers"] = [{"byteLength": 104, "uri": "b.bin"}] * 200
    document["bufferViews"] = [
        {**view, "buffer": 199 - n} for n, view in enumerate(document["bufferViews"])
    ] * 60
    (tmp_path / "a.gltf").write_text(json.dumps({"asset": {"version": "2.0"}, **document}))
    frugal(read_clips, tmp_path / "a.gltf")


# --- pictures and text


def png(width: int, height: int) -> bytes:
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = zlib.compress(bytes((width // 8 + 1) * height))
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 1, 0, 0, 0, 0))
        + chunk(b"IDAT", rows)
        + chunk(b"IEND", b"")
    )


def test_a_texture_of_kilobytes_is_not_unpacked_to_gigabytes(tmp_path: Path) -> None:
    from preview.gpu import decode_texture

    data = png(30_000, 30_000)
    assert read_picture_size(data) == (30_000, 30_000) and len(data) < 1 << 20
    tracemalloc.start()
    assert decode_texture(data)[0] == (1, 1)
    assert tracemalloc.get_traced_memory()[1] < 8 << 20
    tracemalloc.stop()
    assert decode_texture(png(64, 32))[0] == (64, 32)


@pytest.mark.parametrize("late", [1e18, 1e9, 40_000])
def test_keypoints_do_not_lie_years_apart(tmp_path: Path, late: float) -> None:
    frames = [{"t": t, "keypoints": [[1, 2, 1]] * 17} for t in (0, 0.1, 0.2, late)]
    (tmp_path / "k.json").write_text(json.dumps(frames))
    assert "apart" in refused(read_keypoints, tmp_path / "k.json").cause


@pytest.mark.nightly
@pytest.mark.parametrize("backwards", [False, True])
def test_long_chains_of_annotations_are_read_in_their_length_and_not_its_square(
    tmp_path: Path, backwards: bool
) -> None:
    count = 20_000
    slots = "".join(
        f'<TIME_SLOT TIME_SLOT_ID="t{n}"' + (f' TIME_VALUE="{n}"' if n in (0, count) else "") + "/>"
        for n in range(count + 1)
    )
    chain = [
        f'<ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a{n}" TIME_SLOT_REF1="t{n}" TIME_SLOT_REF2="t{n + 1}"><ANNOTATION_VALUE>x</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>'
        for n in range(count)
    ]
    order = range(1, count)
    refs = [
        f'<TIER TIER_ID="r{n}"><ANNOTATION><REF_ANNOTATION ANNOTATION_ID="b{n}" ANNOTATION_REF="{f"b{n - 1}" if n > 1 else "a0"}"><ANNOTATION_VALUE>y</ANNOTATION_VALUE></REF_ANNOTATION></ANNOTATION></TIER>'
        for n in (reversed(order) if backwards else order)
    ]
    (tmp_path / "a.eaf").write_text(
        f'<ANNOTATION_DOCUMENT><TIME_ORDER>{slots}</TIME_ORDER><TIER TIER_ID="x">{"".join(chain)}</TIER>{"".join(refs)}</ANNOTATION_DOCUMENT>'
    )
    found = read_elan(tmp_path / "a.eaf")
    assert len(found.tiers) == count and len(found.tiers[0].intervals) == count


@pytest.mark.parametrize("inner", ["[" * 200_000, '{"a":' * 200_000])
def test_depth_is_refused_by_every_reader_of_json(tmp_path: Path, inner: str) -> None:
    from app.project.pattern_files import read_patterns
    from metagraph.engines.reading import read_export
    from metagraph.formats.transcripts.reader import read_transcript

    (tmp_path / "a.json").write_text(inner)
    for read in (read_transcript, read_keypoints, read_export, read_patterns):
        refused(read, tmp_path / "a.json")
