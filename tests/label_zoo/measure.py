"""How right proposals are, how well they know it, and how much a person's looking helps."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from metagraph.graph.model import Project
from metagraph.suggest.flags import needs_look
from metagraph.suggest.memory import Memory
from metagraph.suggest.proposal import Proposal, Proposals, simplify_stance_name
from metagraph.suggest.propose import SOURCES, accept, list_waiting_clips, propose
from metagraph.suggest.review import Review
from metagraph.suggest.whole_body import CARRIER

FIELDS = ("kind", "stance", "end_stance", "layer", "limb")
DECIDING = ("kind", "layer", "stance", "end_stance")  # where a clip goes: what makes it right or wrong
BINS = (0.0, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0001)
CAUSES = ("unsure", "conflict", "jumps", "left")
SURE = 0.9  # below it a flag counts as one of the unsure

Truth = Mapping[str, Mapping[str, Any]]
Proposer = Callable[..., Proposals]  # as `propose`


@dataclass(frozen=True, eq=False)
class LabelSet:
    """A set to measure on: its projects, one of each skeleton, and what is true. seen: whether somebody who
    writes the product looked at it. made_from: the sets it is made of. what: words to group it by.
    """

    name: str
    projects: Sequence[Project]
    truth: Truth
    seen: bool = True
    made_from: tuple[str, ...] = ()
    what: tuple[str, ...] = ()

    @property
    def family(self) -> frozenset[str]:
        """The set and those it is made of."""
        return frozenset({self.name, *self.made_from})


def others(sets: Iterable[LabelSet], one: LabelSet, siblings: bool = False) -> list[LabelSet]:
    """Return the sets that may be learned from where `one` measures: none made from it, and none that it is
    made from. siblings: also those made from the same.
    """
    return [
        s
        for s in sets
        if s.name != one.name
        and one.name not in s.made_from
        and s.name not in one.made_from
        and (siblings or not s.family & one.family)
    ]


@dataclass
class Tally:
    """What was counted. right, there: by field; "none": clips that are none of the four kinds, and how many
    of them are marked so; "clip": all that decides is right. flags: flagged, wrong, both (of those that
    should be), clips, and causes. sure: by field, for each of BINS how many, how many right, and the sum of
    what was said. placed: how many of clips the product places by itself.
    """

    right: Counter[str] = field(default_factory=Counter)
    there: Counter[str] = field(default_factory=Counter)
    flags: Counter[str] = field(default_factory=Counter)
    sure: dict[str, list[list[float]]] = field(default_factory=dict)
    placed: int = 0
    clips: int = 0

    def __iadd__(self, other: Tally) -> Tally:
        self.right.update(other.right)
        self.there.update(other.there)
        self.flags.update(other.flags)
        for name, rows in other.sure.items():
            mine = self.sure.setdefault(name, [[0, 0, 0.0] for _ in BINS[1:]])
            for row, new in zip(mine, rows, strict=True):
                for k in range(3):
                    row[k] += new[k]
        self.placed += other.placed
        self.clips += other.clips
        return self

    def believed(self, name: str, confidence: float, right: bool) -> None:
        """Count a belief."""
        rows = self.sure.setdefault(name, [[0, 0, 0.0] for _ in BINS[1:]])
        row = rows[next(k for k, top in enumerate(BINS[1:]) if confidence < top)]
        row[0] += 1
        row[1] += right
        row[2] += confidence

    def calibration(self, name: str) -> float:
        """Return how far what is said is from how often it is right, on average over BINS; 0 of nothing."""
        rows = self.sure.get(name, [])
        count = sum(r[0] for r in rows)
        return sum(abs(r[1] - r[2]) for r in rows) / count if count else 0.0

    def to_json(self) -> dict[str, Any]:
        """Return plain values."""
        return {
            "right": dict(self.right),
            "there": dict(self.there),
            "flags": dict(self.flags),
            "sure": self.sure,
            "placed": self.placed,
            "clips": self.clips,
        }


def none_of_the_four(row: Mapping[str, Any]) -> bool:
    """Whether the truth says that a clip is no clip of a conversation."""
    return not any(row.get(name) for name in FIELDS)


def said_none(p: Proposal | None) -> bool:
    """Whether the product says so."""
    return p is None or p.kind.value in (None, "none", "other")


def meanings(project: Project, truth: Truth, found: Proposals) -> dict[str, str]:
    """Return which stance of the truth each proposed one is: that of most clips proposed for it."""
    votes: dict[str, Counter[str]] = defaultdict(Counter)
    for ident, entry in project.clips.items():
        row, p = truth.get(entry.name), found.proposals.get(ident)
        if row is not None and row["stance"] is not None and p is not None and p.stance is not None:
            votes[p.stance.value][row["stance"]] += 1
    return {key: some.most_common(1)[0][0] for key, some in votes.items()}


def verdict(
    p: Proposal | None, row: Mapping[str, Any], meant: Mapping[str, str], whole: bool = False
) -> dict[str, bool]:
    """Return for each field the truth speaks of whether the proposal is right. whole: one layer plays the
    whole body, so that it is right for whatever a clip moves.
    """
    out = {}
    for name in FIELDS:
        if row.get(name) is None:
            continue
        belief = getattr(p, name) if p is not None else None
        value = belief.value if belief is not None else None
        out[name] = (meant.get(str(value)) if "stance" in name else value) == row[name]
        if name == "layer" and whole and value == CARRIER:
            out[name] = True
    return out


def right_clip(
    p: Proposal | None, row: Mapping[str, Any], meant: Mapping[str, str], whole: bool = False
) -> bool:
    """Whether all that decides where a clip goes is right, as far as the truth speaks of it."""
    if none_of_the_four(row):
        return said_none(p)
    told = verdict(p, row, meant, whole)
    return all(told[name] for name in DECIDING if name in told)


def measured(project: Project, truth: Truth, found: Proposals) -> Tally:
    """Return how right proposals are, whether those that are wrong are flagged, and what is sure."""
    out, meant = Tally(), meanings(project, truth, found)
    taken = accept(project, found)
    out.placed, out.clips = len(taken.placed), len(project.clips)
    for ident, entry in project.clips.items():
        row, p = truth.get(entry.name), found.proposals.get(ident)
        if row is None:
            continue
        right = right_clip(p, row, meant, found.whole)
        if none_of_the_four(row):
            out.there["none"] += 1
            out.right["none"] += said_none(p)
            if said_none(p):
                continue
        else:
            out.there["clip"] += 1
            out.right["clip"] += right
        for name, good in verdict(p, row, meant, found.whole).items():
            out.there[name] += 1
            out.right[name] += good
            if p is not None and (belief := getattr(p, name)) is not None:
                out.believed(name, belief.confidence, good)
        if p is None:
            continue
        out.believed("clip", p.confidence, right)
        flagged = needs_look(p, taken.left)
        out.flags.update({"clips": 1, "flagged": flagged, "wrong": not right, "both": flagged and not right})
        reasons = (p.confidence < SURE, bool(p.conflicts), p.good is False, p.clip in taken.left)
        for cause, is_ in zip(CAUSES, reasons, strict=True):
            out.flags[cause] += is_
            out.flags[f"{cause} wrong"] += is_ and not right
    return out


# -- a person who looks
# --------------------------------------------------------------------------------------------------


def looked(
    project: Project, truth: Truth, looks: Collection[int], propose_: Proposer = propose
) -> dict[int, Counter[str]]:
    """Return what is right after so many looks: a person goes through the clips in the product's order,
    corrects what is wrong and takes over what is right; what was corrected is learned from. By looks: "rest",
    "rest right" of the clips not looked at; "all", "all right" of all; "told": fields that were corrected.

    Clips that are none of the four are looked at and left; they count as no clips here.
    """
    memory, out, told = Memory(), dict[int, Counter[str]](), 0
    review = Review(_proposals(project, None, memory, propose_)).settled(project)
    order = [c for c in review.order() if project.clips[c].name in truth]
    names = [entry.name for entry in project.clips.values()]
    for n in range(max(looks) + 1):
        if n in looks:
            out[n] = _state(project, truth, review, set(order[:n]), told)
        if n >= max(looks) or n >= len(order):
            continue
        clip = order[n]
        row = truth[project.clips[clip].name]
        if none_of_the_four(row):
            continue
        before = review.said.get(clip, {})
        review = corrected(project, truth, review, clip)
        fresh = {k: v for k, v in review.said.get(clip, {}).items() if before.get(k) != v}
        told += len(fresh)
        project = review.take(project, [clip]).project
        review = review.settled(project)
        for name, value in fresh.items():
            memory = memory.corrected(project.clips[clip].name, name, value, names)
        if fresh and (left := [c for c in review.found.proposals if c in set(list_waiting_clips(project))]):
            review = review.anew(_proposals(project, left, memory, propose_)).settled(project)
    for n in looks:
        out.setdefault(n, _state(project, truth, review, set(order), told))
    return out


def _proposals(project: Project, clips: list[str] | None, memory: Memory, propose_: Proposer) -> Proposals:
    return propose_(project, clips, patterns=memory.patterns, sources=SOURCES)


def read(project: Project, truth: Truth, found: Proposals) -> dict[str, str]:
    """Return which stance of the truth a person takes each proposed one for: by its name if that is one's,
    else by its clips.
    """
    stances = {_alike(row["stance"]): row["stance"] for row in truth.values() if row["stance"]}
    named = {key: stances.get(_alike(place.name)) for key, place in found.places.items()}
    return meanings(project, truth, found) | {key: stance for key, stance in named.items() if stance}


def _alike(name: str) -> str:
    """Return a stance's name as a person compares it: 'Idle01' is 'idle 1'."""
    return " ".join(str(int(w)) if w.isdecimal() else w for w in simplify_stance_name(name).split())


def corrected(project: Project, truth: Truth, review: Review, clip: str) -> Review:
    """Return the review with what is wrong about a clip put right, as a person would."""
    row = truth[project.clips[clip].name]
    for name in ("layer", "kind", "stance", "end_stance", "limb"):
        p = review.found.proposals[clip]
        meant = read(project, truth, review.found)
        if name not in row or row[name] is None or verdict(p, row, meant, review.found.whole)[name]:
            continue
        value = row[name]
        if name in ("stance", "end_stance"):
            value = _place(review, p, str(value), meant)
        elif name == "limb" and (p.layer.value != "arms" or p.kind.value == "stance"):
            continue
        review = review.tell(clip, name, value)  # type: ignore[arg-type]
    return review


def _place(review: Review, p: Proposal, stance: str, meant: Mapping[str, str]) -> str:
    """Return what a person would choose for a stance: the one of that name, else the one whose clips are
    mostly of it, else a new one.
    """
    mine = {k: x.name for k, x in review.found.places.items() if x.layer == p.layer.value}
    named = [name for name in mine.values() if _alike(name) == _alike(stance)]
    used = Counter(x.stance.value for x in review.found.proposals.values() if x.stance is not None)
    meaning = sorted((k for k in mine if meant.get(k) == stance), key=lambda k: (-used[k], k))
    return named[0] if named else mine[meaning[0]] if meaning else stance


def _state(project: Project, truth: Truth, review: Review, seen: set[str], told: int) -> Counter[str]:
    meant, out = read(project, truth, review.found), Counter[str]({"told": told})
    for ident, entry in project.clips.items():
        row = truth.get(entry.name)
        if row is None or none_of_the_four(row):
            continue
        right = right_clip(review.found.proposals.get(ident), row, meant, review.found.whole)
        out.update({"all": 1, "all right": right})
        if ident not in seen:
            out.update({"rest": 1, "rest right": right})
    return out
