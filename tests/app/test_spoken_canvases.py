"""The canvases of the real window, as screen readers report them: by Qt, and over AT-SPI."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAccessible
from PySide6.QtWidgets import QWidget

from app.widgets.spoken_items import FRESH
from metagraph.graph.manual import edits as manual_edits
from metagraph.graph.requests import Gesture

pytestmark = [pytest.mark.window, pytest.mark.gl]
ROOT = Path(__file__).resolve().parents[2]
LAUNCHER = Path("/usr/libexec/at-spi-bus-launcher")


def names(drive, canvas: QWidget) -> list[str]:
    drive.pause(int(FRESH * 1000) + 30)
    found = QAccessible.queryAccessibleInterface(canvas)
    return [found.child(n).text(QAccessible.Text.Name) for n in range(found.childCount())]


def test_the_graph_tells_its_stances_and_actions_and_which_has_the_focus(toys):
    drive = toys
    drive.session.place.set_stance(drive.id("rest"))
    found = names(drive, drive.canvas)
    assert found[:5] == ["Stance: rest", "Stance: up", "Stance: far", "New stance", "rest, its loops"]
    assert "Gesture: beat L" in found and "Transition" in found
    drive.canvas.setFocus()
    drive.key(Qt.Key.Key_Down, widget=drive.canvas)
    drive.pause(int(FRESH * 1000) + 30)
    focused = QAccessible.queryAccessibleInterface(drive.canvas).focusChild()
    assert focused.text(QAccessible.Text.Name).startswith("Gesture: ") and focused.state().selected
    assert "Likelihood 1" in focused.text(QAccessible.Text.Description)


def test_the_timeline_tells_requests_and_what_plays(toys):
    drive = toys
    drive.workspaces.show("timeline")
    drive.wait(lambda: bool(drive.performance.shown.plan.layers["arms"].cues))
    drive.performance.requests.ask(Gesture(at=2.0, layer="arms"))
    drive.wait(lambda: bool(drive.timeline.lanes.marks()))
    found = names(drive, drive.timeline.lanes)
    assert any(name.startswith("Arms: ") for name in found)
    assert sum(name.startswith("Request at 2.00 s: ") for name in found) == 1


def test_a_machine_drawn_by_hand_tells_states_and_links(toys):
    drive = toys
    clips = list(drive.document.project.clips)[:2]
    drive.document.edit("Add", lambda p: manual_edits.add_states(p, clips, "arms"))
    states = list(drive.document.project.manual["arms"].states.values())
    drive.document.edit("Link", lambda p: manual_edits.add_link(p, "arms", states[0].id, states[1].id))
    drive.session.place.set_layer("arms")
    drive.session.set_mode("manual")
    found = names(drive, drive.editor.canvas)
    assert f"State: {states[0].name}" in found
    assert f"Link: {states[0].name} to {states[1].name}" in found


READER = """
import sys, time
from gi.repository import Gio, GLib
bus = Gio.bus_get_sync(Gio.BusType.SESSION, None)
place = bus.call_sync("org.a11y.Bus", "/org/a11y/bus", "org.a11y.Bus", "GetAddress", None, None, 0, -1, None).unpack()[0]
flags = Gio.DBusConnectionFlags
line = Gio.DBusConnection.new_for_address_sync(
    place, flags.AUTHENTICATION_CLIENT | flags.MESSAGE_BUS_CONNECTION, None, None)
ONE = "org.a11y.atspi.Accessible"
def ask(whose, path, what, method, given=None):
    return line.call_sync(whose, path, what, method, given, None, 0, 20000, None).unpack()
def walk(whose, path, deep=0):
    role = ask(whose, path, ONE, "GetRoleName")[0]
    name = ask(whose, path, "org.freedesktop.DBus.Properties", "Get", GLib.Variant("(ss)", (ONE, "Name")))[0]
    print(f"{role}|{name}", flush=True)
    if deep < 14:
        for child in ask(whose, path, ONE, "GetChildren")[0]:
            walk(*child, deep + 1)
for _ in range(240):
    found = ask("org.a11y.atspi.Registry", "/org/a11y/atspi/accessible/root", ONE, "GetChildren")[0]
    if found: break
    time.sleep(0.25)
time.sleep(8)
for child in found: walk(*child)
"""
WINDOW = """
import sys
from PySide6.QtCore import QTimer
from app.main import open_window, prepare_application
app = prepare_application()
window = open_window(None, sample=True)
QTimer.singleShot(90000, app.quit)
app.exec()
"""
BOTH = """
"$1" --launch-immediately >/dev/null 2>&1 & bus=$!
QT_LINUX_ACCESSIBILITY_ALWAYS_ON=1 "$2" -c "$3" >/dev/null 2>&1 & window=$!
/usr/bin/python3 -c "$4"
kill $window $bus
"""


def reads_at_spi() -> bool:
    """Return whether this machine has AT-SPI and what asks it."""
    if (
        shutil.which("dbus-run-session") is None
        or not LAUNCHER.exists()
        or not Path("/usr/bin/python3").exists()
    ):
        return False
    tried = subprocess.run(["/usr/bin/python3", "-c", "from gi.repository import Gio"], capture_output=True)
    return tried.returncode == 0


@pytest.mark.nightly
@pytest.mark.skipif(not reads_at_spi(), reason="AT-SPI needs at-spi2-core, dbus and python3-gi")
def test_a_screen_reader_finds_stances_and_actions_over_at_spi(qapp, tmp_path):
    env = {**os.environ, "PYTHONPATH": str(ROOT), "CI": "true", "XDG_RUNTIME_DIR": str(tmp_path)}
    tmp_path.chmod(0o700)
    words = [
        "dbus-run-session",
        "--",
        "bash",
        "-c",
        BOTH,
        "both",
        str(LAUNCHER),
        sys.executable,
        WINDOW,
        READER,
    ]
    said = subprocess.run(
        words, env=env, capture_output=True, text=True, timeout=240, cwd=ROOT
    ).stdout.splitlines()
    assert "list|Meta-graph" in said, said[:40]
    assert any(line.startswith("page tab|Stance: ") for line in said)
    assert any(line.startswith("list item|Gesture: ") for line in said)
    assert "button|New stance" in said or "push button|New stance" in said
