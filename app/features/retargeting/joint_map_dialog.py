"""Clips of another skeleton: which joint follows which, seen on both figures, corrected by hand, and
retargeted or left out.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QSize, QStringListModel, Qt, QTimer
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QSplitter,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.look.joint_roles import describe_joint_role
from app.look.theme import DARK, LIGHT, strengthen
from app.project.jobs import Jobs
from app.translation import tr, tr_error, tr_noop, tr_phrase, tr_plural
from app.widgets.making import make_widget
from app.widgets.quiet_fields import ComboBox
from app.widgets.stick_figures import StickFigures
from app.widgets.within_screen import resize_within_screen
from metagraph.formats.imports import Strangers
from metagraph.graph.editing.retargeting import Bringing
from metagraph.motion.clip import Clip
from metagraph.motion.joint_map import JointMap, find_known_roles

JOINT = Qt.ItemDataRole.UserRole
NONE = tr_noop("– none –")
AT_ONCE = 12  # rows that get their boxes in one go
SHOWN = 150  # frames of a clip that are played
# Why joints are paired, as `metagraph.motion.joint_map` says it.
REASONS = (
    *(tr_noop("same role and name"), tr_noop("same part of the body"), tr_noop("both carry the arms")),
    *(tr_noop("both stand above the hips"), tr_noop("same name"), tr_noop("same words in the name")),
    tr_noop("chosen by hand"),
)


class JointMapDialog(QDialog):
    """`map`: the joint map as it is now; accepted when the clips are to be retargeted by it, rejected when
    they are left out. `all_chosen`: whether the groups that wait are to be retargeted, too, by the maps that
    are offered for them.
    """

    def __init__(
        self,
        strangers: Strangers,
        bringing: Bringing,
        jobs: Jobs,
        parent: QWidget | None = None,
        waiting: int = 0,
    ) -> None:
        """Show how `strangers` are mapped. `waiting`: clips of other skeletons that are asked about next."""
        super().__init__(parent)
        assert bringing.project.skeleton is not None
        self.strangers, self.bringing, self.jobs = strangers, bringing, jobs
        self.source, self.target = strangers.skeleton, bringing.project.skeleton
        self.map: JointMap = strangers.joint_map
        self._before: tuple[str, JointMap] = (
            "",
            self.map,
        )  # the joint that was changed last, and the map before that
        self.all_chosen = False
        self._asked = 0  # previews, so that a late one of an older map is not shown
        self._roles = {
            self.target.names[j]: role for role, j in find_known_roles(self.target, bringing.roles).items()
        }
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Retarget clips"))
        resize_within_screen(self, 1200, 720)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(16, 14, 16, 14)
        layout.setSpacing(8)
        self.headline = QLabel(self, wordWrap=True)
        self.headline.setProperty("heading", True)
        self.details = QLabel(self, wordWrap=True)
        self.details.setProperty("dim", True)
        layout.addWidget(self.headline)
        layout.addWidget(self.details)
        split = QSplitter(Qt.Orientation.Horizontal, self)
        split.setChildrenCollapsible(False)
        split.addWidget(self._table())
        split.addWidget(self._picture())
        split.setStretchFactor(0, 1)
        split.setSizes([800, 380])
        layout.addWidget(split, 1)
        self.missing = QLabel(self, wordWrap=True)
        layout.addWidget(self.missing)
        self.buttons = QDialogButtonBox(self)
        self.go = self.buttons.addButton(tr("Retarget"), QDialogButtonBox.ButtonRole.AcceptRole)
        self.leave = self.buttons.addButton(tr("Skip them"), QDialogButtonBox.ButtonRole.RejectRole)
        count = waiting + len(strangers.clips)
        self.everything = self.buttons.addButton(
            tr_plural("Retarget all {count:,} clip", "Retarget all {count:,} clips", count),
            QDialogButtonBox.ButtonRole.ActionRole,
        )
        self.everything.setVisible(waiting > 0)
        self.everything.setToolTip(
            tr("Retarget the clips of the other skeletons, too, with the joint maps offered for them")
        )
        self.everything.clicked.connect(self._choose_all)
        strengthen(self.go)
        self.buttons.accepted.connect(self.accept)
        self.buttons.rejected.connect(self.reject)
        layout.addWidget(self.buttons)
        self.finished.connect(self._forget)
        self._say()
        self._show()
        self._play()

    def _choose_all(self) -> None:
        self.all_chosen = True
        self.accept()

    def _forget(self) -> None:
        self._asked = 0  # what a preview finds from now on is nobody's

    # --- parts

    def _say(self) -> None:
        paths = list(dict.fromkeys(Path(path).name for path, *_ in self.strangers.clips))
        count = len(self.strangers.clips)
        files = ", ".join(paths[:2]) + (
            tr(" and {count} more", count=len(paths) - 2) if len(paths) > 2 else ""
        )
        self.headline.setText(
            tr_plural("{count:,} clip has another skeleton", "{count:,} clips have another skeleton", count)
        )
        words = tr(
            "From {files}: {joints} joints, {height:.2f} m tall; {why}.",
            files=files,
            joints=len(self.source),
            height=self.source.height,
            why=tr_phrase(self.strangers.why),
        )
        if not self.strangers.why:  # they are in the project
            words = tr(
                "From {files}: {joints} joints, {height:.2f} m tall. The joints below show "
                "how they were mapped.",
                files=files,
                joints=len(self.source),
                height=self.source.height,
            )
            self.headline.setText(
                tr_plural("{count:,} clip was retargeted", "{count:,} clips were retargeted", count)
            )
        elif self.strangers.remembered:
            words += tr(" The joints are mapped as you mapped them last time.")
        else:
            words += tr(" The joints below were matched by motion and name. Check the uncertain ones.")
        self.details.setText(words)
        self.go.setText(tr_plural("Retarget {count:,} clip", "Retarget {count:,} clips", count))
        if not self.strangers.why:
            self.go.setText(tr("Retarget again"))
            self.leave.setText(tr("Keep as it is"))
        elif count == 1:
            self.leave.setText(tr("Skip it"))

    def _table(self) -> QWidget:
        page = QWidget(self)
        box = QVBoxLayout(page)
        box.setContentsMargins(0, 0, 8, 0)
        self.doubtful = QCheckBox(tr("Show only uncertain and unmapped joints"), page)
        self.doubtful.toggled.connect(self._narrow)
        self.contacts = QCheckBox(tr("Keep hand contacts with the body"), page)
        self.contacts.setToolTip(
            tr("Hands touch the face, chest, thighs and the other arm and hand where they did in the clip")
        )
        self.contacts.setChecked(self.map.contacts)
        self.contacts.toggled.connect(self._touch)
        self.tree = make_widget(QTreeWidget, page, rootIsDecorated=False, uniformRowHeights=True)
        self.tree.setHeaderLabels(
            [tr("Joint of the clips"), tr("Moves"), tr("Role"), tr("Certainty"), tr("Why")]
        )
        self.tree.setAccessibleName(tr("Joint map"))
        header = self.tree.header()
        header.setStretchLastSection(True)
        self.tree.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        for column, width in enumerate((170, 180, 150, 84)):
            self.tree.setColumnWidth(column, width)
        header.setSectionResizeMode(3, QHeaderView.ResizeMode.Fixed)
        self.tree.currentItemChanged.connect(self._mark)
        self.names = QStringListModel([tr(NONE), *self.target.names], self)
        self.rows: dict[str, QTreeWidgetItem] = {}
        self.combos: dict[str, QComboBox] = {}
        for name in self.source.names:
            item = QTreeWidgetItem(self.tree, [name])
            item.setToolTip(0, name)
            item.setData(0, JOINT, name)
            item.setSizeHint(0, QSize(0, 36))
            self.rows[name] = item
        self._filling = QTimer(self, interval=0)  # a hundred at once would hold the window up
        self._filling.timeout.connect(self._more_combos)
        self._filling.start()
        box.addWidget(self.doubtful)
        box.addWidget(self.contacts)
        box.addWidget(self.tree, 1)
        return page

    def _more_combos(self) -> None:
        left = [name for name in self.rows if name not in self.combos]
        for name in left[:AT_ONCE]:
            self.combo(name)
        if len(left) <= AT_ONCE:
            self._filling.stop()

    def combo(self, joint: str) -> QComboBox:
        """Return the box in which is chosen what the joint moves."""
        if joint not in self.combos:
            combo = ComboBox(self.tree, toolTip=tr("The joint of your character that follows this joint"))
            combo.setModel(self.names)
            combo.setAccessibleName(tr("{joint} moves", joint=joint))
            combo.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

            combo.setCurrentIndex(self._number(joint))
            combo.activated.connect(lambda n: self._choose(joint, n))
            self.tree.setItemWidget(self.rows[joint], 1, combo)
            self.combos[joint] = combo
        return self.combos[joint]

    def _number(self, joint: str) -> int:
        """Return the row of the box for what follows the joint now."""
        pair = self.map.of(joint)
        return self.target.index(pair.target) + 1 if pair is not None and pair.target in self.target else 0

    def _picture(self) -> QWidget:
        page = QWidget(self)
        box = QVBoxLayout(page)
        box.setContentsMargins(8, 0, 0, 0)
        self.clip = ComboBox(page, toolTip=tr("The clip to preview"))
        self.clip.setAccessibleName(tr("Clip to preview"))
        self.clip.addItems([clip.name for *_, clip in self.strangers.clips])
        self.clip.activated.connect(lambda _: self._play())
        self.figures = StickFigures(page)
        self.figures.words = (tr("original"), tr("on your character"))
        row = QHBoxLayout()
        row.addWidget(QLabel(tr("Play"), page))
        row.addWidget(self.clip, 1)
        box.addLayout(row)
        box.addWidget(self.figures, 1)
        self.trouble = QLabel(page, wordWrap=True)
        self.trouble.setProperty("dim", True)
        box.addWidget(self.trouble)
        return page

    # --- the map

    def _choose(self, joint: str, number: int) -> None:
        """Let a joint of the character follow another, or none.

        What one joint is given on the way there by keyboard is taken back, so that it takes nothing from the
        others.
        """
        if self._before[0] != joint:
            self._before = (joint, self.map)
        before = self._before[1]
        if number <= 0:
            self.map = before.without(joint)
        else:
            target = self.target.names[number - 1]
            self.map = before.with_pair(joint, target, self._roles.get(target))
        self._show()
        self._mark()
        self._play()

    def _show(self) -> None:
        """Show the map in the table, and what is missing in words."""
        look = DARK if self.palette().window().color().lightness() < 128 else LIGHT
        for name, item in self.rows.items():
            pair = self.map.of(name)
            if name in self.combos:
                self.combos[name].setCurrentIndex(self._number(name))
            item.setText(2, describe_joint_role(pair.role) if pair is not None else "")
            item.setText(3, f"{100 * pair.sure:.0f} %" if pair is not None else "")
            item.setText(4, tr(pair.why) if pair is not None else tr("moves nothing"))
            item.setToolTip(4, item.text(4))
            unsure = pair is not None and pair.sure < 0.7
            for column in range(5):
                item.setForeground(
                    column,
                    QColor(
                        look.dim if pair is None else look.warning if unsure and column == 3 else look.text
                    ),
                )
        missing = self.map.missing_roles
        free = len(self.target) - len({p.target for p in self.map.pairs})
        words = tr(
            "{mapped} of {joints} joints are mapped.", mapped=len(self.map.pairs), joints=len(self.source)
        )
        if free:
            words += tr(" {free} joints of your character follow their parents.", free=free)
        if missing:
            parts = [describe_joint_role(role) for role in missing]
            more = tr(" and {count} more", count=len(parts) - 4) if len(parts) > 4 else ""
            words = tr(
                "Still missing: {parts}{more}. Choose what moves them above. If your own "
                "character's joints are unknown, set them first under Graph, Skeleton.",
                parts=", ".join(parts[:4]),
                more=more,
            )
        self.missing.setText(words)
        self.missing.setStyleSheet(f"color: {look.warning}" if missing else "")
        self.go.setEnabled(not missing)
        self.everything.setEnabled(not missing)
        self._narrow()

    def _narrow(self, *_: object) -> None:
        for name, item in self.rows.items():
            pair = self.map.of(name)
            item.setHidden(self.doubtful.isChecked() and pair is not None and pair.sure >= 0.9)

    def _touch(self, contacts: bool) -> None:
        self.map = replace(self.map, contacts=contacts)
        self._before = ("", self.map)
        self._play()

    def _mark(self, *_: object) -> None:
        item = self.tree.currentItem()
        pair = self.map.of(item.data(0, JOINT)) if item is not None else None
        self.figures.mark(
            item.data(0, JOINT) if item is not None else "", pair.target if pair is not None else ""
        )

    # --- the picture

    def _play(self) -> None:
        """Play the chosen clip, and what becomes of it, on both figures."""
        self._asked += 1
        asked, joint_map, bringing = self._asked, self.map, self.bringing
        clip = self.strangers.clips[max(0, self.clip.currentIndex())][3]
        clip = clip.trimmed(0, min(SHOWN, clip.frames))
        self.figures.show_clips(clip, None)
        if joint_map.missing:
            self.trouble.setText(tr("The preview moves your character as soon as nothing is missing."))
            return
        self.trouble.clear()

        def done(brought: Clip) -> None:
            if asked == self._asked:
                self.figures.show_clips(clip, brought)

        def failed(error: Exception) -> None:
            if asked == self._asked:
                self.trouble.setText(tr_error(error))

        self.jobs.start(
            tr("Previewing the joint map"),
            lambda _: bringing.bring(clip, joint_map),
            done,
            failed,
            quick=True,
        )
