"""Going through proposals on the character: one clip after another, out of its stance and back; Enter
accepts, a key corrects.

The keyboard alone is enough; the mouse can do the same. Every clip is one undo step.
"""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import Any

from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QDialog,
    QFrame,
    QHBoxLayout,
    QInputDialog,
    QLabel,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QSplitter,
    QVBoxLayout,
    QWidget,
)

from app.features.labelling import review_words
from app.features.labelling.proposal_preview import Span, make_trial
from app.features.labelling.review_fields import ReviewFields, ReviewRow
from app.features.labelling.review_queue import ReviewQueue
from app.features.labelling.review_session import Reviewing
from app.features.labelling.review_stage import ReviewStage
from app.features.labelling.review_watch import Watching
from app.look.theme import get_theme, strengthen
from app.project.document import Document
from app.project.jobs import Jobs
from app.project.learned import Learned
from app.stage.figures import Figures
from app.stage.playback_source import ShownPlayback, play_clip_alone
from app.stage.session import StageSession
from app.stage.thumbnails import Thumbnails
from app.translation import make_lazy_texts, tr, tr_error, tr_phrase
from app.widgets.vocabulary import get_vocabulary_word
from metagraph.graph.model import KINDS, Kind
from metagraph.suggest.proposal import Proposal
from metagraph.suggest.review import DECIDING, Field, Review

TITLES: dict[str, str] = make_lazy_texts(
    lambda: {
        "kind": tr("Kind"),
        "layer": tr("Layer"),
        "stance": tr("Stance"),
        "end_stance": tr("Ends in"),
        "limb": tr("Arm"),
    }
)
LARGEST = QSize(1380, 850)  # pixels, where the window is that large
FRAME = 1 / 30  # seconds a step goes
LEAST = 2 / 30  # seconds a clip keeps at least


def name_choices(name: Field, choices: list[tuple[Any, str]]) -> list[tuple[Any, str]]:
    """Return choices in the window's words; stances are called as the user calls them."""
    return [(v, get_vocabulary_word(w)) for v, w in choices] if name in ("kind", "layer", "limb") else choices


_Tried = tuple[
    int, Proposal | None, ShownPlayback, Span | None
]  # the trial's number, the times found, what plays


class ReviewDialog(QDialog):
    """current: the clip that is looked at. row: the field that keys correct."""

    def __init__(
        self,
        document: Document,
        session: StageSession,
        jobs: Jobs,
        figures: Figures,
        learned: Learned,
        thumbnails: Thumbnails,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.document, self.session, self.jobs = document, session, jobs
        self.thumbnails = thumbnails
        self.work = Reviewing(document, jobs, learned, self)
        self.current: str | None = None
        self.row: Field = "kind"
        self.context = True  # the clip plays out of its stance and back, not alone
        self._trials = self._seen = 0
        self._bridged: tuple[str, ...] = ()
        if session.transport.playing:
            session.transport.set_playing(False)  # one character at a time
            self.finished.connect(lambda _: session.transport.set_playing(True))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Label clips"))
        self.resize(LARGEST if parent is None else LARGEST.boundedTo(parent.window().size()))
        self.queue = ReviewQueue(session, self)
        self.stage = ReviewStage(session, figures, self)
        self.fields = ReviewFields(session, self)
        self._build()
        self.watching = Watching(self._watch)
        self.stage.played.connect(self._played)
        self.queue.picked.connect(self.go_to)
        self.queue.sure_wanted.connect(self.accept_sure)
        self.queue.limit_changed.connect(self._count)
        self.queue.groups_wanted.connect(self.review_groups)
        self.queue.bridge_wanted.connect(self.bridge)
        self.fields.chosen.connect(self._choose)
        self.fields.picked.connect(self._pick)
        self.work.found.connect(self._begin)
        self.work.changed.connect(self._refresh)
        self.work.failed.connect(self._failed)
        session.look.changed.connect(self._restyle)
        self._keys = self._key_table()
        self._restyle()
        self.work.start()

    @property
    def review(self) -> Review:
        return self.work.review

    # --- building

    def _build(self) -> None:
        self.legend = QLabel(self)
        self.legend.setWordWrap(True)
        self.legend.setTextFormat(Qt.TextFormat.RichText)
        self.legend.setAlignment(Qt.AlignmentFlag.AlignCenter)
        middle = QWidget(self)
        centre = QVBoxLayout(middle)
        centre.setContentsMargins(4, 12, 4, 10)
        centre.addWidget(self.stage, 1)
        centre.addWidget(self.legend)
        split = QSplitter(Qt.Orientation.Horizontal, self)
        split.setChildrenCollapsible(False)
        for part, least in ((self.queue, 230), (middle, 360), (self._side(), 360)):
            split.addWidget(part)
            part.setMinimumWidth(least)
        split.setSizes([290, 660, 430])
        split.setStretchFactor(1, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(split)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        for field in (self.queue.limit, self.tags):
            field.installEventFilter(self)
        self.setFocus()

    def _side(self) -> QWidget:
        """The right side: the fields, and what is done with them."""
        self.tags = QLineEdit(self)
        self.tags.setAccessibleName(tr("Tags"))
        self.tags.setPlaceholderText(tr("none"))
        self.tags.setToolTip(tr("Tags by which a request can ask for the action, separated by commas (T)"))
        self.tags.editingFinished.connect(self._tag)
        label = QLabel(tr("Tags"), self)
        label.setProperty("dim", True)
        label.setFixedWidth(72)
        line = QHBoxLayout()
        line.setContentsMargins(12, 6, 12, 6)
        line.addWidget(label)
        line.addWidget(self.tags, 1)
        self.timing = QLabel(self)
        self.timing.setWordWrap(True)
        self.timing.setTextFormat(Qt.TextFormat.RichText)
        self.timing.setContentsMargins(12, 4, 12, 0)
        self.timing.setProperty("dim", True)
        inner = QWidget(self)
        column = QVBoxLayout(inner)
        column.setContentsMargins(0, 0, 6, 0)
        column.addWidget(self.fields)
        column.addLayout(line)
        column.addWidget(self.timing)
        column.addStretch(1)
        scroll = QScrollArea(self)
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        scroll.setWidget(inner)
        self.back, self.shut, self.go = (
            QPushButton(tr("Undo"), self),
            QPushButton(tr("Close"), self),
            QPushButton(tr("Accept"), self),
        )
        for button, run in ((self.back, self.undo), (self.shut, self.close), (self.go, self.accept_current)):
            button.setAutoDefault(False)
            button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            button.clicked.connect(run)
        strengthen(self.go)
        self.go.setMinimumWidth(120)
        buttons = QHBoxLayout()
        buttons.addWidget(self.back)
        buttons.addWidget(self.shut)
        buttons.addStretch(1)
        buttons.addWidget(self.go)
        out = QWidget(self)
        side = QVBoxLayout(out)
        side.setContentsMargins(4, 12, 12, 12)
        side.addWidget(scroll, 1)
        side.addLayout(buttons)
        return out

    def _restyle(self) -> None:
        self.legend.setText(review_words.format_keys(get_theme(self.session.look.name)))
        self._refresh()

    # --- where it is

    def _begin(self) -> None:
        self.queue.fill(self.work.clips, self.work.aside)
        self._refresh()
        self.go_to(self.work.after(None))

    def go_to(self, clip: str | None) -> None:
        """Look at a clip; None when nothing is left to look at."""
        self.current = clip
        if clip is not None:
            self.row = "kind" if clip in self.work.aside else self.review.doubtful(clip)
            self.queue.go_to(clip)
        self.work.look_at()
        self._show()
        self._play()

    def watch(self) -> None:
        """Watch what waits, one after another; or stop, and accept what was watched."""
        if self.watching.on:
            self._accept_watched()
        elif waiting := self.work.waiting():
            self.context = False
            self.watching.begin(self.review, waiting)

    def _played(self) -> None:
        if self._seen == self._trials:  # not the one before, which plays until this one is planned
            self.watching.played(self.current)

    def _watch(self, clip: str | None) -> None:
        self.go_to(clip)
        self.queue.words.setText(self.watching.words(clip))

    def _accept_watched(self) -> None:
        clips = self.watching.stop()
        self.context = True
        if clips:
            self._place(clips, tr("Label {clips} clips", clips=len(clips)), None)
        else:
            self.go_to(self.work.after(None))

    def _later(self) -> None:
        if self.watching.on and self.current is not None:
            self.watching.skip(self.current)
            return
        self.go_to(self.work.open_after(self.current))

    def _earlier(self) -> None:
        self.watching.hold()
        self.go_to(self.work.before(self.current))

    # --- correcting

    @property
    def _proposed(self) -> Proposal | None:
        """What the current clip is taken for; None if there is none, or it was skipped."""
        return self.review.found.proposals.get(self.current or "")

    def _tell(self, name: Field, value: Any) -> None:
        if self.current is not None:
            self.watching.hold()
            self.work.tell(self.current, name, value)
            self._play()

    def _pick(self, name: Field) -> None:
        self.row = name
        self._show()

    def _choose(self, name: Field, value: Any) -> None:
        """Take a value for a field of the current clip."""
        self.row = name
        if self.current in self.work.aside:
            if name == "kind":
                self._take_up(self.current, value)
            return
        if self.current is not None and value != self.review.value(self.current, self.row):
            self._tell(self.row, value)
        self._show()

    def _take_up(self, clip: str, kind: Kind) -> None:
        """Label a clip that was skipped."""
        self.work.take_up(clip, kind)
        self.queue.fill(self.work.clips, self.work.aside)
        self._refresh()
        self.go_to(clip)

    def _turn(self, step: int) -> None:
        """Take the next or the previous value of the current field."""
        if self.current is None:
            return
        values = [v for v, _ in self._choices(self.row)]
        if values:
            now = self.review.value(self.current, self.row) if self._proposed is not None else None
            self._choose(
                self.row, values[(values.index(now) + step) % len(values)] if now in values else values[0]
            )

    def _choices(self, name: Field) -> list[tuple[Any, str]]:
        """Return what a field of the current clip may be."""
        if self._proposed is None or self.current is None:
            return [(k, k) for k in KINDS]
        return self.review.choices(self.current, name)

    def _move(self, step: int) -> None:
        names = [row.name for row in self.fields.rows]
        if names:
            self._pick(names[(names.index(self.row) + step) % len(names)])

    def _number(self, place: int) -> None:
        if self.current is not None:
            choices = self._choices(self.row)
            if place < len(choices):
                self._choose(self.row, choices[place][0])

    def _tag(self) -> None:
        p = self._proposed
        if p is None:
            return
        tags = tuple(
            dict.fromkeys(t for word in self.tags.text().split(",") if (t := " ".join(word.split())))
        )
        if tags != (p.tags.value if p.tags is not None else ()):
            self._tell("tags", tags)

    def _cut(self, name: str) -> None:
        """Let the clip start or end at what is just seen."""
        shown, span = self.stage.shown, self.stage.strip.span
        p = self._proposed
        if self.current is None or shown is None or p is None:
            return
        old, length = (
            p.timing,
            self.document.project.clips[self.current].duration,
        )
        start, end = float(old.get("start") or 0.0), float(old.get("end") or length)
        seen = self.stage.seconds if span is None else self.stage.seconds - span.start + start
        seconds = (
            min(max(0.0, seen), end - LEAST) if name == "start" else min(max(seen, start + LEAST), length)
        )
        self._tell("timing", {name: round(seconds, 3)})

    def _find_stance(self) -> None:
        """Ask for a stance by typing: one that is there, or the name of a new one."""
        if self._proposed is None:
            return
        name: Field = "end_stance" if self.row == "end_stance" else "stance"
        choices = self._choices(name)
        words, ok = QInputDialog.getItem(
            self,
            tr("Find or add a stance"),
            tr("Stance it ends in, or a new name:") if name == "end_stance" else tr("Stance, or a new name:"),
            ["", *(words for _, words in choices)],
        )
        plain = " ".join(words.split())
        if ok and plain:
            known = {words.casefold(): value for value, words in choices}
            self._choose(name, known.get(plain.casefold(), plain))

    def _toggle_context(self) -> None:
        self.context = not self.context
        self._play()

    def _edit_tags(self) -> None:
        self.tags.setFocus()
        self.tags.selectAll()

    # --- accepting

    def accept_current(self) -> None:
        """Place the clip as it is shown, and go on; close when nothing is left. While clips are watched it
        only goes on, and after the last all are placed.
        """
        if self.watching.on and self.current is not None:
            self.watching.go_on(self.current)
        elif self.watching.on:
            self._accept_watched()
        elif self.current is None:
            self.close()
        elif self._proposed is None:
            self._later()
        else:
            self._place(
                [self.current],
                tr("Label {name}", name=self.document.project.clips[self.current].name),
                self.current,
            )

    def accept_sure(self) -> None:
        """Place all that wait, are as sure as wanted, and are not disputed, as one step."""
        if clips := self.work.sure_ones(self.queue.least):
            self._place(clips, tr("Label {clips} clips", clips=len(clips)), None)

    def _place(self, clips: list[str], words: str, step: str | None) -> None:
        taken = self.work.place(clips, words, step)
        why = next(iter(taken.left.items()), None)
        if not taken.placed:
            self.stage.tell(
                tr(
                    "<b>Not placed:</b> {why}.",
                    why=escape(
                        tr_phrase(why[1]) if why is not None else tr("the clip is no longer in the project")
                    ),
                )
            )
            return
        self.go_to(self.work.after(self.current))
        if unexpected := review_words.describe_placing(taken, clips):
            self.queue.words.setText(unexpected)

    def review_groups(self) -> None:
        """Show clips with the same proposal side by side, and accept them together."""
        from app.features.labelling.groups_dialog import GroupsDialog

        if self.work.waiting():
            self.watching.stop()
            self.context, self.stage.playing = True, False
            dialog = GroupsDialog(self.work, self.session, self.thumbnails, self)
            dialog.opened.connect(self.go_to)
            dialog.finished.connect(lambda _: self._go_on())
            dialog.open()

    def _go_on(self) -> None:
        """Look at the clip that was looked at, or at the next if that is placed by now."""
        waiting = self.work.waiting()
        self.go_to(self.current if self.current in waiting else next(iter(waiting), None))

    def bridge(self) -> None:
        """Join the stances that no clip leads to or back from by blending."""
        if self.work.parted:
            self._bridged = self.work.bridge()
            self._count()
        else:
            self.queue.say_nothing_to_bridge()

    def undo(self) -> None:
        """Take the last step back, and look at that clip again."""
        if self.work.can_undo:
            self._bridged = ()
            self.go_to(self.work.undo())

    # --- showing

    def _refresh(self) -> None:
        self.queue.refresh(self.review, self.document.project)
        self._count()
        self._show()

    def _count(self) -> None:
        if self.work.looked:
            self.queue.count(
                len(self.work.waiting()), len(self.work.sure_ones(self.queue.least)), self.work.pace
            )
        project = self.document.project
        names = [s.name for i in self.work.parted if (s := project.stance(i)) is not None]
        made = self._bridged if not names and any(self._bridged) else ()
        self.queue.part(names, made, self.work.unbridged)
        self.back.setEnabled(self.work.can_undo)

    def _show(self) -> None:
        """Show what the current clip is taken for."""
        clip, project = self.current, self.document.project
        p = self._proposed
        self.go.setText(tr("Done") if clip is None else tr("Accept") if p is not None else tr("Skip"))
        self.tags.setEnabled(p is not None)
        if clip is None or clip not in project.clips:
            self.fields.show_rows((), "")
            self.timing.setText("")
            self.tags.setText("")
            done = (
                tr("<b>All clips are placed.</b>")
                if not self.work.aside
                else review_words.describe_skipped(self.work.aside)
            )
            done = self.watching.words(None) if self.watching.on else done
            self.stage.tell(done if self.work.looked else tr("Analysing names and motion…"))
            return
        if p is None:
            why = tr_phrase(self.review.found.aside.get(clip, ""))
            kinds = self._choices("kind")
            self.row = "kind"
            self.fields.show_rows(
                [ReviewRow("kind", TITLES["kind"], name_choices("kind", kinds), None, 0.0, why)], self.row
            )
            self.timing.setText(review_words.ANYWAY)
            self.tags.setText("")
            self.stage.tell(
                review_words.write_headline(self.review, project, clip, get_theme(self.session.look.name))
            )
            return
        rows = []
        for name in DECIDING:
            if choices := self.review.choices(clip, name):
                belief = getattr(p, name)
                sure, reason = (
                    (belief.confidence, tr_phrase(belief.reason))
                    if belief is not None
                    else (0.0, tr("neither the name nor the motion says which"))
                )
                rows.append(
                    ReviewRow(
                        name,
                        TITLES[name],
                        name_choices(name, choices),
                        self.review.value(clip, name),
                        sure,
                        reason,
                        p.kind.value,
                    )
                )
        if self.row not in {row.name for row in rows}:
            self.row = "kind"
        self.fields.show_rows(rows, self.row)
        if self.focusWidget() is not self.tags:
            self.tags.setText(", ".join(p.tags.value) if p.tags is not None else "")
        self.timing.setText(review_words.describe_proposed_times(p, project.clips[clip].duration))
        self.stage.tell(
            review_words.write_headline(self.review, project, clip, get_theme(self.session.look.name))
        )

    def _play(self) -> None:
        """Plan the clip as it would be placed, on a thread, and play it."""
        clip, project, review, context = self.current, self.document.project, self.review, self.context
        self._trials += 1
        number = self._trials
        if clip is None or clip not in project.clips:
            self.stage.play(None, None)
            return

        def work(_: object) -> _Tried:
            times = review.timed(project, clip) if clip in review.said else None
            ready = review.with_times(times) if times is not None else review
            return (
                (number, times, *make_trial(project, ready, clip))
                if context and clip in review.found.proposals
                else (number, times, play_clip_alone(project, clip), None)
            )

        self.jobs.start("trial", work, self._tried, self._failed, quick=True)

    def _tried(self, made: _Tried) -> None:
        number, times, shown, span = made
        if number == self._trials:
            self._seen = number
            self.stage.play(shown, span)
            if times is not None:
                self.work.times_found(times)

    def _failed(self, error: object) -> None:
        self.stage.tell(escape(tr_error(error)))

    # --- keys

    def _key_table(self) -> dict[int, Callable[[], object]]:
        k, stage = Qt.Key, self.stage
        table: dict[int, Callable[[], object]] = {
            k.Key_Return: self.accept_current,
            k.Key_Enter: self.accept_current,
            k.Key_Backspace: self.undo,
            k.Key_A: self.accept_sure,
            k.Key_B: self.bridge,
            k.Key_G: self.review_groups,
            k.Key_W: self.watch,
            k.Key_Up: lambda: self._move(-1),
            k.Key_Down: lambda: self._move(1),
            k.Key_Left: lambda: self._turn(-1),
            k.Key_Right: lambda: self._turn(1),
            k.Key_Tab: self._later,
            k.Key_Backtab: self._earlier,
            k.Key_PageDown: self._later,
            k.Key_PageUp: self._earlier,
            k.Key_Space: stage.toggle,
            k.Key_Home: stage.replay,
            k.Key_C: self._toggle_context,
            k.Key_N: self._find_stance,
            k.Key_T: self._edit_tags,
            k.Key_BracketLeft: lambda: self._cut("start"),
            k.Key_BracketRight: lambda: self._cut("end"),
            k.Key_Comma: lambda: stage.step(-FRAME),
            k.Key_Period: lambda: stage.step(FRAME),
        }
        return table | {k.Key_1 + n: lambda n=n: self._number(n) for n in range(9)}

    def event(self, event: QEvent) -> bool:
        # Tab would go from widget to widget.
        if (
            event.type() == QEvent.Type.KeyPress
            and isinstance(event, QKeyEvent)
            and event.key() in (Qt.Key.Key_Tab, Qt.Key.Key_Backtab)
        ):
            self.keyPressEvent(event)
            return True
        return super().event(event)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Give the keys back when a field is done."""
        done = (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Escape, Qt.Key.Key_Tab)
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent) and event.key() in done:
            if event.key() == Qt.Key.Key_Escape and watched is self.tags and (p := self._proposed):
                belief = p.tags
                self.tags.setText(", ".join(belief.value) if belief is not None else "")
            self.setFocus()
            return True
        return super().eventFilter(watched, event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        control = (
            Qt.KeyboardModifier.ControlModifier
            | Qt.KeyboardModifier.AltModifier
            | Qt.KeyboardModifier.MetaModifier
        )
        if event.matches(QKeySequence.StandardKey.Undo):
            self.undo()
        elif not event.modifiers() & control and (run := self._keys.get(event.key())) is not None:
            run()
        else:
            super().keyPressEvent(event)  # Esc closes
