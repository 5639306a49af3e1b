"""Inputs on their way to where they are needed: what they are made from once, and how each is taken from it."""

from __future__ import annotations

import weakref
from abc import ABC, abstractmethod
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab_core.engine.inputs import ArraysInput, Crop, DataInput, ImageInput, Input, Inputs, hash_arrays
from texlab_core.errors import InputError
from texlab_core.images.exemplar import take

if TYPE_CHECKING:
    from collections.abc import Collection

    from numpy.typing import NDArray

Parcel = Mapping[str, "NDArray[Any]"]
"""Named arrays: the pixels of a source, or the arrays of a state."""


@dataclass(frozen=True, slots=True)
class Slip:
    """How one input is made from a parcel.

    Parameters
    ----------
    kind
        "image", "arrays" or "data".
    name, sha256
        Of the input; what comes out must have this hash.
    parcel
        SHA-256 of the arrays it is made from; empty for data, which travel with the slip.
    scale, crop
        How an image is taken from its source.
    notes
        What was converted when the image was read.
    data
        A small JSON document.
    """

    kind: str
    name: str
    sha256: str
    parcel: str = ""
    scale: float = 1.0
    crop: Crop | None = None
    notes: tuple[str, ...] = ()
    data: Any = None

    def unpack(self, parcels: Mapping[str, Parcel]) -> Input:
        """Return the input.

        Raises
        ------
        InputError
            When what comes out is not what was sent.
        """
        found: Input
        if self.kind == "data":
            found = DataInput(self.data, self.name)
        elif self.kind == "arrays":
            found = ArraysInput(parcels[self.parcel], self.name)
        else:
            found = take(parcels[self.parcel]["pixels"], self.name, self.crop, self.scale, self.notes)
        if found.sha256 != self.sha256:
            raise InputError(
                f"{self.name}: has other values where it arrived than where it was read; the two places have "
                "different libraries."
            )
        return found


class Packer:
    """Packs inputs; the hash of a source that several inputs share is computed once, while the source is there."""

    def __init__(self) -> None:
        # A source is known as long as someone else holds it: scans are large.
        self._hashes: dict[int, tuple[weakref.ref[NDArray[Any]], str]] = {}

    def pack(self, inputs: Inputs) -> tuple[Mapping[str, Slip], Mapping[str, Parcel]]:
        """Return the slips by role, and the parcels that they need by hash."""
        slips: dict[str, Slip] = {}
        parcels: dict[str, Parcel] = {}
        for role, given in inputs.items():
            if isinstance(given, ImageInput):
                slips[role] = self._image(given, parcels)
            elif isinstance(given, ArraysInput):
                slips[role] = Slip("arrays", given.name, given.sha256, given.sha256)
                parcels[given.sha256] = given.arrays
            else:
                slips[role] = Slip("data", given.name, given.sha256, data=given.data)
        return slips, parcels

    def _image(self, given: ImageInput, parcels: dict[str, Parcel]) -> Slip:
        origin = given.origin
        pixels = given.pixels if origin is None else origin.pixels
        digest = self._hash_of(pixels)
        parcels[digest] = {"pixels": pixels}
        scale, crop = (1.0, None) if origin is None else (origin.scale, origin.crop)
        return Slip("image", given.name, given.sha256, digest, scale, crop, given.notes)

    def _hash_of(self, pixels: NDArray[Any]) -> str:
        known = self._hashes.get(id(pixels))
        if known is None or known[0]() is not pixels:
            self._hashes = {place: each for place, each in self._hashes.items() if each[0]() is not None}
            known = self._hashes[id(pixels)] = weakref.ref(pixels), hash_arrays({"pixels": pixels})
        return known[1]


class Unpacked:
    """The inputs that were unpacked last, so that the jobs of one exemplar share it and its hash.

    Parameters
    ----------
    capacity
        How many inputs are kept at most.
    max_bytes
        What they and the sources they were taken from may take together; the newest is kept whatever it takes.
    """

    def __init__(self, capacity: int = 8, max_bytes: int = 2**27) -> None:
        self._capacity = capacity
        self._max_bytes = max_bytes
        self._inputs: OrderedDict[tuple[object, ...], Input] = OrderedDict()

    def __len__(self) -> int:
        """Return how many are kept."""
        return len(self._inputs)

    def get(self, slip: Slip, parcels: Mapping[str, Parcel]) -> Input:
        """Return the input of a slip; raises ``InputError`` like :meth:`Slip.unpack`."""
        key = (slip.kind, slip.name, slip.sha256, slip.parcel, slip.scale, slip.crop, slip.notes)
        found = self._inputs.get(key)
        if found is None:
            found = self._inputs[key] = slip.unpack(parcels)
            while len(self._inputs) > 1 and (len(self._inputs) > self._capacity or self._nbytes > self._max_bytes):
                self._inputs.popitem(last=False)
        self._inputs.move_to_end(key)
        return found

    @property
    def _nbytes(self) -> int:
        arrays: dict[int, NDArray[Any]] = {}
        for each in self._inputs.values():
            held: list[NDArray[Any]] = []
            if isinstance(each, ImageInput):
                held = [each.pixels] + ([] if each.origin is None else [each.origin.pixels])
            elif isinstance(each, ArraysInput):
                held = list(each.arrays.values())
            arrays |= {id(array): array for array in held}
        return sum(array.nbytes for array in arrays.values())


class Deposit(ABC):
    """Parcels at one place, each as long as orders that need it are on their way, and those that came last."""

    def __init__(self) -> None:
        self._needed: dict[str, int] = {}
        self._newest: frozenset[str] = frozenset()

    def __len__(self) -> int:
        """Return how many parcels are there."""
        return len(self._needed)

    @abstractmethod
    def put(self, name: str, parcel: Parcel) -> None:
        """Take a parcel in, by its hash."""

    @abstractmethod
    def remove(self, name: str) -> None:
        """Take it away again."""

    def bring(self, parcels: Mapping[str, Parcel]) -> None:
        """Count what an order needs, and put what is not there yet."""
        before, self._newest = self._newest, frozenset(parcels)
        for name, parcel in parcels.items():
            if name not in self._needed:
                self.put(name, parcel)
            self._needed[name] = self._needed.get(name, 0) + 1
        self._tidy(before)

    def leave(self, names: Collection[str]) -> None:
        """Count an order that needed these as done; what nobody needs goes, except for what came last."""
        for name in names:
            self._needed[name] -= 1
        self._tidy(names)

    def _tidy(self, names: Collection[str]) -> None:
        for name in names:
            if name in self._needed and not self._needed[name] and name not in self._newest:
                del self._needed[name]
                self.remove(name)
