"""Plots: what their axes show follows the language."""

from __future__ import annotations

import pytest

from app import translation
from app.widgets.still_plot import NumberAxis

pytestmark = pytest.mark.window


@pytest.mark.parametrize(("language", "shown"), [("en", "0.5"), ("de", "0,5"), ("pl", "0,5")])
def test_axes_write_numbers_as_the_language_does(qapp: object, language: str, shown: str) -> None:
    translation.choose(language)
    try:
        assert shown in NumberAxis("left").tickStrings([0.0, 0.5, 1.0], 1.0, 0.5)
    finally:
        translation.choose("en")
