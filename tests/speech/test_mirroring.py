"""Listeners take up the posture of who speaks."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np

from metagraph.graph.conversation.model import Conversation, Rates, Segment, Side
from metagraph.graph.model import Project
from metagraph.playback.plan import Plan
from metagraph.speech.drive import drive
from metagraph.speech.duet import plan_duet
from metagraph.speech.mirroring import Mover, list_mirrored_stances, measure_stance_shapes


def talk(mirror: float = 1.0, seed: int = 1) -> Conversation:
    """One tells, in turns of 6 s with pauses; the other listens all the time."""
    said = tuple(Segment("clause", 2.0 + 8 * n, 8.0 + 8 * n, 5.0 + 8 * n, f"w{n}") for n in range(12))
    sides = (Side(name="Ann", segments=said), Side(name="Ben", rates=Rates(mirror=mirror)))
    return Conversation(name="talk", length=100.0, sides=sides, seed=seed)


def found(project: Project, conversation: Conversation, side: int = 1) -> list[tuple[float, str]]:
    movers = [Mover(n, project, drive(conversation, n, project)[1]) for n in range(len(conversation.sides))]
    own = movers.pop(side)
    return [(a.at or 0.0, a.stance) for a in list_mirrored_stances(conversation, own, movers)]


def test_nothing_is_mirrored_at_a_rate_of_nought_or_where_nobody_changes(sample: Project) -> None:
    assert not found(sample, talk(0.0))
    still = Plan(1, 100.0)
    assert not list(list_mirrored_stances(talk(), Mover(1, sample, still), [Mover(0, sample, still)]))


def test_a_project_without_a_skeleton_or_with_one_stance_mirrors_nothing(sample: Project) -> None:
    assert measure_stance_shapes(Project()) == {}
    bare = Mover(1, Project(), Plan(1, 9.0))
    assert not list(list_mirrored_stances(talk(), bare, [Mover(0, sample, Plan(1, 9.0))]))


def test_the_stance_on_the_other_foot_is_taken_up_as_in_a_mirror(sample: Project) -> None:
    names = {i: s.name for i, s in sample.graphs["body"].stances.items()}
    conversation = talk()
    seen = drive(conversation, 0, sample)[1]
    mirror = {"weight left": "weight right", "weight right": "weight left", "weight both": "weight both"}
    taken = found(sample, conversation)
    assert taken
    for at, stance in taken:
        theirs = names[seen.layers["body"].stance_at(at - 0.01) or ""]
        assert names[stance] == mirror.get(theirs, theirs)


def test_who_speaks_mirrors_nobody(sample: Project) -> None:
    assert not found(sample, talk(), side=0)
    conversation = talk()
    speaks = conversation.sides[0].segments
    both = msgspec.structs.replace(
        conversation,
        sides=(conversation.sides[0], msgspec.structs.replace(conversation.sides[1], segments=speaks)),
    )
    assert all(not any(s.start <= at < s.end for s in speaks) for at, _ in found(sample, both))


def test_names_and_sizes_do_not_matter(sample: Project) -> None:
    graph = sample.graphs["body"]
    other = sample.with_graph(
        replace(
            graph, stances={i: replace(s, name=f"pose {n}") for n, (i, s) in enumerate(graph.stances.items())}
        )
    )
    assert found(sample, talk()) == found(other, talk())


def test_in_a_conversation_the_listener_ends_up_as_the_speaker_stands(sample: Project) -> None:
    conversation = talk()
    with_it = plan_duet(conversation, "v", (sample, sample), (None, None)).parts
    without = plan_duet(talk(0.0), "v", (sample, sample), (None, None)).parts
    shapes = measure_stance_shapes(sample)

    def apart(parts: object) -> float:
        """How unlike in a mirror both stand, on average over the conversation."""
        ann, ben = (p.plan.layers["body"] for p in parts)  # type: ignore[attr-defined]
        times = np.arange(4.0, 98.0, 0.5)
        mirror = [shapes[ann.stance_at(t)][[0, 1, 3, 2, 5, 4]] * (-1, 1, 1) for t in times]
        return float(
            np.mean(
                [np.linalg.norm(shapes[ben.stance_at(t)] - m) for t, m in zip(times, mirror, strict=True)]
            )
        )

    assert apart(with_it) < 0.8 * apart(without)
    assert with_it[0].plan.layers == without[0].plan.layers
