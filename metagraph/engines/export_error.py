"""The error of a project that cannot be exported."""


class ExportError(ValueError):
    """The project cannot be exported; the message says what to mend first."""
