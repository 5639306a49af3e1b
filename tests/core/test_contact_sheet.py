"""Contact sheets: every picture stands where it belongs bit for bit, every caption has ink inside the sheet."""

from __future__ import annotations

import numpy as np
import pytest

from texlab_core.errors import InputError
from texlab_core.sheets.contact_sheet import Tile, check_sheet, contact_sheet, font_size, series_columns


def pictures(count, height=40, width=30, channels=3):
    random = np.random.default_rng(4)
    return [random.integers(0, 256, (height, width, channels), np.uint8) for _ in range(count)]


def floats(picture):
    return (picture / np.float32(255)).astype(np.float32)


def find(sheet, picture):
    """Return every place where the picture stands in the sheet."""
    height, width = picture.shape[:2]
    windows = np.lib.stride_tricks.sliding_window_view(sheet[:, :, 0], (height, width))
    corner = picture[:, :, 0]
    rows, columns = np.nonzero((windows[:, :, 0, 0] == corner[0, 0]) & (windows[:, :, -1, -1] == corner[-1, -1]))
    places = zip(rows.tolist(), columns.tolist(), strict=True)
    return [(y, x) for y, x in places if np.array_equal(sheet[y : y + height, x : x + width], picture)]


def test_pictures_stand_row_by_row_bit_for_bit():
    shown = pictures(6)
    sheet = contact_sheet([Tile(floats(each), ("caption",)) for each in shown], 3, title=("Title", "below"))
    places = [find(sheet, each) for each in shown]
    assert all(len(found) == 1 for found in places)
    tops, lefts = zip(*(found[0] for found in places), strict=True)
    assert len(set(tops[:3])) == len(set(tops[3:])) == 1
    assert tops[0] < tops[3]
    assert lefts[:3] == lefts[3:]
    assert lefts[0] < lefts[1] < lefts[2]


def test_gray_pictures_are_shown_in_three_equal_channels():
    (gray,) = pictures(1, channels=1)
    sheet = contact_sheet([Tile(floats(gray))], 1)
    assert len(find(sheet, np.repeat(gray, 3, axis=2))) == 1


def test_large_pictures_keep_their_mean_and_shape():
    image = floats(pictures(1, 200, 400)[0])
    sheet = contact_sheet([Tile(image)], 1, largest=100)
    part = sheet[8 : 8 + 50, 8 : 8 + 100]
    np.testing.assert_allclose(part.mean((0, 1)) / 255, image.mean((0, 1)), atol=2e-3)
    assert sheet.shape[1] == 8 + 100 + 8


def test_all_pictures_are_scaled_down_together():
    black = [np.zeros(shape, np.float32) for shape in ((200, 200, 1), (50, 100, 3))]
    sheet = contact_sheet([Tile(each) for each in black], 2, largest=100)
    dark = (sheet == 0).all(axis=2)
    assert dark.sum() == 100 * 100 + 25 * 50


@pytest.mark.parametrize("side", [16, 64, 128, 256, 512])
@pytest.mark.parametrize("heads", [False, True])
def test_texts_have_ink_and_none_is_cut_off(side, heads):
    tiles = [Tile(np.ones((side, side, 3), np.float32), ("alpha 0.15", "copied 94%, median 14")) for _ in range(6)]
    options = {"column_heads": ["alpha 0.05", "alpha 0.1", "alpha 0.2"], "row_heads": ["beta 0", "beta 1"]}
    sheet = contact_sheet(tiles, 3, title=("A title that is long " * 3,), **(options if heads else {}))
    dark = (sheet < 128).any(axis=2)
    assert dark.sum() > 500
    edges = np.concatenate([dark[:3].ravel(), dark[-3:].ravel(), dark[:, :3].ravel(), dark[:, -3:].ravel()])
    assert not edges.any()


def test_a_picture_that_is_missing_says_why():
    tile = Tile(None, ("alpha 3",), "window: must be at most 15, the exemplar's smaller side, got 41. " * 4)
    sheet = contact_sheet([tile, Tile(np.zeros((64, 64, 1), np.float32))], 2)
    box = sheet[8 : 8 + 64, 8 : 8 + 88]
    assert (box[0] == 232).all()
    assert (box[-1] == 232).all()
    assert (box < 100).any()


def test_only_missing_pictures_make_a_sheet_too():
    assert contact_sheet([Tile(None, (), "no")], 1).shape == (108, 104, 3)


def test_a_long_word_is_broken():
    sheet = contact_sheet([Tile(np.ones((20, 20, 3), np.float32), ("x" * 90,))], 1)
    assert sheet.shape[1] == 104
    assert (sheet < 128).any(axis=2).any(axis=1).sum() > 40


def test_font_sizes():
    assert [font_size(side) for side in (16, 64, 168, 512, 4000)] == [12, 12, 12, 18, 18]


@pytest.mark.parametrize(("count", "columns"), [(1, 1), (6, 6), (7, 4), (10, 4), (40, 8)])
def test_columns_of_a_series(count, columns):
    assert series_columns(count) == columns


def test_a_sheet_that_is_too_large_is_refused_before_the_work():
    check_sheet(200, 20, (512, 512))
    check_sheet(400, 20, (4096, 4096), largest=256)
    with pytest.raises(InputError, match=r"A sheet of 400 cells would have 11[0-9] megapixels"):
        check_sheet(400, 20, (512, 512))
