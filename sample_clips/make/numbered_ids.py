"""Ids counted from 1 in the order in which things are made: c1, c2, s3, a4.

What is made by script keeps its ids, and so what plays and every shipped file, however ids are made for
people (`metagraph.graph.ids`). They are also easier to read in tests.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager

from metagraph.graph import ids
from metagraph.graph.model import Project


def numbered_id(project: Project, letter: str, *made_of: object, more: Collection[str] = ()) -> str:
    """Return the letter and the number after the highest in the project; takes the place of `ids.make_id`."""
    graphs, machines = project.graphs.values(), project.manual.values()
    known = (
        project.clips,
        project.performances,
        project.conversations,
        *(some for graph in graphs for some in (graph.stances, graph.actions)),
        *(some for machine in machines for some in (machine.states, machine.links, machine.aliases)),
        [marker.id for timeline in project.timelines.values() for marker in timeline.markers],
        more,
    )
    numbers = (i[1:] for some in known for i in some)
    return f"{letter}{1 + max((int(n) for n in numbers if n.isdecimal() and len(n) < 9), default=0)}"


@contextmanager
def numbered_ids() -> Iterator[None]:
    """Number ids while this lasts; also a decorator."""
    made, ids.make_id = ids.make_id, numbered_id
    try:
        yield
    finally:
        ids.make_id = made
