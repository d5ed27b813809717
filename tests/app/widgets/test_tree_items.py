"""The items of a tree as lists."""

from PySide6.QtWidgets import QTreeWidget, QTreeWidgetItem

from app.widgets.tree_items import list_items_below, list_top_items


def test_items_come_from_the_top_one_level_at_a_time(qtbot):
    tree = QTreeWidget()
    qtbot.addWidget(tree)
    assert list_top_items(tree) == []
    first, second = QTreeWidgetItem(tree, ["1"]), QTreeWidgetItem(tree, ["2"])
    inner = QTreeWidgetItem(first, ["1.1"])
    QTreeWidgetItem(inner, ["1.1.1"])
    assert [item.text(0) for item in list_top_items(tree)] == ["1", "2"]
    assert [item.text(0) for item in list_items_below(first)] == ["1.1"]
    assert list_items_below(second) == []
