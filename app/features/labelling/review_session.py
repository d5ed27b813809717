"""Review proposals on a document: make proposals again after corrections, learn from corrections, place
clips, undo, and bridge stances that no clip leads to.
"""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QElapsedTimer, QObject, QTimer, Signal

from app.project.document import Document
from app.project.jobs import Jobs, WindowJob
from app.project.learned import Learned
from app.translation import tr, tr_error
from metagraph.graph.model import Kind, Project
from metagraph.suggest.accept import AcceptedProposals
from metagraph.suggest.jumps.bridges import (
    bridge_all,
    describe_bridges,
    describe_unbridged,
    find_missing_bridges,
)
from metagraph.suggest.left_aside import group_reasons, take_up_skipped
from metagraph.suggest.proposal import Proposal, Proposals
from metagraph.suggest.propose import list_waiting_clips, propose
from metagraph.suggest.review import Field, Review, ReviewPace

REST = 400  # milliseconds of quiet after a correction before the rest is proposed again


class Reviewing(QObject):
    """A review. clips: all of its clips, in order. aside: the skipped ones. parted: signals stances that
    bridges can join, after many clips were placed. found: signals the first proposals. changed: signals
    changed proposals or placements. failed: signals an error in words.
    """

    found = Signal()
    changed = Signal()
    failed = Signal(str)

    def __init__(
        self, document: Document, jobs: Jobs, learned: Learned, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.document, self.jobs, self.learned = document, jobs, learned
        self.review, self.pace = Review(Proposals({}, {})), ReviewPace()
        self.clips: tuple[str, ...] = ()
        self.aside: tuple[str, ...] = ()
        self.parted: tuple[str, ...] = ()
        self.unbridged: tuple[str, ...] = ()  # why stances cannot be joined by blending, in words
        self._looks_for_parted = False
        self.looked = False  # whether proposals have come
        # One per undo step: the clip placed; None for many at once; for a correction of many, the review
        # before it and their clips.
        self._steps: list[str | tuple[Review, tuple[str, ...]] | None] = []
        self._clock = QElapsedTimer()
        self._anew = QTimer(self, singleShot=True, interval=REST)
        self._anew.timeout.connect(self._propose_anew)
        document.changed.connect(self._edited)

    def start(self) -> None:
        """Propose labels for the clips that are not placed yet, on a thread."""
        project = self.document.project
        self.jobs.start(
            tr("Proposing labels"), lambda job: self._proposals(project, None, job), self._first, self._failed
        )

    def _first(self, found: Proposals) -> None:
        self.review = Review(found).settled(self.document.project)
        entries = self.document.project.clips
        self.clips = tuple(c for c in self.review.order() if c in entries)
        self.aside = tuple(
            c for _, clips in group_reasons(found.aside) for c in clips if c in entries and c in found.spare
        )
        self.looked = True
        self.found.emit()

    def _failed(self, error: Exception) -> None:
        self.failed.emit(tr_error(error))

    def _proposals(self, project: Project, clips: list[str] | None, job: WindowJob) -> Proposals:
        """Propose, with what was learned from other projects; on a job's thread."""
        patterns, examples = self.learned.patterns, self.learned.examples_for(self.document)
        return propose(project, clips, patterns, examples, cancelled=lambda: job.cancelled, progress=job.tell)

    def _propose_anew(self) -> None:
        """Look again at what is left, with what was just learned."""
        project, waiting = self.document.project, self.waiting()
        if waiting:
            self.jobs.start(
                "labels anew",
                lambda job: self._proposals(project, waiting, job),
                self._again,
                self._failed,
                quick=True,
            )

    def _again(self, found: Proposals) -> None:
        mine = self.review.found  # what has a proposal is not skipped any more, whatever is learned
        aside = {c: why for c, why in found.aside.items() if c not in mine.proposals}
        found = replace(found, aside=aside, spare={**mine.spare, **found.spare})
        self.review = self.review.anew(found).settled(self.document.project)
        self.changed.emit()

    # --- what is left

    def waiting(self) -> list[str]:
        """Return the clips that are not placed yet, in order. A clip that only lends a stance a still moment
        counts as placed.
        """
        there = set(list_waiting_clips(self.document.project))
        return [c for c in self.clips if c in there]

    def sure_ones(self, least: float) -> list[str]:
        """Return the waiting clips that are at least this certain and not disputed."""
        proposals = self.review.found.proposals
        return [c for c in self.waiting() if proposals[c].confidence >= least and not proposals[c].conflicts]

    def after(self, clip: str | None) -> str | None:
        """Return the next waiting clip, starting over after the last one, or None."""
        at = self.clips.index(clip) if clip in self.clips else -1
        waiting = set(self.waiting())
        return next((c for c in (*self.clips[at + 1 :], *self.clips[: at + 1]) if c in waiting), None)

    def open_after(self, clip: str | None) -> str | None:
        """Return the next waiting or skipped clip, starting over after the last one."""
        every, there = (*self.clips, *self.aside), set(list_waiting_clips(self.document.project))
        at = every.index(clip) if clip in every else -1
        return next((c for c in (*every[at + 1 :], *every[: at + 1]) if c in there), None)

    def before(self, clip: str | None) -> str | None:
        """Return the clip before, whether it is placed or not."""
        there = [c for c in (*self.clips, *self.aside) if c in self.document.project.clips]
        return there[max(0, there.index(clip) - 1)] if clip in there else next(iter(there), None)

    # --- deciding

    def look_at(self) -> None:
        """Start the time of a decision."""
        self._clock.restart()

    def tell(self, clip: str, name: Field, value: object) -> None:
        """Correct a field of a clip's proposal; the project changes when it is placed."""
        self.review = self.review.tell(clip, name, value)
        self.changed.emit()

    def tell_all(self, clips: list[str], name: Field, value: object) -> None:
        """Correct a field of the proposals of several clips, if they have it, as one step. Then find their
        times on a thread.
        """
        now, changed = self.review, list[str]()
        for clip in clips:
            possible = value in [choice for choice, _ in now.choices(clip, name)]
            if possible and now.value(clip, name) != value:
                now = now.tell(clip, name, value)
                changed.append(clip)
        if not changed:
            return
        self._steps.append((self.review, tuple(changed)))
        self.review = now
        self.changed.emit()
        project = self.document.project

        def found(times: list[Proposal]) -> None:
            for p in times:
                self.review = self.review.with_times(p)
            self.changed.emit()

        self.jobs.start(
            "times of many", lambda _: now.timed_all(project, changed), found, self._failed, quick=True
        )

    def take_up(self, clip: str, kind: Kind) -> None:
        """Take a skipped clip into the review, as a kind."""
        self.review = Review(take_up_skipped(self.review.found, clip), self.review.said).tell(
            clip, "kind", kind
        )
        self.clips = (*self.clips, clip)
        self.aside = tuple(c for c in self.aside if c != clip)
        self.changed.emit()

    def times_found(self, p: Proposal) -> None:
        """Use the times that were found after a correction."""
        self.review = self.review.with_times(p)
        self.changed.emit()

    def place(self, clips: list[str], words: str, step: str | None) -> AcceptedProposals:
        """Place clips as proposed and corrected, as one undo step with this name. step: the clip under
        review, or None for several.
        """
        review, project = self.review, self.document.project
        late = [c for c in clips if c in review.said and not review.found.proposals[c].timing]
        for p in review.timed_all(project, late) if late else ():  # accepted before its times were found
            review = review.with_times(p)
        taken = review.take(project, clips)
        if not taken.placed:
            return taken
        if step is not None:
            self.pace.decided(self._clock.elapsed() / 1000)
        self._steps.append(step)
        self.document.edit(words, lambda p: taken.project if p is project else review.take(p, clips).project)
        if self.document.project is project:
            self._steps.pop()  # it was placed just so already
        self._learn(clips)
        if step is None:
            self._looks_for_parted = True
            self._look_for_parted()
        return taken

    def _look_for_parted(self) -> None:
        """Look for stances that no clip leads to or from, even with the rest placed; on a thread."""
        project, review, rest = self.document.project, self.review, self.waiting()

        def found(_: object) -> tuple[list[str], list[str]]:
            now, never = find_missing_bridges(project), describe_unbridged(project)
            if (now or never) and rest:
                then = review.take(project, rest).project
                now = [stance for stance in find_missing_bridges(then) if stance in now] if now else now
                never = [words for words in describe_unbridged(then) if words in never] if never else never
            return now, never

        def done(made: tuple[list[str], list[str]]) -> None:
            parted, unbridged = (tuple(some) for some in made)
            if project is self.document.project and (parted, unbridged) != (self.parted, self.unbridged):
                self.parted, self.unbridged = parted, unbridged
                self.changed.emit()

        self.jobs.start("parted stances", found, done, self._failed, quick=True)

    def bridge(self) -> tuple[str, ...]:
        """Join the stances that no clip leads to or from by blending, as one undo step; return what was made,
        in words. `unbridged` says which stances cannot be joined.
        """
        after, made = bridge_all(self.document.project)
        if made:
            self._steps.append(None)
            self.document.edit(tr("Bridge by blending"), lambda p: bridge_all(p)[0])
        return tuple(describe_bridges(after, made))

    def _learn(self, clips: list[str]) -> None:
        """Remember what was corrected of clips that are now placed, and look at the rest again."""
        entries = self.document.project.clips
        names = [entries[c].name for c in self.clips if c in entries]
        corrected = [
            (c, name, value)
            for c in clips
            for name, value in self.review.said.get(c, {}).items()
            if name != "timing"
        ]
        told = [(entries[clip].name, name, value) for clip, name, value in corrected]
        self.learned.correct_all(told, names)
        if corrected:
            self._anew.start()

    @property
    def can_undo(self) -> bool:
        return bool(self._steps)

    def undo(self) -> str | None:
        """Undo the last step, and return the clip to review again."""
        step = self._steps.pop()
        if isinstance(step, tuple):
            self.review = self.review.with_former(*step).settled(self.document.project)
            self.changed.emit()
            return next(iter(self.waiting()), None)
        self.document.undo()
        return step if step is not None else next(iter(self.waiting()), None)

    def _edited(self, before: Project, after: Project) -> None:
        self.review = self.review.settled(after)
        if self._looks_for_parted and before.graphs is not after.graphs:
            self._look_for_parted()
        self.changed.emit()
