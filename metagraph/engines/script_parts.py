"""What scripts of conformance are made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from metagraph.graph.model import Action, Kind, Layer, Project

Ask = Mapping[str, Any]


@dataclass(frozen=True)
class ScriptStep:
    """At `now`, `asks` become known and the plan is extended to `end` seconds; then what ended before
    `forget` is forgotten.
    """

    now: float
    end: float
    asks: tuple[Ask, ...] = ()
    forget: float | None = None


@dataclass(frozen=True)
class ScriptCase:
    """One script. times: at which poses are compared, the most telling ones where empty. alive: with the life
    layers, without, both. watched: times after the last step at which is looked, as after each
    step, at what was spoken, what began and ended, and what became of each request; None to look nowhere.
    """

    name: str
    about: str
    steps: tuple[ScriptStep, ...]
    seed: int = 1
    idle: bool = False
    stances: Mapping[Layer, str] = field(default_factory=dict)
    times: tuple[float, ...] = ()
    alive: tuple[bool, ...] = (False,)
    watched: tuple[float, ...] | None = None


def make_case(name: str, about: str, asks: Sequence[Ask], end: float = 14.0, **more: Any) -> ScriptCase:
    """Return a case of one step that begins at 0 s."""
    return ScriptCase(name, about, (ScriptStep(0.0, end, tuple(asks)),), **more)


def ask(ident: str, do: str, at: float | None = None, **more: Any) -> Ask:
    """Return an ask as plain data."""
    return {"do": do, "id": ident, **({} if at is None else {"at": at}), **more}


def list_some_actions(project: Project, layer: Layer, *kinds: Kind) -> list[Action]:
    """Return a layer's actions of some kinds, those of its first stance first."""
    graph = project.graphs[layer]
    order = [s for s in (graph.start, *graph.stances) if s is not None]
    found = [a for a in graph.actions.values() if a.kind in kinds and a.stance in graph.stances]
    return sorted(found, key=lambda a: order.index(a.stance))
