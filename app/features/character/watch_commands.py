"""What helps to watch the character, as commands; and the same behind one button of the panel."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtGui import QAction, QActionGroup, QColor
from PySide6.QtWidgets import QColorDialog, QFileDialog, QMenu

from app.project.jobs import WindowJob
from app.shell.actions import Command
from app.shell.command_table import Feature
from app.shell.context import Shell
from app.stage.watch import MOST_GHOSTS, SPACINGS, Watch, Watched
from app.translation import format_number, tr, tr_error, tr_noop
from metagraph.common.studio import find_start_folder
from metagraph.errors import FileError
from metagraph.formats.project.paths import make_path_for_project
from metagraph.graph.backdrop import Backdrop, BackdropKind
from metagraph.graph.edit_error import EditError

if TYPE_CHECKING:
    from app.features.character.reference import Reference

SHOWN = (
    ("feet", "hands_touch", "next_slide", "trails", "bones"),
    ("stance_ghost", "onion", "onion_skin"),
    ("two_views", "four_views"),
    ("light", "background", "seat"),
    ("reference", "no_reference"),
    ("meshes", "sticks"),
)
SEAT_WORDS = {"stool": tr_noop("Stool"), "chair": tr_noop("Chair"), "none": tr_noop("None")}
BACKDROP_WORDS: dict[BackdropKind, str] = {
    "studio": tr_noop("Studio, the floor turns into the wall"),
    "room": tr_noop("Room"),
    "color": tr_noop("Plain colour…"),
    "picture": tr_noop("Picture…"),
}
PICTURES = tr_noop("Pictures (*.png *.jpg *.jpeg *.webp)")
GHOSTS = 2  # before and after, where onion skin is turned on by its key
AHEAD = 120.0  # seconds that are searched for a slide
VIEW = "&View"
PART = 240  # samples between two looks at whether to stop


class WatchFeature(Feature):
    """Does the commands of this module."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.watch = self.session.watch

    @property
    def reference(self) -> Reference:
        found: Reference = self.shell.panel("character").reference
        return found

    @property
    def now(self) -> Watched:
        return self.watch.now

    def toggle_feet(self) -> None:
        self.watch.set(feet=not self.now.feet)

    def marks_feet(self) -> bool:
        return self.now.feet

    def toggle_hands(self) -> None:
        self.watch.set(hands=not self.now.hands)

    def marks_hands(self) -> bool:
        return self.now.hands

    def go_to_next_slide(self) -> None:
        go_to_next_slide(self.shell)

    def toggle_sticks(self) -> None:
        self.watch.set(sticks=not self.now.sticks)

    def draws_sticks(self) -> bool:
        return self.now.sticks

    def toggle_stance(self) -> None:
        self.watch.set(stance=not self.now.stance)

    def shows_stance(self) -> bool:
        return self.now.stance

    def toggle_onion_skin(self) -> None:
        ghosts = 0 if self.shows_onion_skin() else GHOSTS
        self.watch.set(before=ghosts, after=ghosts)

    def shows_onion_skin(self) -> bool:
        return bool(self.now.before or self.now.after)

    def toggle_four_views(self) -> None:
        self.watch.set(panes=1 if self.shows_four_views() else 4)

    def shows_four_views(self) -> bool:
        return self.now.panes == 4

    def toggle_two_views(self) -> None:
        self.watch.set(panes=1 if self.shows_two_views() else 2)

    def shows_two_views(self) -> bool:
        return self.now.panes == 2

    def choose_reference(self) -> None:
        choose_reference(self.shell, self.reference)

    def close_reference(self) -> None:
        self.reference.close()

    def has_reference(self) -> bool:
        return self.reference.path is not None

    def fill_lights(self, menu: QMenu) -> None:
        fill_choice(self.shell, menu, "light")

    def fill_backgrounds(self, menu: QMenu) -> None:
        fill_choice(self.shell, menu, "background")

    def fill_seats(self, menu: QMenu) -> None:
        fill_choice(self.shell, menu, "seat")

    def use_next_light(self) -> None:
        choose_next_light(self.watch)

    def fill_onion_skin(self, menu: QMenu) -> None:
        fill_onion(self.shell, menu)


WATCH_COMMANDS = (
    Command(
        "feet",
        VIEW,
        "watch",
        tr_noop("Foo&t contacts"),
        WatchFeature.toggle_feet,
        ("Shift+G",),
        checked=WatchFeature.marks_feet,
        tip=tr_noop(
            "Mark feet that are planted (square), step (diamond), are lifted (circle) or slide (triangle)"
        ),
        study=True,
    ),
    Command(
        "hands_touch",
        VIEW,
        "watch",
        tr_noop("Hand &contacts"),
        WatchFeature.toggle_hands,
        ("Shift+J",),
        checked=WatchFeature.marks_hands,
        tip=tr_noop(
            "Mark hands that are pinned: in place (square), on the way (diamond), out of reach (triangle)"
        ),
        study=True,
    ),
    Command(
        "sticks",
        VIEW,
        "watch",
        tr_noop("Stic&k figure"),
        WatchFeature.toggle_sticks,
        checked=WatchFeature.draws_sticks,
        tip=tr_noop("Draw characters without a mesh as a stick figure, not as the default body"),
        study=True,
    ),
    Command(
        "next_slide",
        VIEW,
        "watch",
        tr_noop("Next foot sl&ide"),
        WatchFeature.go_to_next_slide,
        ("Ctrl+Shift+G",),
        tip=tr_noop("Go to the next moment when a planted foot slides"),
        study=True,
    ),
    Command(
        "stance_ghost",
        VIEW,
        "watch",
        tr_noop("Ghost of the &stance"),
        WatchFeature.toggle_stance,
        ("Shift+B",),
        checked=WatchFeature.shows_stance,
        tip=tr_noop("Show the character in its stance, without the action that plays"),
        study=True,
    ),
    Command(
        "onion",
        VIEW,
        "watch",
        tr_noop("&Onion skin"),
        WatchFeature.toggle_onion_skin,
        ("Shift+O",),
        checked=WatchFeature.shows_onion_skin,
        tip=tr_noop("Show ghosts of earlier poses (dark) and later poses (light)"),
        study=True,
    ),
    Command(
        "four_views",
        VIEW,
        "watch",
        tr_noop("Four &views"),
        WatchFeature.toggle_four_views,
        ("Ctrl+Alt+Q",),
        checked=WatchFeature.shows_four_views,
        tip=tr_noop("Show the view and three other sides at once"),
        study=True,
    ),
    Command(
        "two_views",
        VIEW,
        "watch",
        tr_noop("T&wo views"),
        WatchFeature.toggle_two_views,
        ("Ctrl+Alt+W",),
        checked=WatchFeature.shows_two_views,
        tip=tr_noop("Show the view and one other side at once"),
        study=True,
    ),
    Command(
        "reference",
        VIEW,
        "watch",
        tr_noop("Reference vi&deo…"),
        WatchFeature.choose_reference,
        ("Ctrl+Alt+R",),
        tip=tr_noop("Show a video or picture beside or behind the character, to compare"),
    ),
    Command(
        "no_reference",
        VIEW,
        "watch",
        tr_noop("Close the reference video"),
        WatchFeature.close_reference,
        enabled=WatchFeature.has_reference,
    ),
    Command("light", VIEW, "watch", tr_noop("Li&ght"), fill=WatchFeature.fill_lights),
    Command("background", VIEW, "watch", tr_noop("Back&ground"), fill=WatchFeature.fill_backgrounds),
    Command("seat", VIEW, "watch", tr_noop("S&eat"), fill=WatchFeature.fill_seats),
    Command(
        "next_light",
        VIEW,
        "watch",
        tr_noop("Ne&xt light"),
        WatchFeature.use_next_light,
        ("Shift+L",),
        tip=tr_noop("Switch to the next light: studio, day, evening, rim, flat"),
        study=True,
    ),
    Command(
        "onion_skin",
        VIEW,
        "watch",
        tr_noop("Onion skin: ghosts and spac&ing"),
        fill=WatchFeature.fill_onion_skin,
    ),
)


def choose_reference(shell: Shell, reference: Reference) -> None:
    """Ask which video the character is compared with."""
    from app.features.character.reference import FILES

    folder = reference.path.parent if reference.path is not None else find_start_folder(shell.document.folder)
    name, _ = QFileDialog.getOpenFileName(
        shell.widget, tr("Choose a reference video"), str(folder), tr(FILES)
    )
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


def choose_next_light(watch: Watch) -> None:
    """Light the character by the light that comes after this one, the first after the last."""
    from preview.looks import LIGHTS

    names = list(LIGHTS)
    watch.set(light=names[(names.index(watch.now.light) + 1) % len(names)])


def fill_choice(shell: Shell, menu: QMenu, name: str) -> None:
    """Fill a menu of lights, backgrounds or seats. name: of `Watched`."""
    from preview.looks import BACKDROPS, LIGHTS, SEATS, look_name

    choices: Iterable[str] = {"light": LIGHTS, "background": BACKDROPS, "seat": SEATS}[name]
    watch, group = shell.stage.session.watch, QActionGroup(menu)
    kept = shell.document.project.backdrop.kind if name == "background" else ""

    def choose(choice: str) -> None:
        if kept:
            set_project_backdrop(shell, Backdrop())
        watch.set(**{name: choice})

    for choice in choices:
        action = QAction(
            tr(SEAT_WORDS[choice] if name == "seat" else look_name(choice)), menu, checkable=True
        )
        action.setChecked(getattr(watch.now, name) == choice and not kept)
        action.triggered.connect(lambda _=False, c=choice: choose(c))
        group.addAction(action)
        menu.addAction(action)
    if name == "background":
        menu.addSeparator()
        menu.addAction(tr("Saved with the project")).setEnabled(
            False
        )  # a heading: styles hide those of sections
        for kind, words in BACKDROP_WORDS.items():
            action = QAction(tr(words), menu, checkable=True)
            action.setChecked(kind == kept)
            action.triggered.connect(lambda _=False, k=kind: choose_project_backdrop(shell, k))
            group.addAction(action)
            menu.addAction(action)


def choose_project_backdrop(shell: Shell, kind: BackdropKind) -> None:
    """Put something behind the project's character; ask which colour or picture."""
    from app.stage.backdrop import read_back_picture

    document = shell.document
    before = document.project.backdrop
    if kind == "color":
        color = QColorDialog.getColor(QColor(*before.color), shell.widget, tr("Colour of the background"))
        if color.isValid():
            set_project_backdrop(
                shell, Backdrop(kind="color", color=(color.red(), color.green(), color.blue()))
            )
    elif kind == "picture":
        folder = find_start_folder(document.folder)
        name, _ = QFileDialog.getOpenFileName(
            shell.widget, tr("Choose a background picture"), str(folder), tr(PICTURES)
        )
        if not name:
            return
        try:
            read_back_picture(Path(name))
            path = make_path_for_project(Path(name), document.folder)
        except FileError as error:
            document.failed.emit(tr_error(error))
            return
        set_project_backdrop(shell, Backdrop(kind="picture", path=path))
    else:
        set_project_backdrop(shell, Backdrop(kind=kind))


def set_project_backdrop(shell: Shell, backdrop: Backdrop) -> None:
    """Put something behind the project's character, as a step that can be undone."""
    try:
        shell.document.edit(tr("Change the background"), lambda project: replace(project, backdrop=backdrop))
    except EditError as error:
        shell.document.failed.emit(tr_error(error))


def fill_onion(shell: Shell, menu: QMenu) -> None:
    """Fill the menu of how many ghosts there are on each side and how far apart."""
    watch = shell.stage.session.watch
    for title, name, values, words in (
        (tr("Before"), "before", range(MOST_GHOSTS + 1), "{}"),
        (tr("After"), "after", range(MOST_GHOSTS + 1), "{}"),
        (tr("Spacing"), "spacing", SPACINGS, "{} s"),
    ):
        part = menu.addMenu(title)
        group = QActionGroup(part)
        for value in values:
            action = QAction(words.format(format_number(value, "g")), part, checkable=True)
            action.setChecked(abs(getattr(watch.now, name) - value) < 1e-6)
            action.triggered.connect(lambda _=False, n=name, v=value: watch.set(**{n: v}))
            group.addAction(action)
            part.addAction(action)


def go_to_next_slide(shell: Shell) -> None:
    """Go to where a foot that stands slides next, after now; searched beside the window."""
    from app.features.character.foot_marks import watch_of
    from metagraph.playback.posing.foot_slides import RATE

    session, shown = shell.stage.session, shell.stage.performance.shown
    watch, now = watch_of(shown), session.transport.seconds
    if watch is None:
        shell.tell(tr("No character with two feet is shown."))
        return
    session.transport.set_playing(False)
    end = min(shown.length, now + AHEAD)

    def search(job: WindowJob) -> float | None:
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
                    "No planted foot slides up to {minutes}:{seconds:04.1f}.",
                    minutes=int(end // 60),
                    seconds=end % 60,
                )
            )
            return
        session.watch.set(feet=True)
        session.transport.seek(found)

    shell.jobs.start(tr("Searching for foot slides"), search, done, lambda error: shell.tell(tr_error(error)))
