"""Bring the catalogues up to date: `python -m app.languages`.

Collects every marked text of the tree, adds it to each `metagraph.po`, comments out what is gone, and
compiles `metagraph.mo`, which the window reads. `python -m app.languages new fr` begins a language.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from datetime import UTC, datetime
from itertools import product
from pathlib import Path
from typing import NamedTuple

from babel import Locale
from babel.messages.catalog import Catalog
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po

import metagraph

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
BEGUN = datetime(2026, 11, 28, tzinfo=UTC)  # a date that moves would change every file each time
FOLDERS = ("app", "metagraph", "preview")
# How many texts each takes; those of `CONTEXT` begin with the context.
TEXTS = {"tr": 1, "tr_noop": 1, "phrase": 1, "tr_plural": 2, "plural_phrase": 2, "tr_context": 2}
CONTEXT = ("tr_context",)
CALL = re.compile(rf"\b(?:{'|'.join(TEXTS)})\s*\(")  # a file without one has no marked text


class Marked(NamedTuple):
    """A marked text. texts: one, or one and many. values: the names that the call has values for."""

    file: str
    line: int
    context: str | None
    texts: tuple[str, ...]
    values: frozenset[str]


def find_marked(root: Path = ROOT, folders: Iterable[str] = FOLDERS) -> Iterator[Marked]:
    """Yield every marked text of the tree, also one inside an f-string, and both of `tr(a if x else b)`."""
    for path in sorted(path for folder in folders for path in (root / folder).rglob("*.py")):
        source = path.read_text(encoding="utf-8")
        if CALL.search(source) is None:
            continue  # to parse it takes a hundred times as long
        file = path.relative_to(root).as_posix()
        for node in ast.walk(ast.parse(source)):
            name = node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else ""
            if not isinstance(node, ast.Call) or name not in TEXTS:
                continue
            values = frozenset(keyword.arg for keyword in node.keywords if keyword.arg is not None)
            for texts in product(*(list_constant_texts(x) for x in node.args[: TEXTS[name]])):
                if texts and texts[0]:
                    context = texts[0] if name in CONTEXT else None
                    yield Marked(file, node.lineno, context, texts[1:] if context else texts, values)


def list_constant_texts(node: ast.expr) -> list[str]:
    """Return the texts that an expression can be, as far as they are written in it."""
    if isinstance(node, ast.IfExp):
        return [*list_constant_texts(node.body), *list_constant_texts(node.orelse)]
    return [node.value] if isinstance(node, ast.Constant) and isinstance(node.value, str) else []


def collect_texts(every: Iterable[Marked]) -> Catalog:
    """Return marked texts, each with the file it is in."""
    out = Catalog()
    for marked in every:
        text = marked.texts if len(marked.texts) > 1 else marked.texts[0]
        out.add(text, None, [(marked.file, marked.line)], context=marked.context)
    return out


def make_catalogue(code: str) -> Catalog:
    """Return a catalogue without texts."""
    name = Locale.parse(code).english_name
    return Catalog(
        locale=code,
        header_comment=f"# {name} translation of Metagraph. MIT licence.",
        project="Metagraph",
        version=metagraph.__version__,
        msgid_bugs_address="see README.md",
        last_translator="Metagraph",
        language_team=f"{name} <see README.md>",
        creation_date=BEGUN,
        revision_date=BEGUN,
        fuzzy=False,
    )


def list_catalogues() -> Iterator[Path]:
    """Yield the catalogue of each language."""
    yield from sorted(HERE.glob("*/LC_MESSAGES/metagraph.po"))


def read_catalogue(path: Path) -> Catalog:
    """Return a catalogue. Raises babel's PoFileError where it is malformed."""
    with path.open("rb") as file:
        return read_po(file, locale=path.parent.parent.name, abort_invalid=True)


def write_catalogue(catalogue: Catalog, path: Path) -> None:
    """Write a catalogue and compile it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as file:
        # Without line numbers: they would change in every catalogue with every edit of the code.
        write_po(
            file,
            catalogue,
            width=110,
            sort_output=True,
            omit_header=False,
            include_lineno=False,
            include_previous=False,
        )
    with path.with_suffix(".mo").open("wb") as file:
        write_mo(file, catalogue)


def update(path: Path, texts: Catalog) -> None:
    """Bring a catalogue up to date. Texts that are gone stay in it as comments, for who translates a similar
    one."""
    catalogue = read_catalogue(path)
    catalogue.update(texts, no_fuzzy_matching=True, update_creation_date=False)
    catalogue.creation_date = catalogue.revision_date = BEGUN
    write_catalogue(catalogue, path)
    missing = sum(not message.string or message.fuzzy for message in catalogue if message.id)
    print(f"{path.relative_to(ROOT)}: {len(catalogue)} texts, {missing} to translate")


def main(arguments: list[str]) -> int:
    if arguments[:1] == ["new"] and len(arguments) == 2:
        path = HERE / arguments[1] / "LC_MESSAGES" / "metagraph.po"
        if not path.exists():
            write_catalogue(make_catalogue(arguments[1]), path)
    elif arguments:
        print(__doc__)
        return 2
    texts = collect_texts(find_marked())
    for path in list_catalogues():
        update(path, texts)
    return 0
