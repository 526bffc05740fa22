"""What can go wrong."""

from __future__ import annotations


class SceneError(ValueError):
    """A scene, or what else was given, that cannot be used.

    ``message`` shows the line and marks the place; ``key`` is the dotted key that it is about, or None.
    """

    def __init__(self, message: str, key: str | None = None) -> None:
        super().__init__(message, key)
        self.message = message
        self.key = key

    def __str__(self) -> str:
        return self.message


class RunError(RuntimeError):
    """A run that came to no end: the equations could not be solved from some moment on, which the message tells."""
