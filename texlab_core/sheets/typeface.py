"""The typeface of figure sheets: widths of text, and a font file with the glyphs of a text only.

Reference: OpenType specification 1.9 (tables ``cmap``, ``hmtx``, ``loca``, ``glyf``).
"""

from __future__ import annotations

import functools
import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from texlab_core.files.resources import resource

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

Weight = Literal["regular", "bold"]
_FILES: dict[Weight, str] = {"regular": "DejaVuSans", "bold": "DejaVuSans-Bold"}
FAMILY = "DejaVu Sans"
# In the place of what the typeface does not have.
_REPLACEMENT = "\ufffd"
_WORDS = 0x0001
_SCALE, _MORE, _SCALE_XY, _SCALE_2X2 = 0x0008, 0x0020, 0x0040, 0x0080
_MAGIC = 0xB1B0AFBA


@dataclass(frozen=True, eq=False)
class Typeface:
    """A TrueType font.

    Parameters
    ----------
    name
        As documents call it ("DejaVuSans").
    tables
        The font's tables by tag.
    """

    name: str
    tables: Mapping[str, bytes]

    @functools.cached_property
    def units(self) -> int:
        """Font units in one em."""
        return int(struct.unpack_from(">H", self.tables["head"], 18)[0])

    @functools.cached_property
    def box(self) -> tuple[int, int, int, int]:
        """Left, bottom, right and top of all glyphs together, in thousandths of an em."""
        sides = struct.unpack_from(">4h", self.tables["head"], 36)
        left, bottom, right, top = (round(1000 * side / self.units) for side in sides)
        return left, bottom, right, top

    @functools.cached_property
    def extent(self) -> tuple[int, int]:
        """Ascent and descent (below zero), in thousandths of an em."""
        ascent, descent = struct.unpack_from(">2h", self.tables["hhea"], 4)
        return round(1000 * ascent / self.units), round(1000 * descent / self.units)

    @functools.cached_property
    def glyphs(self) -> Mapping[int, int]:
        """Index of the glyph of each character code that the font has."""
        return _characters(self.tables["cmap"])

    @functools.cached_property
    def advances(self) -> Sequence[float]:
        """Width of each glyph in thousandths of an em."""
        count = struct.unpack_from(">H", self.tables["hhea"], 34)[0]
        pairs = struct.unpack_from(f">{2 * count}H", self.tables["hmtx"])[::2]
        widths = [1000 * each / self.units for each in pairs]
        return widths + [widths[-1]] * (len(self.offsets) - 1 - count)

    @functools.cached_property
    def offsets(self) -> Sequence[int]:
        """Where the outline of each glyph starts in ``glyf``, and where the last one ends."""
        loca = self.tables["loca"]
        if struct.unpack_from(">h", self.tables["head"], 50)[0]:
            return struct.unpack(f">{len(loca) // 4}I", loca)
        return [2 * each for each in struct.unpack(f">{len(loca) // 2}H", loca)]

    def shown(self, text: str) -> str:
        """Return the text with U+FFFD for every character that the font does not have."""
        return "".join(each if ord(each) in self.glyphs else _REPLACEMENT for each in text)

    def width(self, text: str, size: float) -> float:
        """Return how wide a text is at a size, in the size's unit."""
        return sum(self.advances[self.glyphs[ord(each)]] for each in self.shown(text)) * size / 1000

    def wrap(self, text: str, size: float, width: float) -> list[str]:
        """Break a text between words, and words that are wider than ``width`` after a hyphen or anywhere."""
        lines: list[str] = []
        for word in text.split():
            joined = f"{lines[-1]} {word}" if lines else word
            if lines and self.width(joined, size) <= width:
                lines[-1] = joined
                continue
            rest = word
            while len(rest) > 1 and self.width(rest, size) > width:
                fitting = next(
                    n for n in range(len(rest) - 1, 0, -1) if n == 1 or self.width(rest[:n], size) <= width
                )
                fitting = rest.rfind("-", 0, fitting) + 1 or fitting
                lines.append(rest[:fitting])
                rest = rest[fitting:]
            lines.append(rest)
        return lines

    def subset(self, text: Iterable[str]) -> bytes:
        """Return a font file with the outlines of these characters only; glyphs keep their indices.

        All other glyphs are empty, so that the widths and the map of characters stay as they are.
        """
        wanted = {0, *(self.glyphs[ord(each)] for each in self.shown("".join(text)))}
        waiting = list(wanted)
        while waiting:
            for part in self._parts(waiting.pop()):
                if part not in wanted:
                    wanted.add(part)
                    waiting.append(part)
        outlines, places = bytearray(), [0]
        for index in range(len(self.offsets) - 1):
            if index in wanted:
                outline = self.tables["glyf"][self.offsets[index] : self.offsets[index + 1]]
                outlines += outline + b"\0" * (-len(outline) % 4)
            places.append(len(outlines))
        head = bytearray(self.tables["head"])
        # Long offsets, and a sum of its own.
        struct.pack_into(">h", head, 50, 1)
        struct.pack_into(">I", head, 8, 0)
        loca = struct.pack(f">{len(places)}I", *places)
        return _font_file({**self.tables, "head": bytes(head), "glyf": bytes(outlines), "loca": loca})

    def _parts(self, glyph: int) -> list[int]:
        """Return the glyphs of which a glyph is put together."""
        outline = self.tables["glyf"][self.offsets[glyph] : self.offsets[glyph + 1]]
        if len(outline) < 10 or struct.unpack_from(">h", outline)[0] >= 0:
            return []
        found: list[int] = []
        place, flags = 10, _MORE
        while flags & _MORE:
            flags, part = struct.unpack_from(">2H", outline, place)
            found.append(part)
            place += 8 if flags & _WORDS else 6
            place += 2 if flags & _SCALE else 4 if flags & _SCALE_XY else 8 if flags & _SCALE_2X2 else 0
        return found


@functools.cache
def typeface(weight: Weight = "regular") -> Typeface:
    """Return the program's own typeface, DejaVu Sans, whose licence lets it be embedded everywhere."""
    name = _FILES[weight]
    data = resource(f"fonts/{name}.ttf").read_bytes()
    tables = {}
    for index in range(struct.unpack_from(">H", data, 4)[0]):
        tag, _, start, length = struct.unpack_from(">4s3I", data, 12 + 16 * index)
        tables[tag.decode("ascii")] = data[start : start + length]
    return Typeface(name, tables)


def _characters(cmap: bytes) -> dict[int, int]:
    """Return the map of characters of the subtable in format 4 (Unicode, the basic plane)."""
    for index in range(struct.unpack_from(">H", cmap, 2)[0]):
        start = struct.unpack_from(">I", cmap, 8 + 8 * index)[0]
        if struct.unpack_from(">H", cmap, start)[0] == 4:
            break
    else:
        raise ValueError("The font has no map of Unicode characters.")
    count = struct.unpack_from(">H", cmap, start + 6)[0] // 2
    base = start + 14
    ends = struct.unpack_from(f">{count}H", cmap, base)
    starts = struct.unpack_from(f">{count}H", cmap, base + 2 * count + 2)
    deltas = struct.unpack_from(f">{count}H", cmap, base + 4 * count + 2)
    ranges = base + 6 * count + 2
    found: dict[int, int] = {}
    for segment in range(count):
        shift = struct.unpack_from(">H", cmap, ranges + 2 * segment)[0]
        for code in range(starts[segment], ends[segment] + 1):
            glyph = code
            if shift:
                place = ranges + 2 * segment + shift + 2 * (code - starts[segment])
                glyph = struct.unpack_from(">H", cmap, place)[0]
                if not glyph:
                    continue
            glyph = (glyph + deltas[segment]) & 0xFFFF
            if glyph and code != 0xFFFF:
                found[code] = glyph
    return found


def _font_file(tables: Mapping[str, bytes]) -> bytes:
    count = len(tables)
    power = 1 << (count.bit_length() - 1)
    header = struct.pack(">I4H", 0x00010000, count, 16 * power, power.bit_length() - 1, 16 * (count - power))
    start = 12 + 16 * count
    entries, body = b"", b""
    for tag in sorted(tables):
        table = tables[tag]
        entries += struct.pack(">4s3I", tag.encode(), _checksum(table), start + len(body), len(table))
        if tag == "head":
            adjustment = start + len(body) + 8
        body += table + b"\0" * (-len(table) % 4)
    font = bytearray(header + entries + body)
    struct.pack_into(">I", font, adjustment, (_MAGIC - _checksum(bytes(font))) & 0xFFFFFFFF)
    return bytes(font)


def _checksum(data: bytes) -> int:
    padded = data + b"\0" * (-len(data) % 4)
    words: tuple[int, ...] = struct.unpack(f">{len(padded) // 4}I", padded)
    return sum(words) & 0xFFFFFFFF
