"""Calls on a project: one step each, or none; undone and done again; scripts; what cannot be done says why."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from app.authoring.desk import AuthorDesk, list_author_tools
from app.authoring.project_file import AuthoredFile
from app.authoring.tool import AuthorError, CallCancelledError
from app.project.step_store import find_steps
from metagraph.formats.locking import Lock, make_owner
from metagraph.formats.store import open_project, read_with_digest


def test_each_tool_says_what_it_does_takes_and_gives() -> None:
    tools = [tool.describe() for tool in list_author_tools().values()]
    assert len(tools) > 15 and len({tool["name"] for tool in tools}) == len(tools)
    for tool in tools:
        assert tool["description"].endswith(".")
        assert tool["inputSchema"]["type"] == tool["outputSchema"]["type"] == "object"
        assert tool["inputSchema"]["additionalProperties"] is False
    assert {t["name"] for t in tools if t["annotations"]["readOnlyHint"]} >= {"look", "list_clips"}


def test_an_edit_is_one_saved_step_with_its_name_that_the_window_finds(call, project_path) -> None:
    before = project_path.read_bytes()
    (action,) = call("show_graph", kind="gesture", count=1)["actions"]
    told = call("edit_action", actions=[action["id"]], blend_in=0.35)
    assert told["step"].endswith("(agent)") and "0.35" in told["step"]
    assert any("blend_in" in line or "0.35" in line for line in told["changes"])
    assert project_path.read_bytes() != before
    project, digest = read_with_digest(project_path)
    assert project.action(action["id"]).timing.blend_in == 0.35
    (step,) = find_steps(digest, open_project(project_path).project, project_path.parent)
    assert step.text == told["step"] and step.after.action(action["id"]).timing.blend_in == 0.35


def test_undo_and_redo_are_saved_and_a_new_edit_forgets_what_was_undone(call, project_path) -> None:
    before = read_with_digest(project_path)[0]
    (action,) = call("show_graph", kind="gesture", count=1)["actions"]
    call("edit_action", actions=[action["id"]], likelihood=3.0)
    call("edit_action", actions=[action["id"]], likelihood=4.0)
    told = call("undo")
    assert len(told["done"]) == len(told["undone"]) == 1
    assert read_with_digest(project_path)[0].action(action["id"]).likelihood == 3.0
    call("redo")
    assert read_with_digest(project_path)[0].action(action["id"]).likelihood == 4.0
    call("undo", steps=2)
    assert read_with_digest(project_path)[0].graphs == before.graphs
    call("edit_action", actions=[action["id"]], likelihood=5.0)
    assert call("history")["undone"] == []
    with pytest.raises(AuthorError, match="there is nothing to redo"):
        call("redo")
    with pytest.raises(AuthorError, match="there are 1 to undo, not 3"):
        call("undo", steps=3)


def test_another_sitting_goes_on_with_the_steps_of_the_one_before(call, project_path) -> None:
    (action,) = call("show_graph", kind="gesture", count=1)["actions"]
    call("edit_action", actions=[action["id"]], likelihood=3.0)
    later = AuthorDesk(AuthoredFile(project_path))
    history = later.call("history", {}, lambda *_: None).told
    assert len(history.done) == 1
    later.call("undo", {}, lambda *_: None)
    assert read_with_digest(project_path)[0].action(action["id"]).likelihood == action.get("likelihood", 1.0)


def test_what_changes_nothing_is_an_error_and_no_step(call, project_path) -> None:
    (action,) = call("show_graph", kind="gesture", count=1)["actions"]
    before = project_path.read_bytes()
    with pytest.raises(AuthorError, match="nothing changed"):
        call("edit_action", actions=[action["id"]], blend_in=action["blend_in"])
    assert project_path.read_bytes() == before and call("history") == {"done": [], "undone": []}


@pytest.mark.parametrize(
    ("tool", "given", "words"),
    [
        ("dance", {}, "there is no tool 'dance'"),
        ("edit_action", {"actions": ["wave"], "speed": 2}, "speed"),
        ("edit_action", {"actions": [], "name": "x"}, "actions"),
        ("edit_action", {"actions": ["wave_helo_rt_01"], "likelihood": 2}, "did you mean 'wave_hello_rt_01'"),
        ("edit_action", {"actions": ["wave_hello_rt_01"], "likelihood": -1}, "likelihood"),
        ("edit_action", {"actions": ["wave_hello_rt_01"], "start": 90.0}, "wave_hello_rt_01|outside|plays"),
        ("edit_action", {"actions": ["wave_hello_rt_01"], "end_stance": "sitting"}, "no stance|only transit"),
        ("set_labels", {"labels": [{"clip": "nobody", "kind": "gesture"}]}, "there is no clip 'nobody'"),
        ("edit_stance", {"stance": "flying", "start": True}, "there is no stance 'flying'"),
        ("fix_problem", {"problems": ["p-00000000"]}, "there is no problem"),
        ("export", {"folder": "../game"}, "outside of the folders"),
        ("export", {"folder": "."}, "folder of its own"),
        ("import_clips", {"paths": ["nowhere"]}, "no file or folder 'nowhere'"),
        ("merge", {"base": "a.metagraph.yaml", "theirs": "b.metagraph.yaml"}, "a.metagraph.yaml"),
        ("look", {"clip": "wave", "action": "wave"}, "not several"),
        ("look", {"at": 5.0, "clip": "hands_at_sides__stance", "seconds": 9999}, "seconds"),
        ("plan_performance", {"performance": "none"}, "there is no performance 'none'"),
    ],
)
def test_what_cannot_be_done_says_why_and_leaves_the_file_as_it_was(
    call, project_path, tool, given, words
) -> None:
    before = project_path.read_bytes()
    with pytest.raises(AuthorError, match=words):
        call(tool, **given)
    assert project_path.read_bytes() == before


def test_a_script_is_one_step_and_a_dry_run_of_it_keeps_nothing(call, project_path) -> None:
    before = project_path.read_bytes()
    first, second = call("show_graph", kind="gesture", count=2)["actions"]
    calls = [
        {"tool": "edit_action", "arguments": {"actions": [first["id"]], "name": "first"}},
        {"tool": "edit_action", "arguments": {"actions": ["first"], "likelihood": 2.5}},
        {"tool": "edit_action", "arguments": {"actions": [second["id"]], "tags": ["mine"]}},
        {"tool": "show_graph", "arguments": {"kind": "gesture", "count": 1}},
    ]
    dry = call("run_script", calls=calls, dry_run=True)
    assert dry["dry_run"] and "step" not in dry and len(dry["changes"]) >= 2
    assert dry["results"][3]["actions"][0]["name"] == "first"  # each sees what those before it did
    assert project_path.read_bytes() == before
    told = call("run_script", calls=calls, name="Tidy up")
    assert told["changes"] == dry["changes"] and "Tidy up" in told["step"]
    assert len(call("history")["done"]) == 1
    after = read_with_digest(project_path)[0]
    call("undo")
    undone = read_with_digest(project_path)[0]
    assert undone.graphs != after.graphs and undone.action(first["id"]).name == first["name"]


def test_a_script_that_fails_half_way_keeps_nothing_and_names_the_call(call, project_path) -> None:
    before = project_path.read_bytes()
    (first,) = call("show_graph", kind="gesture", count=1)["actions"]
    edit = {"tool": "edit_action", "arguments": {"actions": [first["id"]], "name": "first"}}
    for bad, words in (
        ({"tool": "edit_action", "arguments": {"actions": ["gone"], "likelihood": 2}}, "no action 'gone'"),
        ({"tool": "export", "arguments": {"folder": "game"}}, "cannot be taken back"),
        ({"tool": "run_script", "arguments": {"calls": [edit]}}, "cannot be taken back"),
        ({"tool": "none"}, "there is no tool"),
        (edit, "nothing changed"),
    ):
        with pytest.raises(AuthorError, match=f"call 2 .*{words}.*Nothing was changed"):
            call("run_script", calls=[edit, bad])
    assert project_path.read_bytes() == before


def test_a_cancelled_call_keeps_nothing(desk, project_path) -> None:
    before = project_path.read_bytes()

    def cancel(done: float, total: float, words: str) -> None:
        if words.startswith("call 2"):
            raise CallCancelledError

    edit = {"tool": "edit_action", "arguments": {"actions": ["wave_hello_rt_01"], "likelihood": 2}}
    with pytest.raises(CallCancelledError):
        desk.call("run_script", {"calls": [edit, {"tool": "show_graph"}]}, cancel)
    assert project_path.read_bytes() == before


def test_a_project_that_somebody_has_open_is_left_alone(call, project_path) -> None:
    lock = Lock(project_path, make_owner())
    assert lock.acquire() is None
    try:
        with pytest.raises(AuthorError, match=r"is open in a window or another command.*Let agents edit"):
            call("edit_action", actions=["wave_hello_rt_01"], likelihood=2.0)
    finally:
        lock.release()
    call("edit_action", actions=["wave_hello_rt_01"], likelihood=2.0)


def test_what_others_saved_in_between_is_read_and_kept(call, project_path) -> None:
    call("show_graph")
    other = AuthorDesk(AuthoredFile(project_path))
    other.call("edit_action", {"actions": ["wave_hello_rt_01"], "likelihood": 2.0}, lambda *_: None)
    call("edit_action", actions=["wave_hello_rt_01"], cooldown=3.0)
    action = next(a for a in read_with_digest(project_path)[0].actions() if a.name == "wave_hello_rt_01")
    assert (action.likelihood, action.cooldown) == (2.0, 3.0)
    assert len(call("history")["done"]) == 2


def test_a_person_can_forbid_edits_and_looks_are_still_taken(project_path) -> None:
    desk = AuthorDesk(AuthoredFile(project_path, look_only=True))
    before = project_path.read_bytes()
    desk.call("show_graph", {}, lambda *_: None)
    edit = {"tool": "edit_action", "arguments": {"actions": ["wave_hello_rt_01"], "likelihood": 2}}
    desk.call("run_script", {"calls": [edit], "dry_run": True}, lambda *_: None)
    for tool, given in ((edit["tool"], edit["arguments"]), ("run_script", {"calls": [edit]}), ("undo", {})):
        with pytest.raises(AuthorError, match="edits are forbidden"):
            desk.call(tool, given, lambda *_: None)
    assert project_path.read_bytes() == before


def test_a_new_project_is_made_by_its_first_edit(few, tmp_path) -> None:
    shutil.copytree(few.parent / "clips", tmp_path / "clips")
    path = tmp_path / "new.metagraph.yaml"
    desk = AuthorDesk(AuthoredFile(path))
    desk.call("show_graph", {}, lambda *_: None)
    assert not path.exists()
    desk.call("import_clips", {"paths": ["clips"]}, lambda *_: None)
    assert len(read_with_digest(path)[0].clips) == len(list((tmp_path / "clips").iterdir()))
    assert [p.name for p in tmp_path.glob("new.*")] == ["new.metagraph.yaml"]  # no lock is left behind


def test_the_version_from_before_the_sitting_is_kept_and_not_pushed_out(call, project_path) -> None:
    before = project_path.read_bytes()
    for likelihood in (2.0, 3.0, 4.0, 5.0, 6.0):
        call("edit_action", actions=["wave_hello_rt_01"], likelihood=likelihood)
    assert Path(f"{project_path}.1").read_bytes() == before and not Path(f"{project_path}.2").exists()
