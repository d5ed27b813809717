"""The items of a tree as lists."""

from __future__ import annotations

from PySide6.QtWidgets import QTreeWidget, QTreeWidgetItem


def list_top_items(tree: QTreeWidget) -> list[QTreeWidgetItem]:
    """Return a tree's outermost items, from the top."""
    return list_items_below(tree.invisibleRootItem())


def list_items_below(item: QTreeWidgetItem) -> list[QTreeWidgetItem]:
    """Return an item's own children, from the top."""
    return [child for n in range(item.childCount()) if (child := item.child(n)) is not None]
