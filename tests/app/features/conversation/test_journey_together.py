"""Two who talk are dropped on the sample project, move both characters, are heard, and are written as a
video.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.features.conversation.conversation_dialog import ImportDialog
from app.features.conversation.conversation_settings import SideRatesDialog
from app.features.render.render_dialog import RenderDialog
from app.project.files import SAMPLE
from metagraph.graph.requests import Blink, Gesture, Play
from metagraph.speech.drive import find_stroke_times
from tests.speech.talk import make_conversation

pytestmark = [pytest.mark.window, pytest.mark.gl]


@pytest.mark.nightly
def test_dropped_seen_heard_and_written(drive: Any, tmp_path: Path) -> None:
    audio, words = make_conversation(tmp_path)
    drive.files.open(SAMPLE, template=True)
    drive.wait(lambda: drive.performance.skeleton() is not None and not drive.jobs.running)
    assert drive.drop_files((drive.window.statusBar(), QPoint(200, 8)), audio, words)
    dialog = next(d for d in drive.window.findChildren(ImportDialog) if d.isVisible())
    drive.wait(dialog.go.isEnabled, 240)  # the first of all has the reader compiled
    QTest.mouseClick(dialog.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: bool(drive.performance.shown.others), 120)
    drive.session.transport.set_playing(False)

    talk = drive.document.project.conversations[drive.session.onstage.conversation]
    nods = 0
    for one in drive.performance.shown.everyone:
        peaks = [s.peak for s in talk.sides[one.side].segments if s.kind == "clause"]
        found = find_stroke_times(one.project, one.plan)
        asked = [a for a in one.asks if isinstance(a, Gesture | Play)]
        assert len(asked) >= 2
        assert all(a.stroke in peaks and abs(found[a.id] - a.stroke) <= 0.1 for a in asked)
        nods += len(one.plan.layers["head"].cues)
    assert nods >= 2
    drive.wait(lambda: "the rates ask for 75 % and 75 %" in drive.conversation.title.words)
    drive.actions["rates"].trigger()
    rates = drive.window.findChild(SideRatesDialog)
    assert rates.delivered.isVisible() and rates.delivered.text().count("75 % requested") == 2
    rates.fields[0]["clause"].setValue(0)
    QTest.mouseClick(rates.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: "0 % and" in drive.conversation.title.words)
    drive.actions["rates"].trigger()
    rates = next(d for d in drive.window.findChildren(SideRatesDialog) if d.isVisible())
    rates.blinks.setCurrentIndex(1)
    QTest.mouseClick(rates.go, Qt.MouseButton.LeftButton)
    drive.wait(lambda: any(isinstance(a, Blink) for a in drive.performance.shown.asks))
    one = drive.performance.shown.everyone[0]
    blinks = one.plan.life.blinks.starts.tolist()
    assert blinks == pytest.approx([a.at for a in one.asks if isinstance(a, Blink)], abs=1e-6)
    drive.actions["undo"].trigger()
    drive.actions["undo"].trigger()
    drive.wait(lambda: "75 % and 75 %" in drive.conversation.title.words)

    drive.wait(lambda: len(drive.sound.parts) == 2, 60)
    frames = drive.preview.frames
    drive.session.transport.seek(1.0)
    drive.session.transport.set_playing(True)
    drive.wait(lambda: drive.preview.frames > frames + 5 and drive.session.transport.seconds > 1.3)
    drive.session.transport.set_playing(False)
    assert len(drive.preview.scene().actors) == 2

    drive.actions["render"].trigger()
    writer = next(d for d in drive.window.findChildren(RenderDialog) if d.isVisible())
    assert talk.name in writer.windowTitle() and writer.seconds.value() == pytest.approx(
        talk.length, abs=0.06
    )
    out = tmp_path / "talk.mp4"
    writer.file.setText(str(out))
    writer.seconds.setValue(2.0)
    writer.size_box.setCurrentIndex(0)
    QTest.mouseClick(writer.go, Qt.MouseButton.LeftButton)
    drive.wait(out.is_file, 120)
    import av

    with av.open(str(out)) as container:
        pictures = [f.to_ndarray(format="gray") for f in container.decode(video=0)]
    with av.open(str(out)) as container:
        sound = np.concatenate([f.to_ndarray()[0] for f in container.decode(audio=0)])
    assert len(pictures) == 60 and np.abs(pictures[0].astype(int) - pictures[-1]).max() > 40, "somebody moves"
    assert np.abs(sound[: 44100 // 2]).max() < 0.05 < np.abs(sound[44100:]).max(), (
        "the first words begin after 0.6 s"
    )
    writer.close()
