"""The error of an edit that cannot be done."""


class EditError(ValueError):
    """The edit cannot be done; the message says why."""
