"""The problems panel: what is wrong, where, and what to do; a click goes there, and what can be mended is
mended with a press.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import (
    QAbstractItemModel,
    QEvent,
    QLocale,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    QPoint,
    QRect,
    QSize,
    Qt,
    Signal,
)
from PySide6.QtGui import QColor, QContextMenuEvent, QMouseEvent, QPainter, QPen
from PySide6.QtWidgets import (
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QMenu,
    QPushButton,
    QStackedLayout,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTreeView,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.look import icons
from app.look.theme import get_theme
from app.stage.fixes import Fix
from app.stage.session import StageSession
from app.translation import tr, tr_noop, tr_phrase, tr_plural
from metagraph.graph.problem import Problem
from metagraph.graph.problem_groups import ProblemGroup, group_problems

MOST = 500  # rows; a project with more has one cause, seen long before
FIX = 3  # the column of buttons
WHERE = 170  # pixels wide, the column of places
ICON, MARGIN = 26, 12  # pixels beside the words of a row: of its icon, of its edges
SHARE = 0.55  # of the rest, that the problem itself has; what to do has the other part
ROLE = Qt.ItemDataRole.UserRole

SEVERITIES = (tr_noop("error"), tr_noop("warning"), tr_noop("hint"))


class FixButtons(QStyledItemDelegate):
    """Draws a button where a problem can be mended: five hundred real ones would take their time."""

    def __init__(self, panel: ProblemsPanel) -> None:
        super().__init__(panel)
        self.panel = panel
        self._down: QPersistentModelIndex | None = None

    def place(self, option: QStyleOptionViewItem, words: str) -> QRect:
        """Return where the button is in its cell."""
        rect, wide = option.rect, option.fontMetrics.horizontalAdvance(words) + 20
        return QRect(rect.left() + 2, rect.top() + 2, min(wide, rect.width() - 4), rect.height() - 4)

    def sizeHint(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:
        found = super().sizeHint(option, index)
        return QSize(found.width() + 20, max(found.height(), 24))

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        words, look = str(index.data() or ""), get_theme(self.panel.session.look.name)
        if option.state & QStyle.StateFlag.State_Selected:
            painter.fillRect(option.rect, QColor(look.hover))
        if not words:
            return
        rect = self.place(option, words)
        over = bool(option.state & QStyle.StateFlag.State_MouseOver)
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(look.text if over else look.line), 1))
        painter.setBrush(QColor(look.card))
        painter.drawRoundedRect(rect.adjusted(0, 0, -1, -1), 4, 4)
        painter.setPen(QColor(look.text))
        painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, words)
        painter.restore()

    def editorEvent(
        self,
        event: QEvent,
        model: QAbstractItemModel,
        option: QStyleOptionViewItem,
        index: QModelIndex | QPersistentModelIndex,
    ) -> bool:
        words = str(index.data() or "")
        if words and isinstance(event, QMouseEvent) and event.button() == Qt.MouseButton.LeftButton:
            inside = self.place(option, words).contains(event.position().toPoint())
            if event.type() == QEvent.Type.MouseButtonPress:
                self._down = QPersistentModelIndex(index) if inside else None
            elif (
                event.type() == QEvent.Type.MouseButtonRelease
                and inside
                and self._down == QPersistentModelIndex(index)
            ):
                self._down = None
                self.panel.mend(self.panel.tree.itemFromIndex(index))
                return True
        return super().editorEvent(event, model, option, index)


def make_breakable(words: str) -> str:
    """Return words whose names may go on in another line after each underscore."""
    return words.replace("_", "_\u200b")


class WrappedWords(QStyledItemDelegate):
    """Makes rows as high as their words need in the width of their column."""

    def sizeHint(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:
        found, tree = super().sizeHint(option, index), self.parent()
        assert isinstance(tree, QTreeView)
        icon = ICON if index.data(Qt.ItemDataRole.DecorationRole) is not None else 0
        wide = max(40, tree.columnWidth(index.column()) - icon - MARGIN)
        words = option.fontMetrics.boundingRect(
            0, 0, wide, 10_000, Qt.TextFlag.TextWordWrap, make_breakable(str(index.data()))
        )
        return QSize(found.width(), max(24, words.height() + 8))

    def displayText(self, value: object, locale: QLocale | QLocale.Language) -> str:
        return make_breakable(str(value))


class ProblemsPanel(QWidget):
    """mend_wanted: some `Fix`es were asked for. play_wanted: the character is to be played and checked.
    moment_wanted: the performance is to be shown at a second.
    """

    mend_wanted = Signal(object)
    play_wanted = Signal()
    moment_wanted = Signal(float)

    def __init__(self, session: StageSession, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.problems: tuple[Problem, ...] = ()
        self.fixes: Mapping[Problem, Fix | None] = {}
        self._shown: object = None
        self.tree = QTreeWidget(self)
        self.tree.setColumnCount(4)
        self.tree.setHeaderLabels([tr("Problem"), tr("Where"), tr("What to do"), ""])
        self.tree.setRootIsDecorated(False)
        self.tree.setWordWrap(True)  # what to do is read whole, in as many lines as it takes
        self.tree.setAccessibleName(tr("Problems"))
        self.tree.header().setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        self.tree.header().setStretchLastSection(False)
        self.tree.header().sectionResized.connect(lambda *_: self.tree.scheduleDelayedItemsLayout())
        self.tree.setItemDelegate(WrappedWords(self.tree))
        self.tree.setItemDelegateForColumn(FIX, FixButtons(self))
        self.tree.viewport().installEventFilter(self)
        self.tree.setMouseTracking(True)
        self.tree.itemActivated.connect(self._go)
        self.tree.itemClicked.connect(self._go)
        self.tree.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.tree.customContextMenuRequested.connect(self._menu)
        self.none = QLabel(self)
        self.none.setProperty("dim", True)
        self.none.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.all = QPushButton(self)
        self.all.setToolTip(tr("Fix them all in one undo step"))
        self.all.clicked.connect(lambda: self.mend_wanted.emit(self.fixable()))
        self.foot = QWidget(self)
        foot = QHBoxLayout(self.foot)
        foot.setContentsMargins(8, 4, 8, 6)
        self.play = QPushButton(tr("Play and check"), self)
        self.play.setToolTip(
            tr(
                "Plays ten minutes and each action once, and lists what a viewer would see: jumps, a body "
                "that slides, feet under the floor. It takes about a minute."
            )
        )
        self.play.clicked.connect(self.play_wanted)
        foot.addWidget(self.play)
        foot.addStretch(1)
        foot.addWidget(self.all)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.setSpacing(0)
        self.stack = QStackedLayout()
        self.stack.addWidget(self.none)
        self.stack.addWidget(self.tree)
        box.addLayout(self.stack, 1)
        box.addWidget(self.foot)
        session.look.changed.connect(lambda: self.show_problems(self.problems, self.fixes))

    def show_problems(
        self, problems: Sequence[Problem], fixes: Mapping[Problem, Fix | None] | None = None
    ) -> None:
        """Show problems. fixes: what mends some of them."""
        look = get_theme(self.session.look.name)
        fixes = fixes or {}
        state = (
            tuple(problems),
            tuple(fixes.items()),
            look.name,
            self.session.document.project.graphs,
            self.session.onstage.mode,
        )
        if state == self._shown:
            return
        fresh = self.problems[:1] != tuple(problems)[:1]
        self.problems, self.fixes, self._shown = tuple(problems), fixes, state
        self.tree.clear()
        colors = {"error": look.error, "warning": look.warning, "hint": look.dim}
        project = self.session.document.project
        groups = group_problems(project, self.problems[:MOST])
        self.tree.setRootIsDecorated(any(len(group.problems) > 1 for group in groups))
        for group in groups:
            if len(group.problems) == 1:
                self.tree.addTopLevelItem(self._row(group.problems[0], colors, look.text))
                continue
            item = self._row(group.problems[0], colors, look.text)
            fixes_of = self._together(group)
            words = tr_plural("Fix {count:,} problem", "Fix {count:,} problems", len(fixes_of))
            item.setText(0, tr_phrase(group.words))
            item.setText(FIX, words if fixes_of else "")
            item.setToolTip(0, tr("Open the line to see each of them."))
            item.setToolTip(FIX, self.all.toolTip() if fixes_of else "")
            item.setData(0, ROLE, group)
            item.addChildren([self._row(problem, colors, look.text) for problem in group.problems])
            self.tree.addTopLevelItem(item)
        self._share_out()
        if fresh:
            self.tree.scrollToTop()
        self.none.setText(
            tr("Nothing to check yet: no clip is in the graph.")
            if not project.uses and not project.drawn
            else tr("No problems. Every state can be reached and left.")
            if self.session.onstage.mode == "manual"
            else tr("No problems. Every stance has a resting clip, a way out and a way back.")
        )
        self.stack.setCurrentIndex(1 if self.problems else 0)
        count = len(self.fixable())
        self.all.setVisible(count > 1)
        self.all.setText(tr_plural("Fix {count:,} problem", "Fix {count:,} problems", count))

    def _row(self, problem: Problem, colors: Mapping[str, str], text: str) -> QTreeWidgetItem:
        """Return the row of a problem. colors: of the icons, by severity."""
        project = self.session.document.project
        stance, drawn = project.stance(problem.stance), project.state(problem.state)
        inside = stance.name if stance else drawn.name if drawn else ""
        place = ", ".join(x for x in (tr(problem.layer or ""), inside) if x) or tr("project")
        fix = self.fixes.get(problem)
        message, remedy = tr_phrase(problem.message), tr_phrase(problem.remedy)
        item = QTreeWidgetItem([message, place, remedy, fix.words if fix is not None else ""])
        sign = "hint" if problem.severity == "hint" else "warning"
        item.setIcon(0, icons.make_icon(sign, colors[problem.severity]))
        item.setForeground(0, QColor(text if problem.severity != "hint" else colors["hint"]))
        item.setToolTip(0, f"{tr(problem.severity)}: {message}. {remedy}")
        if fix is not None:
            item.setToolTip(FIX, fix.tip)
        item.setData(0, ROLE, problem)
        return item

    def _together(self, group: ProblemGroup) -> list[Fix]:
        """Return the fixes of a group that can be done together."""
        found = (self.fixes.get(p) for p in group.problems)
        return [fix for fix in found if fix is not None and not fix.alone]

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize and watched is self.tree.viewport():
            self._share_out()
        return super().eventFilter(watched, event)

    def _share_out(self) -> None:
        """Give each column its width: buttons and places what they need, the words the rest."""
        self.tree.resizeColumnToContents(FIX)
        room = max(300, self.tree.viewport().width() - WHERE - self.tree.columnWidth(FIX))
        widths = round(SHARE * room), WHERE, room - round(SHARE * room)
        if widths == tuple(self.tree.columnWidth(column) for column in range(FIX)):
            return
        for column, width in enumerate(widths):
            self.tree.setColumnWidth(column, width)

    def show_playing(self, playing: bool) -> None:
        """Show whether the character is being played."""
        self.play.setEnabled(not playing)
        self.play.setText(tr("Playing…") if playing else tr("Play and check"))

    def show_progress(self, percent: int) -> None:
        """Show how much has been played."""
        self.play.setText(tr("Playing… {percent} %", percent=percent))

    def fixable(self) -> list[Fix]:
        """Return what can be mended together, with one press, without taking anything away."""
        found = (self.fixes.get(p) for p in self.problems)
        return [fix for fix in found if fix is not None and not fix.alone]

    def mend(self, item: QTreeWidgetItem) -> None:
        """Mend the problem of a row, if that can be done with a press."""
        problem = item.data(0, ROLE)
        if isinstance(problem, ProblemGroup):
            self.mend_wanted.emit(self._together(problem))
            return
        fix = self.fixes.get(problem) if isinstance(problem, Problem) else None
        if fix is not None:
            self.session.jump(problem.layer, problem.stance, fix.action or problem.action)
            self.mend_wanted.emit([fix])

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        event.accept()  # the list's own

    def menu(self, item: QTreeWidgetItem) -> QMenu:
        """Return what can be done about a row."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        problem = item.data(0, ROLE)
        if isinstance(problem, ProblemGroup):
            menu.addAction(tr("Open"), lambda: item.setExpanded(True))
        else:
            menu.addAction(tr("Go to the place"), lambda: self._go(item))
        fix = self.fixes.get(problem) if isinstance(problem, Problem) else None
        if fix is not None:
            menu.addAction(fix.words, lambda: self.mend(item))
        if fix is not None and (other := fix.instead) is not None:
            menu.addAction(other.words, lambda: self.mend_wanted.emit([other]))
        if len(self.fixable()) > 1:
            menu.addSeparator()
            menu.addAction(self.all.text(), self.all.click)
        return menu

    def _menu(self, at: QPoint) -> None:
        item = self.tree.itemAt(at)
        if item is not None:
            self.menu(item).exec(self.tree.viewport().mapToGlobal(at))

    def _go(self, item: QTreeWidgetItem, column: int = 0) -> None:
        problem = item.data(0, ROLE)
        if isinstance(problem, ProblemGroup) and column != FIX:
            item.setExpanded(not item.isExpanded())
        if isinstance(problem, Problem) and column != FIX:
            self.session.jump(
                problem.layer, problem.stance, problem.action or problem.state or problem.link, problem.clip
            )
            if problem.moment is not None:
                self.moment_wanted.emit(problem.moment)
