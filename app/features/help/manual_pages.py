"""Find the pages of the manual, which lie beside the program, and the page of each panel."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import yaml

import app

DOCS = Path(app.__file__).resolve().parents[1] / "docs"
FIRST = "index.md"
_ABOUT = {  # panels by page
    "animators/bring-clips.md": "library",
    "animators/graph.md": "graph properties problems machine",
    "animators/life.md": "character life lines",
    "animators/manual-machine.md": "manual inspector",
    "animators/perform.md": "timeline",
    "animators/props.md": "props",
    "animators/parameters.md": "parameters",
    "animators/safety.md": "history",
    "animators/table.md": "table",
    "animators/talk.md": "conversation",
    "animators/time.md": "timing",
    "animators/workspaces.md": "notes",
    "researchers/index.md": "models",
}
PAGES = {panel: page for page, panels in _ABOUT.items() for panel in panels.split()}


class ManualEntry(NamedTuple):
    """A page, or a part of one that begins with a heading; a section of pages has no page. depth: from 0."""

    depth: int
    title: str
    page: str
    heading: str = ""


@cache
def list_manual_entries() -> tuple[ManualEntry, ...]:
    """Return sections and pages in the order of the site's navigation."""
    return tuple(_entries(yaml.safe_load((DOCS / "mkdocs.yml").read_text(encoding="utf-8"))["nav"], 0))


def _entries(nav: Any, depth: int) -> Iterator[ManualEntry]:
    for item in nav:
        title, inside = ("", item) if isinstance(item, str) else next(iter(item.items()))
        if isinstance(inside, str):
            text = (DOCS / inside).read_text(encoding="utf-8")
            yield ManualEntry(
                depth, title or strip_markdown(text.partition("# ")[2].partition("\n")[0]), inside
            )
        else:
            yield ManualEntry(depth, title, "")
            yield from _entries(inside, depth + 1)


def anchor(heading: str) -> str:
    """Return the anchor of a heading."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def strip_markdown(text: str) -> str:
    """Return the text of Markdown without its marks."""
    return re.sub(r"!?\[([^\]]*)\]\([^)]*\)|[*`]", lambda m: m[1] or "", text).strip()


def search_pages(words: str) -> list[ManualEntry]:
    """Return the parts of pages that have all words, those with the words in title or heading first."""
    wanted, hits = words.casefold().split(), list[tuple[int, ManualEntry]]()
    for entry in list_manual_entries() if wanted else ():
        text = strip_markdown((DOCS / entry.page).read_text(encoding="utf-8")) if entry.page else ""
        for part in re.split(r"^## ", text, flags=re.M):
            heading = "" if part.startswith("# ") else part.partition("\n")[0]
            named, part = f"{entry.title} {heading}".casefold(), part.casefold()
            if all(word in named or word in part for word in wanted):
                rank = sum(word not in named for word in wanted)
                hits.append((rank, ManualEntry(0, entry.title, entry.page, heading)))
    return [hit for _, hit in sorted(hits, key=lambda ranked: ranked[0])]


def format_for_qt(text: str, words: dict[str, str]) -> str:
    """Return a page as Qt reads Markdown: an admonition becomes a quotation that begins with its title, or
    with what its kind is called in `words`.
    """
    out, inside = [], False
    for line in text.splitlines():
        begin = re.match(r'!!! (\w+)(?: "(.*)")?$', line)
        inside = begin is not None or (inside and (line.startswith("    ") or not line))
        if begin:
            out += [f"> **{begin[2] or words.get(begin[1], begin[1])}**", ">"]
        else:
            out.append(f"> {line[4:]}" if inside and line else line)
    return "\n".join(out) + "\n"
