"""What is written into the file of a tab's picture: how it was made; no Qt here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab_core.engine.result import Result

TAB_KEY = "texlab-tab"
SUFFIXES = (".png", ".svg")


def picture_texts(made: Mapping[str, Any], result: Result | None) -> dict[str, str]:
    """Return what is written into the file: how the tab was set, and the recipe of the result that it shows.

    Parameters
    ----------
    made
        Tab, stage, controls: JSON data.
    result
        Of the column that was chosen, if it had finished.
    """
    from texlab_core.documents.reading import KEY
    from texlab_core.documents.recipe import written_recipe
    from texlab_core.files.strict_json import packed

    texts = {TAB_KEY: packed(dict(made))}
    if result is not None:
        texts[KEY] = written_recipe(result)
    return texts
