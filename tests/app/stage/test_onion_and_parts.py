"""Parts of clips that are looped, moments of actions in what plays, and onion skin."""

from __future__ import annotations

import pytest

from app.stage.onion import MOST, Onion, OnionSkin
from app.stage.playback_source import ShownPlayback, play_clip_alone, play_in_context
from app.stage.playhead import Playhead
from app.stage.transport import Transport


@pytest.fixture
def wave(toy):
    project = toy.project()
    return project, project.action(toy.id(project, "rest wave rt"))


def test_a_moment_of_an_action_is_found_in_context_and_back(wave):
    project, action = wave
    shown = play_in_context(project, action.id, "arms", {})
    for moment in (0.1, 0.5, 0.9):
        seconds = shown.seconds_of(action, moment)
        assert seconds is not None and seconds > moment
        assert shown.clip_seconds(action, seconds) == pytest.approx(moment, abs=0.01)
    assert shown.clip_seconds(action, 0.0) is None, "there the stance plays"
    assert shown.seconds_of(action, 99.0) is None


def test_of_a_clip_alone_moments_are_its_seconds_and_others_are_not_there(toy, wave):
    project, action = wave
    other = project.action(toy.id(project, "rest long"))
    shown: ShownPlayback = play_clip_alone(project, action.clip)
    assert shown.clip_seconds(action, 0.4) == shown.seconds_of(action, 0.4) == 0.4
    assert shown.clip_seconds(other, 0.4) is None and shown.seconds_of(other, 0.4) is None


class _Session:
    def __init__(self):
        self.transport = Transport()


class _Performance:
    class live:  # noqa: N801 - a stand-in
        stage = None

    class shown:  # noqa: N801 - a stand-in
        length = 4.0

    ends = True

    def skeleton(self):
        return object()


def test_only_the_part_is_played_again_and_again(qapp):
    session = _Session()
    transport, playhead = session.transport, Playhead(session, _Performance())
    transport.show_clip("c1")
    transport.set_part(("c1", 1.0, 1.5))
    transport.seek(1.45)
    playhead.advance(0.1)
    assert transport.seconds == pytest.approx(1.05)
    transport.seek(0.2)
    playhead.advance(0.1)
    assert transport.seconds == pytest.approx(0.3), "from before it plays into it"
    transport.show_clip("c2")
    transport.seek(1.45)
    playhead.advance(0.1)
    assert transport.seconds == pytest.approx(1.55), "it is of the other clip"


def test_scrubbing_shows_a_clip_still_and_does_not_begin_it_anew(qapp):
    transport, changes = Transport(), []
    transport.show_changed.connect(lambda: changes.append(1))
    transport.scrub("c1", 0.7)
    transport.scrub("c1", 0.8)
    assert (transport.show, transport.shown, transport.seconds) == ("clip", "c1", 0.8)
    assert not transport.playing and len(changes) == 1


def test_a_skin_is_told_once_and_has_few_ghosts(qapp, wave):
    onion, told = Onion(), []
    onion.changed.connect(lambda: told.append(1))
    skin = OnionSkin(wave[1], tuple((n / 10, 0.2) for n in range(9)))
    onion.show(skin)
    onion.show(skin)
    assert len(onion.skin.moments) == MOST and len(told) == 1
    onion.show(None)
    assert onion.skin is None and len(told) == 2
