"""Put problems of one kind in one stance together, so that a list of them can be read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from metagraph.common.wording import Phrase, plural_phrase
from metagraph.graph.model import Project
from metagraph.graph.problem import Problem

FEWEST = 3  # problems of one kind in one stance that are shown as one
_KINDS = {
    "far-start": "far",
    "far-end": "far",
    "jump-start": "jump",
    "jump-end": "jump",
    "play-jump": "rough",
    "play-fast": "rough",
}


@dataclass(frozen=True)
class ProblemGroup:
    """Problems that are shown as one line: of a kind, in a stance. words: what they have in common; of a
    single problem, its message.
    """

    words: str
    problems: tuple[Problem, ...]


def group_problems(project: Project, problems: Sequence[Problem]) -> list[ProblemGroup]:
    """Return problems in their order; FEWEST or more that actions of one stance have of one kind are
    together, where the first of them is.
    """
    of: dict[tuple[object, ...], list[Problem]] = {}
    for n, p in enumerate(problems):
        kind = _KINDS.get(p.code, p.code)
        key = (p.severity, kind, p.layer, p.stance) if p.action is not None and p.stance is not None else (n,)
        of.setdefault(key, []).append(p)
    out: list[ProblemGroup] = []
    for some in of.values():
        if len({p.action for p in some}) >= FEWEST:
            out.append(ProblemGroup(_describe(project, some), tuple(some)))
        else:
            out += [ProblemGroup(p.message, (p,)) for p in some]
    places = {p: n for n, p in reversed([*enumerate(problems)])}
    return sorted(out, key=lambda group: places[group.problems[0]])


def _describe(project: Project, some: Sequence[Problem]) -> Phrase:
    """Return what problems of one stance have in common: "idle 3: 18 actions begin or end 9 to 14 cm off"."""
    stance = project.stance(some[0].stance)
    name, count = stance.name if stance is not None else "", len({p.action for p in some})
    kind = _KINDS.get(some[0].code, some[0].code)
    if kind == "far":
        lengths = [float(far) for p in some if (far := _length_of(p.message)) is not None]
        least, most = (round(x) for x in (min(lengths, default=0.0), max(lengths, default=0.0)))
        if least == most:
            return plural_phrase(
                "{name}: {count:,} action begins or ends {most} cm off",
                "{name}: {count:,} actions begin or end {most} cm off",
                count,
                name=name,
                most=most,
            )
        return plural_phrase(
            "{name}: {count:,} action begins or ends {least} to {most} cm off",
            "{name}: {count:,} actions begin or end {least} to {most} cm off",
            count,
            name=name,
            least=least,
            most=most,
        )
    if kind == "jump":
        return plural_phrase(
            "{name}: {count:,} action begins or ends with a visible jump",
            "{name}: {count:,} actions begin or end with a visible jump",
            count,
            name=name,
        )
    if kind == "rough":
        return plural_phrase(
            "{name}: {count:,} action jumps, or blends too fast, as it plays",
            "{name}: {count:,} actions jump, or blend too fast, as they play",
            count,
            name=name,
        )
    return plural_phrase(
        "{name}: {count:,} problem: {message}",
        "{name}: {count:,} similar problems: {message}",
        count,
        name=name,
        message=some[0].message,
    )


def _length_of(words: str) -> float | None:
    """Return the centimetres that a message has been made with; None if it has none."""
    if not isinstance(words, Phrase):
        return None
    if "far" in words.values and isinstance(words.values["far"], float):
        return float(words.values["far"])
    return next((x for v in words.values.values() if (x := _length_of(v)) is not None), None)
