"""Watching clips through: one plays after another, like beside like, each once; a key stops where one is
wrong, and what was watched is accepted together.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from html import escape

from app.translation import tr
from metagraph.graph.model import KINDS, LAYERS
from metagraph.suggest.review import Review


class Watching:
    """on: clips go on by themselves. held: the one that plays stays until it is gone on from. watched: in the
    order they were; skipped: seen, and not to be accepted. go: shows a clip; None when all were watched.
    """

    def __init__(self, go: Callable[[str | None], None]) -> None:
        self.on = self.held = False
        self.watched: list[str] = []
        self.skipped: set[str] = set()
        self._order: list[str] = []
        self._go = go

    def begin(self, review: Review, waiting: Sequence[str]) -> None:
        """Begin with the first that waits. Clips of one stance and kind follow each other: what does not
        belong is seen.
        """
        self._order = order_similar(review, waiting)
        self.watched, self.skipped, self.on, self.held = [], set(), True, False
        self._go(next(iter(self._order), None))

    def stop(self) -> list[str]:
        """Stop, and return what was watched."""
        self.on = self.held = False
        return self.watched

    def played(self, clip: str | None) -> None:
        """A clip has played through: go on, unless it is held."""
        if self.on and not self.held and clip is not None:
            self.go_on(clip)

    def go_on(self, clip: str) -> None:
        """Count a clip as watched, and go to the next."""
        self.held = False
        self.skipped.discard(clip)
        if clip not in self.watched:
            self.watched.append(clip)
        self._on()

    def skip(self, clip: str) -> None:
        """Go to the next without accepting a clip."""
        self.held = False
        self.skipped.add(clip)
        self._on()

    def _on(self) -> None:
        seen = self.skipped.union(self.watched)
        self._go(next((c for c in self._order if c not in seen), None))

    def hold(self) -> None:
        """Stay with the clip that plays."""
        self.held = self.on

    def words(self, clip: str | None) -> str:
        """Say as rich text how far it is, and what the keys do."""
        done, every = len(self.watched), len(self._order)
        if clip is None:
            return tr(
                "<b>Watched {done} of {every}.</b> Press Enter to accept them as shown.",
                done=done,
                every=every,
            )
        state = (
            tr("Paused: correct it, then press Enter to continue")
            if self.held
            else tr("Any correction pauses, Tab skips the clip, W ends and accepts")
        )
        return tr(
            "<b>Watching {number} of {every}</b> &nbsp; {state}",
            number=min(done + 1, every),
            every=every,
            state=escape(state),
        )


def order_similar(review: Review, waiting: Sequence[str]) -> list[str]:
    """Return clips so that such as are taken for the same follow each other, stances before all else."""
    found = review.found.proposals

    def rank(clip: str) -> tuple[int, str, int, str, str]:
        p = found[clip]
        stance = review.value(clip, "stance") or ""
        end = review.value(clip, "end_stance") if p.kind.value == "transition" else ""
        return LAYERS.index(p.layer.value), str(stance), KINDS.index(p.kind.value), str(end), clip

    return sorted((c for c in waiting if c in found), key=rank)
