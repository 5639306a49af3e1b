"""How large a draft may be."""

from __future__ import annotations

DRAFT_BUDGET_S = 0.05
SMALLEST_DRAFT = 48
SMALLEST_SOLID = 24


def draft_size(size: tuple[int, ...], seconds: float | None) -> tuple[int, ...] | None:
    """Return the size of a draft that takes about 50 ms, or None when the full size is as quick.

    Parameters
    ----------
    size
        Full height and width, or depth, height and width.
    seconds
        How long the full size took last time; None when that is unknown.
    """
    if seconds is not None and seconds <= DRAFT_BUDGET_S:
        return None
    factor = (DRAFT_BUDGET_S / seconds) ** (1 / len(size)) if seconds else 0.5
    smallest = SMALLEST_DRAFT if len(size) == 2 else SMALLEST_SOLID
    smaller = tuple(max(min(side, smallest), round(side * factor / 8) * 8) for side in size)
    return None if smaller == size else smaller
