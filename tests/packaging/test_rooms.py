"""The listing of the rooms and their imports: complete, and every arrow points down."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest

ROOT = Path(__file__).resolve().parents[2]


def test_every_room_is_listed_with_what_it_imports_below_it(capsys: pytest.CaptureFixture[str]) -> None:
    spec = importlib.util.spec_from_file_location("rooms", ROOT / ".ci" / "rooms.py")
    assert spec is not None
    assert spec.loader is not None
    rooms = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(rooms)
    rooms.main()
    houses = re.split(r"^(\w+)/\n", capsys.readouterr().out, flags=re.MULTILINE)[1:]
    for package, text in zip(houses[::2], houses[1::2], strict=True):
        arrows = dict(re.findall(r"^  (\w+) +-> (.*)$", text, re.MULTILINE))
        there = {each.stem for each in (ROOT / package).iterdir() if each.is_dir() or each.suffix == ".py"}
        assert arrows.keys() == there - {"__init__", "__pycache__", "_pyinstaller"}
        order = [*arrows]
        for room, targets in arrows.items():
            below = re.findall(r"[a-z_]+", targets)
            assert all(order.index(each) > order.index(room) for each in below), (room, below)
    assert houses[::2] == ["texlab_core", "texlab"]
