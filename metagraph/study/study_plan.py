"""Study files: who works on what under which conditions. `study.yaml` is read here and checked to the last
field.

Beside it lie `data/<participant>/` with the log and what was made, and `report/`. Paths in it are relative to
it.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta, Struct

from metagraph.budgets import TEXT_FILE
from metagraph.errors import FileError
from metagraph.files import read_file
from metagraph.formats.clips import find_clip_files
from metagraph.formats.text import TextError, parse
from metagraph.study.klm import Times
from metagraph.study.log import NAME
from metagraph.study.order import latin
from metagraph.study.questionnaires import BUILT_IN, Item, Name, Questionnaire, Scale, When

VERSION = 1
FILE = "study.yaml"
MOST = 1000  # participants
_CORRECT = "Correct it; docs/studies.md describes every field."

ConditionName = Literal["meta", "manual"]
Minutes = Annotated[float, Meta(gt=0, le=1440)]
CONDITION_TITLES: Mapping[str, str] = {"meta": "Meta-graph", "manual": "State machine"}


class Task(Struct, frozen=True, forbid_unknown_fields=True):
    """clips: a folder, or files. reference: the project that is the right answer. minutes: the limit, null
    for none. instructions: Markdown.
    """

    id: Name
    clips: str | tuple[str, ...]
    title: str = ""
    instructions: str = ""
    reference: str | None = None
    minutes: Minutes | None = None

    @property
    def name(self) -> str:
        return self.title or self.id


class Training(Struct, frozen=True, forbid_unknown_fields=True):
    """Practice with one condition's editor, before its tasks; it is logged and not counted."""

    condition: ConditionName
    clips: str | tuple[str, ...]
    instructions: str = ""
    minutes: Minutes | None = None


class Given(Struct, frozen=True, forbid_unknown_fields=True):
    """given: for each participant the conditions in order ("meta"), or conditions with a task each
    ("meta/ten").
    """

    given: dict[str, tuple[str, ...]]


class Plan(Struct, frozen=True, forbid_unknown_fields=True):
    """study: the version of the format. participants: how many, or their pseudonyms. order: `latin`
    counterbalances conditions and tasks, `fixed` keeps to the file. breaks: minutes after each condition but
    the last. when: what questionnaires are about that do not say it themselves. tolerance: seconds by which a
    timing may differ from the reference. allow: `labels` lets proposals be asked for. operators: seconds each
    operator of the keystroke-level model takes these participants, where it is not as `klm.Times` has it.
    """

    study: int
    title: str
    participants: (
        Annotated[int, Meta(ge=1, le=MOST)] | Annotated[tuple[Name, ...], Meta(min_length=1, max_length=MOST)]
    )
    conditions: Annotated[tuple[ConditionName, ...], Meta(min_length=1)]
    tasks: Annotated[tuple[Task, ...], Meta(min_length=1)]
    consent: str = ""
    instructions: str = ""
    training: tuple[Training, ...] = ()
    order: Literal["latin", "fixed"] | Given = "latin"
    breaks: Annotated[float, Meta(ge=0, le=1440)] = 0
    questionnaires: tuple[str | Questionnaire, ...] = ()
    when: When = "after_condition"
    seed: Annotated[int, Meta(ge=0, le=0xFFFFFFFF)] = 0
    tolerance: Annotated[float, Meta(ge=0, le=60)] = 0.1
    operators: dict[Literal["K", "P", "B", "H", "M"], Annotated[float, Meta(ge=0, le=60)]] = {}
    allow: tuple[Literal["labels"], ...] = ()
    thanks: str = ""

    @property
    def times(self) -> Times:
        """Return what the operators take."""
        return replace(Times(), **self.operators)

    @property
    def ids(self) -> tuple[str, ...]:
        """Return the participants' pseudonyms, in the order of their numbers."""
        if not isinstance(self.participants, int):
            return self.participants
        width = max(2, len(str(self.participants)))
        return tuple(f"P{n:0{width}}" for n in range(1, self.participants + 1))

    def task(self, ident: str) -> Task:
        """Return a task. Raises KeyError."""
        return {t.id: t for t in self.tasks}[ident]

    def questions(self) -> tuple[Questionnaire, ...]:
        """Return all questionnaires, those that are built in written out."""
        return tuple(BUILT_IN[q] if isinstance(q, str) else q for q in self.questionnaires)

    def blocks(self, participant: str) -> tuple[tuple[str, tuple[str, ...]], ...]:
        """Return a participant's conditions in order, each with the ids of its tasks in order. Raises
        ValueError for a stranger.
        """
        if participant not in self.ids:
            raise ValueError(f"'{participant}' does not take part; there are {_listed(self.ids)}")
        tasks = tuple(t.id for t in self.tasks)
        if self.order == "fixed":
            return tuple((c, tasks) for c in self.conditions)
        if self.order == "latin":
            return latin(self.conditions, tasks, self.ids.index(participant), self.seed)
        out: list[tuple[str, tuple[str, ...]]] = []
        assert isinstance(self.order, Given)
        for step in self.order.given[participant]:
            condition, _, task = step.partition("/")
            if task and out and out[-1][0] == condition:
                out[-1] = condition, (*out[-1][1], task)
            else:
                out.append((condition, (task,) if task else tasks))
        return tuple(out)


@dataclass(frozen=True)
class Study:
    """A plan and where it is. digest: SHA-256 of the file."""

    path: Path
    plan: Plan
    digest: str

    @property
    def folder(self) -> Path:
        return self.path.parent

    def data(self, participant: str) -> Path:
        return self.folder / "data" / participant

    def log(self, participant: str) -> Path:
        return self.data(participant) / NAME

    def clips(self, named: str | tuple[str, ...]) -> tuple[Path, ...]:
        """Return the clip files of a task or a training. Raises FileError when one is not there, or a folder
        has none.
        """
        if isinstance(named, str):
            folder = self.folder / named
            found = [folder] if folder.is_file() else find_clip_files(folder) if folder.is_dir() else []
            if not found:
                raise FileError(
                    self.path,
                    f"there are no clips in '{named}'",
                    "clips",
                    "Name a folder beside the study file that has some.",
                )
            return tuple(found)
        for name in named:
            if not (self.folder / name).is_file():
                raise FileError(
                    self.path,
                    f"there is no clip '{name}'",
                    "clips",
                    "Name files by their paths from the study file.",
                )
        return tuple(self.folder / name for name in named)

    def reference(self, task: str) -> Path | None:
        """Return where the task's right answer lies."""
        found = self.plan.task(task).reference
        return self.folder / found if found is not None else None

    def problems(self) -> list[str]:
        """Return what would hamper a sitting: clips and references that are not there, or do not belong
        together.
        """
        from metagraph.formats.store import read_project

        out: list[str] = []
        parts: tuple[Task | Training, ...] = (*self.plan.tasks, *self.plan.training)
        for part in parts:
            who = f"task '{part.id}'" if isinstance(part, Task) else f"training for '{part.condition}'"
            try:
                names = {p.name for p in self.clips(part.clips)}
                if not isinstance(part, Task):
                    continue
                if part.reference is None:
                    out.append(f"{who} has no reference: its mistakes cannot be counted")
                    continue
                used = {Path(c.path).name for c in read_project(self.folder / part.reference).clips.values()}
            except FileError as error:
                out.append(f"{who}: {error}")
                continue
            if used != names:
                few = _listed(tuple(sorted(used ^ names)))
                out.append(f"{who}: its clips and those of its reference are not the same: {few}")
        return out


# --- reading


def read_study(path: str | Path) -> Study:
    """Read a study file, or the one in a folder. Raises FileError with the line, the cause and the remedy."""
    path = Path(path)
    path = path / FILE if path.is_dir() else path
    try:
        content = read_file(path, TEXT_FILE)
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FileError(path, "is not text", f"byte {error.start}", "Choose a study file.") from None
    return Study(path.resolve(), from_text(text, path), hashlib.sha256(content).hexdigest())


def from_text(text: str, path: Path = Path(FILE)) -> Plan:
    """Return the plan of a study file's text. Raises FileError."""
    try:
        data, lines = parse(text)
    except TextError as error:
        raise FileError(
            path, f"not valid YAML ({error})", f"line {error.line}" if error.line else "its text", _CORRECT
        ) from None

    def failure(cause: str, where: str) -> FileError:
        place = where
        while place not in lines and place:
            place = place[: max(place.rfind("."), place.rfind("["), 0)]
        return FileError(
            path, cause, f"line {lines.get(place, 1)}" + (f" ({where})" if where else ""), _CORRECT
        )

    version = data.get("study") if isinstance(data, Mapping) else None
    if not isinstance(data, Mapping) or "study" not in data:
        raise failure("is no study: it should begin with 'study: 1'", "")
    if isinstance(version, int) and version > VERSION:
        raise FileError(
            path, f"is of a newer version ({version}; this one reads {VERSION})", "study", "Update Metagraph."
        )
    if version != VERSION or isinstance(version, bool):
        raise failure(f"should be the version of the format, {VERSION}", "study")
    try:
        plan = msgspec.convert(data, Plan)
    except msgspec.ValidationError as error:
        message, _, where = str(error).partition(" - at `$")
        where = where.rstrip("`").lstrip(".").replace("[...]", "")
        unknown = re.search(r"unknown field `(\w+)`", message)
        raise failure(
            _plain(message), ".".join(filter(None, (where, unknown[1] if unknown else "")))
        ) from None
    for where, cause in _faults(plan):
        raise failure(cause, where)
    return plan


def _plain(message: str) -> str:
    """Return msgspec's words as ours."""
    for pattern, words in (
        (r"Object contains unknown field `(\w+)`", r"there is no field '\1'"),
        (r"Object missing required field `(\w+)`", r"the field '\1' is missing"),
        (r"Expected `(.*)`, got `(.*)`", r"should be \1, not \2"),
        (r"Expected `(.*)` matching regex .*", r"should be a name of letters, digits, '-' and '_'"),
        (r"Invalid enum value (.*)", r"\1 is none of the words that can stand there"),
    ):
        if re.match(pattern, message):
            return re.sub(pattern, words, message)
    return message[:1].lower() + message[1:]


def _faults(plan: Plan) -> list[tuple[str, str]]:
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
    if isinstance(plan.order, Given):
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


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")


# --- the published schema

SCHEMA = Path(__file__).with_name("study.schema.json")


def schema_text() -> bytes:
    """Return the JSON Schema (draft 2020-12) of study files, as it is published beside this module."""
    schema: dict[str, Any] = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Metagraph study",
        **msgspec.json.schema(Plan),
    }
    return msgspec.json.format(msgspec.json.encode(schema), indent=2) + b"\n"


if __name__ == "__main__":
    SCHEMA.write_bytes(schema_text())
