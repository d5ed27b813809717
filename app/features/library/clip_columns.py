"""The columns of the list of clips: what stands in each, and what a click on its title sorts by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.features.library.clip_facts import ClipFacts
from app.features.library.clip_order import GIVEN, list_stance_names
from app.look.domain_words import COLOR_TITLES
from app.translation import make_lazy_texts, tr
from metagraph.graph.clip_mark import STARS
from metagraph.graph.model import KINDS, LAYERS, ClipEntry


@dataclass(frozen=True)
class Column:
    """id: stable. words: what stands in it. order: of `ORDERS`. width: in pixels at first. right: whether its
    words end at the right. shown: whether it is there at first. tip: what it tells.
    """

    id: str
    title: str
    words: Callable[[ClipFacts, ClipEntry], str]
    order: str
    width: int
    tip: str
    right: bool = False
    shown: bool = True


def format_stars(rating: int) -> str:
    """Return a rating as it is drawn: as many full stars, the others empty; nothing for none."""
    return "★" * rating + "☆" * (STARS - rating) if rating else ""


def _layers(facts: ClipFacts, entry: ClipEntry) -> str:
    found = {a.layer for a in facts.uses(entry)}
    return ", ".join(layer for layer in LAYERS if layer in found)


def _kinds(facts: ClipFacts, entry: ClipEntry) -> str:
    found = {a.kind for a in facts.uses(entry)}
    return ", ".join(kind for kind in KINDS if kind in found)


def _count(number: int) -> str:
    return str(number) if number else ""


def _note(facts: ClipFacts, entry: ClipEntry) -> str:
    return facts.mark(entry).note.replace("\n", " ")


COLUMNS: tuple[Column, ...] = make_lazy_texts(
    lambda: (
        Column("name", tr("Name"), lambda f, e: e.name, "name", 250, tr("The clip's name")),
        Column(
            "length",
            tr("Length"),
            lambda f, e: tr("{seconds:.2f} s", seconds=e.duration),
            "length",
            70,
            tr("The clip's length in seconds"),
            right=True,
        ),
        Column(
            "moves",
            tr("Moves"),
            lambda f, e: f.moved_words(e),
            "moves",
            130,
            tr("The parts of the body that move; position: the character travels"),
        ),
        Column("kind", tr("Kind"), _kinds, "use", 90, tr("The kinds of action that use the clip")),
        Column("layer", tr("Layer"), _layers, "use", 80, tr("The layers of the actions that use the clip")),
        Column(
            "stance",
            tr("Stance"),
            lambda f, e: ", ".join(list_stance_names(f, e)),
            "stance",
            130,
            tr("The stances that use the clip"),
        ),
        Column(
            "uses",
            tr("Uses"),
            lambda f, e: _count(len(f.uses(e))),
            "uses",
            72,
            tr("How many actions use the clip"),
            True,
        ),
        Column(
            "problems",
            tr("Problems"),
            lambda f, e: _count(f.problems(e)),
            "problems",
            80,
            tr("How many problems concern the clip"),
            True,
        ),
        Column(
            "rating",
            tr("Stars"),
            lambda f, e: format_stars(f.mark(e).rating),
            "rating",
            85,
            tr("Your rating of the clip"),
        ),
        Column(
            "color",
            tr("Colour"),
            lambda f, e: COLOR_TITLES[f.mark(e).color],
            "color",
            80,
            tr("The clip's colour label"),
        ),
        Column(
            "favourite",
            "♥",
            lambda f, e: "♥" if f.mark(e).favourite else "",
            "favourite",
            34,
            tr("Favourites"),
        ),
        Column("note", tr("Note"), _note, "name", 160, tr("Your note on the clip"), shown=False),
        Column(
            "added",
            tr("Added"),
            lambda f, e: str(f.place(e)),
            GIVEN,
            65,
            tr("The clip's place in the order of import"),
            True,
            False,
        ),
        Column(
            "file", tr("File"), lambda f, e: e.path, "folder", 220, tr("The file that the clip comes from")
        ),
    )
)
