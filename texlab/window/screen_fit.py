"""Sizes that follow from the screen: of the first window, of one that comes back, of its panels. No Qt here."""

from __future__ import annotations

# What the window's frame takes at its sides and its top.
FRAME = (2, 32)
LEAST = (1280, 800)
SHARE = 0.85

Rect = tuple[int, int, int, int]
"""Left, top, width, height, in pixels that do not depend on the scale of the screen."""


def first_window(available: Rect) -> Rect:
    """Return the place of the first window: 1280 x 800 or most of a larger screen, and never more than it has."""
    left, top, width, height = available
    most = width - FRAME[0], height - FRAME[1]
    wide, high = (
        min(max(least, round(SHARE * side)), room)
        for least, side, room in zip(LEAST, (width, height), most, strict=True)
    )
    return left + (width - wide) // 2, top + FRAME[1] + (most[1] - high) // 2, wide, high


def within(window: Rect, available: Rect) -> Rect:
    """Return a window that lies inside the screen, made smaller and moved no more than it has to be."""
    left, top, wide, high = window
    wide, high = min(wide, available[2] - FRAME[0]), min(high, available[3] - FRAME[1])
    left = min(max(left, available[0]), available[0] + available[2] - wide)
    top = min(max(top, available[1] + FRAME[1]), available[1] + available[3] - high)
    return left, top, wide, high


def panel_sizes(width: int, height: int) -> tuple[int, int, int]:
    """Return the widths of gallery and parameters and the height of the docks in a window of this size."""
    gallery = min(max(round(0.11 * width), 150), 320, round(0.28 * width))
    parameters = min(max(round(0.16 * width), 240), 480, round(0.36 * width))
    docks = min(max(round(0.33 * height), 120), 760)
    return gallery, parameters, docks
