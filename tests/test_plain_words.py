"""Texts for people, docstrings and comments are plain English: none has a phrase of the lists below."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import pytest

pytest.importorskip("babel")
from app.languages.catalogues import find_marked

ROOT = Path(__file__).resolve().parents[1]
QUOTES = ("docs/contributing/style.md",)  # shows what not to write
# Made from the parsers of commands (`docs/command_line_page.py`).
MADE = (
    "docs/reference/command-line.md",
    "docs/reference/command-line-generate.md",
    "docs/reference/command-line-motion-graph.md",
    "docs/reference/command-line-perceive.md",
    "docs/reference/command-line-research.md",
    "docs/reference/command-line-study.md",
)

# A regular expression (a blank stands for any white space) and what to write instead.
PHRASES = {
    r"\b(leave|leaves|left|leaving) aside\b": "skip, skipped",
    r"\bof before\b": "earlier, previous",
    r"\ball alike\b": "all of them",
    r"\bas it were\b": "leave it out",
    r"\bwhat is asked for\b": "the requests",
    r"(?<![{`\w])anew\b": "again",
    r"\b(is|are|was|were) told\b(?! (to|that|who|what|how|when|it|g|in words)\b)": "is reported, is given",
    r"(?-i:\bNone where\b)": "None if",
    r"\breckon(ed|s|ing)?\b": "count, compute",
    r"\blikewise\b": "in the same way",
    r"\bas good as\b": "almost",
    r"\bthe very same\b": "the same",
    r"\bwholly\b": "entirely",
    r"\btold apart\b": "distinguished",
    r"\bround about\b": "about",
    r"\b(told|tells?) of\b": "reports",
    r", whichever(?=\s*([.;:|]|$))": "any",
    r"\bnone such\b": "no such",
    r"\b(moves?|looks?|does|do|plays?) otherwise\b": "differently",
    r"\bwith (it|them|him) go(es)?\b": "goes with it",
    r"\bso sure\b": "that certain",
    r"\bas dear\b": "as expensive",
    r"\bdearest\b": "most expensive",
    r"\bfellows?\b": "counterpart",
    r"\bwhere that is so\b": "if so",
    r"\bin no file\b": "unsaved",
    r"\bthrice\b": "three times",
    r"\b(whence|whither|thereof|therein|thereupon|hitherto)\b": "from where, of it, in it, so far",
    r"\bwith what chance\b": "with which seed",
    r"\btimes what is usual\b": "times the usual",
    r"\bfor want of\b": "without",
}
# The same for docstrings of front doors only.
DOCSTRING_PHRASES = {
    r"\bwhoever\b": "the one who, code that",
    r"\bdear\b": "expensive",
    r"\bbut for\b": "except for",
    r"\b(under way|on the way)\b": "in progress, at the same time",
    r"\bwhere (nothing|that is|there is none)\b": "if nothing, if that is, if there is none",
    r"\b(is|are) alike\b": "are equal, are similar",
}
# The same for what the command line and the live server print.
PRINTED_PHRASES = {
    r"\bgo on (with|where)\b": "continue",
    r"\b(for|by|only|keep|up to) so (many|much|long)\b": "this many",
    r"\bso many (seconds|frames|of)\b": "this many",
    r"\b(is|are) called (so|as)\b": "has this name, has the name of",
    r"\bcalled as\b": "with the name of",
    r"\bnobody is called\b": "there is no",
    r"(^|[:;,'] )(is|are) no (sound|model|seed|take|number)\b": "is not a",
    r"\b(a|the) \w+ of yours\b": "your",
    r"\bcannot be taken back\b": "cannot be undone",
    r"\bsays? nothing of\b": "does not describe, does not apply to",
    r"\b(made|are|was|is) made out\b": "recognised",
    r"\bwhat (is said|there is|was played|was asked)\b": "a noun, such as transcript, list, performance",
    r"\bmade-up\b": "synthetic",
    r"\btake (it|them|this) over\b": "use, accept",
    r"\bholds? (no|a study|other)\b": "has no",
    r"\bit is written as\b": "the file can be",
}
PRINTING = ("app/cli/*.py", "metagraph/live/*.py")

# Modules that a new maintainer reads first.
FRONT_DOORS = (
    "app/main.py",
    "app/project/*.py",
    "app/shell/*.py",
    "app/stage/*.py",
    "app/translation.py",
    "metagraph/engines/character.py",
    "metagraph/engines/contract.py",
    "metagraph/engines/export.py",
    "metagraph/engines/targets/losses.py",
    "metagraph/engines/targets/registry.py",
    "metagraph/engines/targets/target.py",
    "metagraph/formats/bvh/*.py",
    "metagraph/formats/clip_readers.py",
    "metagraph/formats/clips.py",
    "metagraph/formats/fbx/*.py",
    "metagraph/formats/gltf/*.py",
    "metagraph/formats/imports.py",
    "metagraph/formats/locking.py",
    "metagraph/formats/outputs.py",
    "metagraph/formats/recovery.py",
    "metagraph/formats/project/clip_loading.py",
    "metagraph/formats/project/paths.py",
    "metagraph/formats/store.py",
    "metagraph/formats/stray_poses.py",
    "metagraph/formats/takes.py",
    "metagraph/graph/check.py",
    "metagraph/graph/checks/*.py",
    "metagraph/graph/edits.py",
    "metagraph/graph/model.py",
    "metagraph/graph/requests.py",
    "metagraph/graph/timeline_edits.py",
    "metagraph/live/live_session.py",
    "metagraph/live/messages.py",
    "metagraph/live/schemas.py",
    "metagraph/motion/clip.py",
    "metagraph/motion/joint_map.py",
    "metagraph/motion/retarget.py",
    "metagraph/motion/rotation.py",
    "metagraph/motion/skeleton.py",
    "metagraph/playback/evaluator.py",
    "metagraph/playback/planner.py",
    "metagraph/playback/player.py",
    "metagraph/playback/posing/*.py",
    "metagraph/speech/clauses.py",
    "metagraph/speech/drive.py",
    "metagraph/speech/lines.py",
    "metagraph/suggest/*.py",
    "preview/*.py",
)


class Found(NamedTuple):
    file: str
    line: int
    text: str
    plain: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: '{self.text}': write {self.plain}"


@cache
def compile_any(phrases: tuple[str, ...]) -> re.Pattern[str]:
    """Return a pattern that finds any of the phrases. All begin with a word or a mark, so that it looks only
    there, in a quarter of the time.
    """
    either = "|".join(f"(?:{phrase})" for phrase in phrases).replace(" ", r"\s+")
    return re.compile(rf"(?:\b(?=\w)|(?=[:;,']))(?:{either})", re.IGNORECASE | re.MULTILINE)


def search(file: str, first_line: int, text: str, phrases: Mapping[str, str] = PHRASES) -> Iterator[Found]:
    """Yield the phrases that a text has. The text begins in line `first_line` of the file."""
    if not compile_any(tuple(phrases)).search(text):
        return  # nearly every text: one look is as quick as one at a phrase
    for phrase, plain in phrases.items():
        pattern = phrase.replace(" ", r"\s+")
        for match in re.finditer(pattern, text, re.IGNORECASE | re.MULTILINE):
            line = first_line + text.count("\n", 0, match.start())
            yield Found(file, line, " ".join(match[0].split()), plain)


def search_pages(root: Path, pages: Iterable[Path]) -> Iterator[Found]:
    for page in pages:
        yield from search(page.relative_to(root).as_posix(), 1, page.read_text(encoding="utf-8"))


def search_docstrings(root: Path, modules: Iterable[Path]) -> Iterator[Found]:
    """Yield the phrases in docstrings of modules, public classes and public functions."""
    for path in modules:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if not isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
                continue
            if ast.get_docstring(node) is None or getattr(node, "name", "").startswith("_"):
                continue
            text = node.body[0]
            assert isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant)
            name = path.relative_to(root).as_posix()
            yield from search(name, text.lineno, str(text.value.value), PHRASES | DOCSTRING_PHRASES)


def list_modules(root: Path = ROOT) -> Iterator[Path]:
    """Yield the modules of the program and of its tests, without this one."""
    for folder in ("app", "docs", "metagraph", "preview", "sample_clips", "tests"):
        for path in sorted((root / folder).rglob("*.py")):
            other = {"runtimes", "node_modules", "__pycache__"} & set(path.parts)
            if not other and path != Path(__file__):
                yield path


def search_comments(root: Path, modules: Iterable[Path]) -> Iterator[Found]:
    """Yield the phrases of `PHRASES` in all docstrings and comments, also those of private functions."""
    for path in modules:
        source, name = path.read_text(encoding="utf-8"), path.relative_to(root).as_posix()
        if not compile_any(tuple(PHRASES)).search(source):
            continue
        for text, line in list_docstrings(source):
            yield from search(name, line, text)
        for token in tokenize.generate_tokens(io.StringIO(source).readline):
            if token.type == tokenize.COMMENT:
                yield from search(name, token.start[0], token.string)


def list_docstrings(source: str) -> Iterator[tuple[str, int]]:
    """Yield the docstrings of a module's source, with their lines."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            first = node.body[0] if node.body else None
            if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
                yield str(first.value.value), first.lineno


def search_printed(root: Path, modules: Iterable[Path]) -> Iterator[Found]:
    """Yield the phrases in texts of more than one word that modules print; not in docstrings."""
    for path in modules:
        source, name = path.read_text(encoding="utf-8"), path.relative_to(root).as_posix()
        docstrings = {line for _, line in list_docstrings(source)}
        for node in ast.walk(ast.parse(source)):
            if (
                isinstance(node, ast.Constant)
                and isinstance(node.value, str)
                and node.lineno not in docstrings
            ):
                yield from search(name, node.lineno, node.value, PHRASES | PRINTED_PHRASES)


def list_pages(root: Path = ROOT) -> Iterator[Path]:
    """Yield the pages of the manual, the readme and the changelog."""
    for page in sorted([*root.glob("docs/**/*.md"), root / "README.md", root / "CHANGELOG.md"]):
        if not page.relative_to(root).as_posix().startswith(QUOTES + MADE):
            yield page


def show(found: Iterable[Found]) -> str:
    return "\n".join(map(str, found))


def test_the_manual_is_plain() -> None:
    found = show(search_pages(ROOT, list_pages()))
    assert not found, found


def test_marked_texts_are_plain() -> None:
    texts = ((one.file, one.line, text.replace("&", "")) for one in find_marked(ROOT) for text in one.texts)
    found = show(chain.from_iterable(search(*text) for text in texts))
    assert not found, found


def test_docstrings_of_front_doors_are_plain() -> None:
    modules = sorted(path for pattern in FRONT_DOORS for path in ROOT.glob(pattern))
    found = show(search_docstrings(ROOT, modules))
    assert not found, found


def test_docstrings_and_comments_are_plain() -> None:
    found = show(search_comments(ROOT, list_modules()))
    assert not found, found


def test_what_the_command_line_and_the_live_server_print_is_plain() -> None:
    modules = sorted(path for pattern in PRINTING for path in ROOT.glob(pattern))
    assert len(modules) > 50
    found = show(search_printed(ROOT, modules))
    assert not found, found


def test_each_front_door_is_there() -> None:
    assert not [pattern for pattern in FRONT_DOORS if not any(ROOT.glob(pattern))]


def test_a_planted_phrase_is_found(tmp_path: Path) -> None:
    page, module = tmp_path / "page.md", tmp_path / "module.py"
    page.write_text("# Page\n\nTwo clips were left\naside.\n", encoding="utf-8")
    module.write_text('"""Plain."""\n\n\ndef draw() -> None:\n    """Draw it anew."""\n', encoding="utf-8")
    assert show(search_pages(tmp_path, [page])) == "page.md:3: 'left aside': write skip, skipped"
    assert show(search_docstrings(tmp_path, [module])) == "module.py:5: 'anew': write again"


def test_planted_phrases_in_comments_and_printed_texts_are_found(tmp_path: Path) -> None:
    module = tmp_path / "module.py"
    module.write_text(
        'def _draw() -> None:\n    """Draw it anew."""\n    print("go on with it")  # likewise\n',
        encoding="utf-8",
    )
    assert [one.text for one in search_comments(tmp_path, [module])] == ["anew", "likewise"]
    assert [one.text for one in search_printed(tmp_path, [module])] == ["go on with"]


def test_private_functions_and_names_in_braces_or_backquotes_are_not_searched(tmp_path: Path) -> None:
    module = tmp_path / "module.py"
    module.write_text('def _draw() -> None:\n    """Draw it anew."""\n', encoding="utf-8")
    assert not show(search_docstrings(tmp_path, [module]))
    assert not show(search("page.md", 1, "Labelled {anew}, with `anew`."))
