"""Find the camera of a conversation from its cuts, and the captions of what is said, both for the preview and
for exported pictures.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from app.stage.playback_source import ShownPlayback
from metagraph.graph.conversation.model import Conversation, Word, get_side_name
from metagraph.graph.timeline import Cut
from metagraph.speech.automatic_cuts import cut_at
from metagraph.speech.captions import (
    Caption,
    describe_line,
    list_timed_words,
    make_captions,
    make_captions_of_text,
    make_conversation_captions,
)
from preview.camera import Camera
from preview.scene import LampTurn
from preview.shots import is_lamp_on_right, make_shot_camera

Seen = tuple[Any, ShownPlayback]  # a figure, and what it plays
SAMPLED = 2  # moments of a cut at which the positions of heads are taken
HEAD, MOST = (
    0.085,
    4.0,
)  # of the height, from a head's middle to its top with hair; how many times larger it may be
FARTHEST = 8.0  # seconds of a cut over which they are taken


class Filmed(NamedTuple):
    """The camera of a picture, and how the light is turned for it."""

    camera: Camera
    lamp: LampTurn | None = None


class Cutting:
    """Finds one camera for each cut. It stands still, placed for where the speakers are during the cut. The
    light follows it.
    """

    def __init__(self) -> None:
        self._of: tuple[object, ...] = ()
        self._kept: dict[tuple[Cut, float, float], Filmed] = {}
        self._heads: list[tuple[float, float]] = []

    def camera(
        self, seen: Sequence[Seen], cuts: tuple[Cut, ...], seconds: float, aspect: float
    ) -> Filmed | None:
        """Return the camera and the light at a time; None if there is no cut. `seen` has the speakers, the
        first side first.
        """
        found = cut_at(cuts, seconds)
        if found is None or len(seen) < 2:
            return None
        cut, end = found
        of = (*(figure for figure, _ in seen), *(shown.plan for _, shown in seen))
        if len(of) != len(self._of) or any(a is not b for a, b in zip(of, self._of, strict=True)):
            self._of, self._kept = of, {}
            self._heads = [_head(figure) for figure, _ in seen]
        key = (cut, end, round(aspect, 2))
        if key not in self._kept:
            self._kept[key] = _film(
                seen, self._heads, cut, min(end, cut.at + FARTHEST, seen[0][1].length), aspect
            )
        return self._kept[key]


def _head(figure: Any) -> tuple[float, float]:
    """Return how far the middle of a figure's head is above where `Figure.head` says, and how tall a person
    with such a head is, in metres: a cartoon figure may have a head three times as large.
    """
    rotations, positions = figure.skeleton.globals(figure.skeleton.rest)
    above = float(figure.bounds(positions)[1][1] - figure.head(rotations, positions)[1])
    lift = max(0.0, (above - HEAD * figure.height) / 2)
    return lift, min(MOST, max(1.0, (above - lift) / (HEAD * figure.height))) * figure.height


def _film(
    seen: Sequence[Seen], sizes: Sequence[tuple[float, float]], cut: Cut, end: float, aspect: float
) -> Filmed:
    times = np.linspace(cut.at, max(cut.at, end), SAMPLED)
    heads, heights = [], []
    for (figure, shown), (lift, height) in zip(seen, sizes, strict=True):
        pose, skeleton = shown.pose(times), shown.skeleton
        assert pose is not None and skeleton is not None
        rotations, positions = skeleton.globals(pose)
        if shown.stand is not None:
            rotations, positions = shown.stand.placed(rotations, positions)
        middle = np.mean([figure.head(r, p) for r, p in zip(rotations, positions, strict=True)], axis=0)
        heads.append(middle + np.array([0.0, lift, 0.0]))
        heights.append(height)
    at = np.array(heads)
    camera = make_shot_camera(cut.shot, cut.side, at, heights, aspect)
    return Filmed(camera, LampTurn(camera.yaw, is_lamp_on_right(camera, cut.shot, cut.side, at)))


def list_captions(
    shown: ShownPlayback,
    conversation: Conversation | None,
    folder: Path,
    lines: Mapping[str, Sequence[Word]] | None = None,
) -> tuple[Caption, ...]:
    """Return the captions of what is played, by start. `lines` has the timed words of lines, None to read
    them.
    """
    if shown.clip is not None:
        return ()
    if conversation is not None:
        named = len({side.name for side in conversation.sides}) == len(conversation.sides)
        return tuple(
            Caption(
                c.start,
                c.end,
                f"{get_side_name(conversation, c.side)}: {c.text}" if named else c.text,
                c.side,
            )
            for c in make_conversation_captions(conversation)
        )
    out: list[Caption] = []
    for speech in shown.plan.track.speeches:
        line = shown.project.lines.get(speech.line or "")
        known = dict(lines or {})
        if line is not None and lines is None:
            known[str(speech.line)] = describe_line(line, shown.folder or folder)
        words = list_timed_words(speech, known)
        text = speech.text or (line.text if line is not None else "")
        out += make_captions(words) if words else make_captions_of_text(speech, text)
    return tuple(sorted(out, key=lambda c: c.start))
