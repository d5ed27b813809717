"""Say what is wrong with the words of the five workspaces, in a process of its own: `QT_SCALE_FACTOR=2 python -m
tests.app.painted_words_twice`. Nothing of the user's is touched.
"""

from __future__ import annotations

import sys
import tempfile
import time

from PySide6.QtCore import QSettings, QStandardPaths
from PySide6.QtTest import QTest

SIZE, SMALL = (1280, 720), (1280, 680)


def main() -> None:
    from app.main import make_window, prepare_application
    from app.project.files import SAMPLE
    from tests.app.handles import Handles
    from tests.app.painted_walk import walk

    QStandardPaths.setTestModeEnabled(True)
    app = prepare_application()
    drive = Handles(make_window())
    drive.window.resize(*SIZE)
    drive.window.show()
    drive.window.make_late_panels()
    for workspace, lines in walk(drive, *SMALL).items():  # with nothing in it
        for line in lines:
            print(f"{workspace}, empty: {line}")
    drive.files.open(SAMPLE, template=True)
    end = time.monotonic() + 60
    while not (drive.document.project.clips and drive.performance.skeleton() is not None):
        QTest.qWait(50)
        if time.monotonic() > end:
            sys.exit("the sample was not read")
    for size in (SIZE, SMALL):
        for workspace, lines in walk(drive, *size).items():
            for line in lines:
                print(f"{workspace}, {size}: {line}")
    drive.document.undo_stack.setClean()
    drive.window.close()
    app.quit()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        QSettings.setDefaultFormat(QSettings.Format.IniFormat)
        QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, folder)
        main()
