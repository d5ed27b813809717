"""Move the playhead with time: through the plan, around a loop, or with a live session."""

from __future__ import annotations

from app.stage.performance import StagePerformance
from app.stage.session import StageSession


class Playhead:
    """Moves the session's playhead through the performance."""

    def __init__(self, session: StageSession, performance: StagePerformance) -> None:
        self.session, self.performance = session, performance

    def advance(self, elapsed: float) -> None:
        """Move the playhead by `elapsed` seconds of wall clock; called before each frame."""
        transport = self.session.transport
        if self.performance.live.stage is not None and transport.show == "plan":
            self._advance_live(elapsed)
            return
        if not transport.playing or elapsed <= 0 or self.performance.skeleton() is None:
            return
        seconds = transport.seconds + elapsed * transport.speed
        length = self.performance.shown.length
        part = transport.part
        if part is not None and (transport.show, transport.shown) == ("clip", part[0]) and seconds >= part[2]:
            transport.seek(part[1] + (seconds - part[1]) % max(part[2] - part[1], 1e-3))
            return
        again = self.performance.timeline.range if transport.show == "plan" and transport.loop else None
        if again is not None and transport.seconds < min(again[1], length) <= seconds and again[0] < length:
            start, end = again[0], min(again[1], length)
            transport.seek(start + (seconds - end) % max(end - start, 1e-3))
            return
        endless = not self.performance.ends and transport.show == "plan" and not transport.loop
        if endless:
            self.performance.plan_beyond(seconds)
        if seconds >= length > 0 and not endless:
            if transport.loop:
                seconds %= length
            else:
                seconds = length
                transport.set_playing(False)
        transport.seek(seconds)

    def _advance_live(self, elapsed: float) -> None:
        """Set the playhead to the present; once it was moved back, play on behind until it follows again."""
        transport, live = self.session.transport, self.performance.live
        assert live.stage is not None
        now = live.stage.now
        live.following = live.following and transport.playing
        if live.following:
            transport.seek(now)
        elif transport.playing:
            transport.seek(min(now, transport.seconds + elapsed * transport.speed))
