"""The project as a table: a row for each action and for each clip without one, a column for each field.

Cells are text, as a spreadsheet has them. Words of the domain (kinds, layers, limbs) are English here; the
window shows and reads them in its language.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal, get_args

from metagraph.common.wording import phrase
from metagraph.graph import edits
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.half_labels import (
    find_half_label,
    find_layers,
    find_stance_named,
    place_complete,
    set_half_labels,
)
from metagraph.graph.model import KINDS, LAYERS, LIMBS, Action, Kind, Layer, Project
from metagraph.playback.planning.prominence import measure_prominence
from metagraph.playback.timing.handles import FIELDS, move_handle

Column = Literal[
    "name",
    "clip",
    "kind",
    "layer",
    "stance",
    "end_stance",
    "limb",
    "tags",
    "start",
    "end",
    "blend_in",
    "blend_out",
    "earliest_exit",
    "likelihood",
    "cooldown",
    "prominence",
]
COLUMNS: tuple[Column, ...] = get_args(Column)
PLACE_COLUMNS: tuple[Column, ...] = ("kind", "layer", "stance", "end_stance")
LABEL_COLUMNS: tuple[Column, ...] = (*PLACE_COLUMNS, "limb", "tags")
TIME_COLUMNS: tuple[Column, ...] = ("start", "end", "blend_in", "blend_out", "earliest_exit")
CHOICES: Mapping[str, tuple[str, ...]] = {"kind": KINDS, "layer": LAYERS, "limb": LIMBS}
HALF_SHOWN = 0.005  # seconds: times are shown with two decimals
Cell = tuple[str, Column]  # the id of a row, and a column


@dataclass(frozen=True, slots=True)
class ActionRow:
    """ident: the action's id, or the clip's where it has no action."""

    ident: str
    clip: str
    action: Action | None


@dataclass(frozen=True)
class WrittenCells:
    """project: with what could be written. refused: the reason for each cell that could not. cut: cells with
    blends that were longer than their part and were cut to it.
    """

    project: Project
    refused: Mapping[Cell, str]
    cut: tuple[Cell, ...] = ()


def list_rows(project: Project) -> tuple[ActionRow, ...]:
    """Return the rows in the order of the clips; those of one clip follow each other."""
    return list_clip_rows(project, project.clips)


def list_clip_rows(project: Project, clips: Iterable[str]) -> tuple[ActionRow, ...]:
    """Return the rows of some clips, by id."""
    out: list[ActionRow] = []
    for clip in clips:
        uses = project.uses.get(clip, ())
        out += [ActionRow(action.id, clip, action) for action in uses] or [ActionRow(clip, clip, None)]
    return tuple(out)


def find_row(project: Project, ident: str) -> ActionRow | None:
    """Return the row of an action or of a clip without one; None for an id that has no row."""
    action = project.action(ident)
    if action is not None:
        return ActionRow(ident, action.clip, action)
    return ActionRow(ident, ident, None) if ident in project.clips and ident not in project.uses else None


def read_cell(project: Project, row: ActionRow, column: Column) -> str:
    """Return what a cell says; "" for what is not set or has no meaning in its row. Times are seconds of the
    clip with two decimals, *stands out* is per cent.
    """
    action = row.action
    if column == "clip":
        return project.clips[row.clip].name
    if action is None:
        return _half_text(project, row.clip, column)
    if column in ("name", "kind", "layer"):
        return str(getattr(action, column))
    if column in ("stance", "end_stance"):
        stance = project.stance(getattr(action, column) or "")
        return stance.name if stance is not None else ""
    if column == "limb":
        return action.limb if has_limb(action) else ""
    if column == "tags":
        return ", ".join(action.tags)
    if column in TIME_COLUMNS:
        return _time_text(project, action, column)
    if column == "likelihood":
        return f"{action.likelihood:g}"
    if column == "cooldown":
        return f"{action.cooldown:g}"
    return f"{100 * measure_prominence(project, action):.0f}"


def has_limb(action: Action) -> bool:
    """Return whether an action says which arm it needs."""
    return action.layer == "arms" and action.kind != "stance"


def can_write(row: ActionRow, column: Column) -> bool:
    """Return whether a cell can say anything: a clip without an action has only a label."""
    if row.action is None:
        return column in LABEL_COLUMNS
    if column == "limb":
        return has_limb(row.action)
    return column != "clip" and not (row.action.kind == "stance" and column in ("blend_out", "earliest_exit"))


def write_cells(project: Project, cells: Mapping[Cell, str]) -> WrittenCells:
    """Write texts into cells. Those of one row are taken together, and rows that make a stance come first, so
    that the order in which cells are written does not matter.

    A stance that does not exist yet is made by a row of kind stance. Writing where an action ends makes it a
    transition. A cell that cannot be written is left as it was, with the reason. One that says the same
    already is left alone.
    """
    refused: dict[Cell, str] = {}
    rows: dict[str, dict[Column, str]] = {}
    for (ident, column), text in cells.items():
        rows.setdefault(ident, {})[column] = " ".join(text.split())
    for ident, texts in rows.items():
        row = find_row(project, ident)
        for column, text in tuple(texts.items()):
            if row is not None and text == read_cell(project, row, column):
                del texts[column]  # numbers are shown rounded: the same text is the same value
                continue
            why = find_cell_refusal(row, column, texts) if row is not None else _GONE
            if why is not None:
                refused[ident, column] = why
                del texts[column]
    actions = {ident: texts for ident, texts in rows.items() if project.action(ident) is not None}
    clips = {ident: texts for ident, texts in rows.items() if ident not in actions and texts}
    project = _move_actions(project, actions, refused)
    project, cut = _set_fields(project, actions, refused)
    return WrittenCells(_write_half_labels(project, clips, refused), refused, cut)


def find_cell_refusal(row: ActionRow, column: Column, texts: Mapping[Column, str]) -> str | None:
    """Return why a cell cannot say what `texts` has for it, or None. texts: all that is written into the row,
    which may change what its cells can say.
    """
    text = texts[column]
    if column == "clip":
        return phrase("clips are renamed in the library")
    if not can_write(row, column) and not ("kind" in texts or "layer" in texts):
        if row.action is None:
            return phrase("it has no action yet: give it a kind and a stance first")
        return phrase("a {kind} of this layer has no such value", kind=phrase(row.action.kind))
    if column in CHOICES and text not in CHOICES[column] and not (row.action is None and not text):
        choices = ", ".join(phrase(word) for word in CHOICES[column])
        return phrase("'{text}' is none of {choices}", text=text, choices=choices)
    if row.action is not None and not text:
        if column in ("name", "stance"):
            return phrase("it cannot be empty")
        if column == "end_stance" and texts.get("kind", row.action.kind) == "transition":
            return _NEEDS_END
    if column in (*TIME_COLUMNS, "likelihood", "cooldown", "prominence"):
        return _number_refusal(column, text)
    return None


def parse_number(text: str) -> float | None:
    """Return the number that a cell says: with a point or a decimal comma, with a unit (s, %) or without.
    None if it says none.
    """
    bare = text.strip().rstrip("s%").strip().replace(",", ".")
    try:
        value = float(bare)
    except ValueError:
        return None
    return value if abs(value) < 1e9 else None


_MAY_BE_EMPTY = ("earliest_exit", "end", "prominence")  # no exit, the clip's end, as measured


def _number_refusal(column: Column, text: str) -> str | None:
    if not text and column in _MAY_BE_EMPTY:
        return None
    value = parse_number(text)
    if value is None:
        return phrase("'{text}' is not a number", text=text)
    if value < 0 or (column == "likelihood" and value == 0):
        return phrase("{text} is too small", text=text)
    if column == "prominence" and value > 100:
        return phrase("{text} is over 100 %", text=text)
    return None


def _half_text(project: Project, clip: str, column: Column) -> str:
    if column == "name":
        return project.clips[clip].name
    if column not in LABEL_COLUMNS:
        return ""
    value = getattr(find_half_label(project, clip), column)
    return ", ".join(value) if column == "tags" else str(value)


def _time_text(project: Project, action: Action, column: Column) -> str:
    start, end = project.span(action)
    timing = action.timing
    if action.kind == "stance" and column in ("blend_out", "earliest_exit"):
        return ""
    value = {"start": start, "end": end}.get(column, getattr(timing, column))
    return "" if value is None else f"{value:.2f}"


def _split_tags(text: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys(w.strip().lower() for w in text.split(",") if w.strip()))


Rows = Mapping[str, Mapping[Column, str]]
_GONE = phrase("it is no longer in the project")
_NEEDS_END = phrase(
    "a transition needs the stance it ends in: write the stance, and the action becomes a transition"
)


def _write_half_labels(project: Project, rows: Rows, refused: dict[Cell, str]) -> Project:
    labels: dict[str, dict[str, Any]] = {}
    for clip, texts in rows.items():
        fields: dict[str, Any] = {str(column): text for column, text in texts.items()}
        if "tags" in fields:
            fields["tags"] = _split_tags(fields["tags"])
        known = find_half_label(project, clip)
        if fields.get("end_stance") and not fields.get("kind", known.kind):
            fields["kind"] = "transition"
        start, end = (fields.get(name, getattr(known, name)) for name in ("stance", "end_stance"))
        if fields.get("kind", known.kind) == "transition" and start and start == end:
            refused |= {(clip, c): phrase("a transition must end in another stance") for c in texts}
        else:
            labels[clip] = fields
    return set_half_labels(project, labels) if labels else place_complete(project)


def _move_actions(project: Project, rows: Rows, refused: dict[Cell, str]) -> Project:
    """Give actions other kinds and places; all that go to one place together."""
    placing: dict[str, dict[Column, str]] = {}
    for ident, texts in rows.items():
        place: dict[Column, str] = {c: texts[c] for c in PLACE_COLUMNS if c in texts}
        if place:
            placing[ident] = place
    groups: dict[tuple[Kind, str, str | None], list[str]] = {}
    for makes_stance in (True, False):
        for ident, place in placing.items():
            action = project.action(ident)
            assert action is not None
            if (place.get("kind", action.kind) == "stance") == makes_stance:
                try:
                    project, target = _find_target(project, action, place)
                    groups.setdefault(target, []).append(ident)
                except EditError as error:
                    why: str = error.args[0]
                    refused |= {(ident, c): why for c in place}
    for (kind, stance, end), idents in groups.items():
        project = edits.move_actions(project, idents, kind, stance, end)
    return project


def _find_target(
    project: Project, action: Action, place: Mapping[Column, str]
) -> tuple[Project, tuple[Kind, str, str | None]]:
    """Return an action's new kind and the ids of the stances where it begins and ends; with the stance that a
    loop makes. Raises EditError.
    """
    ends = place.get("end_stance", "")
    kind: Kind = place.get("kind", "transition" if ends else action.kind)  # type: ignore[assignment]
    now = project.stance(action.stance)
    name = place.get("stance", now.name if now is not None else "")
    layer: Layer = place.get("layer", action.layer)  # type: ignore[assignment]
    if "layer" not in place and kind != "stance" and find_stance_named(project, layer, name) is None:
        elsewhere = find_layers(project, name)
        layer = elsewhere[0] if len(elsewhere) == 1 else layer
    stance = find_stance_named(project, layer, name)
    if stance is None and kind == "stance":
        project = edits.add_stance(project, layer, name)
        stance = find_stance_named(project, layer, name)
    if stance is None:
        raise EditError(_no_stance(layer, name))
    if kind != "transition":
        if ends:
            raise EditError(phrase("only a transition ends in another stance"))
        return project, (kind, stance, None)
    end = find_stance_named(project, layer, ends) if ends else action.end_stance
    if end is None:
        raise EditError(_no_stance(layer, ends) if ends else _NEEDS_END)
    why = edits.find_placing_refusal(project, [action.clip], layer, kind, stance, end)
    if why is not None:
        raise EditError(why)
    return project, (kind, stance, end)


def _no_stance(layer: Layer, name: str) -> str:
    return phrase(
        "the {layer} layer has no stance '{name}'; a row of the kind stance creates it",
        layer=phrase(layer),
        name=name,
    )


def _set_fields(project: Project, rows: Rows, refused: dict[Cell, str]) -> tuple[Project, tuple[Cell, ...]]:
    """Set everything but kinds and places, each row's cells one after the other."""
    changes: dict[str, dict[str, Any]] = {}
    cut: list[Cell] = []
    for ident, texts in rows.items():
        action = before = project.action(ident)
        assert action is not None
        for column, text in texts.items():
            if column in PLACE_COLUMNS:
                continue
            if not can_write(ActionRow(ident, action.clip, action), column):
                refused[ident, column] = phrase(
                    "a {kind} of this layer has no such value", kind=phrase(action.kind)
                )
            elif (why := _find_time_refusal(project, action, column, text)) is not None:
                refused[ident, column] = why
            elif column in TIME_COLUMNS:
                action = _with_time(project, action, column, text)
                value = parse_number(text)
                if value is not None and _time_text(project, action, column) != f"{value:.2f}":
                    cut.append((ident, column))
            else:
                action = replace(action, **_SETTERS[column](text))
        if action != before:
            changes[ident] = {f: getattr(action, f) for f in _SET if getattr(action, f) != getattr(before, f)}
    return (edits.update_each(project, changes) if changes else project), tuple(cut)


_SET = ("name", "limb", "tags", "likelihood", "cooldown", "prominence", "timing")


def _find_time_refusal(project: Project, action: Action, column: Column, text: str) -> str | None:
    """Return why an action cannot start, end or be left at a time; None for other columns."""
    value = parse_number(text)
    if value is None or column not in ("start", "end", "earliest_exit"):
        return None
    start, end = project.span(action)
    length = project.clips[action.clip].duration
    if value > length + HALF_SHOWN:
        return phrase("{at:g} s is after the clip's end, {length:.2f} s", at=value, length=length)
    if column == "start" and value >= end:
        return phrase("{at:g} s is not before its end, {end:.2f} s", at=value, end=end)
    if column == "end" and value <= start:
        return phrase("{at:g} s is not after its start, {start:.2f} s", at=value, start=start)
    if column == "earliest_exit" and not start <= value <= end + HALF_SHOWN:
        return phrase("{at:g} s is not between its start and its end", at=value)
    return None


def _with_time(project: Project, action: Action, column: Column, text: str) -> Action:
    value = parse_number(text)
    if value is None:
        fields: dict[str, Any] = {column: None}
        return replace(action, timing=replace(action.timing, **fields))
    start, end = project.span(action)
    at = {"blend_in": start + value, "blend_out": end - value}.get(column, value)
    fields = move_handle(project, action, FIELDS[column], at)
    return replace(action, timing=replace(action.timing, **fields))


_SETTERS: Mapping[Column, Callable[[str], dict[str, Any]]] = {
    "name": lambda text: {"name": text},
    "limb": lambda text: {"limb": text},
    "tags": lambda text: {"tags": _split_tags(text)},
    "likelihood": lambda text: {"likelihood": round(parse_number(text) or 1.0, 3)},
    "cooldown": lambda text: {"cooldown": round(parse_number(text) or 0.0, 2)},
    "prominence": lambda text: {"prominence": round((parse_number(text) or 0.0) / 100, 2) if text else None},
}
