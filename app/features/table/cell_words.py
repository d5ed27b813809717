"""What the cells of the table are called and say in the window's language, and what is typed into them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from app.look.domain_words import KIND_TITLES
from app.translation import make_lazy_texts, tr
from app.widgets.vocabulary import get_vocabulary_title
from metagraph.graph.model import KINDS, Project
from metagraph.playback.action_table import CHOICES, Column

TITLES: Mapping[Column, str] = make_lazy_texts(
    lambda: {
        "name": tr("Name"),
        "clip": tr("Clip"),
        "kind": tr("Kind"),
        "layer": tr("Layer"),
        "stance": tr("Stance"),
        "end_stance": tr("Ends in"),
        "limb": tr("Limb"),
        "tags": tr("Tags"),
        "start": tr("Start"),
        "end": tr("End"),
        "blend_in": tr("Blend in"),
        "blend_out": tr("Blend out"),
        "earliest_exit": tr("Earliest exit"),
        "likelihood": tr("Likelihood"),
        "cooldown": tr("Cooldown"),
        "prominence": tr("Stands out"),
    }
)
UNITS: Mapping[Column, str] = {
    **dict.fromkeys(("start", "end", "blend_in", "blend_out", "earliest_exit", "cooldown"), "s"),
    "prominence": "%",
}
NUMBERS = frozenset(UNITS) | {"likelihood"}


def describe_column(column: Column) -> str:
    """Return the title of a column with its unit."""
    unit = UNITS.get(column, "")
    return f"{TITLES[column]} ({unit})" if unit else TITLES[column]


def translate_cell(column: Column, text: str) -> str:
    """Return a cell's text in the window's language."""
    if column == "kind" and text:
        return KIND_TITLES[text]
    return get_vocabulary_title(text) if column in CHOICES and text else text


def parse_typed(column: Column, typed: str) -> str:
    """Return the text of a cell that somebody typed or pasted: words of the window's language or in English,
    or how they begin; kinds also as their keys 1 to 4. What is none of these stays as it is.
    """
    words, bare = CHOICES.get(column), " ".join(typed.split())
    if words is None or not bare:
        return bare
    if column == "kind" and bare in ("1", "2", "3", "4"):
        return KINDS[int(bare) - 1]
    wanted = bare.casefold()
    names = {word: (word, translate_cell(column, word).casefold()) for word in words}
    exact = [word for word, own in names.items() if wanted in own]
    begun = [word for word, own in names.items() if any(name.startswith(wanted) for name in own)]
    return next(iter(exact or (begun if len(begun) == 1 else [])), bare)


def list_choices(project: Project, column: Column, layer: str) -> Sequence[str]:
    """Return what is offered while a cell is edited. layer: the row's, "" for any."""
    if column in CHOICES:
        return [translate_cell(column, word) for word in CHOICES[column]]
    if column in ("stance", "end_stance"):
        graphs = [g for g in project.graphs.values() if not layer or g.layer == layer]
        return list(dict.fromkeys(s.name for g in graphs for s in g.stances.values()))
    if column == "tags":
        return sorted({tag for action in project.actions() for tag in action.tags})
    return ()
