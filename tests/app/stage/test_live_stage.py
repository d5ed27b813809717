"""The live stage without lines: how busy it says it is."""

from __future__ import annotations

import time

from app.stage.live_stage import WINDOW, LiveStage


def test_requests_are_counted_whether_they_are_taken_on_or_refused(qapp, toy):
    stage = LiveStage(toy.project())
    stage._clock.start()
    stage.tick()
    for n in range(30):
        stage.session.receive(
            WINDOW, f'{{"do": "line", "id": "{n}", "line": "none"}}' if n % 2 else '{"do": "nothing known"}'
        )
    time.sleep(0.02)
    stage.tick()
    assert stage.session.answered == 30 and stage.tape.count == 0
    assert stage.rate > 0
    assert stage.asks is stage.asks, "the same requests are the same tuple, so that they are painted once"
