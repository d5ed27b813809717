"""Unity's text assets: its YAML, its ids and `.meta` files."""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import yaml
from numpy.typing import NDArray

from metagraph.motion.skeleton import Skeleton

Array = NDArray[Any]

# Unity's numbers for its classes. An asset's main object has the id `klass * 100000`.
CLIP, CONTROLLER, MASK, TRANSITION, STATE, STATES, ENTRY = 74, 91, 319, 1101, 1102, 1107, 1109


class Inline(dict[str, Any]):
    """A mapping that is written on one line."""


class Written(str):
    """The items of a list, written already."""


NOTHING = Inline(fileID=0)
_HEAD = {"m_CorrespondingSourceObject": NOTHING, "m_PrefabInstance": NOTHING, "m_PrefabAsset": NOTHING}


def format_yaml_number(value: float, digits: int = 6) -> str:
    """Return a number with at most so many digits (1 or more) behind the point, none needless, and without an
    exponent.
    """
    short = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if short == "-0" else short


def main_id(klass: int) -> int:
    """Return the id of an asset's main object."""
    return klass * 100000


def make_local_id(*words: str) -> int:
    """Return an object's id in its file; the same words give the same id in every export."""
    return 1 + (int.from_bytes(hashlib.sha256("\n".join(words).encode()).digest()[:8], "big") >> 1)


def make_guid(project: str, file: str) -> str:
    """Return a file's id in Unity's project."""
    return hashlib.md5(f"{project}\n{file}".encode(), usedforsecurity=False).hexdigest()


def to(klass: int, project: str, file: str) -> Inline:
    """Return a reference to a file's main object."""
    return Inline(fileID=main_id(klass), guid=make_guid(project, file), type=2)


def write_asset(*objects: tuple[int, int, str, Mapping[str, Any]]) -> bytes:
    """Return a file of objects: class, id, type and fields."""
    lines = ["%YAML 1.1", "%TAG !u! tag:unity3d.com,2011:"]
    for klass, ident, kind, fields in objects:
        lines += [f"--- !u!{klass} &{ident}", f"{kind}:", *_block(fields, "  ")]
    return ("\n".join(lines) + "\n").encode()


def make_object_fields(hidden: int, name: str, version: int = 0, **more: Any) -> dict[str, Any]:
    """Return the fields that all objects begin with, and their own."""
    first = {"serializedVersion": version} if version else {}
    return {**first, "m_ObjectHideFlags": hidden, **_HEAD, "m_Name": name, **more}


def write_meta(ident: str, klass: int | None) -> bytes:
    """Return the `.meta` of a file: of an asset with a main object, of a text where None."""
    native = "" if klass is None else f"  mainObjectFileID: {main_id(klass)}\n"
    kind = "TextScriptImporter" if klass is None else "NativeFormatImporter"
    rest = "  userData: \n  assetBundleName: \n  assetBundleVariant: \n"
    return f"fileFormatVersion: 2\nguid: {ident}\n{kind}:\n  externalObjects: {{}}\n{native}{rest}".encode()


def _block(mapping: Mapping[str, Any], pad: str) -> list[str]:
    lines: list[str] = []
    for key, value in mapping.items():
        if isinstance(value, Written):
            lines.append(f"{pad}{key}:\n{value}" if value else f"{pad}{key}: []")
        elif isinstance(value, list) and value:
            lines.append(f"{pad}{key}:")
            for item in value:
                if isinstance(item, Inline):
                    lines.append(f"{pad}- {_scalar(item)}")
                else:
                    first, *rest = _block(item, pad + "  ")
                    lines.append(f"{pad}- {first[len(pad) + 2 :]}")
                    lines += rest
        elif isinstance(value, dict) and not isinstance(value, Inline):
            lines.append(f"{pad}{key}:")
            lines += _block(value, pad + "  ")
        else:
            lines.append(f"{pad}{key}: {_scalar(value)}")
    return lines


def _scalar(value: Any) -> str:
    if isinstance(value, int):
        return str(int(value))
    if isinstance(value, str):
        return format_yaml_text(value)
    if isinstance(value, Inline):
        return "{" + ", ".join([f"{key}: {_scalar(v)}" for key, v in value.items()]) + "}"
    return "[]" if isinstance(value, list) else format_yaml_number(value)


@lru_cache(maxsize=4096)  # paths of joints come back in every clip
def format_yaml_text(value: str) -> str:
    """Return a text as YAML on one line: plain where it can be, even where it looks like a number, for Unity
    reads by type.
    """
    if re.fullmatch(r"\w*", value, re.ASCII):
        return value
    written = yaml.safe_dump(value, width=math.inf, default_style=None if value.isprintable() else '"')
    return written.removesuffix("...\n").rstrip("\n")


def find_joint_path(skeleton: Skeleton, joint: int) -> str:
    """Return the way to a joint from the object that the skeleton's roots are in."""
    return "/".join(skeleton.names[at] for at in skeleton.chain(joint))
