"""Measure whom a speaker looks at, and for how long: the gaze of a plan is sampled, with the looks away and
the eye darts that life adds, and counted for each role.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import asin, atan, atan2, hypot
from typing import Literal

from metagraph.common.wording import phrase
from metagraph.graph.conversation.model import EVERYBODY, Conversation
from metagraph.graph.model import Project
from metagraph.graph.requests import Point
from metagraph.playback.life.gaze import BodyGaze
from metagraph.playback.plan import Plan
from metagraph.playback.posing.rigs import get_rigs
from metagraph.speech.addressing import list_side_roles
from metagraph.speech.drive import find_partner_points

FACE = 0.14  # metres round the middle of a head that are its face, hair and chin with it
STEP, MOST = 0.1, 6000  # seconds between samples at least, and samples at most
Doing = Literal["addressed", "aside", "speaking", "speaking to all"]
NAMES: dict[Doing, str] = {
    "addressed": phrase("when addressed, looks at the speaker"),
    "aside": phrase("when not addressed, looks at the speaker"),
    "speaking": phrase("when speaking to one, looks at that one"),
    "speaking to all": phrase("when speaking to all, looks at one of them"),
}


@dataclass(frozen=True, slots=True)
class GazeShare:
    """Of one role of a side. seconds: how long it had it. main: share of that time, 0..1, in which it looks
    at the face it is about: the speaker's, or the one spoken to; of all where all are. others: at other
    faces. The rest is spent looking away.
    """

    doing: Doing
    seconds: float
    main: float
    others: float

    @property
    def of_faces(self) -> float | None:
        """Share of all looks at faces that are at the one it is about; None without looks."""
        seen = self.main + self.others
        return self.main / seen if seen > 0 else None

    def words(self) -> str:
        """Return a sentence, such as "when addressed, looks at the speaker for 71 % of 12.3 s and at others
        for 8 %: 90 % of all looks at faces".
        """
        role, main = NAMES[self.doing], 100 * self.main
        if self.doing == "speaking to all" or self.of_faces is None:
            return phrase(
                "{role} for {main:.0f} % of {seconds:.1f} s", role=role, main=main, seconds=self.seconds
            )
        return phrase(
            "{role} for {main:.0f} % of {seconds:.1f} s and at others for {others:.0f} %: {faces:.0f} % of "
            "all looks at faces",
            others=100 * self.others,
            faces=100 * self.of_faces,
            role=role,
            main=main,
            seconds=self.seconds,
        )


def measure_gaze_shares(
    conversation: Conversation, side: int, project: Project, plan: Plan
) -> tuple[GazeShare, ...]:
    """Return where a side looks by what it does, in the order of `NAMES`; nothing of what it never does, and
    nothing of two, who have nobody else to look at. project: whose graph moves it.
    """
    points = find_partner_points(plan)
    if len(conversation.sides) < 3 or not points or not project.life.on:
        return ()
    gaze = BodyGaze(plan.life, project.life, get_rigs(project).body, project.points)
    found: dict[Doing, list[int]] = {doing: [0, 0, 0] for doing in NAMES}
    roles, place = list_side_roles(conversation, side), 0
    step = max(STEP, conversation.length / MOST)
    for n in range(int(conversation.length / step)):
        at = (n + 0.5) * step
        while place + 1 < len(roles) and roles[place].end <= at:
            place += 1
        role = roles[place]
        if role.part == "idle":
            continue
        doing: Doing = role.part if role.part != "speaks" else "speaking"
        if role.whom == EVERYBODY:
            doing = "speaking to all"
        seen = _seen(gaze, at, points)
        main = seen is not None and (seen == role.whom or role.whom == EVERYBODY)
        found[doing][0] += 1
        found[doing][1 if main else 2] += seen is not None
    return tuple(
        GazeShare(doing, count * step, main / count, others / count)
        for doing, (count, main, others) in found.items()
        if count
    )


def join_shares(shares: Sequence[GazeShare]) -> tuple[GazeShare, ...]:
    """Return shares of several as of one, by what they do."""
    out = []
    for doing in NAMES:
        some = [s for s in shares if s.doing == doing]
        whole = sum(s.seconds for s in some)
        if whole > 0:
            main = sum(s.main * s.seconds for s in some) / whole
            others = sum(s.others * s.seconds for s in some) / whole
            out.append(GazeShare(doing, whole, main, others))
    return tuple(out)


def _seen(gaze: BodyGaze, at: float, points: Mapping[int, Point]) -> int | None:
    """Return whose face the eyes are on; None for nobody's."""
    moves, eyes = gaze.at(at), gaze.body.eyes_at_rest
    turn, up = moves.eyes
    for aim, share, _ in moves.parts:
        left, high, _ = _angles(aim.at, eyes)
        turn, up = turn + share * left, up + share * high
    for side, point in points.items():
        left, high, far = _angles(point, eyes)
        if hypot(turn - left, up - high) <= atan(FACE / max(far, 1e-3)):
            return side
    return None


def _angles(to: Sequence[float], eyes: Sequence[float]) -> tuple[float, float, float]:
    """Return how far to the left and up a point is, radians, and how far off, metres."""
    x, y, z = (a - b for a, b in zip(to, eyes, strict=True))
    far = hypot(x, y, z)
    return atan2(x, z), asin(y / far) if far > 0 else 0.0, far
