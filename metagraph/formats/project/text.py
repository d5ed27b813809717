"""Plain data as YAML text and back: one line a clip, stance or action.

Reading builds the data from libyaml's events: no anchors, tags or depth that a hostile file could hide in,
every field's line is known, and it takes less than half the time of PyYAML's own loader. What was written
here and not changed by hand needs no YAML.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import Any

import msgspec

from metagraph.formats.project.canonical_text import DEPTH, ODD, WORDS, read_canonical

HEADER = "# A Metagraph project. One line a clip, stance or action; times in seconds.\n"
Data = dict[str, Any]
Lines = dict[str, int]  # field, as `layers.arms.actions[3].kind` -> line, from 1


class TextError(ValueError):
    """The text is not plain YAML data; `line` from 1, or 0 where none can be told."""

    def __init__(self, line: int, message: str) -> None:
        self.line = line
        super().__init__(message)


_HALVES = re.compile("[\ud800-\udfff]")


def as_text(data: Any) -> Any:
    """Return plain data whose texts can all be written: half a surrogate pair, which JSON can say and names
    of files can hold, is no character. What holds none is returned as it is.
    """
    try:
        msgspec.json.encode(data)
        return data
    except UnicodeEncodeError:
        return _whole(data)
    except (TypeError, ValueError, RecursionError, OverflowError):  # whoever reads it says what is wrong
        return data


def _whole(value: Any) -> Any:
    if isinstance(value, str):
        return _HALVES.sub("\ufffd", value)
    if isinstance(value, dict):
        return {_whole(k): _whole(v) for k, v in value.items()}
    return [_whole(v) for v in value] if isinstance(value, list | tuple) else value


# --- writing

_PLAIN = re.compile(r"[A-Za-z_](?:[A-Za-z0-9_ ./()+-]*[A-Za-z0-9_./()+-])?\Z")


def _quoted(value: str) -> str:
    def escape(found: re.Match[str]) -> str:
        code = ord(found[0])
        return (
            "\ufffd" if 0xD800 <= code < 0xE000 else f"\\u{code:04x}"
        )  # half a surrogate pair is no character

    return ODD.sub(escape, json.dumps(value, ensure_ascii=False))


@lru_cache(maxsize=8192)
def _word(value: str) -> str:
    return value if _PLAIN.match(value) and value.lower() not in WORDS else _quoted(value)


def _scalar(value: Any) -> str:
    if isinstance(value, str):
        return _word(value)
    if isinstance(value, list):
        return "[" + ", ".join(map(_scalar, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_flow_key(k)} {_scalar(v)}" for k, v in value.items()) + "}"
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    text = repr(value)
    return re.sub(r"^(-?\d+)e", r"\1.0e", text) if "e" in text else text  # YAML 1.1 wants the point


_LONG_KEY = 1_000  # characters beyond which YAML takes no key on a line with its value


def _key(key: Any, indent: str = "") -> str:
    """Return a key with what stands between it and its value."""
    text = _scalar(key)
    if len(text) <= _LONG_KEY:
        return f"{indent}{text}:"
    return f"{indent}? {text}\n{indent}:"


def _flow_key(key: Any) -> str:
    text = _scalar(key)
    return f"{text}:" if len(text) <= _LONG_KEY else f"? {text} :"


def to_text(data: Data) -> str:
    """Return the canonical text of plain project data."""
    lines = [HEADER.rstrip("\n")]

    def section(key: str, value: Any, indent: str) -> None:
        if isinstance(value, list) and value and isinstance(value[0], dict | list):
            lines.append(_key(key, indent))
            lines.extend(f"{indent}- {_scalar(item)}" for item in value)
        elif isinstance(value, dict) and value and indent == "":
            lines.append(_key(key))
            for inner, content in value.items():
                if isinstance(content, dict) and key in (
                    "layers",
                    "markov",
                    "performances",
                    "conversations",
                    "timelines",
                    "joint_maps",
                    "manual",
                ):
                    lines.append(_key(inner, "  "))
                    for name, part in content.items():
                        section(name, part, "    ")
                else:
                    lines.append(f"{_key(inner, '  ')} {_scalar(content)}")
        else:
            lines.append(f"{_key(key, indent)} {_scalar(value)}")

    for key, value in data.items():
        section(key, value, "")
    return "\n".join(lines) + "\n"


# --- reading

_VALUES: dict[str, Any] = dict.fromkeys(("", "~", "null", "Null", "NULL"))
_VALUES |= {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}
_INTEGER = re.compile(r"[-+]?\d{1,15}\Z", re.ASCII)
_FLOAT = re.compile(r"[-+]?(?:\.\d+|\d+(?:\.\d*)?)(?:[eE][-+]?\d+)?\Z", re.ASCII)
_INFINITE = re.compile(r"[-+]?\.(?:inf|Inf|INF)\Z|\.(?:nan|NaN|NAN)\Z")


def read_text_data(text: str) -> tuple[Any, Callable[[], Lines]]:
    """Return the data of a text, and what tells the line of every field. Raises TextError."""
    data = read_canonical(text)
    if data is not None:
        return data, lambda: parse_yaml(text)[1]
    data, lines = parse_yaml(text)
    return data, lambda: lines


def parse_yaml(text: str) -> tuple[Any, Lines]:
    """Return the data of a text and the line of every field. Raises TextError."""
    import yaml  # a window opens before there is anything to read

    nodes = frozenset((yaml.ScalarEvent, yaml.MappingStartEvent, yaml.SequenceStartEvent, yaml.AliasEvent))
    lines: Lines = {}
    stack: list[list[Any]] = []  # [container, its field, key that waits for its value]
    result: Any = None
    documents = 0
    for event in _events(text):
        kind = type(event)
        if kind is yaml.MappingEndEvent or kind is yaml.SequenceEndEvent:
            value = stack.pop()[0]
        elif kind in nodes:
            line = event.start_mark.line + 1
            if kind is yaml.AliasEvent or event.anchor is not None:
                raise TextError(line, "anchors and aliases are not used in project files")
            if event.tag is not None:
                raise TextError(line, f"the tag {event.tag} is not used in project files")
            if kind is not yaml.ScalarEvent:
                if len(stack) >= DEPTH:
                    raise TextError(line, "it is nested too deep")
                new: Any = {} if kind is yaml.MappingStartEvent else []
                where = _place(stack, line)
                stack.append([new, where, None])
                lines.setdefault(where, line)
                continue
            if stack and stack[-1][2] is None and type(stack[-1][0]) is dict:
                if event.value in stack[-1][0]:
                    raise TextError(line, f"'{event.value}' is there twice")
                stack[-1][2] = event.value
                continue
            lines.setdefault(_place(stack, line), line)
            value = _resolved(event)
        else:
            if kind is yaml.DocumentStartEvent:
                documents += 1
                if documents > 1:
                    raise TextError(event.start_mark.line + 1, "a second document begins")
            continue
        if not stack:
            result = value
        elif isinstance(stack[-1][0], list):
            stack[-1][0].append(value)
        else:
            stack[-1][0][stack[-1][2]] = value
            stack[-1][2] = None
    return result, lines


def _events(text: str) -> Iterator[Any]:
    import yaml

    loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        yield from yaml.parse(text, Loader=loader)
    except yaml.MarkedYAMLError as error:
        raise TextError(
            error.problem_mark.line + 1 if error.problem_mark else 0, str(error.problem)
        ) from None
    except yaml.reader.ReaderError as error:
        at = error.position if isinstance(error.position, int) else 0
        raise TextError(text.encode(errors="replace")[:at].count(b"\n") + 1, str(error.reason)) from None
    except (yaml.YAMLError, UnicodeError, ValueError) as error:
        raise TextError(0, str(error).splitlines()[0]) from None


def _place(stack: list[list[Any]], line: int) -> str:
    """Return what the field that begins now is called."""
    if not stack:
        return ""
    container, where, key = stack[-1]
    if isinstance(container, list):
        return f"{where}[{len(container)}]"
    if key is None:
        raise TextError(line, "a name of a field should be text")
    return f"{where}.{key}" if where else str(key)


def _resolved(event: Any) -> Any:
    """Return a scalar's value by YAML 1.2's core schema, where `yes` is a word and `1e3` a number."""
    text: str = event.value
    if not event.implicit[0] or event.style not in (None, ""):
        return text
    if text in _VALUES:
        return _VALUES[text]
    if _INTEGER.match(text):
        return int(text)
    if _FLOAT.match(text):
        return float(text)
    return float(text.replace(".", "")) if _INFINITE.match(text) else text
