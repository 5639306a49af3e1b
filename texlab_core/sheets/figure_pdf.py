"""Figure sheets as PDF: text with embedded fonts, pictures without loss.

Reference: ISO 32000-1 (PDF 1.7), 7.3 to 7.5 (files), 8.9 (images), 9.7 (composite fonts), 7.11.4 (attached files).
"""

from __future__ import annotations

import re
import zlib
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.sheets.figure_items import Box, Page, Picture, Words
from texlab_core.sheets.typeface import Weight, typeface
from texlab_core.version import __version__

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.sheets.figure_items import Ink
    from texlab_core.sheets.typeface import Typeface

_NAMES: dict[Weight, str] = {"regular": "F1", "bold": "F2"}
_ATTACHED = re.compile(
    rb"/Type /EmbeddedFile /Subtype /application#2Fjson /Length (\d{1,9}) >>\nstream\n", re.DOTALL
)
_CODES = 100


def encode_pdf(page: Page) -> bytes:
    """Return the page as a PDF file; the same page gives the same bytes."""
    file = _File()
    # What is attached comes first, so that it can be found by the first bytes of the file.
    names = [file.attach(key, text) for key, text in page.texts.items()]
    fonts = {weight: file.add_font(typeface(weight), _used(page, weight)) for weight in _weights(page)}
    pictures: list[int] = []
    drawn: list[str] = []
    for item in page.items:
        if isinstance(item, Picture):
            pictures.append(file.add_picture(item.pixels))
            place = f"{_n(item.x)} {_n(page.height - item.y - item.height)}"
            drawn.append(f"q {_n(item.width)} 0 0 {_n(item.height)} {place} cm /P{len(pictures)} Do Q")
        elif isinstance(item, Box):
            drawn.append(
                f"{_colour(item.ink)} {_n(item.x)} {_n(page.height - item.y - item.height)} "
                f"{_n(item.width)} {_n(item.height)} re f"
            )
        else:
            drawn.append(_text(item, page.height))
    content = file.add_stream("", "\n".join(drawn).encode("ascii"))
    held = " ".join(f"/P{index + 1} {number} 0 R" for index, number in enumerate(pictures))
    letters = " ".join(f"/{_NAMES[weight]} {number} 0 R" for weight, number in fonts.items())
    pages = file.reserve()
    leaf = file.add(
        f"<< /Type /Page /Parent {pages} 0 R /MediaBox [0 0 {_n(page.width)} {_n(page.height)}] "
        f"/Resources << /Font << {letters} >> /XObject << {held} >> >> /Contents {content} 0 R >>"
    )
    file.put(pages, f"<< /Type /Pages /Kids [{leaf} 0 R] /Count 1 >>")
    attached = "".join(
        f" {_string(f'{key}.json')} {number} 0 R" for key, number in zip(page.texts, names, strict=True)
    )
    tree = f" /Names << /EmbeddedFiles << /Names [{attached} ] >> >>" if names else ""
    root = file.add(f"<< /Type /Catalog /Pages {pages} 0 R /Lang (en){tree} >>")
    made = file.add(f"<< /Title {_string(page.title)} /Creator {_string(f'TexLab {__version__}')} >>")
    return file.finish(root, made)


def attached_text(head: bytes) -> str | None:
    """Return the first JSON that :func:`encode_pdf` attached, from the first bytes of a file; None without one.

    Raises
    ------
    ValueError
        When it is cut off or no text; the message continues a sentence.
    """
    found = _ATTACHED.search(head)
    if not head.startswith(b"%PDF-") or found is None:
        return None
    length = int(found[1])
    data = head[found.end() : found.end() + length]
    if len(data) < length:
        raise ValueError("is damaged")
    try:
        return data.decode()
    except UnicodeDecodeError as error:
        raise ValueError("is damaged") from error


def _weights(page: Page) -> list[Weight]:
    return [weight for weight in _NAMES if _used(page, weight)]


def _used(page: Page, weight: Weight) -> str:
    return "".join(sorted(set("".join(each.text for each in page.words if each.weight == weight))))


def _text(words: Words, height: float) -> str:
    glyphs = typeface(words.weight).glyphs
    codes = "".join(f"{glyphs[ord(each)]:04X}" for each in words.text)
    return (
        f"BT {_colour(words.ink)} /{_NAMES[words.weight]} {_n(words.size)} Tf "
        f"{_n(words.x)} {_n(height - words.y)} Td <{codes}> Tj ET"
    )


def _colour(ink: Ink) -> str:
    return " ".join(_n(value / 255) for value in ink) + " rg"


def _n(value: float) -> str:
    return f"{value:.4f}".rstrip("0").rstrip(".")


def _string(text: str) -> str:
    """Return a text string in UTF-16, whatever its characters."""
    return f"<FEFF{text.encode('utf-16-be', 'replace').hex().upper()}>"


class _File:
    """Numbered objects, and where each of them starts."""

    def __init__(self) -> None:
        self._objects: dict[int, bytes] = {}
        self._count = 0

    def reserve(self) -> int:
        self._count += 1
        return self._count

    def put(self, number: int, body: str | bytes) -> None:
        self._objects[number] = body if isinstance(body, bytes) else body.encode("ascii")

    def add(self, body: str | bytes) -> int:
        number = self.reserve()
        self.put(number, body)
        return number

    def add_stream(self, entries: str, data: bytes, *, packed: bool = True) -> int:
        body = zlib.compress(data, 6) if packed else data
        how = "/Filter /FlateDecode " if packed else ""
        head = f"<< {f'{entries} ' if entries else ''}{how}/Length {len(body)} >>\nstream\n"
        return self.add(head.encode("ascii") + body + b"\nendstream")

    def attach(self, key: str, text: str) -> int:
        data = text.encode()
        stream = self.add_stream("/Type /EmbeddedFile /Subtype /application#2Fjson", data, packed=False)
        name = _string(f"{key}.json")
        return self.add(f"<< /Type /Filespec /F {name} /UF {name} /EF << /F {stream} 0 R >> >>")

    def add_picture(self, pixels: NDArray[np.uint8]) -> int:
        height, width, channels = pixels.shape
        # PNG's filter 1: differences to the pixel on the left pack better.
        rows = np.empty((height, 1 + width * channels), np.uint8)
        rows[:, 0] = 1
        flat = pixels.reshape(height, -1)
        rows[:, 1 : 1 + channels] = flat[:, :channels]
        np.subtract(flat[:, channels:], flat[:, :-channels], out=rows[:, 1 + channels :])
        space = "/DeviceGray" if channels == 1 else "/DeviceRGB"
        return self.add_stream(
            f"/Type /XObject /Subtype /Image /Width {width} /Height {height} /ColorSpace {space} "
            f"/BitsPerComponent 8 "
            f"/DecodeParms << /Predictor 15 /Colors {channels} /BitsPerComponent 8 /Columns {width} >>",
            rows.tobytes(),
        )

    def add_font(self, face: Typeface, text: str) -> int:
        data = face.subset(text)
        program = self.add_stream(f"/Length1 {len(data)}", data)
        # Six letters before the name say that it is a part of the font (9.6.4).
        name = f"{_tag(text)}+{face.name}"
        box = " ".join(map(str, face.box))
        ascent, descent = face.extent
        weight = 700 if "Bold" in name else 400
        describing = self.add(
            f"<< /Type /FontDescriptor /FontName /{name} /Flags 4 /FontBBox [{box}] /ItalicAngle 0 "
            f"/Ascent {ascent} /Descent {descent} /CapHeight 729 /StemV {80 if weight == 400 else 140} "
            f"/FontWeight {weight} /FontFile2 {program} 0 R >>"
        )
        glyphs = {face.glyphs[ord(each)]: each for each in text}
        widths = " ".join(f"{glyph} [{_n(face.advances[glyph])}]" for glyph in sorted(glyphs))
        part = self.add(
            f"<< /Type /Font /Subtype /CIDFontType2 /BaseFont /{name} /CIDSystemInfo << /Registry (Adobe) "
            f"/Ordering (Identity) /Supplement 0 >> /FontDescriptor {describing} 0 R /DW 600 /W [{widths}] "
            "/CIDToGIDMap /Identity >>"
        )
        unicode = self.add_stream("", _characters(glyphs).encode("ascii"))
        return self.add(
            f"<< /Type /Font /Subtype /Type0 /BaseFont /{name} /Encoding /Identity-H "
            f"/DescendantFonts [{part} 0 R] /ToUnicode {unicode} 0 R >>"
        )

    def finish(self, root: int, made: int) -> bytes:
        out = bytearray(b"%PDF-1.7\n%\xe2\xe3\xcf\xd3\n")
        places = []
        for number in range(1, self._count + 1):
            places.append(len(out))
            out += f"{number} 0 obj\n".encode() + self._objects[number] + b"\nendobj\n"
        table = len(out)
        out += f"xref\n0 {self._count + 1}\n0000000000 65535 f \n".encode()
        out += b"".join(f"{place:010d} 00000 n \n".encode() for place in places)
        out += f"trailer\n<< /Size {self._count + 1} /Root {root} 0 R /Info {made} 0 R >>\n".encode()
        out += f"startxref\n{table}\n%%EOF\n".encode()
        return bytes(out)


def _tag(text: str) -> str:
    rest, tag = zlib.crc32(text.encode()), ""
    for _ in range(6):
        rest, place = divmod(rest, 26)
        tag += chr(65 + place)
    return tag


def _characters(glyphs: dict[int, str]) -> str:
    """Return the map from glyphs to Unicode (9.10.3), by which text can be searched and copied."""
    pairs = [f"<{glyph:04X}> <{each.encode('utf-16-be').hex().upper()}>" for glyph, each in sorted(glyphs.items())]
    parts = [pairs[start : start + _CODES] for start in range(0, len(pairs), _CODES)]
    blocks = "\n".join("\n".join([f"{len(part)} beginbfchar", *part, "endbfchar"]) for part in parts)
    return (
        "/CIDInit /ProcSet findresource begin\n12 dict begin\nbegincmap\n"
        "/CIDSystemInfo << /Registry (Adobe) /Ordering (UCS) /Supplement 0 >> def\n"
        "/CMapName /Adobe-Identity-UCS def\n/CMapType 2 def\n"
        f"1 begincodespacerange\n<0000> <FFFF>\nendcodespacerange\n{blocks}\n"
        "endcmap\nCMapName currentdict /CMap defineresource pop\nend\nend"
    )
