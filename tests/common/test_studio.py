"""A studio's defaults are read from one file; what is wrong is reported with its line, and stops nothing."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from metagraph.common import studio
from metagraph.common.studio import (
    Studio,
    find_export_folder,
    find_start_folder,
    find_studio_file,
    read_studio,
)

WHOLE = """language: de
theme: light
author: "{user}, Kranich"
folders:
  projects: PROJECTS
colours:
  red: Retake
shortcuts:
  export: Ctrl+Alt+E
hide:
  features: [study]
  commands: [practice]
"""


@pytest.fixture
def write(tmp_path):
    def write(text: str | bytes) -> Studio:
        path = tmp_path / "studio.yaml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_studio(path)

    return write


@pytest.fixture(autouse=True)
def fresh():
    yield
    studio.use_studio(Studio())


def test_all_of_it_is_read(write, tmp_path):
    found = write(WHOLE.replace("PROJECTS", str(tmp_path)))
    assert found.problems == ()
    assert (found.language, found.theme) == ("de", "light")
    assert found.colours == {"red": "Retake"} and found.shortcuts == {"export": "Ctrl+Alt+E"}
    assert found.hidden_features == ("study",) and found.hidden_commands == ("practice",)
    studio.use_studio(found)
    assert find_start_folder(None) == tmp_path and find_start_folder(Path("/x")) == Path("/x")
    assert studio.name_author("anna") == "anna, Kranich"


def test_without_a_file_nothing_changes(write, tmp_path):
    assert read_studio(None) == Studio() and write("").problems == () and write("# nothing\n").problems == ()
    assert find_start_folder(None) == Path.home() and find_export_folder(Path("/x")) == Path("/x")
    assert studio.name_author("anna") == "anna"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "language: de\ncolors:\n  red: x\n",
            "studio.yaml, line 2: 'colors' is unknown. Known are language, ",
        ),
        ("theme: pink\n", "studio.yaml, line 1: there is no theme 'pink'. Known are dark, light."),
        ("language: 5\n", "line 1: 'language' is not text. Write it in quotes."),
        ("\ncolours:\n  red: A\n  pink: B\n", "line 4: 'pink' is unknown. Known are red, "),
        ("colours: red\n", "line 1: 'colours' has no names with values. Indent them below it."),
        ("folders:\n  exports: out\n", "line 2: 'out' is not a full path. Begin it with"),
        ("hide: [study]\n", "line 1: 'hide' has no lists. Write hide:"),
        ("hide:\n  menus: [x]\n", "line 2: 'menus' is unknown. Known are features, commands."),
        ("a: [1\n", "studio.yaml, line 2: it is not YAML"),
        ("- de\n", "studio.yaml: it has no names with values"),
        (b"\xff\xfe", "studio.yaml: it is not UTF-8. Save it as UTF-8."),
        ("x" * 300_000, "studio.yaml: it is too large"),
        ("language: &a [*a]\n", "studio.yaml"),
    ],
)
def test_what_is_wrong_is_told_with_line_cause_and_remedy(write, text, told):
    found = write(text)
    assert len(found.problems) == 1 and told in found.problems[0]


def test_the_rest_of_a_file_with_a_fault_holds(write):
    found = write("language: de\ntheme: pink\ncolours:\n  red: Retake\n  pink: B\n")
    assert found.language == "de" and found.theme == "" and found.colours == {"red": "Retake"}
    assert len(found.problems) == 2


def test_a_file_that_is_not_there_is_told(tmp_path):
    (problem,) = read_studio(tmp_path / "gone.yaml").problems
    assert "gone.yaml: it cannot be read" in problem and "METAGRAPH_STUDIO" in problem


@pytest.mark.skipif(os.name == "nt", reason="pipes of Unix")
def test_a_drive_that_hangs_does_not_stop_the_start(tmp_path, monkeypatch):
    monkeypatch.setattr(studio, "PATIENCE", 0.1)
    os.mkfifo(tmp_path / "hangs.yaml")
    begun = time.monotonic()
    (problem,) = read_studio(tmp_path / "hangs.yaml").problems
    assert "did not answer within 0.1 s" in problem and time.monotonic() - begun < 2
    with (tmp_path / "hangs.yaml").open("wb"):
        pass  # let the thread go


def test_the_variable_counts_more_than_the_build(tmp_path, monkeypatch):
    monkeypatch.delenv("METAGRAPH_STUDIO", raising=False)
    monkeypatch.setattr(studio, "ROOT", tmp_path)
    assert find_studio_file() is None
    (tmp_path / studio.ADDRESS).write_text("/built.yaml\n")
    assert find_studio_file() == Path("/built.yaml")
    assert find_studio_file("/chosen.yaml") == Path("/chosen.yaml")
    monkeypatch.setenv("METAGRAPH_STUDIO", "/named.yaml")
    assert find_studio_file("/chosen.yaml") == Path("/named.yaml")
