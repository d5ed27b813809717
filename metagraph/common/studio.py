"""A studio's defaults: one YAML file, often on a shared drive, that says how Metagraph begins for everybody.

What a user chose is kept: the file only says what holds where nobody chose. It never stops the start: what is
wrong in it is a problem to read, with the line, and the rest holds.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from metagraph.common.programs import ROOT
from metagraph.common.wording import Phrase, phrase

VARIABLE = "METAGRAPH_STUDIO"
ADDRESS = "studio_file"  # the file in which a build keeps the path
PATIENCE = 2.0  # seconds that a drive may take to answer
MOST = 200_000  # bytes
COLOURS = ("red", "orange", "yellow", "green", "blue", "purple")
THEMES = ("dark", "light")


@dataclass(frozen=True)
class Studio:
    """The defaults; empty where the file says nothing.

    folders: where dialogs begin, by `projects`, `exports`. author: the name that others see, {user} stands
    for the user's. colours: what colour labels are called. shortcuts: by command, "" for none. lines: where
    each key was found, for later problems. problems: what is wrong.
    """

    path: Path | None = None
    language: str = ""
    theme: str = ""
    author: str = ""
    folders: Mapping[str, Path] = field(default_factory=dict)
    colours: Mapping[str, str] = field(default_factory=dict)
    shortcuts: Mapping[str, str] = field(default_factory=dict)
    hidden_features: tuple[str, ...] = ()
    hidden_commands: tuple[str, ...] = ()
    lines: Mapping[str, int] = field(default_factory=dict)
    problems: tuple[Phrase, ...] = ()

    def with_problem(self, key: str, cause: str, remedy: str) -> Studio:
        """Return these defaults with one more problem, at a key such as "shortcuts/export"."""
        name = self.path.name if self.path is not None else ""
        told = _describe(name, self.lines.get(key, 0), cause, remedy)
        return self if told in self.problems else replace(self, problems=(*self.problems, told))


_studio = Studio()


def use_studio(studio: Studio) -> None:
    """Have the program begin with these defaults."""
    global _studio
    _studio = studio


def get_studio() -> Studio:
    """Return the defaults that hold."""
    return _studio


def find_studio_file(chosen: str = "") -> Path | None:
    """Return where the file is: METAGRAPH_STUDIO, else what the user chose, else what the build has; None if
    nobody named one.
    """
    named = os.environ.get(VARIABLE) or chosen
    if not named:
        try:
            named = (ROOT / ADDRESS).read_text(encoding="utf-8").strip()
        except (OSError, ValueError):
            return None
    return Path(named).expanduser() if named else None


def read_studio(path: Path | None) -> Studio:
    """Return what a file says. A drive that does not answer within two seconds is a problem, too."""
    if path is None:
        return Studio()
    empty = Studio(path=path)
    found: list[bytes | OSError] = []

    def read() -> None:
        try:
            with path.open("rb") as file:
                found.append(file.read(MOST + 1))
        except OSError as error:
            found.append(error)

    thread = threading.Thread(target=read, daemon=True)
    thread.start()
    thread.join(PATIENCE)
    if not found:
        cause = phrase("its drive did not answer within {seconds:g} s", seconds=PATIENCE)
        return empty.with_problem("", cause, phrase("Connect the drive and start Metagraph again."))
    data = found[0]
    if isinstance(data, OSError):
        cause = phrase("it cannot be read ({why})", why=data.strerror or str(data))
        return empty.with_problem("", cause, phrase("Check {variable}.", variable=VARIABLE))
    if len(data) > MOST:
        return empty.with_problem("", phrase("it is too large"), phrase("Name the studio's file."))
    return _parse(empty, data)


def _parse(studio: Studio, data: bytes) -> Studio:
    import yaml

    try:
        root = yaml.compose(data.decode("utf-8"), Loader=yaml.SafeLoader)
        content = yaml.safe_load(data)
    except UnicodeDecodeError:
        return studio.with_problem("", phrase("it is not UTF-8"), phrase("Save it as UTF-8."))
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None)
        studio = replace(studio, lines={"": mark.line + 1 if mark is not None else 0})
        cause = phrase("it is not YAML ({why})", why=str(getattr(error, "problem", error)))
        return studio.with_problem("", cause, phrase("Correct the line."))
    if content is None:
        return studio
    if not isinstance(content, dict):
        return studio.with_problem("", phrase("it has no names with values"), phrase("Write language: de"))
    studio = replace(studio, lines=dict(_list_lines(root, "")))
    for key, value in content.items():
        reader = _READERS.get(str(key))
        if reader is None:
            names = ", ".join(_READERS)
            cause = phrase("'{key}' is unknown", key=str(key))
            studio = studio.with_problem(str(key), cause, phrase("Known are {names}.", names=names))
        else:
            studio = reader(studio, str(key), value)
    return studio


def _list_lines(node: Any, above: str) -> Iterator[tuple[str, int]]:
    """Yield the line of each key, such as ("folders/projects", 3), and of each value of a list."""
    for key, value in node.value if hasattr(node, "value") and isinstance(node.value, list) else ():
        path = f"{above}{key.value}"
        yield path, key.start_mark.line + 1
        if value.id == "mapping":
            yield from _list_lines(value, f"{path}/")
        elif value.id == "sequence":
            yield from ((f"{path}/{each.value}", each.start_mark.line + 1) for each in value.value)


def _describe(name: str, line: int, cause: str, remedy: str) -> Phrase:
    if line:
        return phrase(
            "{name}, line {line}: {cause}. {remedy}", name=name, line=line, cause=cause, remedy=remedy
        )
    return phrase("{name}: {cause}. {remedy}", name=name, cause=cause, remedy=remedy)


def _set(studio: Studio, name: str, value: Any) -> Studio:
    return replace(studio, **{name: value})


def _read_text(studio: Studio, key: str, value: object) -> Studio:
    if not isinstance(value, str):
        return studio.with_problem(key, phrase("'{key}' is not text", key=key), phrase("Write it in quotes."))
    if key == "theme" and value not in THEMES:
        cause = phrase("there is no theme '{value}'", value=value)
        return studio.with_problem(key, cause, phrase("Known are {names}.", names=", ".join(THEMES)))
    return _set(studio, key, value)


def _read_mapping(studio: Studio, key: str, value: object) -> Studio:
    """Read `folders`, `colours` or `shortcuts`."""
    if not isinstance(value, dict):
        cause = phrase("'{key}' has no names with values", key=key)
        return studio.with_problem(key, cause, phrase("Indent them below it."))
    known = {"folders": ("projects", "exports"), "colours": COLOURS}.get(key)
    out: dict[str, Any] = {}
    for name, words in value.items():
        where = f"{key}/{name}"
        if known is not None and name not in known:
            cause = phrase("'{key}' is unknown", key=str(name))
            studio = studio.with_problem(where, cause, phrase("Known are {names}.", names=", ".join(known)))
        elif not isinstance(words, str):
            cause = phrase("'{key}' is not text", key=str(name))
            studio = studio.with_problem(where, cause, phrase("Write it in quotes."))
        elif key == "folders" and not Path(words).expanduser().is_absolute():
            cause = phrase("'{folder}' is not a full path", folder=words)
            studio = studio.with_problem(where, cause, phrase("Begin it with the drive or with /."))
        else:
            out[str(name)] = Path(words).expanduser() if key == "folders" else words
    return _set(studio, key, out)


def _read_hidden(studio: Studio, key: str, value: object) -> Studio:
    known = {"features": "hidden_features", "commands": "hidden_commands"}
    if not isinstance(value, dict) or not all(isinstance(each, list) for each in value.values()):
        cause = phrase("'hide' has no lists")
        return studio.with_problem(key, cause, phrase("Write hide: and below it features: [study, mimic]"))
    for name, words in value.items():
        if name not in known:
            cause = phrase("'{key}' is unknown", key=str(name))
            names = ", ".join(known)
            studio = studio.with_problem(f"{key}/{name}", cause, phrase("Known are {names}.", names=names))
        else:
            studio = _set(studio, known[name], tuple(str(each) for each in words))
    return studio


_READERS: Mapping[str, Any] = {
    "language": _read_text,
    "theme": _read_text,
    "author": _read_text,
    "folders": _read_mapping,
    "colours": _read_mapping,
    "shortcuts": _read_mapping,
    "hide": _read_hidden,
}


def find_start_folder(folder: Path | None) -> Path:
    """Return where a dialog begins: a project's folder, else the studio's, else the user's home."""
    wished = get_studio().folders.get("projects")
    return folder or (wished if wished is not None and wished.is_dir() else Path.home())


def find_export_folder(folder: Path | None) -> Path:
    """Return where exports go unless another place is chosen: the studio's folder, else the project's."""
    wished = get_studio().folders.get("exports")
    return wished if wished is not None and wished.is_dir() else find_start_folder(folder)


def name_author(user: str) -> str:
    """Return the name that others see of a user."""
    return get_studio().author.replace("{user}", user) or user
