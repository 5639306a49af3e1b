"""What several commands share: sizes, settings, and outputs that are refused before the work starts."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from texlab.cli.commands._options import (
    output_file,
    output_folder,
    parse_crop,
    parse_number,
    parse_result_size,
    parse_settings,
    parse_size,
    refuse_overwriting,
)
from texlab_core.engine.inputs import Crop
from texlab_core.errors import InputError, ParamError

if TYPE_CHECKING:
    from pathlib import Path

sides = st.integers(1, 8192)


@given(sides, sides, st.integers(0, 9999), st.integers(0, 9999))
def test_width_comes_first_on_the_command_line_and_height_in_the_core(
    width: int, height: int, left: int, top: int
) -> None:
    assert parse_size(f"{width}x{height}") == (height, width)
    assert parse_crop(f"{width}x{height}+{left}+{top}") == Crop(top, left, height, width)


@pytest.mark.parametrize(
    "text", ["", "0", "256x", "x256", "0x10", "5x00", "-1x5", "-5", "1.5x2", "9x9x9", "1e3x5", "٣x٣"]
)
def test_sizes_that_are_none(text: str) -> None:
    # What was given is shown as it was given.
    with pytest.raises(ParamError, match=f"size: must be width and height as in 256x192, or one.*, got '{text}'"):
        parse_size(text)


def test_one_number_is_a_square_everywhere() -> None:
    assert parse_size("32") == parse_size(" 032 ") == (32, 32)
    assert parse_size("64 x 48") == parse_size("64X48") == parse_size("64×48") == (48, 64)
    with pytest.raises(ParamError, match="size: must be at most 64 megapixels, got '99999'"):
        parse_size("99999")
    with pytest.raises(ParamError, match="size: must be at most 64 million voxels, got '512x512x512'"):
        parse_result_size("512x512x512", 3)


@pytest.mark.parametrize("text", ["256x256", "256x256+1", "256x256-1+2", "0x5+1+1", "a", "256x256+1+2+3"])
def test_crops_that_are_none(text: str) -> None:
    with pytest.raises(ParamError, match="crop: must be width"):
        parse_crop(text)


def test_settings_are_names_and_texts() -> None:
    assert parse_settings(["a=1", "table=[1,2]=x", "mean-only= yes"]) == {
        **{"a": "1", "table": "[1,2]=x", "mean_only": " yes"},
    }
    for texts in (["a"], ["=1"], ["a=1", "a=2"]):
        with pytest.raises(InputError):
            parse_settings(texts)


def test_numbers_name_their_option() -> None:
    assert parse_number("seed", "12", int) == 12
    with pytest.raises(ParamError, match=r"seed: must be a whole number, got '1\.5'"):
        parse_number("seed", "1.5", int)
    with pytest.raises(ParamError, match="scale: must be a number, got 'half'"):
        parse_number("scale", "half", float)


def test_an_output_needs_a_folder(tmp_path: Path) -> None:
    assert output_file(str(tmp_path / "A.PNG")) == tmp_path / "A.PNG"
    (tmp_path / "b.png").mkdir()
    for name, words in [
        ("missing/a.png", "does not exist"),
        ("b.png", "is a folder"),
    ]:
        with pytest.raises(InputError, match=words):
            output_file(str(tmp_path / name))
    assert not list((tmp_path / "b.png").iterdir())


def test_a_folder_is_made_when_its_parent_is_there(tmp_path: Path) -> None:
    # Not before there is something to put into it.
    assert output_folder(str(tmp_path / "maps")) == tmp_path / "maps"
    assert not (tmp_path / "maps").exists()
    # Not before there is something to put into it.
    assert output_folder(str(tmp_path / "maps")) == tmp_path / "maps"
    assert not (tmp_path / "maps").exists()
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="is a file"):
        output_folder(str(tmp_path / "file"))
    with pytest.raises(InputError, match="does not exist"):
        output_folder(str(tmp_path / "no" / "maps"))


@pytest.mark.skipif(sys.platform == "win32", reason="folders are read-only in another way there")
def test_a_folder_that_cannot_be_written_to_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    # Root may write anywhere, so that the question itself is answered.
    monkeypatch.setattr("tempfile.TemporaryFile", refuse)
    with pytest.raises(InputError, match=r"cannot be written to \(Permission denied\)"):
        output_file(str(tmp_path / "a.png"))


def test_the_exemplar_is_never_overwritten(tmp_path: Path) -> None:
    image = tmp_path / "wall.png"
    image.touch()
    os.link(image, tmp_path / "same.png")
    for name in ("wall.png", "same.png"):
        with pytest.raises(InputError, match="is what the result is made from"):
            refuse_overwriting(tmp_path / name, str(image))
    refuse_overwriting(tmp_path / "other.png", str(image))
    refuse_overwriting(image, "gallery:structured-pebbles")
