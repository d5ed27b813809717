"""Play the stage live: agents send requests over WebSocket and OSC on this machine, and the window shows the
result.

The connections to clients are in another process. Here is one tick for each frame, which answers what arrived
since the previous one.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from concurrent.futures import Future
from pathlib import Path
from threading import Thread

import msgspec
from PySide6.QtCore import QElapsedTimer, QObject, Qt, QTimer, Signal

from app.translation import tr, tr_error, tr_plural
from metagraph.generation.offered import list_models
from metagraph.graph.model import Project
from metagraph.graph.requests import AnyRequest, Performance
from metagraph.live import OSC_PORT, PORT
from metagraph.live.graph_motion import LiveGraph, list_recorded_takes, make_live_graph
from metagraph.live.live_session import LiveSession
from metagraph.live.messages import HeardMessage, Reply
from metagraph.live.relay import Relay
from metagraph.live.server import LiveError, Options
from metagraph.live.tape import Tape
from metagraph.live.tick_work import Out
from metagraph.playback.planning.extend_performance import AskAnswer, answer_asks

TICK = 16  # milliseconds
SHOWN = 300  # latest requests that the timeline shows
ANSWERED = 0.2  # seconds between two updates of what becomes of them
RATED = 1.0  # seconds over which requests are counted
WINDOW = 0  # the window is a client, too
TAKES = "takes"  # the clients' name for the motion graph of the project itself


class _Shown(Tape):
    """A tape that also keeps the latest requests. `count` is the number of accepted requests."""

    def __init__(self) -> None:
        super().__init__()
        self.latest: tuple[AnyRequest, ...] = ()
        self.count = 0

    def keep(self, asks: Sequence[AnyRequest], now: float) -> None:
        super().keep(asks, now)
        shown = [ask for ask in asks if ask.__struct_config__.tag != "withdraw"]
        if shown:
            self.latest = (*self.latest, *shown)[-SHOWN:]
        self.count += len(asks)


class _Counted(LiveSession):
    """A session that counts the requests it has answered."""

    answered = 0

    def tick(self, now: float, heard: Iterable[tuple[int, HeardMessage | Reply]] = ()) -> Out:
        out = super().tick(now, heard)
        self.answered += len(out.replies)
        return out


class LiveStage(QObject):
    """Plays live. `ticked` is emitted when the plan advanced; `told` has words about who can connect, or why
    nobody can. Models are searched beside `folder`.
    """

    ticked = Signal()
    told = Signal(str)

    def __init__(
        self,
        project: Project,
        options: Options | None = None,
        parent: QObject | None = None,
        folder: Path | None = None,
    ) -> None:
        super().__init__(parent)
        self.session = _Counted(project, models=list_models(folder))
        self._graph: Future[LiveGraph] | None = None
        self.session.tape = self.tape = _Shown()
        self.session.join(WINDOW)
        self.options = options or Options(port=PORT, osc=OSC_PORT)
        self.relay: Relay | None = None
        self.error = self.graph_error = ""
        self._clock = QElapsedTimer()
        self._timer = QTimer(self, interval=TICK)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self.tick)
        self._answers: dict[str, AskAnswer] = {}
        self._answered = -ANSWERED
        self._rated: deque[tuple[float, int]] = deque()
        self._ready = False

    # --- from beginning to end

    def start(self) -> None:
        """Begin: open the connections and start the clock."""
        self._clock.start()
        self._open(self.options)
        self._make_graph()
        self._timer.start()

    def _make_graph(self) -> None:
        """Begin to make the motion graph of the project's own takes on a thread, if it has any."""
        project = self.session.project
        clips, speech = list_recorded_takes(project)
        if not clips:
            return
        future: Future[LiveGraph] = Future()
        self._graph = future
        self.session.offer(TAKES, None)

        def make() -> None:
            try:
                graph = make_live_graph(clips, speech)
                graph.warm(project)
                future.set_result(graph)
            except Exception as error:  # reported to clients that ask for it
                future.set_exception(error)

        Thread(target=make, name="motion graph", daemon=True).start()

    def _take_graph(self) -> None:
        """Offer the motion graph once it is made; otherwise say why there is none."""
        future, self._graph = self._graph, None
        error = None if future is None else future.exception()
        if future is not None and error is None:
            self.session.offer(TAKES, future.result())
        else:
            self.session.generating.graphs.pop(TAKES, None)
            self.graph_error = tr_error(error)

    def _open(self, options: Options) -> None:
        try:
            self.relay = Relay(options)
            self.relay.start()
        except (LiveError, OSError) as error:
            self.relay, self.error = None, tr_error(error)
            self.told.emit(self.words())

    def stop(self) -> None:
        """End, and disconnect the clients."""
        self._timer.stop()
        if self.relay is not None:
            self.relay.close()
            self.relay = None

    @property
    def now(self) -> float:
        """Return the seconds since it began."""
        return self._clock.elapsed() / 1000 if self._clock.isValid() else 0.0

    # --- what happens

    def tick(self) -> None:
        """Answer what arrived, and advance."""
        now = self.now
        if self._graph is not None and self._graph.done():
            self._take_graph()
        if self.relay is None:
            self.session.tick(now)
        else:
            self.relay.tick(self.session, now)
            if self.relay.error and not self.error:
                self._lost(self.relay.error)
            elif self.relay is not None and self.relay.ready is not None and not self._ready:
                self._ready = True
                self.told.emit(self.words())
        self._rated.append((now, self.session.answered))
        while self._rated[0][0] < now - RATED:
            self._rated.popleft()
        self.ticked.emit()

    def _lost(self, error: str) -> None:
        relay, self.relay = self.relay, None
        if relay is not None:
            relay.close()
        if not self._ready and (self.options.port, self.options.osc) == (PORT, OSC_PORT):
            self.options = Options(port=0, osc=0)  # another program uses these ports: use any free ones
            self._open(self.options)
            return
        self.error = error
        self.told.emit(self.words())

    def ask(self, ask: AnyRequest) -> None:
        """Send a request as a client does."""
        self.session.receive(WINDOW, msgspec.json.encode(ask))

    def change(self, project: Project) -> None:
        """Continue with an edited project."""
        self.session.change(project)

    # --- what is known

    @property
    def asks(self) -> tuple[AnyRequest, ...]:
        """Return the latest requests of all clients."""
        return self.tape.latest

    def answers(self) -> dict[str, AskAnswer]:
        """Return what becomes of the latest requests."""
        if self.session.now >= self._answered + ANSWERED:
            self._answered = self.session.now
            self._answers = answer_asks(self.session.plan, (ask.id for ask in self.tape.latest))
        return self._answers

    @property
    def rate(self) -> float:
        """Return the recent number of requests a second."""
        if len(self._rated) < 2:
            return 0.0
        (a, first), (b, last) = self._rated[0], self._rated[-1]
        return (last - first) / max(b - a, 1e-3)

    def words(self) -> str:
        """Say who can connect and how busy it is."""
        if self.error:
            return tr("Live, but no program can connect: {error}", error=self.error)
        ready = self.relay.ready if self.relay is not None else None
        if ready is None:
            return tr("Going live…")
        clients = len(self.session.clients) - 1
        who = (
            tr("no clients connected")
            if clients == 0
            else tr(
                "{clients}, {rate:.0f} requests/s",
                clients=tr_plural("{count:,} client", "{count:,} clients", clients),
                rate=self.rate,
            )
        )
        lacks = (
            tr("; no motion graph can be built from its takes: {error}", error=self.graph_error)
            if self.graph_error
            else ""
        )
        return tr("Live at {address}: {who}{lacks}", address=ready.websocket, who=who, lacks=lacks)

    def performance(self) -> Performance:
        """Return what was played so far, to keep it."""
        return self.session.performance(tr("Live session"))
