"""Public names: each is defined in one module, and functions are called by what they do."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

from metagraph.engines.translation.listing import LISTING

ROOT = Path(__file__).parent.parent
# What every feature, command, export target and program offers under the same name.
PROTOCOLS = {"contribute", "add_arguments", "run", "write", "main"}
# Modules that are translated for the engines: their names are also those of the runtimes.
TRANSLATED = {Path(*one.module.split(".")).with_suffix(".py") for one in LISTING}
# Names of messages and study files, which their JSON Schemas have too.
KEPT = {"Condition", "Document", "Plan", "Poses", "apart", "length", "meta_of", "scaled"}
# Functions that the translated modules call and each runtime has by hand, under the same name.
NATIVE = {"begun", "named", "placed", "scaled", "stressed"}
# Words that end like participles and are none, or begin a verb phrase.
NO_PARTICIPLES = {"bed", "cut", "feed", "need", "put", "read", "seed", "set", "speed", "split", "spread"}
PARTICIPLES = {
    *("begun", "built", "done", "drawn", "felt", "given", "gone", "grown", "heard", "held", "kept", "known"),
    *("laid", "left", "lost", "made", "meant", "met", "said", "seen", "sent", "shown", "spent", "spoken"),
    *("stood", "sworn", "taken", "told", "worn", "wound", "written"),
}


def defined() -> dict[str, list[tuple[Path, ast.stmt]]]:
    """Return by name where public functions and classes are defined."""
    out = defaultdict(list)
    for root in ("app", "metagraph", "preview"):
        for path in sorted((ROOT / root).rglob("*.py")):
            if "runtimes" in path.parts:
                continue
            for node in ast.parse(path.read_text(encoding="utf-8")).body:
                if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
                    out[node.name].append((path.relative_to(ROOT), node))
    return out


def is_participle(name: str) -> bool:
    """Return whether a name begins with a participle that no noun follows, such as `kept` or `drawn_of`."""
    first, *rest = name.split("_")
    ends = first in PARTICIPLES or (first.endswith("ed") and first not in NO_PARTICIPLES)
    return ends and (not rest or rest[0] in ("at", "by", "for", "in", "of", "on", "to", "with"))


def test_a_public_name_is_defined_in_one_module() -> None:
    twice = {
        name: sorted({str(path) for path, _ in places})
        for name, places in defined().items()
        if len({path for path, _ in places}) > 1 and name not in PROTOCOLS | KEPT
    }
    assert not twice, "give one of each another name"


def test_no_function_is_called_by_a_bare_participle() -> None:
    found = [
        f"{path}: {name}"
        for name, places in defined().items()
        for path, node in places
        if isinstance(node, ast.FunctionDef) and is_participle(name)
        if path not in TRANSLATED and name not in NATIVE
    ]
    assert not found, "call them by a verb, such as find_, make_, list_, describe_"


def test_participles_are_told_from_verbs_and_nouns() -> None:
    assert is_participle("kept") and is_participle("drawn_of") and is_participle("shifted")
    assert not any(map(is_participle, ("read", "set_start", "seed", "spoken_seconds", "keep", "find_kept")))
