"""What the manual's site needs beyond MkDocs: headings have GitHub's anchors, files of the
repository that pages link to are published with them, and each page lies as Markdown beside its HTML,
listed in `llms.txt`.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files, InclusionLevel

ROOT = Path(__file__).resolve().parents[1]
DOCS = "docs/"
OUTSIDE = "repository/"  # where files from outside docs/ are on the site
LINK = re.compile(r"(\]\()([^)\s]+)(\))")
CODE = re.compile(r"^```.*?^```$", re.S | re.M)


def on_config(config: Any) -> Any:
    """Give headings the anchors that links on GitHub have."""
    config.mdx_configs["toc"] = {**config.mdx_configs.get("toc", {}), "slugify": anchor}
    return config


def anchor(title: str, separator: str = "-") -> str:
    """Return what a heading is called in links, as GitHub does."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", separator)


def on_files(files: Files, *, config: Any) -> Files:
    """Publish what pages link to outside docs/, and what those pages link to in turn."""
    todo = [DOCS + file.src_uri for file in files if file.src_uri.endswith(".md")]
    known = {file.src_uri for file in files}
    while todo:
        page = todo.pop()
        for target in _targets(page):
            uri = _uri(target)
            if uri in known or not (ROOT / target).is_file():
                continue
            known.add(uri)
            page_too = target.endswith(".md")
            level = InclusionLevel.NOT_IN_NAV if page_too else InclusionLevel.INCLUDED
            files.append(File.generated(config, uri, abs_src_path=str(ROOT / target), inclusion=level))
            if page_too:
                todo.append(target)
    return files


def on_page_markdown(markdown: str, *, page: Any, config: Any, files: Files) -> str:
    """Have links lead to where the linked files are on the site."""
    source = _source(page.file.src_uri)
    if page.file.src_uri.startswith(OUTSIDE):
        page.meta["search"] = {"exclude": True}  # the manual's own pages are what is searched for

    def moved(link: re.Match[str]) -> str:
        target, hash_, part = link[2].partition("#")
        if not target or "://" in target:
            return link[0]
        full = posixpath.normpath(posixpath.join(posixpath.dirname(source), target))
        there = posixpath.relpath(_uri(full), posixpath.dirname(page.file.src_uri) or ".")
        return f"{link[1]}{there}{hash_}{part}{link[3]}"

    return "".join(
        part if part.startswith("```") else LINK.sub(moved, part)
        for part in re.split(rf"({CODE.pattern})", markdown, flags=re.S | re.M)
    )


def on_post_build(*, config: Any) -> None:
    """Write each page as Markdown beside its HTML, and the list of all pages."""
    site, docs = Path(config.site_dir), ROOT / DOCS
    lines = [f"# {config.site_name}", "", f"> {config.site_description}", ""]
    for depth, title, uri in _pages(config.nav):
        if uri is None:
            lines += ["", f"{'#' * (depth + 2)} {title}", ""]
            continue
        text = (docs / uri).read_text(encoding="utf-8")
        (site / uri).parent.mkdir(parents=True, exist_ok=True)
        (site / uri).write_text(text, encoding="utf-8")
        lines.append(f"- [{heading(text)}]({uri}): {first_sentence(text)}")
    (site / "llms.txt").write_text(re.sub(r"\n{3,}", "\n\n", "\n".join(lines)) + "\n", encoding="utf-8")


def heading(text: str) -> str:
    """Return a page's title."""
    found = re.search(r"^# (.+)$", text, re.M)
    return found[1] if found else ""


def first_sentence(text: str) -> str:
    """Return the first sentence of a page's first paragraph, without Markdown's marks."""
    body = re.sub(r"^# .+$", "", CODE.sub("", text), count=1, flags=re.M)
    part = next((p for p in re.split(r"\n\s*\n", body.strip()) if p and p[0] not in "|!#-<"), "")
    plain = re.sub(r"!?\[([^\]]*)\]\([^)]*\)|[*`]", lambda m: m[1] or "", " ".join(part.split()))
    return re.split(r"(?<=[.:?]) ", plain, maxsplit=1)[0]


def _pages(nav: Any, depth: int = 0) -> Iterator[tuple[int, str, str | None]]:
    """Yield depth, title and file of each entry of `nav`; sections have no file."""
    for entry in nav:
        if isinstance(entry, str):
            yield depth, "", entry
            continue
        for title, inside in entry.items():
            if isinstance(inside, str):
                yield depth, title, inside
            else:
                yield depth, title, None
                yield from _pages(inside, depth + 1)


def _targets(page: str) -> Iterator[str]:
    """Yield the files that a page of the repository links to, from the root."""
    text = CODE.sub("", (ROOT / page).read_text(encoding="utf-8"))
    for _, link, _ in LINK.findall(text):
        target = link.partition("#")[0]
        if target and "://" not in target:
            yield posixpath.normpath(posixpath.join(posixpath.dirname(page), target))


def _uri(path: str) -> str:
    """Return what a file of the repository is called on the site."""
    shown = path.startswith(DOCS) and not path.endswith(".py") and not path.startswith(DOCS + "clients/")
    return path[len(DOCS) :] if shown else OUTSIDE + path


def _source(uri: str) -> str:
    return uri[len(OUTSIDE) :] if uri.startswith(OUTSIDE) else DOCS + uri
