"""From what people were seen to do to what a character does: sequences of acts, the model they give, and the
same sequence performed.

Borer et al., sections 7.2 and 7.3: intervals of each layer become a sequence of abstract actions, whose
transitions are counted.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from statistics import fmean, stdev

from metagraph.graph.model import KINDS, LIMBS, Kind, Layer, Limb, Markov
from metagraph.graph.requests import AnyRequest, Change, Fidget, Gesture, Performance
from metagraph.playback.learning.annotation import (
    IGNORE,
    PHASES,
    ROLES,
    Annotation,
    AnnotationInterval,
    Label,
    label_of,
    split_meaning,
)
from metagraph.playback.plan import MetaAction

OVERLAP = 0.5  # of the shorter of two intervals, one of each arm, that they must share to be one act of both
PHASE_GAP = 1.0  # seconds between phases that still are of one gesture
STANCE_CHANGE = 1.0  # seconds that going to a stance takes, where only the stances were annotated
LEAST_GAP = 0.05  # seconds of rest between acts that a model has at least

State = tuple[Limb, Kind, str]  # limb, kind, tags (blanks between them)
_WEIGHT: Mapping[Kind, int] = {"transition": 2, "gesture": 1, "fidget": 0, "stance": -1}


@dataclass(frozen=True, slots=True)
class Act:
    """Something one layer was seen, or is made, to do. start, end: seconds. stroke: its most telling moment,
    if that is known.
    """

    start: float
    end: float
    limb: Limb
    kind: Kind
    tags: tuple[str, ...] = ()
    stroke: float | None = None

    @property
    def length(self) -> float:
        return self.end - self.start


# --- intervals to sequences


def find_act_sequences(
    annotation: Annotation, roles: Mapping[str, str], labels: Iterable[Label]
) -> dict[Layer, tuple[Act, ...]]:
    """Return what each layer does that some tier is read as, ascending by start.

    Phases become whole gestures, stances the changes between them. Acts of the left and right arm that share
    more than `OVERLAP` of the shorter become one of both: the kind of the more important (transition,
    gesture, fidget), from the earlier start to the later end.
    """
    meant = {(label.layer, label.text): label.meaning for label in labels}
    out: dict[Layer, list[Act]] = {}
    for tier in annotation.tiers:
        role = roles.get(tier.name, IGNORE)
        if role in ROLES:
            layer, limb = ROLES[role]
            named = [(i, meant.get((layer, label_of(i.text)), IGNORE)) for i in tier.intervals]
            out.setdefault(layer, []).extend(_acts(named, limb))
    return {layer: merge_acts(acts) for layer, acts in out.items()}


def _acts(named: Sequence[tuple[AnnotationInterval, str]], limb: Limb) -> list[Act]:
    """Return the acts of one tier."""
    out: list[Act] = []
    phases: list[tuple[AnnotationInterval, str, tuple[str, ...]]] = []
    resting = ""
    for interval, meaning in named:
        first, tags = split_meaning(meaning)
        if first in PHASES:
            if phases and _begins(first, [p for _, p, _ in phases], interval.start - phases[-1][0].end):
                out.append(_whole(phases, limb))
                phases = []
            phases.append((interval, first, tags))
        elif first == "stance":
            if resting and resting != label_of(interval.text):
                end = min(interval.end, interval.start + STANCE_CHANGE)
                out.append(Act(interval.start, end, limb, "transition", tags))
            resting = label_of(interval.text)
        elif first in KINDS:
            out.append(Act(interval.start, interval.end, limb, _kind(first), tags))
    return [*out, _whole(phases, limb)] if phases else out


def _begins(phase: str, before: Sequence[str], gap: float) -> bool:
    """Return whether a phase begins another gesture: each has one stroke, begins with its preparation and
    ends with its retraction.
    """
    another = phase == "stroke" and "stroke" in before
    return (
        another
        or gap > PHASE_GAP
        or before[-1] == "retraction"
        or (phase == "preparation" and before[-1] != "preparation")
    )


def _whole(phases: Sequence[tuple[AnnotationInterval, str, tuple[str, ...]]], limb: Limb) -> Act:
    strokes = [(i.start + i.end) / 2 for i, phase, _ in phases if phase == "stroke"]
    tags = tuple(dict.fromkeys(tag for _, _, some in phases for tag in some))
    return Act(phases[0][0].start, phases[-1][0].end, limb, "gesture", tags, strokes[0] if strokes else None)


def _kind(word: str) -> Kind:
    return next(kind for kind in KINDS if kind == word)


def merge_acts(acts: Iterable[Act]) -> tuple[Act, ...]:
    """Return acts in order, those of two arms that overlap by more than `OVERLAP` of the shorter as one of
    both.

    Where one arm's annotation overlaps itself (two tiers read as the same), that is one act, too.
    """
    waiting = sorted(acts, key=lambda a: (a.start, a.end))
    while True:
        out: list[Act] = []
        for act in waiting:
            place = len(out) - 1
            while place >= 0 and not _one(out[place], act):
                place = place - 1 if out[place].end > act.start else -1
            if place < 0:
                out.append(act)
            else:
                out[place] = _together(out[place], act)
        if len(out) == len(waiting):
            return tuple(out)
        waiting = sorted(out, key=lambda a: (a.start, a.end))  # what has grown may reach further ones


def _one(a: Act, b: Act) -> bool:
    return min(a.end, b.end) - max(a.start, b.start) > OVERLAP * min(a.length, b.length)


def _together(a: Act, b: Act) -> Act:
    main, other = (a, b) if _WEIGHT[a.kind] >= _WEIGHT[b.kind] else (b, a)
    tags = main.tags if main.kind != other.kind else tuple(dict.fromkeys((*main.tags, *other.tags)))
    limb: Limb = a.limb if a.limb == b.limb else "both"
    return Act(min(a.start, b.start), max(a.end, b.end), limb, main.kind, tags, main.stroke)


# --- sequences to models


def get_act_state(act: Act, tagged: bool) -> State:
    """Return the state of a model that an act belongs to; with its tags where `tagged`."""
    return act.limb, act.kind, " ".join(act.tags) if tagged else ""


def describe_state(state: State, layer: Layer) -> str:
    """Return a state for people: "left gesture, positive"; only arms have sides."""
    limb, kind, tags = state
    words = f"{limb} {kind}" if layer == "arms" else kind
    return f"{words}, {tags.replace(' ', ', ')}" if tags else words


def list_model_states(model: Markov) -> tuple[State, ...]:
    """Return the states of a model, in its order."""
    return tuple((limb, kind, model.tag(n)) for n, (limb, kind) in enumerate(model.states))


def _order(state: State) -> tuple[int, int, int, str]:
    """As the paper's figure 11: left, right, both; gesture, fidget, transition; without tags, positive,
    negative, others.
    """
    limb, kind, tags = state
    rank = {"": 0, "positive": 1, "negative": 2}.get(tags, 3)
    return LIMBS.index(limb), ("gesture", "fidget", "transition", "stance").index(kind), rank, tags


def learn_model(
    layer: Layer, observed: Sequence[Sequence[Act]], tagged: bool = False, smoothing: float = 0.0
) -> Markov:
    """Return the first-order model of sequences of acts of one layer.

    tagged: tags are part of the states; otherwise only the shares of positive and negative gestures are kept.
    smoothing: added to every count before a row is evened to 1; 0 as in the paper. The row of a state that
    was never left (it only ended sequences) has every state as often as it was seen at all. `gap` is the mean
    rest between acts, 0 where they overlap. The deviation of a length seen only once is in proportion to the
    others'. Raises ValueError when nothing was observed.
    """
    acts = [act for sequence in observed for act in sequence]
    if not acts:
        raise ValueError(f"nothing of the {layer} layer was annotated")
    if smoothing < 0:
        raise ValueError("smoothing is 0 or more")
    seen = Counter(get_act_state(act, tagged) for act in acts)
    states = sorted(seen, key=_order)
    counts = Counter(
        pair for sequence in observed for pair in pairwise(get_act_state(act, tagged) for act in sequence)
    )
    matrix = []
    for source in states:
        row = [counts[source, target] + smoothing for target in states]
        row = row if sum(row) > 0 else [float(seen[target]) for target in states]
        matrix.append(tuple(x / sum(row) for x in row))
    gestures = [act for act in acts if act.kind == "gesture"]
    share = {
        tag: sum(tag in act.tags for act in gestures) / len(gestures) if gestures else 0.0
        for tag in ("positive", "negative")
    }
    tags = tuple(tag for _, _, tag in states)
    return Markov(
        layer,
        tuple((limb, kind) for limb, kind, _ in states),
        tuple(matrix),
        round(max(LEAST_GAP, fmean(measure_rests(observed) or [2.5])), 4),
        0.0 if tagged else round(share["positive"], 6),
        0.0 if tagged else round(share["negative"], 6),
        tags if any(tags) else (),
        _lengths(acts, states, tagged),
    )


def measure_rests(observed: Sequence[Sequence[Act]]) -> list[float]:
    """Return the seconds of rest between acts, 0 where the next begins before the last has ended."""
    return [max(0.0, b.start - a.end) for sequence in observed for a, b in pairwise(sequence)]


def _lengths(acts: Sequence[Act], states: Sequence[State], tagged: bool) -> tuple[tuple[float, float], ...]:
    lengths = {state: [a.length for a in acts if get_act_state(a, tagged) == state] for state in states}
    ratios = [stdev(some) / fmean(some) for some in lengths.values() if len(some) > 1]
    usual = fmean(ratios) if ratios else 0.0
    out = []
    for state in states:
        mean = max(1e-3, fmean(lengths[state]))
        out.append(
            (round(mean, 4), round(stdev(lengths[state]) if len(lengths[state]) > 1 else usual * mean, 4))
        )
    return tuple(out)


# --- editing a model


def with_cell(model: Markov, row: int, column: int, probability: float) -> Markov:
    """Return the model with one probability set; the others of its row keep their proportions (where all were
    0, they share evenly).
    """
    p = min(1.0, max(0.0, probability))
    old = model.matrix[row]
    rest = sum(x for n, x in enumerate(old) if n != column)
    if len(old) == 1:
        p = 1.0
    others = [
        (x / rest if rest > 0 else 1 / (len(old) - 1)) * (1 - p) if n != column else p
        for n, x in enumerate(old)
    ]
    return replace(
        model, matrix=tuple(tuple(others) if n == row else line for n, line in enumerate(model.matrix))
    )


def with_state(model: Markov, state: State) -> Markov:
    """Return the model with another state, which nothing leads to yet and which leads to every state alike;
    as it is if it has it.
    """
    if state in list_model_states(model):
        return model
    count = len(model.states) + 1
    order = sorted(range(count), key=lambda n: _order((*list_model_states(model), state)[n]))
    rows = [(*row, 0.0) for row in model.matrix] + [(1 / count,) * count]
    tags = [*(model.tags or [""] * (count - 1)), state[2]]
    lengths = [*model.lengths, _typical(model)] if model.lengths else []
    return replace(
        model,
        states=tuple([*model.states, state[:2]][n] for n in order),
        matrix=tuple(tuple(rows[i][j] for j in order) for i in order),
        tags=tuple(tags[n] for n in order) if any(tags) else (),
        lengths=tuple(lengths[n] for n in order) if lengths else (),
    )


def _typical(model: Markov) -> tuple[float, float]:
    return fmean(mean for mean, _ in model.lengths), fmean(deviation for _, deviation in model.lengths)


def remove_state(model: Markov, place: int) -> Markov:
    """Return the model without a state; rows that led only there lead to every other state alike. The last
    state stays.
    """
    kept = [n for n in range(len(model.states)) if n != place]
    if not kept:
        return model
    matrix = []
    for i in kept:
        total = sum(model.matrix[i][j] for j in kept)
        matrix.append(tuple(model.matrix[i][j] / total if total > 0 else 1 / len(kept) for j in kept))
    tags = tuple(model.tags[n] for n in kept) if model.tags else ()
    return replace(
        model,
        states=tuple(model.states[n] for n in kept),
        matrix=tuple(matrix),
        tags=tags if any(tags) else (),
        lengths=tuple(model.lengths[n] for n in kept) if model.lengths else (),
    )


# --- performing what was seen


def make_asks_from_acts(layer: Layer, acts: Sequence[Act]) -> tuple[AnyRequest, ...]:
    """Return what to ask for so that a layer does what was seen; which actions that takes is left to chance.

    A change of stance does not say which stance it leads to. Only arms are asked for by limb.
    """
    out: list[AnyRequest] = []
    for n, act in enumerate(acts):
        limb = act.limb if layer == "arms" else None
        ident, at, seconds = f"{layer}{n + 1}", round(act.start, 3), round(act.length, 3)
        if act.kind == "gesture":
            stroke = None if act.stroke is None else round(act.stroke, 3)
            out.append(
                Gesture(
                    id=ident, at=at, layer=layer, tags=act.tags, limb=limb, duration=seconds, stroke=stroke
                )
            )
        elif act.kind == "fidget":
            out.append(Fidget(id=ident, at=at, layer=layer, tags=act.tags, limb=limb, duration=seconds))
        elif act.kind == "transition":
            out.append(Change(id=ident, at=at, layer=layer, limb=limb, duration=seconds))
    return tuple(out)


def as_performance(name: str, observed: Mapping[Layer, Sequence[Act]], seconds: float = 0.0) -> Performance:
    """Return what was seen as a performance to keep; other seeds perform it with other actions. Layers that
    were not seen rest.

    seconds: how long it was watched, at least; it lasts a second longer than the last act in any case.
    """
    asks = sorted(
        (ask for layer, acts in observed.items() for ask in make_asks_from_acts(layer, acts)),
        key=lambda ask: ask.at or 0.0,
    )
    end = max((act.end for acts in observed.values() for act in acts), default=0.0)
    return Performance(
        name=name, asks=tuple(asks), length=float(math.ceil(max(end + 1.0, seconds))), idle=False
    )


def read_acts_of_asks(layer: Layer, asks: Iterable[AnyRequest]) -> tuple[Act, ...]:
    """Return the acts that a performance asks of a layer, as far as it asks for kinds and times: the inverse
    of `make_asks_from_acts`.
    """
    out = []
    for ask in asks:
        if not isinstance(ask, Gesture | Fidget | Change) or ask.layer != layer or ask.at is None:
            continue
        seconds = STANCE_CHANGE if ask.duration is None else ask.duration
        kind: Kind = (
            "gesture" if isinstance(ask, Gesture) else "fidget" if isinstance(ask, Fidget) else "transition"
        )
        stroke = ask.stroke if isinstance(ask, Gesture) else None
        tags = () if isinstance(ask, Change) else ask.tags
        out.append(Act(ask.at, ask.at + seconds, ask.limb or "both", kind, tags, stroke))
    return tuple(sorted(out, key=lambda a: (a.start, a.end)))


def read_acts_of_metas(metas: Iterable[MetaAction]) -> tuple[Act, ...]:
    """Return what meta actions say is done, whichever actions realise them."""
    return tuple(Act(m.start, m.end, m.request.limb or "both", m.request.kind, m.request.tags) for m in metas)
