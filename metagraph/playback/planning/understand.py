"""From asks at any level of abstraction to what the planner and the life layers work with (Borer et al.,
section 6 and figure 5).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from metagraph.graph import requests as a
from metagraph.graph.model import LAYERS, Action, Layer, Project
from metagraph.playback.life.alphabet import ALPHABET
from metagraph.playback.planning.finding import action_called, stance_called
from metagraph.playback.planning.meaning import Meaning, PlainAsk, SaidLine
from metagraph.playback.planning.mood import MOODS
from metagraph.playback.timing.phases import lead
from metagraph.playback.timing.told_timing import read_given_timing

__all__ = ["find_action", "find_stance", "lead", "understand"]


def understand(
    project: Project, asks: Iterable[a.AnyRequest], now: float, soon: float | None = None
) -> Meaning:
    """Return what asks mean in a project. now: when those begin that do not say; soon: when it is said, for
    what is said, None for the same; seconds.

    An ask that makes several requests gives them ids of its own: `<id>`, then `<id>.1`, `<id>.2`, ...
    """
    graphs = [project.graphs[layer] for layer in LAYERS]
    out = Meaning(project, graphs, ALPHABET)
    for ask in asks:
        one = Meaning(project, graphs, ALPHABET, fixed=now)
        usual = now if soon is None or not isinstance(ask, a.Say) else soon
        at = usual if ask.at is None else ask.at
        try:
            _add(one, ask, ask.id, at)
            for block in one.blocks:
                from metagraph.playback.bml.reader import (
                    read_bml,  # only agents that speak it pay for its reader
                )

                for n, inner in enumerate(read_bml(block.text, block.at, block.priority, project)):
                    _add(one, inner, f"{block.id}.{n + 1}", block.at if inner.at is None else inner.at)
            out.take(one)
        except (a.RequestError, ValueError) as error:
            out.refuse(ask.id, str(error), getattr(ask, "layer", None), at)
    return out


def _add(meaning: Meaning, ask: a.AnyRequest, ident: str, at: float) -> None:
    """Add what an ask means. Raises RequestError when there is nothing it could mean."""
    plain = _plain(meaning.project, ask)
    why = meaning.add(plain, ident, at, ask.priority, 0.0)
    if not why:
        return
    project, layer = meaning.project, plain.layer
    known: Mapping[str, Mapping[str, Any]] = {"line": project.lines}
    if meaning.unknown == "action":
        known = {"action": _action_names(project, layer)}
    elif meaning.unknown == "stance":
        known = {"stance": _stance_names(project, layer)}
    word = {"line": plain.line or "", "action": plain.action, "stance": plain.stance}.get(meaning.unknown)
    raise a.RequestError(why if not word else why + _hint(word, known[meaning.unknown]))


# Which fields of an ask are called otherwise, or otherwise told, in a plain one.
_TOLD = frozenset(("told", "line", "words", "visemes", "characters", "set", "audio", "rate", "bml", "mood"))
_FIELDS: dict[type, tuple[str, ...]] = {}


def _plain(project: Project, ask: a.AnyRequest) -> PlainAsk:
    """Return an ask with every field. Raises RequestError if it tells times that make no sense."""
    kind = type(ask)
    if kind not in _FIELDS:
        _FIELDS[kind] = tuple(name for name in kind.__struct_fields__ if name not in _TOLD)
    fields: dict[str, Any] = {name: getattr(ask, name) for name in _FIELDS[kind]}
    fields |= read_mood(getattr(ask, "mood", None), getattr(ask, "intensity", None))
    if isinstance(ask, a.Bml):
        fields["text"] = ask.bml
    elif isinstance(ask, a.Say):
        fields["timing"] = read_given_timing(ask)
        if ask.line is not None:
            fields["line"] = str(ask.line)
            fields["said"] = _said(project, fields["line"], ask.gestures)
    return PlainAsk(str(kind.__struct_config__.tag), **fields)


def _said(project: Project, ident: str, gestures: bool) -> SaidLine | None:
    line = project.lines.get(ident)
    if line is None:
        return None
    seconds = line.duration if ident not in project.voices else float(project.voices[ident].duration)
    asks = line.asks if gestures else ()
    plain = [PlainAsk("say") if isinstance(x, a.Say) else _plain(project, x) for x in asks]
    return SaidLine(line.text, seconds, plain, **read_mood(line.mood, line.intensity))


def read_mood(mood: a.MoodPoint, intensity: float | None) -> dict[str, Any]:
    """Return what a mood that is asked for tells: `valence`, `arousal` and `intensity`, as far as it does."""
    out: dict[str, Any] = {}
    if mood is not None:
        out["valence"], out["arousal"] = MOODS[mood] if isinstance(mood, str) else mood[:2]
    if intensity is not None:
        out["intensity"] = intensity
    return out


def find_action(project: Project, word: str, layer: Layer | None = None) -> Action:
    """Return the action of an id or, failing that, a name; of several of one name the likeliest. Raises
    RequestError.
    """
    found = action_called([project.graphs[each] for each in LAYERS], word, layer)
    if found is None:
        where = f" in the {layer} layer" if layer else ""
        names = _action_names(project, layer)
        raise a.RequestError(f"there is no action '{word}'{where}{_hint(word, names)}")
    return found


def find_stance(project: Project, word: str, layer: Layer | None = None) -> tuple[Layer, str]:
    """Return layer and id of a stance from its id or name. Raises RequestError."""
    found = stance_called([project.graphs[each] for each in LAYERS], word, layer)
    if found is None:
        where = f" in the {layer} layer" if layer else ""
        raise a.RequestError(
            f"there is no stance '{word}'{where}{_hint(word, _stance_names(project, layer))}"
        )
    return found.layer, found.id


def _action_names(project: Project, layer: Layer | None) -> dict[str, None]:
    return {x.name: None for x in project.actions() if layer in (None, x.layer)}


def _stance_names(project: Project, layer: Layer | None) -> dict[str, None]:
    each = [project.graphs[one] for one in LAYERS if layer in (None, one)]
    return {stance.name: None for graph in each for stance in graph.stances.values()}


def _hint(word: str, known: Mapping[str, Any]) -> str:
    from difflib import get_close_matches  # it takes long to import, and few words are wrong

    near = get_close_matches(word, [str(k) for k in known], 1)
    if near:
        return f"; did you mean '{near[0]}'?"
    some = ", ".join(list(known)[:6])
    return f"; there are {some}{' ...' if len(known) > 6 else ''}" if some else "; there are none"
