"""The library as a runtime: ten lines play an export, without Qt, and nothing that is asked can break the
loop.
"""

from __future__ import annotations

import json
import math
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import metagraph
from metagraph import Character
from metagraph.engines.reading import read_export
from metagraph.errors import FileError
from metagraph.graph.model import Project
from metagraph.graph.requests import Gesture
from metagraph.playback.plan import Plan
from metagraph.playback.planning.extend_performance import hear_asks
from tests.posing import pose_at

STICK = Path(metagraph.__file__).parent / "engines" / "conformance" / "stick" / "stick.json"
README = Path(metagraph.__file__).parent / "engines" / "runtimes" / "python" / "README.md"


@pytest.fixture(scope="module")
def stick() -> Project:
    return read_export(STICK, resolved=True)


def test_a_request_is_played_answered_and_told(stick: Project) -> None:
    character = Character(stick, idle=False)
    ident = character.ask({"do": "gesture", "layer": "arms", "tags": ["greeting"], "after": 0.5})
    assert character.answer(ident).state == "planned"
    told = []
    for frame in range(300):
        character.update(frame / 60)
        told += [(e.kind, e.action, e.meta) for e in character.events()]
    assert told == [("begin", "wave", ident), ("end", "wave", ident)]
    assert character.answer(ident).at == pytest.approx(0.5)


@pytest.mark.nightly
def test_it_plays_what_a_plan_of_the_same_steps_plays(stick: Project) -> None:
    character = Character(stick, seed=5)
    plan = hear_asks(stick, Plan(5, 0.0), 0.0, [], 20.0, {}, True)
    for frame in range(1, 200):
        now = frame * 0.4
        if frame == 20:
            character.ask(Gesture(id="g", layer="head"))
        pose = character.update(now)
        asks = [Gesture(id="g", layer="head")] if frame == 20 else []
        end = plan.end if plan.end >= now + 18 else now + 20
        if asks or end > plan.end:
            plan = hear_asks(stick, plan, now, asks, end, {}, True)
        assert np.allclose(pose.rotations, pose_at(plan, stick, now).rotations, atol=1e-6)


@pytest.mark.nightly
def test_an_hour_keeps_a_short_past(stick: Project) -> None:
    character = Character(stick)
    for second in range(0, 3600, 5):
        character.update(float(second))
    assert sum(len(of.cues) for of in character.plan.layers.values()) < 120
    assert character.plan.end > 3590


def test_time_does_not_run_backwards(stick: Project) -> None:
    character = Character(stick)
    character.update(3.0)
    character.update(1.0)
    assert character.now == 3.0


def test_a_leap_is_an_hour_at_most_and_what_is_no_time_is_ignored(stick: Project) -> None:
    character = Character(stick)
    character.update(1e9)
    assert character.now == 3600.0
    for odd in (math.nan, math.inf, -math.inf, "7200", None, True, 10**400):
        character.update(odd)
    assert character.now == 3600.0
    character.update(np.float32(3601.5))
    assert character.now == 3601.5


@pytest.mark.parametrize(
    "odd",
    [
        None,
        3,
        "nod",
        [],
        {"do": "nod", "after": 10**400},
        {"do": "nod", "after": True},
        {"do": "nod", "at": 10**400},
    ],
)
def test_what_is_no_request_is_refused(stick: Project, odd: Any) -> None:
    character = Character(stick)
    ident = character.ask(odd)
    character.update(1.0)
    assert ident == "#1"
    assert character.answer(ident).state == "refused"


def test_a_fault_of_the_planner_does_not_stop_the_game(
    stick: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    character = Character(stick)
    plan = character.plan
    with monkeypatch.context() as broken:
        broken.setattr("metagraph.playback.planning.running_plan.hear_asks", lambda *_: 1 // 0)
        ident = character.ask({"do": "nod"})
        character.update(1.0)
        assert character.answer(ident).state == "refused"
        assert "failed" in character.answer(ident).why
        assert character.plan is plan
    again = character.ask({"do": "nod", "id": ident})
    character.update(1.1)
    assert character.answer(again).state in ("planned", "late")


def test_a_thousand_answers_are_remembered(stick: Project) -> None:
    character = Character(stick)
    idents = [character.ask({"do": "dance"}) for _ in range(1001)]
    assert "known" in character.answer(idents[1]).why
    assert "nothing was asked for" in character.answer(idents[0]).why


@pytest.mark.nightly
def test_a_look_that_another_replaced_was_played_and_is_forgotten(stick: Project) -> None:
    character = Character(stick)
    idents = []
    for second in range(200):
        idents.append(character.ask({"do": "look", "to": "door" if second % 2 else "ahead"}))
        character.update(float(second))
    assert {character.answer(ident).state for ident in idents[:150]} == {"done"}
    assert len(character.plan.track.looks) < 60


anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda x: st.lists(x, max_size=3) | st.dictionaries(st.text(max_size=4), x, max_size=3),
)
fields = st.sampled_from(
    [
        "do",
        "id",
        "at",
        "after",
        "layer",
        "tags",
        "limb",
        "stance",
        "action",
        "to",
        "duration",
        "stroke",
        "hold",
        "line",
        "text",
        "mode",
        "what",
        "bml",
        "priority",
    ]
)
words = st.sampled_from(
    [
        "gesture",
        "fidget",
        "action",
        "stance",
        "change",
        "nod",
        "look",
        "blink",
        "say",
        "mode",
        "place",
        "withdraw",
        "bml",
    ]
)


@pytest.mark.nightly
@given(st.lists(st.dictionaries(fields, anything | words, max_size=5).map(lambda d: d), max_size=4))
@settings(max_examples=80, deadline=None)
def test_nothing_that_is_asked_raises(requests: list[dict[str, Any]]) -> None:
    character = Character(read_export(STICK, motions=False, resolved=True))
    idents = [character.ask(request) for request in requests]
    character.update(0.5)
    for ident in idents:
        assert character.answer(ident).state in ("planned", "late", "refused", "done")


def test_a_newer_version_a_cut_glb_and_a_missing_file_are_told(tmp_path: Path) -> None:
    data = json.loads(STICK.read_bytes())
    glb = STICK.with_suffix(".glb").read_bytes()
    path = tmp_path / "stick.json"
    (tmp_path / "stick.glb").write_bytes(glb)
    path.write_text(json.dumps({**data, "metagraph": 2}))
    with pytest.raises(FileError, match=r"Update Metagraph"):
        Character(path)
    path.write_text(json.dumps(data))
    (tmp_path / "stick.glb").write_bytes(glb[: len(glb) // 2])
    with pytest.raises(FileError, match=r"stick\.glb"):
        Character(path)
    with pytest.raises(FileError, match="cannot be read"):
        Character(tmp_path / "nothing.json")


@pytest.mark.nightly
def test_the_readme_is_true(sample_export: Path, tmp_path: Path) -> None:
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(), re.S)
    shutil.copytree(sample_export, tmp_path / "game")
    hidden = (
        "import sys\nfor name in ('PySide6', 'moderngl', 'pyqtgraph', 'trimesh', 'numba', 'av'): "
        "sys.modules[name] = None\n"
    )
    shown = []
    for block in blocks:
        done = subprocess.run(
            [sys.executable, "-c", hidden + block], cwd=tmp_path, capture_output=True, text=True, timeout=120
        )
        assert done.returncode == 0, done.stderr
        shown.append(done.stdout)
    assert shown[0].startswith("planned") and shown[1] == "[]\n"
    assert 2.9 < float(shown[2]) < 3.2, "the line lasts as long as what was added to it"
