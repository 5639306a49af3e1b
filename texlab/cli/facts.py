"""What the command line promises to others: its exit codes, and the name of its file of defaults."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

EXIT_CODES: Mapping[int, str] = MappingProxyType(
    {
        0: "success",
        1: "something unexpected happened; the log has the details",
        2: "something that you can mend, said in one sentence; also a batch of which a job failed",
        130: "interrupted with Ctrl-C",
    }
)
DEFAULTS = "defaults.toml"
