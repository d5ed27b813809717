"""Parameters: the named values of a character that a game sets, without knowing any clip, stance or graph.

Each is a typed name for a request of `metagraph.graph.requests`: to set its value sends that request with one
field filled in. So whatever plays requests plays parameters.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Iterable, Mapping
from typing import Annotated, Any, Literal, get_args

import msgspec
from msgspec import Meta, Struct

from metagraph.graph.requests import AnyRequest, Point, RequestError, make_request

ParameterType = Literal["number", "boolean", "enum", "list", "point", "trigger"]
PARAMETER_TYPES: tuple[ParameterType, ...] = get_args(ParameterType)
# Names in small letters, in words parted by underscores that begin with a letter: each language writes them
# in its own way (maxSpeed, MaxSpeed, max_speed, MAX_SPEED), and no two ever become the same.
WORD = re.compile(r"[a-z][a-z0-9]*(_[a-z][a-z0-9]*)*")
LONGEST_WORD = 60
MOST_CHOICES = 500
# What lasts until it is set again, and with which fields; everything else is over by itself.
LASTING: Mapping[str, tuple[str, ...]] = {
    "mood": ("mood", "intensity"),
    "look": ("to", "amount"),
    "mode": ("mode",),
    "stance": ("stance",),
    "place": ("point",),
}
# Which fields a value of a type goes into.
FIELDS: Mapping[ParameterType, tuple[tuple[str, str], ...]] = {
    "number": (("mood", "intensity"), ("look", "amount")),
    "boolean": (("mood", "mood"), ("look", "to"), ("mode", "mode"), ("stance", "stance")),
    "enum": (("mood", "mood"), ("look", "to"), ("mode", "mode"), ("stance", "stance")),
    "list": (("gesture", "tags"), ("fidget", "tags")),
    "point": (("place", "point"),),
}
TRIGGERS = (
    *("gesture", "fidget", "action", "change", "nod", "shake", "blink", "say", "interrupt", "pause"),
    "resume",
)

Word = Annotated[str, Meta(min_length=1, max_length=LONGEST_WORD)]
ChoiceValue = str | float | tuple[float, ...] | None


class ParameterChoice(Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """One of the words that a parameter may be set to. value: what it puts into the request's field, such as
    the id of a stance; the word stays if that changes.
    """

    name: Word
    value: ChoiceValue = None


class CharacterParameter(Struct, frozen=True, kw_only=True, omit_defaults=True, forbid_unknown_fields=True):
    """A parameter. request: what is requested if it is set, with the value that it has at first. field: of
    the request, which its value goes into; "" for a trigger. choices: the words of an enum or a list; of a
    boolean what it does when off, then when on. least, most: of a number. about: what it is for, which
    becomes a comment in game code.
    """

    type: ParameterType
    request: AnyRequest
    field: Annotated[str, Meta(max_length=40)] = ""
    choices: Annotated[tuple[ParameterChoice, ...], Meta(max_length=MOST_CHOICES)] = ()
    least: float = 0.0
    most: float = 1.0
    about: Annotated[str, Meta(max_length=2000)] = ""

    @property
    def does(self) -> str:
        """Return which request it makes: "mood", "look" and so on."""
        return str(type(self.request).__struct_config__.tag)


def is_word(text: str) -> bool:
    """Return whether a text can be the name of a parameter or a choice."""
    return len(text) <= LONGEST_WORD and WORD.fullmatch(text) is not None


def make_word(text: str, taken: Collection[str] = (), otherwise: str = "value") -> str:
    """Return a text as a name of a parameter or a choice that is not taken. otherwise: what one without Latin
    letters is called.
    """
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().lower()
    pieces: list[str] = []
    for piece in re.findall(r"[a-z0-9]+", plain):
        if pieces and piece[0].isdigit():  # it must begin with a letter
            pieces[-1] += piece
        else:
            pieces.append(piece)
    word = "_".join(pieces).lstrip("0123456789_")[: LONGEST_WORD - 5].rstrip("_") or otherwise
    found, number = word, 1
    while found in taken:
        number += 1
        found = f"{word}{number}" if not word[-1].isdigit() else f"{word}n{number}"
    return found


def make_parameter_choices(pairs: Iterable[tuple[str, ChoiceValue]]) -> tuple[ParameterChoice, ...]:
    """Return a choice for each text and value, no two with the same name."""
    out: dict[str, ParameterChoice] = {}
    for text, value in pairs:
        word = make_word(text, out, "choice")
        out[word] = ParameterChoice(word, value)
    return tuple(out.values())


def get_first_value(parameter: CharacterParameter) -> Any:
    """Return the value of a parameter that nobody has set: a number, a switch, the name of a choice, a list
    of names, or three numbers; None for a trigger.
    """
    if parameter.type == "trigger":
        return None
    value = getattr(parameter.request, parameter.field, None)
    if parameter.type == "number":
        number = 1.0 if value is None else float(value)
        return min(max(number, parameter.least), parameter.most)
    if parameter.type == "point":
        return [float(x) for x in value or (0.0, 0.0, 0.0)]
    if parameter.type == "list":
        return [choice.name for choice in parameter.choices if choice.value in (value or ())]
    place = next((n for n, choice in enumerate(parameter.choices) if choice.value == value), 0)
    if parameter.type == "boolean":
        return bool(place)
    return parameter.choices[place].name if parameter.choices else ""


class ParameterValues:
    """The values that a character's parameters were set to. `made` has the ids of the last requests."""

    def __init__(self) -> None:
        self.values: dict[str, Any] = {}
        self.made: dict[str, str] = {}

    def get(self, parameters: Mapping[str, CharacterParameter], name: str) -> Any:
        """Return the value of a parameter; None if there is none of that name."""
        if name not in parameters:
            return None
        return self.values.get(name, get_first_value(parameters[name]))

    def has(self, parameters: Mapping[str, CharacterParameter], name: str, value: Any) -> bool:
        """Return whether a parameter was set to this value and has it still. A trigger never has."""
        parameter = parameters.get(name)
        if parameter is None or name not in self.values or name not in self.made:
            return False
        try:
            return bool(self.values[name] == _read_value(parameter, value))
        except RequestError:
            return False

    def take(self, parameters: Mapping[str, CharacterParameter], name: str, value: Any = None) -> AnyRequest:
        """Set a parameter and return the request that this makes. A number outside of its range becomes the
        nearest inside. Raises RequestError for a name that is not known and a value of another type.
        """
        parameter = parameters.get(name)
        if parameter is None:
            raise RequestError(f"name: there is no parameter '{name}'")
        found = _read_value(parameter, value)
        if parameter.type == "trigger":
            return parameter.request
        fields = {parameter.field: fill_in(parameter, found)}
        for other, given in self.values.items():
            beside = parameters.get(other)
            if beside is not None and is_beside(parameter, beside):
                fields[beside.field] = fill_in(beside, given)
        request = make_request(msgspec.to_builtins(parameter.request) | fields)
        for other, beside in parameters.items():
            if other != name and is_replaced(parameter, beside):
                self.values.pop(other, None)
        self.values[name] = found
        return request


def is_beside(parameter: CharacterParameter, other: CharacterParameter) -> bool:
    """Return whether two parameters fill different fields of one lasting request, such as where to look and
    how far to turn there. Who sets one of them keeps the other.
    """
    same = parameter.does == other.does and parameter.does in LASTING
    return same and parameter.field != other.field


def is_replaced(parameter: CharacterParameter, other: CharacterParameter) -> bool:
    """Return whether two parameters are bound to the same thing, so that setting one unsets the other."""
    if parameter.does != other.does or parameter.field != other.field or parameter.does not in LASTING:
        return False
    return all(
        getattr(parameter.request, field, None) == getattr(other.request, field, None)
        for field in ("layer", "name")
    )


def fill_in(parameter: CharacterParameter, value: Any) -> Any:
    """Return what a parameter's value puts into the request's field."""
    if parameter.type == "boolean":
        return parameter.choices[int(value)].value
    if parameter.type == "enum":
        return next(choice.value for choice in parameter.choices if choice.name == value)
    if parameter.type == "list":
        return [choice.value for choice in parameter.choices if choice.name in value]
    return value


def _read_value(parameter: CharacterParameter, value: Any) -> Any:
    """Return a value as it is kept. Raises RequestError for one of another type."""
    names = [choice.name for choice in parameter.choices]
    kind, number = parameter.type, isinstance(value, int | float) and not isinstance(value, bool)
    if kind == "trigger":
        if value is None:
            return None
        raise RequestError("value: a trigger has none")
    if kind == "number" and number and value == value:
        return min(max(float(value), parameter.least), parameter.most)
    if kind == "boolean" and isinstance(value, bool):
        return value
    if kind == "enum" and isinstance(value, str) and value in names:
        return value
    if kind == "list" and isinstance(value, list | tuple) and all(x in names for x in value):
        return [name for name in names if name in value]
    if kind == "point" and isinstance(value, list | tuple) and len(value) == 3:
        point = msgspec.convert(list(value), Point) if all(_is_length(x) for x in value) else None
        if point is not None:
            return [float(x) for x in point]
    words = {
        "number": "a number",
        "boolean": "true or false",
        "enum": f"one of {', '.join(names)}",
        "list": f"a list of {', '.join(names)}",
        "point": "three numbers, metres",
    }
    raise RequestError(f"value: should be {words[kind]}")


def _is_length(value: Any) -> bool:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and -1e6 <= value <= 1e6


def describe_parameters(parameters: Mapping[str, CharacterParameter]) -> dict[str, dict[str, Any]]:
    """Return parameters as plain data, by name: `type`, `about`, `initial` (but of triggers), `least` and
    `most` of numbers, `choices` (names) of enums and lists.
    """
    out: dict[str, dict[str, Any]] = {}
    for name, parameter in parameters.items():
        out[name] = {"type": parameter.type, "about": parameter.about}
        if parameter.type != "trigger":
            out[name]["initial"] = get_first_value(parameter)
        if parameter.type == "number":
            out[name] |= {"least": parameter.least, "most": parameter.most}
        if parameter.type in ("enum", "list"):
            out[name]["choices"] = [choice.name for choice in parameter.choices]
    return out
