"""Clips that were recorded all over the floor are brought to one spot."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.store import open_project, save_project
from metagraph.graph import anatomy
from metagraph.graph.clip_source import get_source_clip, with_source
from metagraph.graph.editing.retiming import keep_clips_in_place
from metagraph.graph.model import Project
from metagraph.motion.in_place import find_spot, measure_turn, stand_elsewhere
from metagraph.suggest.accept import accept
from metagraph.suggest.gather import AWAY, NEAR, NEARLY, TURNED, gather_clips
from metagraph.suggest.propose import propose
from tests.label_zoo.catalogue import named


@pytest.fixture(scope="module")
def strewn() -> Project:
    return named("strewn over the floor").project


def test_each_clip_begins_where_its_stance_stands_and_stances_stand_together(strewn: Project) -> None:
    project = accept(strewn, propose(strewn)).project
    graph, hips = project.graphs["body"], anatomy.project_roles(project)["hips"]

    def spot(action):  # type: ignore[no-untyped-def]
        motion = project.clips[action.clip].motion
        assert motion is not None
        return find_spot(motion, hips, project.span(action)[0])

    homes = {stance: spot(graph.of(stance, "stance")[0]) for stance in graph.stances}
    first = homes[graph.start or ""]
    assert len(graph.actions) > 8 and any(c.turned for c in project.clips.values())
    for action in graph.actions.values():
        near, turned, to = (
            (AWAY, TURNED, first) if action.kind == "stance" else (NEAR, NEARLY, homes[action.stance])
        )
        at = spot(action)
        assert np.linalg.norm(at[1] - to[1]) <= near + 0.01, action.name
        assert abs(measure_turn(at[0], to[0])) <= turned + 0.02, action.name


def test_clips_that_stand_together_and_those_not_asked_for_stay(strewn: Project, sample: Project) -> None:
    placed = accept(strewn, propose(strewn)).project
    assert gather_clips(placed, placed.clips) is placed
    assert gather_clips(sample, []) is sample
    assert gather_clips(sample, [c for c in sample.clips if "stance" in sample.clips[c].name]) is sample


def test_a_clip_that_stands_elsewhere_keeps_its_motion(strewn: Project) -> None:
    clip = next(c.motion for c in strewn.clips.values() if c.motion is not None)
    moved = stand_elsewhere(clip, 1.2, 0.5, -2.0)
    assert stand_elsewhere(clip, 0.0, 0.0, 0.0) is clip
    back = stand_elsewhere(stand_elsewhere(moved, 0.0, -0.5, 2.0), -1.2, 0.0, 0.0)
    first, again = (c.skeleton.globals(c.poses())[1] for c in (clip, back))
    assert np.abs(first - again).max() < 1e-4
    assert np.ptp(moved.skeleton.globals(moved.poses())[1][..., 1]) == pytest.approx(
        float(np.ptp(first[..., 1])), abs=1e-4
    )


def test_where_a_clip_stands_is_kept_in_the_project(sample: Project, tmp_path: Path) -> None:
    entry = next(iter(sample.clips.values()))
    source = get_source_clip(entry)
    assert source is not None
    moved = with_source(replace(entry, turned=0.5, moved_x=1.0, moved_z=-0.25), source)
    kept = keep_clips_in_place(replace(sample, clips={**sample.clips, entry.id: moved}), [entry.id])
    assert kept.clips[entry.id].turned == 0.5
    folder = Path(__file__).resolve().parents[2] / "sample_clips"
    project = open_project(folder / "sample.metagraph.yaml").project
    found = project.clips[entry.id]
    path = tmp_path / "moved.metagraph.yaml"
    inside = {
        i: replace(c, path=str(folder / c.path)) for i, c in {**project.clips, entry.id: replace(
            found, turned=0.5, moved_x=1.0, moved_z=-0.25
        )}.items()
    }  # fmt: skip
    save_project(replace(project, clips=inside), path)
    again = open_project(path).project.clips[entry.id]
    assert (again.turned, again.moved_x, again.moved_z) == (0.5, 1.0, -0.25)
    assert again.motion is not None and moved.motion is not None
    one, other = (c.skeleton.globals(c.pose_at(0.0))[1] for c in (again.motion, moved.motion))
    assert np.abs(one - other).max() < 1e-4
