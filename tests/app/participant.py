"""A scripted participant: does a labelling task in the real window with real events, in either condition, and
counts its hands' work.

It knows what is right and makes no mistake. `Participant` goes about it as somebody does who was shown the tool
once: one clip after another, dragged from the library, stance by stance, found by typing the stance's name once.
`Expert` does what `by_hand` found to be quickest, or has the clips labelled and goes through the proposals.
Thoughts (M) are placed by rule: one before each clip, one before each link or other setting, one before each
command, one for each part of what is searched for. Waits of more than 0.3 s for what the program does are R.
"""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass, replace
from typing import Any

from PySide6.QtCore import QPoint, QPointF, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QScrollArea

from app.features.study.operator_events import Hands
from metagraph.graph import edits
from metagraph.graph.edits import guess_limb
from metagraph.graph.expand import find_end_stance
from metagraph.graph.model import LAYERS, LIMBS, Layer, Project
from metagraph.research.study.machines.klm import predict_seconds
from metagraph.research.study.machines.normal_machine import normalize_machines
from metagraph.research.study.scores.machines import Score, score

LEFT = Qt.MouseButton.LeftButton
CONDITIONS = ("meta", "manual", "manual, every connection")
EXPERT = ("review", "aliases")
LEAST_WAIT = 0.3


@dataclass(frozen=True)
class Task:
    """project: clips, nothing placed. reference: what is wanted of them."""

    project: Project
    reference: Project


@dataclass(frozen=True)
class Result:
    """operators: how many of each class. predicted: seconds an expert takes. seconds: by the clock. ours:
    processor seconds of the program. score: beside the reference.
    """

    condition: str
    clips: int
    operators: Counter[str]
    predicted: float
    seconds: float
    ours: float
    score: Score


def task(sample: Project, clips: int) -> Task:
    """Return the task to place the first clips of the sample: stance by stance, so that few make a whole
    graph, too. Timing stays as it is when clips are dropped.
    """
    chosen, layers = [], [sample.graphs[x] for x in ("arms", "head", "body")]
    for graph in layers:
        known: list[str] = []
        for stance in graph.stances:
            known.append(stance)
            chosen += graph.of(stance, "stance")
            ways = [
                a
                for s in known
                for a in graph.of(s, "transition")
                if stance in (a.stance, a.end_stance) and a.end_stance in known
            ]
            chosen += ways
            chosen += [a for kind in ("gesture", "fidget") for a in graph.of(stance, kind)]
    chosen = chosen[:clips]
    bare = Project(
        name="task", skeleton=sample.skeleton, clips={a.clip: sample.clips[a.clip] for a in chosen}
    )
    reference, stances = bare, {}
    for action in chosen:
        if action.stance not in stances and action.kind == "stance":
            name = sample.stance(action.stance).name
            reference = edits.add_stance(reference, action.layer, name, [action.clip])
            stances[action.stance] = list(reference.graphs[action.layer].stances)[-1]
        else:
            end = stances[action.end_stance] if action.kind == "transition" else None
            reference = edits.place_clips(
                reference, [action.clip], action.layer, action.kind, stances[action.stance], end
            )
    return Task(bare, reference)


class Participant:
    """drive: the window and a hand, as tests have it. The window shows the task's project in the condition's
    editor.
    """

    def __init__(self, drive: Any, given: Task) -> None:
        self.drive, self.given = drive, given
        self.thoughts = self.scrolls = 0
        self.waited = 0.0
        self.hands = Hands(lambda now: None, lambda dialog, shown: None, lambda: None, drive.window)
        self.typed = ""

    # --- what people do

    def think(self) -> None:
        self.thoughts += 1

    def click(self, widget: Any, at: QPoint) -> None:
        QTest.mouseMove(widget, at)
        QTest.mouseClick(widget, LEFT, pos=at)

    def find(self, words: str) -> None:
        """Type what the library is searched for, unless that is what it shows."""
        if words == self.typed:
            return
        self.typed = words
        self.think()
        field = self.drive.library.search
        self.click(field, QPoint(field.width() // 2, field.height() // 2))
        QTest.keyClick(field, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
        QTest.keyClicks(field, words)
        self.drive.pause(120)

    def drop(self, clip: str, target: tuple[Any, QPoint]) -> None:
        """Drag a clip from the library, with the real pointer."""
        before = self.drive.document.project
        self.think()
        self.drive.drag(self.card(clip), target, lambda: self.drive.document.project is not before)

    def card(self, clip: str) -> tuple[Any, QPoint]:
        """The card of a clip, scrolled to where it is not in sight."""
        bar = self.drive.library.list.verticalScrollBar()
        before = bar.value()
        out: tuple[Any, QPoint] = self.drive.card(clip)
        self.scrolls += bar.value() != before
        return out

    def wait(self, until: Any) -> None:
        """Wait for the program."""
        began = time.monotonic()
        self.drive.wait(until, 120)
        spent = time.monotonic() - began
        self.waited += spent if spent > LEAST_WAIT else 0.0

    def layer(self, layer: Layer) -> None:
        if self.drive.session.place.layer != layer:
            self.think()
            number = LAYERS.index(layer)
            QTest.keyClick(self.drive.window, Qt.Key(Qt.Key.Key_1 + number), Qt.KeyboardModifier.AltModifier)
            self.drive.wait(lambda: self.drive.session.place.layer == layer)

    # --- the task

    def do(self, condition: str) -> Result:
        started, ours = time.monotonic(), time.process_time()
        self.act(condition)
        project = self.drive.document.project
        counts = Counter(self.hands.operators.take(time.monotonic()).operators)
        self.hands.stop()
        drags = counts.pop("D", 0)  # pressing and letting go are counted already
        counts["P"] += drags  # a drag points at where it ends
        counts["M"], counts["S"], counts["R"] = self.thoughts, self.scrolls, round(self.waited)
        found = score(normalize_machines(project), normalize_machines(self.given.reference))
        return Result(
            condition,
            len(project.clips),
            counts,
            predict_seconds(counts),
            time.monotonic() - started,
            time.process_time() - ours,
            found,
        )

    def act(self, condition: str) -> None:
        if condition == "meta":
            self._meta()
        else:
            self._manual(condition == CONDITIONS[2])

    def _wanted(self) -> list[Any]:
        return list(self.given.reference.actions())

    def _prefix(self, clip: str) -> str:
        name = self.given.project.clips[clip].name
        return name.split("__")[0] + "__" if "__" in name else name

    def _meta(self) -> None:
        d, reference = self.drive, self.given.reference
        made: dict[str, str] = {}  # the reference's stance -> the one here

        def stance(wanted: str) -> None:
            if d.session.place.stance() != made[wanted]:
                self.think()
                self.click(*d.chip(made[wanted]))
                d.wait(lambda: d.session.place.stance() == made[wanted])

        def end(wanted: str) -> None:
            if d.session.place.other() != made[wanted]:
                self.think()
                names = [
                    s
                    for s in d.document.project.graphs[d.session.place.layer].stances
                    if s != d.session.place.stance()
                ]
                QTimer.singleShot(60, lambda: self._choose(names.index(made[wanted])))
                self.click(d.canvas, d.canvas.layout_now().nodes["transition"].other.center().toPoint())
                d.wait(lambda: d.session.place.other() == made[wanted])

        actions = self._wanted()
        for layer in LAYERS:
            mine = [a for a in actions if a.layer == layer]
            if mine:
                self.layer(layer)
            for action in (a for a in mine if a.kind == "stance"):
                name = reference.clips[action.clip].name
                self.find(name)
                self.drop(name, d.middle())
                made[action.stance] = list(d.document.project.graphs[layer].stances)[-1]
            for action in sorted(
                (a for a in mine if a.kind != "stance"),
                key=lambda a: (list(made).index(a.stance), a.end_stance or ""),
            ):
                self.find(self._prefix(action.clip))
                stance(action.stance)
                if action.kind == "transition":
                    end(action.end_stance)
                self.drop(reference.clips[action.clip].name, d.node(action.kind))

    def _choose(self, row: int) -> None:
        """Take an entry of the menu that is open, or about to be, by keys."""
        menu = QApplication.activePopupWidget()
        if menu is None:
            QTimer.singleShot(20, lambda: self._choose(row))
            return
        for _ in range(row + 1):
            QTest.keyClick(menu, Qt.Key.Key_Down)
        QTest.keyClick(menu, Qt.Key.Key_Return)

    def _manual(self, whole: bool) -> None:
        d, reference = self.drive, self.given.reference
        canvas = d.editor.canvas
        for layer in LAYERS:
            mine = [a for a in self._wanted() if a.layer == layer]
            if not mine:
                continue
            self.layer(layer)
            across = max(2, round(len(mine) ** 0.5 * 1.1))
            self._room(canvas, across, -(-len(mine) // across))
            state: dict[str, str] = {}
            for number, action in enumerate(mine):
                self.find(
                    reference.clips[action.clip].name
                    if action.kind == "stance"
                    else self._prefix(action.clip)
                )
                at = canvas.view.to(self._spot(number, across)).toPoint()
                self.drop(reference.clips[action.clip].name, (canvas, at))
                state[action.id] = list(canvas.scene().manual.states)[-1]
                self._set_up(action)
            for source, target in self._links(mine, whole):
                self._link(canvas, state[source], state[target])
                if reference.action(target).kind in ("gesture", "transition"):
                    self._on_request(reference.action(source).kind != "stance")

    @staticmethod
    def _spot(number: int, across: int) -> QPointF:
        """Where the n-th node's middle goes, in the editor's own units."""
        return QPointF(120 + 230 * (number % across), 70 + 120 * (number // across))

    def _room(self, canvas: Any, across: int, down: int) -> None:
        """Zoom out, by the wheel, until all that comes has room."""
        from app.features.manual.manual_scene import ManualView

        scale = min(1.0, canvas.width() / (230 * across + 40), canvas.height() / (120 * down + 60))
        canvas.look_at(ManualView(scale, 0.0, 0.0))
        canvas.settle()
        self.think()
        self.scrolls += 1

    def _links(self, mine: list[Any], whole: bool) -> list[tuple[str, str]]:
        """The links to draw: to and from stances, or all that the meta-graph implies."""
        out = []
        for source in mine:
            for target in mine:
                if (
                    source.id != target.id
                    and find_end_stance(source) == target.stance
                    and (whole or "stance" in (source.kind, target.kind))
                ):
                    out.append((source.id, target.id))
        return out

    def _link(self, canvas: Any, source: str, target: str) -> None:
        """Draw an arrow from the border of a node to another node."""
        self.think()
        nodes, view = canvas.scene().nodes, canvas.view
        a, b = nodes[source], nodes[target]
        start = view.to(QPointF(a.right() - 1, a.center().y())).toPoint()
        end = view.to(b.center()).toPoint()
        before = len(canvas.scene().manual.links)
        QTest.mouseMove(canvas, start)
        QTest.mousePress(canvas, LEFT, pos=start)
        for part in (0.3, 0.7, 1.0):
            QTest.mouseMove(canvas, start + (end - start) * part)
        QTest.mouseRelease(canvas, LEFT, pos=end)
        assert len(canvas.scene().manual.links) == before + 1, f"no link from {source} to {target}"

    def _press(self, widget: Any) -> None:
        """Click a control of the inspector, which may have to be scrolled to."""
        area = self.drive.editor.inspector
        self.drive.wait(widget.isVisible)
        for parent in [area, *area.findChildren(QScrollArea)]:
            if parent.isAncestorOf(widget):
                bar = parent.verticalScrollBar()
                before = bar.value()
                parent.ensureWidgetVisible(widget)
                self.scrolls += bar.value() != before
        at = QPoint(min(14, widget.width() // 2), widget.height() // 2)
        self.click(widget, at)

    def _set_up(self, action: Any) -> None:
        """What a state needs that its clip does not say: that it loops, and which arm it moves."""
        inspector = self.drive.editor.inspector
        if action.kind == "stance":
            self.think()
            self._press(inspector.loop)
        if action.limb != guess_limb(self.given.project.clips[action.clip].name) and action.layer == "arms":
            self.think()
            self._press(inspector.limb.button(LIMBS.index(action.limb)))

    def _on_request(self, at_the_end: bool) -> None:
        """Let the link that was just drawn wait for its trigger, which is named after where it leads, and for
        the end of what plays.
        """
        inspector = self.drive.editor.inspector
        self.think()
        self._press(inspector.when)
        self.drive.wait(lambda: inspector.when.view().isVisible())
        QTest.keyClick(inspector.when.view(), Qt.Key.Key_Down)
        QTest.keyClick(inspector.when.view(), Qt.Key.Key_Return)
        if at_the_end:
            self._pick(inspector.exit.way, 1)

    def _pick(self, chooser: Any, row: int) -> None:
        """Take an entry of a list, by keys."""
        self.think()
        steps = row - chooser.currentIndex()
        self._press(chooser)
        self.drive.wait(lambda: chooser.view().isVisible())
        if chooser.currentIndex() < 0:  # it shows "mixed": the first entry comes with the first key
            steps = row + 1
        for _ in range(abs(steps)):
            QTest.keyClick(chooser.view(), Qt.Key.Key_Down if steps > 0 else Qt.Key.Key_Up)
        QTest.keyClick(chooser.view(), Qt.Key.Key_Return)


def bare(drive: Any, given: Task, condition: str) -> None:
    """Show a task's project in a condition's editor, as a study does."""
    drive.document.load(replace(given.project, name="task"), None)
    drive.files.opened.emit()
    drive.session.set_mode("meta" if condition == "meta" else "manual")
    drive.wait(lambda: drive.performance.skeleton() is not None)
    drive.pause(300)
