"""More contrast, less motion and larger text are the user's, and are kept."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QSettings

from app.look.comfort import FACTOR, Comfort, get_comfort, read_comfort, scale_application, set_comfort
from app.look.theme import HIGH_DARK, HIGH_LIGHT, LIGHT, get_theme

pytestmark = pytest.mark.window


@pytest.fixture(autouse=True)
def usual(qapp):
    yield
    QSettings().clear()
    read_comfort()


def test_what_is_chosen_is_kept_for_later_runs():
    assert read_comfort() == Comfort()
    set_comfort(contrast=True, still=True, size=125)
    assert read_comfort() == get_comfort() == Comfort(True, True, 125)


def test_the_themes_have_more_contrast_where_it_is_chosen():
    assert get_theme("light") is LIGHT
    set_comfort(contrast=True)
    assert get_theme("light") is HIGH_LIGHT and get_theme("no such") is HIGH_DARK


def test_all_is_drawn_larger_from_the_next_start_on_unless_the_environment_says_how_large():
    bare, own = {}, {FACTOR: "2"}
    scale_application(bare)
    assert bare == {}
    set_comfort(size=125)
    scale_application(bare)
    scale_application(own)
    assert bare == {FACTOR: "1.25"} and own == {FACTOR: "2"}


@pytest.mark.parametrize("found", ["", "7", "large", "-125"])
def test_a_size_that_there_is_not_is_the_usual_one(found):
    QSettings().setValue("comfort/size", found)
    assert read_comfort().size == 100
