"""Motion from what is heard: as it comes in, or of a whole conversation. The same seed gives the same motion
to the bit, in whatever pieces the sound came.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metagraph.generation.averaging import RESTING, TOKENS_RESTING, Averaging
from metagraph.generation.chunks import GUIDANCE
from metagraph.generation.features import (
    RATE,
    FeatureStream,
    count_sound_frames,
    make_silence,
    tell_by_sound,
    tell_conversation,
)
from metagraph.generation.generators import make_generator
from metagraph.generation.loudness import compute_gain
from metagraph.generation.networks import FPS, FlowSizes, MatchingSizes
from metagraph.generation.poses import PoseError, decode_poses, encode_rotations
from metagraph.generation.stored import Model
from metagraph.graph.conversation.model import Conversation
from metagraph.motion import rotation
from metagraph.motion.clip import Clip
from metagraph.motion.skeleton import Pose

Array = NDArray[Any]

WARMEST = 1.2  # temperature at most


class TakeSampler:
    """One take of a model, from its first frame on.

    seed, take: 0..2^64 - 1; start: number of the first frame, 0 or more, so that what begins later has the
    chance of its own frames. temperature: 0..WARMEST, how much may happen by chance. lookahead: frames of
    sound ahead that each frame may wait for; None: all that the model uses. guidance: how closely a model
    that can be guided follows the speech. channels, gains: of the sound, as `features.AudioStream`. first:
    local rotations `[J, 4]` of all joints that it goes on from, None for the mean pose. smooth: frames, the
    deviation of a Gaussian over the numbers of poses; None: as `averaging` has it where a model makes pieces
    of several frames, 0 for others.
    delay: frames by which poses come out later than the sound goes in. made, pieces: `advance` makes so many
    frames at once, after it was called so often.
    """

    def __init__(
        self,
        model: Model,
        seed: int = 1,
        temperature: float = 1.0,
        *,
        take: int = 0,
        start: int = 0,
        lookahead: int | None = None,
        guidance: float = GUIDANCE,
        channels: int = 2,
        gains: Sequence[float] | None = None,
        first: Array | None = None,
        smooth: float | None = None,
    ) -> None:
        if not 0 <= temperature <= WARMEST:
            raise ValueError(f"a temperature is 0 to {WARMEST:g}, not {temperature:g}")
        if not (0 <= seed < 2**64 and 0 <= take < 2**64 and 0 <= start < 2**63):
            raise ValueError("seeds, takes and frames are whole numbers from 0 to 2^64 - 1")
        if not np.isfinite(guidance):
            raise ValueError("the guidance must be a finite number")
        self.model, self.seed, self.take, self.start = model, seed, take, start
        self._features = FeatureStream(channels, model.card.tracks, gains)
        sizes = model.card.sizes
        before = np.zeros(sizes.pose, np.float32)
        if first is not None:
            rotations = np.asarray(first, np.float64)
            if rotations.shape != (len(model.rig.skeleton), 4) or not np.isfinite(rotations).all():
                raise PoseError("the first pose is one of another skeleton")
            before = model.poses.apply(encode_rotations(model.rig, rotations))
        self._made = make_generator(model.weights, sizes, before, temperature, lookahead, guidance)
        adaptive = smooth is None and (
            isinstance(sizes, MatchingSizes) or (isinstance(sizes, FlowSizes) and sizes.span > 1)
        )
        resting = TOKENS_RESTING if isinstance(sizes, MatchingSizes) else RESTING
        self._averaging = Averaging(resting=resting) if adaptive else Averaging(smooth or 0.0, None)
        quiet = make_silence(model.card.tracks)
        # Features that are still needed, from `before` frames before the next one made.
        self._heard = model.heard(np.tile(quiet, (self._made.before, 1)))
        self._quiet = model.heard(quiet[None])
        self._next = 0  # number of the next frame made
        self._given = 0  # poses that came of it: fewer, where a model is behind
        self._known = 0  # frames of sound that are known
        self._out = np.zeros((0, sizes.pose), np.float32)  # poses that are made, and still averaged over
        self._begun = False
        self._steps: Iterator[Array | None] | None = None  # what `advance` is in the middle of
        self.delay = self._made.needed + self._made.delay + self._averaging.reach
        self.made, self.pieces = self._made.made, self._made.pieces

    def push(self, audio: Array, activity: Array) -> Array:
        """Return the poses that are ready, local rotations `[n, joints, 4]` of the rig's joints. audio: `[C,
        N]` at `features.RATE`; activity: of the next frames, as for `features.FeatureStream.push`. Raises
        FeatureError.
        """
        return self._turns(self.numbers(self._features.push(audio, activity)))

    def finish(self) -> Array:
        """Return the poses that are left, as though silence followed."""
        return self._turns(self.numbers(self._features.finish(), True))

    def feed(self, audio: Array, activity: Array) -> None:
        """Take in what `push` does, and leave the work to `advance`. Raises FeatureError."""
        self._take(self._features.push(audio, activity))

    def advance(self) -> Array | None:
        """Do about a millisecond of what there is to do; return the poses that are ready, as `push` does,
        None when nothing is left to be done.
        """
        if self._steps is None:
            if self._next + self._made.needed >= self._known:
                return None
            self._steps = self._made.steps(self._window(False), self.seed, self.take, self.start + self._next)
        new = next(self._steps)
        if new is None:
            return np.zeros((0, len(self.model.rig.joints), 4))
        self._steps = None
        self._on(new)
        return self._turns(self._averaged(np.concatenate([self._out, new]), False))

    def _turns(self, poses: Array) -> Array:
        return decode_poses(self.model.rig, poses)

    def _take(self, frames: Array) -> None:
        self._known += len(frames)
        if len(frames):
            self._heard = np.concatenate([self._heard, self.model.heard(frames)])

    def _window(self, last: bool) -> Array:
        """Return what the next frame made hears, and some of those after it. last: silence follows."""
        window = self._heard[: self._made.most]
        if last and len(window) < self._made.most:
            window = np.concatenate([window, np.repeat(self._quiet, self._made.most - len(window), 0)])
        return window

    def _on(self, new: Array) -> None:
        self._heard = self._heard[self._made.made :]
        self._next += self._made.made
        self._given += len(new)

    def numbers(self, frames: Array, last: bool = False) -> Array:
        """Return the poses that are ready as numbers `[n, X]`, not standardised, of the next features `[m,
        audio + 4]`. last: silence follows, and all that is left is made.
        """
        self._take(frames)
        made, poses = self._made, [self._out]
        while self._next < self._known:
            if self._next + made.needed >= self._known and not last:
                break
            new = made.step(self._window(last), self.seed, self.take, self.start + self._next)
            poses.append(new[: self._known - self._given])
            self._on(new)
        if last and self._given < self._known and (rest := made.rest()) is not None:
            poses.append(rest[: self._known - self._given])
        return self._averaged(np.concatenate(poses), last)

    def _averaged(self, poses: Array, last: bool) -> Array:
        """Return the poses of which all neighbours are known, not standardised."""
        reach = self._averaging.reach
        if not self._begun and len(poses):
            poses = np.concatenate([np.repeat(poses[:1], reach, 0), poses])
            self._begun = True
        if last and len(poses):
            poses = np.concatenate([poses, np.repeat(poses[-1:], reach, 0)])
        count = max(0, len(poses) - 2 * reach)
        out = self._averaging.of(poses)
        self._out = poses[count:]
        return self.model.poses.undo(out)


def generate_recording_poses(
    model: Model, features: Array, seed: int = 1, temperature: float = 1.0, **options: Any
) -> Array:
    """Return the poses `[T, X]`, not standardised, to a whole recording's features `[T, audio + 4]`. options:
    as for `Sampler`.
    """
    sampler = TakeSampler(model, seed, temperature, **options)
    return sampler.numbers(features, True)


def sample_whole(
    model: Model,
    samples: Array,
    activity: Array,
    *,
    seed: int = 1,
    temperature: float = 1.0,
    lookahead: int | None = None,
    guidance: float = GUIDANCE,
    take: int = 0,
    first: Array | None = None,
    smooth: float | None = None,
    name: str = "generated",
) -> Clip:
    """Return the motion to a recording, as long as it is. samples: `[C, N]` at `features.RATE`, own voice
    first; activity: as `features.tell_conversation` or `tell_by_sound` give it, `[T, TOLD]`, or who speaks
    alone `[T, 4]`.
    Joints that the model does not move are in its base pose, or as `first` has them. Raises FeatureError.
    """
    samples = np.atleast_2d(samples)
    if not samples.shape[1]:
        raise ValueError("there is no sound to move to")
    sampler = TakeSampler(
        model,
        seed,
        temperature,
        take=take,
        lookahead=lookahead,
        guidance=guidance,
        channels=len(samples),
        gains=[compute_gain(channel, RATE) for channel in samples],
        first=first,
        smooth=smooth,
    )
    ready = [sampler.push(samples, activity[: count_sound_frames(samples.shape[1])]), sampler.finish()]
    return make_clip_from_poses(model, np.concatenate(ready), name, first, seed)


def make_conversation_motion(
    model: Model, conversation: Conversation, side: int, samples: Array, seed: int = 1, **options: Any
) -> Clip:
    """Return the motion of one side of a conversation. samples: `[C, N]` at `features.RATE`, that side's
    voice first. options: as for `whole`.
    """
    count = count_sound_frames(np.atleast_2d(samples).shape[1])
    activity = tell_conversation(conversation, side, count)
    name = conversation.sides[side].name or f"{conversation.name}, side {side + 1}"
    return sample_whole(model, samples, activity, seed=seed, **{"name": name, **options})


def hear_activity(samples: Array) -> Array:
    """Return marks and activity `[T, TOLD]` of a recording without words: samples `[C, N]` at
    `features.RATE`.
    """
    samples = np.atleast_2d(samples)
    partner = samples[1] if len(samples) > 1 else None
    return tell_by_sound(samples[0], partner, RATE, count_sound_frames(samples.shape[1]))


def make_clip_from_poses(
    model: Model, turns: Array, name: str, first: Array | None = None, seed: int | None = None
) -> Clip:
    """Return a clip of rotations `[T, joints, 4]` of the rig's joints."""
    rig = model.rig
    held = rig.base if first is None else np.asarray(first, np.float64)
    rotations = np.repeat(held[None], len(turns), 0)
    between = sorted({j for line in rig.lines for j in line[:-1]})
    rotations[:, between] = rig.base[between]
    rotations[:, list(rig.joints)] = turns
    root = np.repeat(rig.skeleton.rest_translations[None, :1], len(turns), 0)
    made = "by a learned model" if seed is None else f"by a learned model, seed {seed}"
    return Clip(
        name,
        rig.skeleton,
        FPS,
        rotation.make_continuous(rotation.normalize(rotations)).astype(np.float32),
        root.astype(np.float32),
        notes=(f"generated {made} ({model.card.kind})",),
    )


def read_first_pose(clip: Clip, seconds: float = 0.0) -> Array:
    """Return the local rotations `[J, 4]` of a clip, a stance say, at a moment."""
    pose: Pose = clip.pose_at(seconds)
    return np.asarray(pose.rotations, np.float64)
