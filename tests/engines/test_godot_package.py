"""The add-on for Godot 4 as a package: typed, without what Godot warns of, and laid out as its Asset Library wants.

Godot's build for the web is a release, which warns of nothing, so its warnings are looked for here.
"""

from __future__ import annotations

import configparser
import re
from pathlib import Path

import pytest

from metagraph import __version__
from metagraph.engines.targets import registry
from metagraph.formats.store import open_project
from tests.engines.godot_runtime import ADDON, GODOT3

METAGRAPH = ADDON / "metagraph"
TYPED = ("metagraph_character.gd", "plugin.gd")  # the core is shared with Godot 3
# Functions of Godot 4 whose names no variable should have.
GLOBALS = set(
    """abs acos asin atan atan2 ceil clamp cos ease exp floor fmod hash lerp log max min pow print range remap round
    seed sign sin snapped sqrt str tan typeof wrap assert char convert len load preload ord""".split()  # noqa: SIM905
)
MEMBER = r"^(?:@\S+(?:\([^)]*\))? )*(?:static )?(?:var|const|signal|enum|func|class) (\w+)"


def read_code(text: str) -> str:
    """Return a script without texts and comments."""
    plain = re.sub(r'"(?:\\.|[^"\\\n])*"', '""', text)
    return "\n".join(line.split("#")[0].rstrip() for line in plain.splitlines())


def list_warnings(text: str) -> list[str]:
    """Return what Godot 4 would warn of: variables and parameters that nothing reads, or that hide another name."""
    code = read_code(text)
    members = {*re.findall(MEMBER, code, re.MULTILINE)}
    out = []
    for block in re.split(r"^(?=(?:static )?func )", code, flags=re.MULTILINE)[1:]:
        head, _, body = block.partition(":\n")
        body = re.split(r"^\S", body, flags=re.MULTILINE)[0]
        function, inside = re.findall(r"func (\w+)\((.*)\)", head, re.DOTALL)[0]
        given = [word for part in inside.split(",") if (word := re.split("[:=]", part)[0].strip())]
        made = re.findall(r"\bvar (\w+)", body)
        out += [f"{function}: {p} is not read" for p in given if p[0] != "_" and not count(p, body)]
        out += [f"{function}: {v} is not read" for v in made if count(v, body) < 2]
        hiding = {*given, *made, *re.findall(r"\bfor (\w+)", body)}
        out += [f"{function}: {name} hides another" for name in sorted(hiding & (GLOBALS | members))]
    return out


def count(name: str, body: str) -> int:
    return len(re.findall(rf"(?<!\.)\b{name}\b", body))


def list_untyped(text: str) -> list[str]:
    """Return the declarations of a script that name no type."""
    code = read_code(text)
    out = re.findall(r"\bvar \w+ *(?:=|:=|$)", code, re.MULTILINE) + re.findall(r"\bfor \w+ in\b", code)
    for name, inside, answer in re.findall(r"func (\w+)\(([^)]*)\)( -> \w)?", code):
        out += [f"{name}: {part.strip()}" for part in inside.split(",") if part and ":" not in part]
        out += [] if answer else [f"{name} returns no type"]
    return out


def test_the_check_finds_what_godot_warns_of() -> None:
    wrong = 'extends Node\nvar a\n\nfunc f(b, range):\n\tvar c = 1\n\tfor a in "c":\n\t\tpass\n'
    assert list_warnings(wrong) == [
        "f: b is not read",
        "f: range is not read",
        "f: c is not read",
        "f: a hides another",
        "f: range hides another",
    ]
    assert len(list_untyped(wrong)) == 6


@pytest.mark.parametrize(
    "path", sorted(ADDON.rglob("*.gd")), ids=lambda path: path.relative_to(ADDON).as_posix()
)
def test_no_script_has_what_godot_warns_of(path: Path) -> None:
    assert list_warnings(path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("name", TYPED)
def test_what_games_call_is_typed(name: str) -> None:
    assert list_untyped((METAGRAPH / name).read_text(encoding="utf-8")) == []


def test_the_scripts_of_an_export_are_typed_and_its_files_are_those_the_readme_names(
    few: Path, tmp_path: Path
) -> None:
    report = registry.write_for_target(open_project(few).project, "godot", tmp_path)
    written = {path.relative_to(tmp_path).as_posix() for path in report.files}
    for name in ("sample.gd", "sample.tree.gd"):
        text = (tmp_path / name).read_text()
        assert list_untyped(text) == [] and list_warnings(text) == []
    assert {"sample.library.tres", "sample.tree.tres", "sample.tree.tscn", "sample.glb.import"} <= written
    assert {"godot3/.gdignore", "godot3/addons/metagraph/core/shim3.gd"} <= written
    settings = configparser.ConfigParser()
    settings.read(tmp_path / "sample.glb.import")
    assert settings["remap"]["importer"] == '"scene"' and settings["params"]["animation/import"] == "false"
    readme = (METAGRAPH / "README.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`(sample\.[\w.]+)`", readme))
    assert named <= written, named - written


def test_godot_3_lays_its_own_files_over_the_add_on_and_godot_4_passes_over_them() -> None:
    own = {path.relative_to(GODOT3).as_posix() for path in GODOT3.rglob("*.gd")}
    assert own == {"metagraph/metagraph_character.gd", "metagraph/core/shim3.gd"}
    assert (GODOT3.parent / ".gdignore").is_file() and not (METAGRAPH / "core" / "shim3.gd").exists()
    for path in ADDON.rglob("*.gd"):
        code = read_code(path.read_text(encoding="utf-8"))
        assert not re.search(r"^(tool|onready|export ?\()|\byield\(|extends Spatial", code, re.MULTILINE), (
            path
        )


def test_the_plugin_says_what_it_is() -> None:
    found = configparser.ConfigParser()
    found.read(METAGRAPH / "plugin.cfg")
    plugin = {key: value.strip('"') for key, value in found["plugin"].items()}
    assert plugin["version"] == __version__ and (METAGRAPH / plugin["script"]).is_file()
    assert all(plugin[key] for key in ("name", "description", "author"))
    assert (METAGRAPH / "LICENSE").read_text() == (Path(__file__).parents[2] / "LICENSE").read_text()
