"""Experts in the real window: one draws by hand in the way that was found to be quickest, one has the clips
labelled and goes through what is proposed.
"""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from dataclasses import asdict, replace
from functools import partial
from typing import Any
from zlib import crc32

from PySide6.QtCore import QPoint, QPointF, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QInputDialog, QLineEdit

from metagraph.graph import edits
from metagraph.graph.edits import guess_limb
from metagraph.graph.manual.machine import ANY
from metagraph.graph.model import LIMBS, Project
from metagraph.playback.action_table import COLUMNS
from metagraph.research.study.machines.by_hand import MachineDrawing, Way, Work, list_works
from metagraph.research.study.machines.counted_fields import FromNames, SetFound, Step
from metagraph.research.study.machines.finding import Words
from metagraph.suggest.review import DECIDING
from tests.app.participant import LEFT, Participant, Task

CONTROL = Qt.KeyboardModifier.ControlModifier
ACROSS, DOWN = 240.0, 96.0  # units a dropped grid takes for each clip
MARGIN = 320.0  # units left free beside the states, where aliases go


class Expert(Participant):
    """Carries out a way of drawing by hand with the window's own events. look: each clip is gone to and played
    in the library, which is not waited for.
    """

    def draw(self, way: Way, look: bool = False) -> None:
        reference = self.given.reference
        some = list_works(reference)
        library = [(c, reference.clips[c].name) for w in some for c in w.clips]
        guessed = {
            c: guess_limb(n) if w.layer == "arms" else "both"
            for w in some
            for c, n in zip(w.clips, w.names, strict=True)
        }
        self.states: dict[str, str] = {}
        self.way, self.chosen = way, frozenset[str]()
        self.searched: str | None = None
        self.looked = 0.0
        self.canvas = self.drive.editor.canvas
        MachineDrawing(way, self, library).draw(some, guessed, look)

    # --- clips

    def begin(self) -> None:
        self.think()
        chip = self.drive.library.chips["unlabelled"]
        self.click(chip, chip.rect().center())

    def layer(self, work: Any) -> None:
        if not isinstance(work, Work):
            super().layer(work)
            return
        super().layer(work.layer)
        count = len(work.clips)
        across = max(2, round(count**0.5) + 1)
        if self.way.pick == "rubber bands":
            across = max(len(b) for b in work.order)
            self.down = len(work.order)
        else:
            self.down = -(-count // across) + 2
        self.room(across + 1, self.down)
        self.at = QPointF(0, 0)

    def room(self, across: int, down: int) -> None:
        """Zoom out, by the wheel, until all that comes has room."""
        from app.features.manual.manual_scene import ManualView

        wide, high = MARGIN + ACROSS * across + 60, DOWN * down + 160
        scale = min(1.0, self.canvas.width() / wide, self.canvas.height() / high)
        self.canvas.look_at(ManualView(scale, -MARGIN, -100.0))
        self.canvas.settle()
        self.think()
        self.scrolls += 1

    def look(self, clip: str) -> None:
        cards = self.drive.library.list
        cards.setFocus()
        QTest.keyClick(cards, Qt.Key.Key_Right)
        QTest.keyClick(cards, Qt.Key.Key_Return)
        self.looked += self.given.project.clips[clip].duration

    def drop(self, work: Any, clips: Any, words: Any = None) -> None:
        if not isinstance(work, Work):
            super().drop(work, clips)
            return
        d, library = self.drive, self.drive.library
        self.think()
        moved = words is not None and words != self.searched and bool(words or self.searched)
        if moved:
            self.thoughts += 1 + words.count(" ") + words.count("|")
            QTest.keyClick(d.window, Qt.Key.Key_F, CONTROL)
            QTest.keyClick(library.search, Qt.Key.Key_A, CONTROL)
            if words:
                QTest.keyClicks(library.search, words)
            else:
                QTest.keyClick(library.search, Qt.Key.Key_Delete)
            d.pause(120)
        self.searched = words if words is not None else self.searched
        name = self.given.reference.clips[clips[0]].name
        if len(clips) > 1:
            if moved:
                QTest.keyClick(library.search, Qt.Key.Key_Down)
            else:
                self.click(*self.card(name))
            QTest.keyClick(library.list, Qt.Key.Key_A, CONTROL)
            assert len(library.list.selectedIndexes()) == len(clips), f"'{words}' shows other clips"
        before = d.document.project
        place = self.canvas.view.to(self._corner(work, clips) + QPointF(98, 32)).toPoint()
        d.drag(self.card(name), (self.canvas, place), lambda: d.document.project is not before)
        found = list(self.canvas.scene().manual.states.values())[-len(clips) :]
        self.states |= {s.clip: s.id for s in found}
        self.chosen = frozenset(s.id for s in found)

    def _corner(self, work: Work, clips: Sequence[str]) -> QPointF:
        """Where the grid of what is dropped begins, in the editor's units."""
        if self.way.pick == "rubber bands":
            n = work.clips.index(clips[0])
            row = next(r for r, block in enumerate(work.order) if n in block)
            return QPointF(work.order[row].index(n) * ACROSS, row * DOWN)
        corner = QPointF(self.at)
        columns = next(n for n in range(1, len(clips) + 1) if n * n >= len(clips))
        self.at += QPointF(0, -(-len(clips) // columns) * DOWN)
        if self.at.y() > (self.down - 1) * DOWN:
            self.at = QPointF(self.at.x() + columns * ACROSS, 0)
        return corner

    # --- selecting

    def select(self, work: Work, want: int, words: Words | None, bands: bool) -> None:
        states = [self.states[c] for n, c in enumerate(work.clips) if want >> n & 1]
        if frozenset(states) == self.chosen:
            return
        self.chosen = frozenset(states)
        clicks = 0.28 * (1 + (len(states) > 1)) + 1.35 + 1.3 * len(states)
        typed = 1.35 * words.terms + 0.28 * (len(words.text) + 2) + 0.8 if words is not None else 1e9
        runs = work.runs(want) if bands else []
        banded = 1.35 + 2.4 * len(runs) + 0.28 * (len(runs) > 1) if runs else 1e9
        if words is not None and typed <= min(clicks, banded):
            self.thoughts += words.terms
            self.canvas.setFocus()
            QTest.keyClick(self.canvas, Qt.Key.Key_Slash)
            QTest.keyClicks(self.drive.editor.search, words.text)
            QTest.keyClick(self.drive.editor.search, Qt.Key.Key_Return)
        elif banded < clicks:
            self.think()
            for n, run in enumerate(runs):
                self._band(work, *run, more=n > 0)
        else:
            self.think()
            for n, state in enumerate(states):
                self._click(state, more=n > 0)
            self.held(len(states))
        found = self.drive.session.selection.states
        if frozenset(found) != self.chosen:
            off = {self.drive.document.project.state(i) for i in self.chosen ^ frozenset(found)}
            where = [(s.name, s.x, s.y) if s is not None else "an alias" for s in off]
            raise AssertionError(f"{len(found)} rather than {len(states)} selected: {where} at {runs}")

    def held(self, count: int) -> None:
        """Count the key that is held down while several are selected."""
        if count > 1:
            QTest.keyClick(self.canvas, Qt.Key.Key_Control)

    def _click(self, state: str, more: bool) -> None:
        at = self.canvas.view.to(self.canvas.scene().nodes[state].center()).toPoint()
        QTest.mouseMove(self.canvas, at)
        keys = CONTROL if more else Qt.KeyboardModifier.NoModifier
        QTest.mouseClick(self.canvas, LEFT, keys, at)

    def _band(self, work: Work, first: int, last: int, more: bool) -> None:
        longest = max(len(work.order[n]) for n in range(first, last + 1))
        view, scene = self.canvas.view, self.canvas.scene()
        low, high, right = first * DOWN - 16, last * DOWN + 70, (longest - 1) * ACROSS + 215
        corners = [
            ((x, y), (right, high if y == low else low)) for x in range(-20, -300, -9) for y in (low, high)
        ]
        corners += [
            ((right + 9.0 * n, y), (-16, high if y == low else low)) for n in range(60) for y in (low, high)
        ]
        corners = [(a, b) for a, b in corners if scene.hit(QPointF(*a), view.scale).area == "nothing"]
        a, b = (view.to(QPointF(*c)).toPoint() for c in corners[0])  # if nothing is
        keys = CONTROL if more else Qt.KeyboardModifier.NoModifier
        QTest.mouseMove(self.canvas, a)
        QTest.mousePress(self.canvas, LEFT, keys, a)
        for part in (0.4, 1.0):
            QTest.mouseMove(self.canvas, a + (b - a) * part)
        QTest.mouseRelease(self.canvas, LEFT, keys, b)
        if more:
            self.held(2)

    # --- links

    def alias(self) -> str:
        self.think()
        before = set(self.canvas.scene().manual.aliases)
        QTest.keyClick(self.canvas, Qt.Key.Key_G, CONTROL)
        (made,) = set(self.canvas.scene().manual.aliases) - before
        self.chosen = frozenset((made,))
        return made

    def link(self, source: str, target: str, many: bool) -> None:
        if not many and self.chosen:
            at = self.canvas.view.to(QPointF(-40, -60)).toPoint()
            self.click(self.canvas, at)
        canvas, view = self.canvas, self.canvas.view
        a = ANY if source == ANY else self.states.get(source, source)
        box, end = canvas.scene().nodes[a], canvas.scene().nodes[self.states[target]].center()
        start = view.to(QPointF(box.right() - 1, box.center().y())).toPoint()
        goal = view.to(end).toPoint()
        assert canvas.rect().contains(start) and canvas.rect().contains(goal), "out of sight"
        self.think()
        before = len(canvas.scene().manual.links)
        QTest.mouseMove(canvas, start)
        QTest.mousePress(canvas, LEFT, pos=start)
        for part in (0.3, 0.7, 1.0):
            QTest.mouseMove(canvas, start + (goal - start) * part)
        QTest.mouseRelease(canvas, LEFT, pos=goal)
        self.wait(lambda: len(canvas.scene().manual.links) > before)
        self.chosen = frozenset()

    def into(self) -> None:
        self.think()
        self.canvas.setFocus()
        QTest.keyClick(self.canvas, Qt.Key.Key_I)
        self.chosen = frozenset()

    def ask(self) -> None:
        self._pick(self.drive.editor.inspector.when, 1)

    def finish(self) -> None:
        self._pick(self.drive.editor.inspector.when, 0)

    def at_end(self) -> None:
        self._pick(self.drive.editor.inspector.exit.way, 1)

    def loop(self) -> None:
        self.think()
        self._press(self.drive.editor.inspector.loop)

    def limb(self, limb: str) -> None:
        self.think()
        self._press(self.drive.editor.inspector.limb.button(LIMBS.index(limb)))  # type: ignore[arg-type]

    def table(self, text: str) -> None:
        raise NotImplementedError("a table is written in another program")


class TableExpert(Participant):
    """Labels clips field by field in the table, without proposals, by the window's own events."""

    def fill(self, steps: Sequence[Step]) -> None:
        d = self.drive
        self.think()
        QTest.keyClick(d.window, Qt.Key.Key_T, CONTROL)
        d.wait(lambda: d.shell.panel("table").view.hasFocus())
        self.panel = d.shell.panel("table")
        self.naming = False
        for step in steps:
            self.think()
            steps_before = d.document.undo_stack.index()
            if isinstance(step, FromNames):
                self._fill_from_names(step.pattern)
            else:
                self._set_found(step)
            self.wait(lambda before=steps_before: d.document.undo_stack.index() > before)  # type: ignore[misc]
            self.wait(lambda: self.panel.rows.project is d.document.project)
            assert not self.panel.rows.refused, self.panel.message.text()

    def _fill_from_names(self, pattern: str) -> None:
        row = self.panel.naming
        if self.naming:
            QTest.keyClick(row.pattern, Qt.Key.Key_A, CONTROL)
        else:
            self.click(self.panel.names_button, self.panel.names_button.rect().center())
            self.drive.wait(row.pattern.hasFocus)
        self.naming = True
        self.thoughts += pattern.count("{")
        QTest.keyClicks(row.pattern, pattern)
        QTest.keyClick(row.pattern, Qt.Key.Key_Return)

    def _set_found(self, step: SetFound) -> None:
        panel, view = self.panel, self.panel.view
        self.thoughts += 1 + step.words.count(" ") + step.words.count("|")
        QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_F, CONTROL)
        self.drive.wait(panel.search.hasFocus)
        if step.words:
            QTest.keyClicks(panel.search, step.words)
        else:
            QTest.keyClick(panel.search, Qt.Key.Key_Delete)
        QTest.keyClick(panel.search, Qt.Key.Key_Return)
        self.drive.wait(view.hasFocus)
        wanted = COLUMNS.index(step.column)
        while (now := view.currentIndex().column()) != wanted:
            QTest.keyClick(view, Qt.Key.Key_Right if now < wanted else Qt.Key.Key_Left)
        for letter in step.typed:
            QTest.keyClicks(QApplication.focusWidget(), letter)
        QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Return)


class Reviewer(Participant):
    """Has the clips labelled and goes through the proposals. look: every clip is watched once, alone, in full;
    else those that are sure are accepted unseen. watched: seconds of motion that were.
    """

    watched = 0.0

    def review(self, look: bool) -> None:
        from app.features.labelling.review_dialog import ReviewDialog

        d = self.drive
        self.think()
        QTest.keyClick(d.window, Qt.Key.Key_P, CONTROL)
        d.wait(lambda: bool(d.window.findChildren(ReviewDialog)))
        dialog = d.window.findChildren(ReviewDialog)[-1]
        self.wait(lambda: dialog.current is not None)
        corner = dialog.legend.mapToGlobal(QPoint(2, 2))
        words = ["xdotool", "mousemove", str(corner.x()), str(corner.y()), "click", "1"]
        self.hands.stop()  # a window manager would have given it the keyboard
        subprocess.run(words, check=True, timeout=10)
        d.wait(dialog.isActiveWindow)
        QApplication.instance().installEventFilter(self.hands)
        truth = self._truth(dialog.review)
        self.corrected = self.looked = 0
        (self._watch if look else self._accept)(dialog, truth)
        assert not dialog.work.waiting(), f"{len(dialog.work.waiting())} clips wait"
        dialog.close()
        d.wait(lambda: not dialog.isVisible())

    def _watch(self, dialog: Any, truth: dict[str, dict[str, Any]]) -> None:
        self.think()
        QTest.keyClick(dialog, Qt.Key.Key_W)
        while dialog.current is not None:
            clip = dialog.current
            self.watched += self.given.project.clips[clip].duration
            self.looked += 1
            if self._correct(dialog, clip, truth[clip]):
                self.think()
                QTest.keyClick(dialog, Qt.Key.Key_Return)
            else:
                dialog.watching.go_on(clip)  # it has played through
        self.think()
        QTest.keyClick(dialog, Qt.Key.Key_Return)

    def _accept(self, dialog: Any, truth: dict[str, dict[str, Any]]) -> None:
        self.think()
        QTest.keyClick(dialog, Qt.Key.Key_A)
        while dialog.current is not None:
            self._correct(dialog, dialog.current, truth[dialog.current])
            self.think()
            QTest.keyClick(dialog, Qt.Key.Key_Return)
            self.drive.pause(1)

    def _correct(self, dialog: Any, clip: str, wanted: dict[str, Any]) -> bool:
        """Correct the fields that are wrong, by keys; return whether there were any."""
        wrong = False
        for name in DECIDING:
            choices = [v for v, _ in dialog.review.choices(clip, name)]
            if not choices or dialog.review.value(clip, name) == wanted[name]:
                continue
            rows = [row.name for row in dialog.fields.rows]
            steps = (rows.index(name) - rows.index(dialog.row)) % len(rows)
            self.think()
            for _ in range(steps):
                QTest.keyClick(dialog, Qt.Key.Key_Down)
            at = choices.index(wanted[name]) if wanted[name] in choices else None
            if at is None:  # a stance that nothing was proposed for on this layer
                QTimer.singleShot(100, partial(self._type, wanted[name]))
                QTest.keyClick(dialog, Qt.Key.Key_N)
            elif at < 9:
                QTest.keyClick(dialog, Qt.Key(Qt.Key.Key_1 + at))
            while dialog.review.value(clip, name) != wanted[name]:
                QTest.keyClick(dialog, Qt.Key.Key_Right)
            self.corrected += 1
            wrong = True
        return wrong

    def _type(self, words: str) -> None:
        """Answer the question that is asked, or about to be."""
        asked = QApplication.activeModalWidget()
        field = asked.findChild(QLineEdit) if isinstance(asked, QInputDialog) else None
        if field is None:
            QTimer.singleShot(50, partial(self._type, words))
            return
        QTest.keyClicks(field, words)
        QTest.keyClick(field, Qt.Key.Key_Return)

    def _truth(self, review: Any) -> dict[str, dict[str, Any]]:
        """What each clip is, with the stances called as the review calls them: by the loops in them."""
        reference = self.given.reference
        called: dict[str, str] = {}
        for action in reference.actions():
            p = review.found.proposals[action.clip]
            if action.kind == "stance" and p.stance is not None:
                called.setdefault(action.stance, review.found.places[p.stance.value].name)
        return {
            a.clip: {
                "kind": a.kind,
                "layer": a.layer,
                "stance": called[a.stance],
                "end_stance": called[a.end_stance] if a.end_stance else None,
                "limb": a.limb,
            }
            for a in reference.actions()
        }


def without_times(project: Project) -> Project:
    """Return a project whose actions have the times of clips that are dropped: the review proposes others."""
    for action in list(project.actions()):
        timing = edits.make_default_timing(project.clips[action.clip], action.kind)
        project = edits.update_actions(project, [action.id], timing=asdict(timing))
    return project


def hidden(given: Task) -> Task:
    """Return a task whose clips' names tell nothing."""
    order = sorted(given.project.clips, key=lambda c: crc32(given.project.clips[c].name.encode()))
    names = {c: f"clip_{n:03}" for n, c in enumerate(order, 1)}

    def renamed(project: Project) -> Project:
        clips = {
            c: replace(
                e, name=names[c], path=f"{names[c]}.glb", motion=e.motion and replace(e.motion, name=names[c])
            )
            for c, e in ((c, project.clips[c]) for c in order)
        }
        return replace(project, clips=clips)

    return Task(renamed(given.project), renamed(given.reference))
