"""A character whose face is made of morph targets moves it, alone and in a performance."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.stage.filming import render_pictures
from app.stage.playback_source import play_clip_alone
from metagraph.formats.gltf.reader import read_character
from metagraph.formats.imports import import_files
from metagraph.graph import edits
from metagraph.graph.model import Project
from metagraph.playback.planner import make_plan
from preview.figure import SkinnedFigure, StickFigure
from tests.posing import compute_morphs_at


def test_a_figure_without_morphs_takes_no_weights(toy):
    assert StickFigure(toy.skeleton).morph_weights({"smile": 1.0}) is None


def test_a_clip_without_morphs_has_no_weights(sample):
    clip = next(iter(sample.clips.values())).motion
    assert clip.morphs_at(0.5) == {}


@pytest.mark.gl
def test_morphs_of_a_clip_and_of_a_plan_are_drawn(shared_data):
    file = shared_data / "robot-expressive" / "RobotExpressive.glb"
    project = import_files(Project(), None, [file]).into(Project())
    figure = SkinnedFigure(read_character(file), project.skeleton)
    assert figure.morphs
    # The file's own weights stay at zero; ours rise to 1 over the clip.
    entry = next(e for e in project.clips.values() if e.name == "Idle")
    weights = np.zeros_like(entry.motion.weights)
    weights[:, 0] = np.linspace(0, 1, len(weights))
    entry = replace(entry, motion=replace(entry.motion, weights=weights))
    project = replace(project, clips={**project.clips, entry.id: entry})
    frame = entry.frames // 2
    wanted = entry.motion.morphs_at(frame / entry.fps)
    assert figure.morph_weights(wanted).any()
    assert play_clip_alone(project, entry.id).clip == entry.id

    project = edits.add_stance(project, "head", "face", [entry.id])
    loop = project.graphs["head"].of(next(iter(project.graphs["head"].stances)), "stance")[0]
    assert compute_morphs_at(
        make_plan(project, 5.0), project, frame / entry.fps - project.span(loop)[0]
    ) == pytest.approx({name: min(1.0, max(0.0, value)) for name, value in wanted.items()}, abs=1e-3)
    times = np.array([frame / entry.fps])
    seen = [(figure, play_clip_alone(project, entry.id))]
    shown = next(iter(render_pictures(seen, times, (160, 160), "dark")))
    figure.morphs = ()
    still = next(iter(render_pictures(seen, times, (160, 160), "dark")))
    assert (shown != still).any(), "the face differs from the one without morphs"


def test_the_characters_own_morph_targets_are_known_when_it_is_opened(
    shared_data: Path, tmp_path: Path
) -> None:
    """A face is recognised from what the character has, not only from what clips move."""
    from app.project.opening import open_whole
    from metagraph.formats.gltf.reader import read_morph_targets
    from metagraph.formats.store import save_project
    from metagraph.graph.life import Face

    robot = shared_data / "robot-expressive"
    file = next(robot.rglob("*.glb"))
    assert read_morph_targets(file) == read_character(file).morphs != ()
    imported = import_files(Project(), tmp_path, [file])
    project = imported.into(Project())
    assert project.face.morphs == read_morph_targets(file)
    save_project(replace(project, face=Face()), tmp_path / "robot.metagraph.yaml")
    assert open_whole(tmp_path / "robot.metagraph.yaml").project.face.morphs == read_morph_targets(file)
