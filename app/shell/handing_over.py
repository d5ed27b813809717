"""Replace an old window by a new one with the same project, undo steps, file, selection and place."""

from __future__ import annotations

from PySide6.QtCore import Qt

from app.shell.window import Window
from app.stage.session import StageSession
from app.translation import tr


def describe_running(window: Window) -> str:
    """Return a message about what would end if a window were replaced now, "" if nothing would."""
    if window.shell.jobs.running:
        title = window.shell.jobs.running[0].title
        return tr("The language changes once '{job}' has finished.", job=title)
    if window.shell.stage.performance.live.stage is not None:
        return tr("The language changes once the live session has ended.")
    return ""


def replace_window(old: Window, new: Window) -> None:
    """Show `new` instead of `old`, with everything that the user did and sees in it; `old` is closed."""
    new.restoreGeometry(old.saveGeometry())
    new.shell.document.take_over(old.shell.document)
    new.shell.files.opened.emit()
    _copy_session(old.shell.stage.session, new.shell.stage.session)
    new.show()
    if old.isActiveWindow():  # the keyboard goes on, too
        new.activateWindow()
    new.load_late_panels_soon()
    old.replaced = True
    old.close()
    old.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    old.deleteLater()


def _copy_session(old: StageSession, new: StageSession) -> None:
    new.set_mode(old.onstage.mode)
    new.place.stances.update(old.place.stances)
    new.place.others.update(old.place.others)
    new.place.set_layer(old.place.layer)
    new.place.stance_changed.emit()
    new.onstage.set_performance(old.onstage.performance)
    new.onstage.set_conversation(old.onstage.conversation)
    new.onstage.set_side(old.onstage.side)
    chosen = old.selection
    if chosen.states or chosen.links:
        new.selection.select_states(chosen.states, chosen.links)
    elif chosen.actions:
        new.selection.select_actions(chosen.actions)
    else:
        new.selection.select_clips(chosen.clips)
    new.selection.copied = chosen.copied
    was, now = old.transport, new.transport
    if was.show == "clip" and was.shown is not None:
        now.show_clip(was.shown)
    elif was.show == "context" and was.shown is not None:
        now.show_context(was.shown, was.tried)
    now.set_playing(was.playing)
    now.seek(was.seconds)
