"""Take the pictures of the documentation from the real window: `python docs/pictures.py` (on a screen, or
under `xvfb-run`).

Writes into docs/images: screens/*.webp, timing.png, practice.png, empty.png, light.png, requests.png,
models.png, label.png, characters.png, export.png, parameters.png, web.png, conversation.png,
motion-graph.png, performance.png, props.png and at-a-desk.png, from our own sample clips only; with names
behind it, only those. The screen has to be larger than 2560 x 1440. The web page needs Node, Chromium and
what tests/package.json names.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from PySide6.QtCore import QEventLoop, QSettings, QStandardPaths, Qt, QTimer  # noqa: E402

from app.main import prepare_application  # noqa: E402


def wait(milliseconds: int, until: Callable[[], bool] | None = None) -> None:
    """Let the window live for a while, or until something is so."""
    loop, timer = QEventLoop(), QTimer()
    timer.timeout.connect(lambda: loop.quit() if until is not None and until() else None)
    timer.start(50)
    QTimer.singleShot(milliseconds, loop.quit)
    loop.exec()


def window(theme: str = "dark") -> Any:
    from app.main import make_window
    from tests.app.handles import Handles

    QSettings().clear()
    out = Handles(make_window())
    out.window.resize(1680, 1020)
    out.session.look.choose(theme)  # type: ignore[arg-type]
    out.window.show()
    out.make_late_panels()
    wait(1500)
    return out


def shoot(shown: Any, name: str) -> None:
    shown.grab().save(str(ROOT / "docs" / "images" / name))
    print(f"docs/images/{name}")


def close(out: Any) -> None:
    out.document.undo_stack.setClean()
    out.window.close()
    wait(100)


SCALE = "QT_SCALE_FACTOR"
SIZES = ((1280, 720), (1680, 1050), (2560, 1440))
THEMES = ("dark", "light")
TALKING = 5.4  # seconds of the sample's conversation at which both can be seen to take part


def on_sample(theme: str = "dark", size: tuple[int, int] = (1680, 1020)) -> Any:
    """Return a window on the sample project, everything read."""
    from app.project.files import SAMPLE

    out = window(theme)
    out.window.resize(*size)
    out.files.open(SAMPLE, template=True)
    wait(20000, lambda: bool(out.document.project.clips))
    wait(5000)
    return out


def selected(out: Any, name: str) -> Any:
    """Select an action of the sample by its name and return it."""
    found = next(a for a in out.document.project.actions() if a.name == name)
    out.session.jump(action=found.id)
    return found


def still_in_gesture(out: Any, layer: str) -> None:
    """Stop the performance in the middle of a gesture of a layer."""
    out.session.transport.show_plan()
    out.session.transport.set_playing(False)
    wait(4000, lambda: out.performance.shown.clip is None)
    cues = out.performance.shown.plan.layers[layer].cues
    cue = next((c for c in cues if c.action.kind == "gesture" and c.end - c.start > 2), cues[0])
    out.session.transport.seek((cue.start + cue.end) / 2)


def finished(name: str, theme: str, machine: bool, action: str) -> None:
    """The sample project with an action selected and playing."""
    out = on_sample(theme)
    found = selected(out, action)
    out.session.transport.show_plan()
    if machine:
        out.show("machine")
    wait(4000)
    still_in_gesture(out, found.layer)
    wait(4000)
    shoot(out.window, name)
    close(out)


def screens() -> None:
    """The five workspaces in both themes: at three sizes, and at the least on a screen twice as fine."""
    twice = os.environ.get(SCALE) == "2"
    for theme in THEMES:
        out = on_sample(theme)
        found = selected(out, "shrug_bt_01")
        for size in SIZES[:1] if twice else SIZES:
            out.window.resize(*size)
            for tab in out.workspaces.tabs:
                out.workspaces.choose(tab.id)
                on_stage(out, tab.id, found.layer)
                keep_screen(out, f"{tab.id}-{size[0]}x{size[1]}{'-twice' if twice else ''}-{theme}")
        close(out)
    if not twice:
        again = [sys.executable, __file__, "screens"]
        subprocess.run(again, env={**os.environ, SCALE: "2"}, check=True)


def on_stage(out: Any, workspace: str, layer: str) -> None:
    """Put two who talk on the stage of *Talk*, a gesture on the others'."""
    talk = next(iter(out.document.project.conversations)) if workspace == "talk" else None
    if out.session.onstage.conversation != talk:
        out.session.onstage.set_conversation(talk)
        both = talk is not None
        wait(20000, lambda: bool(out.performance.shown.others) == both and not out.jobs.running)
    if talk is not None:
        out.session.transport.set_playing(False)
        out.session.transport.seek(TALKING)
    else:
        still_in_gesture(out, layer)


def keep_screen(out: Any, name: str) -> None:
    """Write a picture of the whole window, once all pictures in it are there, small enough to keep many."""
    from PIL import Image

    wait(1500)
    wait(60000, lambda: not out.thumbnails.waiting and not out.jobs.running)
    wait(700)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "whole.png"
        out.window.grab().save(str(path))
        with Image.open(path) as whole:
            whole.convert("RGB").save(
                ROOT / "docs" / "images" / "screens" / f"{name}.webp", quality=80, method=6
            )
    print(f"docs/images/screens/{name}.webp")


def timing() -> None:
    """The timing editor, with a hold, a kept hand, a line and onion skin."""
    from metagraph.graph.editing.retiming import keep_hand, set_hold

    out = on_sample(size=(1680, 1050))
    found = selected(out, "shrug_bt_01")
    out.document.edit("Hold", lambda p: set_hold(p, found.clip, 0.95, 0.4))
    out.document.edit("Pin hand", lambda p: keep_hand(p, found.clip, "right", 0.6, 0.95))
    out.workspaces.choose("time")
    subject = out.shell.panel("timing").subject
    subject.show(onion=True, dope=True, heard=next(iter(out.document.project.lines)))
    out.session.transport.scrub(found.clip, 0.62)
    wait(20000, lambda: bool(subject.film(found.id)) and not out.jobs.running)
    wait(3000)
    shoot(out.window, "timing.png")
    close(out)


def half_labelled() -> None:
    """The practice project with a part of its clips placed, two holes and a misfit left to see."""
    from app.project.files import PRACTICE
    from metagraph.graph import edits

    out = window()
    out.files.open(PRACTICE, template=True)
    document, session = out.document, out.session
    wait(20000, lambda: bool(document.project.clips))
    ids = {e.name: e.id for e in document.project.clips.values()}

    def put(kind: str, stance: str, names: list[str], end: str | None = None) -> None:
        document.edit(
            "Place", lambda p: edits.place_clips(p, [ids[n] for n in names], "arms", kind, stance, end)
        )

    for name in ("hands_at_sides", "arms_crossed", "on_hips"):
        document.edit(
            "New stance",
            lambda p, n=name: edits.add_stance(p, "arms", n.replace("_", " "), [ids[f"{n}__stance"]]),
        )
    sides, crossed, hips = list(document.project.graphs["arms"].stances)
    taken = [
        n for n in ids if n.startswith("hands_at_sides__") and not n.endswith("stance") and "__to__" not in n
    ]
    put("gesture", sides, taken[:9])
    put("fidget", sides, [n for n in ids if "check_watch" in n or "flick_fingers" in n])
    put("transition", sides, ["hands_at_sides__to__arms_crossed"], crossed)
    put("transition", sides, ["hands_at_sides__to__on_hips"], hips)
    put(
        "gesture",
        crossed,
        [n for n in ids if n.startswith("arms_crossed__") and "__to__" not in n and "stance" not in n][:3],
    )
    put("transition", crossed, ["arms_crossed__to__hands_at_sides"], sides)
    document.edit(
        "Place",
        lambda p: edits.place_clips(p, [ids["on_hips__to__hands_at_sides"]], "arms", "gesture", sides),
    )  # a mistake to find
    session.place.set_stance(sides)
    out.library.chips["unlabelled"].click()
    out.show("problems")
    wait(9000)
    shoot(out.window, "practice.png")
    close(out)


def requests() -> None:
    """The lanes of a performance: requests, what plays, one that is late and one that cannot."""
    from metagraph.graph import requests as a

    out = on_sample()
    stage, session = out.performance, out.session
    session.transport.set_playing(False)
    for ask in (
        a.Say(text="Well, I would not say so. But who knows?", at=1.0),
        a.Gesture(tags=("negative",), at=1.4, priority=2),
        a.Go(stance="on hips", at=4.0),
        a.Look(to="user", at=4.5),
        a.Nod(at=6.0),
        a.Gesture(tags=("greeting",), at=8.0),
        a.Gesture(tags=("positive",), at=10.0),
        a.Play(action="shrug_bt_01", at=11.5),
        a.Go(stance="weight left", at=7.0),
    ):
        stage.requests.ask(ask)
    session.onstage.select_requests(())
    session.transport.seek(2.0)
    wait(4000)
    out.show("timeline")
    wait(500)
    out.timeline.grab().save(str(ROOT / "docs" / "images" / "requests.png"))
    print("docs/images/requests.png")
    close(out)


def models() -> None:
    """The heat map of a model learned from our own annotation, beside what it generates."""
    from app.features.models.annotation_dialog import open_annotation

    out = on_sample()
    open_annotation(
        out, ROOT / "sample_clips" / "annotation" / "conversation.eaf", lambda dialog: dialog.accept()
    )  # type: ignore[arg-type]
    wait(8000, lambda: "arms" in out.document.project.markov)
    out.session.place.set_layer("arms")
    out.show("models")
    out.window.resizeDocks([out.docks["models"]], [420], Qt.Orientation.Vertical)
    wait(3000)
    out.models.grab().save(str(ROOT / "docs" / "images" / "models.png"))
    print("docs/images/models.png")
    close(out)


def parameters() -> None:
    """The panel of parameters with a control of each kind."""
    from metagraph.graph.editing.parameters import list_offered_parameters

    out = on_sample()
    out.show("parameters")
    panel = out.shell.panel("parameters")
    names = ("mood", "energy", "looks_at", "attention", "arms_stance", "speaking", "greeting", "nod")
    offered = {one.name: one for one in list_offered_parameters(out.document.project)}
    for name in names:
        panel.add(offered[name])
    panel.controls["energy"].number.setValue(1.4)
    wait(1500)
    whole = panel.rows.parentWidget()
    whole.resize(620, whole.sizeHint().height())
    wait(300)
    whole.grab().save(str(ROOT / "docs" / "images" / "parameters.png"))
    print("docs/images/parameters.png")
    close(out)


def exporting() -> None:
    """The export dialog, on a target that loses something."""
    from app.features.export.export_dialog import ExportDialog

    out = on_sample()
    dialog = ExportDialog(out.document, out.jobs, out.window)
    dialog.open()
    dialog._select("playcanvas")
    dialog.folder.setText("game/playcanvas")
    wait(60000, lambda: "MB in" in dialog.sized.text())
    shoot(dialog, "export.png")
    dialog.reject()
    close(out)


def characters() -> None:
    """The gallery of characters, over the sample."""
    from app.features.character.character_gallery import CharacterGallery

    out = on_sample()
    out.do("character")
    gallery = out.window.findChild(CharacterGallery)
    gallery.resize(760, 400)
    wait(20000, gallery.is_drawn)
    wait(300)
    shoot(gallery, "characters.png")
    gallery.close()
    close(out)


def labelling() -> None:
    """A clip of the practice project under review."""
    from app.features.labelling.review_dialog import ReviewDialog
    from app.project.files import PRACTICE

    out = window()
    out.files.open(PRACTICE, template=True)
    wait(20000, lambda: bool(out.document.project.clips))
    out.do("propose")
    dialog = out.window.findChildren(ReviewDialog)[-1]
    wait(20000, lambda: dialog.current is not None)
    dialog.accept_sure()
    dialog.undo()
    clip = next(c for c, e in out.document.project.clips.items() if e.name == "hands_at_sides__to__on_hips")
    for _ in range(6):
        dialog.accept_current()
    dialog.go_to(clip)
    wait(20000, lambda: dialog.stage.shown is not None and clip in dialog.stage.shown.project.uses)
    dialog.stage.step(1.6)
    wait(600)
    shoot(dialog, "label.png")
    dialog.reject()
    close(out)


def conversation() -> None:
    """Two who talk, on their lanes."""
    out = on_sample()
    out.show("conversation")
    on_stage(out, "talk", "arms")
    wait(2500)
    out.window.statusBar().clearMessage()  # a machine without a sound device says so
    shoot(out.window, "conversation.png")
    close(out)


def motion_graph() -> None:
    """What counts as a jump between the sample's stances, and new motion from them."""
    from app.features.motion_graph.motion_graph_dialog import MotionGraphDialog
    from metagraph.formats.project.paths import make_paths_absolute
    from metagraph.formats.store import open_project, save_project

    samples = ROOT / "sample_clips"
    out = window()
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "sample.metagraph.yaml"
        save_project(
            make_paths_absolute(open_project(samples / "sample.metagraph.yaml").project, samples), path
        )
        out.files.open(path)
        wait(20000, lambda: bool(out.document.project.clips) and not out.jobs.running)
        out.do("motion_graph")
        dialog = out.window.findChild(MotionGraphDialog)
        wait(20000, lambda: dialog.limit is not None)
        dialog.count()
        wait(60000, lambda: not dialog.stop.isVisible())
        dialog.wishes.speech.setCurrentIndex(0)
        dialog.find_motion()
        wait(60000, lambda: not dialog.stop.isVisible())
        wait(1500)
        shoot(dialog, "motion-graph.png")
        dialog.close()
        close(out)


def page() -> None:
    """The web page, in a browser, having been asked to wave."""
    from metagraph.engines.targets import registry, web
    from metagraph.engines.targets.target import Contents
    from metagraph.formats.store import open_project

    samples = ROOT / "sample_clips"
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        web.tools = lambda folder: ROOT / "tests" / "node_modules"  # type: ignore[assignment]
        project = open_project(samples / "sample.metagraph.yaml").project
        registry.write_for_target(project, "web", folder, Contents(samples / "ada.glb", base=samples))
        steps = [
            {"url": "?seed=7&paused&panel", "until": "window.metagraph"},
            {"click": "#panel button:text-is('greeting') >> nth=0"},
            {"run": "metagraph.seek(0.3)"},
            {"click": "#panel button:text-is('arms crossed')"},
            {"click": "#panel button:text-is('question') >> nth=1"},
            {"run": "metagraph.seek(1.35)"},
            {"wait": 300},
            {"shot": str(ROOT / "docs" / "images" / "web.png")},
        ]
        (folder / "steps.json").write_text(json.dumps(steps))
        script = ROOT / "tests" / "engines" / "run" / "browser.mjs"
        subprocess.run(
            ["node", str(script), str(folder), str(folder / "steps.json")],
            check=True,
            stdout=subprocess.DEVNULL,
        )
    print("docs/images/web.png")


def performance() -> None:
    """A contact sheet of a performance."""
    from app.cli.parser import main as command

    sample = str(ROOT / "sample_clips" / "sample.metagraph.yaml")
    out = str(ROOT / "docs" / "images" / "performance.png")
    command(["render", sample, "-s", "46", "--seed", "7", "-o", out, "--overwrite"])


def props() -> None:
    """Who sits at a desk, with the panel that says how well it fits; and two who talk at one, filmed."""
    from app.cli.parser import main as command
    from metagraph.formats.store import save_project
    from sample_clips.make.at_a_desk import make_desk_talk

    with tempfile.TemporaryDirectory() as place:
        project = Path(place) / "desk.metagraph.yaml"
        save_project(make_desk_talk(), project)
        out = str(ROOT / "docs" / "images" / "at-a-desk.png")
        command(
            ["render", str(project), "--conversation", "talk", "--start", "16.6", "-s", "1", "--frames", "1",
             "--size", "1280x720", "--theme", "light", "--depth-of-field", "--no-captions", "--cuts",
             "-o", out, "--overwrite"]
        )  # fmt: skip
        out = window()
        out.files.open(project)
        wait(8000, lambda: out.performance.shown.skeleton is not None)
        out.window.resize(1680, 1020)
        out.show("props")
        wait(4000)
        panel = out.panel("props")
        (desk,) = (i for i, prop in out.document.project.props.items() if prop.name == "desk")
        panel.choose(desk)
        wait(2500)
        out.window.statusBar().clearMessage()
        shoot(out.window, "props.png")
        close(out)


def nothing() -> None:
    """The window before anything is in it."""
    out = window()
    shoot(out.window, "empty.png")
    close(out)


PICTURES: dict[str, Callable[[], None]] = {
    "empty": nothing,
    "light": lambda: finished("light.png", "light", True, "beat_large_bt_01"),
    "screens": screens,
    "timing": timing,
    "practice": half_labelled,
    "requests": requests,
    "models": models,
    "label": labelling,
    "characters": characters,
    "export": exporting,
    "parameters": parameters,
    "conversation": conversation,
    "motion-graph": motion_graph,
    "web": page,
    "performance": performance,
    "props": props,
}


def main() -> None:
    QStandardPaths.setTestModeEnabled(True)
    app = prepare_application()
    with tempfile.TemporaryDirectory() as folder:
        QSettings.setDefaultFormat(QSettings.Format.IniFormat)
        QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, folder)
        for name in sys.argv[1:] or PICTURES:
            PICTURES[name]()
    app.quit()


if __name__ == "__main__":
    main()
