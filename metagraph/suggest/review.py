"""Let a person review proposals: what they correct, what is still open, and how long the rest will take.

Stances come first, the most used before the others, because everything else depends on them; then the clips
for which a check gains most. A correction is kept as it was meant, a stance by its name, so that it still
holds when proposals are made again.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from statistics import median
from typing import Any, Literal

from metagraph.common.wording import phrase
from metagraph.errors import describe_error
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.model import KINDS, LAYERS, LIMBS, Layer, Project
from metagraph.suggest.accept import AcceptedProposals, accept
from metagraph.suggest.details import with_timing
from metagraph.suggest.estimate import Belief
from metagraph.suggest.flags import estimate_gain
from metagraph.suggest.proposal import Proposal, Proposals, StancePlace, simplify_stance_name
from metagraph.suggest.propose import list_waiting_clips

Field = Literal["kind", "layer", "stance", "end_stance", "limb", "tags", "timing"]
DECIDING: tuple[Field, ...] = (
    "kind",
    "layer",
    "stance",
    "end_stance",
    "limb",
)  # fields with a few values to choose from
WORDS: tuple[Field, ...] = ("kind", "layer", "limb", "tags")
SAID = phrase("you chose it")
USUAL = 6.0  # seconds that a clip takes at first, before the pace is known
PAUSE = 60.0  # seconds: a longer pause is an absence, not a decision
REMEMBERED = 25  # latest decisions that the pace is computed from


@dataclass(frozen=True)
class Review:
    """The proposals with a person's corrections.

    `found` has the corrected proposals. `said` is clip -> field -> value: stances by name, tags as a tuple,
    timing as fields of `Timing`.
    """

    found: Proposals
    said: Mapping[str, Mapping[Field, Any]] = field(default_factory=dict)

    def tell(self, clip: str, name: Field, value: Any) -> Review:
        """Correct one field of a clip's proposal. A stance with a new name becomes a new one."""
        old = self.said.get(clip, {})
        if name == "timing":
            value = {**old.get("timing", {}), **value}
        if name == "layer" and value != self.found.proposals[clip].layer.value:
            old = {
                k: v for k, v in old.items() if k not in ("stance", "end_stance")
            }  # they belong to the other layer
        said = {**old, name: value}
        return Review(_corrected(self.found, clip, said), {**self.said, clip: said})

    def anew(self, found: Proposals) -> Review:
        """Return the review of new proposals for the same clips, with the corrections kept. Clips that are
        not among them keep their proposals.
        """
        mine = {c: p for c, p in self.found.proposals.items() if c not in found.proposals}
        found = replace(
            found,
            proposals={**mine, **found.proposals},
            places={**self.found.places, **found.places},
            aside={**{c: x for c, x in self.found.aside.items() if c not in found.proposals}, **found.aside},
            whole=self.found.whole or found.whole,
        )
        for clip, said in self.said.items():
            if clip in found.proposals:
                found = _corrected(found, clip, said)
        return Review(found, self.said)

    def settled(self, project: Project) -> Review:
        """Return the review with stances that were made in the meantime as the project's, and those that were
        removed as ones to be made.

        Call it after every change of the project, because the id of a removed stance may be used again for
        another one.
        """
        moved: dict[str, str] = {}
        places: dict[str, StancePlace] = {}
        named = {
            (s.layer, simplify_stance_name(s.name)): s
            for layer in LAYERS
            for s in project.graphs[layer].stances.values()
        }
        for key, place in self.found.places.items():
            stance = project.stance(key) or named.get((place.layer, simplify_stance_name(place.name)))
            if stance is not None:
                new = replace(place, key=stance.id, layer=stance.layer, name=stance.name, there=True)
            elif place.there:
                new = replace(place, key=f"new {place.layer} {simplify_stance_name(place.name)}", there=False)
            else:
                new = place
            moved[key] = new.key
            places.setdefault(new.key, new)
        for stance in named.values():
            places.setdefault(stance.id, StancePlace(stance.id, stance.layer, stance.name, True))
        proposals = {
            clip: replace(p, stance=_moved(p.stance, moved), end_stance=_moved(p.end_stance, moved))
            for clip, p in self.found.proposals.items()
        }  # fmt: skip
        return Review(replace(self.found, proposals=proposals, places=places), self.said)

    def order(self) -> list[str]:
        """Return the clips in the best order to review: stances first, the most used before the others,
        because a layer begins in its first stance and the first gives the base pose; then those for which a
        check gains most.
        """
        used = Counter(p.stance.value for p in self.found.proposals.values() if p.stance is not None)

        def rank(p: Proposal) -> tuple[Any, ...]:
            rests = p.kind.value == "stance"
            return (
                not rests,
                -used[p.stance.value] if rests and p.stance is not None else 0,
                -estimate_gain(p),
                p.confidence,
                p.clip,
            )

        return [p.clip for p in sorted(self.found.proposals.values(), key=rank)]

    def choices(self, clip: str, name: Field) -> list[tuple[Any, str]]:
        """Return the values of a deciding field, as pairs of value and words. The project's stances come
        first, then the most used ones.
        """
        p = self.found.proposals[clip]
        if name == "kind":
            return [(k, k) for k in KINDS]
        if name == "layer":
            return [(x, x) for x in LAYERS]
        if name == "limb":
            return [(x, x) for x in LIMBS] if p.layer.value == "arms" and p.kind.value != "stance" else []
        if name not in ("stance", "end_stance") or (name == "end_stance" and p.kind.value != "transition"):
            return []
        spoken = Counter(x.stance.value for x in self.found.proposals.values() if x.stance is not None)
        mine = [place for place in self.found.places.values() if place.layer == p.layer.value]
        start = p.stance.value if p.stance is not None else None
        mine = [place for place in mine if name == "stance" or place.key != start]
        return [
            (place.name, place.name)
            for place in sorted(mine, key=lambda x: (not x.there, -spoken[x.key], x.name))
        ]

    def value(self, clip: str, name: Field) -> Any:
        """Return the current value of a deciding field, as in `choices`; None if it is unknown."""
        belief = getattr(self.found.proposals[clip], name)
        if belief is None:
            return None
        return self.found.places[belief.value].name if name in ("stance", "end_stance") else belief.value

    def doubtful(self, clip: str) -> Field:
        """Return the least certain deciding field."""
        p = self.found.proposals[clip]
        beliefs: dict[Field, Belief[Any] | None] = {
            n: getattr(p, n) for n in DECIDING if self.choices(clip, n)
        }
        return min(beliefs, key=lambda n: belief.confidence if (belief := beliefs[n]) is not None else -1.0)

    def take(self, project: Project, clips: Collection[str], above: float = 0.0) -> AcceptedProposals:
        """Return the project with clips placed as proposed, together with resting clips for the stances they
        need that do not exist yet. A clip that is placed already is placed again.
        """
        known = [c for c in clips if c in self.found.proposals and c in project.clips]
        open_ = set(list_waiting_clips(project))
        again = [a.id for c in known if c not in open_ for a in project.uses.get(c, ())]
        try:
            bare = edits.remove_actions(project, again) if again else project
        except EditError as error:
            return AcceptedProposals(project, (), dict.fromkeys(known, describe_error(error)))
        wanted = [c for c in known if self.found.proposals[c].confidence >= above]
        along = {r for c in wanted for r in self._resting(bare, c)}
        taken = accept(bare, self.found, 0.0, {*wanted, *along})
        if (again and taken.left) or not set(wanted) & set(taken.placed):
            return AcceptedProposals(
                project, (), taken.left
            )  # nothing is placed for nothing, and nothing placed is lost
        return taken

    def timed(self, project: Project, clip: str) -> Proposal:
        """Return a clip's proposal with the times that the statistics give it as what it is now, and with
        corrected times.
        """
        return self.timed_all(project, [clip])[0]

    def timed_all(self, project: Project, clips: Sequence[str]) -> list[Proposal]:
        """Return the proposals of clips, each as `timed` does."""
        found = with_timing(project, self.found.proposals)
        out = []
        for clip in clips:
            p, said = found[clip], self.said.get(clip, {}).get("timing")
            out.append(replace(p, timing={**p.timing, **said}) if said else p)
        return out

    def with_former(self, former: Review, clips: Sequence[str]) -> Review:
        """Return the review with the proposals of some clips, and what was said of them, as in an earlier
        one.
        """
        mine = {clip: former.found.proposals[clip] for clip in clips}
        found = replace(
            self.found,
            proposals={**self.found.proposals, **mine},
            places={**former.found.places, **self.found.places},
        )
        said = {clip: what for clip, what in self.said.items() if clip not in mine}
        return Review(found, said | {clip: former.said[clip] for clip in clips if clip in former.said})

    def with_times(self, p: Proposal) -> Review:
        """Return the review with what `timed` found, unless the clip has been changed to something else in
        the meantime.
        """
        mine = self.found.proposals.get(p.clip)
        if mine is None or _decides(mine) != _decides(p):
            return self
        mine = replace(
            mine,
            timing={**p.timing, **mine.timing},
            timing_reason=p.timing_reason,
            good=p.good,
            details=p.details,
        )
        return Review(replace(self.found, proposals={**self.found.proposals, p.clip: mine}), self.said)

    def _resting(self, project: Project, clip: str) -> list[str]:
        """Return the most certain unplaced clips that rest in stances that this clip needs and the project
        does not have.
        """
        p = self.found.proposals[clip]
        out, open_ = [], set(list_waiting_clips(project))
        for belief in (p.stance, p.end_stance if p.kind.value == "transition" else None):
            if (
                belief is None
                or project.stance(belief.value) is not None
                or (belief is p.stance and p.kind.value == "stance")
            ):
                continue
            rests = [
                x
                for x in self.found.proposals.values()
                if x.kind.value == "stance"
                and x.stance is not None
                and x.stance.value == belief.value
                and x.clip in open_
            ]
            if rests:
                out.append(max(rests, key=lambda x: x.confidence).clip)
        return out


def _moved(belief: Belief[str] | None, moved: Mapping[str, str]) -> Belief[str] | None:
    return belief if belief is None else replace(belief, value=moved.get(belief.value, belief.value))


def _corrected(found: Proposals, clip: str, said: Mapping[Field, Any]) -> Proposals:
    """Return the proposals with the corrections of one clip."""
    p, places = found.proposals[clip], dict(found.places)
    words: dict[str, Any] = {name: Belief(said[name], 1.0, SAID) for name in WORDS if name in said}
    p = replace(p, **words)
    layer: Layer = p.layer.value

    def place(name: str) -> str:
        for key, there in places.items():
            if there.layer == layer and simplify_stance_name(there.name) == simplify_stance_name(name):
                return key
        key = f"new {layer} {simplify_stance_name(name)}"
        places[key] = StancePlace(key, layer, name)
        return key

    stance = p.stance
    if "stance" in said:
        stance = Belief(place(said["stance"]), 1.0, SAID)
    elif stance is not None and places[stance.value].layer != layer:
        # The other layer's stance of the same name, if there is one; else the one with most of its clips.
        name = simplify_stance_name(places[stance.value].name)
        same = next(
            (k for k, x in places.items() if x.layer == layer and simplify_stance_name(x.name) == name), None
        )
        there = Counter(
            x.stance.value
            for x in found.proposals.values()
            if x.stance is not None and places[x.stance.value].layer == layer
        )
        best = same or next(
            (k for k, _ in there.most_common(1)),
            next((k for k, x in places.items() if x.layer == layer), None),
        )
        stance = Belief(best, 0.5, phrase("most clips of this layer are there")) if best is not None else None
    end = p.end_stance if p.kind.value == "transition" else None
    if "end_stance" in said and p.kind.value == "transition":
        end = Belief(place(said["end_stance"]), 1.0, SAID)
    if end is not None and (
        places[end.value].layer != layer or (stance is not None and end.value == stance.value)
    ):
        end = None
    if layer != "arms":
        p = replace(p, limb=Belief("both", 0.9, phrase("only arms have sides")))
    was = found.proposals[clip]
    if (p.kind.value, p.layer.value, stance and stance.value, end and end.value) != _decides(was):
        # Its times were for what it is not; `Review.timed` finds the right ones.
        p = replace(
            p,
            timing={},
            timing_reason="",
            good=None,
            details={k: v for k, v in p.details.items() if k == "likelihood"},
        )
    if "timing" in said:
        p = replace(p, timing={**p.timing, **said["timing"]})
    # The disagreement of the sources is decided.
    conflicts = () if {"kind", "stance", "end_stance", "layer"} & set(said) else p.conflicts
    p = replace(p, stance=stance, end_stance=end, conflicts=conflicts)
    return replace(found, proposals={**found.proposals, clip: p}, places=places)


def _decides(p: Proposal) -> tuple[Any, ...]:
    return p.kind.value, p.layer.value, p.stance and p.stance.value, p.end_stance and p.end_stance.value


class ReviewPace:
    """Measures how long decisions take, and estimates the rest of the work."""

    def __init__(self) -> None:
        self.seconds: list[float] = []

    def decided(self, seconds: float) -> None:
        """Count a decision. A pause longer than PAUSE is not counted."""
        if seconds <= PAUSE:
            self.seconds.append(seconds)

    @property
    def known(self) -> bool:
        """Return whether there were enough decisions for an estimate."""
        return len(self.seconds) >= 3

    @property
    def each(self) -> float:
        """Return the seconds that a clip takes lately."""
        return median(self.seconds[-REMEMBERED:]) if self.known else USUAL

    def left(self, clips: int) -> float:
        """Return the seconds of work that remain for this number of clips."""
        return clips * self.each
