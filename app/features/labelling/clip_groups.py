"""Clips that are taken for the same: the groups in which a review can be gone through."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.features.labelling.review_watch import order_similar
from app.translation import tr, tr_plural
from app.widgets.vocabulary import get_vocabulary_title
from metagraph.graph.model import Kind, Layer
from metagraph.suggest.flags import estimate_chance_wrong, needs_look
from metagraph.suggest.proposal import Proposal
from metagraph.suggest.review import Review


@dataclass(frozen=True)
class ClipGroup:
    """`clips` wait, the likeliest to be wrong first, and are all taken for one kind on one layer, out of the
    stance with the name `stance`. A layer's stances form one group, and so do its transitions; their
    `stance` is "".
    """

    layer: Layer
    kind: Kind
    stance: str
    clips: tuple[str, ...]

    @property
    def key(self) -> tuple[str, str, str]:
        """Return what tells the group from others."""
        return self.layer, self.kind, self.stance

    @property
    def title(self) -> str:
        """Return the group in words, such as "Gesture · idle 1"."""
        where = self.stance or get_vocabulary_title(self.layer)
        return tr("{kind} · {where}", kind=get_vocabulary_title(self.kind), where=where)

    def count(self) -> str:
        """Return the number of clips in words."""
        return tr_plural("{count:,} clip", "{count:,} clips", len(self.clips))


def is_doubtful(p: Proposal) -> bool:
    """Return whether a clip should be looked at before its proposal is accepted: report and command say so,
    or its times show a jump.
    """
    return needs_look(p) or p.good is False


def group_alike(review: Review, waiting: Sequence[str]) -> list[ClipGroup]:
    """Return the groups of clips that wait: stances first, then the largest."""
    found, groups = review.found, dict[tuple[Layer, Kind, str], list[str]]()
    for clip in order_similar(review, waiting):
        p = found.proposals[clip]
        place = found.places.get(p.stance.value) if p.stance is not None else None
        alone = p.kind.value in ("gesture", "fidget")
        stance = place.name if place is not None and alone else ""
        groups.setdefault((p.layer.value, p.kind.value, stance), []).append(clip)
    wrong = lambda clip: -estimate_chance_wrong(found.proposals[clip])  # noqa: E731
    made = [ClipGroup(*key, tuple(sorted(clips, key=wrong))) for key, clips in groups.items()]
    return sorted(made, key=lambda g: (g.kind != "stance", -len(g.clips)))
