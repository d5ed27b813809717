"""An action knows which clip it was made of: another clip under the same id is noticed, a new take is not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from metagraph.formats.clip_identity import DIGITS, remove_clip_identity, with_clip_identity
from metagraph.formats.project.data import from_data, to_data
from metagraph.formats.store import encode_project, parse_project
from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.model import Action, ClipEntry, Project
from tests.projects import clip

pytestmark = pytest.mark.usefixtures("numbered_ids")
HERE = Path("x.metagraph.yaml")
WAVE, POINT = "ab" * 32, "cd" * 32


def project(digest: str = WAVE) -> Project:
    made = edits.add_clips(Project(), [("rest.glb", 0, "ef" * 32, clip("rest"))])
    made = edits.add_stance(made, "arms", "rest", ["c1"])
    made = edits.add_clips(made, [("wave.glb", 0, digest, clip("wave"))])
    return edits.place_clips(made, ["c4"], "arms", "gesture", "s2")


def opened(text: str) -> Project:
    return parse_project(text, HERE)


def written(one: Project) -> str:
    return encode_project(one, HERE).decode()


def swaps(one: Project) -> list[str]:
    return [str(p.message) for p in check_project(one) if p.code == "swapped-clip"]


def test_an_empty_project_has_nothing_to_say() -> None:
    data = to_data(Project())
    assert with_clip_identity(data) == data


def test_a_project_comes_back_as_it_was_and_the_data_given_stays() -> None:
    one = project()
    data = to_data(one)
    named = with_clip_identity(data)
    assert data == to_data(one) and from_data(named) == one == opened(written(one))
    (rest, wave) = named["layers"]["arms"]["actions"]
    assert rest["clip_sha256"] == "ef" * (DIGITS // 2) and "clip_name" not in rest
    assert list(wave)[:3] == ["id", "clip", "clip_sha256"]


def test_the_name_is_written_where_the_action_has_another_or_the_content_is_not_known() -> None:
    renamed = edits.update_actions(project(), ["a5"], name="hello")
    assert "clip_name: wave, clip_sha256" in written(renamed)
    assert "clip: c4, clip_name: wave, kind" in written(project(""))
    assert opened(written(renamed)) == renamed and opened(written(project(""))) == project("")


@pytest.mark.parametrize(
    "changed",
    [
        {"name": "wave better"},
        {"name": "wave better", "path": "other.glb"},
        {"digest": POINT},
        {"digest": ""},
        {"path": "elsewhere/wave.glb", "frames": 7},
    ],
)
def test_a_renamed_moved_or_exchanged_file_is_the_same_clip(changed: dict[str, object]) -> None:
    (action,) = (
        a for a in with_clip_identity(to_data(project()))["layers"]["arms"]["actions"] if a["id"] == "a5"
    )
    entry = replace(project().clips["c4"], **changed)
    assert remove_clip_identity(action, {"c4": entry}) == to_data(project())["layers"]["arms"]["actions"][1]


@pytest.mark.parametrize("digest", [WAVE, ""])
def test_another_clip_under_the_id_is_an_error_until_a_person_decides(digest: str) -> None:
    before = project(digest)
    text = written(before).replace(
        "{id: c4, name: wave, path: wave.glb", "{id: c4, name: point, path: point.glb"
    )
    after = opened(text.replace(WAVE, POINT))
    (words,) = swaps(after)
    assert "'wave'" in words and "'point'" in words
    assert swaps(opened(written(after))) == swaps(after), "saving does not hide it"
    assert swaps(edits.update_actions(after, ["a5"], likelihood=2.0)) == swaps(after)
    assert swaps(edits.update_actions(after, ["a5"], clip="c4")) == []


def test_files_without_it_are_read_and_nothing_is_claimed() -> None:
    action = {"id": "a1", "clip": "c1", "name": "wave"}
    assert remove_clip_identity(action, {"c1": ClipEntry("c1", "other", "x.glb")}) is action
    assert Action("a", "c", "gesture", "arms", "s", "x").clip_name == ""


def test_a_clip_that_is_gone_is_reported_once_as_such() -> None:
    text = "\n".join(x for x in written(project()).splitlines() if "- {id: c4" not in x)
    codes = [p.code for p in check_project(opened(text)) if p.action == "a5"]
    assert codes == ["lost-clip"]


@pytest.mark.parametrize("value", ["3", "[]", "null", '""'])
def test_a_field_that_is_no_text_is_refused_or_means_nothing(value: str) -> None:
    from metagraph.errors import FileError

    text = written(project()).replace(f"clip_sha256: {WAVE[:DIGITS]}", f"clip_sha256: {value}")
    try:
        assert swaps(opened(text)) == []
    except FileError as error:
        assert "clip_sha256" in str(error)
