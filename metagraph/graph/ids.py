"""Ids of what people make: a letter and nine digits that derive from what the thing is made of.

Two people who add different things to one project, each in a copy of their own, never give them the same id,
so nothing gets mixed up when the copies are merged. Who adds the same clip, or the same stance by name, gives
it the same id. Ids that are in a file stay as they are, whatever they look like.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from metagraph.graph.model import Project

DIGITS = 9
_LOWEST = 10 ** (DIGITS - 1)


def make_id(project: Project, letter: str, *made_of: object, more: Collection[str] = ()) -> str:
    """Return an id that nothing in the project has.

    letter: what kind of thing it is, as in other ids of its kind. made_of: what tells this thing from others
    of its kind. more: ids taken by what is being added to the project just now.
    """
    ident, number = derive_id(letter, *made_of), len(more) + project.size
    while ident in more or project.has(ident):  # the same thing once more
        ident, number = derive_id(letter, *made_of, number), number + 1
    return ident


def derive_id(letter: str, *made_of: object) -> str:
    """Return the letter and nine digits that derive from what a thing is made of."""
    text = repr([str(x) for x in made_of])
    number = int.from_bytes(hashlib.blake2b(text.encode(), digest_size=8).digest(), "big")
    return f"{letter}{_LOWEST + number % (9 * _LOWEST)}"
