"""Questionnaires of a study as BIDS has them: `phenotype/sus.tsv`, a row a participant and a column an item,
and JSON that says what was asked.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from metagraph.research.study.analysis.reading import SCORED, Data
from metagraph.research.study.questionnaires import Item, Questionnaire
from metagraph.research.study.reports.tables import Table
from metagraph.research.study.study_plan import CONDITION_TITLES, Study

SOURCES: Mapping[str, str] = {
    "sus": "Brooke, J. (1996). SUS: a quick and dirty usability scale. In Usability Evaluation in Industry.",
    "tlx": "Hart, S. G. and Staveland, L. E. (1988). Development of NASA-TLX (Task Load Index).",
    "tlx_weighted": "Hart, S. G. and Staveland, L. E. (1988). Development of NASA-TLX (Task Load Index).",
}
About = tuple[str | None, str | None]  # condition, task


def make_phenotype_tables(
    study: Study, data: Data, people: Mapping[str, str]
) -> dict[str, tuple[Table, Mapping[str, Any]]]:
    """Return questionnaire -> its table and what its columns are. people: participant -> how BIDS calls them,
    in the order of the rows. Items asked several times have a column each, which names condition and task.
    """
    out: dict[str, tuple[Table, Mapping[str, Any]]] = {}
    for sheet in study.plan.questions():
        answers = {
            (a.participant, (a.condition, a.task), a.item): a.value
            for a in data.answers
            if a.questionnaire == sheet.id
        }
        found = sorted({about for _, about, _ in answers}, key=lambda x: (x[0] or "", x[1] or ""))
        if not found:
            continue
        columns = ["participant_id"]
        told: dict[str, Any] = {
            "MeasurementToolMetadata": _tool(sheet),
            "participant_id": {"Description": "Pseudonym"},
        }
        for about in found:
            for item in sheet.items:
                columns.append(_column(about, item.id))
                told[columns[-1]] = _item(item, about)
            if sheet.id in SCORED:
                columns.append(_column(about, "score"))
                words = f"{SCORED[sheet.id][0]}, the score{_about(about)}, 0 to 100"
                told[columns[-1]] = {"Description": words}
        rows = [
            (f"sub-{label}", *_values(sheet, who, found, answers))
            for who, label in people.items()
            if any(key[0] == who for key in answers)
        ]
        out[sheet.id] = (tuple(columns), rows), told
    return out


def _values(
    sheet: Questionnaire, who: str, found: Sequence[About], answers: Mapping[tuple[str, About, str], Any]
) -> list[Any]:
    out: list[Any] = []
    for about in found:
        mine = {item.id: answers.get((who, about, item.id)) for item in sheet.items}
        out += [_plain(v) for v in mine.values()]
        if sheet.id in SCORED:
            try:
                out.append(SCORED[sheet.id][1]({k: v for k, v in mine.items() if v is not None}))
            except ValueError:
                out.append(None)
    return out


def _plain(value: Any) -> Any:
    """Return words on one line."""
    return " ".join(value.split()) or None if isinstance(value, str) else value


def _column(about: About, item: str) -> str:
    return "_".join(part for part in (*about, item) if part is not None)


def _about(about: About) -> str:
    condition, task = about
    words = f" about {CONDITION_TITLES.get(condition, condition)}" if condition is not None else ""
    return words + (f", task {task}" if task is not None else "")


def _tool(sheet: Questionnaire) -> dict[str, str]:
    return {"Description": ". ".join(filter(None, (sheet.title or sheet.id, SOURCES.get(sheet.id))))}


def _item(item: Item, about: About) -> dict[str, Any]:
    out: dict[str, Any] = {"Description": f"{item.text}{_about(about)}"}
    scale = item.scale
    if scale is not None and scale.left + scale.right:
        out["Levels"] = {
            str(p): {scale.lowest: scale.left, scale.highest: scale.right}.get(p) or f"{p} of {scale.highest}"
            for p in scale.points
        }
    elif item.choices:
        out["Levels"] = {c: c for c in item.choices}
    return out
