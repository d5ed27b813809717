"""Reads the listed modules with mypy and prints each in every language."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from mypy import build
from mypy.modulefinder import BuildSource
from mypy.options import Options

from metagraph.engines.translation import tree as x
from metagraph.engines.translation.cpp import Cpp
from metagraph.engines.translation.csharp import CSharp
from metagraph.engines.translation.gdscript import GDScript
from metagraph.engines.translation.javascript import JavaScript
from metagraph.engines.translation.listing import LISTING, NATIVE, RUNTIMES, Translated
from metagraph.engines.translation.lowering import convert_module
from metagraph.engines.translation.printing import Printer, TranslationError, make_pascal_case
from metagraph.engines.translation.source import SourceModule, SubsetError

ROOT = Path(__file__).parents[3]
PLACES: dict[type[Printer], Callable[[str], str]] = {  # where each language's file of a module is
    JavaScript: lambda word: f"javascript/{word}.js",
    CSharp: lambda word: f"unity/Runtime/Core/{make_pascal_case(word)}.cs",
    Cpp: lambda word: f"cpp/{word}.hpp",
    GDScript: lambda word: f"godot/addons/metagraph/core/{word}.gd",
}
UNKNOWN = ("numpy.*", "numba.*", "yaml.*")  # nothing translated knows arrays and files; reading is slow


def translate_runtimes() -> dict[Path, str]:
    """Return every translated file of the runtimes with its text. Raises what `read` and `printed` do."""
    return {
        RUNTIMES / path: text for path, text in print_modules(read_modules(LISTING, ROOT), NATIVE).items()
    }


def read_modules(listing: Sequence[Translated], root: Path) -> dict[Translated, x.Module]:
    """Return listed modules below a folder. Raises SubsetError for what mypy or the subset refuses."""
    found = read_typed_modules(listing, root)
    return {one: convert_module(source) for one, source in found.items()}


def read_typed_modules(listing: Sequence[Translated], root: Path) -> dict[Translated, SourceModule]:
    """Return listed modules as mypy has them. Raises SubsetError with what it finds wrong."""
    options = Options()
    options.export_types = options.preserve_asts = options.local_partial_types = True
    options.incremental = False
    options.mypy_path = [str(root)]
    left_out = {"follow_imports": "skip", "follow_imports_for_stubs": True}
    options.per_module_options = dict.fromkeys(UNKNOWN, left_out)
    paths = {one: root / f"{one.module.replace('.', '/')}.py" for one in listing}
    found = build.build([BuildSource(str(p), one.module) for one, p in paths.items()], options)
    own = [f"{one.module.replace('.', '/')}.py:" for one in listing if not one.only]
    wrong = [e for e in found.errors if any(place in e.replace("\\", "/") for place in own)]
    if wrong:  # elsewhere there are errors, too, since arrays are left out
        raise SubsetError("\n".join(wrong))
    return {
        one: SourceModule(
            found.files[one.module],
            found.types,
            path,
            (*one.only, *one.more) if one.only else (),
            one.without,
        )
        for one, path in paths.items()
    }


def print_modules(modules: Mapping[Translated, x.Module], native: Mapping[str, str]) -> dict[str, str]:
    """Return each module's text in each language, by where it belongs. native: modules that are not
    translated, with the word of their files. Raises TranslationError for what a language cannot say.
    """
    words = {**native, **{one.module: one.word for one in modules}}
    parts = [(m.name, p) for m in modules.values() for p in m.parts]
    records = {(name, p.name): p for name, p in parts if isinstance(p, x.RecordClass)}
    constants = {(name, p.name): p.value for name, p in parts if isinstance(p, x.Constant)}

    def known(module: str) -> str:
        if module not in words:
            raise TranslationError(f"'{module}' is used, which is not translated; list it, or make it native")
        return words[module]

    def record_of(kind: x.Type) -> x.RecordClass:
        return records[kind.module, kind.name]

    def constant_of(node: x.Global) -> x.Expression:
        return constants.get((node.module, node.name), x.Value(x.NONE, None))

    out = {}
    for one, module in modules.items():
        for language, place in PLACES.items():
            meant = tuple(p for p in module.parts if language.LANGUAGE == "cpp" or p.name not in one.more)
            printer = language(replace(module, parts=meant), known, record_of, constant_of)
            out[place(one.word)] = printer.text()
    return out
