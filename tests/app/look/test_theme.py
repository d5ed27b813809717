"""Both themes can be read: contrast as WCAG 2.1 defines it, at least 4.5 : 1 for words."""

from __future__ import annotations

import shutil
import sys

import pytest
from PySide6.QtGui import QImage, QPalette
from PySide6.QtWidgets import QApplication, QCheckBox

from app.look import theme
from app.look.theme import (
    DARK,
    HIGH_DARK,
    HIGH_LIGHT,
    KIND_MARKS,
    KIND_TITLES,
    LIGHT,
    apply_theme,
    get_theme,
    make_palette,
    make_style_sheet,
)
from metagraph.graph.model import KINDS

GROUNDS = ("ground", "panel", "card", "field", "hover")


def luminance(color: str) -> float:
    """Relative luminance of #rrggbb, 0..1 (WCAG 2.1)."""
    channels = (int(color[i : i + 2], 16) / 255 for i in (1, 3, 5))
    r, g, b = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels)
    return 0.2126 * r + 0.7152 * g + 0.0722 * b


def contrast(one: str, other: str) -> float:
    a, b = sorted((luminance(one), luminance(other)), reverse=True)
    return (a + 0.05) / (b + 0.05)


def test_the_measure_itself():
    assert contrast("#000000", "#ffffff") == pytest.approx(21)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.01)


@pytest.mark.parametrize("look", [DARK, LIGHT], ids=["dark", "light"])
@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("ink", ["text", "dim", "warning", "error", *KINDS])
def test_words_can_be_read_on_every_ground(look, ground, ink):
    color = look.kinds[ink] if ink in KINDS else getattr(look, ink)
    assert contrast(color, getattr(look, ground)) >= 4.5


@pytest.mark.parametrize("look", [DARK, LIGHT], ids=["dark", "light"])
def test_words_can_be_read_on_the_filled_button_and_on_cues(look):
    assert contrast(look.on_strong, look.strong) >= 4.5
    assert contrast(look.on_strong, look.text) >= 4.5, "under the pointer it is filled with the text's colour"
    for kind in KINDS:
        assert contrast("#17181b", look.fills[kind]) >= 4.5, "names on cues of the timeline"


@pytest.mark.parametrize("look", [HIGH_DARK, HIGH_LIGHT], ids=["dark", "light"])
@pytest.mark.parametrize("ground", GROUNDS)
def test_in_high_contrast_words_have_seven_to_one_and_borders_three(look, ground):
    """WCAG 2.1, 1.4.6 and 1.4.11."""
    below = getattr(look, ground)
    for color in (look.text, look.dim, look.warning, look.error, *look.kinds.values()):
        assert contrast(color, below) >= 7, (color, below)
    assert contrast(look.line, below) >= 3


def test_colour_is_never_alone():
    assert len(set(KIND_MARKS.values())) == len(KINDS) == len(set(KIND_TITLES.values()))


def test_an_unknown_theme_is_the_dark_one():
    assert get_theme("no such") is DARK


@pytest.mark.nightly
def test_applying_a_theme_reaches_palette_and_style(qapp):
    for look in (LIGHT, DARK):
        apply_theme(QApplication.instance(), look)
        assert QApplication.palette().color(QPalette.ColorRole.Window).name() == look.panel
        assert qapp.styleSheet() == make_style_sheet(look)
        assert make_palette(look).color(QPalette.ColorRole.PlaceholderText).name() == look.dim


@pytest.mark.parametrize("folder", ["Meine Programme – ü", "it's (new) #1; {a}", 'a "quoted" one', "plain"])
@pytest.mark.parametrize("look", [DARK, LIGHT], ids=lambda look: look.name)
def test_the_style_works_wherever_metagraph_is_installed(qapp, tmp_path, monkeypatch, folder, look):
    """A path that cannot be written in a style sheet leaves the whole window without its style."""
    if sys.platform == "win32" and '"' in folder:
        pytest.skip("Windows has no such names")

    def draw() -> QImage:
        box = QCheckBox("x")
        box.setStyleSheet(make_style_sheet(look))
        box.setChecked(True)
        image = box.grab().toImage()
        box.deleteLater()
        return image

    usual = draw()
    place = tmp_path / folder
    shutil.copytree(theme.MARKS, place)
    monkeypatch.setattr(theme, "MARKS", place.as_posix())
    assert draw() == usual
    blank = shutil.copytree(place, tmp_path / "blank")
    for mark in blank.glob("*.svg"):
        mark.write_text('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"/>', encoding="utf-8")
    monkeypatch.setattr(theme, "MARKS", blank.as_posix())
    assert draw() != usual, "the mark is drawn from its file"
