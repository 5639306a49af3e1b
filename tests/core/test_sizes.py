"""Sizes of two and three numbers, and the memory of the machine."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.engine.sizes import check_size, default_size, size_from_json, size_text, size_to_json
from texlab_core.errors import ParamError
from texlab_core.work import memory

if TYPE_CHECKING:
    from pathlib import Path


def test_sizes_are_checked_for_their_number_of_sides() -> None:
    assert check_size((3, np.int64(4))) == (3, 4)
    assert check_size([2, 3, 4], 3) == (2, 3, 4)
    wrong: list[tuple[Any, int]] = [
        ((3, 4), 3),
        ((2, 3, 4), 2),
        ((0, 3, 4), 3),
        ((2, 3, True), 3),
        ((2.0, 3, 4), 3),
    ]
    wrong += [((512, 512, 512), 3), ((2**14, 2**14), 2), (None, 3), ("abc", 3)]
    for size, dimensions in wrong:
        with pytest.raises(ParamError, match="size: must be"):
            check_size(size, dimensions)


def test_sizes_as_text_and_json() -> None:
    assert size_text((3, 4)) == "4 x 3"
    assert size_text((2, 3, 4), "x") == "4x3x2"
    for size in ((3, 4), (2, 3, 4)):
        assert size_from_json(size_to_json(size), len(size)) == size
    assert size_to_json((2, 3, 4)) == {"width": 4, "height": 3, "depth": 2}
    for data, dimensions in (
        ({"width": 1, "height": 2}, 3),
        ({"width": 1, "height": 2, "depth": 3}, 2),
        ([1, 2], 2),
    ):
        with pytest.raises(ParamError, match="a width"):
            size_from_json(data, dimensions)


def test_without_a_size_a_solid_is_a_small_cube() -> None:
    assert default_size((24, 32), 2) == (24, 32)
    assert default_size((24, 32), 3) == (24, 24, 24)
    assert default_size((300, 200), 3) == (64, 64, 64)


def test_memory_is_the_smaller_of_machine_and_container(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = memory.machine_bytes()
    assert found is None or found > 2**20
    limit, none = tmp_path / "limit", tmp_path / "none"
    limit.write_text("1048576\n")
    none.write_text("max\n")
    monkeypatch.setattr(memory, "LIMITS", (str(none), str(limit), str(tmp_path / "missing")))
    assert memory.machine_bytes() == 2**20
    monkeypatch.setattr(memory, "LIMITS", (str(none),))
    monkeypatch.setattr(memory, "_physical", lambda: None)
    assert memory.machine_bytes() is None
