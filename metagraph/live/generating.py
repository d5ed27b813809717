"""Generate motion of a live session from the sound that it hears, by a learned model or a motion graph."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from metagraph.errors import FileError
from metagraph.graph.model import Project
from metagraph.live.generated_motion import GeneratedMotion
from metagraph.live.graph_motion import MOST_TOLD, GraphMotion, KeptMotion, LiveGraph
from metagraph.live.laid_motion import LaidMotion
from metagraph.live.messages import Generate, Hear, Reply, round_seconds
from metagraph.playback.plan import Plan
from metagraph.playback.posing.overlay import Overlay

if TYPE_CHECKING:
    from metagraph.generation.stored import Model

KEPT = 100  # pieces of motion of a session that can be made again


class Generating:
    """What of a session is generated. models: names to files, those that clients may choose from. graphs:
    names to motion graphs, in the same way, None while they are being made. kept: of motion that graphs made,
    and that is over.
    """

    def __init__(
        self, models: Mapping[str, Path] | None = None, graphs: Mapping[str, LiveGraph] | None = None
    ) -> None:
        self.models = dict(models or {})
        self.graphs: dict[str, LiveGraph | None] = dict(graphs or {})
        self.motion: LaidMotion | None = None
        self.kept: list[KeptMotion] = []
        self._read: dict[tuple[str, int], Model] = {}

    def answer(self, client: int, message: Generate | Hear, project: Project, now: float) -> Reply:
        """Return the reply to a client's message."""
        if isinstance(message, Hear):
            return self.hear(client, message, now)
        return self.generate(client, message, project, now)

    def generate(self, client: int, message: Generate, project: Project, now: float) -> Reply:
        """Begin, change or end generated motion; return the reply."""
        ident = message.id or None
        if message.model is None:
            before = self.motion
            if before is not None:
                before.end(now)
            return Reply(id=ident, state="done", why="" if before else "nothing was generated")
        motion: LaidMotion
        try:
            if message.model in self.graphs:
                graph = self.graphs[message.model]
                if graph is None:
                    raise ValueError(
                        f"the motion graph '{message.model}' is being made; try again in a moment"
                    )
                motion = GraphMotion(client, message.model, graph, message, project, now)
            else:
                model = self._model(message.model)
                motion = GeneratedMotion(client, message.model, model, message, project, now)
        except (FileError, ValueError) as error:
            return Reply(id=ident, state="refused", why=str(error))
        if self.motion is not None and not self.motion.over(now):
            motion.follow(self.motion)
        self._put(motion)
        return Reply(
            id=ident,
            state="planned",
            at=round_seconds(now + motion.shows),
            layer="arms",
            notes=(motion.note,),
        )

    def _put(self, motion: LaidMotion | None) -> None:
        """Let other motion, or none, follow."""
        if isinstance(self.motion, GraphMotion):
            self.kept = [*self.kept, self.motion.kept()][-KEPT:]
            while len(self.kept) > 1 and sum(len(kept.told) for kept in self.kept) > MOST_TOLD:
                del self.kept[0]
        self.motion = motion

    def hear(self, client: int, message: Hear, now: float) -> Reply:
        """Take in what a client hears; return the reply."""
        ident, motion = message.id or None, self.motion
        if motion is None or motion.ended:
            why = "no motion is being generated; send `generate` first"
        elif motion.client != client:
            why = "another client started the generated motion; only that client may send its speech"
        else:
            why = motion.hear(message, now)
        return Reply(id=ident, state="refused" if why else "done", why=why)

    def reach(self, now: float, plan: Plan, project: Project, clients: Any) -> None:
        """Make what is due. clients: numbers of those that are there; without who asked for it, it ends."""
        motion = self.motion
        if motion is None:
            return
        fits = motion.fits(project)
        if motion.client not in clients or not fits:
            motion.end(now)
        if motion.over(now) or not fits:
            self._put(None)
            return
        motion.reach(now, plan)

    def overlay(self, plan: Plan, project: Project, now: float) -> Overlay | None:
        """Return what is laid over a plan at a time, None for nothing."""
        return None if self.motion is None else self.motion.overlay(plan, project, now)

    def status(self) -> dict[str, Any] | None:
        """Return what is generated now, as it is told to clients."""
        motion = self.motion
        return None if motion is None or motion.ended else motion.status()

    def motions(self) -> tuple[KeptMotion, ...]:
        """Return what the motion that graphs made can be made again of, the last of it last."""
        now = (self.motion.kept(),) if isinstance(self.motion, GraphMotion) else ()
        return (*self.kept, *now)

    def _model(self, name: str) -> Model:
        """Return a model, read once. Raises FileError and ValueError."""
        from metagraph.generation.stored import read_model

        path = self.models.get(name)
        if path is None:
            known = ", ".join([*self.graphs, *self.models][:6])
            there = (
                f"there are {known}"
                if known
                else f"put files of models beside the project, or into '{_folder()}'"
            )
            raise ValueError(f"there is no model '{name[:60]}'; {there}")
        try:
            key = (name, path.stat().st_mtime_ns)
        except OSError:
            key = (name, 0)
        if key not in self._read:
            self._read = {key: read_model(path)}
        return self._read[key]


def _folder() -> str:
    from metagraph.generation.offered import FOLDER

    return FOLDER
