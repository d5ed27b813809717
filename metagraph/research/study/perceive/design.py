"""Who sees what in which order: sides and orders balanced, drawn from a secret, so that nobody chooses them.

Each person's pairs are a stretch of all pairs in a ring, comparisons taking turns; two sequences in a row
show the same stretch mirrored. After all sequences each pair was shown as often as every other one, as often
on each side. Which sequence a person gets is drawn in permuted blocks (`allocation.numbers`), the order
within it for each person again.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import gcd
from typing import Any, Literal

import msgspec
from msgspec import Struct

from metagraph.research.study.perceive.perceive_plan import PerceivePlan
from metagraph.research.study.plan.allocation import compute_commitment, draw_order_numbers, make_drawer

Kind = Literal["training", "choice", "rating", "told", "same"]
NAME_LENGTH = 20  # hexadecimal digits of a video's or a trial's name
Draw = Callable[..., int]


class Trial(Struct, frozen=True, forbid_unknown_fields=True):
    """left, right: names of videos; of a rating the one video is `left` and `right` is empty. told: of a
    check what it is said to answer: left, right, or a number of the scale. a, b: the conditions on the left
    and right.
    """

    id: str
    kind: Kind
    left: str
    item: str
    a: str
    right: str = ""
    b: str = ""
    told: str | int | None = None

    @property
    def public(self) -> list[Any]:
        """Return what the page may know."""
        return [self.id, self.kind, self.left, self.right, self.told]


class RatingSession(Struct, frozen=True, forbid_unknown_fields=True):
    """What one person goes through. number: of the sequence that was drawn."""

    number: int
    trials: tuple[Trial, ...]


class Key(Struct, frozen=True, forbid_unknown_fields=True):
    """What nobody who takes part may see. commitment: the secret's digest. design: the digest of what the
    page says. stimuli: name -> (condition, item).
    """

    perceive: int
    commitment: str
    design: str
    stimuli: dict[str, tuple[str, str]]
    sessions: dict[str, RatingSession]


@dataclass(frozen=True)
class Design:
    """A key, and what the page is given: `public`, whose sessions are sealed there, each with its code."""

    key: Key
    public: dict[str, Any]


def name_stimulus(draw: Draw, condition: str, item: str) -> str:
    """Return what a video is called: nobody without the secret can tell what of."""
    return f"{draw('video', condition, item):064x}"[:NAME_LENGTH]


def make_design(plan: PerceivePlan, secret: str) -> Design:
    """Return who sees what: the same for the same plan and secret for ever."""
    draw = make_drawer(secret)
    used = list(dict.fromkeys(c for pair in plan.pairs for c in pair)) if plan.rating is None else []
    used = used or list(plan.conditions)
    stimuli = {name_stimulus(draw, c, i.id): (c, i.id) for c in used for i in plan.items}
    taken = draw_order_numbers(secret, count_sequences(plan), 1)  # all are drawn before anybody comes
    sessions = {who: _session(plan, draw, who, next(taken)) for who in plan.ids}
    public = {
        "perceive": plan.perceive,
        "title": plan.title,
        "consent": plan.consent,
        "instructions": plan.instructions,
        "thanks": plan.thanks,
        "choice": None
        if plan.choice is None
        else {"question": plan.choice.question, "present": plan.choice.present},
        "rating": [] if plan.rating is None else [_question(q) for q in plan.rating.questions],
        "size": [plan.video.width, plan.video.height],
        "sessions": {who: [t.public for t in s.trials] for who, s in sessions.items()},
    }
    digest = hashlib.sha256(msgspec.json.encode(public, order="sorted")).hexdigest()
    public["design"] = digest
    return Design(Key(plan.perceive, compute_commitment(secret), digest, stimuli, sessions), public)


def _question(item: Any) -> dict[str, Any]:
    scale = item.scale
    return {
        "id": item.id,
        "title": item.title,
        "text": item.text,
        "points": list(scale.points),
        "left": scale.left,
        "right": scale.right,
        "optional": item.optional,
    }


def count_sequences(plan: PerceivePlan) -> int:
    """Return how many sequences there are until all is balanced."""
    out = 1
    if plan.choice is not None:
        count = len(plan.pairs) * len(plan.items)
        each = plan.choice.each or count
        out = 2 * (count // gcd(count, each))
    if plan.rating is not None:
        count = len(plan.items)
        turns = count // gcd(count, plan.rating.each or count)
        out = out * turns // gcd(out, turns)
    return out


def _session(plan: PerceivePlan, draw: Draw, who: str, number: int) -> RatingSession:
    trials: list[Trial] = []

    def add(kind: Kind, item: str, a: str, b: str = "", told: str | int | None = None) -> None:
        left = name_stimulus(draw, a, item)
        right = name_stimulus(draw, b, item) if b else ""
        name = f"{draw('trial', who, len(trials)):064x}"[:NAME_LENGTH]
        trials.append(Trial(name, kind, left, item, a, right, b, told))

    for block, shown in (("choice", _choices(plan, draw, number)), ("rating", _ratings(plan, draw, number))):
        if not shown:
            continue
        shown = _apart(sorted(shown, key=lambda s: draw("order", who, block, *s)))
        for n in range(plan.training):
            item, a, b = shown[draw("training", who, block, n) % len(shown)]
            add("training", item, a, b)
        checks: list[tuple[Kind, int]] = [("told", n) for n in range(plan.checks.told)]
        if block == "choice":
            checks += [("same", n) for n in range(plan.checks.same)]
        checks.sort(key=lambda c: draw("check", who, block, *c))
        places = _places(draw, who, block, len(shown), len(checks))
        turned = draw("told side", who) % 2
        for place in range(len(shown) + 1):
            for kind, n in (c for c, at in zip(checks, places, strict=True) if at == place):
                item, a, b = shown[draw("checked", who, block, kind, n) % len(shown)]
                if kind == "same":
                    add("same", item, a, a)
                elif block == "choice":
                    add("told", item, a, b, ("left", "right")[(n + turned) % 2])
                else:
                    add("told", item, a, "", _told_number(plan, draw(who, "number", n)))
            if place < len(shown):
                item, a, b = shown[place]
                add("choice" if b else "rating", item, a, b)
    return RatingSession(number, tuple(trials))


def _told_number(plan: PerceivePlan, drawn: int) -> int:
    """Return a number all scales have."""
    assert plan.rating is not None
    scales = [q.scale.points for q in plan.rating.questions if q.scale is not None]
    shared = [p for p in scales[0] if all(p in s for s in scales)] or list(scales[0])
    return shared[drawn % len(shared)]


def _choices(plan: PerceivePlan, draw: Draw, number: int) -> list[tuple[str, str, str]]:
    """Return the pairs of a sequence: item, left, right."""
    if plan.choice is None:
        return []
    rows = [
        sorted(((i.id, n) for i in plan.items), key=lambda s: draw("item", *s))
        for n in range(len(plan.pairs))
    ]
    # Comparisons take turns, each with its items from another place on, so that a stretch repeats few items.
    ring = [
        rows[n][(k + n * len(plan.items) // len(rows)) % len(plan.items)]
        for k in range(len(plan.items))
        for n in range(len(rows))
    ]
    each = plan.choice.each or len(ring)
    first = number // 2 * each
    out, seen = [], [0] * len(rows)
    for k in range(each):
        item, n = ring[(first + k) % len(ring)]
        a, b = plan.pairs[n]
        turned = (seen[n] + n + number) % 2
        seen[n] += 1
        out.append((item, b, a) if turned else (item, a, b))
    return out


def _ratings(plan: PerceivePlan, draw: Draw, number: int) -> list[tuple[str, str, str]]:
    """Return the videos of a sequence: item, condition, nothing. An item is rated in every condition."""
    if plan.rating is None:
        return []
    items = sorted((i.id for i in plan.items), key=lambda i: draw("rated", i))
    each = plan.rating.each or len(items)
    mine = [items[(number * each + k) % len(items)] for k in range(each)]
    return [(i, c, "") for i in mine for c in plan.conditions]


def _apart(shown: Sequence[tuple[str, str, str]]) -> list[tuple[str, str, str]]:
    """Return the same in nearly the same order, an item never twice in a row if that can be."""
    left = list(shown)
    out: list[tuple[str, str, str]] = []
    while left:
        counts: dict[str, int] = {}
        for item, _, _ in left:
            counts[item] = counts.get(item, 0) + 1
        last = out[-1][0] if out else ""
        most = max((c for i, c in counts.items() if i != last), default=0)
        pressing = 2 * most > len(left)  # it must come now, or will come twice in a row
        n = next(
            (n for n, s in enumerate(left) if s[0] != last and (not pressing or counts[s[0]] == most)), 0
        )
        out.append(left.pop(n))
    return out


def _places(draw: Draw, who: str, block: str, count: int, checks: int) -> list[int]:
    """Return before which trial each check comes: one somewhere in each of as many parts."""
    out = []
    for n in range(checks):
        low, high = 1 + n * count // checks, max(1 + n * count // checks, (n + 1) * count // checks)
        out.append(min(count, low + draw("place", who, block, n) % (high - low + 1)))
    return out
