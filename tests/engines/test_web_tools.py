"""Where a web page's three.js and bundler come from: one folder of Metagraph's own, and only what has the digests that
are written down.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from metagraph.common import programs
from metagraph.engines.runtimes import __path__ as RUNTIMES  # noqa: N812
from metagraph.engines.targets import registry, web, web_tools
from metagraph.graph.model import Project
from tests.browsing import Browser
from tests.engines.web_tools_kept import kept_web_tools

ELEMENT = Path(RUNTIMES[0]) / "javascript" / "element.js"


@pytest.fixture
def without_npm(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(programs, "find_system_program", lambda name: None)


def _lay_out(modules: Path, ran: Path) -> None:
    """Put a three.js and an esbuild of somebody's into a `node_modules`."""
    for name in web_tools.NEEDED:
        (modules / "three" / name).parent.mkdir(parents=True, exist_ok=True)
        (modules / "three" / name).write_text("// of somebody's")
    for system in web_tools.PROGRAMS:
        program = modules / "@esbuild" / system / "bin" / "esbuild"
        program.parent.mkdir(parents=True)
        program.write_text(f"#!/bin/sh\ntouch {ran}\n")
        program.chmod(0o755)


@pytest.mark.nightly
def test_nothing_is_taken_from_folders_around_the_export_or_the_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sample: Project, without_npm: None
) -> None:
    monkeypatch.setattr(web_tools, "find_web_tools_folder", lambda: tmp_path / "kept")
    here, out, ran = tmp_path / "here", tmp_path / "project" / "out", tmp_path / "ran"
    for folder in (here, out, out.parent, tmp_path):
        _lay_out(folder / "node_modules", ran)
    here.mkdir(exist_ok=True)
    monkeypatch.chdir(here)
    report = registry.write_for_target(sample, "web", out, overwrite=True)
    assert not ran.exists() and not (out / "three").exists()
    assert any("three.js" in words for words in report.warnings)


@pytest.mark.nightly
def test_without_them_the_page_says_so_and_the_browser_compares_digests(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sample: Project, without_npm: None
) -> None:
    monkeypatch.setattr(web_tools, "find_web_tools_folder", lambda: tmp_path / "kept")
    registry.write_for_target(sample, "web", tmp_path / "out")
    page = (tmp_path / "out" / "index.html").read_text()
    assert f"This page loads three.js {web_tools.THREE} from" in page
    scripts = [name for name in web_tools.NEEDED if name.endswith(".js")]
    for name in scripts:
        said = f'"{web_tools.NET}{name}": "sha384-{web_tools.NEEDED[name]}"'
        assert said in page, name
        assert f'href="{web_tools.NET}{name}" integrity="sha384-{web_tools.NEEDED[name]}"' in page
    assert page.count(web_tools.NET) == 2 * len(scripts) + 2  # none without a digest but where the folder is
    assert "./metagraph/element.js" in (tmp_path / "out" / web.CHARACTER).read_text()


@pytest.mark.nightly
def test_a_page_that_gets_no_three_js_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sample: Project, without_npm: None, browse: Browser
) -> None:
    monkeypatch.setattr(web_tools, "find_web_tools_folder", lambda: tmp_path / "kept")
    registry.write_for_target(sample, "web", tmp_path / "out")
    page = tmp_path / "out" / "index.html"
    page.write_text(page.read_text().replace(web_tools.NET, "/nowhere/"))
    failed = {"url": "", "until": "document.querySelector('#net[role=alert]')"}
    (words,), _ = browse(tmp_path / "out", failed, {"run": "document.getElementById('net').textContent"})
    assert words.startswith(f"The character cannot be shown: three.js {web_tools.THREE} could not be loaded")


@pytest.mark.nightly
def test_what_is_kept_is_used_as_one_file(tmp_path: Path, sample: Project) -> None:
    with kept_web_tools(tmp_path / "kept"):
        registry.write_for_target(sample, "web", tmp_path / "out")
    page = (tmp_path / "out" / "index.html").read_text()
    assert "importmap" not in page and "This page loads" not in page
    assert (tmp_path / "out" / web.CHARACTER).stat().st_size > 500_000


@pytest.mark.parametrize("name", ["three/build/three.core.js", "three/LICENSE"])
def test_a_three_js_with_one_byte_changed_is_none(tmp_path: Path, without_npm: None, name: str) -> None:
    with kept_web_tools(tmp_path / "kept") as kept:
        assert web_tools.is_three_at_hand()
        path = kept / "node_modules" / name
        content = bytearray(path.read_bytes())
        content[100] ^= 1
        path.write_bytes(content)
        assert not web_tools.is_three_at_hand() and web_tools.bundle_module(ELEMENT) is None


@pytest.mark.nightly
def test_a_bundler_with_another_digest_is_not_run(tmp_path: Path, sample: Project) -> None:
    ran = tmp_path / "ran"
    with kept_web_tools(tmp_path / "kept") as kept:
        for program in (kept / "node_modules" / "@esbuild").glob("*/bin/esbuild"):
            program.write_text(f"#!/bin/sh\ntouch {ran}\n")
        registry.write_for_target(sample, "web", tmp_path / "out")
    assert not ran.exists()
    page = (tmp_path / "out" / "index.html").read_text()
    assert "./three/build/" in page and web_tools.NET not in page  # as modules, with three.js beside it


@pytest.mark.skipif(os.name == "nt", reason="modes are POSIX's")
@pytest.mark.parametrize(
    "place", ["", "node_modules", "node_modules/three/build", "node_modules/three/LICENSE"]
)
def test_what_others_may_write_to_is_not_used(tmp_path: Path, without_npm: None, place: str) -> None:
    with kept_web_tools(tmp_path / "kept") as kept:
        path = kept / place
        path.chmod(stat.S_IMODE(path.stat().st_mode) | 0o002)
        assert not web_tools.is_three_at_hand()


@pytest.mark.skipif(os.name == "nt", reason="owners are POSIX's")
def test_what_belongs_to_somebody_else_is_not_used(
    tmp_path: Path, without_npm: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    with kept_web_tools(tmp_path / "kept") as kept:
        if os.geteuid() == 0:
            os.chown(kept / "node_modules", 65534, 65534)
        else:
            monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
        assert not web_tools.is_three_at_hand()


def test_an_npm_that_fails_is_as_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(web_tools, "find_web_tools_folder", lambda: tmp_path / "kept")
    monkeypatch.setattr(programs, "find_system_program", lambda name: "/bin/false")
    assert not web_tools.is_three_at_hand()
