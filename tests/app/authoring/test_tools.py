"""What the tools do to a project, one by one."""

from __future__ import annotations

import io
import shutil

import pytest
from PIL import Image

from app.authoring.desk import AuthorDesk
from app.authoring.project_file import AuthoredFile
from app.authoring.tool import AuthorError
from metagraph.formats.store import read_project
from preview.offscreen import Offscreen, OpenGLError


def test_clips_are_listed_with_measures_uses_and_places(call) -> None:
    told = call("list_clips", clips=["hands_at_sides__wave_hello_rt_01", "hands_at_sides__stance"])
    wave, rest = told["clips"]
    assert told["total"] == 2 and wave["seconds"] > 0.5 and "gesture" in wave["actions"][0]
    assert wave["measures"]["speeds"]["right_arm"] > 5 * wave["measures"]["speeds"]["left_arm"]
    assert wave["measures"]["side"] < -0.8 and wave["measures"]["reach"] > 0.2
    assert rest["measures"]["resting"] > wave["measures"]["resting"]
    assert call("list_clips", only="unlabelled")["total"] == 0
    page = call("list_clips", first=2, count=3, measures=False)
    assert len(page["clips"]) == 3 and "measures" not in page["clips"][0] and page["total"] > 10


@pytest.mark.gl
def test_pictures_come_with_clips_moments_and_strips(desk: AuthorDesk) -> None:
    listed = desk.call("list_clips", {"count": 2, "pictures": True}, lambda *_: None)
    assert [row.picture for row in listed.told.clips] == [0, 1]
    sizes = [Image.open(io.BytesIO(png)).size for png in listed.pictures]
    assert sizes == [(192, 192)] * 2
    one = desk.call(
        "look", {"clip": "hands_at_sides__wave_hello_rt_01", "at": 0.5, "width": 128}, lambda *_: None
    )
    strip = desk.call("look", {"seconds": 2, "pictures": 4, "width": 128}, lambda *_: None)
    (single,), (several,) = one.pictures, strip.pictures
    assert Image.open(io.BytesIO(several)).width > 3 * Image.open(io.BytesIO(single)).width
    assert [m.at for m in strip.told.moments] == pytest.approx([0, 2 / 3, 4 / 3, 2], abs=0.001)
    assert one.told.moments[0].playing == {"clip": "hands_at_sides__wave_hello_rt_01"}
    between = desk.call("look", {"action": "wave_hello_rt_01", "at": 1.2, "width": 96}, lambda *_: None)
    assert between.told.moments[0].playing["arms"] == "wave_hello_rt_01"


def test_without_opengl_the_error_says_so(call, monkeypatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise OpenGLError("there is no OpenGL 3.3 here")

    monkeypatch.setattr(Offscreen, "__init__", refuse)
    for tool, given in (("look", {}), ("list_clips", {"pictures": True})):
        with pytest.raises(AuthorError, match="no OpenGL"):
            call(tool, **given)
    assert call("list_clips")["total"] > 0


def test_the_graph_is_shown_and_narrowed(call) -> None:
    whole = call("show_graph")
    assert whole["total"] == len(whole["actions"]) and whole["unlabelled"] == 0
    gestures = call("show_graph", layer="arms", stance="hands at sides", kind="gesture")
    assert {a["kind"] for a in gestures["actions"]} == {"gesture"}
    assert [s["name"] for s in gestures["stances"]] == ["hands at sides"]
    assert call("show_graph", kind="gesture", first=1, count=1)["total"] > 1


def test_labels_are_proposed_accepted_and_set(few, tmp_path) -> None:
    shutil.copytree(few.parent / "clips", tmp_path / "clips")
    desk = AuthorDesk(AuthoredFile(tmp_path / "new.metagraph.yaml"))

    def call(tool, **given):
        return desk.call(tool, given, lambda *_: None).told

    call("import_clips", paths=["clips"])
    proposed = call("propose_labels")
    sure = [p.sure for p in proposed.proposals]
    assert sure == sorted(sure) and proposed.proposals[0].reasons["kind"] and proposed.new_stances
    told = call("accept_proposals", above=0.99)
    assert told.left and all("certain" in why or why for why in told.left.values())
    call("undo")
    told = call("accept_proposals", bridge=False)
    placed = len(told.actions)
    assert placed >= 10 and str(placed) in told.notes[0]
    with pytest.raises(AuthorError, match="no clip waits"):
        call("accept_proposals")
    wave = next(a for a in call("show_graph", count=500).actions if "wave" in a.clip)
    call("remove_actions", actions=[wave.id])
    label = {"clip": wave.clip, "kind": "gesture", "layer": "arms", "stance": wave.stance, "tags": ["hello"]}
    told = call("set_labels", labels=[label])
    (made,) = told.actions
    action = next(a for a in call("show_graph", count=500).actions if a.id == made)
    assert action.tags == ("hello",) and action.stance == wave.stance


def test_all_labels_are_set_or_none(call, project_path) -> None:
    wave = call("show_graph", kind="gesture", layer="arms", count=1)["actions"][0]
    rows = [
        {"clip": wave["clip"], "kind": "gesture", "layer": "arms", "stance": "new stance"},
        {"clip": wave["clip"], "kind": "transition", "layer": "arms", "stance": wave["stance"]},
    ]
    with pytest.raises(AuthorError, match=r"2 of 2|1 of 2"):
        call("set_labels", labels=rows)
    assert "new stance" not in {
        s.name for g in read_project(project_path).graphs.values() for s in g.stances.values()
    }
    told = call("set_labels", labels=[{**rows[0], "kind": "stance"}])  # its first clip makes a stance
    assert any("new stance" in line for line in told["changes"])


def test_actions_get_names_times_tags_stances_and_kinds(call) -> None:
    stances = [s["name"] for s in call("show_graph", layer="arms")["stances"]]
    first, other = stances[:2]
    wave = call("show_graph", layer="arms", stance=first, kind="gesture", count=1)["actions"][0]
    told = call(
        "edit_action", actions=[wave["id"]], name="hi", tags=["a", "a", " b "], start=0.1, stroke=None
    )
    assert told["changes"]
    call("edit_action", actions=["hi"], stance=other, kind="fidget")
    (now,) = call("show_graph", layer="arms", stance=other, kind="fidget", count=500)["actions"][-1:]
    assert (now["name"], now["tags"], now["start"]) == ("hi", ("a", "b"), 0.1)
    with pytest.raises(AuthorError, match=r"a transition must end|first choose"):
        call("edit_action", actions=["hi"], kind="transition")
    call("edit_action", actions=["hi"], kind="transition", end_stance=first)


def test_an_edit_that_would_make_an_error_is_refused(call) -> None:
    (wave,) = call("show_graph", kind="gesture", count=1)["actions"]
    with pytest.raises(AuthorError):
        call("edit_action", actions=[wave["id"]], start=1.0, end=0.5)
    with pytest.raises(AuthorError):
        call("edit_action", actions=[wave["id"]], end=wave["clip_seconds"] + 5)


def test_stances_are_renamed_begun_in_merged_and_removed(call) -> None:
    first, other = (s["name"] for s in call("show_graph", layer="arms")["stances"][:2])
    with pytest.raises(AuthorError, match="merge_into"):
        call("edit_stance", stance=first, layer="arms", name=other)
    call("edit_stance", stance=other, layer="arms", name="elsewhere", start=True)
    shown = {s["name"]: s for s in call("show_graph", layer="arms")["stances"]}
    assert shown["elsewhere"]["start"] and other not in shown
    call("edit_stance", stance="elsewhere", merge_into=first)
    assert "elsewhere" not in {s["name"] for s in call("show_graph", layer="arms")["stances"]}
    call("edit_stance", stance=first, layer="arms", remove=True)
    assert first not in {s["name"] for s in call("show_graph", layer="arms")["stances"]}
    assert call("list_clips", only="unlabelled")["total"] > 0


def test_a_clip_gets_a_name_and_so_do_its_actions_that_had_the_old_one(call) -> None:
    old = "hands_at_sides__wave_hello_rt_01"
    call("rename_clip", clip=old, name="greets")
    (action,) = [a for a in call("show_graph", count=500)["actions"] if a["clip"] == "greets"]
    assert action["name"] == "wave_hello_rt_01"
    call("edit_action", actions=[action["id"]], name="greets")
    call("rename_clip", clip="greets", name="waves")
    (action,) = [a for a in call("show_graph", count=500)["actions"] if a["clip"] == "waves"]
    assert action["name"] == "waves"


def test_problems_are_found_mended_and_named_the_same_until_they_are_gone(call) -> None:
    (wave,) = call("show_graph", kind="gesture", layer="arms", count=1)["actions"]
    rest = next(a for a in call("show_graph", kind="stance", layer="arms")["actions"])
    call("edit_action", actions=[wave["id"]], start=wave["clip_seconds"] / 2)  # it begins far from its stance
    found = call("find_problems")
    problem = next(p for p in found["problems"] if p["action"] == wave["id"] and p.get("fix"))
    assert found["counts"]["warning"] >= 1 and found["exportable"]
    call("edit_action", actions=[rest["id"]], likelihood=2.0)
    assert problem["id"] in {p["id"] for p in call("find_problems")["problems"]}
    told = call("fix_problem", problems=[problem["id"]])
    assert told["notes"] and told["step"]
    assert problem["id"] not in {p["id"] for p in call("find_problems")["problems"]}
    with pytest.raises(AuthorError, match="no problem"):
        call("fix_problem", problems=[problem["id"]])


def test_all_that_can_be_mended_is_and_then_nothing_is_left_to_mend(call) -> None:
    gestures = call("show_graph", kind="gesture", layer="arms", count=3)["actions"]
    for one in gestures:
        call("edit_action", actions=[one["id"]], start=one["clip_seconds"] / 3, blend_in=0.05)
    before = call("find_problems")["total"]
    call("fix_problem")
    assert call("find_problems")["total"] < before
    assert len(call("show_graph", kind="gesture", layer="arms", count=500)["actions"]) >= len(gestures)


def test_a_performance_is_planned_and_rates_are_counted(call) -> None:
    told = call("plan_performance", seconds=30)
    assert [c["start"] for c in told["cues"]] == sorted(c["start"] for c in told["cues"])
    assert call("plan_performance", seconds=30) == told
    assert call("plan_performance", seconds=30, seed=told["seed"] + 1) != told
    rates = {row["name"]: row for row in call("count_rates", seconds=300)["rates"]}
    assert rates["Gestures of the arms"]["unit"] == "a minute" and any(
        r.get("source") for r in rates.values()
    )


def test_an_export_is_written_and_verified(call, project_path) -> None:
    told = call("export", folder="game")
    assert set(told["files"]) >= {"sample.json", "sample.glb"} and told["next"]
    assert any("as they were written" in line for line in told["verified"])
    assert (project_path.parent / "game" / "sample.glb").is_file()
    told = call("export", folder="chart", target="xstate")
    assert told["losses"] and "verified" not in told


def test_a_project_with_errors_is_not_exported_and_nothing_is_written(call, project_path) -> None:
    (project_path.parent / "clips" / "hands_at_sides__wave_hello_rt_01.glb").unlink()
    project_path.write_bytes(project_path.read_bytes() + b"\n")  # it is read again
    with pytest.raises(AuthorError):
        call("export", folder="game")
    assert not (project_path.parent / "game").exists()


def test_another_persons_copy_is_merged(call, project_path) -> None:
    base = shutil.copy(project_path, project_path.with_name("base.metagraph.yaml"))
    theirs = project_path.with_name("theirs.metagraph.yaml")
    shutil.copy(project_path, theirs)
    other = AuthorDesk(AuthoredFile(theirs))
    edit = {"actions": ["wave_hello_rt_01"], "likelihood": 2.0}
    other.call("edit_action", edit, lambda *_: None)
    call("edit_action", actions=["wave_hello_rt_01"], cooldown=3.0)
    call("merge", base=str(base), theirs="theirs.metagraph.yaml")
    action = next(a for a in read_project(project_path).actions() if a.name == "wave_hello_rt_01")
    assert (action.likelihood, action.cooldown) == (2.0, 3.0)
    other.call("edit_action", {**edit, "cooldown": 9.0}, lambda *_: None)
    told = call("merge", base=str(base), theirs="theirs.metagraph.yaml", prefer="theirs")
    assert any(note.startswith("conflict") for note in told["notes"])
    action = next(a for a in read_project(project_path).actions() if a.name == "wave_hello_rt_01")
    assert action.cooldown == 9.0
