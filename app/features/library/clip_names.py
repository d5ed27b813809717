"""Names of clips on their cards."""

from __future__ import annotations

from app.features.library.clip_rows import ClipRows
from app.look.names import make_readable_name
from app.look.plural import strip_stance
from app.project.document import Document
from metagraph.graph.model import LAYERS, ClipEntry

NEAR = 48  # cards before and behind one, from which its name is distinguished


class ClipNames:
    """Names of the listed clips. shown: these clips."""

    def __init__(self, document: Document, shown: ClipRows) -> None:
        self.document, self.shown = document, shown
        for signal in (
            shown.dataChanged,
            shown.layoutChanged,
            shown.modelReset,
            shown.rowsInserted,
            shown.rowsMoved,
            shown.rowsRemoved,
        ):
            signal.connect(self._relisted)

    def of(self, entry: ClipEntry) -> tuple[str, str]:
        """Return the stance with which a clip's name begins ("" for none) and the rest, in readable form."""
        kept, names = self._names(), self.stances()
        if entry.name not in kept:
            found = next((n for n in names if strip_stance(entry.name, n) != entry.name), "")
            kept[entry.name] = found, make_readable_name(entry.name, found)
        return kept[entry.name]

    def _names(self) -> dict[str, tuple[str, str]]:
        """Return what is known of names by now; nothing after stances are called otherwise."""
        graphs = self.document.project.graphs
        if self._graphs is not graphs:
            self._graphs = graphs
            some = [(layer, s.name) for layer in LAYERS for s in graphs[layer].stances.values()]
            if self._named[0] != some:
                names = {name for _, name in some} | {f"{layer} {name}" for layer, name in some}
                self._named = some, tuple(sorted(names, key=len, reverse=True)), {}
        return self._named[2]

    _graphs: object = None
    _named: tuple[object, tuple[str, ...], dict[str, tuple[str, str]]] = None, (), {}

    def stances(self) -> tuple[str, ...]:
        """Return the names of all stances, with and without their layers in front, the longest first."""
        self._names()
        return self._named[1]

    def beside(self, row: int) -> tuple[str, ...]:
        """Return the names on the cards around one, as far as the line shows them."""
        place, names = row // NEAR, self._names()
        if self._listed[0] is not names:
            self._listed = names, {}
        if place not in self._listed[1]:
            near = range(max(0, place * NEAR - NEAR), min(len(self.shown.entries), place * NEAR + 2 * NEAR))
            entries = (self.shown.entries[n] for n in near)
            found = tuple(dict.fromkeys(self.of(e)[1] for e in entries if e is not None))
            self._listed[1][place] = found
        return self._listed[1][place]

    def _relisted(self, *_: object) -> None:
        self._listed = None, {}

    _listed: tuple[object, dict[int, tuple[str, ...]]] = None, {}
