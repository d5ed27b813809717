"""A character that plays an export, for programs in Python: ask, update, pose. Needs neither Qt nor OpenGL.

    character = Character("talk.json")
    character.ask({"do": "gesture", "tags": ["greeting"]})
    while running:
        pose = character.update(seconds)

It is the desktop's planner and composer, as the runtimes for engines are theirs; all of them make the same of the same.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import msgspec

from metagraph.engines.export import read_export
from metagraph.graph import asks as a
from metagraph.graph.model import LAYERS, Layer, Project
from metagraph.motion.skeleton import Pose
from metagraph.playback.hear import Answer, answer, hear, since
from metagraph.playback.plan import Plan
from metagraph.playback.player import morphs_at, pose_at

SLACK = 2.0  # seconds by which the plan may fall behind its horizon before it is extended
CUT = 15.0  # seconds between two cuts of the past


@dataclass(frozen=True, slots=True)
class Happening:
    """What began or ended since the update before. at: seconds. action: its name. meta: the id that was asked with, or the model's."""

    kind: Literal["begin", "end"]
    at: float
    layer: Layer
    action: str
    meta: str


class Character:
    """One character, played live. export: path of an exported JSON, its GLB beside it, or a project. seed: 32-bit, the project's when
    None. idle: the models fill the time nobody asks for. stances: where layers begin. ahead: seconds of plan; recent: of past.

    Raises FileError when the export cannot be read.
    """

    def __init__(
        self,
        export: str | Path | Project,
        seed: int | None = None,
        idle: bool = True,
        stances: Mapping[Layer, str] | None = None,
        ahead: float = 20.0,
        recent: float = 30.0,
    ) -> None:
        self.project = export if isinstance(export, Project) else read_export(export, resolved=True)
        self.now = 0.0
        self._idle, self._stances, self._ahead, self._recent = idle, dict(stances or {}), ahead, recent
        self._asked: list[a.AnyAsk] = []
        self._refused: dict[str, str] = {}
        self._events: tuple[Happening, ...] = ()
        self._count = 0
        self._cut = 0.0
        empty = Plan(self.project.settings.seed if seed is None else seed & 0xFFFFFFFF, 0.0)
        self.plan = hear(self.project, empty, 0.0, [], ahead, self._stances, idle)

    @property
    def problems(self) -> tuple[str, ...]:
        """What the export lacks, in words; actions without a clip show their stance."""
        return tuple(f"clip '{clip.name}' is missing" for clip in self.project.clips.values() if clip.motion is None)

    def ask(self, request: Mapping[str, Any] | a.AnyAsk) -> str:
        """Ask for something; return the id it goes by. It is worked in at the next update. `after`: seconds from now, instead of `at`.

        What cannot be read is refused, as `answer` tells; nothing is raised.
        """
        self._count += 1
        if not isinstance(request, Mapping):
            named = request if request.id else msgspec.structs.replace(request, id=f"#{self._count}")
            self._asked.append(named)
            return named.id
        data = dict(request)
        ident = data.setdefault("id", f"#{self._count}")
        if not isinstance(ident, str) or not ident:
            ident = data["id"] = f"#{self._count}"
        after = data.pop("after", None)
        if isinstance(after, int | float) and not isinstance(after, bool):
            data["at"] = self.now + after
        try:
            self._asked.append(a.ask_from(data))
            self._refused.pop(ident, None)
        except a.AskError as error:
            self._refused[ident] = str(error)
        return str(ident)

    def update(self, now: float) -> Pose:
        """Move on to `now`, seconds that never decrease, and return the pose there (rotations `[J, 4]`, translations `[J, 3]`)."""
        before, self.now = self.now, max(self.now, now)
        end = self.plan.end if self.plan.end >= self.now + self._ahead - SLACK else self.now + self._ahead
        if self._asked or end > self.plan.end:
            asked, self._asked = self._asked, []
            self.plan = hear(self.project, self.plan, self.now, asked, end, self._stances, self._idle)
        if self.now >= self._cut + CUT:
            self._cut, self.plan = self.now, since(self.plan, self.now - self._recent)
        self._events = tuple(self._happened(before))
        return self.pose()

    def _happened(self, before: float) -> list[Happening]:
        out = []
        for layer in LAYERS:
            for cue in self.plan.layers[layer].cues:
                meta = cue.meta.partition("+")[0]
                if before < cue.start <= self.now or (cue.start == before == 0.0 < self.now):
                    out.append(Happening("begin", cue.start, layer, cue.action.name, meta))
                if before < cue.end <= self.now:
                    out.append(Happening("end", cue.end, layer, cue.action.name, meta))
        return sorted(out, key=lambda event: event.at)

    def events(self) -> tuple[Happening, ...]:
        """Return what began and ended between the last two updates, in order."""
        return self._events

    def answer(self, ident: str) -> Answer:
        """Say what became of a request: when it plays, or why it does not."""
        if ident in self._refused:
            return Answer(ident, "refused", None, None, (), self._refused[ident])
        if any(ask.id == ident for ask in self._asked):
            return Answer(ident, "planned", None, None, (), "worked in at the next update")
        return answer(self.plan, ident)

    def pose(self, alive: bool = True) -> Pose:
        """Return the pose at the time of the last update; alive: with the life layers."""
        return pose_at(self.plan, self.project, self.now, alive)

    def morphs(self, alive: bool = True) -> dict[str, float]:
        """Return the morph target weights, 0..1, at the time of the last update."""
        return morphs_at(self.plan, self.project, self.now, alive)
