"""The timeline's commands: the range, markers, what is seen of it, snapping and ripple."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QSettings

from app.shell.actions import Command
from app.shell.context import Shell
from app.translation import tr


def commands(shell: Shell) -> tuple[Command, ...]:
    session, performance = shell.stage.session, shell.stage.performance
    noted = performance.timeline

    def there() -> bool:
        return shell.document.project.skeleton is not None

    def performing() -> bool:
        """Whether the timeline is a performance's, and no clip's or action's that is looked at alone."""
        return there() and session.transport.show == "plan"

    def panel() -> Any:
        shell.show("timeline")
        return shell.panel("timeline")

    def press(switch: str) -> Callable[[], object]:
        return lambda: getattr(shell.panel("timeline"), switch).toggle()

    def move(step: int) -> Callable[[], object]:
        return lambda: noted.jump(step)

    def command(
        ident: str, group: str, text: str, run: Callable[[], object], keys: tuple[str, ...], **more: Any
    ) -> Command:
        return Command(ident, "&Play", group, text, run, keys, when="meta", **{"enabled": there, **more})

    def taller(by: float) -> Callable[[], object]:
        """Return what makes the lane of the layer that is edited taller."""

        def size() -> None:
            titles, lane = panel().lanes.titles, session.place.layer
            titles.size(lane, titles.view.sizes.factor(lane) * by)

        return size

    def automatic() -> None:
        talk = shell.document.project.conversations.get(performance.conversation or "")
        if talk is not None:
            noted.automatic(talk)
            shell.show("timeline")

    def snaps() -> bool:
        return QSettings().value("timeline/magnet", "true") != "false"

    tip = tr("What is between in and out is played again and again, and can be written alone")
    return (
        command(
            "range_in", "range", tr("Loop from &here"), noted.set_in, ("I",), tip=tip, enabled=performing
        ),
        command(
            "range_out", "range", tr("Loop &to here"), noted.set_out, ("O",), tip=tip, enabled=performing
        ),
        command(
            "range_clear",
            "range",
            tr("&Clear loop range"),
            noted.clear_range,
            ("Ctrl+Shift+X",),
            enabled=performing,
        ),
        command(
            "marker",
            "markers",
            tr("Add &marker"),
            noted.add_marker,
            ("Ctrl+Alt+M",),
            tip=tr("A named moment at the playhead; on the timeline, M alone"),
            enabled=performing,
        ),
        command("marker_next", "markers", tr("&Next marker"), move(1), ("Shift+M",)),
        command("marker_before", "markers", tr("&Previous marker"), move(-1), ("Ctrl+Shift+M",)),
        command(
            "timeline_all",
            "timeline",
            tr("Zoom the timeline to &all"),
            lambda: panel().lanes.zoom_all(),
            ("Shift+Z",),
        ),
        command(
            "timeline_selection",
            "timeline",
            tr("&Zoom the timeline to the selection"),
            lambda: panel().lanes.zoom_selection(),
            ("Z",),
            tip=tr("The selected requests or action; else the loop range"),
        ),
        command(
            "timeline_snap",
            "timeline",
            tr("&Snap on the timeline"),
            press("magnet"),
            ("S",),
            checked=snaps,
        ),
        command(
            "timeline_ripple",
            "timeline",
            tr("&Ripple on the timeline"),
            press("ripple"),
            ("Shift+R",),
            checked=lambda: performance.requests.ripple,
            tip=tr("What follows goes along with what is moved"),
        ),
        command(
            "lock_layer",
            "timeline",
            tr("&Lock the layer's requests"),
            lambda: noted.lock(session.place.layer, session.place.layer not in noted.now.locked),
            ("Shift+K",),
            tip=tr("Requests of the layer that is edited cannot be moved or taken back"),
            checked=lambda: session.place.layer in noted.now.locked,
        ),
        command("lane_taller", "timeline", tr("Taller lane"), taller(1.3), ("Alt+Shift+Up",)),
        command("lane_lower", "timeline", tr("Lower lane"), taller(1 / 1.3), ("Alt+Shift+Down",)),
        command(
            "automatic_cuts",
            "timeline",
            tr("A&utomatic cuts"),
            automatic,
            ("Ctrl+Shift+U",),
            tip=tr("The camera of the conversation on stage follows who speaks"),
            enabled=lambda: performance.conversation is not None,
        ),
        command(
            "captions",
            "timeline",
            tr("&Captions"),
            lambda: noted.show_captions(not noted.now.captions),
            ("Shift+C",),
            tip=tr("The words of who speaks, at the bottom of the picture"),
            checked=lambda: noted.now.captions,
        ),
        command(
            "what_if",
            "timeline",
            tr("What other seeds would pla&y"),
            press("ghosts"),
            ("Shift+W",),
            tip=tr("Three more rows under the lanes; a click takes one over"),
        ),
        command(
            "what_if_others",
            "timeline",
            tr("Three ot&her seeds"),
            lambda: shell.panel("timeline").what_if.others(),
            (),
            tip=tr("The next three, where other seeds are shown"),
        ),
        command(
            "requests_copy",
            "timeline",
            tr("Copy re&quests"),
            lambda: performance.requests.to_clipboard(session.onstage.requests),
            (),
            tip=tr("As a text that another window pastes, too; Ctrl+C on the timeline"),
            enabled=lambda: performance.requests.kept is not None and bool(session.onstage.requests),
        ),
        command(
            "requests_paste",
            "timeline",
            tr("Paste requests at the p&layhead"),
            performance.requests.paste,
            (),
            tip=tr("Ctrl+V on the timeline"),
        ),
    )
