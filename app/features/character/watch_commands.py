"""What helps to watch the character, as commands; and the same behind one button of the panel."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QFileDialog, QMenu

from app.project.jobs import Job
from app.shell.actions import Command
from app.shell.context import Shell
from app.stage.watch import MOST_GHOSTS, SPACINGS, Watch
from app.translation import tr, tr_error

if TYPE_CHECKING:
    from app.features.character.character_panel import PreviewPanel
    from app.features.character.reference import Reference

SHOWN = (
    ("feet", "hands_touch", "next_slide", "trails", "bones"),
    ("stance_ghost", "onion", "onion_skin"),
    ("two_views", "four_views"),
    ("light", "background"),
    ("reference", "no_reference"),
    ("meshes",),
)
GHOSTS = 2  # before and after, where onion skin is turned on by its key
AHEAD = 120.0  # seconds that are searched for a slide
PART = 240  # samples between two looks at whether to stop


def watch_commands(shell: Shell, preview: Callable[[], PreviewPanel]) -> tuple[Command, ...]:
    """Return the commands of the menu View."""
    watch, view = shell.stage.session.watch, "&View"

    def onion() -> None:
        on = watch.now.before or watch.now.after
        watch.set(before=0 if on else GHOSTS, after=0 if on else GHOSTS)

    return (
        Command(
            "feet",
            view,
            "watch",
            tr("Marks of the fee&t"),
            lambda: watch.set(feet=not watch.now.feet),
            ("Shift+G",),
            checked=lambda: watch.now.feet,
            tip=tr("Which foot is held (square), steps (diamond), is lifted (circle), and slides (triangle)"),
            study=True,
        ),
        Command(
            "hands_touch",
            view,
            "watch",
            tr("&Contacts of the hands"),
            lambda: watch.set(hands=not watch.now.hands),
            ("Shift+J",),
            checked=lambda: watch.now.hands,
            tip=tr("Where hands are kept: there (square), on the way (diamond), not reached (triangle)"),
            study=True,
        ),
        Command(
            "next_slide",
            view,
            "watch",
            tr("Next foot that sl&ides"),
            lambda: next_slide(shell),
            ("Ctrl+Shift+G",),
            tip=tr("Go to where a foot that stands slides next"),
            study=True,
        ),
        Command(
            "stance_ghost",
            view,
            "watch",
            tr("Ghost of the &stance"),
            lambda: watch.set(stance=not watch.now.stance),
            ("Shift+B",),
            checked=lambda: watch.now.stance,
            tip=tr("How the character would stand without what it plays"),
            study=True,
        ),
        Command(
            "onion",
            view,
            "watch",
            tr("&Onion skin"),
            onion,
            ("Shift+O",),
            checked=lambda: bool(watch.now.before or watch.now.after),
            tip=tr("Ghosts of moments before now, dark, and after it, light"),
            study=True,
        ),
        Command(
            "four_views",
            view,
            "watch",
            tr("Four &views"),
            lambda: watch.set(panes=1 if watch.now.panes == 4 else 4),
            ("Ctrl+Alt+Q",),
            checked=lambda: watch.now.panes == 4,
            tip=tr("As it was, and three sides beside it, at one time"),
            study=True,
        ),
        Command(
            "two_views",
            view,
            "watch",
            tr("T&wo views"),
            lambda: watch.set(panes=1 if watch.now.panes == 2 else 2),
            ("Ctrl+Alt+W",),
            checked=lambda: watch.now.panes == 2,
            tip=tr("As it was, and one side beside it, at one time"),
            study=True,
        ),
        Command(
            "reference",
            view,
            "watch",
            tr("Reference vi&deo…"),
            lambda: choose_reference(shell, preview().reference),
            ("Ctrl+Alt+R",),
            tip=tr("A video or a picture to compare with, beside the character or behind it"),
        ),
        Command(
            "no_reference",
            view,
            "watch",
            tr("Close the reference video"),
            lambda: preview().reference.close(),
            enabled=lambda: preview().reference.path is not None,
        ),
        Command("light", view, "watch", tr("Li&ght"), fill=lambda m: fill_choice(shell, m, "light")),
        Command(
            "background",
            view,
            "watch",
            tr("Back&ground"),
            fill=lambda m: fill_choice(shell, m, "background"),
        ),
        Command(
            "next_light",
            view,
            "watch",
            tr("Ne&xt light"),
            lambda: next_light(watch),
            ("Shift+L",),
            tip=tr("Studio, day, evening, rim, flat"),
            study=True,
        ),
        Command(
            "onion_skin",
            view,
            "watch",
            tr("Onion skin: ghosts and spac&ing"),
            fill=lambda m: fill_onion(shell, m),
        ),
    )


def choose_reference(shell: Shell, reference: Reference) -> None:
    """Ask which video the character is compared with."""
    from app.features.character.reference import FILES

    folder = reference.path.parent if reference.path is not None else shell.document.folder or Path.home()
    name, _ = QFileDialog.getOpenFileName(shell.widget, tr("Choose a reference video"), str(folder), FILES)
    if name:
        reference.choose(Path(name))


def fill_watch(shell: Shell, menu: QMenu) -> None:
    """Fill the menu of the panel's button: what is shown, and what of the character."""
    shell.actions.refresh()
    menu.clear()
    for group in SHOWN:
        for ident in group:
            menu.addAction(shell.actions[ident])
        menu.addSeparator()


def next_light(watch: Watch) -> None:
    """Light the character by the light that comes after this one, the first after the last."""
    from preview.looks import LIGHTS

    names = list(LIGHTS)
    watch.set(light=names[(names.index(watch.now.light) + 1) % len(names)])


def fill_choice(shell: Shell, menu: QMenu, name: str) -> None:
    """Fill a menu of lights or backgrounds. name: of `Watched`."""
    from preview.looks import BACKDROPS, LIGHTS, words_of

    choices: Iterable[str] = LIGHTS if name == "light" else BACKDROPS
    watch, group = shell.stage.session.watch, QActionGroup(menu)
    for choice in choices:
        action = QAction(tr(words_of(choice)), menu, checkable=True)
        action.setChecked(getattr(watch.now, name) == choice)
        action.triggered.connect(lambda _=False, c=choice: watch.set(**{name: c}))
        group.addAction(action)
        menu.addAction(action)


def fill_onion(shell: Shell, menu: QMenu) -> None:
    """Fill the menu of how many ghosts there are on each side and how far apart."""
    watch = shell.stage.session.watch
    for title, name, values, words in (
        (tr("Before now"), "before", range(MOST_GHOSTS + 1), "{:d}"),
        (tr("After now"), "after", range(MOST_GHOSTS + 1), "{:d}"),
        (tr("Apart"), "spacing", SPACINGS, "{:g} s"),
    ):
        part = menu.addMenu(title)
        group = QActionGroup(part)
        for value in values:
            action = QAction(words.format(value), part, checkable=True)
            action.setChecked(abs(getattr(watch.now, name) - value) < 1e-6)
            action.triggered.connect(lambda _=False, n=name, v=value: watch.set(**{n: v}))
            group.addAction(action)
            part.addAction(action)


def next_slide(shell: Shell) -> None:
    """Go to where a foot that stands slides next, after now; searched beside the window."""
    from app.features.character.foot_marks import watch_of
    from metagraph.playback.foot_slides import RATE

    session, shown = shell.stage.session, shell.stage.performance.shown
    watch, now = watch_of(shown), session.transport.seconds
    if watch is None:
        shell.tell(tr("Nobody with two feet is shown."))
        return
    session.transport.set_playing(False)
    end = min(shown.length, now + AHEAD)

    def search(job: Job) -> float | None:
        first, last = int(now * RATE) + 1, int(end * RATE) + 1
        for part in range(first, last, PART):
            if job.cancelled:
                return None
            seen = watch.at(range(part, min(part + PART, last)))
            # What slides now is left behind first: from its end on the next begins.
            slides = np.asarray(seen.sliding().any(1))
            if part == first and len(slides) and slides[0]:
                quiet = np.flatnonzero(~slides)
                slides[: quiet[0] if len(quiet) else len(slides)] = False
            if slides.any():
                return float(seen.times[int(np.argmax(slides))])
        return None

    def done(found: float | None) -> None:
        if shell.stage.performance.shown is not shown:
            return
        if found is None:
            shell.tell(
                tr(
                    "No foot that stands slides until {minutes}:{seconds:04.1f}.",
                    minutes=int(end // 60),
                    seconds=end % 60,
                )
            )
            return
        session.watch.set(feet=True)
        session.transport.seek(found)

    shell.jobs.start(tr("Searching feet that slide"), search, done, lambda error: shell.tell(tr_error(error)))
