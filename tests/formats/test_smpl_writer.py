"""Motion is written as SMPL-H parameters, and read back as it was."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from metagraph.formats.clips import read_clips
from metagraph.formats.smpl import make_smpl_figure
from metagraph.formats.smpl_writer import write_smpl
from metagraph.motion.roles import find_roles

CLIPS = Path(__file__).resolve().parents[2] / "sample_clips" / "clips"


def test_what_is_written_is_read_back_with_limbs_that_point_as_they_did(tmp_path: Path) -> None:
    clip = read_clips(next(CLIPS.glob("*open_palms_bt_01*")))[0]
    path = tmp_path / "a.npz"
    write_smpl(clip, path)
    with np.load(path) as found:
        assert found["poses"].shape == (clip.frames, 156) and found["trans"].shape == (clip.frames, 3)
        assert float(found["mocap_framerate"]) == clip.fps and str(found["gender"]) == "neutral"
        assert np.abs(found["poses"]).max() <= np.pi + 1e-6
        assert 0.7 < found["trans"][:, 2].mean() < 1.1, "Z is up, and the hips are as high as a leg is long"
    back = read_clips(path)[0]
    assert back.frames == clip.frames and back.skeleton == make_smpl_figure(52)
    assert any("its Z axis points up" in note for note in back.notes)
    worst = 0.0
    for role, end in (("upper_arm", "lower_arm"), ("lower_arm", "hand"), ("upper_leg", "lower_leg")):
        for side in ("left", "right"):
            ways = []
            for one in (clip, back):
                roles, at = find_roles(one.skeleton), one.skeleton.globals(one.poses())[1].astype(float)
                line = at[:, roles[f"{side}_{end}"]] - at[:, roles[f"{side}_{role}"]]
                ways.append(line / np.linalg.norm(line, axis=-1, keepdims=True))
            worst = max(
                worst, float(np.degrees(np.arccos(np.clip((ways[0] * ways[1]).sum(-1), -1, 1))).max())
            )
    assert worst < 12.0, "degrees: hands that touch or reach are brought where they were"
    low = back.skeleton.globals(back.poses())[1][
        :, [back.skeleton.index(n) for n in ("left_foot", "right_foot")], 1
    ]
    assert abs(float(np.median(low.min(1)))) < 0.05
