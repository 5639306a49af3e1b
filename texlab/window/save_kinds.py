"""The formats and depths that a result can be saved in, as the dialog offers them: pure functions."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from texlab_core.images.formats.writing import Bits

_WORDS: dict[Bits, str] = {8: "8 bits", 16: "16 bits", "float": "floats"}
_FLAT: tuple[tuple[str, str, tuple[Bits, ...]], ...] = (
    ("PNG", ".png", (8, 16)),
    ("TIFF", ".tif", (8, 16, "float")),
    ("WebP, lossless", ".webp", (8,)),
    ("JPEG", ".jpg", (8,)),
)
_SOLID: tuple[tuple[str, str, tuple[Bits, ...]], ...] = (
    ("TIFF stack", ".tif", (8, 16, "float")),
    ("NumPy array", ".npy", ("float",)),
)
_SAME = {".tiff": ".tif", ".jpeg": ".jpg"}


@dataclass(frozen=True)
class SaveKind:
    """A format with a depth; ``label`` is its line in the dialog."""

    label: str
    suffix: str
    bits: Bits


def save_kinds(depth: Bits, *, solid: bool = False) -> tuple[SaveKind, ...]:
    """Return every kind, the one that keeps the exemplar's own depth first.

    Parameters
    ----------
    depth
        ``ImageInput.depth`` of the exemplar.
    solid
        Of a block of three dimensions.
    """
    made = [
        SaveKind(f"{name}, {_WORDS[bits]} (*{suffix})", suffix, bits)
        for name, suffix, depths in (_SOLID if solid else _FLAT)
        for bits in depths
    ]
    return tuple(sorted(made, key=lambda kind: kind.bits != depth))


def named(path: str, kind: SaveKind) -> Path:
    """Return the file to write; what follows a dot may be part of the name: ``wall.v2`` is ``wall.v2.png``."""
    from texlab_core.images.formats.writing import named_with_suffix

    given = Path(path)
    return given if given.suffix.lower() in (kind.suffix, ".npy") else named_with_suffix(given, kind.suffix)


def chosen_bits(path: Path, kind: SaveKind) -> Bits | None:
    """Return the depth of the chosen kind, or None (the default) where the typed name is of another format."""
    suffix = path.suffix.lower()
    return kind.bits if _SAME.get(suffix, suffix) == kind.suffix else None


def saved_words(path: Path, bits: Bits, depth: Bits, alpha: str) -> str:
    """Return what is said of a saved file: ``alpha`` is ``carried``, ``lost`` or ``none``."""
    said = f"Saved {path} with its recipe"
    if bits != depth:
        said += f", in {_WORDS[bits]}; the exemplar has {_WORDS[depth]}"
    elif bits != 8:
        said += f", in {_WORDS[bits]}, as the exemplar has"
    tail = {
        "carried": " Its transparency is the exemplar's, carried along by the source map.",
        "lost": " The exemplar's transparency could not come along: that takes PNG, TIFF or WebP, and a method "
        "that keeps places.",
    }
    return said + "." + tail.get(alpha, "")
