"""Names of exported files from a pattern, and selections of seeds and sizes from text."""

from __future__ import annotations

import re
import string
from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab_core.engine.job import MAX_SEED
from texlab_core.engine.sizes import size_from_text, size_text
from texlab_core.errors import InputError, ParamError
from texlab_core.files.wording import printable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from texlab_core.engine.job import Job

PATTERN = "{name}-{method}-{size}-seed{seed}"
FIELDS = {
    "name": "the exemplar's name",
    "method": "the method's id",
    "seed": "the seed",
    "size": "width x height, as in 256x192",
    "width": "of the result in pixels",
    "height": "of the result in pixels",
    "title": "the column's title, or the method's",
    "index": "1, 2, 3, ... within the export",
}
MOST_FILES = 1000
_MOST_SIZES = 64
_LONGEST = 200
# What some file system does not take, and what means something to a shell or a pattern.
_UNSAFE = re.compile(r'[\\/:*?"<>|\x00-\x1f\x7f{}]+')
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\.|$)", re.IGNORECASE)


@dataclass(frozen=True)
class Named:
    """What a name can be made of.

    Parameters
    ----------
    job
        What makes the file.
    title
        Of its column, or of the method.
    """

    job: Job
    title: str


def check_pattern(pattern: str) -> str:
    """Return the pattern of names.

    Raises
    ------
    ParamError
        When it is empty, too long, has an unknown field, a format within a field, half of a pair of braces, or a
        character that names of files cannot have.
    """
    known = ", ".join(f"{{{each}}}" for each in FIELDS)
    try:
        parts = list(string.Formatter().parse(pattern))
    except ValueError:
        raise ParamError("name", f"text with fields {known}, each in one pair of braces", pattern) from None
    for text, field, form, conversion in parts:
        if field is not None and (field not in FIELDS or form or conversion):
            raise ParamError("name", f"text with fields of {known}", pattern)
        if _UNSAFE.search(text):
            raise ParamError("name", 'without any of \\ / : * ? " < > |', pattern)
    if not pattern.strip() or len(pattern) > _LONGEST:
        raise ParamError("name", f"a text of 1 to {_LONGEST} characters", pattern[:40])
    return pattern


def file_stems(pattern: str, named: Sequence[Named]) -> tuple[str, ...]:
    """Return the names of the files without their endings, one for each.

    Raises
    ------
    InputError
        When the pattern cannot be used, or gives two files one name.
    """
    check_pattern(pattern)
    stems = tuple(_stem(pattern, each, index, len(named)) for index, each in enumerate(named))
    seen: dict[str, int] = {}
    for index, stem in enumerate(stems):
        # Some file systems take capitals for small letters.
        other = seen.setdefault(stem.casefold(), index)
        if other != index:
            missing = _missing(named[other], named[index])
            raise InputError(f"The pattern {pattern} gives two files the name {stem}; add {missing}.")
    return stems


def _stem(pattern: str, named: Named, index: int, count: int) -> str:
    job = named.job
    source = job.inputs.get("exemplar") or next(iter(job.inputs.values()), None)
    name = "texture" if source is None else source.name.removeprefix("gallery:")
    values = {
        "name": safe_part(re.sub(r"\.[A-Za-z0-9]{1,5}$", "", re.split(r"[\\/]", name)[-1])),
        "method": safe_part(job.method),
        "seed": str(job.seed),
        "size": size_text(job.size).replace(" ", ""),
        "width": str(job.picture_size[1]),
        "height": str(job.picture_size[0]),
        "title": safe_part(named.title),
        "index": str(index + 1).zfill(len(str(count))),
    }
    stem = pattern.format_map(values).strip(" .")
    stem = stem.encode()[:_LONGEST].decode("utf-8", "ignore").strip(" .")
    return f"_{stem}" if not stem or _RESERVED.match(stem) else stem


def safe_part(text: str) -> str:
    """Return a text as a part of a file's name on any system."""
    kept = _UNSAFE.sub("-", printable(text)).replace("\ufffd", "-").strip(" .-")
    return kept[:80].rstrip(" .-") or "texture"


def _missing(one: Named, other: Named) -> str:
    for field, differs in (
        ("seed", one.job.seed != other.job.seed),
        ("size", one.job.size != other.job.size),
        ("method", one.job.method != other.job.method),
        ("title", one.title != other.title),
    ):
        if differs:
            return f"{{{field}}} or {{index}}"
    return "{index}"


def parse_seeds(text: str) -> tuple[int, ...]:
    """Return the seeds of ``3``, ``1..4`` (or ``1-4``) or ``1..4,9``, in their order and each once.

    Raises
    ------
    ParamError
        When it is none of these, or there are more than 1000.
    """
    allowed = f"whole numbers from 0 to {MAX_SEED} as in 1..4,9, at most {MOST_FILES} of them"
    found: dict[int, None] = {}
    for part in text.split(","):
        match = re.fullmatch(r"\s*([0-9]{1,10})\s*(?:(?:\.\.|[-\u2013])\s*([0-9]{1,10})\s*)?", part)
        if match is None:
            raise ParamError("seeds", allowed, text)
        first = int(match[1])
        last = first if match[2] is None else int(match[2])
        if last < first or last > MAX_SEED or last - first >= MOST_FILES:
            raise ParamError("seeds", allowed, text)
        found |= dict.fromkeys(range(first, last + 1))
    if len(found) > MOST_FILES:
        raise ParamError("seeds", allowed, text)
    return tuple(found)


def parse_sizes(text: str, dimensions: int = 2) -> tuple[tuple[int, ...], ...]:
    """Return the sizes of ``256x192,512``, each as height and width, or depth, height and width.

    One number stands for all sides.

    Raises
    ------
    ParamError
        When a part is no size of so many sides. Whether a method can make it is asked by the job.
    """
    found = dict.fromkeys(size_from_text(part, dimensions, "sizes") for part in text.split(","))
    if len(found) > _MOST_SIZES:
        raise ParamError("sizes", f"at most {_MOST_SIZES} sizes, separated by commas", text)
    return tuple(found)
