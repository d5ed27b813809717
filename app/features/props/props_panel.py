"""The props panel: which props there are, where they stand or which joint carries them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import msgspec
from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QBoxLayout,
    QFileDialog,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from app.features.props.floor_plan import FloorPlan
from app.features.props.placing import Placing
from app.look.names import make_readable_name
from app.project.jobs import Jobs
from app.stage.figures import Figures
from app.stage.prop_contacts import list_prop_tops
from app.stage.seat_fit import SAME, find_carrying_prop, fit_prop_to_seat, measure_seat_height
from app.stage.session import StageSession
from app.translation import tr, tr_error, tr_noop, tr_plural
from app.widgets.quiet_fields import ComboBox, DoubleSpinBox
from metagraph.errors import FileError
from metagraph.formats.project.paths import make_path_for_project
from metagraph.formats.props.reader import ENDINGS
from metagraph.graph.edit_error import EditError
from metagraph.graph.editing.props import add_prop, find_grip, remove_prop
from metagraph.graph.model import Project
from metagraph.graph.prop import LARGEST, Prop
from metagraph.graph.seats import find_seat
from metagraph.motion.character_mesh import CharacterMesh
from metagraph.motion.roles import find_roles

SAMPLES = Path(__file__).resolve().parents[3] / "sample_clips" / "props"
FIELDS = (
    ("at", 0, tr_noop("Right"), " m", 0.05, 3),
    ("at", 1, tr_noop("Up"), " m", 0.05, 3),
    ("at", 2, tr_noop("Front"), " m", 0.05, 3),
    ("turn", 0, tr_noop("Tip"), "°", 5.0, 1),
    ("turn", 1, tr_noop("Turn"), "°", 5.0, 1),
    ("turn", 2, tr_noop("Roll"), "°", 5.0, 1),
)
BESIDE, GAP = 0.5, 0.1  # metres: from the character to the first prop that is added, and between props
NUMBER = 72  # pixels: the least width of a number
WIDE = 560  # pixels from which the parts are side by side
HANDS = ("right_hand", "left_hand", "head")  # roles of joints that are offered before the other joints


class PropsPanel(QWidget):
    """Lists the project's props, and edits the chosen one."""

    def __init__(
        self, session: StageSession, figures: Figures, jobs: Jobs, placing: Placing, parent: QWidget
    ) -> None:
        super().__init__(parent)
        document = self.document = placing.document
        self.session, self.figures, self.jobs, self.placing = session, figures, jobs, placing
        self.current = ""
        self._showing = False
        self.add_button = QPushButton(tr("Add a prop…"), self)
        self.add_button.clicked.connect(self.ask)
        self.remove_button = QPushButton(tr("Remove"), self)
        self.remove_button.clicked.connect(self.remove)
        self.list = QListWidget(self)
        self.list.setAccessibleName(tr("Props"))
        self.list.currentItemChanged.connect(lambda item, _: self._choose(item))
        self.list.itemClicked.connect(self._choose)
        self.plan = FloorPlan(session, figures.props.meshes, placing, self)
        self.plan.chosen.connect(self.choose)
        self.empty = QLabel(
            tr(
                "A prop is a desk, a cup or a wall: an OBJ, STL, PLY, OFF, 3MF or GLB file. Add one of the "
                "samples, or drop a file of yours on the window."
            ),
            self,
        )
        self.empty.setWordWrap(True)
        self.empty.setProperty("dim", True)
        self._lay_out()
        document.changed.connect(self._follow)
        document.loaded.connect(self.refresh)
        figures.changed.connect(self.refresh)
        session.look.changed.connect(self.plan.update)
        placing.changed.connect(self._follow_choice)
        self.refresh()

    def _lay_out(self) -> None:
        buttons = QHBoxLayout()
        buttons.addWidget(self.add_button)
        buttons.addWidget(self.remove_button)
        buttons.addStretch(1)
        self.fields = QWidget(self)
        grid = QGridLayout(self.fields)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(8)
        self.joint = ComboBox(self.fields)
        self.joint.setAccessibleName(tr("Carried by"))
        self.joint.activated.connect(lambda _: self._set_joint())
        grid.addWidget(QLabel(tr("Carried by"), self.fields), 0, 0)
        grid.addWidget(self.joint, 0, 1, 1, 3)
        self.joint.setMaxVisibleItems(14)
        self.joint.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.joint.setMinimumContentsLength(10)
        self.numbers: dict[tuple[str, int], DoubleSpinBox] = {}
        for n, (name, place, words, unit, step, decimals) in enumerate(FIELDS):
            row, column = 1 + n // 3, 2 * (n % 3)
            self._add_number(grid, row, column, (name, place), tr(words), unit, step, decimals)
        self._add_number(grid, 0, 4, ("scale", 0), tr("Size"), " ×", 0.1, 3)
        self.numbers["scale", 0].setRange(0.001, LARGEST)
        for column in (1, 3, 5):
            grid.setColumnStretch(column, 1)
        grid.setRowStretch(4, 1)
        self.seat_words = QLabel(self.fields)
        self.seat_words.setWordWrap(True)
        self.seat_button = QPushButton(tr("Fit to who sits"), self.fields)
        self.seat_button.setToolTip(
            tr("Makes the prop as high as the body above it: larger or smaller, or lifted if it is")
        )
        self.seat_button.clicked.connect(self.fit)
        grid.addWidget(self.seat_words, 3, 0, 1, 4)
        grid.addWidget(self.seat_button, 3, 4, 1, 2)
        self.outside = QLabel(self)
        self.outside.setWordWrap(True)
        self.copy_button = QPushButton(tr("Copy into the project's folder"), self)
        self.copy_button.clicked.connect(self.copy_outside)
        left = QVBoxLayout()
        left.setSpacing(8)
        left.addLayout(buttons)
        left.addWidget(self.outside)
        left.addWidget(self.copy_button, 0, Qt.AlignmentFlag.AlignLeft)
        left.addWidget(self.empty)
        left.addWidget(self.list, 1)
        inner = QWidget(self)
        self._layout = QBoxLayout(QBoxLayout.Direction.TopToBottom, inner)
        self._layout.setContentsMargins(12, 8, 12, 8)
        self._layout.setSpacing(12)
        self._layout.addLayout(left, 2)
        self._layout.addWidget(self.plan, 3)
        self._layout.addWidget(self.fields)
        area = QScrollArea(self)
        area.setWidgetResizable(True)
        area.setWidget(inner)
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.addWidget(area)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Where it is wide, its parts are side by side."""
        super().resizeEvent(event)
        wide = event.size().width() >= WIDE
        directions = QBoxLayout.Direction
        self._layout.setDirection(directions.LeftToRight if wide else directions.TopToBottom)

    def _add_number(
        self,
        grid: QGridLayout,
        row: int,
        column: int,
        key: tuple[str, int],
        words: str,
        unit: str,
        step: float,
        decimals: int,
    ) -> None:
        box = DoubleSpinBox(
            self.fields, minimum=-LARGEST, maximum=LARGEST, singleStep=step, decimals=decimals, suffix=unit
        )
        box.setKeyboardTracking(False)
        box.setMinimumWidth(NUMBER)
        box.setAccessibleName(words)
        box.valueChanged.connect(lambda value: self._set_number(key, value))
        self.numbers[key] = box
        grid.addWidget(QLabel(words, self.fields), row, column)
        grid.addWidget(box, row, column + 1)

    # --- showing

    @property
    def prop(self) -> Prop | None:
        """The chosen prop."""
        return self.document.project.props.get(self.current)

    def _follow(self, before: Project, after: Project) -> None:
        if before.props is not after.props or before.skeleton is not after.skeleton:
            self.refresh()

    def refresh(self) -> None:
        """Show the props as they are now."""
        props = self.document.project.props
        self.current = self.placing.ident or self.current
        if self.current not in props:
            self.current = next(iter(props), "")
        self._showing = True
        self.list.clear()
        for ident, prop in props.items():
            words = tr("{name}, in {joint}", name=prop.name, joint=make_readable_name(prop.joint))
            item = QListWidgetItem(words if prop.joint else prop.name, self.list)
            item.setData(Qt.ItemDataRole.UserRole, ident)
            problem = self.figures.props.find_problem(prop.path)
            item.setToolTip(problem or prop.path)
            if problem:
                item.setText(tr("{name}: cannot be drawn", name=item.text()))
            if ident == self.current:
                self.list.setCurrentItem(item)
        self._show_fields()
        self._showing = False
        usable = self.document.project.skeleton is not None
        self.add_button.setEnabled(usable)
        self.remove_button.setEnabled(bool(self.current))
        for widget in (self.list, self.plan, self.fields):
            widget.setVisible(bool(props))
        self.empty.setVisible(not props)
        self._show_outside()
        self.plan.set_current(self.current)

    def _find_outside(self) -> dict[str, Path]:
        """Return the files of props outside the project's folder, by their ids; none until it has one."""
        from metagraph.formats.props.copying import find_outside_props

        folder = self.document.folder
        return {} if folder is None else find_outside_props(self.document.project, folder)

    def _show_outside(self) -> None:
        """Say which props do not go where the project's folder goes."""
        found = self._find_outside()
        names = ", ".join(dict.fromkeys(place.name for place in found.values()))
        self.outside.setText(
            tr("Outside the project's folder: {names}. Who gets the folder does not get them.", names=names)
        )
        for widget in (self.outside, self.copy_button):
            widget.setVisible(bool(found))

    def copy_outside(self) -> None:
        """Copy the files of props outside the project's folder into it on a thread, and use the copies."""
        from metagraph.formats.props.copying import copy_props, set_prop_paths

        found, folder = self._find_outside(), self.document.folder
        if folder is None or not found:
            return

        def use(result: tuple[dict[str, str], list[FileError]]) -> None:
            paths, bad = result
            if paths and folder == self.document.folder:
                words = tr_plural("Copy {count} prop", "Copy {count} props", len(paths))
                self.document.edit(words, lambda project: set_prop_paths(project, paths))
            for error in bad:
                self.document.failed.emit(tr_error(error))

        self.jobs.start(
            "copy props",
            lambda _: copy_props(found, folder),
            use,
            lambda error: self.document.failed.emit(tr_error(error)),
        )

    def _show_fields(self) -> None:
        prop = self.prop or Prop(name="", path="")
        for (name, place), box in self.numbers.items():
            value = getattr(prop, name)
            box.setValue(value if name == "scale" else value[place])
        skeleton = self.document.project.skeleton
        names = list(skeleton.names) if skeleton is not None else []
        roles = find_roles(skeleton) if skeleton is not None else {}
        first = [names[roles[role]] for role in HANDS if role in roles]
        self.joint.clear()
        self.joint.addItem(tr("Nobody: it stands"), "")
        for joint in [*first, *(name for name in names if name not in first)]:
            self.joint.addItem(make_readable_name(joint), joint)
        self.joint.choose(prop.joint)
        self._show_seat()

    def _measure_seat(self) -> tuple[float, float] | None:
        """Return how high the chosen prop is below who sits on it, and how high it should be, metres; None if
        nobody sits on it.
        """
        project, meshes = self.document.project, self.figures.props.meshes
        seat = find_seat(project) if self.current in project.props else None
        if seat is None or project.skeleton is None:
            return None
        ident, top = find_carrying_prop(project, meshes, seat)
        figure = self.figures.figure(project.skeleton) if ident == self.current else None
        return (top, measure_seat_height(project, seat, figure)) if figure is not None else None

    def _show_seat(self) -> None:
        """Say how well the chosen prop carries who sits on it."""
        found, prop = self._measure_seat(), self.prop
        words = ""
        if found is not None and prop is not None:
            off = round((found[0] - found[1]) * 100)
            if off > 0:
                words = tr("The body sinks {off} cm into {name}", off=off, name=prop.name)
            elif off < 0:
                words = tr("The body sits {off} cm above {name}", off=-off, name=prop.name)
            else:
                words = tr("The body sits on {name}", name=prop.name)
        hands = self._measure_hands() if found is None else None
        if hands is not None and prop is not None:
            off = round(hands[0] * 100)
            if off > 0:
                words = tr("Hands pass {off} cm below the top of {name}", off=off, name=prop.name)
            else:
                words = tr("Hands rest on {name}", name=prop.name)
        self.seat_button.setText(tr("Fit to the hands") if hands is not None else tr("Fit to who sits"))
        self.seat_button.setToolTip(
            tr("Makes the prop so low that hands rest on it: smaller, or lower if it is lifted")
            if hands is not None
            else tr("Makes the prop as high as the body above it: larger or smaller, or lifted if it is")
        )
        self.seat_words.setText(words)
        self.seat_words.setVisible(bool(words))
        self.seat_button.setVisible(bool(words))
        sinks = found is not None and abs(found[0] - found[1]) > SAME
        self.seat_button.setEnabled(sinks or (hands is not None and hands[0] > 0))

    def _measure_hands(self) -> tuple[float, float] | None:
        """Return how far hands pass below the chosen prop, and how high it is, metres; None if no hand comes
        there.
        """
        from app.stage.hand_fit import measure_hands_below

        prop = self.prop
        if prop is None or prop.joint:
            return None
        return measure_hands_below(self.document.project, list_prop_tops(prop, self.figures.props.meshes))

    def fit(self) -> None:
        """Make the chosen prop as high as who sits on it, or so low that hands rest on it."""
        from app.stage.hand_fit import find_fitting_height

        prop, hands = self.prop, self._measure_hands()
        if prop is None or self._measure_seat() is not None:
            self.fit_to_seat()
        elif hands is not None:
            fitted = fit_prop_to_seat(prop, hands[1], find_fitting_height(*hands))
            self.placing.edit(tr("Fit {name} to the hands", name=prop.name), self.current, fitted)

    def fit_to_seat(self) -> None:
        """Make the chosen prop as high as who sits on it."""
        found, prop = self._measure_seat(), self.prop
        if found is not None and prop is not None:
            fitted = fit_prop_to_seat(prop, *found)
            self.placing.edit(tr("Fit {name} to who sits", name=prop.name), self.current, fitted)

    # --- choosing and editing

    def _choose(self, item: QListWidgetItem | None) -> None:
        if item is not None and not self._showing:
            self.choose(str(item.data(Qt.ItemDataRole.UserRole)))

    def choose(self, ident: str) -> None:
        """Choose a prop by its id; "" chooses none other."""
        if ident:
            self.placing.choose(ident)

    def _follow_choice(self) -> None:
        """Show the prop that was chosen, in the view perhaps; the last one if none is."""
        if self.placing.ident and self.placing.ident != self.current:
            self.current = self.placing.ident
            self.refresh()

    def _set_number(self, key: tuple[str, int], value: float) -> None:
        prop = self.prop
        if prop is None or self._showing:
            return
        name, place = key
        if name == "scale":
            self.placing.edit(
                tr("Resize {name}", name=prop.name), self.current, msgspec.structs.replace(prop, scale=value)
            )
            return
        values = list(getattr(prop, name))
        values[place] = round(value, 4)
        changed = msgspec.structs.replace(prop, **{name: tuple(values)})
        self.placing.edit(tr("Move {name}", name=prop.name), self.current, changed)

    def _set_joint(self) -> None:
        prop, joint = self.prop, str(self.joint.currentData() or "")
        if prop is None or joint == prop.joint:
            return
        at, turn = (0.0, 0.0, 0.5), (0.0, 0.0, 0.0)
        if joint:
            at, turn = find_grip(self.document.project, joint)
        changed = msgspec.structs.replace(prop, joint=joint, at=at, turn=turn)
        words = tr("Carry {name}", name=prop.name) if joint else tr("Put {name} down", name=prop.name)
        self.placing.edit(words, self.current, changed)

    def remove(self) -> None:
        """Remove the chosen prop."""
        prop, ident = self.prop, self.current
        if prop is not None:
            self.document.edit(
                tr("Remove {name}", name=prop.name), lambda project: remove_prop(project, ident)
            )

    def ask(self) -> None:
        """Ask which files to add."""
        kinds = tr("Props ({endings})", endings=" ".join(f"*{ending}" for ending in ENDINGS))
        start = str(SAMPLES if SAMPLES.is_dir() else self.document.folder or Path.home())
        names, _ = QFileDialog.getOpenFileNames(self, tr("Add props"), start, kinds)
        if names:
            self.add([Path(name) for name in names])

    def add(self, paths: Sequence[Path]) -> None:
        """Read files on a thread, and add those that can be drawn as one step; say why others cannot."""
        from metagraph.formats.clips import digest
        from metagraph.formats.props.reader import read_prop

        digests: dict[Path, str] = {}

        def read(_: object) -> tuple[dict[Path, CharacterMesh], list[FileError]]:
            good, bad = {}, []
            for path in paths:
                try:
                    good[path], digests[path] = read_prop(path), digest(path)
                except FileError as error:
                    bad.append(error)
            return good, bad

        def place(result: tuple[dict[Path, CharacterMesh], list[FileError]]) -> None:
            good, bad = result
            for path, mesh in good.items():
                self.figures.props.keep_mesh(path, mesh)
            if good:
                self._place([path for path in paths if path in good], good, digests)
            for error in bad:
                self.document.failed.emit(tr_error(error))

        self.jobs.start("props", read, place, lambda error: self.document.failed.emit(tr_error(error)))

    def _place(
        self, paths: Sequence[Path], meshes: Mapping[Path, CharacterMesh], digests: Mapping[Path, str]
    ) -> None:
        """Add props in a row beside the character, to the viewer's right, none in another."""
        added: list[str] = []
        standing = [p for p in self.plan.props.values() if abs(p.at[2]) < BESIDE]
        ends = [max(x for x, _ in self.plan.find_corners(prop)) + GAP for prop in standing]

        def edit(project: Project) -> Project:
            right = max((BESIDE, *ends))
            for path in paths:
                low, high = (
                    float(meshes[path].positions[:, 0].min()),
                    float(meshes[path].positions[:, 0].max()),
                )
                at = (round(right - low, 3), 0.0, 0.0)
                place, sha256 = make_path_for_project(path, self.document.folder), digests.get(path, "")
                prop = Prop(name=path.stem, path=place, at=at, sha256=sha256)
                project, ident = add_prop(project, prop)
                added.append(ident)
                right += high - low + GAP
            return project

        words = (
            tr("Add {name}", name=paths[0].stem)
            if len(paths) == 1
            else tr("Add {count} props", count=len(paths))
        )
        try:
            self.document.edit(words, edit)
        except EditError as error:
            self.document.failed.emit(tr_error(error))
            return
        self.choose(added[-1])
