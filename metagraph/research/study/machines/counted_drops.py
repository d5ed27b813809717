"""What labelling with the meta-graph takes a person who has no proposals and labels many clips at once,
counted with the real edits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from metagraph.graph import edits
from metagraph.graph.expand import find_end_stance
from metagraph.graph.model import LAYERS, Action, Kind, MetaGraph, Project
from metagraph.research.study.machines.by_hand import make_batches
from metagraph.research.study.machines.counted_hand import OperatorCounts, strip_project
from metagraph.research.study.machines.klm import predict_seconds
from metagraph.research.study.machines.normal_machine import normalize_machines
from metagraph.research.study.scores.machines import Score, score


@dataclass(frozen=True)
class Dropped:
    """operators: of the hands. seconds: predicted. score: beside the reference."""

    operators: dict[str, int]
    seconds: float
    score: Score


def label_by_drops(reference: Project) -> Dropped:
    """Label a reference's clips stance by stance, all of a stance's gestures, fidgets and ways to one other
    stance at once: found by the shortest words, all selected, labelled by a key.
    """
    made, project = OperatorCounts(), strip_project(reference)
    library = {a.clip: reference.clips[a.clip].name for a in reference.actions()}
    here: dict[str, str] = {}  # the reference's stance -> the one made
    made.think()
    made.click()  # only what is not placed yet

    def find(clips: Sequence[str], drag: bool) -> list[list[str]]:
        out = []
        for batch, words in make_batches(library, clips):
            made.think(1 + words.count(" ") + words.count("|"))
            made.keys(4 + max(1, len(words)) + (2 if len(batch) > 1 else 0) + 1)
            made.drag() if drag else made.keys(1)
            out.append(batch)
        return out

    for layer in LAYERS:
        graph = reference.graphs[layer]
        if not graph.actions:
            continue
        made.think()
        made.keys(2)
        for stance in graph.stances.values():
            made.think()
            for batch in find([a.clip for a in graph.of(stance.id, "stance")], drag=True):
                if stance.id in here:
                    project = edits.place_clips(project, batch, layer, "stance", here[stance.id], None)
                else:
                    project = edits.add_stance(project, layer, stance.name, batch)
                    here[stance.id] = list(project.graphs[layer].stances)[-1]
        for stance in graph.stances.values():
            if stance.id not in here:
                continue
            made.think()
            made.keys(2)
            for kind, end, mine in _groups(graph, stance.id):
                if end is not None:
                    made.think()
                    made.click()
                    made.keys(1 + max(1, list(graph.stances).index(end)))
                made.think()
                for batch in find([a.clip for a in mine], drag=False):
                    project = edits.place_clips(
                        project, batch, layer, kind, here[stance.id], here[end] if end is not None else None
                    )
    found = score(normalize_machines(project, False), normalize_machines(reference, False))
    return Dropped(dict(made.counts), predict_seconds(made.counts), found)


def _groups(graph: MetaGraph, stance: str) -> list[tuple[Kind, str | None, Sequence[Action]]]:
    """Return what is labelled at once: ways by where they end, then fidgets, then gestures."""
    ways = graph.of(stance, "transition")
    ends = dict.fromkeys(find_end_stance(a) for a in ways)
    out: list[tuple[Kind, str | None, Sequence[Action]]] = [
        ("transition", e, [a for a in ways if find_end_stance(a) == e]) for e in ends
    ]
    kinds: tuple[Kind, ...] = ("fidget", "gesture")
    out += [(kind, None, mine) for kind in kinds if (mine := graph.of(stance, kind))]
    return out
