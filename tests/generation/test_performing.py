"""Models at work for a project: on its own skeleton or another, to a conversation's sound."""

from __future__ import annotations

from concurrent.futures import CancelledError
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
import soundfile

from metagraph.errors import FileError
from metagraph.generation.features import RATE, FeatureError
from metagraph.generation.offered import list_models
from metagraph.generation.performing import (
    Chance,
    HeardSpeech,
    as_project_clip,
    generate_long_takes,
    generate_motion,
    hear_file,
    hear_side,
    make_side_clip,
    moves_skeleton,
    project_rig,
    read_side_sound,
)
from metagraph.generation.poses import PoseError
from metagraph.generation.sampler import hear_activity, sample_whole
from metagraph.graph import anatomy, edits
from metagraph.graph.generated import add_generated, describe_origin
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Skeleton
from tests.generation.makers import babble, conversation, moving, stance, untrained

pytestmark = pytest.mark.usefixtures("numbered_ids")


@pytest.fixture(scope="module")
def model():
    return untrained("flow-vae")


def talking(project: Project, folder: Path, seconds: float = 6.0) -> Project:
    sound = np.stack([babble(seconds, 1), babble(seconds, 2)], 1)
    soundfile.write(folder / "talk.wav", sound, RATE)
    talk = conversation(seconds)
    sides = tuple(
        msgspec.structs.replace(s, name=("Ada", "Ben")[n], audio="talk.wav", channel=n)
        for n, s in enumerate(talk.sides)
    )
    return replace(project, conversations={"v1": msgspec.structs.replace(talk, sides=sides)})


def taller(by: float = 1.2) -> Project:
    """A project whose figure is another: other names before the joints', longer bones."""
    clip = stance()
    s = clip.skeleton
    names = tuple(f"rig:{n}" for n in s.names)
    other = Skeleton(names, s.parents, s.rest_rotations, s.rest_translations * by)
    moved = Clip("stance", other, clip.fps, clip.rotations, clip.translations * by, clip.translated)
    return edits.place_clips(
        edits.add_clips(Project(), [("a.glb", 0, "", moved)]), ["c1"], "arms", "stance", None
    )


def test_only_what_the_model_moves_leaves_the_base_pose(sample, model, tmp_path):
    project = talking(sample, tmp_path)
    assert moves_skeleton(model, project)
    clip, notes = make_side_clip(model, project, hear_side(project, "v1", 0, tmp_path), Chance(3), "ada")
    assert clip.skeleton == project.skeleton and clip.duration == pytest.approx(6.0, abs=0.05) and not notes
    base = anatomy.get_base_pose(project)
    moved = {j for line in project_rig(project).lines for j in line}
    still = [j for j in range(len(project.skeleton)) if j not in moved]
    assert np.abs(clip.rotations[:, still] - base.rotations[still]).max() < 1e-6
    assert np.abs(clip.rotations[:, sorted(moved)] - base.rotations[sorted(moved)]).max() > 0.01
    assert np.allclose(clip.poses().translations, base.translations, atol=1e-6)


def test_another_figure_gets_the_motion_retargeted_and_is_told(model, tmp_path):
    project = talking(taller(), tmp_path)
    assert not moves_skeleton(model, project)
    clip, notes = make_side_clip(model, project, hear_side(project, "v1", 1, tmp_path), Chance(), "ben")
    assert clip.skeleton == project.skeleton and "retargeted" in notes[-1]
    arm = anatomy.project_roles(project)["left_upper_arm"]
    assert np.ptp(clip.rotations[:, arm], axis=0).max() > 0.01
    feet = [j for j, part in enumerate(anatomy.project_parts(project)) if part == "legs"]
    assert np.abs(clip.rotations[:, feet] - anatomy.get_base_pose(project).rotations[feet]).max() < 1e-6


def test_the_same_chance_gives_the_same_clip_and_pieces_do_not_matter(model):
    sound = np.stack([babble(4.3, 1), babble(4.3, 2)])
    told = hear_activity(sound)
    heard = HeardSpeech(sound, told)
    one = generate_motion(model, heard, Chance(5, 0.8), "a")
    assert (one.rotations == generate_motion(model, heard, Chance(5, 0.8), "a").rotations).all()
    assert (one.rotations == sample_whole(model, sound, told, seed=5, temperature=0.8).rotations).all()
    assert (one.rotations != generate_motion(model, heard, Chance(6, 0.8), "a").rotations).any()


def test_a_short_sound_is_moved_to_again_each_time_otherwise(sample, model):
    sound = babble(5.0)[None]
    made, _ = generate_long_takes(
        model, sample, HeardSpeech(sound, hear_activity(sound)), 14.0, Chance(), "long"
    )
    assert [round(c.duration) for c in made] == [5, 5, 4]
    assert (made[0].rotations[:90] != made[1].rotations[:90]).any()


def test_sides_hear_their_own_voice_first_and_what_is_missing_is_told(sample, tmp_path):
    project = talking(sample, tmp_path)
    talk = project.conversations["v1"]
    ada, ben = (read_side_sound(talk, n, tmp_path)[0] for n in (0, 1))
    assert np.allclose(ada, ben[::-1]) and ada.shape == (2, 6 * RATE)
    mute = msgspec.structs.replace(
        talk, sides=(msgspec.structs.replace(talk.sides[0], audio=None, channel=None), talk.sides[1])
    )
    samples, notes = read_side_sound(mute, 0, tmp_path)
    assert not samples[0].any() and samples[1].any() and len(notes) == 1 and notes[0].startswith("Ada ")


def test_of_three_all_others_are_one_voice_each_heard_once(sample, tmp_path):
    talk = talking(sample, tmp_path).conversations["v1"]
    ada, ben = read_side_sound(talk, 0, tmp_path)[0]
    three = msgspec.structs.replace(talk, sides=(*talk.sides, talk.sides[1]))
    assert np.allclose(read_side_sound(three, 0, tmp_path)[0], (ada, ben)), (
        "the third shares the second's channel"
    )
    other = msgspec.structs.replace(talk, sides=(*talk.sides, talk.sides[0]))
    assert np.allclose(read_side_sound(other, 1, tmp_path)[0], (ben, ada))
    apart = msgspec.structs.replace(talk, sides=(talk.sides[0], *talk.sides))
    assert np.allclose(read_side_sound(apart, 0, tmp_path)[0], (ada, ada + ben))


def test_a_sound_that_is_gone_is_an_error_that_names_it(sample, tmp_path):
    project = talking(sample, tmp_path)
    (tmp_path / "talk.wav").unlink()
    with pytest.raises(FileError, match=r"talk\.wav"):
        hear_side(project, "v1", 0, tmp_path)


def test_a_file_of_one_voice_is_heard(tmp_path):
    soundfile.write(tmp_path / "one.wav", babble(2.0), RATE)
    heard = hear_file(tmp_path / "one.wav")
    assert heard.samples.shape == (1, 2 * RATE)
    assert heard.activity.shape[1] == 9 and not heard.activity[:, -3:-1].any()


def test_it_can_be_cancelled_and_nothing_cannot_be_moved_to(sample, model):
    sound = babble(5.0)[None]
    with pytest.raises(CancelledError):
        generate_motion(
            model, HeardSpeech(sound, hear_activity(sound)), Chance(), "a", cancelled=lambda: True
        )
    with pytest.raises(FeatureError):
        generate_motion(model, HeardSpeech(sound[:, :0], hear_activity(sound)), Chance(), "a")
    with pytest.raises(PoseError, match="nobody to move"):
        as_project_clip(Project(), moving(1.0))


def test_clips_say_who_made_them_and_still_do_when_read_again(sample, tmp_path):
    clip = moving(2.0)
    project = add_generated(sample, [("generated/a.glb", 0, "x", clip)], "anna", 7)
    entry = next(e for e in project.clips.values() if e.path == "generated/a.glb")
    assert "'anna'" in describe_origin(entry) and "seed 7" in describe_origin(entry)
    assert {describe_origin(e) for e in project.clips.values() if e is not entry} == {""}
    again = edits.add_clips(project, [("generated/a.glb", 0, "y", clip)])
    assert describe_origin(again.clips[entry.id]) == describe_origin(entry)


def test_models_are_offered_from_beside_the_project_and_its_folder(tmp_path, monkeypatch):
    from metagraph.generation import offered as module

    monkeypatch.setattr(module, "SHIPPED", tmp_path / "none.mgmodel")
    assert list_models(None) == {} and list_models(tmp_path / "gone") == {}
    (tmp_path / "models").mkdir()
    for name in ("b.mgmodel", "models/a.mgmodel", "models/b.mgmodel", "models/no.txt"):
        (tmp_path / name).touch()
    assert list_models(tmp_path) == {n: tmp_path / "models" / f"{n}.mgmodel" for n in ("a", "b")}
    monkeypatch.setattr(module, "SHIPPED", tmp_path / "b.mgmodel")
    assert list(list_models(tmp_path)) == ["own", "a", "b"]
