"""What the blend shapes of other tools mean: their names as ARKit's shapes, or as channels of a face.

The names are data, in `blendshape_names.toml` beside this module.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from metagraph.graph.face.arkit import ARKIT
from metagraph.graph.face.expression_presets import PRESETS
from metagraph.graph.face.names import simplify_curve_name

TABLE = Path(__file__).with_suffix(".toml")
_PREFIX = re.compile(
    r"^(ctrlexpressions|ctrl|blendshapes?\d*|morph(target)?s?|shapes?|bs|expressions?|exp|facs|face|head|cc|"
    r"vrc|[a-z0-9]*?fcl(all|mth)?|genesis\d*(fe)?male|au\d+|[a-z]?\d+)"
)
_SIDES = {"Left": ("left", "l"), "Right": ("right", "r")}


@dataclass(frozen=True)
class CurveMeaning:
    """What a curve's name stands for: amounts of ARKit's shapes, and of channels of a face
    (`metagraph.graph.face.rig`); neither for an expression that is no change.
    """

    shapes: Mapping[str, float]
    channels: Mapping[str, float]


def find_curve_meanings(
    names: Iterable[str], own: Mapping[str, str] | None = None
) -> tuple[dict[str, CurveMeaning], tuple[str, ...]]:
    """Return what each of a clip's names means, and those that mean nothing to anybody.

    own: the user's words for names (`Face.names`): one of ARKit's shapes, any other name of the table, or ""
    for nothing.
    """
    every = tuple(names)
    table, vowels = _table(), _vowels()
    spoken = len({key for name in every for key in _keys(name)} & vowels.keys()) >= 3
    found: dict[str, CurveMeaning] = {}
    lost: list[str] = []
    for name in every:
        said = (own or {}).get(name)
        if said == "":
            continue
        keys = _keys(name if said is None else said)
        key = next((k for k in keys if k in table or (spoken and k in vowels)), None)
        if key is not None and key in vowels:
            found[name] = CurveMeaning({}, {f"viseme_{vowels[key]}": 1.0})
        elif key is None:
            lost.append(name)
        else:
            found[name] = table[key]
    return found, tuple(lost)


def match_arkit_shape(name: str) -> str | None:
    """Return the one of ARKit's shapes that a name stands for as a whole, None for none or several."""
    meaning = find_curve_meanings([name])[0].get(name)
    if meaning is None or meaning.channels or len(meaning.shapes) != 1:
        return None
    shape, amount = next(iter(meaning.shapes.items()))
    return shape if amount == 1 else None


def _keys(name: str) -> list[str]:
    out = [simplify_curve_name(name)]
    while (found := _PREFIX.match(out[-1])) and len(out[-1]) > found.end():
        out.append(out[-1][found.end() :])
    return out


@cache
def _data() -> dict[str, Any]:
    import tomllib

    return tomllib.loads(TABLE.read_text(encoding="utf-8"))


@cache
def _vowels() -> dict[str, str]:
    return dict(_data()["vowels"])


@cache
def _table() -> dict[str, CurveMeaning]:
    """Return plain name -> meaning."""
    out: dict[str, CurveMeaning] = {}
    data = _data()
    for shape in ARKIT:  # as they stand, before all else
        out[shape.lower()] = CurveMeaning({shape: 1.0}, {})
    words = {"#".join(shape.rsplit("Left", 1)) for shape in ARKIT if shape.endswith("Left")}
    words -= {"jaw#", "mouth#"}
    single = {shape for shape in ARKIT if not shape.endswith(("Left", "Right"))}
    aliases = {shape: [shape.lower()] for shape in sorted(words | single)}
    for shape, more in data["shapes"].items():
        aliases.setdefault(shape, []).extend(more)
    for shape, forms in aliases.items():
        for form in forms:
            _add(out, form, {shape: 1.0})
    for form, mix in data["parts"].items():
        _add(out, f"{form}#" if any("#" in s for s in mix) else form, mix)
    for viseme, forms in data["visemes"].items():
        channels = {} if viseme == "sil" else {f"viseme_{viseme}": 1.0}
        marks = [*(p + viseme.lower() for p in ("viseme", "vis", "v", "")), *forms]
        for mark in marks:
            if len(mark) > 1:  # a letter alone may be anything
                out.setdefault(mark, CurveMeaning({}, channels))
    for preset, forms in data["expressions"].items():
        channels = dict(PRESETS.get(preset, ()))
        for form in (preset, *forms):
            out.setdefault(form, CurveMeaning({}, channels))
    return out


def _add(out: dict[str, CurveMeaning], form: str, mix: Mapping[str, float]) -> None:
    """Add a name with both of its sides. A shape in the middle of the face that is named with a side is half
    of it.
    """
    word = form.replace("#", "")
    for side, marks in _SIDES.items():
        sided = {s.replace("#", side): w if "#" in s or "#" in form else 0.5 * w for s, w in mix.items()}
        for mark in marks:
            where = form.replace("#", mark) if "#" in form else word + mark
            for key in (where, mark + word if len(mark) > 1 else where):
                out.setdefault(key, CurveMeaning(sided, {}))
    both: dict[str, float] = {}
    for shape, amount in mix.items():
        for name in [shape.replace("#", side) for side in _SIDES] if "#" in shape else [shape]:
            both[name] = amount * (2 if "#" in form and "#" not in shape else 1)
    out.setdefault(word, CurveMeaning(both, {}))
