"""Plain data field by field: written without defaults, read with types, ranges and known names, and an error
that names the place.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import MISSING, fields
from functools import cache
from typing import Any

from metagraph.common.network_paths import recover_original_path

Data = dict[str, Any]
LARGEST = 1e15  # no number in a project is larger; up to here whole numbers are exact


class DataError(ValueError):
    """The data is not a project: `where` names the field, the message says what is wrong with it."""

    def __init__(self, where: str, message: str) -> None:
        self.where = where
        super().__init__(message)


class UnknownFieldError(DataError):
    """The data has a field that is not known here."""


# --- writing


def round_number(value: float) -> float | int:
    """Return a number rounded to six decimals, or to six digits if nothing else would be left. Raises
    ValueError.
    """
    if not abs(value) <= LARGEST:
        raise ValueError(f"{value!r} is not a number that can be saved")
    rounded = round(float(value), 6) or float(f"{value:.6g}")
    return int(rounded) if rounded == int(rounded) else rounded


def as_plain(value: Any) -> Any:
    """Return a value as it can be written. Raises ValueError and TypeError."""
    if isinstance(value, str):
        return recover_original_path(value) if value.startswith(".") else value
    if isinstance(value, bool) or value is None:
        return value
    if isinstance(value, int) and abs(value) <= LARGEST:
        return value
    if isinstance(value, int | float):
        return round_number(value)
    if isinstance(value, tuple | list):
        return [as_plain(v) for v in value]
    raise TypeError(f"{type(value).__name__} has no place in a project file")


def list_changed_fields(value: Any, skip: tuple[str, ...] = ()) -> Data:
    """Return a dataclass's fields that differ from their defaults. Raises DataError."""
    out: Data = {}
    for name, default in _defaults(type(value), skip):  # type: ignore[arg-type]
        v = getattr(value, name)
        if v is default or v == default:
            continue
        try:
            out[name] = v if type(v) is str else as_plain(v)
        except ValueError as error:
            raise DataError(
                f"{type(value).__name__.lower()} {getattr(value, 'name', '')!r}, {name}", str(error)
            ) from None
    return out


@cache
def _defaults(cls: Any, skip: tuple[str, ...]) -> tuple[tuple[str, Any], ...]:
    """Return a dataclass's fields and their defaults, MISSING if there is none."""
    return tuple((f.name, f.default) for f in fields(cls) if f.name not in skip)


# --- reading

_WORDS = {
    str: "text",
    int: "a whole number",
    float: "a number",
    bool: "true or false",
    list: "a list",
    dict: "fields",
}


def name_reference(value: Any) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, list | dict):
        return "a list" if isinstance(value, list) else "fields"
    if isinstance(value, int) and abs(value) > LARGEST:
        return "a huge number"
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."


def get(data: Any, key: str, kind: Any, where: str, default: Any = MISSING) -> Any:
    """Return a field checked for its type, `default` where it is missing or empty; numbers are finite, not
    beyond `LARGEST`, and rounded as they are written: what can be read can be saved.
    """
    if type(data) is not dict and not isinstance(data, Mapping):
        raise DataError(where, f"should be fields, found {name_reference(data)}")
    value = data.get(key, MISSING)
    place = f"{where}.{key}" if where else key
    if value is MISSING and default is MISSING:
        raise DataError(place, "is missing")
    if default is not MISSING and (value is None or value is MISSING):
        return default
    wrong = isinstance(value, bool) and kind is not bool
    if wrong or not isinstance(value, (int, float) if kind is float else kind):
        raise DataError(place, f"should be {_WORDS[kind]}, found {name_reference(value)}")
    if kind in (int, float) and not abs(value) <= LARGEST:
        raise DataError(place, f"should be a finite number, found {name_reference(value)}")
    if isinstance(value, dict) and not all(isinstance(k, str) for k in value):
        raise DataError(place, "should be fields with names")
    return float(round_number(value)) if kind is float else value


def refuse_unknown_fields(data: Data, allowed: Collection[str], where: str) -> None:
    """Refuse fields nobody reads: what a slip of the pen was meant to say would be lost."""
    for key in data:
        if key not in allowed:
            from difflib import get_close_matches

            near = get_close_matches(str(key), allowed, 1)
            hint = f"; did you mean '{near[0]}'?" if near else ""
            place = f"{where}.{key}" if where else str(key)
            raise UnknownFieldError(place, f"is not a field known here{hint}")


def is_too_large(data: Any, where: str) -> str | None:
    """Return the place of a number in plain data that no project may hold, None if there is none."""
    if isinstance(data, dict | list):
        inside = data.items() if isinstance(data, dict) else enumerate(data)
        for key, value in inside:
            place = f"{where}[{key}]" if isinstance(data, list) else f"{where}.{key}"
            if found := is_too_large(value, place):
                return found
    elif isinstance(data, int | float) and not abs(data) <= LARGEST:
        return where
    return None


def require_one_of(value: Any, allowed: tuple[str, ...], where: str) -> Any:
    if value not in allowed:
        raise DataError(where, f"should be one of {', '.join(allowed)}, found {name_reference(value)}")
    return value


_RANGES = {  # field -> least and greatest value of what no check of the graph looks at
    "fps": (1e-3, 1e6),
    "frames": (0, 1e9),
    "take": (0, 1e6),
    "frame": (0, 1e9),
    "seed": (0, 0xFFFFFFFF),
    "alpha": (0, LARGEST),
    "shortest": (0, LARGEST),
    "wait": (0, LARGEST),
    "gap": (1e-3, LARGEST),
    "positive": (0, 1),
    "negative": (0, 1),
    "memory": (0, 600),
    "rest": (0, 600),
    "lookahead": (0, 10),
    "cooldown": (0, LARGEST),
    "prominence": (0, 1),
    "variety": (0, 4),
}


def fill_fields(cls: Any, data: Data, where: str, skip: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return a dataclass's simple fields read from data, those that are there."""
    out: dict[str, Any] = {}
    every = list_field_types(cls)
    for name, value in data.items():
        kind = every.get(name)
        if kind is None or name in skip:
            continue
        if kind is str and type(value) is str:
            out[name] = value
        elif kind is tuple:
            items = get(data, name, list, where)
            if not all(isinstance(x, str) for x in items):
                raise DataError(f"{where}.{name}", "should be a list of texts")
            out[name] = tuple(items)
        elif isinstance(kind, tuple):
            out[name] = get(data, name, kind[0], where, None)
            if out[name] is not None:
                _check_range(name, out[name], where)
        else:
            out[name] = get(data, name, kind, where)
            _check_range(name, out[name], where)
    return out


def _check_range(name: str, value: Any, where: str) -> None:
    if name not in _RANGES:
        return
    low, high = _RANGES[name]
    if not low <= value <= high:
        limit = f"{low:g} or more" if high in (1e9, LARGEST) else f"between {low:g} and {high:.10g}"
        raise DataError(f"{where}.{name}", f"should be {limit}, found {name_reference(value)}")


@cache
def list_field_types(cls: Any) -> dict[str, Any]:
    """Return field -> type; (type,) where None is a value, too; `tuple` for a list of texts."""
    out: dict[str, Any] = {}
    for f in fields(cls):
        text = str(f.type)
        plain = {"bool": bool, "int": int, "float": float}.get(text.split(" ")[0], str)
        out[f.name] = tuple if text.startswith("tuple[str") else (plain,) if "None" in text else plain
    return out


def read_items(data: Data, key: str, where: str, seen: set[str]) -> list[tuple[str, Data]]:
    """Return a list of dicts with ids, each with words for where it stands; `seen` are ids already taken."""
    out: list[tuple[str, Data]] = []
    for n, item in enumerate(get(data, key, list, where, ())):
        place = f"{where}.{key}[{n}]" if where else f"{key}[{n}]"
        ident = get(item, "id", str, place)
        if not ident:
            raise DataError(f"{place}.id", "should not be empty")
        if ident in seen:
            raise DataError(f"{place}.id", f"'{ident}' is used twice")
        seen.add(ident)
        out.append((place, item))
    return out


def read_floats(values: list[Any], count: int, where: str, largest: float = LARGEST) -> list[float]:
    """Return a list of exactly `count` numbers. Raises DataError for anything else, and for numbers beyond
    `largest` either way."""
    numbers = [
        x for x in values if isinstance(x, int | float) and not isinstance(x, bool) and abs(x) <= largest
    ]
    if not len(numbers) == len(values) == count:
        raise DataError(where, f"should be {count} numbers")
    return [float(x) for x in values]


def encode_joint_weights(weights: Iterable[tuple[str, float]]) -> Data:
    """Return how far joints move, by name; nothing if all move entirely."""
    found = {name: round_number(weight) for name, weight in weights}
    return {"joint_weights": found} if found else {}


def decode_joint_weights(data: Data, where: str) -> tuple[tuple[str, float], ...]:
    """Return how far joints move, (name, above 0 and below 1). Raises DataError."""
    if "joint_weights" not in data:
        return ()
    told = get(data, "joint_weights", dict, where, {})
    out = []
    for name in told:
        weight = get(told, name, float, f"{where}.joint_weights")
        if not 0 < weight <= 1:
            raise DataError(
                f"{where}.joint_weights.{name}",
                f"should be above 0 and at most 1, found {weight:g}; a joint that is not to move is left out "
                "of `joints`",
            )
        if weight < 1:
            out.append((name, weight))
    return tuple(out)


def read_texts(data: Data, key: str) -> tuple[str, ...]:
    """Return a list of texts at the top of the data, empty if it is missing."""
    values = get(data, key, list, "", [])
    for n, value in enumerate(values):
        if not isinstance(value, str):
            raise DataError(f"{key}[{n}]", f"should be text, found {name_reference(value)}")
    return tuple(values)
