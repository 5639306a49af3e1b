"""Errors that a user can cause and mend: one sentence each, saying what, what is allowed and what was given."""

from __future__ import annotations


class InputError(ValueError):
    """Bad input; ``str(error)`` is one clear sentence for the user."""


class ParamError(InputError):
    """A parameter that is unknown, of the wrong kind or out of range.

    Parameters
    ----------
    field
        Name of the parameter, as in the ``Params`` dataclass.
    allowed
        What would have been accepted, in words.
    given
        The offending value.
    """

    def __init__(self, field: str, allowed: str, given: object) -> None:
        try:
            shown = repr(given)
        except (RecursionError, ValueError):
            # Lists nested too deep and whole numbers with too many digits have no repr.
            shown = f"a {type(given).__name__} too large to be shown"
        if len(shown) > 60:
            shown = shown[:57] + "..."
        super().__init__(f"{field}: must be {allowed}, got {shown}.")
        self.field = field
        self.allowed = allowed
        self.given = given


class ImageError(InputError):
    """An image that cannot be read, or cannot be used as asked."""


class TooLargeError(ImageError):
    """An image with too many pixels to be kept whole.

    Parameters
    ----------
    sentence
        For the user.
    width, height
        In pixels, as the file states them.
    """

    def __init__(self, sentence: str, width: int, height: int) -> None:
        super().__init__(sentence)
        self.width = width
        self.height = height


class RecipeError(InputError):
    """A recipe (in a saved result) that is missing, malformed or cannot be followed."""


class NoRecipeError(RecipeError):
    """A file without any recipe: an ordinary image, say."""


class Cancelled(Exception):
    """The run was stopped because ``should_stop`` said so."""
