"""A window of another program from which files are dragged, as from a file manager: `python file_source.py X Y
FILE...` puts one at a place on the screen and says "ready".
"""

from __future__ import annotations

import sys

from PySide6.QtCore import QMimeData, QPoint, Qt, QTimer, QUrl
from PySide6.QtGui import QDrag, QMouseEvent
from PySide6.QtWidgets import QApplication, QLabel


class Files(QLabel):
    def mousePressEvent(self, event: QMouseEvent) -> None:
        drag, data = QDrag(self), QMimeData()
        data.setUrls([QUrl.fromLocalFile(path) for path in sys.argv[3:]])
        drag.setMimeData(data)
        drag.exec(Qt.DropAction.CopyAction | Qt.DropAction.MoveAction | Qt.DropAction.LinkAction)


app = QApplication(sys.argv[:1])
label = Files("files")
label.setWindowFlags(Qt.WindowType.X11BypassWindowManagerHint | Qt.WindowType.FramelessWindowHint)
label.resize(60, 40)
label.move(QPoint(int(sys.argv[1]), int(sys.argv[2])))
label.show()
label.raise_()
QTimer.singleShot(150, lambda: print("ready", flush=True))
QTimer.singleShot(60_000, app.quit)
app.exec()
