"""Say in words what an edit changed: "Blend in 0.20 → 0.35 s, 6 gestures"."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields
from itertools import compress
from operator import is_not
from typing import Any

from app.look.domain_words import KIND_TITLES
from app.translation import format_number, make_lazy_texts, tr, tr_plural
from metagraph.graph.model import LAYERS, Action, Project, Settings, Timing

# What a field is called in Properties, and how its value is written.
SECONDS, NUMBER, WORD, STANCE, TAGS, YES = "seconds", "number", "word", "stance", "tags", "yes"
FIELDS: Mapping[str, tuple[str, str]] = make_lazy_texts(
    lambda: {
        "start": (tr("Start"), SECONDS),
        "end": (tr("End"), SECONDS),
        "blend_in": (tr("Blend in"), SECONDS),
        "blend_out": (tr("Blend out"), SECONDS),
        "earliest_exit": (tr("Earliest exit"), SECONDS),
        "stroke": (tr("Stroke"), SECONDS),
        "ready": (tr("Preparation ends"), SECONDS),
        "stroke_end": (tr("Stroke ends"), SECONDS),
        "relax": (tr("Retraction begins"), SECONDS),
        "repeat": (tr("Repeats for"), SECONDS),
        "likelihood": (tr("Likelihood"), NUMBER),
        "cooldown": (tr("Cooldown"), SECONDS),
        "spacing": (tr("Spacing"), NUMBER),
        "prominence": (tr("Stands out"), NUMBER),
        "limb": (tr("Limb"), WORD),
        "kind": (tr("Kind"), WORD),
        "stance": (tr("Stance"), STANCE),
        "end_stance": (tr("Ends in"), STANCE),
        "tags": (tr("Tags"), TAGS),
        "seed": (tr("Seed"), NUMBER),
        "alpha": (tr("Alpha"), NUMBER),
        "memory": (tr("Memory"), SECONDS),
        "rest": (tr("Rest"), SECONDS),
        "variety": (tr("Variety"), NUMBER),
        "never_twice": (tr("Never twice in a row"), YES),
        "wait": (tr("Maximum wait"), SECONDS),
        "lookahead": (tr("Look ahead"), SECONDS),
    }
)
_COUNTS: Mapping[str, Callable[[int], str]] = {
    "stance": lambda n: tr_plural("{count:,} stance", "{count:,} stances", n),
    "gesture": lambda n: tr_plural("{count:,} gesture", "{count:,} gestures", n),
    "fidget": lambda n: tr_plural("{count:,} fidget", "{count:,} fidgets", n),
    "transition": lambda n: tr_plural("{count:,} transition", "{count:,} transitions", n),
    "": lambda n: tr_plural("{count:,} action", "{count:,} actions", n),
}
_LONGEST = 40  # letters of a name


def describe_edit(text: str, before: Project, after: Project) -> str:
    """Return what an edit changed, with the old value, the new one, and of how many actions. If it changed
    more than one thing, return `text`, with whom it changed if those are actions.
    """
    actions = _changed_actions(before, after)
    if actions is None:
        return text
    if not actions:
        changes = _changed_fields(before.settings, after.settings)
        known = len(changes) == 1 and changes.keys() <= FIELDS.keys()
        return _one_value(changes, before, after) if known else text
    whom = _name_actions(actions)
    fields_changed = {name for old, new in actions for name in _action_changes(old, new)}
    if len(fields_changed) != 1 or not fields_changed <= FIELDS.keys():
        return tr("{what}, {whom}", what=text, whom=whom) if whom not in text else text
    (name,) = fields_changed
    values = [_action_changes(old, new)[name] for old, new in actions]
    return tr("{what}, {whom}", what=_values(name, values, before, after), whom=whom)


def _changed_actions(before: Project, after: Project) -> list[tuple[Action, Action]] | None:
    """Return the actions that changed, as they were and are; None if actions or stances came or went."""
    found: list[tuple[Action, Action]] = []
    for layer in LAYERS:
        old, new = before.graphs[layer], after.graphs[layer]
        if old is new:
            continue
        if old.actions.keys() != new.actions.keys() or old.stances.keys() != new.stances.keys():
            return None
        was = map(old.actions.__getitem__, new.actions)
        ids = compress(new.actions, map(is_not, was, new.actions.values()))
        found += [(old.actions[i], new.actions[i]) for i in ids if old.actions[i] != new.actions[i]]
    return found


def _action_changes(old: Action, new: Action) -> dict[str, tuple[Any, Any]]:
    changes = _changed_fields(old, new)
    if "timing" in changes:
        del changes["timing"]
        changes |= _changed_fields(old.timing, new.timing)
    return changes


def _changed_fields(old: Action | Timing | Settings, new: Any) -> dict[str, tuple[Any, Any]]:
    pairs = ((f.name, getattr(old, f.name), getattr(new, f.name)) for f in fields(old))
    return {name: (was, now) for name, was, now in pairs if was != now}


def _one_value(changes: Mapping[str, tuple[Any, Any]], before: Project, after: Project) -> str:
    ((name, values),) = changes.items()
    return _values(name, [values], before, after)


def _values(name: str, values: Iterable[tuple[Any, Any]], before: Project, after: Project) -> str:
    """Return the field's name with the old value, if all had the same, and the new one."""
    what, form = FIELDS[name]
    old = {_show(form, was, before) for was, _ in values}
    new = {_show(form, now, after) for _, now in values}
    if len(new) > 1:
        return what
    (now,) = new
    if form == SECONDS and now != tr("automatic"):
        now = tr("{seconds} s", seconds=now)
    if len(old) > 1:
        return tr("{field} → {new}", field=what, new=now)
    return tr("{field} {old} → {new}", field=what, old=old.pop(), new=now)


def _show(form: str, value: Any, project: Project) -> str:
    if form == STANCE:
        return tr("'{name}'", name=_stance_name(project, value))
    if form == TAGS:
        return ", ".join(value) or tr("none")
    if value is None:
        return tr("automatic")
    if form == YES:
        return tr("yes") if value else tr("no")
    if form == WORD:
        return str(KIND_TITLES.get(value) or tr(value)).lower()
    return format_number(value, ".2f" if form == SECONDS else "g")


def _stance_name(project: Project, ident: str | None) -> str:
    found = (graph.stances.get(ident or "") for graph in project.graphs.values())
    return next((stance.name for stance in found if stance is not None), "?")


def _name_actions(actions: list[tuple[Action, Action]]) -> str:
    if len(actions) == 1:
        name = actions[0][1].name
        return name if len(name) <= _LONGEST else f"{name[: _LONGEST - 1]}…"
    kinds = {new.kind for _, new in actions}
    return _COUNTS[kinds.pop() if len(kinds) == 1 else ""](len(actions))
