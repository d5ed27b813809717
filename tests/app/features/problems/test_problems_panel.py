"""The problems panel: what the statistics flag is reported once, goes to its place, and is mended with a
press.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import partial

import msgspec
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.features.problems.problems_panel import FIX, make_breakable
from app.stage.compatibility_state import describe_jumps, judge_jumps, merge_problems
from app.stage.fixes import Fix, fix_unreachable
from app.stage.remedies import fix_clips
from metagraph.graph import edits
from metagraph.graph.check import check_project
from metagraph.graph.editing.retiming import keep_clips_in_place
from metagraph.graph.expand import find_reachable
from metagraph.graph.model import Project
from metagraph.graph.problem import Problem


def lines_cut(tree) -> list[str]:
    """The words of rows that are not painted whole, by the font and the room they have."""
    out = []
    for n in range(tree.topLevelItemCount()):
        item = tree.topLevelItem(n)
        for column in range(3):
            rect = tree.visualRect(tree.indexFromItem(item, column))
            wide = rect.width() - (26 if column == 0 else 0) - 8
            words = tree.fontMetrics().boundingRect(
                0, 0, wide, 10_000, Qt.TextFlag.TextWordWrap, make_breakable(item.text(column))
            )
            if words.height() > rect.height() or words.width() > wide:
                out.append(item.text(column))
    return out


@pytest.mark.window
@pytest.mark.parametrize("width", [560, 900, 1600])
def test_what_is_wrong_and_what_to_do_are_read_whole_at_any_width(toys, toy, width):
    panel = toys.problems_panel
    toys.show("problems")
    long = Problem(
        "warning",
        "far-start",
        "'on_hips__to__hands_at_sides' begins 22 cm from stance 'hands at sides'",
        remedy="Trim it, lengthen its blend, or move it to a stance that it fits.",
        layer="arms",
    )
    panel.show_problems((long, replace(long, severity="hint", message="short")))
    panel.tree.setFixedWidth(width)
    toys.pause(50)
    assert panel.tree.viewport().width() > 300 and lines_cut(panel.tree) == []
    panel.tree.setMinimumWidth(0)
    panel.tree.setMaximumWidth(16_777_215)


@pytest.fixture(scope="module")
def wide(toy):
    """A wave so wide that it is far from its stance in the middle, cut there."""
    project = edits.add_clips(toy.project(), [("wide.glb", 0, "", toy.clip("wide", 2.4, swing=2.4))])
    project = edits.place_clips(
        project, [toy.id(project, "wide")], "arms", "gesture", toy.id(project, "rest")
    )
    return edits.update_actions(project, [toy.id(project, "wide")], timing={"end": 1.5, "blend_out": 0.05})


def test_an_empty_project_has_no_flags():
    assert describe_jumps(Project(), judge_jumps(Project())) == {}


def test_a_jump_is_told_in_words_with_what_mends_it(toy, wide):
    flags = {p: fix for p, fix in describe_jumps(wide, judge_jumps(wide)).items() if p.severity == "warning"}
    ((problem, fix),) = flags.items()
    assert problem.message.startswith("'wide' ends ") and "jump to 'rest'" in problem.message
    assert problem.remedy.startswith("At ") and problem.remedy.endswith(" s it would not jump.")
    assert (
        fix is not None and fix.words.startswith("Use ") and fix.words.removeprefix("Use ") in problem.remedy
    )
    after = fix(wide)
    assert not [p for p in describe_jumps(after, judge_jumps(after)) if p.severity == "warning"]


def test_statistics_never_make_an_error_and_too_few_clips_are_a_hint(toy, wide):
    assert {p.severity for p in describe_jumps(wide, judge_jumps(wide))} <= {"warning", "hint"}
    few = edits.remove_actions(wide, [a.id for a in wide.actions()][4:])
    gesture = edits.place_clips(few, [toy.id(few, "wide")], "arms", "gesture", toy.id(few, "rest"))
    (hint,) = describe_jumps(
        edits.remove_actions(gesture, [a.id for a in few.actions()][1:]), judge_jumps(few)
    )
    assert (hint.severity, hint.code, hint.layer) == (
        "hint",
        "few-clips",
        "arms",
    ) and "too few" in hint.message


def test_the_sample_and_its_neighbours_have_no_false_alarms(sample):
    assert describe_jumps(sample, judge_jumps(sample)) == {}


def test_a_judgement_keeps_what_still_holds(toy, wide):
    first = judge_jumps(wide)
    after = edits.update_actions(wide, [toy.id(wide, "rest wave rt")], timing={"end": 1.0})
    again = judge_jumps(after, first)
    assert again.measured["arms"] is first.measured["arms"]
    assert {a.id for a in again.known["arms"]} == {a.id for a in after.graphs["arms"].actions.values()}
    gone = judge_jumps(edits.remove_actions(wide, [toy.id(wide, "wide")]), first)
    assert gone.measured["arms"] is not first.measured["arms"] and not gone.jumps
    assert describe_jumps(edits.remove_actions(wide, [toy.id(wide, "wide")]), first) == {}, (
        "an action that went is not told of"
    )


def test_a_place_is_told_of_once_and_errors_come_first():
    def at(severity, code, action="a1"):
        return Problem(severity, code, "", "", action=action)

    flag = at("warning", "jump-end")
    rest = [
        at("warning", "far-end"),
        at("warning", "far-start"),
        at("warning", "far-end", "a2"),
        at("hint", "no-gestures", None),
    ]
    assert merge_problems([*rest, at("error", "trim")], [flag]) == (
        at("error", "trim"),
        *rest[1:3],
        flag,
        rest[3],
    )


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_flag_marks_the_action_and_a_press_mends_it_in_one_step(toys, toy, wide):
    drive = toys
    drive.document.load(wide, None)
    drive.files.opened.emit()
    wave = toy.id(wide, "wide")
    flagged = lambda: [p for p in drive.problems.problems if p.code == "jump-end"]  # noqa: E731
    drive.wait(lambda: bool(flagged()))
    assert wave in drive.canvas.misfits and "visible jump" in drive.canvas.misfits[wave]
    drive.show("problems")
    drive.wait(drive.problems_panel.tree.isVisible)
    panel = drive.problems_panel
    tree = panel.tree
    item = next(
        tree.topLevelItem(n)
        for n in range(tree.topLevelItemCount())
        if tree.topLevelItem(n).text(0).startswith("'wide' ends")
    )
    assert item.text(FIX).startswith("Use ")
    tree.scrollToItem(item)
    # A press beside the button goes there and mends nothing.
    row = tree.visualItemRect(item)
    QTest.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=row.center())
    assert drive.session.selection.actions == (wave,)
    assert drive.document.project is wide
    before = drive.document.undo_stack.count()
    tree.scrollTo(tree.indexFromItem(item, FIX))
    cell = tree.visualRect(tree.indexFromItem(item, FIX))
    QTest.mouseMove(tree.viewport(), cell.topLeft() + tree.viewport().rect().topLeft())
    spot = cell.topLeft()
    spot.setX(spot.x() + 20)
    spot.setY(cell.center().y())
    QTest.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    assert drive.document.undo_stack.count() == before + 1
    assert drive.document.project.action(wave).timing.end != 1.5
    drive.wait(lambda: not flagged())
    assert wave not in drive.canvas.misfits
    drive.document.undo()
    drive.wait(lambda: bool(flagged()))


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_all_timings_are_mended_in_one_step(toys, toy, wide):
    drive = toys
    two = edits.update_actions(wide, [toy.id(wide, "wide")], timing={"start": 1.0, "blend_in": 0.05})
    drive.document.load(two, None)
    drive.files.opened.emit()
    panel = drive.problems_panel
    drive.wait(lambda: len(panel.fixable()) == 2)
    drive.show("problems")
    drive.pause(100)
    assert panel.all.text() == "Fix 2 problems"
    drive.click((panel.all, panel.all.rect().center()))
    assert drive.document.undo_stack.count() == 1
    jumps = lambda: [p for p in panel.problems if p.code.startswith("jump-")]  # noqa: E731
    drive.wait(lambda: not jumps())
    item = panel.tree.topLevelItem(0)
    if item is not None:
        assert "Go to the place" in [a.text() for a in panel.menu(item).actions()]


@pytest.fixture(scope="module")
def parted(toy):
    """The toy project without its transitions: only rest is ever seen."""
    project = toy.project()
    return edits.remove_actions(project, [a.id for a in project.actions() if a.kind == "transition"])


def test_a_stance_nothing_leads_to_is_mended_by_blending_and_one_without_a_loop_is_not(toy, parted):
    fixes = fix_unreachable(parted, check_project(parted))
    assert Counter(p.code for p in fixes) == {"dead-end": 3, "unreachable": 2}
    for problem, fix in fixes.items():
        assert fix.words == "Bridge by blending" and "blended in" in fix.tip
        assert not [
            p for p in check_project(fix(parted)) if (p.code, p.stance) == (problem.code, problem.stance)
        ]
    up = toy.id(parted, "up")
    bare = edits.remove_actions(parted, [a.id for a in parted.graphs["arms"].of(up, "stance")])
    assert up not in {p.stance for p in fix_unreachable(bare, check_project(bare))}
    assert fix_unreachable(Project(), check_project(Project())) == {}


def test_what_went_meanwhile_is_mended_no_more(toy, parted):
    up = toy.id(parted, "up")
    (fix, *_) = [f for p, f in fix_unreachable(parted, check_project(parted)).items() if p.stance == up]
    gone = edits.remove_stance(parted, up)
    assert fix(gone) is gone
    assert Fix("Use 1.00 s", "a99", {"timing": {"end": 1.0}})(parted) is parted


@pytest.mark.nightly
@pytest.mark.window
@pytest.mark.gl
def test_a_stance_that_cannot_be_reached_is_bridged_with_a_press_in_one_step(toys, toy, parted):
    drive = toys
    drive.document.load(parted, None)
    drive.files.opened.emit()
    panel = drive.problems_panel
    drive.wait(lambda: len(panel.fixable()) == 5)
    drive.show("problems")
    drive.wait(panel.tree.isVisible)
    tree = panel.tree
    up = toy.id(parted, "up")

    def row(code):
        rows = (tree.topLevelItem(n) for n in range(tree.topLevelItemCount()))
        return next(i for i in rows if i.text(0) == f"stance 'up' cannot be {code}")

    item = row("reached")
    assert item.text(FIX) == "Bridge by blending" and "blended in" in item.toolTip(FIX)
    tree.scrollTo(tree.indexFromItem(item, FIX))
    cell = tree.visualRect(tree.indexFromItem(item, FIX))
    spot = cell.topLeft()
    spot.setX(spot.x() + 20)
    spot.setY(cell.center().y())
    QTest.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    stack, graph = drive.document.undo_stack, drive.document.project.graphs["arms"]
    assert stack.count() == 1 and stack.text(0) == "Bridge by blending"
    assert up in find_reachable(graph, graph.start) and graph.start in find_reachable(graph, up)
    drive.wait(lambda: len(panel.fixable()) == 2)
    assert {p.stance for p in drive.problems.problems if p.code in ("unreachable", "dead-end")} == {
        toy.id(parted, "far")
    }
    assert not drive.canvas.misfits  # a long slow blend is nothing to warn of
    drive.document.undo()
    drive.wait(lambda: len(panel.fixable()) == 5)
    assert panel.all.text() == "Fix 5 problems"
    drive.click((panel.all, panel.all.rect().center()))
    assert stack.count() == 1 and stack.text(0) == "Fix 5 problems"
    drive.wait(lambda: not panel.fixable())
    graph = drive.document.project.graphs["arms"]
    assert find_reachable(graph, graph.start) == set(graph.stances)
    drive.document.undo()
    assert drive.document.project.graphs == parted.graphs


@pytest.mark.parametrize("there", [True, False])
def test_a_swapped_clip_is_given_back_or_kept(toy, there):
    project = toy.project()
    point, short = toy.id(project, "up point"), toy.id(project, "rest short")
    action = replace(project.action(short), clip=project.action(point).clip, clip_name="rest short")
    wrong = project.with_graph(project.graphs["arms"].with_actions({short: action}))
    if not there:
        wrong = edits.rename_clip(wrong, project.action(short).clip, "another")
    (problem, fix), *_ = fix_clips(wrong, check_project(wrong)).items()
    assert problem.code == "swapped-clip"
    assert fix.words == ("Play 'rest short'" if there else "Keep 'up point'")
    mended = fix(wrong)
    swapped = lambda p: [x for x in check_project(p) if x.code == "swapped-clip"]  # noqa: E731
    assert not swapped(mended)
    assert mended.action(short).clip == (project.action(short).clip if there else action.clip)
    if there:
        kept = fix.instead(wrong)
        assert not swapped(kept) and kept.action(short).clip == action.clip


@pytest.mark.nightly
@pytest.mark.window
def test_play_and_check_lists_what_is_seen_and_a_click_opens_that_moment(toys, toy, monkeypatch):
    from app.stage import problem_watch
    from tests.playback.test_rehearsal import changed, lifted

    drive = toys
    monkeypatch.setattr(problem_watch, "rehearse", partial(problem_watch.rehearse, seconds=20.0))
    drive.document.load(changed(toy.project("body"), lifted(0.6)), None)
    drive.files.opened.emit()
    drive.show("problems")
    panel = drive.problems_panel
    drive.wait(panel.play.isVisible)
    QTest.mouseClick(panel.play, Qt.MouseButton.LeftButton)
    assert not panel.play.isEnabled() and panel.play.text() == "Playing…"
    shown = set()
    drive.problems.progressed.connect(lambda percent: shown.add((percent, panel.play.text())))
    drive.wait(panel.play.isEnabled, 60)
    assert shown and all(text == f"Playing… {percent} %" for percent, text in shown)
    assert panel.play.text() == "Play and check"
    (seen,) = [p for p in panel.problems if p.code == "play-in-air"]
    assert seen.severity == "error" and seen.moment is not None
    assert panel.problems[0].code.startswith("play-"), "what was seen is on top"
    transport = drive.session.transport
    transport.show_clip(next(iter(drive.document.project.clips)))
    item = panel.tree.topLevelItem([p.code for p in panel.problems].index("play-in-air"))
    panel.tree.scrollToItem(item)
    spot = panel.tree.visualItemRect(item).center()
    QTest.mouseClick(panel.tree.viewport(), Qt.MouseButton.LeftButton, pos=spot)
    assert transport.show == "plan" and not transport.playing
    assert transport.seconds == pytest.approx(max(0.0, seen.moment - 1.0))
    clip = drive.document.project.action(seen.action).clip
    for edit in (
        lambda p: edits.update_actions(p, [seen.action], name="another"),
        lambda p: keep_clips_in_place(p, [clip]),
    ):
        drive.document.edit("change what it is about", edit)
        drive.wait(lambda: "play-in-air" not in {p.code for p in panel.problems})
        drive.document.undo()
        drive.wait(lambda: "play-in-air" in {p.code for p in panel.problems})


@pytest.mark.window
def test_an_arm_inside_the_body_is_over_once_hands_are_kept_out(toys, toy, monkeypatch):
    from app.stage import problem_watch

    action = toy.id(toys.document.project, "rest wave rt")
    inside = Problem("warning", "play-arm-inside", "an arm is inside", "keep it out", "arms", action=action)
    monkeypatch.setattr(problem_watch, "rehearse", lambda *given, **more: [inside])
    toys.problems.play()
    toys.wait(lambda: inside in toys.problems.problems)
    was = toys.document.project.touch
    touch = msgspec.structs.replace(was, guard=not was.guard)
    toys.document.edit("Keep hands out", lambda p: replace(p, touch=touch))
    toys.wait(lambda: inside not in toys.problems.problems)
    monkeypatch.setattr(problem_watch, "rehearse", lambda *given, **more: [])
    toys.problems.play()
    toys.wait(lambda: not toys.problems.is_playing)
