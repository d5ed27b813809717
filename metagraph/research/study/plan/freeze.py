"""What a study is made of, by digest: its texts, questions, references and clips. What everybody worked
with is known from their logs; whether it still is what lies there, too.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path

import msgspec

from metagraph import __version__
from metagraph.common.budgets import TEXT_FILE
from metagraph.common.files import read_file
from metagraph.errors import FileError
from metagraph.formats.atomic import write_atomically
from metagraph.formats.clips import digest
from metagraph.formats.store import read_project
from metagraph.research.study.logs.log import format_wall_time
from metagraph.research.study.plan.study_fields import Task, Training
from metagraph.research.study.study_plan import Study

LOCK = "study.frozen.json"
ABSENT = "absent"
TEXTS = ("consent", "instructions", "tasks", "training", "questions", "order", "thanks")


def study_manifest(study: Study) -> dict[str, str]:
    """Return name -> SHA-256 of everything a participant works with: the plan's texts, among them the wording
    of questionnaires that are built in, and by their paths from the study file the references, their
    characters, and all clips. What is not there is `absent`.
    """
    plan = study.plan
    said: Mapping[str, object] = {
        "consent": plan.consent,
        "instructions": plan.instructions,
        "tasks": plan.tasks,
        "training": plan.training,
        "questions": [(q, q.when or plan.when) for q in plan.questions()],
        "order": (
            *(plan.order, plan.seed, plan.conditions, plan.participants, plan.breaks),
            *((plan.names, plan.hidden) if plan.names != "shown" else ()),
        ),
        "thanks": plan.thanks,
    }
    out = {
        name: hashlib.sha256(msgspec.json.encode(value, order="sorted")).hexdigest()
        for name, value in said.items()
    }
    files: dict[str, Path] = {}
    for task in plan.tasks:
        path = study.reference(task.id)
        if path is not None:
            files[_relative(study, path)] = path
            try:
                character = read_project(path).character
            except FileError:
                character = None
            if character is not None:
                files[_relative(study, path.parent / character)] = path.parent / character
    parts: tuple[Task | Training, ...] = (*plan.tasks, *plan.training)
    for part in parts:
        try:
            files |= {_relative(study, p): p for p in study.clips(part.clips)}
        except FileError:
            named = (part.clips,) if isinstance(part.clips, str) else part.clips
            files |= {n: study.folder / n for n in named if not (study.folder / n).is_file()}
    for name, path in sorted(files.items()):
        try:
            out[name] = digest(path)
        except (OSError, FileError):
            out[name] = ABSENT
    return out


def _relative(study: Study, path: Path) -> str:
    from os.path import relpath

    try:
        return Path(relpath(path.resolve(), study.folder)).as_posix()
    except ValueError:  # on another drive
        return path.resolve().as_posix()


def seal(digests: Mapping[str, str]) -> str:
    """Return one digest of them all."""
    return hashlib.sha256(json.dumps(dict(sorted(digests.items()))).encode()).hexdigest()


def find_changed_names(before: Mapping[str, str], after: Mapping[str, str]) -> list[str]:
    """Return the names of what is not the same, in the order of `before`; what both miss is the same."""
    return [n for n in dict.fromkeys((*before, *after)) if before.get(n, ABSENT) != after.get(n, ABSENT)]


def freeze_files(study: Study, force: bool = False) -> Path:
    """Write what the study is made of beside it; return the file. Raises FileError if it is frozen already
    and something has changed since, unless forced.
    """
    digests = study_manifest(study)
    path = study.folder / LOCK
    earlier: list[dict[str, object]] = []
    if path.is_file():
        differ = find_changed_names(read_frozen(study) or {}, digests) if not force else []
        if differ:
            raise FileError(
                path,
                f"the study is frozen, and {', '.join(differ[:4])} {'is' if len(differ) == 1 else 'are'} "
                "not as "
                "it was",
                "digests",
                "Put it back, or freeze anew with --force and tell why in the report.",
            )
        if not force:
            return path
        try:
            before = msgspec.json.decode(read_file(path, TEXT_FILE))
            earlier = [*before.get("earlier", ()), {k: before[k] for k in ("frozen", "seal")}]
        except (msgspec.DecodeError, KeyError, AttributeError):
            earlier = [{"frozen": "", "seal": digest(path)}]
    data = {
        "frozen": format_wall_time(datetime.now(UTC)),
        "version": __version__,
        "study": study.digest,
        "seal": seal(digests),
        "digests": digests,
        "earlier": earlier,
    }
    write_atomically(path, (json.dumps(data, indent=1, ensure_ascii=False) + "\n").encode())
    return path


def read_frozen(study: Study) -> dict[str, str] | None:
    """Return what was frozen, None if nothing was. Raises FileError."""
    path = study.folder / LOCK
    if not path.is_file():
        return None
    try:
        data = msgspec.json.decode(read_file(path, TEXT_FILE))
        found = data["digests"]
        if seal(found) != data["seal"]:
            raise KeyError("seal")
        return {str(k): str(v) for k, v in found.items()}
    except (msgspec.DecodeError, KeyError, TypeError, AttributeError, RecursionError):
        raise FileError(
            path, "is damaged, or was changed by hand", "digests", "Take it from a copy, or freeze anew."
        ) from None


def describe_study_differences(
    study: Study, logs: Mapping[str, Mapping[str, str] | None], clips: bool = True
) -> list[str]:
    """Return in words what people worked with that is not what lies there now. logs: participant -> what the
    log says it was, None if it says nothing. clips: read them, too.
    """
    now = study_manifest(study)
    out: list[str] = []
    others: dict[str, list[str]] = {}
    for who, before in logs.items():
        for name in find_changed_names(before, now) if before is not None else ():
            if clips or now.get(name) != ABSENT:
                others.setdefault(name, []).append(who)
    references = {_relative(study, p) for t in study.plan.tasks if (p := study.reference(t.id)) is not None}
    for name, people in others.items():
        some = "everybody" if len(people) == len(logs) and len(people) > 1 else list_people(people)
        if name in TEXTS:
            out.append(f"{some}: what the study file says of {name} is not what it was then.")
            continue
        what = f"the reference '{name}'" if name in references else f"'{name}'"
        worse = "; mistakes are counted against what lies there now" if name in references else ""
        gone = "is not there any more" if now.get(name, ABSENT) == ABSENT else "is not the one"
        out.append(f"{some}: {what} {gone} that was worked with{worse}.")
    silent = [who for who, before in logs.items() if before is None]
    if silent:
        out.append(
            f"{list_people(silent)}: {'the log does' if len(silent) == 1 else 'their logs do'} not say which "
            "references and clips were worked with; whether they were changed since is not known."
        )
    return out


def list_people(people: list[str]) -> str:
    """Return names in a sentence, of many only the first."""
    return ", ".join(people[:6]) + (f" and {len(people) - 6} more" if len(people) > 6 else "")
