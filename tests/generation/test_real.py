"""Skeletons of other studios: whatever has arms and a head is given in numbers and comes back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from metagraph.formats.clips import find_clip_files, read_clips
from metagraph.generation.landmarks import HEAD, NOSE, place_landmarks
from metagraph.generation.poses import PoseError, decode_poses, encode_clip, find_rig, resample_rotations
from metagraph.motion import rotation
from metagraph.motion.skeleton import Pose

DATA = Path(__file__).resolve().parents[3] / "shared" / "data"
pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason=f"clips made by others are not at {DATA}")


@pytest.mark.parametrize(
    ("folder", "numbers"),
    [
        ("sumerian-hosts", {78}),
        ("bandai-namco-1", {72}),
        ("kaykit-rogue", {54}),
        ("robot-expressive", {78}),
        ("smartbody-brad", {78}),
    ],
)
def test_a_talkers_upper_body_comes_back(folder, numbers):
    files = [f for f in find_clip_files(DATA / folder) if f.suffix in (".glb", ".bvh")]
    clips = [c for f in files[:: max(1, len(files) // 4)] for c in read_clips(f)[:2]]
    assert clips
    seen = set()
    for clip in clips:
        rig = find_rig(clip.skeleton)
        seen.add(rig.numbers)
        turns = resample_rotations(clip, 25.0)
        back = turns.copy()
        between = [j for line in rig.lines for j in line[:-1]]
        back[:, between] = rig.base[between]
        back[:, list(rig.joints)] = decode_poses(rig, encode_clip(rig, clip, 25.0))
        still = np.repeat(clip.skeleton.rest_translations[None], len(turns), 0)
        there, again = (clip.skeleton.globals(Pose(r, still))[0][:, list(rig.joints)] for r in (turns, back))
        assert np.degrees(rotation.measure_angle_between(there, again).max()) < 0.05
        marks = place_landmarks(rig, encode_clip(rig, clip, 25.0)[:1])
        assert np.linalg.norm(marks[:, NOSE] - marks[:, HEAD]) == pytest.approx(0.12)
    assert seen == numbers


@pytest.mark.parametrize("name", ["bird-animations.glb", "quad-creature-animations.glb"])
def test_animals_are_refused_in_words(name):
    with pytest.raises(PoseError, match=r"has no .*arm.* that can be told by name or shape"):
        find_rig(read_clips(DATA / "mesh2motion-cmu" / name)[0].skeleton)
