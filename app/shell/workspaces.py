"""Define the workspaces as data: arrangements of the same panels, in each of which one thing is large.

A workspace divides the window into named areas. Panels declare themselves which area they are in, see
`Panel.where` and `Panel.opens`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from app.translation import tr_noop


@dataclass(frozen=True)
class Split:
    """Parts side by side, or one below the other if `down`. Each part is an area's name or another split,
    with its share of the whole.
    """

    parts: tuple[tuple[str | Split, int], ...]
    down: bool = False


@dataclass(frozen=True)
class Workspace:
    """An arrangement of the window.

    `id` is stable; panels refer to it. `title` and `tip` are on its tab. `tree` has its areas. `large` is the
    largest area, `spare` the area in which a panel opens that has no area of its own here.
    """

    id: str
    title: str
    tip: str
    tree: Split
    large: str = "large"
    spare: str = "below"

    @property
    def areas(self) -> tuple[str, ...]:
        """Return the names of its areas, from the upper left on."""
        return tuple(_areas(self.tree))


def _areas(part: str | Split) -> Iterator[str]:
    if isinstance(part, str):
        yield part
    else:
        for inner, _ in part.parts:
            yield from _areas(inner)


def split_across(*parts: tuple[str | Split, int]) -> Split:
    """Return parts side by side, each with its share of the width."""
    return Split(parts)


def split_down(*parts: tuple[str | Split, int]) -> Split:
    """Return parts one below the other, each with its share of the height."""
    return Split(parts, down=True)


LABEL = Workspace(
    "label",
    tr_noop("Label"),
    tr_noop("Large clips, to label each of them"),
    split_across(("large", 52), (split_down(("side", 57), ("below", 43)), 48)),
)
GRAPH = Workspace(
    "graph",
    tr_noop("Graph"),
    tr_noop("Large graph and character"),
    split_across(("list", 16), (split_down(("large", 73), ("below", 27)), 51), ("side", 33)),
)
TIME = Workspace(
    "time",
    tr_noop("Time"),
    tr_noop("Large character beside the timing of an action"),
    split_across((split_down(("list", 40), ("below", 60)), 66), ("large", 34)),
)
PERFORM = Workspace(
    "perform",
    tr_noop("Perform"),
    tr_noop("Large character beside its requests and what it plays"),
    split_across((split_down(("side", 40), ("below", 60)), 63), ("large", 37)),
)
TALK = Workspace(
    "talk",
    tr_noop("Talk"),
    tr_noop("Two characters in conversation, beside what they say"),
    split_across((split_down(("side", 30), ("below", 70)), 58), ("large", 42)),
)
WORKSPACES: tuple[Workspace, ...] = (LABEL, GRAPH, TIME, PERFORM, TALK)
FIRST = GRAPH

# Every panel at once, each in its `Panel.place`. A study's tasks are done here, so that nothing has to be
# searched for.
ALL = Workspace(
    "all",
    tr_noop("All"),
    tr_noop("Every panel"),
    split_across(
        (split_down((split_across(("left", 300), ("centre", 950)), 620), ("bottom", 286)), 1250),
        (split_down(("right", 470), ("right below", 440)), 420),
    ),
    large="centre",
    spare="bottom",
)
