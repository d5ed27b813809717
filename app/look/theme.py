"""Looks: palettes, the four kinds' colours, the style sheet. Colour means kind and nothing else; warnings are
yellow.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from PySide6.QtGui import QColor, QFont, QFontDatabase, QPalette
from PySide6.QtWidgets import QApplication, QPushButton

from app.look.comfort import get_comfort
from app.look.domain_words import KIND_TITLES as KIND_TITLES
from metagraph.graph.model import Kind
from preview.typeface import FAMILY, WEIGHTS, find_typeface_file

FONT_PIXELS = 15


@dataclass(frozen=True)
class WindowTheme:
    """Colours as #rrggbb. ground: behind panels; panel, card, field: ever closer to the eye; line:
    borders.
    """

    name: str
    ground: str
    panel: str
    card: str
    field: str
    hover: str
    line: str
    text: str
    dim: str
    strong: str  # the one filled button, selected tabs
    on_strong: str
    warning: str
    error: str
    kinds: Mapping[str, str]  # text and marks, contrast of at least 4.5:1 on panel and card
    fills: Mapping[str, str]  # areas
    sounds: Mapping[
        str, str
    ]  # areas of what is said; distinguished by colour-blind people by their lightness, too
    high: bool = False  # contrast of at least 7:1

    def kind(self, kind: Kind | str) -> QColor:
        return QColor(self.kinds[kind])

    def fill(self, kind: Kind | str) -> QColor:
        return QColor(self.fills[kind])


_SOUNDS = {"clause": "#e05a7f", "response": "#d9e57f", "hesitation": "#aab1bc"}
_KINDS = {"stance": "#3fb8a6", "gesture": "#f0a63c", "fidget": "#a98bf0", "transition": "#5aa3f0"}
DARK = WindowTheme(
    "dark",
    ground="#17181b",
    panel="#1e2024",
    card="#25282d",
    field="#191b1f",
    hover="#2e3238",
    line="#34383f",
    text="#dfe3e8",
    dim="#9aa1ab",
    strong="#e8eaed",
    on_strong="#17181b",
    warning="#e8c24a",
    error="#ff7a6e",
    kinds=_KINDS,
    fills=_KINDS,
    sounds=_SOUNDS,
)
LIGHT = WindowTheme(
    "light",
    ground="#e9ebee",
    panel="#f6f7f8",
    card="#ffffff",
    field="#ffffff",
    hover="#e4e7eb",
    line="#cdd2d8",
    text="#1d2126",
    dim="#59616b",
    strong="#23272d",
    on_strong="#ffffff",
    warning="#7d5b00",
    error="#b3261e",
    kinds={"stance": "#127065", "gesture": "#8f5a00", "fidget": "#6a45c4", "transition": "#1a63b8"},
    fills=_KINDS,
    sounds=_SOUNDS,
)
HIGH_DARK = replace(
    DARK,
    ground="#000000",
    panel="#000000",
    card="#0c0c0c",
    field="#000000",
    hover="#333333",
    line="#8c8c8c",
    text="#ffffff",
    dim="#d6d6d6",
    strong="#ffffff",
    on_strong="#000000",
    warning="#ffdb3a",
    error="#ffb3ab",
    kinds={"stance": "#62e3d2", "gesture": "#ffc062", "fidget": "#cdbbff", "transition": "#93c9ff"},
    high=True,
)
HIGH_LIGHT = replace(
    LIGHT,
    ground="#ffffff",
    panel="#ffffff",
    card="#ffffff",
    field="#ffffff",
    hover="#dedede",
    line="#626262",
    text="#000000",
    dim="#2e2e2e",
    strong="#000000",
    on_strong="#ffffff",
    warning="#543e00",
    error="#85120c",
    kinds={"stance": "#0a4a43", "gesture": "#603c00", "fidget": "#472b91", "transition": "#0e427c"},
    high=True,
)
THEMES = {"dark": DARK, "light": LIGHT}
HIGH = {"dark": HIGH_DARK, "light": HIGH_LIGHT}
KIND_MARKS = {"stance": "●", "gesture": "▲", "fidget": "◆", "transition": "➜"}  # never colour alone
SOUND_MARKS = {"clause": "■", "response": "✓", "hesitation": "…"}


def get_theme(name: str) -> WindowTheme:
    """Return the theme of a name, in high contrast if the user chose that; the dark one for names that no
    theme has.
    """
    themes = HIGH if get_comfort().contrast else THEMES
    return themes.get(name, themes["dark"])


def make_palette(look: WindowTheme) -> QPalette:
    """Return the palette of a theme for Qt, with colours of its own for what is disabled."""
    out = QPalette()
    role = QPalette.ColorRole
    for key, color in (
        (role.Window, look.panel),
        (role.WindowText, look.text),
        (role.Base, look.field),
        (role.AlternateBase, look.card),
        (role.Text, look.text),
        (role.Button, look.card),
        (role.ButtonText, look.text),
        (role.ToolTipBase, look.card),
        (role.ToolTipText, look.text),
        (role.Highlight, look.hover),
        (role.HighlightedText, look.text),
        (role.PlaceholderText, look.dim),
        (role.Link, look.text),
        (role.Mid, look.line),
        (role.Dark, look.line),
        (role.BrightText, look.error),
        (role.Light, look.hover),
        (role.Midlight, look.hover),
        (role.Shadow, look.ground),
    ):
        out.setColor(key, QColor(color))
    for item in (role.Text, role.WindowText, role.ButtonText):
        faded = QColor(look.dim)
        faded.setAlpha(140)
        out.setColor(QPalette.ColorGroup.Disabled, item, faded)
    return out


MARKS = (Path(__file__).parent / "marks").as_posix()  # pictures a style sheet names by their files


def make_style_sheet(look: WindowTheme) -> str:
    """Return the style of the whole window; 8 px grid, 6 px radius, no gradients.

    Labels, message boxes and tooltips show text as it is: a name from a stranger's file may look like HTML,
    which Qt would show as such, and open the pictures it names. A label for rich text sets its format itself.
    """
    t, marks = look, MARKS.replace("\\", "\\\\").replace('"', '\\"')
    return f"""
    * {{ font-size: {FONT_PIXELS}px; }}
    QLabel[textFormat="AutoText"], QToolTip {{ qproperty-textFormat: PlainText; }}
    QMainWindow, QMainWindow::separator {{ background: {t.ground}; }}
    QMainWindow::separator {{ width: 6px; height: 6px; }}
    QMainWindow::separator:hover {{ background: {t.line}; }}
    QToolTip {{ background: {t.card}; color: {t.text}; border: 1px solid {t.line}; padding: 4px 6px; }}
    QDockWidget {{ color: {t.dim}; font-weight: 600; }}
    QDockWidget::title {{ background: {t.panel}; padding: 8px 10px 4px 10px; border-bottom: 1px solid {t.line}; }}
    QDockWidget > QWidget {{ background: {t.panel}; }}
    QToolBar {{ background: {t.panel}; border: none; border-bottom: 1px solid {t.line}; padding: 5px 8px; spacing: 4px; }}
    QToolBar QToolButton {{ padding: 5px 9px; }}
    QToolBar[slim="1"] QToolButton {{ padding: 5px 6px; }}
    QToolBar[slim="2"] QToolButton {{ padding: 5px 4px; }}
    QToolBar QToolButton#qt_toolbar_ext_button {{ padding: 0; }}
    QToolBar::separator {{ background: {t.line}; width: 1px; margin: 6px 4px; }}
    QStatusBar {{ background: {t.panel}; color: {t.dim}; border-top: 1px solid {t.line}; }}
    QStatusBar::item {{ border: none; }}
    QMenuBar {{ background: {t.panel}; color: {t.text}; padding: 2px 6px; }}
    QMenuBar::item {{ padding: 4px 8px; border-radius: 4px; }}
    QMenuBar::item:selected, QMenu::item:selected {{ background: {t.hover}; }}
    QMenu {{ background: {t.card}; color: {t.text}; border: 1px solid {t.line}; padding: 4px; }}
    QMenu::item {{ padding: 5px 28px 5px 20px; border-radius: 4px; }}
    QMenu::item:disabled {{ color: {t.dim}; }}
    QMenu::separator {{ height: 1px; background: {t.line}; margin: 4px 8px; }}
    QToolButton, QPushButton {{ background: transparent; color: {t.text}; border: 1px solid transparent;
        border-radius: 6px; padding: 5px 10px; }}
    QPushButton {{ background: {t.card}; border-color: {t.line}; }}
    QToolButton:hover, QPushButton:hover {{ background: {t.hover}; }}
    QToolButton::menu-indicator {{ image: none; }}
    QToolButton[tight="true"] {{ padding: 5px 4px; }}
    QToolButton:checked {{ background: {t.hover}; border-color: {t.line}; }}
    QToolButton:disabled, QPushButton:disabled {{ color: {t.dim}; }}
    QToolButton:focus, QPushButton:focus {{ border-color: {t.dim}; }}
    QPushButton[strong="true"] {{ background: {t.strong}; color: {t.on_strong}; border-color: {t.strong}; font-weight: 600; }}
    QPushButton[strong="true"]:hover {{ background: {t.text}; }}
    QPushButton[strong="true"]:disabled {{ background: {t.card}; color: {t.dim}; border-color: {t.line}; font-weight: 400; }}
    QLineEdit, QDoubleSpinBox, QSpinBox, QComboBox, QPlainTextEdit {{ background: {t.field}; color: {t.text};
        border: 1px solid {t.line}; border-radius: 6px; padding: 4px 8px;
        selection-background-color: {t.dim}; selection-color: {t.ground}; }}
    QLineEdit:focus, QDoubleSpinBox:focus, QSpinBox:focus, QComboBox:focus {{ border-color: {t.dim}; }}
    QAbstractSpinBox::up-button, QAbstractSpinBox::down-button {{ width: 0; border: none; }}
    QComboBox::drop-down {{ border: none; width: 22px; }}
    QComboBox::down-arrow {{ image: url("{marks}/down_{t.name}.svg"); width: 12px; height: 12px; }}
    QCheckBox {{ spacing: 8px; }}
    QCheckBox::indicator, QAbstractItemView::indicator {{ width: 14px; height: 14px; border: 1px solid {t.dim};
        border-radius: 4px; background: {t.field}; }}
    QCheckBox::indicator:checked, QAbstractItemView::indicator:checked {{ image: url("{marks}/check_{t.name}.svg"); }}
    QCheckBox::indicator:indeterminate, QAbstractItemView::indicator:indeterminate {{ image: url("{marks}/part_{t.name}.svg"); }}
    QCheckBox::indicator:disabled, QAbstractItemView::indicator:disabled {{ border-color: {t.line}; }}
    QCheckBox::indicator:focus {{ border-color: {t.text}; }}
    QComboBox QAbstractItemView {{ background: {t.card}; border: 1px solid {t.line}; outline: none; }}
    QAbstractScrollArea::corner {{ background: {t.panel}; border: none; }}
    QListView, QTreeView, QTableView, QScrollArea, QGraphicsView {{ background: {t.panel}; border: none; outline: none; }}
    QHeaderView::section {{ background: {t.panel}; color: {t.dim}; border: none; padding: 5px 8px; }}
    QTreeView::item, QTableView::item {{ padding: 4px; }}
    QTreeView::item:selected, QTableView::item:selected, QListView::item:selected {{ background: {t.hover}; color: {t.text}; }}
    QScrollBar:vertical {{ background: transparent; width: 10px; margin: 0; }}
    QScrollBar:horizontal {{ background: transparent; height: 10px; margin: 0; }}
    QScrollBar::handle {{ background: {t.line}; border-radius: 4px; min-height: 28px; min-width: 28px; margin: 1px; }}
    QScrollBar::handle:hover {{ background: {t.dim}; }}
    QScrollBar::add-line, QScrollBar::sub-line, QScrollBar::add-page, QScrollBar::sub-page {{ background: none; width: 0; height: 0; }}
    QProgressBar {{ background: {t.field}; border: none; border-radius: 5px; text-align: center; max-height: 14px; }}
    QProgressBar::chunk {{ background: {t.dim}; border-radius: 4px; }}
    QProgressBar[textVisible="true"]::chunk {{ background: {t.hover if t.high else t.line}; }}
    QTabBar::tab {{ background: transparent; color: {t.dim}; padding: 6px 14px; border-radius: 6px; margin: 2px; }}
    QTabBar::tab:selected {{ background: {t.hover}; color: {t.text}; }}
    QTabWidget::pane {{ border: none; }}
    QSlider::groove:horizontal {{ height: 4px; background: {t.line}; border-radius: 2px; }}
    QSlider::handle:horizontal {{ width: 14px; margin: -5px 0; border-radius: 7px; background: {t.text}; }}
    QToolButton[over="true"] {{ background: {t.card}; border: 1px solid {t.line}; }}
    QToolButton[over="true"]:hover {{ background: {t.hover}; }}
    QFrame[card="true"] {{ background: {t.card}; border: 1px solid {t.line}; border-radius: 8px; }}
    QLabel[dim="true"] {{ color: {t.dim}; }}
    QLabel[heading="true"] {{ font-size: 18px; font-weight: 600; }}
    QDialogButtonBox {{ dialogbuttonbox-buttons-have-icons: 0; }}
    QLabel[title="true"] {{ font-weight: 600; }}
    QFileDialog {{ min-width: 900px; min-height: 560px;
        filedialog-parent-directory-icon: url("{marks}/up_{t.name}.svg");
        filedialog-new-directory-icon: url("{marks}/folder_add_{t.name}.svg");
        filedialog-listview-icon: url("{marks}/grid_{t.name}.svg");
        filedialog-detailedview-icon: url("{marks}/list_{t.name}.svg");
        backward-icon: url("{marks}/back_{t.name}.svg"); forward-icon: url("{marks}/forth_{t.name}.svg");
        filedialog-backward-icon: url("{marks}/back_{t.name}.svg"); }}
    QFileDialog QToolButton {{ padding: 3px; min-width: 20px; min-height: 20px; }}
    QFileDialog QTreeView {{ font-size: 14px; }}
    QFileDialog QTreeView::item {{ padding: 4px 0; }}
    QGroupBox {{ border: none; margin-top: 18px; font-weight: 600; color: {t.dim}; }}
    QGroupBox::title {{ subcontrol-origin: margin; left: 0; }}
    """


def make_window_font() -> QFont:
    """Return the typeface of the window, the same on every system: Source Sans Pro, and the system's own for
    letters that it does not have.
    """
    for weight in WEIGHTS:
        QFontDatabase.addApplicationFont(str(find_typeface_file(weight)))
    font = QFont(FAMILY)
    font.setPixelSize(FONT_PIXELS)
    return font


def apply_theme(app: QApplication, look: WindowTheme) -> None:
    """Give the application a theme's style."""
    if not app.property("styled"):  # once: each of these polishes every widget again
        app.setProperty("styled", True)
        app.setStyle("Fusion")
        app.setFont(make_window_font())
    shown = f"{look.name}{' high' if look.high else ''}"
    if app.property("look") != shown:
        app.setProperty("look", shown)
        app.setPalette(make_palette(look))
        app.setStyleSheet(make_style_sheet(look))


def strengthen(button: QPushButton) -> None:
    """Make a button the filled one; a button of a button box is styled before it can be told."""
    button.setProperty("strong", True)
    button.setDefault(True)
    button.style().polish(button)
