"""Rooms of the house and what each imports, read with import-linter: ``python .ci/rooms.py``, ``make rooms``."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import grimp

ROOT = Path(__file__).resolve().parent.parent


def floors() -> dict[str, list[str]]:
    """Return the rooms of each package from the top floor to the bottom, as ``pyproject.toml`` lays them."""
    with (ROOT / "pyproject.toml").open("rb") as file:
        contracts: list[dict[str, Any]] = tomllib.load(file)["tool"]["importlinter"]["contracts"]
    layers = (each for each in contracts if each["type"] == "layers")
    return {
        each["containers"][0]: [room for floor in each["layers"] for room in floor.split(" | ")] for each in layers
    }


def imported(graph: grimp.ImportGraph, package: str, rooms: list[str]) -> dict[str, dict[str, int]]:
    """Return the rooms that each room of a package imports, with the number of imports."""
    found: dict[str, dict[str, int]] = {room: {} for room in rooms}
    for module in graph.modules:
        parts = module.split(".")
        if parts[0] != package or len(parts) < 2 or parts[1] not in found:
            continue
        for target in graph.find_modules_directly_imported_by(module):
            there = target.split(".")
            if len(there) > 1 and there[0] == package and there[1] in found and there[1] != parts[1]:
                found[parts[1]][there[1]] = found[parts[1]].get(there[1], 0) + 1
    return found


def main() -> None:
    """Print every room from the top floor to the bottom, and the rooms below that it imports."""
    houses = floors()
    graph = grimp.build_graph(*houses)
    for package, rooms in houses.items():
        print(f"{package}/")
        for room, targets in imported(graph, package, rooms).items():
            below = sorted(targets, key=rooms.index)
            print(f"  {room:<10} -> {', '.join(f'{each} {targets[each]}' for each in below) or '-'}")


if __name__ == "__main__":
    main()
