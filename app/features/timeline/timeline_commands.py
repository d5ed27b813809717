"""The timeline's commands: the range, markers, what is seen of it, snapping, ripple and live."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from PySide6.QtCore import QSettings
from PySide6.QtWidgets import QWidget

from app.project.importing import Importing
from app.shell.actions import Command
from app.shell.command_table import Feature, has_skeleton, require_all
from app.shell.context import Shell
from app.translation import tr_noop

TALLER = 1.3


class TimelineFeature(Feature):
    """Makes the panel of the performance, and does the commands of this module."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.noted, self.requests = self.performance.timeline, self.performance.requests
        self.live, self.transport = self.performance.live, self.session.transport

    @property
    def panel(self) -> Any:
        return self.shell.panel("timeline")

    def make_panel(self) -> QWidget:
        from app.features.timeline.lane_drops import LaneDrops
        from app.features.timeline.timeline_panel import TimelinePanel

        shell = self.shell
        panel = TimelinePanel(self.document, self.session, self.performance, shell.jobs, shell.widget)
        LaneDrops(panel.lanes, shell.services[Importing])
        return panel

    def show_panel(self) -> Any:
        self.shell.show("timeline")
        return self.panel

    # --- range and markers

    def begin_range(self) -> None:
        self.noted.set_in()

    def end_range(self) -> None:
        self.noted.set_out()

    def clear_range(self) -> None:
        self.noted.clear_range()

    def add_marker(self) -> None:
        self.noted.add_marker()

    def go_to_next_marker(self) -> None:
        self.noted.jump(1)

    def go_to_previous_marker(self) -> None:
        self.noted.jump(-1)

    def remove_marker(self) -> None:
        self.noted.remove_marker(str(self.noted.marker))

    def rename_marker(self) -> None:
        self.panel.lanes.ruler.rename(str(self.noted.marker))

    # --- lanes

    def zoom_all(self) -> None:
        self.show_panel().lanes.zoom_all()

    def zoom_selection(self) -> None:
        self.show_panel().lanes.zoom_selection()

    def toggle_snapping(self) -> None:
        self.panel.magnet.toggle()

    def toggle_ripple(self) -> None:
        self.panel.ripple.toggle()

    def ripples(self) -> bool:
        return self.requests.ripple

    def toggle_lock(self) -> None:
        self.noted.lock(self.session.place.layer, not self.is_locked())

    def is_locked(self) -> bool:
        """Whether the requests of the layer that is edited are locked."""
        return self.session.place.layer in self.noted.now.locked

    def size_lane(self, factor: float) -> None:
        """Make the lane of the layer that is edited taller or lower."""
        titles, lane = self.show_panel().lanes.titles, self.session.place.layer
        titles.size(lane, titles.view.sizes.factor(lane) * factor)

    # --- what plays

    def cut_automatically(self) -> None:
        talk = self.document.project.conversations.get(self.performance.conversation or "")
        if talk is not None:
            self.noted.automatic(talk)
            self.shell.show("timeline")

    def toggle_captions(self) -> None:
        self.noted.show_captions(not self.shows_captions())

    def shows_captions(self) -> bool:
        return self.noted.now.captions

    def toggle_other_seeds(self) -> None:
        self.panel.ghosts.toggle()

    def try_other_seeds(self) -> None:
        self.panel.what_if.others()

    def copy_requests(self) -> None:
        self.requests.to_clipboard(self.session.onstage.requests)

    def paste_requests(self) -> None:
        self.requests.paste()

    def withdraw_requests(self) -> None:
        self.requests.withdraw(*self.session.onstage.requests)

    def toggle_live(self) -> None:
        if self.is_live():
            self.live.end()
        else:
            self.live.begin()
        self.shell.show("timeline")

    def is_live(self) -> bool:
        return self.live.stage is not None


def is_performance_shown(feature: TimelineFeature) -> bool:
    """Whether the timeline is a performance's, and no clip's or action's that is looked at alone."""
    return feature.transport.show == "plan"


def is_snapping(feature: TimelineFeature) -> bool:
    return QSettings().value("timeline/magnet", "true") != "false"


def is_conversation_performed(feature: TimelineFeature) -> bool:
    return feature.performance.conversation is not None


def has_kept_requests(feature: TimelineFeature) -> bool:
    return feature.requests.kept is not None


def has_requests_selected(feature: TimelineFeature) -> bool:
    return bool(feature.session.onstage.requests)


def has_marker_selected(feature: TimelineFeature) -> bool:
    return feature.noted.selected is not None


def _command(
    ident: str, group: str, text: str, run: Callable[..., object], keys: tuple[str, ...] = (), **more: Any
) -> Command:
    return Command(ident, "&Play", group, text, run, keys, when="meta", **{"enabled": has_skeleton, **more})


performing = require_all(has_skeleton, is_performance_shown)
COMMANDS = (
    _command(
        "range_in",
        "range",
        tr_noop("Set loop start &here"),
        TimelineFeature.begin_range,
        ("I",),
        tip=tr_noop(
            "The part between the loop's start and end repeats. You can also write only this part to a file."
        ),
        enabled=performing,
    ),
    _command(
        "range_out",
        "range",
        tr_noop("Set loop &end here"),
        TimelineFeature.end_range,
        ("O",),
        tip=tr_noop(
            "The part between the loop's start and end repeats. You can also write only this part to a file."
        ),
        enabled=performing,
    ),
    _command(
        "range_clear",
        "range",
        tr_noop("&Clear loop range"),
        TimelineFeature.clear_range,
        ("Ctrl+Shift+X",),
        enabled=performing,
    ),
    _command(
        "marker",
        "markers",
        tr_noop("Add &marker"),
        TimelineFeature.add_marker,
        ("Ctrl+Alt+M",),
        tip=tr_noop("A named moment at the playhead. On the timeline, press M."),
        enabled=performing,
    ),
    _command(
        "marker_next", "markers", tr_noop("&Next marker"), TimelineFeature.go_to_next_marker, ("Shift+M",)
    ),
    _command(
        "marker_before",
        "markers",
        tr_noop("&Previous marker"),
        TimelineFeature.go_to_previous_marker,
        ("Ctrl+Shift+M",),
    ),
    _command(
        "timeline_all",
        "timeline",
        tr_noop("Zoom the timeline to &all"),
        TimelineFeature.zoom_all,
        ("Shift+Z",),
    ),
    _command(
        "timeline_selection",
        "timeline",
        tr_noop("&Zoom the timeline to the selection"),
        TimelineFeature.zoom_selection,
        ("Z",),
        tip=tr_noop("Shows the selected requests or action, or the loop range if nothing is selected"),
    ),
    _command(
        "timeline_snap",
        "timeline",
        tr_noop("&Snap on the timeline"),
        TimelineFeature.toggle_snapping,
        ("S",),
        checked=is_snapping,
    ),
    _command(
        "timeline_ripple",
        "timeline",
        tr_noop("&Ripple on the timeline"),
        TimelineFeature.toggle_ripple,
        ("Shift+R",),
        checked=TimelineFeature.ripples,
        tip=tr_noop("Moving a request also moves everything after it"),
    ),
    _command(
        "lock_layer",
        "timeline",
        tr_noop("&Lock the layer's requests"),
        TimelineFeature.toggle_lock,
        ("Shift+K",),
        tip=tr_noop("Protects the requests of the current layer from being moved or removed"),
        checked=TimelineFeature.is_locked,
    ),
    _command(
        "lane_taller",
        "timeline",
        tr_noop("Taller lane"),
        partial(TimelineFeature.size_lane, factor=TALLER),
        ("Alt+Shift+Up",),
    ),
    _command(
        "lane_lower",
        "timeline",
        tr_noop("Shorter lane"),
        partial(TimelineFeature.size_lane, factor=1 / TALLER),
        ("Alt+Shift+Down",),
    ),
    _command(
        "automatic_cuts",
        "timeline",
        tr_noop("A&utomatic cuts"),
        TimelineFeature.cut_automatically,
        ("Ctrl+Shift+U",),
        tip=tr_noop("The camera cuts to the person who speaks in the conversation on stage"),
        enabled=is_conversation_performed,
    ),
    _command(
        "captions",
        "timeline",
        tr_noop("&Captions"),
        TimelineFeature.toggle_captions,
        ("Shift+C",),
        tip=tr_noop("Show the spoken words at the bottom of the picture"),
        checked=TimelineFeature.shows_captions,
    ),
    _command(
        "what_if",
        "timeline",
        tr_noop("Compare other seed&s"),
        TimelineFeature.toggle_other_seeds,
        ("Shift+W",),
        tip=tr_noop("Show what three other seeds would play, in rows under the lanes. Click one to use it."),
    ),
    _command(
        "what_if_others",
        "timeline",
        tr_noop("Compare three &more seeds"),
        TimelineFeature.try_other_seeds,
        tip=tr_noop("Show the next three seeds in the rows under the lanes"),
    ),
    _command(
        "requests_copy",
        "timeline",
        tr_noop("Copy re&quests"),
        TimelineFeature.copy_requests,
        tip=tr_noop(
            "Copies them as text that you can also paste into another window. Ctrl+C on the timeline."
        ),
        enabled=require_all(has_kept_requests, has_requests_selected),
    ),
    _command(
        "requests_paste",
        "timeline",
        tr_noop("Paste requests at the p&layhead"),
        TimelineFeature.paste_requests,
        tip=tr_noop("Ctrl+V on the timeline"),
    ),
    _command(
        "live",
        "live",
        tr_noop("Li&ve"),
        TimelineFeature.toggle_live,
        ("Ctrl+L",),
        tip=tr_noop("Let other programs on this computer control the character"),
        checked=TimelineFeature.is_live,
    ),
)
