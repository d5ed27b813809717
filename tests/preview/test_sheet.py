"""Contact sheets and PNG files."""

from __future__ import annotations

import numpy as np
import pytest

from metagraph.errors import FileError
from preview.sheet import make_contact_sheet, write_png


def image(value, size=(40, 60), channels=3):
    return np.full((*size, channels), value, np.uint8)


def test_no_images_give_a_small_sheet():
    assert make_contact_sheet([], 4).shape[2] == 3


def test_images_lie_in_rows_in_order():
    sheet = make_contact_sheet([image(50), image(100), image(200)], 2, gap=10)
    assert sheet.shape == (110, 150, 3)
    assert sheet[30, 40].tolist() == [50] * 3
    assert sheet[30, 110].tolist() == [100] * 3
    assert sheet[80, 40].tolist() == [200] * 3


def test_images_of_other_sizes_and_with_alpha_are_taken():
    sheet = make_contact_sheet([image(50, (20, 20)), image(100, channels=4)], 2)
    assert sheet.dtype == np.uint8


def test_labels_titles_and_notes_are_written_and_long_ones_do_not_run_into_the_neighbour():
    plain = make_contact_sheet([image(0)] * 2, 2)
    long = "a name much too long for so small a picture, ÄÖ 漢"
    sheet = make_contact_sheet([image(0)] * 2, 2, ["wave", long], "Title", ["1.2 s", "2 s"], gap=12)
    assert sheet.shape[0] > plain.shape[0] + 40
    assert (sheet[:20].max(axis=(1, 2)) > 200).any()
    gap = sheet[:, 72:84]
    assert np.ptp(gap[40:].reshape(-1, 3).astype(int), axis=0).max() == 0


def test_a_png_comes_back(tmp_path):
    from PIL import Image

    picture = np.arange(4 * 5 * 4, dtype=np.uint8).reshape(4, 5, 4)
    write_png(tmp_path / "a.png", picture)
    with Image.open(tmp_path / "a.png") as back:
        assert np.array_equal(np.asarray(back), picture)


def test_a_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(FileError, match="folder"):
        write_png(tmp_path / "none" / "a.png", image(0))
