"""The words of a block of BML and those of a project: which tags, action or stance a lexeme means, and how
long things take.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from weakref import ref

from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.playback.planning.line_lengths import find_spoken_seconds

SYNCS = ("start", "ready", "strokestart", "stroke", "strokeend", "relax", "end", "attackpeak")
GUESSED = {
    "ready": 0.3,
    "strokestart": 0.3,
    "stroke": 0.45,
    "strokeend": 0.6,
    "relax": 0.8,
    "end": 1.3,
}  # seconds, of a gesture nobody knows
NODDED = {"ready": 0.1, "strokestart": 0.1, "stroke": 0.3, "strokeend": 0.5, "relax": 0.6, "end": 0.9}
SPOKEN = 14.0  # characters a second, as where asks are understood
LOOKED_UP = 16  # different gestures of one block whose clips are looked at for their lengths
UNSAID = 2.0  # seconds of a line about which nothing is known
PARTS: Mapping[str, Layer] = {
    "arms": "arms", "leftarm": "arms", "rightarm": "arms", "hands": "arms", "head": "head",
    "body": "body", "wholebody": "body", "legs": "body", "leftleg": "body", "rightleg": "body",
}  # fmt: skip


def spell_word(text: str) -> str:
    """Return a word as it is compared: lower case, letters and digits alone."""
    return "".join(c for c in text.lower() if c.isalnum())


class Index:
    """A project's actions and stances by their spelled words. called: layer -> word -> gestures that are, or
    begin, so.
    """

    def __init__(self, project: Project) -> None:
        self.tags: dict[str, dict[str, str]] = {}
        self.called: dict[str, dict[str, list[Action]]] = {}
        self.actions: dict[str, list[Action]] = {}  # by id and name
        self.names: dict[str, list[Action]] = {}  # by spelled name
        self.starts = {layer: project.graphs[layer].start for layer in LAYERS}
        self.stances = [s for layer in LAYERS for s in project.graphs[layer].stances.values()]
        for layer in LAYERS:
            tags, called = self.tags.setdefault(layer, {}), self.called.setdefault(layer, {})
            for action in project.graphs[layer].actions.values():
                self.names.setdefault(spell_word(action.name), []).append(action)
                for word in {action.id, action.name}:
                    self.actions.setdefault(word, []).append(action)
                if action.kind == "gesture":
                    tags.update((spell_word(tag), tag) for tag in action.tags)
                    for word in _beginnings(action.name):
                        called.setdefault(word, []).append(action)


# Of the project that was asked for last: agents send block after block.
_latest: list[tuple[ref[Project], Index]] = []


def get_word_index(project: Project) -> Index:
    """Return a project's index."""
    if not _latest or _latest[0][0]() is not project:
        _latest[:] = [(ref(project), Index(project))]
    return _latest[0][1]


class BmlWords:
    """What the words of a block mean in a project; without one they are taken as they are and lengths are
    guessed.
    """

    def __init__(self, project: Project | None) -> None:
        self.project = project
        self.index = get_word_index(project) if project is not None else None
        self.lengths: dict[Any, dict[str, float]] = {}

    def gesture(self, words: Sequence[str], layer: str, fields: Mapping[str, Any]) -> a.Gesture | a.Play:
        """Return what asks for a gesture with these tags, or called so; arms first, where no layer is
        said.
        """
        wanted, index = {spell_word(w) for w in words} - {""}, self.index
        if not wanted or index is None:
            return a.Gesture(layer=layer or "arms", tags=tuple(words), **fields)  # type: ignore[arg-type]
        order: tuple[Layer, ...] = ("arms", "head", "body")
        for each in (x for x in order if layer in ("", x)):
            tags = index.tags[each]
            if wanted <= tags.keys():
                return a.Gesture(
                    layer=each, tags=tuple(tags[w] for w in map(spell_word, words) if w), **fields
                )
            found = index.called[each].get("".join(map(spell_word, words)))
            if found:
                # The likeliest one; of equals that of the stance the layer starts in.
                start, limb = index.starts[each], fields.get("limb")
                best = max(found, key=lambda g: (g.limb == limb, g.likelihood, g.stance == start))
                return a.Play(id=fields["id"], priority=fields["priority"], action=best.id, layer=each)
        return a.Gesture(layer=layer or "arms", tags=tuple(words), **fields)  # type: ignore[arg-type]

    def action(self, name: str, layer: str) -> str:
        """Return an action's name as the project writes it."""
        if self.index is None or any(layer in ("", x.layer) for x in self.index.actions.get(name, ())):
            return name
        return next(
            (x.name for x in self.index.names.get(spell_word(name), ()) if layer in ("", x.layer)), name
        )

    def stance(self, part: str, word: str, layer: str) -> tuple[str, str]:
        """Return layer ("" for any) and stance of a posture: `part` ARMS and `word` CROSSED find "arms
        crossed".
        """
        layer = layer or PARTS.get(spell_word(part), "")
        if self.index is not None:
            stances = [s for s in self.index.stances if layer in ("", s.layer)]
            if not any(word in (s.id, s.name) for s in stances):
                ways = (spell_word(word), spell_word(part + word), spell_word(word + part))
                found = next((s for s in stances if spell_word(s.name) in ways), None)
                return (found.layer, found.name) if found is not None else (layer, word)
        return layer, word

    def line(self, ident: str) -> str:
        """Return the project's line of this id, "" if there is none."""
        return ident if self.project is not None and ident in self.project.lines else ""

    def spoken(self, line: str, text: str) -> float:
        """Return how long something takes to say; seconds."""
        if self.project is None:
            return len(text) / SPOKEN if text else UNSAID
        known = self.project.lines.get(line)
        return find_spoken_seconds(
            self.project, line or None, text or (known.text if known is not None else "")
        )

    def offsets(self, ask: a.Gesture | a.Fidget | a.Play | a.Nod | a.Shake) -> dict[str, float]:
        """Return the sync points of the likeliest action an ask may get; seconds after its start."""
        key = (type(ask), *(getattr(ask, name, None) for name in ("layer", "tags", "limb", "action")))
        if key not in self.lengths:
            self.lengths[key] = self._offsets(ask) if len(self.lengths) < LOOKED_UP else GUESSED
        return self.lengths[key]

    def _offsets(self, ask: a.Gesture | a.Fidget | a.Play | a.Nod | a.Shake) -> dict[str, float]:
        if isinstance(ask, a.Nod | a.Shake):
            word = "nod" if isinstance(ask, a.Nod) else "shake"
            heads = self.project.graphs["head"].actions.values() if self.project is not None else ()
            return self._phases(
                [x for x in heads if x.kind == "gesture" and (word in x.tags or word in x.name.lower())],
                NODDED,
            )
        if self.project is None or self.index is None:
            return GUESSED
        if isinstance(ask, a.Play):
            return self._phases(
                [x for x in self.index.actions.get(ask.action, ()) if ask.layer in (None, x.layer)], GUESSED
            )
        tags, limb = set(ask.tags), ask.limb
        kind = "gesture" if isinstance(ask, a.Gesture) else "fidget"
        actions = self.project.graphs[ask.layer].actions.values() if ask.layer in LAYERS else ()
        fitting = [x for x in actions if x.kind == kind and tags <= set(x.tags) and limb in (None, x.limb)]
        return self._phases(fitting, GUESSED)

    def _phases(self, fitting: Sequence[Action], guessed: dict[str, float]) -> dict[str, float]:
        if self.project is None or not fitting:
            return guessed
        from metagraph.playback.timing.phases import find_phases

        found = find_phases(self.project, max(fitting, key=lambda x: x.likelihood))
        points = (found.ready, found.ready, found.stroke, found.stroke_end, found.relax, found.end)
        return {sync: x - found.start for sync, x in zip(guessed, points, strict=True)}


def _beginnings(name: str) -> set[str]:
    """Return what a name may be called: `shrug_bt_01` is shrug, shrug bt, and all of it."""
    pieces = name.replace("-", "_").replace(" ", "_").split("_")
    return {spell_word(name), *(spell_word("".join(pieces[:n])) for n in range(1, len(pieces)))} - {""}
