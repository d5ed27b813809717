"""Runtimes with one rule broken, and the conformance vectors that must notice.

What notices a mutant is known once it was found, so that each is written down with a hint, `folder: case`:
that case is tried before all others. A hint that has grown stale costs time and nothing else.
"""

from __future__ import annotations

import json
import re
import shutil
from functools import lru_cache
from pathlib import Path
from typing import Any

from metagraph import engines
from tests.thorough import THOROUGH

SHIPPED = sorted(p.parent for p in Path(engines.__file__).with_name("conformance").glob("*/vectors.json"))
# What every runtime plays: of two long scripts drawn at random, one is enough unless asked to be thorough.
PLAYED = [folder for folder in SHIPPED if THOROUGH or folder.name != "random2"]

# The kinds of cases are all among stick's, which every runtime plays whole. Of what these have, each runtime
# plays a part of its own, and they together all; each all where asked to be thorough.
SHARED = ("random1", "varied")
RUNTIMES = ("javascript", "csharp", "cpp", "godot")


def share_of(folder: Path, runtime: str, scratch: Path) -> Path:
    """Return the folder of vectors that a runtime plays: a shipped one, or one made in `scratch`."""
    if THOROUGH or folder.name not in SHARED:
        return folder
    target = scratch / folder.name
    shutil.copytree(folder, target)
    every = _read(folder)
    cases = every["cases"][RUNTIMES.index(runtime) :: len(RUNTIMES)]
    (target / "vectors.json").write_text(
        json.dumps({**every, "cases": cases}, ensure_ascii=False), encoding="utf-8"
    )
    return target


def broken(path: Path, rule: str, instead: str) -> str:
    """Return a source with a rule changed, which must stand in it once."""
    source = path.read_text(encoding="utf-8")
    assert source.count(rule) == 1, f"{path.name} has '{rule}' {source.count(rule)} times"
    return source.replace(rule, instead)


def folders_to_try(hint: str | None, folders: list[Path], scratch: Path) -> list[Path]:
    """Return the folders of vectors, with one before them that has the hint's case alone. scratch: where such
    folders are made.
    """
    name, _, case = (hint or "").partition(": ")
    return [*(only(each, case, scratch) for each in folders if each.name == name), *folders]


def only(folder: Path, case: str, scratch: Path) -> Path:
    """Return a folder with a folder's export and those of its vectors that have a name; "hashes" are what
    comes before the cases.
    """
    target = scratch / f"{folder.name}-{re.sub('[^a-z0-9]+', '-', case)}"
    if not target.exists():
        every = _read(folder)
        vectors = {**every, "cases": [each for each in every["cases"] if each["name"] == case]}
        if case != "hashes":
            vectors["hashes"] = []
        target.mkdir(parents=True)
        export = folder / vectors["export"]
        for file in (export, export.with_name(json.loads(export.read_bytes())["glb"])):
            shutil.copy(file, target)
        (target / "vectors.json").write_text(json.dumps(vectors, ensure_ascii=False), encoding="utf-8")
    return target


@lru_cache(maxsize=4)
def _read(folder: Path) -> dict[str, Any]:
    """Return a folder's vectors, which nobody changes."""
    out: dict[str, Any] = json.loads((folder / "vectors.json").read_bytes())
    return out
