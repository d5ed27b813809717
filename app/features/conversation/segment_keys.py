"""What can be done with the segments, as data: one table for the keys and the menu."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QKeyCombination, Qt
from PySide6.QtGui import QKeySequence

from app.features.conversation.segment_editing import Editing
from app.look.theme import SOUND_MARKS
from app.translation import make_lazy_texts, tr
from metagraph.graph.conversation.model import SPOKEN, Sound

FINE, FAR = 0.02, 0.2  # seconds a key moves something
TITLES = make_lazy_texts(
    lambda: {"clause": tr("Clause"), "response": tr("Response"), "hesitation": tr("Hesitation")}
)
NUDGES = make_lazy_texts(
    lambda: {
        "body": (tr("Move earlier"), tr("Move later")),
        "end": (tr("Move the end earlier"), tr("Move the end later")),
        "start": (tr("Move the start earlier"), tr("Move the start later")),
    }
)
Key, Modifier = Qt.Key, Qt.KeyboardModifier


@dataclass(frozen=True)
class Deed:
    """run: what it does, at a time in seconds. needs: whether segments must be selected. line: the menu has a
    line above. hidden: a key alone, not in the menu.
    """

    text: str
    keys: tuple[QKeyCombination, ...]
    run: Callable[[Editing, float], object]
    needs: bool = True
    line: bool = False
    hidden: bool = False

    @property
    def shown(self) -> str:
        """The key in words."""
        return QKeySequence(self.keys[0]).toString(QKeySequence.SequenceFormat.NativeText)


def _combined(key: Qt.Key, modifier: Qt.KeyboardModifier = Modifier.NoModifier) -> QKeyCombination:
    return QKeyCombination(modifier, key)


def _nudge(by: float, what: str, editing: Editing, seconds: float) -> None:
    editing.nudge(by, what)


def _label(kind: Sound, editing: Editing, seconds: float) -> None:
    editing.relabel(kind)


def _nudges() -> list[Deed]:
    out = []
    for modifier, what in (
        (Modifier.ControlModifier, "body"),
        (Modifier.ShiftModifier, "end"),
        (Modifier.ControlModifier | Modifier.ShiftModifier, "start"),
    ):
        for key, by in ((Key.Key_Left, -FINE), (Key.Key_Right, FINE)):
            out.append(
                Deed(
                    NUDGES[what][by > 0],
                    (_combined(key, modifier),),
                    partial(_nudge, by, what),
                    hidden=True,
                )
            )
    return out


DEEDS: tuple[Deed, ...] = make_lazy_texts(
    lambda: (
        *(
            Deed(f"{SOUND_MARKS[kind]}  {TITLES[kind]}", (_combined(key),), partial(_label, kind))
            for kind, key in zip(SPOKEN, (Key.Key_1, Key.Key_2, Key.Key_3), strict=True)
        ),
        Deed(tr("Split here"), (_combined(Key.Key_S),), lambda e, at: e.split(at), needs=False, line=True),
        Deed(tr("Merge with the next"), (_combined(Key.Key_M),), lambda e, _: e.merge()),
        Deed(tr("Set stress here"), (_combined(Key.Key_P),), lambda e, at: e.stress(at)),
        Deed(
            tr("Remove"),
            (_combined(Key.Key_Delete), _combined(Key.Key_Backspace)),
            lambda e, _: e.remove(),
            line=True,
        ),
        Deed(
            tr("Add a segment at the playhead"),
            (_combined(Key.Key_Insert),),
            lambda e, _: e.add_here(),
            needs=False,
            line=True,
        ),
        Deed(
            tr("Select all segments"),
            (_combined(Key.Key_A, Modifier.ControlModifier),),
            lambda e, _: e.select_all(),
            needs=False,
        ),
        Deed(tr("Next"), (_combined(Key.Key_Right),), lambda e, _: e.step(1), needs=False, hidden=True),
        Deed(tr("Previous"), (_combined(Key.Key_Left),), lambda e, _: e.step(-1), needs=False, hidden=True),
        Deed(
            tr("Speaker above"),
            (_combined(Key.Key_Up),),
            lambda e, _: e.cross(-1),
            needs=False,
            hidden=True,
        ),
        Deed(
            tr("Speaker below"),
            (_combined(Key.Key_Down),),
            lambda e, _: e.cross(1),
            needs=False,
            hidden=True,
        ),
        *_nudges(),
    )
)
_BY_KEY = {key: deed for deed in DEEDS for key in deed.keys}
_PLAIN = ~(Modifier.KeypadModifier | Modifier.GroupSwitchModifier)


def find_deed(key: int, modifiers: Qt.KeyboardModifier) -> Deed | None:
    """Return what a key does."""
    return _BY_KEY.get(QKeyCombination(modifiers & _PLAIN, Qt.Key(key)))
