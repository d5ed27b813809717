"""Conformance vectors: the shipped ones hold for this library, cover every rule, and fail where a rule is
broken.
"""

from __future__ import annotations

import json
from collections import Counter
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from metagraph import engines
from metagraph.engines import reading, vectors
from metagraph.engines.export import export_project
from metagraph.engines.reading import read_export
from metagraph.errors import FileError
from metagraph.graph.model import Project
from metagraph.playback.life import evaluate, gaze, solve
from metagraph.playback.planner import make_plan
from metagraph.playback.planning import (
    choice,
    drawing,
    hashing,
    markov,
    replan,
    routes,
    sampling,
)
from metagraph.playback.posing import layers
from sample_clips.make import conformance
from sample_clips.make.conformance_projects import sparse
from tests.engines.mutants import PLAYED, folders_to_try
from tests.posing import pose_at

FOLDERS = sorted(path for path in Path(engines.__file__).with_name("conformance").iterdir() if path.is_dir())


@lru_cache
def read(folder: Path) -> dict[str, Any]:
    """Return a folder's vectors, which nobody changes."""
    out: dict[str, Any] = json.loads((folder / vectors.NAME).read_bytes())
    return out


@pytest.fixture(scope="module", params=PLAYED, ids=lambda path: path.name)
def shipped(request: Any) -> tuple[Path, Project, dict[str, Any]]:
    folder: Path = request.param
    return (
        folder,
        read_export(folder / f"{folder.name}.json", resolved=True),
        read(folder),
    )


def test_this_library_conforms_from_the_export_alone(shipped: Any) -> None:
    folder, project, data = shipped
    found = vectors.check_vectors(folder, project)
    assert not found.failures
    assert found.passed == len(data["cases"]) > 4


def test_the_shipped_vectors_are_those_the_maker_makes(tmp_path: Path) -> None:
    made = conformance.write_project_files(sparse(), tmp_path)
    path = vectors.write_vectors(made.json)
    folder = next(f for f in FOLDERS if f.name == "sparse")
    document = json.loads(made.json.read_bytes())
    assert document.pop("exporter").startswith("Metagraph ")  # the shipped ones outlast a version
    assert document == json.loads((folder / made.json.name).read_bytes())
    again, kept = json.loads(path.read_bytes()), read(folder)
    assert [c["name"] for c in again["cases"]] == [c["name"] for c in kept["cases"]]
    assert not vectors._unlike(
        [c["plan"] for c in again["cases"]], [c["plan"] for c in kept["cases"]], "plan"
    )


def test_all_shipped_vectors_together_meet_every_outcome_the_planner_has() -> None:
    told: Counter[str] = Counter()
    for folder in FOLDERS:
        for case in read(folder)["cases"]:
            told += Counter(report[1] for report in case["plan"]["reports"])
    planner = {
        "late",
        "cut",
        "resumed",
        "covered",
        "no-room",
        "no-candidate",
        "no-way",
        "no-stance",
        "past",
        "already-there",
        "cooling",
        "not-understood",
    }
    assert planner <= set(told)


def test_the_vectors_look_at_every_combination_of_layers_and_at_empty_ones() -> None:
    names = {case["name"] for f in FOLDERS for case in read(f)["cases"]}
    assert {
        f"layers {x}"
        for x in ("body", "arms", "head", "body arms", "body head", "arms head", "body arms head")
    } <= names
    sparse = next(f for f in FOLDERS if f.name == "sparse")
    assert json.loads((sparse / "sparse.json").read_bytes())["layers"]["head"]["stances"] == []


def test_characters_whose_times_are_exact_are_looked_at_on_boundaries_and_others_are_not() -> None:
    names = {f.name: [case["name"] for case in read(f)["cases"]] for f in FOLDERS}
    for folder in ("random1", "random2"):
        for about in (
            "body: waits as long as it may 4",  # the boundary itself, after four places beside it
            "arms: as short as may be left",
            "has cooled down",
            "held and left",
            "a gap just long enough",
            "heard at a moment that tells",
        ):
            assert any(about in name for name in names[folder]), (folder, about)
    assert not any("waits as long as it may" in name for name in names["stick"])


@pytest.mark.nightly
def test_an_export_plays_what_the_preview_plays(sample: Project, tmp_path: Path) -> None:
    back = read_export(export_project(sample, tmp_path).json, resolved=True)
    assert sample.skeleton is not None
    times = np.linspace(0.0, 40.0, 161)
    poses = [pose_at(make_plan(project, 40.0), project, times) for project in (sample, back)]
    (_, ours), (_, theirs) = (sample.skeleton.globals(pose) for pose in poses)
    # Thinned keys are off by as much in each joint of an arm.
    assert np.linalg.norm(ours - theirs, axis=-1).max() < 1.5 * vectors.METRES


# --- breaking one rule at a time


def _broken_keyed(seed: int, *words: str) -> int:
    return hashing.OFFSET ^ len("".join(words)) ^ seed


MUTATIONS: dict[str, tuple[Any, str, Any]] = {
    "the blend curve": (layers, "ease_blend", lambda x: np.clip(x, 0.0, 1.0)),
    "weights are played as they stand": (
        reading,
        "_weights",
        lambda layer, data: {part: data.weights[part] for part in data.own_weights},
    ),
    "models are played as they stand": (
        reading,
        "_markov",
        lambda layer, data: markov.DEFAULTS[layer],
    ),
    "parts that are not listed are not moved": (
        reading,
        "_weights",
        lambda layer, data: data.weights,
    ),
    "the hash of draws": (choice, "keyed", _broken_keyed),
    "the counter of uses": (drawing, "count_uses", lambda state, ident, now: 0.0),
    "never twice and spacing": (drawing, "keep_spaced", lambda state, candidates: candidates),
    "the loop's seam": (
        layers,
        "compute_loop_seconds",
        lambda p, a, t: (p.span(a)[0] + t * 0, p.span(a)[0] + t * 0, t * 0),
    ),
    "leading a clip in from its stance": (layers, "_lead", lambda shown, stance, edge, weight: shown),
    "crossfading a clip in from afar": (layers, "FADE_BEYOND", 0.0),
    "the cooldown": (sampling, "find_cooled", lambda state, action: float("-inf")),
    "the shortest chain": (routes, "find_hops", lambda state, goal: []),
    "how late a request may start": (replan, "delay", lambda asked, free, settings: (list(asked), [])),
    "lengths of the models": (markov, "length", lambda chain, state, key: 2.0),
    "a breath's shape": (evaluate, "compute_breath", lambda lane, life, time: 0.0),
    "a blink's shape": (evaluate, "compute_blink", lambda lane, life, time: 0.0),
    "how the head settles": (gaze, "settle_gaze", gaze.ease_gaze),
    "the head's share": (solve, "compute_head_part", lambda angle, share: share * angle),
    "what eyes can do": (solve, "limit_eye_turn", lambda left, up: (left, up)),
}


# A case that notices each, tried before all others.
HINTS = {
    "the blend curve": "sparse: arms: strokes that are planned on",
    "weights are played as they stand": "varied: nothing is asked",
    "models are played as they stand": "varied: the models alone",
    "parts that are not listed are not moved": "varied: the models alone",
    "the hash of draws": "quiet: the models alone",
    "the counter of uses": "standing: two minutes",
    "never twice and spacing": "standing: the models alone",
    "the loop's seam": "sparse: the arms begin in s6",
    "leading a clip in from its stance": "sparse: arms: strokes that are planned on",
    "crossfading a clip in from afar": "sparse: arms: strokes that are planned on",
    "the cooldown": "quiet: the models alone",
    "the shortest chain": "standing: body: to a stance and back",
    "how late a request may start": "sparse: arms: strokes that become known late",
    "lengths of the models": "quiet: the models alone",
    "a breath's shape": "slow: the models alone",
    "a blink's shape": "quiet: words that are said",
    "how the head settles": "quiet: a thing that moves",
    "the head's share": "quiet: a thing that moves",
    "what eyes can do": "quiet: the models alone",
}


@pytest.mark.parametrize("rule", MUTATIONS)
def test_breaking_a_rule_fails_some_vector(rule: str, single: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    module, name, broken = MUTATIONS[rule]
    monkeypatch.setattr(module, name, broken)
    if rule == "how late a request may start":
        monkeypatch.setattr("metagraph.playback.planning.layer_planning.delay", broken)
    for folder in folders_to_try(HINTS[rule], FOLDERS, single):
        project = read_export(folder / read(folder)["export"], resolved=True)
        if any(vectors.find_case_differences(project, case) for case in read(folder)["cases"]):
            return
    pytest.fail("no vector noticed")


# --- files


def test_vectors_that_are_missing_broken_or_newer_are_told(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be read"):
        vectors.check_vectors(tmp_path)
    (tmp_path / vectors.NAME).write_text("{")
    with pytest.raises(FileError, match="not JSON"):
        vectors.check_vectors(tmp_path)
    (tmp_path / vectors.NAME).write_text('{"vectors": 99}')
    with pytest.raises(FileError, match="version 99"):
        vectors.check_vectors(tmp_path)


def test_vectors_of_another_performance_are_told_apart(shipped: Any) -> None:
    folder, project, data = shipped
    case = json.loads(
        json.dumps(
            next((c for c in data["cases"] if any(of["cues"] for of in c["plan"]["layers"].values())), None)
        )
    )
    if case is None:
        assert folder.name in ("calm", "quiet", "slow", "steady"), "nobody moves where nothing is asked"
        return
    layer = next(of for of in case["plan"]["layers"].values() if of["cues"])
    layer["cues"][0]["start"] += 0.01
    assert any("start" in words for words in vectors.find_case_differences(project, case))
