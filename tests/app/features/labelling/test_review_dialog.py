"""Going through proposals in the real window: a clip plays out of its stance and back, a key corrects, Enter
accepts, all can be undone.
"""

from __future__ import annotations

import subprocess
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QInputDialog

from app.features.character.character_panel import PreviewPanel
from metagraph.formats.store import open_project
from metagraph.research.study.machines.klm import predict_seconds
from metagraph.suggest.jumps.bridges import find_missing_bridges
from metagraph.suggest.review import DECIDING
from tests.label_zoo.catalogue import named

pytestmark = [pytest.mark.window, pytest.mark.gl]
K = Qt.Key


PROPOSED = {}  # project, patterns -> what is proposed first, which takes seconds and is never changed


@pytest.fixture
def practice(drive, monkeypatch):
    """The practice project, its clips loaded, none placed. What is proposed for it at first is found once."""
    from app.features.labelling import review_session
    from app.project.files import PRACTICE

    propose = review_session.propose

    def once(project, clips, patterns, examples, **more):
        key = (project.name, tuple(project.clips), len(list(project.actions())), repr(patterns))
        if clips is not None or examples:
            return propose(project, clips, patterns, examples, **more)
        if key not in PROPOSED:
            PROPOSED[key] = propose(project, clips, patterns, examples, **more)
        return PROPOSED[key]

    monkeypatch.setattr(review_session, "propose", once)

    drive.files.open(PRACTICE, template=True)
    drive.wait(
        lambda: len(drive.document.project.clips) == 152 and drive.performance.skeleton() is not None, 60
    )
    return drive


@pytest.fixture
def truth(practice):
    """Clip -> what it is in the finished project, field by field; stances by name."""
    from app.project.files import SAMPLE

    sample = open_project(SAMPLE).project
    by_path = {Path(sample.clips[a.clip].path).name: a for a in sample.actions()}
    out = {}
    for clip, entry in practice.document.project.clips.items():
        action = by_path[Path(entry.path).name]
        out[clip] = {
            "kind": action.kind,
            "layer": action.layer,
            "stance": sample.stance(action.stance).name,
            "end_stance": sample.stance(action.end_stance).name if action.end_stance else None,
            "limb": action.limb,
        }
    return out


def begun(drive):
    """The review, once proposals are there."""
    from app.features.labelling.review_dialog import ReviewDialog

    drive.actions["propose"].trigger()
    dialog = drive.window.findChildren(ReviewDialog)[-1]
    drive.wait(lambda: dialog.current is not None, 60)
    given_the_keyboard(drive, dialog)
    return dialog


def given_the_keyboard(drive, dialog) -> None:
    """What a window manager does when a window opens; without one a click does it."""
    corner = dialog.legend.mapToGlobal(QPoint(2, 2))
    subprocess.run(
        ["xdotool", "mousemove", str(corner.x()), str(corner.y()), "click", "1"], check=True, timeout=10
    )
    drive.wait(dialog.isActiveWindow)


def press(dialog, *keys) -> None:
    for key in keys:
        QTest.keyClick(dialog, key)


def playing(drive, dialog) -> None:
    drive.wait(lambda: dialog.stage.shown is not None)


def to_gesture(drive, dialog, name: str = "hands_at_sides__point_you_rt_01") -> str:
    """Look at one gesture."""
    clip = next(c for c, e in drive.document.project.clips.items() if e.name == name)
    dialog.go_to(clip)
    drive.wait(lambda: dialog.stage.shown is not None and clip in dialog.stage.shown.project.uses)
    return clip


@pytest.mark.nightly
def test_the_practice_project_is_labelled_with_the_keyboard_alone(practice, truth, record_property):
    """Stances and whatever is not sure are looked at one by one and corrected where they are wrong; the sure
    ones are accepted at once.
    """
    drive, hands = practice, Counter()
    drive.key(K.Key_P, Qt.KeyboardModifier.ControlModifier)
    hands.update(["M", "K", "K"])
    from app.features.labelling.review_dialog import ReviewDialog

    drive.wait(lambda: bool(drive.window.findChildren(ReviewDialog)))
    dialog = drive.window.findChildren(ReviewDialog)[-1]
    drive.wait(lambda: dialog.current is not None, 60)
    given_the_keyboard(drive, dialog)
    looked = corrected = 0
    while dialog.current is not None:
        clip = dialog.current
        p = dialog.review.found.proposals[clip]
        if p.kind.value != "stance" and p.confidence >= dialog.queue.least and not p.conflicts:
            press(dialog, K.Key_A)
            hands.update(["M", "K"])
            continue
        playing(drive, dialog)
        looked += 1
        hands["R"] += dialog.stage.shown.length  # it is watched once, whole
        for name in DECIDING:
            choices = [v for v, _ in dialog.review.choices(clip, name)]
            wanted = truth[clip][name]
            if choices and dialog.review.value(clip, name) != wanted:
                rows = [row.name for row in dialog.fields.rows]
                steps = (rows.index(name) - rows.index(dialog.row)) % len(rows)
                press(dialog, *[K.Key_Down] * steps, Qt.Key(K.Key_1 + choices.index(wanted)))
                assert dialog.review.value(clip, name) == wanted
                hands.update(("M K" + " K" * steps).split())
                corrected += 1
        press(dialog, K.Key_Return)
        hands.update(["M", "K"])
        drive.pause(1)
    assert not dialog.work.waiting()
    press(dialog, K.Key_Return)  # done
    drive.wait(lambda: not dialog.isVisible())
    assert hands["P"] == hands["B"] == hands["H"] == 0
    project = drive.document.project
    for clip, wanted in truth.items():
        (action,) = project.uses[clip]
        assert action.kind == wanted["kind"] and action.layer == wanted["layer"]
        assert project.stance(action.stance).name == wanted["stance"]
        assert (project.stance(action.end_stance).name if action.end_stance else None) == wanted["end_stance"]
    drive.settle()
    assert not [p for p in drive.problems.problems if p.severity == "error"]
    seconds = predict_seconds(hands)
    record_property("operators", dict(hands))
    record_property("seconds_a_clip", seconds / len(truth))
    every = predict_seconds({"M": 152, "K": 152, "R": watched(project)})
    print(
        f"\n{looked} looked at, {corrected} corrected; {dict(hands)}; predicted {seconds:.0f} s, "
        f"{seconds / len(truth):.2f} s a clip;"
    )
    print(
        f"each of 152 watched whole and accepted by a key: {every:.0f} s, {every / len(truth):.2f} s a clip"
    )
    assert seconds < 600


def watched(project) -> float:
    """Seconds it takes to watch every action once, out of its stance and back."""
    from app.stage.playback_source import LEAD

    return sum(
        (e - s) + (0 if a.kind == "stance" else 2 * LEAD)
        for a in project.actions()
        for s, e in [project.span(a)]
    )


@pytest.mark.nightly
def test_clips_stand_in_the_order_of_the_review_stances_first(practice):
    dialog = begun(practice)
    assert list(dialog.queue.clips) == dialog.review.order() and len(dialog.queue.clips) == 152
    rests = [dialog.review.found.proposals[c].kind.value == "stance" for c in dialog.queue.clips]
    assert rests == sorted(rests, reverse=True)
    assert "0 of 152 placed" in dialog.queue.words.text() and "min left" in dialog.queue.words.text()
    dialog.close()


@pytest.mark.nightly
def test_a_clip_plays_out_of_its_stance_and_back_and_alone_when_wanted(practice):
    drive, dialog = practice, begun(practice)
    clip = to_gesture(drive, dialog)
    span, length = dialog.stage.strip.span, dialog.stage.shown.length
    assert span.words[0] == span.words[2] == "hands at sides" and 0 < span.start < span.end < length
    assert "Gesture" in dialog.stage.words.text() and "hands at sides" in dialog.stage.words.text()
    before = dialog.stage.seconds
    drive.wait(lambda: dialog.stage.seconds != before)  # it plays by itself
    press(dialog, K.Key_C)
    drive.wait(lambda: dialog.stage.shown.clip == clip)
    press(dialog, K.Key_Space)
    assert not dialog.stage.playing
    dialog.close()


def test_number_keys_and_arrows_correct_and_the_mouse_does_too(practice):
    drive, dialog = practice, begun(practice)
    clip = to_gesture(drive, dialog)
    dialog.fields.picked.emit("kind")
    press(dialog, K.Key_3)
    assert dialog.review.value(clip, "kind") == "fidget"
    press(dialog, K.Key_Left)
    assert dialog.review.value(clip, "kind") == "gesture"
    press(dialog, K.Key_Down, K.Key_Down)
    assert dialog.row == "stance"
    at = dialog.fields.chip("limb", "left")
    QTest.mouseClick(dialog.fields, Qt.MouseButton.LeftButton, pos=QPoint(round(at.x()), round(at.y())))
    assert dialog.review.value(clip, "limb") == "left" and dialog.row == "limb"
    press(dialog, K.Key_Return)
    (action,) = drive.document.project.uses[clip]
    assert (action.kind, action.limb) == ("gesture", "left")
    dialog.close()


@pytest.mark.nightly
def test_every_step_is_taken_back_by_a_key_and_the_clip_is_looked_at_again(practice):
    drive, dialog = practice, begun(practice)
    first = dialog.current
    press(dialog, K.Key_Return)
    second = dialog.current
    press(dialog, K.Key_A)
    assert len(dialog.work.waiting()) < 20
    press(dialog, K.Key_Backspace)
    assert len(dialog.work.waiting()) == 151
    press(dialog, K.Key_Backspace)
    assert (
        dialog.current == first
        and second in dialog.work.waiting()
        and not list(drive.document.project.actions())
    )
    press(dialog, K.Key_Backspace)  # nothing is left to take back
    dialog.close()


@pytest.mark.nightly
def test_a_clip_may_wait_and_one_gone_by_is_placed_anew(practice):
    drive, dialog = practice, begun(practice)
    first = dialog.current
    press(dialog, K.Key_Tab)
    assert dialog.current != first and first in dialog.work.waiting()
    press(dialog, K.Key_Backtab)
    press(dialog, K.Key_Return, K.Key_Backtab)
    assert dialog.current == first and first not in dialog.work.waiting()
    clip = to_gesture(drive, dialog)
    press(dialog, K.Key_Return)
    dialog.go_to(clip)
    dialog.fields.picked.emit("kind")
    press(dialog, K.Key_3, K.Key_Return)
    assert [a.kind for a in drive.document.project.uses[clip]] == ["fidget"]
    dialog.close()


@pytest.mark.nightly
def test_a_stance_is_found_by_typing_or_named(practice, monkeypatch):
    drive, dialog = practice, begun(practice)
    rest = next(c for c, e in drive.document.project.clips.items() if e.name == "on_hips__stance")
    dialog.go_to(rest)
    dialog.fields.picked.emit("stance")
    value, name = next((v, w) for v, w in dialog.review.choices(rest, "stance") if "hip" not in w.lower())
    offered = []

    def answer(*words, **_):
        offered.extend(words[3])
        return f" {name.upper()} ", True

    monkeypatch.setattr(QInputDialog, "getItem", answer)
    press(dialog, K.Key_N)
    assert dialog.review.value(rest, "stance") == value and name in offered
    monkeypatch.setattr(QInputDialog, "getItem", lambda *a, **k: (" akimbo ", True))
    press(dialog, K.Key_N)
    assert dialog.review.value(rest, "stance") == "akimbo"
    press(dialog, K.Key_Return)
    assert "akimbo" in {s.name for s in drive.document.project.graphs["arms"].stances.values()}
    dialog.close()


@pytest.mark.nightly
def test_what_cannot_be_placed_stays_with_its_reason(practice):
    drive, dialog = practice, begun(practice)
    clip = to_gesture(drive, dialog)
    dialog.fields.picked.emit("kind")
    press(dialog, K.Key_4, K.Key_Return)
    assert dialog.current == clip and "where it ends" in dialog.stage.words.text()
    assert not list(drive.document.project.actions())
    dialog.close()


@pytest.mark.nightly
def test_tags_and_times_are_given_where_the_clip_is_seen(practice):
    drive, dialog = practice, begun(practice)
    clip = to_gesture(drive, dialog)
    press(dialog, K.Key_T)
    assert dialog.focusWidget() is dialog.tags
    dialog.tags.clear()
    QTest.keyClicks(dialog.tags, "hello, you")
    QTest.keyClick(dialog.tags, K.Key_Return)
    assert dialog.review.found.proposals[clip].tags.value == ("hello", "you") and dialog.current == clip
    drive.wait(lambda: dialog.stage.shown is not None)
    drive.pause(60)
    span = dialog.stage.strip.span
    dialog.stage.strip.sought.emit(span.start + 0.4)
    press(dialog, K.Key_BracketLeft)
    start = dialog.review.found.proposals[clip].timing["start"]
    drive.pause(80)
    press(dialog, K.Key_Return)
    action = drive.document.project.uses[clip][0]
    assert action.tags == ("hello", "you") and action.timing.start == start > 0.3
    dialog.close()


@pytest.mark.nightly
def test_a_correction_is_learned_and_the_rest_looked_at_anew(practice, monkeypatch):
    drive, dialog = practice, begun(practice)
    told = []
    monkeypatch.setattr(type(dialog.work.learned), "correct_all", lambda self, some, _: told.extend(some))
    clip = to_gesture(drive, dialog)
    dialog.fields.picked.emit("kind")
    press(dialog, K.Key_3, K.Key_Return)
    assert told == [("hands_at_sides__point_you_rt_01", "kind", "fidget")]
    before = dialog.review.found
    drive.wait(lambda: dialog.review.found is not before)
    assert dialog.review.value(clip, "kind") == "fidget"
    dialog.close()


@pytest.mark.nightly
def test_with_everything_placed_there_is_nothing_to_label(practice):
    drive, dialog = practice, begun(practice)
    dialog.queue.limit.setValue(0)
    QTest.mouseClick(dialog.queue.sure, Qt.MouseButton.LeftButton)
    while dialog.current is not None:
        press(dialog, K.Key_Return)
    assert "All clips are placed" in dialog.stage.words.text() and dialog.go.text() == "Done"
    assert not drive.actions["propose"].isEnabled()
    dialog.close()


@pytest.mark.nightly
def test_closing_lets_the_character_play_on(practice):
    drive = practice
    assert drive.session.transport.playing
    dialog = begun(drive)
    assert not drive.session.transport.playing
    press(dialog, K.Key_Escape)
    drive.wait(lambda: drive.session.transport.playing)


def made_of(drive, name: str):
    """A made set in the window, nothing of it placed."""
    project = named(name).project
    drive.document.load(project, None)
    drive.files.opened.emit()
    drive.wait(lambda: drive.performance.skeleton() is not None, 60)
    return begun(drive)


@pytest.mark.nightly
def test_clips_left_aside_stand_at_the_end_with_the_reason_and_are_labelled_all_the_same(toys):
    drive = toys
    dialog = made_of(drive, "one stance and exercises")
    project, aside = drive.document.project, dialog.work.aside
    assert len(aside) == 16 and len(aside) + len(dialog.work.clips) == len(project.clips)
    assert not set(aside) & set(dialog.work.clips) and dialog.work.waiting() == list(dialog.work.clips)
    tree = dialog.queue.list
    texts = [tree.topLevelItem(n).text(0) for n in range(tree.topLevelItemCount())]
    assert texts[len(dialog.work.clips)] == "Skipped (16)" and texts[-1].startswith("–  ")
    walks = next(c for c in aside if "walk" in project.clips[c].name)
    row = next(n for n, text in enumerate(texts) if text.endswith(project.clips[walks].name))
    assert "skipped" in tree.topLevelItem(row).toolTip(0)
    press(dialog, K.Key_Backtab)  # before the first there is none
    dialog.go_to(dialog.work.clips[-1])
    press(dialog, K.Key_Tab)
    assert dialog.current == aside[0]
    dialog.go_to(walks)
    drive.wait(lambda: dialog.stage.shown is not None and dialog.stage.shown.clip == walks)
    drive.pause(100)
    target, root = dialog.stage.view.camera.target, dialog.stage.shown.pose(dialog.stage.seconds).root
    assert abs(root[0] - target[0]) < 0.6 and abs(root[2] - target[2]) < 0.6  # it is in the picture
    assert "Skipped" in dialog.stage.words.text() and "walk" in dialog.stage.words.text()
    assert [row.name for row in dialog.fields.rows] == ["kind"] and dialog.go.text() == "Skip"
    assert not dialog.tags.isEnabled()
    press(dialog, K.Key_BracketLeft, K.Key_N, K.Key_Down, K.Key_C, K.Key_C)  # nothing to correct yet
    press(dialog, K.Key_Return)
    assert dialog.current not in (None, walks) and walks in dialog.work.aside
    assert not list(drive.document.project.actions())
    dialog.go_to(walks)
    press(dialog, K.Key_3)
    assert dialog.current == walks and dialog.work.clips[-1] == walks and walks not in dialog.work.aside
    assert dialog.review.value(walks, "kind") == "fidget" and "stance" in [r.name for r in dialog.fields.rows]
    drive.wait(lambda: dialog.stage.shown is not None and walks in dialog.stage.shown.project.uses)
    press(dialog, K.Key_Return)
    assert [a.kind for a in drive.document.project.uses[walks]] == ["fidget"]
    press(dialog, K.Key_Backspace)
    assert dialog.current == walks and not list(drive.document.project.actions())
    dialog.close()


@pytest.mark.nightly
def test_a_clip_taken_up_stays_one_when_the_rest_is_looked_at_anew(toys, monkeypatch):
    drive = toys
    dialog = made_of(drive, "one stance and exercises")
    monkeypatch.setattr(type(dialog.work.learned), "correct_all", lambda self, *a: None)
    clip, other = dialog.work.aside[:2]
    dialog.go_to(clip)
    press(dialog, K.Key_2)
    before = dialog.review.found
    press(dialog, K.Key_Return)
    drive.wait(lambda: dialog.review.found.proposals.keys() == before.proposals.keys())
    drive.pause(700)
    drive.settle()
    assert clip not in dialog.review.found.aside and other in dialog.review.found.aside
    dialog.go_to(other)
    press(dialog, K.Key_2, K.Key_Return)
    kinds = {c: a.kind for c in (clip, other) for a in drive.document.project.uses[c]}
    assert kinds == {clip: "gesture", other: "gesture"}
    dialog.close()


@pytest.mark.nightly
def test_when_all_but_those_left_aside_is_placed_that_is_said(toys):
    dialog = made_of(toys, "one stance and exercises")
    dialog.queue.limit.setValue(0)
    press(dialog, K.Key_A)
    while dialog.current is not None:
        press(dialog, K.Key_Return)
    assert "16 skipped clips" in dialog.stage.words.text() and dialog.go.text() == "Done"
    assert not dialog.queue.bridge.isVisible()  # one stance: there is nothing to bridge
    press(dialog, K.Key_Tab)
    assert dialog.current == dialog.work.aside[0]
    dialog.close()


@pytest.mark.nightly
def test_a_stance_that_a_clip_leads_to_which_is_not_placed_yet_is_not_told(toys):
    drive = toys
    dialog = made_of(drive, "standing talker")
    found = dialog.work.review.found.proposals
    rest = [c for c, p in found.items() if p.kind.value == "transition"]
    dialog.work.place([c for c in found if c not in rest], "All but transitions", None)
    drive.wait(lambda: bool(dialog.work.parted))
    now = find_missing_bridges(drive.document.project)
    assert rest and len(dialog.work.parted) < len(now) and set(dialog.work.parted) < set(now)
    dialog.work.place(rest, "The rest", None)
    drive.settle()
    assert list(dialog.work.parted) == find_missing_bridges(drive.document.project)
    dialog.close()


@pytest.mark.nightly
def test_stances_no_clip_leads_to_are_told_after_all_were_accepted_and_bridged_with_a_press(toys):
    drive = toys
    dialog = made_of(drive, "standing talker")
    assert not dialog.queue.bridge.isVisible()
    press(dialog, K.Key_B)
    assert "Nothing to bridge" in dialog.queue.parted.text()
    press(dialog, K.Key_Return)
    drive.settle()
    assert not dialog.queue.bridge.isVisible()  # a single clip is no reason to speak of it
    dialog.queue.limit.setValue(0)
    press(dialog, K.Key_A)
    drive.wait(dialog.queue.bridge.isVisible)
    stance = drive.document.project.stance(dialog.work.parted[0])
    assert "1 stance" in dialog.queue.parted.text() and stance.name in dialog.queue.parted.text()
    count, placed = drive.document.undo_stack.count(), len(list(drive.document.project.actions()))
    QTest.mouseClick(dialog.queue.bridge, Qt.MouseButton.LeftButton)
    assert drive.document.undo_stack.count() == count + 1
    assert find_missing_bridges(drive.document.project) == []
    drive.wait(lambda: not dialog.queue.bridge.isVisible())
    assert dialog.queue.parted.text() == "Added 1 blended transition."
    assert "blended in" in dialog.queue.parted.toolTip()
    press(dialog, K.Key_Backspace)
    assert len(list(drive.document.project.actions())) == placed
    drive.wait(dialog.queue.bridge.isVisible)
    press(dialog, K.Key_B)
    drive.wait(lambda: not dialog.queue.bridge.isVisible())
    assert find_missing_bridges(drive.document.project) == []
    press(dialog, K.Key_Backspace, K.Key_Backspace)
    drive.wait(lambda: not dialog.queue.parted.isVisible())
    dialog.close()


def play_through(drive, dialog) -> None:
    """Let what plays come round once."""
    drive.wait(lambda: dialog._seen == dialog._trials)
    dialog.stage.played.emit()


@pytest.mark.nightly
def test_all_clips_are_watched_through_a_correction_holds_and_they_are_accepted_together(
    practice, monkeypatch
):
    drive = practice
    dialog = begun(drive)
    press(dialog, K.Key_W)
    assert dialog.watching.on and not dialog.context
    first = dialog.current
    play_through(drive, dialog)
    second = dialog.current
    assert second != first and not drive.document.project.uses.get(first)
    assert "Watching 2 of 152" in dialog.queue.words.text()
    wanted = "fidget" if dialog.review.value(second, "kind") != "fidget" else "gesture"
    dialog.fields.chosen.emit("kind", wanted)
    play_through(drive, dialog)
    assert dialog.current == second  # it is held until Enter
    press(dialog, K.Key_Return)
    assert dialog.current not in (first, second)
    press(dialog, K.Key_Backtab)
    play_through(drive, dialog)
    held = dialog.current
    play_through(drive, dialog)
    assert dialog.current == held
    for _ in range(400):
        if dialog.current is None:
            break
        press(dialog, K.Key_Return)
    assert "Watched" in dialog.stage.words.text() and dialog.work.waiting()
    press(dialog, K.Key_Return)
    assert not dialog.work.waiting() and not dialog.watching.on
    assert drive.document.project.uses[second][0].kind == wanted
    press(dialog, K.Key_Backspace)  # one step
    assert len(dialog.work.waiting()) == 152
    press(dialog, K.Key_W, K.Key_Return)
    out = dialog.current
    press(dialog, K.Key_Tab, K.Key_W)  # ended after one: that is accepted, what was left out is not
    assert len(dialog.work.waiting()) < 152 and out in dialog.work.waiting()


@pytest.mark.nightly
def test_clips_that_are_taken_for_the_same_are_watched_beside_each_other(practice):
    from itertools import groupby

    from app.features.labelling.review_watch import order_similar

    dialog = begun(practice)
    review = dialog.review
    order = order_similar(review, dialog.work.waiting())
    signs = [(review.value(c, "layer"), review.value(c, "stance"), review.value(c, "kind")) for c in order]
    assert len(list(groupby(signs))) == len(set(signs)) < 152 and sorted(order) == sorted(
        dialog.work.waiting()
    )


@pytest.mark.nightly
def test_why_stances_cannot_be_joined_is_said_and_not_counted_as_a_transition(practice):
    dialog = begun(practice)
    dialog.queue.part((), (), ())
    assert not dialog.queue.parted.isVisible()
    dialog.queue.part((), ("one",), ('"far" is not joined to the others: …',))
    assert dialog.queue.parted.text().startswith("Added 1 blended transition.\n")
    assert "is not joined" in dialog.queue.parted.text() and dialog.queue.parted.isVisible()
    dialog.work.unbridged = ('"up" is not joined to the others: …',)
    dialog._refresh()
    assert dialog.queue.parted.text() == dialog.work.unbridged[0]
    dialog.close()


@pytest.mark.parametrize("speed", [1.0, 2.0])
def test_clips_are_watched_at_the_speed_chosen_below_the_character(practice, monkeypatch, speed):
    dialog = begun(practice)
    stage = dialog.stage
    box = practice.window.findChild(PreviewPanel).speed_box
    chosen = box.findText(f"{speed:g}×")
    box.setCurrentIndex(chosen)
    box.activated.emit(chosen)
    stage._timer.stop()
    stage.playing, stage.seconds = True, 0.0
    monkeypatch.setattr(stage, "_clock", SimpleNamespace(restart=lambda: 100))
    practice.wait(stage.isVisible)
    stage._tick()
    assert stage.seconds == pytest.approx(0.1 * speed)
    practice.session.transport.speed = 1.0
    dialog.close()


@pytest.mark.parametrize("lines", [1, 6])
def test_what_is_written_over_the_character_leaves_its_face_free(drive, lines):
    from app.features.labelling.review_stage import ReviewStage

    stage = ReviewStage(drive.session, drive.shell.stage.figures, drive.window)
    stage.resize(500, 480)
    stage.layout().activate()
    stage.tell("<br>".join(["words"] * lines))
    above = stage._share_above()
    top = above / (1 + above) * stage.view.height()  # where a figure begins that fills the rest
    assert top >= stage.words.height() + 12 - 1
    stage.deleteLater()


def test_a_long_reason_is_shown_whole(drive, qtbot):
    from app.features.labelling.review_fields import ReviewFields, ReviewRow

    fields = ReviewFields(drive.session)
    qtbot.addWidget(fields)
    heights = []
    for times in (1, 4, 8):
        reason = "the arms move, hips and legs do not " * times
        fields.show_rows([ReviewRow("layer", "Layer", [("arms", "Arms")], "arms", 1.0, reason)], "layer")
        fields.resize(380, fields.sizeHint().height())
        heights.append(fields.height())
    assert heights[0] < heights[1] < heights[2] and heights[2] - heights[1] > 3 * 14
