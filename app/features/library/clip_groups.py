"""Groups in which the library lists clips. A clip is in one of them: where several would do, in the first."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Any

from app.features.library.clip_facts import ClipFacts
from app.features.library.clip_order import find_first_use, list_stance_names, make_natural_key
from app.look.domain_words import LAYER_LONG_TITLES, MANY_OF_KIND
from app.translation import make_lazy_texts, tr
from metagraph.graph.model import KINDS, LAYERS, ClipEntry

NONE = "none"
Group = tuple[Any, str]  # what it is sorted by, and its title
UNUSED: Group = make_lazy_texts(lambda: ((1,), tr("Not placed yet")))


def _folder(facts: ClipFacts, entry: ClipEntry) -> Group:
    path = PurePosixPath(entry.path).parent.as_posix()
    return make_natural_key(path), tr("Project folder") if path == "." else path


def _stance(facts: ClipFacts, entry: ClipEntry) -> Group:
    names = list_stance_names(facts, entry)
    return ((0, make_natural_key(names[0])), names[0]) if names else UNUSED


def _tag(facts: ClipFacts, entry: ClipEntry) -> Group:
    tags = sorted({tag for a in facts.uses(entry) for tag in a.tags}, key=make_natural_key)
    if tags:
        return (0, make_natural_key(tags[0])), tags[0]
    return ((1,), tr("No tag")) if facts.uses(entry) else ((2,), UNUSED[1])


def _layer(facts: ClipFacts, entry: ClipEntry) -> Group:
    layer, _ = find_first_use(facts, entry)
    return ((0, layer), LAYER_LONG_TITLES[LAYERS[layer]]) if layer < len(LAYERS) else UNUSED


def _kind(facts: ClipFacts, entry: ClipEntry) -> Group:
    kinds = [KINDS.index(a.kind) for a in facts.uses(entry)]
    return ((0, min(kinds)), MANY_OF_KIND[KINDS[min(kinds)]]) if kinds else UNUSED


GROUPS: dict[str, tuple[str, Callable[[ClipFacts, ClipEntry], Group] | None]] = make_lazy_texts(
    lambda: {
        NONE: (tr("No groups"), None),
        "folder": (tr("Folder"), _folder),
        "stance": (tr("Stance"), _stance),
        "tag": (tr("Tag"), _tag),
        "layer": (tr("Layer"), _layer),
        "kind": (tr("Kind"), _kind),
    }
)
