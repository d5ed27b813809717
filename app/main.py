"""Start the window. Heavy imports wait until the first picture is shown."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QCoreApplication, QLibraryInfo, QLocale, QSettings, Qt, QTimer, QTranslator
from PySide6.QtGui import QIcon, QSurfaceFormat
from PySide6.QtWidgets import QApplication

from metagraph.common.programs import leave_working_folder
from metagraph.common.studio import find_studio_file, get_studio, read_studio, use_studio

if TYPE_CHECKING:
    from app.project.second_start import StartRequest
    from app.shell.window import Window

NAME = "Metagraph"  # of the program and its maker, for settings
RETRY = 300  # milliseconds between two checks whether the language can change
QUIET = 5000  # milliseconds after which news may be told: the project opens first
UNSEEN = 500  # milliseconds; then a project is opened even if nothing was painted: the window may be hidden


def prepare_application() -> QApplication:
    """Return the application, with its OpenGL format set; it is made once."""
    found = QApplication.instance()
    return found if isinstance(found, QApplication) else _application()


def _application() -> QApplication:
    from app import translation
    from app.features import check_studio_features
    from app.look.comfort import scale_application
    from app.memory import free_memory_early
    from app.stage.software_drawing import apply_drawing_choice
    from app.widgets.spoken_items import install_spoken_items
    from preview.early_driver import load_soon

    leave_working_folder()
    apply_drawing_choice(QSettings(NAME, NAME))
    free_memory_early()
    load_soon()
    # Planning and checking run on threads; the window's own thread must get its turn well within a frame.
    sys.setswitchinterval(0.001)
    surface = QSurfaceFormat()
    surface.setVersion(3, 3)
    surface.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    surface.setDepthBufferSize(24)
    surface.setSwapInterval(0 if os.environ.get("CI") else 1)
    QSurfaceFormat.setDefaultFormat(surface)
    # A dock that is floated or docked keeps its context.
    QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_ShareOpenGLContexts)
    QCoreApplication.setApplicationName(NAME)
    QCoreApplication.setOrganizationName(NAME)
    scale_application()
    app = QApplication(sys.argv[:1])
    install_spoken_items()
    app.setWindowIcon(QIcon(str(Path(__file__).parent / "look" / "metagraph.svg")))
    app.setDesktopFileName("metagraph")  # under Wayland the icon is that of the menu entry
    use_studio(check_studio_features(read_studio(find_studio_file(str(QSettings().value("studio", ""))))))
    translation.choose_language(QSettings(), QLocale.system().uiLanguages(), get_studio().language)
    follow_language(app)
    return app


def follow_language(app: QApplication) -> None:
    """Make Qt's own texts, and numbers and dates in fields, follow the chosen language."""
    from app.translation import ENGLISH, get_language

    code = get_language()
    QLocale.setDefault(QLocale(code))
    for translator in app.findChildren(QTranslator):
        app.removeTranslator(translator)
        translator.deleteLater()
    if code != ENGLISH:
        translator = QTranslator(app)
        place = QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)
        if translator.load(f"qtbase_{code}", place):
            app.installTranslator(translator)


def make_window() -> Window:
    """Return a window with all features, not shown yet."""
    from app.features import FEATURES
    from app.shell.studio_defaults import is_all_shown
    from app.shell.window import Window

    hidden = set(get_studio().hidden_features) if not is_all_shown(QSettings()) else ()
    shown = [name for name in FEATURES if name not in hidden]
    return Window(import_module(f"app.features.{name}").contribute for name in shown)


def open_window(
    path: Path | None, sample: bool = False, clip: str | None = None, clips: Sequence[Path] = ()
) -> Window:
    """Show a window with a project, the sample project, a new project of clips and folders of clips, or
    nothing. `clip` is the name or id of a clip to select then.
    """
    window = make_window()
    window.show()
    files = window.shell.files

    def begin() -> None:
        if path is not None or clips:
            show_given(window, path, False, clip, clips)
            files.unsaved.tell()
        else:
            files.recover_untitled(lambda: show_given(window, None, sample, clip))
        window.load_late_panels_soon()
        QTimer.singleShot(QUIET, window, lambda: tell_news(window))

    _once_painted(window, begin)
    return window


def tell_news(window: Window) -> None:
    """Offer to read what is new after an update, and look for a newer release if the user allowed it."""
    import time

    from app.shell.update_check import Release, find_update, is_due, note_version
    from app.translation import tr, tr_phrase
    from metagraph import __version__

    shell = window.shell
    settings = shell.settings
    if problems := get_studio().problems:
        words = tr("Check your studio's defaults…")
        lines = [tr_phrase(problem) for problem in problems]
        shell.notice.tell(words, "\n".join(lines), lambda: shell.files.report.emit(words.rstrip("…"), lines))
    elif note_version(settings, __version__):
        words = tr("What is new in Metagraph {version}…", version=__version__)
        shell.notice.tell(words, words, shell.actions["news"].trigger)

    def tell(release: Release | None) -> None:
        if release is not None:
            words = tr("Metagraph {version} is available…", version=release.version)
            command = next(c for c in shell.actions.commands if c.id == "news")
            shell.notice.tell(words, words, lambda: command.run(release))

    if is_due(settings, time.time()):
        shell.jobs.start(
            "updates", lambda _: find_update(__version__, settings), tell, lambda error: None, quick=True
        )


def show_given(
    window: Window, path: Path | None, sample: bool, clip: str | None, clips: Sequence[Path] = ()
) -> None:
    """Show in a window what a start was given, asking about unsaved edits first; options as for
    `open_window`.
    """
    from app.project.files import SAMPLE

    files = window.shell.files
    if clip is not None:
        files.opened.connect(lambda: _select(window, clip), Qt.ConnectionType.SingleShotConnection)
    if path is not None:
        files.open(path)
    elif clips:
        if files.new(clips[0].resolve().name if clips[0].is_dir() else clips[0].stem):
            window.shell.importing.import_paths([str(each) for each in clips])
    elif sample:
        files.open(SAMPLE, template=True)


def _once_painted(window: Window, begin: Callable[[], None]) -> None:
    """Call `begin` once, when the first picture is shown; anything that ran beside it would slow it down."""
    painted = window.shell.stage.painted
    waiting = [begin]

    def go() -> None:
        if waiting:
            waiting.pop()()

    painted.connect(go, Qt.ConnectionType.SingleShotConnection)
    unseen = QTimer(window, singleShot=True, interval=UNSEEN)
    unseen.timeout.connect(go)
    unseen.start()


def _select(window: Window, clip: str) -> None:
    """Select a clip by its id or name, and play it alone."""
    shell = window.shell
    entries = shell.document.project.clips.values()
    found = next((e.id for e in entries if clip in (e.id, e.name)), None)
    if found is None:
        shell.tell(f"There is no clip '{clip}' in {shell.document.project.name}.")
        return
    shell.stage.session.selection.select_clips((found,))
    shell.stage.session.transport.show_clip(found)


def run_window(
    path: Path | None, sample: bool = False, clip: str | None = None, clips: Sequence[Path] = ()
) -> int:
    """Open the window and stay until it is closed; return the exit status."""
    from app import faults
    from app.shell.fault_dialog import find_fault_folder

    gc.disable()  # objects made until the window shows live on; collecting costs 0.08 s
    app = prepare_application()
    faults.install(find_fault_folder())
    keeper = WindowKeeper(open_window(path, sample, clip, clips))
    gc.freeze()
    gc.enable()
    keeper.window.shell.faults.offer_left()
    return app.exec()


class WindowKeeper:
    """Keeps the window as long as the program runs, and replaces it when the user chooses a language. The new
    one continues with the same project, undo steps and place.
    """

    def __init__(self, window: Window) -> None:
        self.window, self._wanted = window, ""
        self._follow()

    def _follow(self) -> None:
        # Queued, because the clicked menu goes with its window.
        self.window.language_chosen.connect(self.change_language, Qt.ConnectionType.QueuedConnection)
        starts = self.window.shell.second_starts
        starts.asked.connect(self.open_request, Qt.ConnectionType.QueuedConnection)
        QTimer.singleShot(0, starts, starts.follow)

    def open_request(self, request: StartRequest) -> None:
        """Bring the window to the front and show what a second start was given."""
        window = self.window
        if request.token:
            os.environ["XDG_ACTIVATION_TOKEN"] = request.token
        if window.isMinimized():
            window.showNormal()
        window.raise_()
        window.activateWindow()
        from app.project.given_files import sort_paths

        path, clips = sort_paths([Path(each) for each in request.paths])
        show_given(window, path, request.sample, request.clip, clips)

    def change_language(self, code: str) -> None:
        """Show the window in a language: now, or as soon as nothing runs that would end with the window."""
        self._wanted = code
        self._change()

    def _change(self, said: str = "") -> None:
        from app import translation
        from app.shell.handing_over import describe_running, replace_window

        old, code = self.window, self._wanted
        if code == translation.get_language():
            return
        runs = describe_running(old)
        if runs:
            if runs != said:
                old.shell.tell(runs)
            QTimer.singleShot(RETRY, old, lambda: self._change(runs))
            return
        translation.choose(code)
        follow_language(prepare_application())
        old.workspaces.save()
        self.window = make_window()
        self._follow()
        replace_window(old, self.window)
