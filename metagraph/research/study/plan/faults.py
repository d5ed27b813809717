"""What is wrong with a study's plan that the types of its fields do not say."""

from __future__ import annotations

from collections.abc import Mapping

from metagraph.research.study.plan.study_fields import Plan
from metagraph.research.study.questionnaires import BUILT_IN, Item, Scale


def find_plan_faults(plan: Plan) -> list[tuple[str, str]]:
    """Return what is wrong that the fields' types do not say: (field, cause)."""
    out: list[tuple[str, str]] = []
    for field, names in (
        ("participants", plan.ids),
        ("conditions", plan.conditions),
        ("tasks", [t.id for t in plan.tasks]),
    ):
        twice = sorted({n for n in names if list(names).count(n) > 1})
        if twice:
            out.append((field, f"'{twice[0]}' is there twice"))
    if len({n.casefold() for n in plan.ids}) < len(plan.ids):
        out.append(("participants", "two differ only by large and small letters, and would share a folder"))
    trained = [t.condition for t in plan.training]
    for n, name in enumerate(trained):
        if name not in plan.conditions:
            out.append((f"training[{n}].condition", f"'{name}' is not among the conditions"))
    for n, task in enumerate(plan.tasks):
        if task.clips in ("", ()):
            out.append((f"tasks[{n}].clips", "there are no clips"))
    ids: list[str] = []
    for n, found in enumerate(plan.questionnaires):
        where = f"questionnaires[{n}]"
        if isinstance(found, str):
            if found not in BUILT_IN:
                out.append(
                    (where, f"there is no questionnaire '{found}' built in; there are {', '.join(BUILT_IN)}")
                )
            ids.append(found)
            continue
        ids.append(found.id)
        out += [
            (f"{where}.items[{k}]", cause)
            for k, item in enumerate(found.items)
            for cause in _item_faults(item)
        ]
        if len({i.id for i in found.items}) < len(found.items):
            out.append((f"{where}.items", "two items have the same id"))
        if found.id in BUILT_IN:
            out.append((f"{where}.id", f"'{found.id}' is built in; give yours another id"))
    if len(set(ids)) < len(ids):
        out.append(("questionnaires", "one is there twice"))
    if not isinstance(plan.order, str):
        out += _given_faults(plan, plan.order.given)
    return out


def _item_faults(item: Item) -> list[str]:
    if (item.scale is not None) + bool(item.choices) + item.words != 1:
        return ["an item has one of scale, choices and words: true"]
    scale: Scale | None = item.scale
    if scale is not None and (scale.highest <= scale.lowest or (scale.highest - scale.lowest) % scale.step):
        return ["a scale goes up from one number to another, in whole steps"]
    return (
        ["there should be two choices at least, no two the same"]
        if item.choices and len(set(item.choices)) < 2
        else []
    )


def _given_faults(plan: Plan, given: Mapping[str, tuple[str, ...]]) -> list[tuple[str, str]]:
    out: list[tuple[str, str]] = []
    steps: set[str] = set(plan.conditions) | {f"{c}/{t.id}" for c in plan.conditions for t in plan.tasks}
    for who in plan.ids:
        if not given.get(who):
            out.append(("order.given", f"'{who}' is given no order"))
    for who, order in given.items():
        where = f"order.given.{who}"
        odd = [s for s in order if s not in steps]
        if who not in plan.ids:
            out.append((where, f"'{who}' does not take part"))
        elif odd:
            out.append(
                (
                    where,
                    f"'{odd[0]}' is neither a condition nor a condition and a task, as "
                    f"'meta/{plan.tasks[0].id}'",
                )
            )
        elif len(set(order)) < len(order) or len({"/" in s for s in order}) > 1:
            out.append((where, "name each condition once, or each condition with each of its tasks"))
    return out
