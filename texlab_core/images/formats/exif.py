"""The one entry of EXIF that matters here: which side of the picture is up."""

from __future__ import annotations

import struct

_ORIENTATION = 0x0112
_SHORT = 3
_MAX_ENTRIES = 1000
_PREFIX = b"Exif\0\0"


def orientation(exif: bytes) -> int:
    """Return the orientation, 1 to 8; 1 when there is none or the data are damaged.

    Parameters
    ----------
    exif
        A TIFF header with its first directory (TIFF 6.0, section 2), with or without the prefix of JPEG files.
    """
    data = exif.removeprefix(_PREFIX)
    order = {b"II*\0": "<", b"MM\0*": ">"}.get(data[:4])
    try:
        if order is None:
            return 1
        (start,) = struct.unpack_from(f"{order}I", data, 4)
        (count,) = struct.unpack_from(f"{order}H", data, start)
        for index in range(min(count, _MAX_ENTRIES)):
            tag, kind, _, value = struct.unpack_from(f"{order}HHIH", data, start + 2 + 12 * index)
            if tag == _ORIENTATION:
                return value if kind == _SHORT and 1 <= value <= 8 else 1
    except struct.error:
        pass
    return 1
