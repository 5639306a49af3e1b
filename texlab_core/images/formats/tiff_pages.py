"""Which page of a TIFF file is the picture, and what it costs to decode it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, BinaryIO

from texlab_core.errors import ImageError
from texlab_core.images.formats import headers
from texlab_core.images.formats.jpeg import check_scans

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from texlab_core.images.formats.decoded import Gate

_REDUCED, _MASK = 1, 4
_RAW = (32803, 34892)
_MAX_PAGES = 1000
_MAX_ENTRIES = 2_000_000
# Parts may lie on each other, as empty tiles do, but not so that a small file is read over and over.
_MOST_OVERLAP = 4
_HEAD = 2**16
_MIB = 2**20
# Compressions whose decoders are told how many bytes to make at most.
_BOUNDED = (1, 2, 3, 4, 5, 8, 32773, 32946, 34925, 34926, 50000)
_JPEG = (6, 7, 33007, 34892)
_PNG = 34933
_CODED: dict[int, Callable[[bytes], headers.Header]] = {
    **dict.fromkeys(_JPEG, headers.jpeg_header),
    **dict.fromkeys((33003, 33004, 33005, 34712), headers.jpeg2000_header),
    **dict.fromkeys((50002, 52546), headers.jpegxl_header),
    **dict.fromkeys((34927, 50001), headers.webp_header),
    _PNG: headers.png_header,
}


def choose_page(tiff: Any, name: str, notes: list[str]) -> Any:
    """Return the largest page that is no preview and no mask (TIFF 6.0, tag 254); the first of several such.

    Parameters
    ----------
    tiff
        An open ``tifffile.TiffFile``.
    name
        How messages call the file.
    notes
        Which page was used, where there is a choice.

    Raises
    ------
    ImageError
        When that page is a raw photograph.
    """
    first = _within_reason(tiff.pages)
    pages = [*first, *_within_reason(each for page in first if page.subifds for each in page.pages)]
    whole = [page for page in pages if not int(page.subfiletype) & (_REDUCED | _MASK)] or pages[:1]
    page = max(whole, key=lambda page: page.imagewidth * page.imagelength)
    if int(page.photometric) in _RAW:
        raise ImageError(
            f"{name}: is a raw photograph (DNG or another camera's), which TexLab does not develop; export it as "
            "TIFF, PNG or JPEG."
        )
    if len(whole) > 1:
        number = whole.index(page)
        used = "the first one" if number == 0 else f"the largest one, number {number + 1},"
        notes.append(f"The file has {len(whole)} pages; {used} was used.")
    elif len(pages) > 1:
        notes.append("Previews and masks in the file were passed over.")
    return page


def _within_reason(pages: Iterable[Any]) -> list[Any]:
    """Return the first pages, as many as a file needs that is not made to waste time."""
    found: list[Any] = []
    entries = 0
    for page in pages:
        found.append(page)
        entries += len(page.tags) + len(page.dataoffsets)
        if len(found) == _MAX_PAGES or entries > _MAX_ENTRIES:
            break
    return found


def check_cost(page: Any, file: BinaryIO, gate: Gate, made: int) -> None:
    """Let the page through the gate by what its parts say of themselves, before any of them is decoded.

    Parameters
    ----------
    page
        Of the file.
    file
        Where its parts are.
    gate
        See :class:`Gate`.
    made
        Pixels that are kept of it.

    Raises
    ------
    ImageError
        When a part is larger than its place, or compressed in a way that is not read.
    HeavyError
        See :class:`Gate`.
    """
    name, compression = gate.name, int(page.compression)
    width, height = int(page.imagewidth), int(page.imagelength)
    high, wide = (int(side) for side in page.chunks[:2])
    # A tile may be larger than its image, and is decoded whole.
    if high * wide > 4 * max(width * height, _MIB):
        raise ImageError(f"{name}: is a TIFF with tiles that are too large.")
    if sum(page.databytecounts) > _MOST_OVERLAP * gate.length + _MIB:
        raise ImageError(f"{name}: is a TIFF whose parts are larger than the file that holds them.")
    effort, scans = 1.0, 1
    if compression in _CODED:
        effort = 1.0 if compression in _JPEG else float("inf")
        for part in _parts(page, file, whole=compression in _JPEG):
            header = _CODED[compression](part)
            if header.width > wide or header.height > high:
                raise ImageError(
                    f"{name}: is a TIFF whose parts of {wide} x {high} pixels hold {header.width} x "
                    f"{header.height} pixels."
                )
            check_scans(header.scans, width, height, name)
            scans = max(scans, header.scans)
    elif compression not in _BOUNDED:
        kind = getattr(page.compression, "name", str(compression))
        raise ImageError(f"{name}: is a TIFF compressed by {kind}, which TexLab does not read.")
    # Tiles are decoded whole, and so are the pixels that a reduced picture loses.
    decoded = max(width * height, math.prod(page.chunked[:2]) * high * wide)
    bytes_each = int(page.samplesperpixel) * page.dtype.itemsize
    effort = max(effort, 0.7 * scans, bytes_each / 4) * decoded / made
    gate.admit(
        width, height, bytes_each=4 * bytes_each, effort=effort, decoded=made, memory=8 * high * wide * bytes_each
    )


def _parts(page: Any, file: BinaryIO, *, whole: bool) -> Iterator[bytes]:
    """Yield strips or tiles, or only what their headers need."""
    for offset, count in zip(page.dataoffsets, page.databytecounts, strict=False):
        # A part without data is left empty by the decoder.
        if count:
            file.seek(offset)
            yield file.read(count if whole else min(count, _HEAD))
