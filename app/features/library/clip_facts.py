"""What is known of clips beyond the project itself: what they move, and how many problems they are in."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable

from app.project.document import Document
from app.translation import tr
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.graph.clip_mark import ClipMark
from metagraph.graph.editing.half_labels import find_half_label, has_half_label
from metagraph.graph.editing.marks import mark_of
from metagraph.graph.model import Action, ClipEntry, Project
from metagraph.graph.problem import Problem
from metagraph.motion.clip import Clip
from metagraph.motion.moving import find_moved_parts


class ClipFacts:
    """problems: those of the project as it is now. What a clip moves is worked out once, when it is asked
    for; `ahead` does so before.
    """

    def __init__(self, document: Document, problems: Callable[[], Iterable[Problem]] = lambda: ()) -> None:
        self.document = document
        self._problems = problems
        self._moved: dict[str, tuple[Clip, tuple[str, ...]]] = {}
        self._listed: tuple[object, object, Counter[str]] = (None, None, Counter())

    @property
    def project(self) -> Project:
        return self.document.project

    def moved(self, entry: ClipEntry) -> tuple[str, ...]:
        """Return the parts of the body that a clip moves; nothing if its file is missing."""
        motion = entry.motion
        if motion is None:
            return ()
        found = self._moved.get(entry.id)
        if found is None or found[0] is not motion:
            found = self._moved[entry.id] = motion, find_moved_parts(motion)
        return found[1]

    def moved_words(self, entry: ClipEntry) -> str:
        """Return in words what a clip moves, with commas between."""
        return ", ".join(
            tr("position") if part == "place" else get_vocabulary_word(part) for part in self.moved(entry)
        )

    def ahead(self, entries: Iterable[ClipEntry]) -> None:
        """Work out what clips move."""
        for entry in entries:
            self.moved(entry)

    def unknown(self) -> list[ClipEntry]:
        """Return the clips of which it is not known what they move."""
        return [e for e in self.project.clips.values() if e.motion is not None and e.id not in self._moved]

    def uses(self, entry: ClipEntry) -> tuple[Action, ...]:
        return self.project.uses.get(entry.id, ())

    def mark(self, entry: ClipEntry) -> ClipMark:
        return mark_of(self.project, entry.id)

    def missing(self, entry: ClipEntry) -> str:
        """Return what a half labelled clip waits for, with a question mark; "" for others."""
        if not has_half_label(self.project, entry.id):
            return ""
        known = find_half_label(self.project, entry.id)
        if not known.kind:
            return tr("kind?")
        return tr("stance?") if known.kind != "transition" or not known.stance else tr("end?")

    def place(self, entry: ClipEntry) -> int:
        """Return the how manieth clip of the project it is, from 1: in the order they were added."""
        clips = self.project.clips
        if self._places[0] is not clips:
            self._places = clips, {clip: n for n, clip in enumerate(clips, 1)}
        return self._places[1].get(entry.id, 0)

    _places: tuple[object, dict[str, int]] = (None, {})

    def problems(self, entry: ClipEntry) -> int:
        """Return in how many problems a clip is, by itself or by an action that uses it."""
        found, graphs = self._problems(), self.project.graphs
        if self._listed[0] is not found or self._listed[1] is not graphs:
            count: Counter[str] = Counter()
            for problem in found:
                action = self.project.action(problem.action) if problem.action else None
                clip = problem.clip or (action.clip if action is not None else None)
                if clip:
                    count[clip] += 1
            self._listed = found, graphs, count
        return self._listed[2][entry.id]
