"""Changes worked into plain data: what a journal's records say, one after another."""

from __future__ import annotations

from collections.abc import Mapping

from metagraph.formats.project.fields import Data
from metagraph.formats.project.journal import ABOUT, KEYED
from metagraph.graph.conversation.model import AUTO
from metagraph.graph.model import LAYERS


class Replay:
    """Project data that changes are worked into; lists are held by id, so that a change costs what it is
    large.
    """

    def __init__(self, data: Data) -> None:
        self.top = _opened({key: value for key, value in data.items() if key != "manual"})
        self.layers = {layer: _opened(data["layers"][layer]) for layer in LAYERS}
        self.manual = {layer: _opened(machine) for layer, machine in data.get("manual", {}).items()}

    def apply(self, change: Data) -> None:
        for layer, part in change.get("layers", {}).items():
            _work_in(self.layers[layer], part)
        for layer, part in change.get("manual", {}).items():
            if part is None:
                self.manual.pop(layer, None)
            elif layer in self.manual:
                _work_in(self.manual[layer], part)
            else:
                self.manual[layer] = _opened(part)
        others = {k: v for k, v in change.items() if k not in ("layers", "manual", *ABOUT)}
        _work_in(self.top, others)

    def data(self) -> Data:
        out = {**_closed(self.top), "layers": {layer: _closed(part) for layer, part in self.layers.items()}}
        if not out.get("hidden", True):
            del out["hidden"]  # as a project without any is written
        if out.get("language") == AUTO:
            del out["language"]
        return (
            {**out, "manual": {layer: _closed(part) for layer, part in self.manual.items()}}
            if self.manual
            else out
        )


def _opened(data: Data) -> Data:
    return {
        key: {item["id"]: item for item in value} if key in KEYED else value for key, value in data.items()
    }


def _closed(data: Data) -> Data:
    return {key: list(value.values()) if key in KEYED else value for key, value in data.items()}


def _work_in(data: Data, change: Data) -> None:
    for key, value in change.items():
        if key in KEYED:
            items = data.setdefault(key, {})
            for ident, item in value.items():
                if item is None:
                    items.pop(ident, None)
                else:
                    items[ident] = item
        elif not key.endswith(("_order", "_after")):
            data[key] = value
    for key in KEYED:
        if f"{key}_order" in change:
            # Of a damaged journal, what added an item may be lost.
            data[key] = {i: data[key][i] for i in change[f"{key}_order"] if i in data[key]}
        elif f"{key}_after" in change:
            data[key] = _inserted(data[key], change[f"{key}_after"])


def _inserted(items: Data, places: Mapping[str, str | None]) -> Data:
    """Return items in the order that puts each of `places` right behind another item, None being the
    beginning.
    """
    following: dict[str | None, list[str]] = {}
    for ident, before in places.items():
        following.setdefault(before, []).append(ident)
    out: Data = {}
    queue: list[str] = following.pop(None, [])[::-1]
    rest = iter([i for i in items if i not in places])
    while True:
        if not queue:
            following_one = next(rest, None)
            if following_one is None:
                break
            queue.append(following_one)
        ident = queue.pop()
        out[ident] = items[ident]
        queue.extend(reversed(following.pop(ident, ())))
    return {**out, **items}


def apply_change(data: Data, change: Data) -> Data:
    """Return project data with one change worked in. Raises KeyError, TypeError or AttributeError when they
    do not fit.
    """
    replay = Replay(data)
    replay.apply(change)
    return replay.data()
