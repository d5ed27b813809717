"""The expanded state machine in an export: millions of numbers, which are written as text at once.

A column repeats what its source has as often as the source has targets, or holds what its node leads to
except for one place: all are pieces of text that were made once.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate

import msgspec
from msgspec import Raw, Struct

from metagraph.engines import contract as c
from metagraph.graph.expand import list_fans
from metagraph.graph.model import MetaGraph, Project


class ListedLayer(Struct, rename={"targets": "to", "sources": "from"}):
    """`contract.Expanded` that is to be written: its columns are JSON already."""

    states: list[c.Id]
    sources: Raw
    targets: Raw
    leave: Raw
    blend: Raw


class ListedExport(c.Export, omit_defaults=True):
    """An export that is to be written with its machine."""

    expanded: dict[c.LayerName, ListedLayer] | None = None  # type: ignore[assignment]


class _Numbers:
    """Numbers of a column as text, a comma behind each."""

    def __init__(self, values: Sequence[float]) -> None:
        items = [_number(value) for value in values]
        self.text = b"".join(items)
        self.begins = list(accumulate(map(len, items), initial=0))

    def but(self, place: int) -> bytes:
        """Return the text without the number at a place; all of it below 0."""
        if place < 0:
            return self.text
        return self.text[: self.begins[place]] + self.text[self.begins[place + 1] :]


def list_machine(project: Project, graph: MetaGraph) -> ListedLayer:
    """Return a layer's machine: sources in the order they were placed, each with its targets."""
    sources, targets, leave, blend = (bytearray(b"[") for _ in range(4))
    texts: dict[str, tuple[_Numbers, _Numbers]] = {}
    for fan in list_fans(project, graph):
        node, itself = fan.node, fan.itself
        if node.stance not in texts:
            texts[node.stance] = _Numbers(node.targets), _Numbers(node.blends[node.loops :])
        others, blends = texts[node.stance]
        count, loops = len(node.targets) - (itself >= 0), node.loops - (0 <= itself < node.loops)
        sources += _number(fan.source) * count
        targets += others.but(itself)
        leave += _number(fan.leave) * count
        blend += _number(fan.blend) * loops
        blend += blends.but(itself - node.loops)
    return ListedLayer(
        list(graph.actions), _column(sources), _column(targets), _column(leave), _column(blend)
    )


def _number(value: float) -> bytes:
    return msgspec.json.encode(value) + b","


def _column(numbers: bytearray) -> Raw:
    """Return an array as JSON: what opens it, and its numbers, a comma behind each."""
    if numbers.endswith(b","):
        numbers.pop()  # in place: there are megabytes of it
    numbers += b"]"
    return Raw(numbers)
