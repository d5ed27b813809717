"""The manual builds without a warning, opens from disk, loads nothing from the network, and whoever names a
page of it names one that is there.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

pytest.importorskip("mkdocs")

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
NAMED = re.compile(r"(?<![\w/-])docs/[\w./-]*\w")
HERE = re.compile(r'"docs"((?: / "[\w.-]+")+)')  # ROOT / "docs" / "images" / "x.png"
# What stands in italics and is no name in the window: words that a page explains, titles, words of a search.
EXPLAINED = {
    *(
        "beat",
        "contacts",
        "cues",
        "explain",
        "journal",
        "listens",
        "needs a look",
        "ours",
        "peak",
        "performed",
    ),
    *("reacts", "retargets", "sit", "talks", "thinks"),
    "statistics-based motion synthesis for social conversations",
}
OF_THE_PAST = {"CHANGELOG.md"}  # what it says was so when it was written; its links are checked


def pages_in_nav(nav: list[object]) -> list[str]:
    out = []
    for entry in nav:
        inside = entry if isinstance(entry, str) else next(iter(entry.values()))  # type: ignore[attr-defined]
        out += [inside] if isinstance(inside, str) else pages_in_nav(inside)
    return out


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The built site."""
    out = tmp_path_factory.mktemp("manual")
    words = ["build", "--strict", "--quiet", "-f", "docs/mkdocs.yml", "-d", str(out)]
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", *words],
        cwd=ROOT,
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1", "PYTHONWARNINGS": "ignore"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr + done.stdout
    return out


def test_every_page_is_in_the_contents_once_and_on_the_site_as_html_and_markdown(site: Path) -> None:
    nav = pages_in_nav(yaml.safe_load((DOCS / "mkdocs.yml").read_text(encoding="utf-8"))["nav"])
    assert sorted(nav) == sorted(p.relative_to(DOCS).as_posix() for p in DOCS.rglob("*.md"))
    listed = (site / "llms.txt").read_text(encoding="utf-8")
    for page in nav:
        assert (site / page).read_bytes() == (DOCS / page).read_bytes()
        assert (site / page).with_suffix(".html").is_file()
        (line,) = (line for line in listed.splitlines() if f"]({page})" in line)
        assert re.fullmatch(r"- \[.+\]\(.+\): \S.+", line), line


def test_the_site_loads_nothing_from_the_network(site: Path) -> None:
    for page in site.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        loads = re.findall(r"<(?:script|img|iframe|link)\b[^>]*?(?:src|href)=[\"']?(https?:[^\"' >]+)", text)
        assert not loads, (page, loads)


CODE = re.compile(r"(?<![\w/.-])(?:tests|app|metagraph|preview|sample_clips)/[\w./-]*\w")
TABLE_OF_THE_TREE = DOCS / "contributing" / "architecture.md"
MADE_UP = (
    "greeting",
    "_",
    "metagraph/metagraph.hpp",  # in an export
    "/fr/LC_MESSAGES/metagraph.po",
)  # what recipes tell readers to make: app/features/greeting, tests/formats/test_<format>.py
IN_TESTS = "papers-"  # whose tests are named from tests/ on; tests/test_papers.py reads them


@pytest.mark.parametrize(
    "page",
    [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(DOCS.rglob("*.md"))],
    ids=lambda page: page.name,
)
def test_files_of_code_that_pages_name_are_there(page: Path) -> None:
    named = set(CODE.findall(page.read_text(encoding="utf-8")))
    roots = [ROOT, ROOT / "tests"] if page.name.startswith(IN_TESTS) else [ROOT]
    assert not [n for n in named if not n.endswith(MADE_UP) and not any((r / n).exists() for r in roots)]


def test_the_table_of_the_tree_has_every_folder_and_no_other() -> None:
    rows = set(re.findall(r"^\| `([\w/]+)/` \|", TABLE_OF_THE_TREE.read_text(encoding="utf-8"), re.M))
    assert all((ROOT / row).is_dir() for row in rows)
    for inside in ("metagraph", "app"):
        folders = {p.relative_to(ROOT).as_posix() for p in (ROOT / inside).iterdir() if p.is_dir()}
        assert {f for f in folders if not f.endswith("__pycache__")} <= rows


def test_the_order_of_imports_is_that_of_the_contracts() -> None:
    rules = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    (layers,) = (c["layers"] for c in rules["contracts"] if c["name"].startswith("inside metagraph"))
    text = TABLE_OF_THE_TREE.read_text(encoding="utf-8")
    told = [re.findall(r"`(\w+)`", line) for line in re.findall(r"^\d+\. (.+)$", text, re.M)]
    order = [[part.strip().removeprefix("metagraph.") for part in row.split("|")] for row in layers]
    assert told == order
    picture = (DOCS / "images" / "architecture.svg").read_text(encoding="utf-8")
    boxes = re.findall(r'font-size="15" font-weight="bold"[^>]*>([^<]+)<', picture)
    assert [box.split(" | ") for box in boxes][-len(order) :] == order


def test_systems_that_nobody_ran_it_on_are_offered_as_not_tested() -> None:
    seen = (DOCS / "contributing" / "platforms.md").read_text(encoding="utf-8")
    (row,) = (line for line in seen.splitlines() if line.startswith("| window, command line, tests |"))
    for n, system in enumerate(("Linux", "macOS", "Windows")):
        untested = row.strip("| ").split(" | ")[n + 1].startswith("not run")
        for page in (ROOT / "README.md", DOCS / "start" / "install.md"):
            (start,) = re.findall(rf"^\| {system}\b.*run\.py.*$", page.read_text(encoding="utf-8"), re.M)
            assert untested == ("not tested yet" in start), (system, page.name)


def find_italics(text: str) -> list[str]:
    """Return the names in italics of a page, without code: parts of a path such as *Edit > History* alone."""
    prose = re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.DOTALL)
    found = re.findall(r"(?<![*\w])\*(?!\*)([^*]+?)\*(?!\*)", prose)
    return [part for name in found for part in " ".join(name.split()).split(" > ")]


def test_names_of_commands_and_fields_on_pages_for_animators_are_in_the_window() -> None:
    pytest.importorskip("babel")
    from app.languages.catalogues import find_marked

    def plain(text: str) -> str:
        return re.sub("[&…]", "", text.partition("\t")[0]).strip(" .:").lower()

    texts = {text for one in find_marked() for text in one.texts}
    shown = {plain(text) for text in texts}
    filled = [
        re.compile(re.sub(r"\\\{[^}]*\}", ".+", re.escape(text)))
        for text in texts
        if "{" in text and len(re.sub(r"\{[^}]*\}", "", text)) > 6
    ]
    pages = [ROOT / "README.md", *DOCS.glob("start/*.md"), *DOCS.glob("animators/*.md")]
    unknown = [
        f"{page.name}: {name}"
        for page in pages
        for name in find_italics(page.read_text(encoding="utf-8"))
        if plain(name) not in shown | EXPLAINED | {""} and not any(one.fullmatch(name) for one in filled)
    ]
    assert not unknown, "write the name that the window shows, or add a word that the page explains"


def long_lines(text: str) -> list[int]:
    """Return the numbers of lines of prose with more than 120 columns, without tables, code and formulas."""
    out, in_code = [], False
    for number, line in enumerate(text.splitlines(), 1):
        in_code ^= line.lstrip().startswith("```")
        other = line.lstrip().startswith(("|", "!["))
        formula = "  " in line.strip() or line.lstrip().startswith(("`step(", '{"'))
        if len(line) > 120 and not (in_code or other or formula):
            out.append(number)
    return out


@pytest.mark.parametrize(
    "page",
    [
        *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")),
        *sorted(DOCS.rglob("*.md")),
    ],
    ids=lambda page: page.name,
)
def test_lines_of_prose_have_at_most_120_columns(page: Path) -> None:
    assert not long_lines(page.read_text(encoding="utf-8"))


def test_a_long_line_is_found_except_in_tables_and_code() -> None:
    long = "word " * 30
    assert long_lines(f"{long}\n| {long}|\n```text\n{long}\n```\n- {long}") == [1, 6]


def test_the_readme_has_at_most_120_lines() -> None:
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 120


def tracked() -> list[Path]:
    done = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True)
    if done.returncode:
        pytest.skip("only a clone with Git tells which files are the tree's")
    return [ROOT / name for name in done.stdout.split("\0") if name]


def test_every_mention_of_a_page_or_picture_is_of_one_that_is_there() -> None:
    wrong = []
    for path in tracked():
        if path.name in OF_THE_PAST or path == Path(__file__) or not path.is_file():
            continue
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        named = set(NAMED.findall(text))
        named |= {"docs" + "".join(re.findall(r"/|[\w.-]+", rest)) for rest in HERE.findall(text)}
        wrong += [(path.name, name) for name in named if not (ROOT / name).exists()]
    assert not wrong
