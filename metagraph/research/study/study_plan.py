"""Study files: who works on what under which conditions. `study.yaml` is read here and checked to the last
field.

Beside it lie `data/<participant>/` with the log and what was made, and `report/`. Paths in it are relative to
it.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import read_file
from metagraph.common.network_paths import find_refusal
from metagraph.errors import FileError, clean_text
from metagraph.formats.clips import find_clip_files
from metagraph.formats.project.text import TextError, parse_yaml
from metagraph.research.study.logs.log import NAME
from metagraph.research.study.plan.drawn_orders import read_drawn_orders
from metagraph.research.study.plan.faults import find_plan_faults
from metagraph.research.study.plan.hidden_names import make_clip_numbers
from metagraph.research.study.plan.study_fields import Plan, Task, Training, list_few

VERSION = 1
FILE = "study.yaml"
_CORRECT = "Correct it; docs/researchers/study-file.md describes every field."
P = TypeVar("P")

CONDITION_TITLES: Mapping[str, str] = {
    "meta": "Meta-graph",
    "manual": "State machine",
    "unreal": "Unreal Engine",  # done there, and imported
    "unity": "Unity",
    "godot": "Godot",
    "blender": "Blender",
}


@dataclass(frozen=True)
class Study:
    """A plan and where it is. digest: SHA-256 of the file."""

    path: Path
    plan: Plan
    digest: str

    @property
    def folder(self) -> Path:
        return self.path.parent

    def blocks(self, participant: str) -> tuple[tuple[str, tuple[str, ...]], ...]:
        """Return a participant's conditions in order, each with its tasks. Raises ValueError as the
        plan's.
        """
        found = read_drawn_orders(self.folder).get(participant) if self.plan.order == "concealed" else None
        return self.plan.blocks(participant, found)

    def hides(self, participant: str, task: str) -> bool:
        """Return whether a participant sees the clips of a task under numbers. Raises ValueError as the
        plan's.
        """
        found = read_drawn_orders(self.folder).get(participant) if self.plan.order == "concealed" else None
        return self.plan.hides(participant, task, found)

    def make_clip_numbers(self, participant: str, condition: str, task: str) -> dict[str, Path]:
        """Return number -> clip, for a task whose clips have numbers. Raises FileError."""
        return make_clip_numbers(self.clips(self.plan.task(task).clips), participant, condition, task)

    def known(self, participant: str) -> None:
        """Raises ValueError for a stranger."""
        self.plan.known(participant)

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
                if isinstance(part, Task) and self.plan.names != "shown":
                    self.make_clip_numbers("", "", part.id)
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
                few = list_few(tuple(sorted(used ^ names)))
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
    return Study(path.resolve(), parse_study_plan(text, path), hashlib.sha256(content).hexdigest())


def parse_study_plan(text: str, path: Path = Path(FILE)) -> Plan:
    """Return the plan of a study file's text. Raises FileError."""
    return plan_from(text, path, Plan, "study", "no study", VERSION, find_plan_faults, _CORRECT)


def plan_from(
    text: str,
    path: Path,
    kind: type[P],
    key: str,
    lacking: str,
    newest: int,
    faults_of: Callable[[P], Iterable[tuple[str, str]]],
    remedy: str,
) -> P:
    """Return the plan of a YAML text that begins with its key and version. lacking: what a text without them
    is. faults_of: what is wrong that the fields' types do not say, (field, cause). Raises FileError naming
    the line.
    """
    try:
        data, lines = parse_yaml(text)
    except TextError as error:
        place = f"line {error.line}" if error.line else "its text"
        raise FileError(path, f"not valid YAML ({error})", place, remedy) from None

    def failure(cause: str, where: str) -> FileError:
        place = where
        while place not in lines and place:
            place = place[: max(place.rfind("."), place.rfind("["), 0)]
        told = f"line {lines.get(place, 1)}" + (f" ({where})" if where else "")
        return FileError(path, cause, told, remedy)

    version = data.get(key) if isinstance(data, Mapping) else None
    if not isinstance(data, Mapping) or key not in data:
        raise failure(f"is {lacking}: it should begin with '{key}: 1'", "")
    if isinstance(version, int) and version > newest:
        newer = f"is of a newer version ({version}; this one reads {newest})"
        raise FileError(path, newer, key, "Update Metagraph.")
    if version != newest or isinstance(version, bool):
        raise failure(f"should be the version of the format, {newest}", key)
    try:
        plan = msgspec.convert(data, kind)
    except msgspec.ValidationError as error:
        message, _, where = str(error).partition(" - at `$")
        where = where.rstrip("`").lstrip(".").replace("[...]", "")
        unknown = re.search(r"unknown field `(\w+)`", message)
        raise failure(
            reword_msgspec(message), ".".join(filter(None, (where, unknown[1] if unknown else "")))
        ) from None
    for where, cause in (*_strange_files(data, path.parent), *faults_of(plan)):
        raise failure(cause, where)
    return plan


FILES = ("clips", "reference", "project", "motion", "video", "audio")  # fields that name files


def _strange_files(
    data: Any, folder: Path, where: str = "", named: bool = False
) -> Iterator[tuple[str, str]]:
    """Yield the files of a plan that are on other computers or devices, and are not to be opened."""
    if isinstance(data, Mapping):
        for key, value in data.items():
            yield from _strange_files(value, folder, f"{where}.{key}".lstrip("."), key in FILES)
    elif isinstance(data, list):
        for n, value in enumerate(data):
            yield from _strange_files(value, folder, f"{where}[{n}]", named)
    elif named and isinstance(data, str) and (why := find_refusal(data, folder)) is not None:
        yield (
            where,
            f"'{clean_text(data)[:200]}' is not opened: {why}; give the command --network if you trust it",
        )


def reword_msgspec(message: str) -> str:
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


# --- the published schema

SCHEMA = Path(__file__).with_name("study.schema.json")


def study_schema_text() -> bytes:
    """Return the JSON Schema (draft 2020-12) of study files, as it is published beside this module."""
    schema: dict[str, Any] = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Metagraph study",
        **msgspec.json.schema(Plan),
    }
    return msgspec.json.format(msgspec.json.encode(schema), indent=2) + b"\n"


if __name__ == "__main__":
    SCHEMA.write_bytes(study_schema_text())
