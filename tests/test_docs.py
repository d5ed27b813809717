"""What the documentation says is true: its code runs, its links lead somewhere, its fields are the
schema's.
"""

from __future__ import annotations

import contextlib
import io
import json
import re
import runpy
import shlex
import shutil
from importlib.util import find_spec
from pathlib import Path

import msgspec
import pytest

from app.cli.parser import COMMANDS, main
from app.features import check_studio_features
from metagraph.common.studio import read_studio
from metagraph.engines import vectors
from metagraph.engines.targets import registry
from metagraph.formats.language_files import read_pack
from metagraph.formats.store import parse_project
from metagraph.research.study.perceive.perceive_plan import PerceivePlan
from metagraph.research.study.perceive.perceive_plan import parse_perceive_plan as perceive_from_text
from metagraph.research.study.study_plan import parse_study_plan as study_from_text
from tests.thorough import many

# Papers are drawn by Qt; whoever opens windows later in this process needs its application.
pytestmark = pytest.mark.usefixtures("qapp", "quick_codes")

ROOT = Path(__file__).resolve().parents[1]
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "CHANGELOG.md",
    *sorted((ROOT / "docs").rglob("*.md")),
]
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.S | re.M)
PICTURES = ("timing", "practice", "empty", "performance")


def blocks(page: Path) -> list[tuple[str, str]]:
    """Every block of code of a page, with its language."""
    return BLOCK.findall(page.read_text(encoding="utf-8"))


def of(*languages: str) -> list[object]:
    return [
        pytest.param(page, n, id=f"{page.name}-{n}")
        for page in PAGES
        for n, (language, _) in enumerate(blocks(page))
        if language in languages
    ]


@pytest.fixture
def samples(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the sample projects to work in."""
    for name in (
        "sample.metagraph.yaml",
        "practice.metagraph.yaml",
        "mannequin.glb",
        "ada.glb",
        "ben.glb",
        "clips",
        "lines",
        "conversation",
        "annotation",
        "keypoints",
        "study",
    ):
        source = ROOT / "sample_clips" / name
        shutil.copytree(source, tmp_path / name) if source.is_dir() else shutil.copy(source, tmp_path / name)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(("page", "n"), of("python"))
def test_python_in_the_pages_runs_and_prints_what_follows_it(
    page: Path, n: int, samples: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    every = blocks(page)
    monkeypatch.setattr(
        Path,
        "write_bytes",
        lambda self, data: pytest.fail("wrote other bytes") if self.read_bytes() != data else len(data),
    )
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(compile(every[n][1], f"{page.name} block {n}", "exec"), {"__name__": "page"})
    if n + 1 < len(every) and every[n + 1][0] == "text":
        assert out.getvalue() == every[n + 1][1]


# What a command may be told on top, so that it does all it does, but short and small.
SMALLER = {
    ("render",): "-s 0.3 --size 96x64 --frames 2",
    ("label",): "--play 0 --no-pictures",
    ("generate", "train"): "--seconds 0.5 --threads 1",
    ("generate", "evaluate"): "--draws 2",
    ("study", "simulate"): "--participants 6",
}
# Those of a folder of clips that are given the clips of three stances, of the arms and of the head.
OF_CLIPS = ("import", "label", "motion-graph")
THREE = ("hands_at_sides__", "on_hips__", "head_straight__")
RUN: set[str] = set()  # commands that have run, without the slashes that folders may end with


def is_needed(words: list[str], later: list[str]) -> bool:
    """Return whether a command may write what later ones read."""
    if "-o" not in words:
        return bool(later)
    written = words[words.index("-o") + 1].partition(".")[0]
    return any(written in line for line in later)


@pytest.mark.nightly
@pytest.mark.gl
@pytest.mark.parametrize(("page", "n"), of("sh"))
def test_commands_in_the_pages_run(
    page: Path, n: int, samples: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    every = vectors.list_cases
    monkeypatch.setattr(vectors, "list_cases", lambda project: [*every(project)][:: many(40, 1)])
    lines = blocks(page)[n][1].splitlines()
    for path in (samples / "clips").iterdir():
        if path.name.startswith(THREE):
            (samples / "few").mkdir(exist_ok=True)
            shutil.copy(path, samples / "few")
    for number, line in enumerate(lines):
        plain = line.replace("/ ", " ").rstrip("/")
        program, *words = shlex.split(line)
        assert program == "metagraph"
        if plain in RUN and not is_needed(words, lines[number + 1 :]):
            continue  # another page has it, too
        RUN.add(plain)
        if words[:2] == ["generate", "train"] and find_spec("torch") is None:
            pytest.skip("training needs torch")
        if words[0] in OF_CLIPS:
            words = ["few/" if word == "clips/" else word for word in words]
        for begin, more in SMALLER.items():
            words += more.split() if words[: len(begin)] == [*begin] else []
        assert main(words) == 0, (line, capsys.readouterr().err)
        if "-o" in words:
            out = samples / words[words.index("-o") + 1]
            assert out.is_file() or any(out.iterdir())


@pytest.mark.parametrize(("page", "n"), of("yaml"))
def test_project_and_study_files_in_the_pages_can_be_read(page: Path, n: int, tmp_path: Path) -> None:
    text = blocks(page)[n][1]
    if text.startswith("code:"):
        (tmp_path / "pack.yaml").write_text(text, encoding="utf-8")
        assert read_pack(tmp_path / "pack.yaml").small
        return
    if text.startswith("study:"):
        assert study_from_text(text).tasks
        return
    if text.startswith("perceive:"):
        assert perceive_from_text(text).pairs
        return
    if page.name == "studio.md":
        (tmp_path / "studio.yaml").write_text(text, encoding="utf-8")
        assert check_studio_features(read_studio(tmp_path / "studio.yaml")).problems == ()
        return
    project = parse_project(text, Path("page.metagraph.yaml"))
    assert project.clips and project.skeleton is not None
    assert any(a.kind == "gesture" for a in project.actions()) or any(
        m.links for m in project.manual.values()
    )


def anchors(page: Path) -> set[str]:
    """What headings of a page are called in links, as GitHub does."""
    out: dict[str, int] = {}
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    found = set()
    for title in re.findall(r"^#+ (.+)$", text, re.M):
        name = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        count = out.get(name, 0)
        out[name] = count + 1
        found.add(name if count == 0 else f"{name}-{count}")
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_and_pictures_lead_somewhere(page: Path) -> None:
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if target.startswith("https://"):
            continue
        file, _, anchor = target.partition("#")
        place = page if not file else page.parent / file
        assert place.is_file(), target
        if anchor:
            assert anchor in anchors(place), target


# What exports, recipes and folders that strangers prepared have.
OTHERS_FILES = {
    "Content/Python/metagraph_study_log.py",
    "metagraph_study_log.py",
    "greeting_commands.py",
    "json.py",
    "numpy.py",
    "sample_gestures.py",
    "sitecustomize.py",
}
FOLDERS = ("app", "docs", "metagraph", "preview", "sample_clips", "tests")


@pytest.mark.nightly
def test_python_files_that_pages_name_are_there() -> None:
    """A name in backticks may leave out the folders at its beginning: `live_hours.py`."""
    there = {f"/{path.relative_to(ROOT).as_posix()}" for f in FOLDERS for path in (ROOT / f).rglob("*.py")}
    there.add("/run.py")
    missing = [
        (page.name, name)
        for page in PAGES
        if page.name != "CHANGELOG.md"  # what it says was so when it was written
        for words in re.findall(r"`([^`\n]+)`", BLOCK.sub("", page.read_text(encoding="utf-8")))
        for name in re.findall(r"(?<!\S)[\w./-]+\.py(?!\S)", words)
        if name not in OTHERS_FILES and not any(path.endswith(f"/{name}") for path in there)
    ]
    assert not missing


def test_the_walk_of_a_clip_goes_through_functions_that_are_there() -> None:
    """A row names a class, a function or a method, and the file it is defined in."""
    text = (ROOT / "docs" / "contributing" / "walk-of-a-clip.md").read_text(encoding="utf-8")
    steps = re.findall(r"`([\w.]+)`(?:, | \()`([\w/]+\.py)`", text)
    assert len(steps) > 20
    for name, path in steps:
        code = (ROOT / path).read_text(encoding="utf-8")
        *owner, last = name.split(".")
        assert re.search(rf"^ *(?:def|class) {last}\b|^{last} = ", code, re.M), (name, path)
        assert not owner or re.search(rf"^class {owner[0]}\b", code, re.M), (name, path)


def test_the_page_of_requests_that_exports_carry_is_what_the_docs_say() -> None:
    """Else: `.venv/bin/python docs/requests_page.py`."""
    written = runpy.run_path(str(ROOT / "docs" / "requests_page.py"))
    assert written["PAGE"].read_text(encoding="utf-8") == written["page"]()


RUNTIMES = ROOT / "metagraph" / "engines" / "runtimes"
RUN_AS_TEST = ROOT / "tests" / "engines" / "run"
SHOWN_ELSEWHERE = ("js", "html", "gdscript", "csharp", "cpp", "py")


@pytest.mark.parametrize("page", sorted((ROOT / "docs" / "engines").glob("*.md")), ids=lambda page: page.name)
def test_first_lines_for_engines_are_lines_that_tests_run(page: Path) -> None:
    """Those of READMEs are run, compiled or parsed by the runtimes' tests; the others are parts of these."""
    run = {code for readme in RUNTIMES.rglob("README.md") for _, code in blocks(readme)}
    drivers = "".join(path.read_text(encoding="utf-8") for path in sorted(RUN_AS_TEST.glob("*.mjs")))
    guide = (ROOT / "metagraph" / "engines" / "targets" / "unity_controller.py").read_text(encoding="utf-8")
    if page.name == "parameters.md":  # tests/engines/test_typed_wrappers.py runs and compiles its code
        return
    for language, code in blocks(page):
        if language not in SHOWN_ELSEWHERE or code in run:
            continue
        if "SetTrigger" in code:  # numbers and names are the project's
            assert all(line.split("(")[0] in guide for line in code.splitlines()), code
        else:
            assert all(line in drivers for line in code.splitlines()), code


def test_every_target_is_in_the_table_and_exported_on_a_page() -> None:
    pages = {p.name: p.read_text(encoding="utf-8") for p in (ROOT / "docs" / "engines").glob("*.md")}
    rows = re.findall(r"^\| `([\w-]+)` \| .*\]\(([\w-]+\.md)", pages["index.md"], re.M)
    assert sorted(name for name, _ in rows) == sorted(registry.list_targets())
    for name, page in rows:
        assert name == registry.DEFAULT or f"--target {name}" in pages[page], name
        (row,) = (line for line in pages["index.md"].splitlines() if line.startswith(f"| `{name}` |"))
        if registry.get_target(name).untried:
            assert re.search(r"\bnot (at hand|run)\b", row), name


def test_readmes_of_runtimes_name_no_file_that_is_not_there() -> None:
    """Files in backticks beside the user's own (sample.*) are the runtime's, or are told to be made."""
    for readme in RUNTIMES.rglob("README.md"):
        text = BLOCK.sub("", readme.read_text(encoding="utf-8"))
        for name in re.findall(r"`([\w./-]+\.(?:m?js|gd|cs|hpp|py))`", text):
            folders = (readme.parent, readme.parent / "addons" / "metagraph", RUNTIMES / "web")
            made = name == "metagraph-character.js" or name.startswith(
                ("sample.", "sample_", "Sample")
            )  # by the export
            there = any((f / name).is_file() or [*f.rglob(Path(name).name)] for f in folders)
            assert made or there, (readme, name)


def test_the_pages_of_commands_are_what_the_parsers_say() -> None:
    """Else: `.venv/bin/python docs/command_line_page.py`."""
    written = runpy.run_path(str(ROOT / "docs" / "command_line_page.py"))["pages"]()
    assert len(written) == 6
    for path, text in written.items():
        assert path.read_text(encoding="utf-8") == text, path.name
    every = "".join(written.values())
    assert not [name for name in COMMANDS if f"## metagraph {name}\n" not in every]


def test_the_readme_shows_the_window_and_the_pictures_are_pictures() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "docs/images/screens/graph-1680x1050-dark.webp" in text
    for name in PICTURES:
        assert (ROOT / "docs" / "images" / f"{name}.png").read_bytes().startswith(b"\x89PNG"), name
    screens = list((ROOT / "docs" / "images" / "screens").iterdir())
    assert len(screens) == 40 and all(s.read_bytes()[8:12] == b"WEBP" for s in screens)


def test_every_field_of_the_schema_is_described() -> None:
    schema = json.loads((ROOT / "metagraph" / "engines" / "metagraph.schema.json").read_bytes())
    pages = (
        "reference/export",
        "reference/export-layers",
        "reference/export-rigs",
        "agents/requests",
        "agents/moods",
        "agents/speech",
    )
    export = "".join((ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8") for page in pages)
    fields = {name for part in schema["$defs"].values() for name in part["properties"]}
    assert not {f for f in fields if not re.search(rf"`{f}[\[`]", export)}
    assert not {part for part in schema["$defs"] if part not in export}


def test_every_field_of_a_study_file_and_every_event_of_its_log_is_described() -> None:
    from metagraph.research.study.logs.log import TYPES
    from metagraph.research.study.study_plan import study_schema_text

    pages = ("study-file", "study-log")
    text = "".join((ROOT / "docs" / "researchers" / f"{p}.md").read_text(encoding="utf-8") for p in pages)
    schema = json.loads(study_schema_text())
    fields = {name for part in schema["$defs"].values() for name in part["properties"]}
    assert not {f for f in fields | set(TYPES) if f"`{f}`" not in text}


def test_every_field_of_a_perceptual_study_is_described() -> None:
    text = (ROOT / "docs" / "researchers" / "perceptual-plan.md").read_text(encoding="utf-8")
    parts = msgspec.json.schema(PerceivePlan)["$defs"]
    fields = {
        name for part, said in parts.items() if part not in ("Item", "Scale") for name in said["properties"]
    }
    assert "mismatched" in text and not {f for f in fields if f"`{f}`" not in text}


def test_every_field_of_a_project_file_is_described() -> None:
    from metagraph.formats.project import data

    pages = ("project-file", "export", "export-layers")  # actions have the export's fields
    text = "".join((ROOT / "docs" / "reference" / f"{p}.md").read_text(encoding="utf-8") for p in pages)
    fields = data._PROJECT_FIELDS | data._CLIP_FIELDS | data._ACTION_FIELDS
    assert not {f for f in fields if not re.search(rf"(`{f}`|^{f}:|[{{ ]{f}: )", text, re.M)}


def test_random_generators_are_only_where_the_page_on_randomness_says() -> None:
    text = (ROOT / "docs" / "reference" / "randomness.md").read_text(encoding="utf-8")
    using = {
        path.relative_to(ROOT).parts[1]
        for path in (ROOT / "metagraph").rglob("*.py")
        if re.search(r"default_rng\(|\brandom\.Random\(|manual_seed\(", path.read_text(encoding="utf-8"))
    }
    assert using == set(re.findall(r"`metagraph\.(\w+)`", text))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_no_page_names_a_place_on_somebodys_machine(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert not re.findall(r"(?<![\w.])(?:/(?:home|Users|root|tmp|srv|mnt)/|[A-Z]:\\)", text)
    assert set(re.findall(r"https?://([^/\s)]+)", text)) <= {"keepachangelog.com", "semver.org"}
