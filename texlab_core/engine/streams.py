"""Random streams by name and index."""

from __future__ import annotations

import hashlib

import numpy as np


class Streams:
    """Random streams by name and index, a function of (seed, name, index) and of nothing else."""

    def __init__(self, seed: int) -> None:
        self.seed = seed

    def key(self, name: str, *index: int) -> int:
        """Return a 64-bit key for counter-based hashing in kernels."""
        return int.from_bytes(self._digest(name, index)[:8], "little")

    def __call__(self, name: str, *index: int) -> np.random.Generator:
        """Return a fresh generator at the start of the stream."""
        key = np.frombuffer(self._digest(name, index), dtype="<u8").astype(np.uint64)
        return np.random.Generator(np.random.Philox(key=key))

    def _digest(self, name: str, index: tuple[int, ...]) -> bytes:
        text = "/".join([str(self.seed), name, *map(str, index)])
        return hashlib.blake2b(text.encode(), digest_size=16, person=b"texlab").digest()
