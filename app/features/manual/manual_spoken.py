"""What screen readers report about a state machine drawn by hand: its states, aliases and links."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from PySide6.QtCore import QPointF, QRectF

from app.features.manual.manual_painter import describe_link
from app.features.manual.manual_scene import ManualScene, ManualView
from app.translation import tr, tr_plural
from app.widgets.spoken_items import SpokenItem
from metagraph.graph.manual.machine import ANY

LINK = 24.0  # pixels of the square that stands for a link, round the middle of its arrow


def list_manual_items(
    scene: ManualScene, view: ManualView, states: Collection[str], links: Collection[str]
) -> Sequence[SpokenItem]:
    """Return the items of a machine: its nodes, then its links. states, links: what is selected."""
    machine = scene.manual
    names = {ANY: tr("Any state")}
    names |= {state.id: state.name for state in machine.states.values()}
    names |= {alias.id: alias.name for alias in machine.aliases.values()}
    out = []
    for ident, rect in scene.nodes.items():
        if ident == ANY and ANY not in machine.out:
            continue
        kind = tr("Alias") if ident in machine.aliases else tr("State")
        count = len(machine.out.get(ident, ()))
        words = tr_plural("{count:,} link leaves it", "{count:,} links leave it", count)
        if machine.start == ident:
            words = tr("{words}, the start state", words=words)
        name = names[ident] if ident == ANY else tr("{kind}: {name}", kind=kind, name=names[ident])
        out.append(SpokenItem(name, _on_screen(view, rect), description=words, selected=ident in states))
    for link in machine.links.values():
        if link.source not in names or link.target not in names:
            continue
        name = tr("Link: {source} to {target}", source=names[link.source], target=names[link.target])
        middle = view.to(scene.middle(link.id))
        room = QRectF(middle - QPointF(LINK, LINK) / 2, middle + QPointF(LINK, LINK) / 2)
        out.append(SpokenItem(name, room, description=describe_link(link), selected=link.id in links))
    return out


def _on_screen(view: ManualView, rect: QRectF) -> QRectF:
    return QRectF(view.to(rect.topLeft()), view.to(rect.bottomRight()))
