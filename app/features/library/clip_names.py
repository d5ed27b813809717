"""How clips are called on their cards."""

from __future__ import annotations

from app.features.library.clip_model import ENTRY, FilterModel
from app.look.names import plain
from app.look.plural import short
from app.project.document import Document
from metagraph.graph.model import LAYERS, ClipEntry

NEAR = 48  # cards before and behind one, from which its name is told apart


class ClipNames:
    """shown: the clips that are listed."""

    def __init__(self, document: Document, shown: FilterModel) -> None:
        self.document, self.shown = document, shown

    def of(self, entry: ClipEntry) -> tuple[str, str]:
        """Return the stance that a clip's name begins with, "" for none, and the rest, as they are read."""
        kept, names = self._names(), self.stances()
        if entry.name not in kept:
            found = next((n for n in names if short(entry.name, n) != entry.name), "")
            kept[entry.name] = found, plain(entry.name, found)
        return kept[entry.name]

    def _names(self) -> dict[str, tuple[str, str]]:
        """Return what is known of names by now; nothing after the graphs changed."""
        graphs = self.document.project.graphs
        if self._named[0] is not graphs:
            some = [(layer, s.name) for layer in LAYERS for s in graphs[layer].stances.values()]
            names = {name for _, name in some} | {f"{layer} {name}" for layer, name in some}
            self._named = graphs, tuple(sorted(names, key=len, reverse=True)), {}
        return self._named[2]

    _named: tuple[object, tuple[str, ...], dict[str, tuple[str, str]]] = None, (), {}

    def stances(self) -> tuple[str, ...]:
        """Return the names of all stances, with their layers in front, too, the longest first."""
        self._names()
        return self._named[1]

    def beside(self, row: int) -> tuple[str, ...]:
        """Return what the cards round one are called, as far as names are shown in a line."""
        near = range(row // NEAR * NEAR - NEAR, row // NEAR * NEAR + 2 * NEAR)
        entries = (self.shown.index(n, 0).data(ENTRY) for n in near if 0 <= n < self.shown.rowCount())
        return tuple(dict.fromkeys(self.of(e)[1] for e in entries if e is not None))
