"""How large a draft may be."""

from __future__ import annotations

DRAFT_BUDGET_S = 0.05
SMALLEST_DRAFT = 48


def draft_size(size: tuple[int, int], seconds: float | None) -> tuple[int, int] | None:
    """Return the size of a draft that takes about 50 ms, or None when the full size is as quick.

    Parameters
    ----------
    size
        Full height and width.
    seconds
        How long the full size took last time; None when that is unknown.
    """
    if seconds is not None and seconds <= DRAFT_BUDGET_S:
        return None
    factor = (DRAFT_BUDGET_S / seconds) ** 0.5 if seconds else 0.5
    height, width = (max(min(side, SMALLEST_DRAFT), round(side * factor / 8) * 8) for side in size)
    return None if (height, width) == size else (height, width)
