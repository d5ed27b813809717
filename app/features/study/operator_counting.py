"""Count operators (keys, clicks, drags) outside a study, and estimate the time of an expert."""

from __future__ import annotations

from collections import Counter
from time import monotonic
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QLabel

from app.features.study.operator_events import Hands
from app.translation import format_number, tr

if TYPE_CHECKING:
    from app.shell.context import Shell


class Counting(QObject):
    """Shows the counts in the status bar until `stop`."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell.widget)
        self.label = QLabel(shell.widget)
        self.label.setToolTip(
            tr(
                "Keystrokes, pointing, button presses and releases, drags and hand changes since you "
                "turned this on.\nThe seconds are the time that an expert would need without thinking "
                "(Card, Moran and Newell 1980)."
            )
        )
        shell.widget.statusBar().addPermanentWidget(self.label)
        self.total: Counter[str] = Counter()
        self.hands = Hands(lambda _: None, lambda _, __: None, lambda: None, self)
        self._timer = QTimer(self, interval=500)
        self._timer.timeout.connect(self.show)
        self._timer.start()
        self.show()

    def show(self) -> None:
        """Show what there was so far."""
        self.total.update(self.hands.operators.take(monotonic()).operators)
        from metagraph.research.study.machines.klm import predict_seconds

        seconds = predict_seconds({k: self.total[k] for k in "KPBH"})
        counts = "   ".join(f"{k} {self.total[k]}" for k in "KPBDH")
        self.label.setText(f"{counts}   {format_number(seconds, '.1f')} s")

    def stop(self) -> None:
        self._timer.stop()
        self.hands.stop()
        self.label.deleteLater()
        self.deleteLater()


class OperatorCounting:
    """Turns the counts in the status bar on and off."""

    def __init__(self, shell: Shell) -> None:
        self.shell = shell
        self._shown: Counting | None = None

    @property
    def on(self) -> bool:
        return self._shown is not None

    def toggle(self) -> None:
        """Start or stop counting keys, pointing, buttons and drags."""
        if self._shown is None:
            self._shown = Counting(self.shell)
        else:
            self._shown.stop()
            self._shown = None
        self.shell.actions.refresh()
