"""Stances of characters made by others are distinguished, each on its own skeleton, under jitter."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.clips import read_clips
from metagraph.graph import edits
from metagraph.graph.model import Layer, Life, Project
from metagraph.mimicry.keypoint_layouts import PLACE
from metagraph.mimicry.mimic import Mimic
from metagraph.mimicry.pose_measures import turn_about_y
from metagraph.mimicry.signatures import BodySignature
from tests import zoo

HEADS = ("head_neutral", "head_l", "head_r", "head_u", "head_d")
ARMS = ("Idle", "Unarmed_Idle", "2H_Melee_Idle", "Blocking", "Sit_Chair_Idle")


def project_of(path: Path, names: tuple[str, ...], layer: Layer) -> Project:
    """A project whose stances are clips of a file, the first its base pose and start."""
    clips = {clip.name: clip for clip in read_clips(path)}
    project = edits.add_clips(
        Project("real", life=Life(on=False)), [(f"{n}.glb", 0, "", clips[n]) for n in names]
    )
    ids = {entry.name: entry.id for entry in project.clips.values()}
    for name in names:
        project = edits.add_stance(project, layer, name, [ids[name]])
    return edits.set_base(project, ids[names[0]])


def poses_of(name: str, path: Path, frames: dict[str, int]) -> Project:
    """A project whose stances are single moments of a clip of the zoo, held."""
    clip = read_clips(path)[0]
    project = Project(name, life=Life(on=False))
    moments = {n: round(at * clip.fps / 30) for n, at in frames.items()}
    held = [
        (
            f"{n}.glb",
            0,
            "",
            replace(
                clip,
                name=n,
                rotations=clip.rotations[[f, f]],
                translations=clip.translations[[f, f]],
                weights=None,
            ),
        )
        for n, f in moments.items()
    ]
    project = edits.add_clips(project, held)
    ids = {entry.name: entry.id for entry in project.clips.values()}
    for n in frames:
        project = edits.add_stance(project, "arms", n, [ids[n]])
    return edits.set_base(project, next(iter(ids.values())))


@pytest.mark.parametrize("name", zoo.ANIMALS)
def test_arms_of_the_zoo_held_high_low_and_between(zoo_files: dict[str, Path], name: str) -> None:
    frames = {"between": 0, "high": 15, "low": 45}
    project = poses_of(name, zoo_files[name], frames)
    for turn in (0.0, 0.5):
        assert seen(project, "arms", 3, turn) == {n: n for n in frames}


def seen(project: Project, layer: Layer, dims: int, turn: float = 0.0) -> dict[str, str | None]:
    """Stance -> the stance that is seen of somebody who plays its loop for 3 s, jittering by a hundredth of
    the torso's length.
    """
    body, rng, out = BodySignature(project), np.random.default_rng(3), {}
    for stance in project.graphs[layer].stances.values():
        clip = next(e.motion for e in project.clips.values() if e.name == stance.name)
        assert clip is not None
        mimic = Mimic(project, mirror=False)
        times = np.arange(75) / 25
        points = body.points(clip.pose_at(np.mod(times, max(clip.duration, 0.01))))
        shoulders, hips = (
            points[0, [PLACE[f"left_{n}"], PLACE[f"right_{n}"]]].mean(0) for n in ("shoulder", "hip")
        )
        points = turn_about_y(points, turn) + rng.normal(size=points.shape) * 0.01 * np.linalg.norm(
            shoulders - hips
        )
        for time, where in zip(times, points, strict=True):
            mimic.feed(float(time), where[:, :dims], body.confidence)
        found = project.stance(mimic.seen.get(layer))
        out[stance.name] = found.name if found else None
    return out


@pytest.mark.parametrize("who", ["adult_female", "adult_male", "alien"])
def test_heads_that_look_five_ways(shared_data: Path, who: str) -> None:
    project = project_of(
        shared_data / "sumerian-hosts" / "glTF" / "animations" / who / "poi.glb", HEADS, "head"
    )
    for turn in (0.0, 0.5):
        assert seen(project, "head", 3, turn) == {name: name for name in HEADS}
    if who != "alien":  # whose head is small beside the torso: to its sides it turns too little for a picture
        assert seen(project, "head", 2) == {name: name for name in HEADS}


@pytest.mark.nightly
def test_arms_of_a_rogue_with_short_limbs(shared_data: Path) -> None:
    project = project_of(shared_data / "kaykit-rogue" / "Rogue.glb", ARMS, "arms")
    for turn in (0.0, 0.5):
        assert seen(project, "arms", 3, turn) == {name: name for name in ARMS}
    flat = seen(project, "arms", 2)
    assert sum(name == found for name, found in flat.items()) >= 3, flat
