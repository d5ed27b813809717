"""Sounds are read on a thread, and what is painted is filled on the window's own."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from app.features.conversation import sound_reading
from app.features.conversation.sound_reading import SideSound, Sounds
from app.project.document import Document
from app.project.jobs import Jobs
from app.stage.session import StageSession
from app.widgets.waveforms import Envelope
from metagraph.graph.conversation import edits as conversation_edits
from metagraph.graph.conversation.model import Conversation, Side
from metagraph.graph.model import Project


@pytest.fixture
def sounds(qapp, tmp_path):
    import soundfile

    rate = 16000
    times = np.arange(3 * rate) / rate
    both = np.stack([0.3 * np.sin(2 * np.pi * hertz * times) for hertz in (120, 210)], 1)
    soundfile.write(tmp_path / "talk.wav", both, rate)
    document, jobs = Document(), Jobs()
    session = StageSession(document)
    made = Sounds(document, session, jobs)
    sides = tuple(Side(name=str(n), audio=str(tmp_path / "talk.wav"), channel=n) for n in (0, 1))
    talk = Conversation(name="talk", length=3.0, sides=sides)
    project, ident = conversation_edits.add_conversation(Project(), talk)
    document.load(project, None)
    made.ident, made.talk = ident, project.conversations[ident]
    yield made
    jobs.stop()
    document.close_journal()


def read(sounds, qtbot) -> list[SideSound]:
    sounds.session.onstage.set_conversation(sounds.ident)
    qtbot.waitUntil(lambda: sounds.heard and all(not h.told for h in sounds.heard.values()), timeout=60000)
    return [sounds.of(sounds.talk, side) for side in (0, 1)]


def test_both_channels_come_with_waveform_and_pitch(sounds, qtbot):
    for heard, hertz in zip(read(sounds, qtbot), (120, 210), strict=True):
        low, high = heard.wave.columns(0.0, 100.0, 300)
        assert high[:290] == pytest.approx(0.3, abs=0.02) and low[:290] == pytest.approx(-0.3, abs=0.02)
        found = heard.pitch.columns(0.5, 100.0, 200)[1]
        assert np.median(found[np.isfinite(found)]) == pytest.approx(hertz, rel=0.02)
        assert heard.loudest == pytest.approx(0.3, abs=0.01) and heard.length == pytest.approx(3.0)


def test_nothing_that_is_painted_is_touched_by_the_thread_that_reads(sounds, qtbot, monkeypatch):
    here, elsewhere = threading.get_ident(), []

    def note(what):
        def wrapped(self, *arguments):
            if threading.get_ident() != here:
                elsewhere.append(what)
            return originals[what](self, *arguments)

        return wrapped

    originals = {"set": SideSound.__setattr__, "put": Envelope.put}
    monkeypatch.setattr(SideSound, "__setattr__", note("set"))
    monkeypatch.setattr(Envelope, "put", note("put"))
    monkeypatch.setattr(sound_reading, "BLOCK", 1)
    read(sounds, qtbot)
    assert elsewhere.count("set") == 0
    assert elsewhere.count("put") <= 2, "only the pitch, which is handed over when it is whole"


def test_a_conversation_that_was_on_stage_before_is_read_at_once(sounds, qtbot):
    read(sounds, qtbot)
    later = Sounds(sounds.document, sounds.session, sounds.jobs)
    qtbot.waitUntil(
        lambda: bool(later.heard) and all(not h.told for h in later.heard.values()), timeout=60000
    )
    assert later.of(sounds.talk, 0).wave is not None
