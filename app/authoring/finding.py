"""Find what a call names in a project: clips, actions and stances, by id or by a name that only one has."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches

from app.authoring.tool import AuthorError
from metagraph.graph.model import Action, Layer, Project, Stance


def find_clips(project: Project, names: Iterable[str]) -> list[str]:
    """Return the ids of clips, each once. Raises AuthorError for one that is not there."""
    known = {ident: entry.name for ident, entry in project.clips.items()}
    return list(dict.fromkeys(_find(known, name, "clip", "list_clips") for name in names))


def find_actions(project: Project, names: Iterable[str]) -> list[Action]:
    """Return actions, each once. Raises AuthorError for one that is not there."""
    actions = {action.id: action for action in project.actions()}
    known = {ident: action.name for ident, action in actions.items()}
    found = dict.fromkeys(_find(known, name, "action", "show_graph") for name in names)
    return [actions[ident] for ident in found]


def find_named_stance(project: Project, name: str, layer: Layer | None = None) -> Stance:
    """Return a stance, of one layer or of any. Raises AuthorError if it is not there, or if several layers
    have one of this name.
    """
    graphs = [project.graphs[layer]] if layer is not None else project.graphs.values()
    stances = {ident: stance for graph in graphs for ident, stance in graph.stances.items()}
    known = {ident: stance.name for ident, stance in stances.items()}
    return stances[_find(known, name, "stance", "show_graph")]


def name_stance(project: Project, ident: str | None) -> str:
    """Return the name of a stance, "" for none."""
    stance = project.stance(ident)
    return stance.name if stance is not None else ""


def _find(known: Mapping[str, str], name: str, kind: str, lister: str) -> str:
    """Return the id of what is called by its id or by its name."""
    if name in known:
        return name
    same = [ident for ident, other in known.items() if other == name]
    if len(same) == 1:
        return same[0]
    if same:
        raise AuthorError(f"{len(same)} {kind}s are called '{name}'; say which by its id: {_few(same)}")
    near = get_close_matches(name, dict.fromkeys(known.values()), 3)
    hint = (
        f"did you mean {_few([repr(x) for x in near])}?" if near else f"{lister} names those that there are"
    )
    raise AuthorError(f"there is no {kind} '{name}'; {hint}")


def _few(names: Sequence[str]) -> str:
    return ", ".join(names[:5]) + (" …" if len(names) > 5 else "")
