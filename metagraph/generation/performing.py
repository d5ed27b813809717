"""Models at work for a project: motion for one side of a conversation, and takes to cut clips from, on the
project's own skeleton.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import CancelledError
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.common.wording import phrase
from metagraph.generation.chunks import GUIDANCE
from metagraph.generation.features import RATE as SOUND_RATE
from metagraph.generation.features import (
    FeatureError,
    count_sound_frames,
    resample_for_features,
    tell_conversation,
)
from metagraph.generation.loudness import compute_gain
from metagraph.generation.poses import PoseError, PoseRig, find_rig
from metagraph.generation.sampler import TakeSampler, hear_activity, make_clip_from_poses
from metagraph.generation.stored import Model
from metagraph.graph import anatomy
from metagraph.graph.conversation.model import Conversation, get_side_name, list_other_sides
from metagraph.graph.editing.retargeting import Bringing
from metagraph.graph.model import Project
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import RetargetError
from metagraph.speech.sound import read_recording

Array = NDArray[Any]

LONGEST = 3600.0  # seconds of sound
AT_ONCE = SOUND_RATE  # samples between two looks at whether it was cancelled
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Chance:
    """How a take is drawn. seed: 0..2^64 - 1. temperature: 0..1.2. guidance: how closely a model that
    can be guided follows the speech. take: number of the take, so that the same speech is moved to
    differently.
    """

    seed: int = 1
    temperature: float = 1.0
    guidance: float = GUIDANCE
    take: int = 0


def project_rig(project: Project) -> PoseRig:
    """Return the joints of a project's figure that models move, relative to its base pose. Raises PoseError
    if there are none.
    """
    if project.skeleton is None:
        raise PoseError("the project has no clips, so there is nobody to move: import some first")
    base = anatomy.get_base_pose(project).rotations
    return find_rig(project.skeleton, anatomy.project_roles(project), base)


def moves_skeleton(model: Model, project: Project) -> bool:
    """Whether a model moves the project's own skeleton."""
    return project.skeleton is not None and model.rig.skeleton == project.skeleton


def find_first_pose(model: Model, project: Project) -> Array | None:
    """Return the pose `[J, 4]` that a model goes on from: the project's base pose, None on another
    skeleton.
    """
    return (
        anatomy.get_base_pose(project).rotations.astype(np.float64)
        if moves_skeleton(model, project)
        else None
    )


def as_project_clip(project: Project, clip: Clip) -> tuple[Clip, tuple[str, ...]]:
    """Return what a model made as a clip of a project's figure: what no model moves is in the base pose; and
    what there is to know of it, in words. A clip of another skeleton is retargeted, by the project's joint
    map where it has one. Raises PoseError and RetargetError.
    """
    rig = project_rig(project)
    notes: tuple[str, ...] = ()
    if clip.skeleton != rig.skeleton:
        bringing = Bringing(project)
        try:
            clip = bringing.bring(clip, bringing.known(clip) or bringing.propose(clip.skeleton))
        except RetargetError as error:
            raise RetargetError(
                f"the model was made for another skeleton, and its motion cannot be retargeted: {error}"
            ) from None
        notes = ("The model was made for another skeleton: its motion is retargeted.",)
    base = anatomy.get_base_pose(project)
    moved = sorted({joint for line in rig.lines for joint in line})
    rotations = np.repeat(base.rotations[None], clip.frames, 0)
    rotations[:, moved] = clip.rotations[:, moved]
    away = np.abs(base.translations - rig.skeleton.rest_translations).max(1) > 1e-6
    places = (0, *(int(j) for j in np.flatnonzero(away) if j > 0))
    held = np.repeat(base.translations[None, list(places)], clip.frames, 0)
    made = Clip(clip.name, rig.skeleton, clip.fps, rotations, held, places, notes=(*clip.notes, *notes))
    return made, notes


def read_side_sound(conversation: Conversation, side: int, folder: Path) -> tuple[Array, tuple[str, ...]]:
    """Return what is heard in a conversation `[2, N]` at `features.RATE`, one side's own voice first, then
    all others' as one, as long as it lasts, and what is missing, in words. folder: what paths begin at.
    Raises FileError.
    """
    count = max(1, round(conversation.length * SOUND_RATE))
    out, notes = np.zeros((2, count), np.float32), []
    heard_once: set[tuple[int, str | None, int | None]] = set()  # several may share one sound
    for n in (side, *list_other_sides(conversation, side)):
        of = conversation.sides[n]
        if of.audio is None:
            notes.append(
                phrase(
                    "{side_name} has no sound: only the speech times are used.",
                    side_name=get_side_name(conversation, n),
                )
            )
            continue
        if (key := (int(n != side), of.audio, of.channel)) in heard_once:
            continue
        heard_once.add(key)
        recording = read_recording(folder / of.audio, LONGEST)
        samples = recording.samples
        one = samples.mean(0) if of.channel is None else samples[min(of.channel, len(samples) - 1)]
        voice = resample_for_features(one[None], recording.rate)[0][:count]
        out[int(n != side), : len(voice)] += voice
    return out, tuple(notes)


@dataclass(frozen=True, eq=False)
class HeardSpeech:
    """What motion is made to. samples: `[C, N]` at `features.RATE`, own voice first. activity: marks and
    who speaks, `[T, TOLD]`. notes: what is missing, or there is to know, in words.
    """

    samples: Array
    activity: Array
    notes: tuple[str, ...] = ()


def hear_side(project: Project, ident: str, side: int, folder: Path) -> HeardSpeech:
    """Return what is heard in a conversation, as `read_side_sound` does. Raises FileError."""
    samples, notes = read_side_sound(project.conversations[ident], side, folder)
    count = count_sound_frames(samples.shape[1])
    return HeardSpeech(samples, tell_conversation(project.conversations[ident], side, count), notes)


def hear_file(path: Path) -> HeardSpeech:
    """Return what is heard in a sound file: at most two channels, the first one's own voice; loudness tells
    who speaks. Raises FileError.
    """
    recording = read_recording(path, LONGEST)
    samples = resample_for_features(recording.samples, recording.rate)[:2]
    return HeardSpeech(samples, hear_activity(samples), ("Loudness tells who speaks.",))


def generate_motion(
    model: Model,
    heard: HeardSpeech,
    chance: Chance,
    name: str,
    first: Array | None = None,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Clip:
    """Return a model's motion to a recording, as long as it is, on the model's skeleton: what `sampler.whole`
    gives, a second at a time. progress: called with seconds done, of how many. Raises FeatureError, and
    CancelledError.
    """
    samples = np.atleast_2d(heard.samples)
    size = samples.shape[1]
    if not size:
        raise FeatureError("there is no sound to move to")
    sampler = TakeSampler(
        model,
        chance.seed,
        chance.temperature,
        take=chance.take,
        guidance=chance.guidance,
        channels=len(samples),
        gains=[compute_gain(channel, SOUND_RATE) for channel in samples],
        first=first,
    )
    told = heard.activity[: count_sound_frames(size)]
    ready = []
    for n, start in enumerate(range(0, size, AT_ONCE)):
        if cancelled is not None and cancelled():
            raise CancelledError
        if progress is not None:
            progress(n, -(-size // AT_ONCE))
        ready.append(sampler.push(samples[:, start : start + AT_ONCE], told if start == 0 else told[:0]))
    ready.append(sampler.finish())
    return make_clip_from_poses(model, np.concatenate(ready), name, first, chance.seed)


def make_side_clip(
    model: Model,
    project: Project,
    heard: HeardSpeech,
    chance: Chance,
    name: str,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> tuple[Clip, tuple[str, ...]]:
    """Return what moves one side of a project's conversation, and what there is to know of it, in words.
    heard: `hear_side`. Raises PoseError, RetargetError, FeatureError and CancelledError.
    """
    first = find_first_pose(model, project)
    clip = generate_motion(model, heard, chance, name, first, progress, cancelled)
    clip, told = as_project_clip(project, clip)
    return clip, (*heard.notes, *told)


def generate_long_takes(
    model: Model,
    project: Project,
    heard: HeardSpeech,
    seconds: float,
    chance: Chance,
    name: str,
    progress: Progress | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> tuple[list[Clip], tuple[str, ...]]:
    """Return takes of together `seconds` to a recording, on the project's skeleton; where it is shorter it is
    moved to again and again, each time by another chance. Beside them, what there is to know, in words.
    Errors as for `spoken`.
    """
    samples = np.atleast_2d(heard.samples)
    wanted, length = round(seconds * SOUND_RATE), samples.shape[1]
    if not length:
        raise FeatureError("there is no sound to move to")
    out: list[Clip] = []
    notes: tuple[str, ...] = ()
    left, total = wanted, -(-wanted // AT_ONCE)
    while left > 0 and (not out or left >= min(length, 4 * SOUND_RATE)):
        part = min(left, length)
        done = (wanted - left) // AT_ONCE

        def tell(n: int, _: int, done: int = done) -> None:
            if progress is not None:
                progress(min(total, done + n), total)

        drawn = replace(chance, take=chance.take + len(out))
        some = HeardSpeech(samples[:, :part], heard.activity)
        clip = generate_motion(model, some, drawn, name, find_first_pose(model, project), tell, cancelled)
        clip, notes = as_project_clip(project, clip)
        out.append(clip)
        left -= part
    return out, notes
