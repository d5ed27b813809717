"""What an exhibit is made of, and which exhibits there are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # telling which exhibits there are must not wait for arrays
    from metagraph.research.exhibits.material import ExhibitMaterial

NUMBERS = "numbers"  # material: what the papers print, and nothing else


@dataclass(frozen=True)
class ExhibitTable:
    """Rows of words under a line of names."""

    caption: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class ExhibitDrawing:
    """svg: a whole drawing, `metagraph.common.svg.svg`."""

    caption: str
    svg: str


@dataclass(frozen=True)
class MadeExhibit:
    """An exhibit that was made. material: what it was made of, and whether anything here was made to fit it.
    says: what can be read off it, the paper's mistakes among it. parts: tables and drawings, in order.
    numbers: the same for programs, plain values. missing: why there is nothing to show, "" if there is.
    """

    material: str
    says: tuple[str, ...] = ()
    parts: tuple[ExhibitTable | ExhibitDrawing, ...] = ()
    numbers: dict[str, Any] = field(default_factory=dict)
    missing: str = ""


@dataclass(frozen=True)
class Exhibit:
    """name: as it is asked for. paper: key of `published.PAPERS`. place: where in the paper. module: that
    makes it, by its `exhibit_NAME(material)`. seconds: it takes about, by default and with all. needs:
    NUMBERS, "project", "takes" or "model".
    """

    name: str
    paper: str
    place: str
    title: str
    module: str
    seconds: tuple[float, float]
    needs: str = "project"

    def make(self, material: ExhibitMaterial) -> MadeExhibit:
        """Return the exhibit. Raises what reading its material raises."""
        module = import_module(f"metagraph.research.exhibits.{self.module}")
        found: MadeExhibit = getattr(module, f"exhibit_{self.name}")(material)
        return found


EXHIBITS: tuple[Exhibit, ...] = (
    Exhibit(
        "growth",
        "meta-graph",
        "figures 1 and 2",
        "Connections drawn and connections stood for",
        "authoring",
        (1, 1),
    ),
    Exhibit("hours", "meta-graph", "section 7.1", "8 hours against 63", "authoring", (5, 40)),
    Exhibit("replanning", "meta-graph", "figure 6", "Temporal replanning", "planning", (1, 1)),
    Exhibit("sampling", "meta-graph", "figure 7", "Sampling specific actions", "planning", (1, 5)),
    Exhibit(
        "variation", "meta-graph", "figures 9 and 12", "One request, many performances", "planning", (1, 1)
    ),
    Exhibit("matrix", "meta-graph", "figure 11", "What follows what", "planning", (1, 20), NUMBERS),
    Exhibit(
        "rates", "conversation", "table 1", "Movements that go with speech", "speaking", (4, 45), "takes"
    ),
    Exhibit(
        "delivery",
        "conversation",
        "table 1, figure 11",
        "What an hour delivers of what is asked",
        "keeping_rates",
        (3, 12),
    ),
    Exhibit("window", "conversation", "figure 3", "A window for a movement", "speaking", (1, 1), "takes"),
    Exhibit("costs", "conversation", "figure 4", "What a transition costs", "graphs", (1, 2), "takes"),
    Exhibit("components", "conversation", "table 2", "States and edges", "graphs", (3, 15), "takes"),
    Exhibit("search", "conversation", "figure 5", "The search, step by step", "searching", (1, 35), "takes"),
    Exhibit(
        "success",
        "conversation",
        "section 8.1",
        "How often a held out conversation finds motion",
        "searching",
        (10, 1300),
        "takes",
    ),
    Exhibit(
        "competing",
        "conversation",
        "section 8.1",
        "Where constraints compete",
        "searching",
        (15, 230),
    ),
    Exhibit("ratings", "conversation", "figure 6", "What people preferred", "rating", (0, 0), NUMBERS),
    Exhibit("times", "conversation", "table 3", "Building and searching", "graphs", (1, 70), "takes"),
    Exhibit(
        "distance", "generator", "figure 6", "Distance from the mean pose", "generated", (5, 15), "model"
    ),
    Exhibit("roles", "generator", "figures 7 and 8", "Speaking and listening", "generated", (1, 1), "model"),
    Exhibit("sizes", "generator", "section 7", "How many parameters", "generated", (0, 0), NUMBERS),
)
NAMES = tuple(e.name for e in EXHIBITS)


def choose_exhibits(names: Sequence[str]) -> tuple[Exhibit, ...]:
    """Return exhibits by name or by paper, each once, in the papers' order; all if nothing is named. Raises
    ValueError for a name that is none.
    """
    papers = {e.paper for e in EXHIBITS}
    wrong = [n for n in names if n not in NAMES and n not in papers]
    if wrong:
        raise ValueError(
            f"there is no exhibit '{wrong[0]}': there are {', '.join(NAMES)}, and the papers "
            f"{', '.join(dict.fromkeys(e.paper for e in EXHIBITS))} with all of theirs"
        )
    return tuple(e for e in EXHIBITS if not names or e.name in names or e.paper in names)
