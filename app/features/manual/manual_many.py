"""What the editor does with many at once: aliases, links by their ends, links copied to others, tables."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QApplication, QFileDialog, QWidget

from app.features.manual.drags.host import ManualHost
from app.translation import tr, tr_error, tr_noop, tr_plural
from metagraph.errors import FileError
from metagraph.formats import manual_table
from metagraph.formats.clips import is_face_recording
from metagraph.graph.manual import groups as manual_groups
from metagraph.graph.manual.machine import Link
from metagraph.graph.model import Project

TABLES = tr_noop("Tables (*.csv *.tsv *.txt)")
SUFFIXES = (".csv", ".tsv")


def is_link_table(path: Path) -> bool:
    """Whether a file is a table of a machine's links, by its name; recordings of faces are none."""
    return path.suffix.lower() in SUFFIXES and not is_face_recording(path)


def make_alias(canvas: ManualHost, every: bool = False) -> None:
    """Make an alias of the selected states, or of every state, and select it."""
    layer, chosen = canvas.session.place.layer, canvas.session.selection.states
    before = set(canvas.scene().manual.aliases)
    words = tr("Make alias of all states") if every else tr("Make alias")
    if canvas.do(words, lambda p: manual_groups.add_alias(p, layer, chosen, every)):
        canvas.session.selection.select_states(
            tuple(i for i in canvas.scene().manual.aliases if i not in before)
        )


def select_members(canvas: ManualHost, alias: str) -> None:
    manual = canvas.scene().manual
    canvas.session.selection.select_states(manual.members(manual.aliases[alias]))


def choose_for_alias(canvas: ManualHost, alias: str, states: tuple[str, ...], on: bool = True) -> None:
    """Let an alias stand for states as well, or no longer; they stay selected."""
    kept = canvas.session.selection.states
    words = tr("Add to alias") if on else tr("Remove from alias")
    if canvas.do(words, lambda p: manual_groups.set_alias_states(p, alias, states, on)):
        canvas.session.selection.select_states(kept)


def select_links(canvas: ManualHost, into: bool) -> None:
    """Select the links that leave the selected nodes, or lead to them."""
    manual, chosen = canvas.scene().manual, canvas.session.selection.states
    found = manual_groups.find_links(manual, chosen, into)
    if found:
        canvas.session.selection.select_states((), found)
    else:
        canvas.refuse(tr("no link leads to the selection") if into else tr("no link leaves the selection"))


def paste_links_on_selected(canvas: ManualHost, links: tuple[Link, ...]) -> None:
    """Draw copied links for the selected states instead."""
    layer, nodes = canvas.session.place.layer, canvas.session.selection.states
    canvas.do_links(tr("Paste links"), lambda p: manual_groups.paste_copied_links(p, layer, links, nodes))


# --- tables


def import_table(canvas: ManualHost, path: Path) -> None:
    """Draw the links of a table; say what could not be read."""
    try:
        rows = manual_table.read_manual_table(path)
    except FileError as error:
        canvas.refuse(tr_error(error))
        return
    _fill(canvas, rows, path.name)


def paste_table(canvas: ManualHost) -> None:
    """Draw the links of the table that was copied in a spreadsheet."""
    try:
        rows = manual_table.parse_manual_table(QApplication.clipboard().text())
    except ValueError as error:
        canvas.refuse(
            tr(
                "The clipboard has no table of links: {error}. {remedy}",
                error=error,
                remedy=manual_table.REMEDY,
            )
        )
        return
    _fill(canvas, rows, tr("the clipboard"))


def has_table() -> bool:
    """Whether what was copied last looks like a table of links."""
    first = QApplication.clipboard().text()[:400].partition("\n")[0].lower()
    return "from" in first and "to" in first and any(c in first for c in ",;\t")


def copy_table(canvas: ManualHost) -> None:
    """Copy every link of the layer as a table."""
    QApplication.clipboard().setText(manual_table.encode_machine_as_table(canvas.scene().manual))


def choose_table(canvas: ManualHost, parent: QWidget, start: str) -> None:
    name, _ = QFileDialog.getOpenFileName(parent, tr("Import links from a table"), start, tr(TABLES))
    if name:
        import_table(canvas, Path(name))


def _fill(canvas: ManualHost, rows: list[manual_table.TableRow], name: str) -> None:
    layer = canvas.session.place.layer
    told: list[manual_table.Filled] = []

    def edit(project: Project) -> Project:
        told[:] = [manual_table.fill_machine(project, layer, rows)]
        return told[0].project

    canvas.do_links(tr("Import links from {name}", name=name), edit)
    for out in told:
        canvas.refuse(describe_table_result(out, name))


def describe_table_result(out: manual_table.Filled, name: str) -> str:
    """Say what came of a table, and of its rows that could not be read the first."""
    said = tr(
        "{links} drawn from {name}",
        links=tr_plural("{count:,} link", "{count:,} links", out.links),
        name=name,
    )
    if out.changed:
        said += tr(", {changed:,} changed", changed=out.changed)
    if out.problems:
        said += tr(
            "; {rows} skipped: {first}",
            rows=tr_plural("{count:,} row", "{count:,} rows", len(out.problems)),
            first=out.problems[0],
        )
    return said
