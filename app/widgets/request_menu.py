"""Describe requests in words, and make the menus to choose them from."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QInputDialog, QMenu, QWidget

from app.look.theme import KIND_MARKS
from app.project.document import Document
from app.stage.performance import StagePerformance
from app.translation import format_number, make_lazy_texts, tr, tr_noop
from app.widgets.vocabulary import get_vocabulary_title, get_vocabulary_word
from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, MODES, Layer, Project
from metagraph.graph.words import FEELINGS

STAGE = "stage"  # the lane of what no layer plays: speech, gaze, modes
DIRECTIONS = {
    tr_noop("Left"): (0.9, 1.6, 0.9),
    tr_noop("Right"): (-0.9, 1.6, 0.9),
    tr_noop("Up"): (0.0, 2.4, 1.0),
    tr_noop("Down"): (0.0, 0.6, 1.0),
}
MOOD_WORDS = {name: get_vocabulary_title(name) for name in FEELINGS}
MODE_WORDS = make_lazy_texts(
    lambda: {
        "idle": tr("Idle"),
        "listening": tr("Listen"),
        "talking": tr("Talk"),
        "thinking": tr("Think"),
        "reacting": tr("React"),
    }
)
MODE_ASKED = make_lazy_texts(
    lambda: {
        "idle": tr("idle"),
        "listening": tr("listen"),
        "talking": tr("talk"),
        "thinking": tr("think"),
        "reacting": tr("react"),
    }
)  # within a sentence
LOOK_TARGETS = make_lazy_texts(lambda: {"user": tr("user"), "ahead": tr("ahead"), "partner": tr("partner")})


def ask_kind(ask: a.AnyRequest) -> str | None:
    """Return the kind an ask is coloured as, None for what no layer plays."""
    if isinstance(ask, a.Go | a.Change):
        return "transition"
    if isinstance(ask, a.Fidget):
        return "fidget"
    return "gesture" if isinstance(ask, a.Gesture | a.Play | a.Nod | a.Shake) else None


def describe_request(ask: a.AnyRequest, project: Project) -> str:
    """Return an ask in a few words: "▲ positive", "➜ on hips", "look at user"."""
    match ask:
        case a.Gesture() | a.Fidget():
            kind = "gesture" if isinstance(ask, a.Gesture) else "fidget"
            limb = get_vocabulary_word(ask.limb) if ask.limb in ("left", "right") else ""
            words = ", ".join(x for x in (limb, *ask.tags) if x) or get_vocabulary_word(kind)
            return f"{KIND_MARKS[kind]} {words}"
        case a.Play():
            found = project.action(ask.action)
            return f"{KIND_MARKS[found.kind if found else 'gesture']} {found.name if found else ask.action}"
        case a.Go():
            stance = project.stance(ask.stance)
            return f"{KIND_MARKS['transition']} {stance.name if stance else ask.stance}"
        case a.Change():
            return f"{KIND_MARKS['transition']} {tr('another stance')}"
        case a.Nod() | a.Shake():
            return f"{KIND_MARKS['gesture']} {tr('nod') if isinstance(ask, a.Nod) else tr('shake')}"
        case a.Look():
            if ask.to == "ahead":
                return tr("look ahead")
            what = LOOK_TARGETS.get(ask.to, ask.to) if isinstance(ask.to, str) else tr("a point")
            return tr("look at {what}", what=what)
        case a.Say():
            line = project.lines.get(str(ask.line)) if ask.line is not None else None
            text = ask.text or (line.text if line else "")
            return (
                f"{ask.line}: {text}"
                if ask.line is not None and text
                else text or tr("line {name}", name=ask.line)
            )
        case a.Behave():
            return MODE_ASKED[ask.mode] if ask.mode else tr("as it comes")
        case a.Feel():
            return describe_mood(ask.mood, ask.intensity)
        case a.Place():
            return tr("{name} moves", name=ask.name)
        case a.Blink():
            return tr("blink")
        case a.Bml():
            return "BML"
    return tr("withdraw")


def describe_mood(mood: a.MoodPoint, intensity: float | None) -> str:
    """Return a mood in a few words: "sad", "sad × 1.5", "mood 0.3, -0.5"."""
    named = tr("mood")
    if isinstance(mood, str):
        named = get_vocabulary_word(mood)
    elif mood:
        values = ", ".join(format_number(x, "g") for x in mood)
        named = f"{named} {values}"
    return named if intensity is None else f"{named} × {format_number(intensity, 'g')}"


Ask = Callable[[a.AnyRequest, str], object]


def make_request_menu(
    parent: QWidget, performance: StagePerformance, seconds: float | None, lane: str | None = None
) -> QMenu:
    """Return a menu of everything that can be asked for at a time (None: now), of one lane or all."""
    menu = QMenu(parent)
    menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    project = performance.document.project

    def ask(made: a.AnyRequest, text: str) -> None:
        performance.requests.ask(made, text)

    for layer in LAYERS:
        if lane not in (None, layer) or not project.graphs[layer].stances:
            continue
        inner = menu if lane == layer else menu.addMenu(get_vocabulary_title(layer))
        _layer_items(inner, project, layer, seconds, ask)
    if lane in (None, STAGE) and project.skeleton is not None:
        if lane is None:
            menu.addSeparator()
        _stage_items(menu, parent, performance.document, seconds, ask)
    if lane is None and performance.asks:
        menu.addSeparator()
        menu.addAction(tr("Withdraw all requests"), lambda: performance.requests.withdraw())
    if menu.isEmpty():
        menu.addAction(tr("Create a stance first")).setEnabled(False)
    return menu


def _layer_items(menu: QMenu, project: Project, layer: Layer, at: float | None, ask: Ask) -> None:
    graph = project.graphs[layer]
    kinds: tuple[tuple[str, Any, str, str], ...] = (
        ("gesture", a.Gesture, tr("A gesture"), tr("Ask for a gesture")),
        ("fidget", a.Fidget, tr("A fidget"), tr("Ask for a fidget")),
    )
    for kind, made, words, asked in kinds:
        if any(x.kind == kind for x in graph.actions.values()):
            menu.addAction(words, partial(ask, made(layer=layer, at=at), asked))
    tags = sorted({tag for x in graph.actions.values() if x.kind == "gesture" for tag in x.tags})
    if tags:
        tagged = menu.addMenu(tr("Gesture with tag"))
        for tag in tags:
            tagged.addAction(
                tag, partial(ask, a.Gesture(layer=layer, at=at, tags=(tag,)), tr("Ask for a gesture"))
            )
    certain = menu.addMenu(tr("Specific action"))
    for stance in graph.stances.values():
        some = [*graph.of(stance.id, "gesture"), *graph.of(stance.id, "fidget")]
        if not some:
            continue
        inner = certain.addMenu(stance.name)
        for x in some:
            words = f"{KIND_MARKS[x.kind]} {x.name}"
            inner.addAction(
                words, partial(ask, a.Play(action=x.id, at=at), tr("Ask for {name}", name=x.name))
            )
    certain.menuAction().setVisible(not certain.isEmpty())
    if layer == "head":
        menu.addSeparator()
        menu.addAction(tr("Nod"), lambda: ask(a.Nod(at=at), tr("Ask for a nod")))
        menu.addAction(tr("Shake the head"), lambda: ask(a.Shake(at=at), tr("Ask for a head shake")))
    menu.addSeparator()
    for stance in graph.stances.values():
        menu.addAction(
            tr("Go to {name}", name=stance.name),
            partial(ask, a.Go(stance=stance.id, at=at), tr("Ask for {name}", name=stance.name)),
        )
    if graph.into:
        menu.addAction(
            tr("Change to another stance"),
            lambda: ask(a.Change(layer=layer, at=at), tr("Ask for another stance")),
        )


def _stage_items(menu: QMenu, parent: QWidget, document: Document, at: float | None, ask: Ask) -> None:
    project = document.project
    said = menu.addMenu(tr("Say"))
    for ident, line in project.lines.items():
        words = line.text if len(line.text) < 48 else line.text[:46] + "…"
        said.addAction(f"{ident}: {words}", partial(ask, a.Say(line=ident, at=at), tr("Ask for a line")))
    if project.lines:
        said.addSeparator()
    said.addAction(tr("Type words…"), lambda: _say(parent, at, ask))
    looks = menu.addMenu(tr("Look at"))
    for name in dict.fromkeys(("user", *project.points)):
        looks.addAction(
            get_vocabulary_title(name) if name == "user" else name,
            partial(ask, a.Look(to=name, at=at), tr("Ask for a look")),
        )
    looks.addAction(tr("Ahead"), lambda: ask(a.Look(to="ahead", at=at), tr("Ask for a look")))
    looks.addSeparator()
    for words, point in DIRECTIONS.items():
        looks.addAction(tr(words), partial(ask, a.Look(to=point, at=at, duration=2.0), tr("Ask for a look")))
    looks.addSeparator()
    looks.addAction(tr("New point…"), lambda: _point(parent, document, at, ask))
    menu.addAction(tr("Blink"), lambda: ask(a.Blink(at=at), tr("Ask for a blink")))
    modes = menu.addMenu(tr("Mode"))
    for mode in MODES:
        modes.addAction(MODE_WORDS[mode], partial(ask, a.Behave(mode=mode, at=at), tr("Ask for a mode")))
    modes.addAction(tr("Automatic"), lambda: ask(a.Behave(mode=None, at=at), tr("Ask for a mode")))
    moods = menu.addMenu(tr("Mood"))
    for feeling in FEELINGS:
        moods.addAction(MOOD_WORDS[feeling], partial(ask, a.Feel(mood=feeling, at=at), tr("Ask for a mood")))


def _point(parent: QWidget, document: Document, at: float | None, ask: Ask) -> None:
    from app.widgets.point_editor import PointEditor

    PointEditor(document, lambda name: ask(a.Look(to=name, at=at), tr("Ask for a look")), parent).open()


def _say(parent: QWidget, at: float | None, ask: Ask) -> None:
    text, ok = QInputDialog.getText(parent, tr("Say"), tr("Words"))
    if ok and text.strip():
        ask(a.Say(text=text.strip(), at=at), tr("Ask for words"))
