"""Hand contacts found from the menu, in all actions at once."""

from __future__ import annotations

import pytest

from metagraph.graph.edits import update_actions

pytestmark = pytest.mark.window


def test_contacts_are_found_in_one_step_told_and_undone(toys, monkeypatch):
    said = []
    monkeypatch.setattr(toys.shell, "tell", said.append)
    before = toys.document.project
    toys.do("hand contacts")
    toys.wait(lambda: bool(said))
    assert said == ["No hand touches the body in any action."]
    assert toys.document.project.touch.guard == before.touch.guard


@pytest.mark.nightly
def test_those_of_the_sample_are_found_again_and_its_measured_body_stays(drive, sample):
    known = {a.id for a in sample.actions() if a.contacts}
    bare = update_actions(sample, [a.id for a in sample.actions()], contacts=())
    drive.document.load(bare, None)
    drive.do("hand contacts")
    drive.wait(lambda: drive.document.project is not bare, 60)
    found = {a.id for a in drive.document.project.actions() if a.contacts}
    assert found >= known and drive.document.project.touch == sample.touch
    drive.document.undo()
    assert not any(a.contacts for a in drive.document.project.actions())
