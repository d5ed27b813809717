"""Exhibits of the conversation paper about speech and movement: how often they go together, and where is
looked.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from metagraph.graph.conversation.model import Segment
from metagraph.motion.clip import Clip
from metagraph.research.exhibits import drawings
from metagraph.research.exhibits.exhibit import ExhibitDrawing, ExhibitTable, MadeExhibit
from metagraph.research.exhibits.material import ExhibitMaterial
from metagraph.research.exhibits.published import TABLE_1, WORDS_A_CLAUSE, PublishedRate
from metagraph.synthesis.cooccurrence import (
    CooccurrenceRow,
    Part,
    compute_wilson_interval,
    count_cooccurrence,
    find_activation_speed,
    find_movement,
    find_movement_windows,
    measure_part_speeds,
)

ACTORS = ("female", "male")
NEAR = 0.8  # seconds to the neighbour of the clause that is shown
CHANCES = (40, 200)  # turns of the speech that tell what chance gives


def exhibit_rates(material: ExhibitMaterial) -> MadeExhibit:
    """Table 1: how often hands and head move with what is said."""
    found = {a.name: count_cooccurrence(a.clips, a.speech, CHANCES[material.full]) for a in material.actors}
    rows: list[tuple[str, ...]] = []
    bars: list[tuple[PublishedRate, drawings.Bar]] = []
    for row in TABLE_1:
        low, high = compute_wilson_interval(row.matched, row.total)
        share = row.matched / row.total
        cells = (f"there: {row.actor}", row.hypothesis, f"{row.matched}", f"{row.total}", f"{row.printed} %")
        rows.append((*cells, f"{low:.0%} to {high:.0%}", "not told"))
        bars.append((row, ("paper", share, low, high)))
    for name, some in found.items():
        for r in some:
            cells = (f"here: {name}", r.hypothesis, f"{r.matched}", f"{r.total}", f"{r.rate:.0%}")
            rows.append((*cells, f"{r.low:.0%} to {r.high:.0%}", f"{r.chance:.0%}"))
    drawn = []
    for k, actor in enumerate(ACTORS):
        ours = list(found.values())[k] if k < len(found) else []
        for row, bar in bars:
            if row.actor != actor:
                continue
            same = [r for r in ours if r.hypothesis == row.hypothesis]
            beside: list[drawings.Bar] = [("ours", r.rate, r.low, r.high) for r in same if r.total]
            beside += [("s4", r.chance, None, None) for r in same if r.total]
            drawn.append((f"{_short(row.hypothesis)}, {k + 1}", [bar, *beside]))
    names = (("paper", "there"), ("ours", "here"), ("s4", "here by chance"))
    says = [
        "The paper tells no chance: hands move often, so many clauses have a movement near them whatever "
        "is said. Here the same speech is also laid elsewhere over the same motion.",
        _above(found),
    ]
    clauses = [
        len(s.text.split())
        for a in material.actors
        for said in a.speech
        for s in said
        if s.kind == "clause" and s.text
    ]
    if clauses:
        mean = sum(clauses) / len(clauses)
        spread = (sum((c - mean) ** 2 for c in clauses) / len(clauses)) ** 0.5
        there = ", ".join(f"{m:g} ± {d:g} ({a})" for a, (m, d) in WORDS_A_CLAUSE.items())
        says.append(f"Words a clause: {there} there, {mean:.2f} ± {spread:.2f} here.")
    if material.made_up:
        says.append(
            "Here the rates that were asked for are the paper's own; what is found differs by what could "
            "not be performed and by movements that come near by chance."
        )
    head = ("", "what", "matched", "segments", "rate", "95 %", "by chance")
    return MadeExhibit(
        material.about,
        tuple(says),
        (
            ExhibitTable("Speech and movement", head, tuple(rows)),
            ExhibitDrawing(
                "Rates with 95 % intervals (Wilson); 1 and 2: the two actors",
                drawings.draw_paired_bars(drawn, names, "share of segments", "Rates of table 1", 1.0),
            ),
        ),
        {n: {r.hypothesis: [r.matched, r.total, r.chance] for r in some} for n, some in found.items()},
    )


def _above(found: dict[str, list[CooccurrenceRow]]) -> str:
    told = []
    for name, rows in found.items():
        some = [
            f"{_short(r.hypothesis)} {r.rate:.0%} beside {r.chance:.0%}"
            for r in rows
            if r.total and r.low > r.chance
        ]
        told.append(f"{name}: {', '.join(some) or 'nothing'}")
    return f"Surely above chance (the interval's lower end): {'; '.join(told)}."


def _short(hypothesis: str) -> str:
    return (
        hypothesis.replace("partner's ", "")
        .replace("with the ", "")
        .replace("with a ", "")
        .replace("with ", "")
    )


def exhibit_window(material: ExhibitMaterial) -> MadeExhibit:
    """Figure 3: a segment, the window twice as long, and what is left of it between neighbours."""
    found = next(_clauses(material), None)
    if found is None:
        return MadeExhibit(material.about, missing="no clause with a movement and a neighbour near was found")
    clip, said, a, part, track = found
    idle = find_activation_speed(track)
    low, high = find_movement_windows([a], clip.duration, said)[0]
    moved = find_movement(track, clip.fps, (low, high), idle) or (low, low)
    middle, half = (a.start + a.end) / 2, a.end - a.start
    begin, end = max(0.0, middle - 1.6 * half), min(clip.duration, middle + 1.6 * half)

    def lane(css: str, start: float, until: float, words: str = "") -> drawings.Stretch:
        return css, max(start, begin) - begin, min(until, end) - begin, words

    near = [
        lane("s4", s.start, s.end, s.kind) for s in said if s.end > begin and s.start < end and s is not a
    ]
    shown = [
        ("A: the clause", [lane("paper", a.start, a.end, "clause")]),
        ("neighbours", near),
        ("B: twice as long", [lane("s9", middle - half, middle + half)]),
        ("C: trimmed", [lane("s1", low, high)]),
        ("what moved", [lane("ours", *moved)]),
    ]
    frames = range(round(begin * clip.fps), min(round(end * clip.fps), len(track)))
    curve = [(max(0.0, f / clip.fps - begin), float(track[f])) for f in frames]
    names = {
        f"speed of the {part.replace('_', ' ')}": ("ours", curve),
        "threshold of the take": ("paper", [(x, idle) for x, _ in curve]),
    }
    graph = drawings.draw_series(names, "seconds", "metres a second", "Speed of a hand about a clause")
    says = (
        f"A clause of {a.end - a.start:.2f} s in '{clip.name}' at {a.start:.2f} s. Nothing moves unless "
        f"something is faster than {idle:.2f} m/s (equation 1 over the take); the movement begins and ends "
        "by the same rule within within the window (equation 2).",
        "Neighbours are trimmed at half the gap, so that each moment is one segment's; the paper's figure "
        "leaves open where.",
    )
    return MadeExhibit(
        material.about,
        says,
        (
            ExhibitDrawing(
                "A, B and C as in the paper's figure", drawings.draw_spans(shown, end - begin, "Windows")
            ),
            ExhibitDrawing("What equations 1 and 2 look at", graph),
        ),
        {"take": clip.name, "clause": [a.start, a.end], "window": [low, high], "moved": list(moved)},
    )


def _clauses(material: ExhibitMaterial) -> Iterator[tuple[Clip, Sequence[Segment], Segment, Part, Any]]:
    """Yield takes with what is said, a clause that a movement goes with and a neighbour is near, the hand
    that moves most in the take, and its speed.
    """
    for actor in material.actors:
        for clip, said in zip(actor.clips, actor.speech, strict=True):
            speed = measure_part_speeds(clip)
            hands: list[Part] = [p for p in ("left_hand", "right_hand") if p in speed]
            if not hands:
                continue
            part = max(hands, key=lambda p: float(speed[p].max()))
            for a, b in pairwise(said):
                if a.kind != "clause" or b.start - a.end > NEAR:
                    continue
                around = find_movement_windows([a], clip.duration, said)[0]
                if (
                    find_movement(speed[part], clip.fps, around, find_activation_speed(speed[part]))
                    is not None
                ):
                    yield clip, said, a, part, speed[part]
