"""How each dialog is opened, in a window on the sample project: for what must hold for all of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QDialog

from metagraph.formats.bvh.file import write_bvh
from metagraph.graph import edits, requests
from tests.app.handles import Handles

ROOT = Path(__file__).resolve().parents[2] / "sample_clips"
Open = Callable[[Handles, Path], object]  # the window, and a folder for what has to be written first


def _command(name: str) -> Open:
    return lambda w, _: w.do(name)


def _compare(w: Handles, _: Path) -> None:
    from app.features.files.compare_dialog import CompareDialog, OtherVersion

    now = w.document.project
    then = OtherVersion("then", lambda: edits.remove_actions(now, [next(now.actions()).id]), ROOT)
    CompareDialog(now, (then,), w.shell.jobs, ROOT, w.window).open()


def _actions(w: Handles, count: int = 2) -> tuple[str, ...]:
    chosen = tuple(a.id for a in w.document.project.actions() if a.kind == "gesture")[:count]
    w.session.selection.select_actions(chosen)
    return chosen


def _on_actions(name: str) -> Open:
    return lambda w, _: (_actions(w), w.do(name))


def _label(w: Handles, _: Path) -> None:
    if not w.actions["propose"].isEnabled():  # every clip is placed
        w.document.edit("Remove", lambda p: edits.remove_actions(p, _actions(w, 1)))
    w.do("propose")


def _paste(w: Handles, _: Path) -> None:
    _actions(w, 1)
    w.do("copy")
    _actions(w)
    w.do("paste")


def _joints(w: Handles, _: Path) -> None:
    _actions(w)
    w.properties.action.joints.click()


def _state_joints(w: Handles, _: Path) -> None:
    from app.features.manual.manual_mask import StateMask
    from metagraph.graph.manual import edits as manual_edits

    layer = w.session.place.layer
    if not w.document.project.manual.get(layer) or not w.document.project.manual[layer].states:
        w.document.edit("Add state", lambda p: manual_edits.add_states(p, [next(iter(p.clips))], layer))
    w.session.set_mode("manual")
    w.session.selection.select_states(tuple(w.document.project.manual[layer].states)[:1])
    StateMask(w.document, w.session, w.editor).open()
    w.session.set_mode("meta")


def _request(w: Handles, _: Path) -> None:
    from app.features.timeline.request_editor import RequestEditor

    w.performance.requests.ask(requests.Gesture(at=2.0), "Ask for a gesture")
    ident = w.performance.asks[-1].id
    RequestEditor(w.performance, ident, w.timeline.lanes).open()


def _point(w: Handles, _: Path) -> None:
    from app.widgets.point_editor import PointEditor

    PointEditor(w.document, lambda name: None, w.timeline).open()


def _talk(name: str) -> Open:
    def open_it(w: Handles, _: Path) -> None:
        w.session.onstage.set_conversation(next(iter(w.document.project.conversations)))
        w.do(name)

    return open_it


def _new_talk(w: Handles, _: Path) -> None:
    from app.features.conversation.conversation_commands import ask_for_conversation

    ask_for_conversation(w.shell, [ROOT / "conversation" / "talk.ogg", ROOT / "conversation" / "talk.json"])


def _annotation(w: Handles, _: Path) -> None:
    from app.features.models.annotation_dialog import open_annotation

    open_annotation(w.shell, "sample")


def _keypoints(w: Handles, _: Path) -> None:
    from app.features.mimic.mimic_dialog import open_keypoints

    open_keypoints(w.shell, ROOT / "keypoints" / "conversation.openpose.json")


def _study(w: Handles, _: Path) -> None:
    from app.features.study.study_chooser import run_study

    run_study(w.shell, ROOT / "study" / "study.yaml")


def _note(w: Handles, _: Path) -> None:
    from app.features.study.study_note import NoteDialog

    NoteDialog(False, w.window).open()


def _joint_map(w: Handles, folder: Path) -> None:
    from tests.conftest import Toy

    path = folder / "stranger.bvh"
    write_bvh(Toy().clip("stranger"), path)
    w.importing.import_paths([str(path)])


def _report(w: Handles, _: Path) -> None:
    w.importing.report.emit("Two files were not read", ("one.bvh: empty", "two.bvh: empty"))


def _take(w: Handles, folder: Path) -> None:
    from app.features.taking.taking_dialog import TakingDialog
    from app.look.theme import get_theme
    from metagraph.formats.project.pieces import read_other_project

    piece = read_other_project(ROOT / "seated.metagraph.yaml", None)
    TakingDialog(w.document, w.shell.jobs, piece, "seated", get_theme("dark"), w.window).open()


def _recover(w: Handles, _: Path) -> None:
    from app.project.leftovers import FoundJournal
    from app.project.recovering import RecoverDialog
    from metagraph.formats.recovery import Left

    p = w.document.project
    left = [Left(Path(str(n)), p, n, None, 1e9 * n, "", n == 1, {}, 0, (), n == 2) for n in (1, 2, 3)]
    found = FoundJournal(None, None, tuple(left), ("a journal: is damaged",))
    dialog = RecoverDialog(found, None, w.window)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)  # as whoever asks does
    dialog.open()


def _fault(w: Handles, _: Path) -> None:
    from app.shell.fault_dialog import FaultDialog

    dialog = FaultDialog(w.window)
    dialog.say("Something went wrong", "Something in the window failed.", "Metagraph 0.1.0")
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.open()


# By name; those that read something first open a little later.
DIALOGS: dict[str, Open] = {
    "extras": _command("extras"),
    "news": _command("news"),
    "export": _command("export"),
    "compare": _compare,
    "label": _label,
    "patterns": _command("patterns"),
    "compatibility": _command("compatibility"),
    "motion graph": _command("motion_graph"),
    "generate motion": _command("generate_motion"),
    "skeleton": _command("skeleton"),
    "meshes": _command("meshes"),
    "render": _command("render"),
    "repairs": _command("repairs"),
    "keys": _command("keys"),
    "palette": _command("palette"),
    "rename": _on_actions("rename"),
    "replace clip": _on_actions("replace_clip"),
    "paste": _paste,
    "joints": _joints,
    "joints of a state": _state_joints,
    "request": _request,
    "point": _point,
    "conversation": _new_talk,
    "annotation": _annotation,
    "keypoints": _keypoints,
    "rates": _talk("rates"),
    "word lists": _talk("word_lists"),
    "sides' sounds": _talk("side_sounds"),
    "study": _study,
    "note": _note,
    "joint map": _joint_map,
    "take": _take,
    "report": _report,
    "recover": _recover,
    "fault": _fault,
}


def opened() -> list[QDialog]:
    """Return the dialogs that are on the screen."""
    return [w for w in QApplication.topLevelWidgets() if isinstance(w, QDialog) and w.isVisible()]
