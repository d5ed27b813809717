"""What a small file may cost: readers look at each of its bytes a fixed number of times, or refuse it."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pytest

from metagraph.common.budgets import JOINTS, JOINTS_DEEP
from metagraph.errors import FileError
from metagraph.formats import elan
from metagraph.formats.bvh.file import read_bvh
from metagraph.formats.elan import read_elan
from metagraph.formats.gltf.reader import read_gltf_clips
from metagraph.formats.transcripts.speaker_names import _BRACKETED
from metagraph.motion.roles import assign_body_parts, find_joint_sides, find_roles
from metagraph.motion.skeleton import Skeleton
from metagraph.speech.sympathies import _LAUGHED
from metagraph.speech.textgrid import read_textgrid


class Counted:
    """An XML parser that counts how often it is given something to read."""

    made: list[Counted]

    def __init__(self, parser: Any) -> None:
        object.__setattr__(self, "parser", parser)
        object.__setattr__(self, "given", 0)

    def __setattr__(self, name: str, value: Any) -> None:
        setattr(self.parser, name, value)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.parser, name)

    def Parse(self, data: bytes, last: bool) -> Any:
        object.__setattr__(self, "given", self.given + 1)
        return self.parser.Parse(data, last)


@pytest.mark.parametrize("begin", ["<ANNOTATION_DOCUMENT a='", "<ANNOTATION_DOCUMENT><!-- ", "<A"])
def test_what_never_ends_in_an_annotation_is_looked_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, begin: str
) -> None:
    """Given in pieces, an unfinished attribute is read again from its beginning with each of them."""
    made: list[Counted] = []
    create = elan.expat.ParserCreate

    def counted() -> Counted:
        made.append(Counted(create()))
        return made[-1]

    monkeypatch.setattr(elan.expat, "ParserCreate", counted)
    (tmp_path / "a.eaf").write_text(begin + "x" * 500_000)
    with pytest.raises(FileError, match="not well-formed"):
        read_elan(tmp_path / "a.eaf")
    assert [one.given for one in made] == [1]


def _bvh(depth: int) -> str:
    channels = "OFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
    joints = "".join(f"JOINT j{n}\n{{\n{channels}" for n in range(depth - 1))
    end = "End Site\n{\nOFFSET 0 0 0\n}\n" + "}\n" * depth
    return (
        f"HIERARCHY\nROOT a\n{{\n{channels}{joints}{end}MOTION\nFrames: 1\nFrame Time: 0.03\n"
        + "0 " * 3 * depth
    )


def test_a_bvh_file_whose_joints_hang_too_deep_is_refused_with_the_line(tmp_path: Path) -> None:
    (tmp_path / "fits.bvh").write_text(_bvh(JOINTS_DEEP - 1))
    assert len(read_bvh(tmp_path / "fits.bvh").skeleton) == JOINTS_DEEP - 1
    (tmp_path / "deep.bvh").write_text(_bvh(JOINTS_DEEP + 1))
    with pytest.raises(FileError, match=rf"line \d+: .*{JOINTS_DEEP} levels deep"):
        read_bvh(tmp_path / "deep.bvh")


def _gltf(depth: int) -> bytes:
    nodes: list[dict[str, Any]] = [{"name": f"n{n}", "translation": [0, 1, 0]} for n in range(depth)]
    for n in range(depth - 1):
        nodes[n]["children"] = [n + 1]
    data = np.array([0, 1, 0, 0, 0, 1, 0, 0, 0.6, 0.8], np.float32).tobytes()
    import base64

    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes,
        "skins": [{"joints": list(range(depth))}],
        "buffers": [{"uri": "data:;base64," + base64.b64encode(data).decode(), "byteLength": 40}],
        "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 32}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
            {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC4"},
        ],
        "animations": [{"samplers": [{"input": 0, "output": 1}],
                        "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}],
    }).encode()  # fmt: skip


def test_a_gltf_file_whose_joints_hang_too_deep_is_refused(tmp_path: Path) -> None:
    (tmp_path / "fits.gltf").write_bytes(_gltf(JOINTS_DEEP))
    assert len(read_gltf_clips(tmp_path / "fits.gltf")[0].skeleton) == JOINTS_DEEP
    (tmp_path / "deep.gltf").write_bytes(_gltf(JOINTS_DEEP + 1))
    with pytest.raises(FileError, match="joint hierarchy"):
        read_gltf_clips(tmp_path / "deep.gltf")


def _steps(work: Callable[[], object]) -> int:
    """Return how many lines of Python a piece of work runs: what it costs, on any machine."""
    count = [0]

    def see(frame: FrameType, event: str, value: object) -> Any:
        count[0] += event == "line"
        return see

    before = sys.gettrace()
    sys.settrace(see)
    try:
        work()
    finally:
        sys.settrace(before)
    return count[0]


def _chains(count: int, length: int) -> list[int]:
    """Return the parents of chains of joints that hang on one root."""
    out = [-1]
    for _ in range(count):
        for n in range(length):
            out.append(0 if n == 0 else len(out) - 1)
    return out


SHAPES = {
    "long chains": lambda size: _chains(size // 200, 200),
    "limbs of four": lambda size: _chains(size // 4, 4),
    "a fan": lambda size: _chains(size, 1),
    "limbs of forty": lambda size: _chains(size // 40, 40),
}


@pytest.mark.nightly
@pytest.mark.parametrize("shape", list(SHAPES))
@pytest.mark.parametrize("word", ["j", "left_hand", "hips", "head", "neck", "jaw"])
def test_what_joints_mean_is_found_in_steps_that_grow_with_their_number(shape: str, word: str) -> None:
    def cost(size: int) -> int:
        parents = SHAPES[shape](size)
        names = tuple(f"{word}{n}" for n in range(len(parents)))
        at = np.tile([0.0, -0.1, 0.01], (len(parents), 1))
        at[:, 0] = np.linspace(-1, 1, len(parents))
        turns = np.tile([0.0, 0, 0, 1], (len(parents), 1))
        skeleton = Skeleton(names, np.array(parents), turns, at)

        def work() -> None:
            roles = find_roles(skeleton)
            assign_body_parts(skeleton, roles)
            find_joint_sides(skeleton, roles)

        return _steps(work)

    small, large = cost(800), cost(1600)
    assert large < 3 * small + 50_000
    assert JOINTS >= 1600


def test_patterns_look_at_each_letter_a_few_times(tmp_path: Path) -> None:
    """Each of these took minutes, or longer than there is time: a test that does not end fails as well."""
    assert _LAUGHED.match("ha" + "hha" * 5_000 + "!x") is None
    assert _BRACKETED.match("[a]" + " " * 200_000) is None
    path = tmp_path / "a.TextGrid"
    path.write_text('File type = "ooTextFile"\nObject class = "TextGrid"\n' + "1" * 1_000_000 + "x\n")
    with pytest.raises(FileError):
        read_textgrid(path)


@pytest.mark.parametrize(
    "text", ["haha", "ha ha", "ha-ha", "Hahah!", "hehheh", "hah hah", "(jaja)", "www", "ha"]
)
def test_laughter_is_still_heard(text: str) -> None:
    assert _LAUGHED.match(text)


@pytest.mark.parametrize("text", ["hallo", "he", "aha", "hm", "haham", ""])
def test_other_words_are_no_laughter(text: str) -> None:
    assert not _LAUGHED.match(text)
