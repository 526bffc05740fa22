"""Scenes that are made key by key."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, TypeAlias

from . import _native

Table: TypeAlias = Mapping[str, Any]
"""A table of a scene: keys, which may be dotted, and their values."""


class Scene:
    """A valid scene.

    Args:
        base: what it begins with: a path, TOML text, a dictionary, or another scene; nothing if left out.
        set: values of dotted keys, such as ``{"loading.amplitude": "2 um"}``; what excludes such a key is left out.
        title, indenter, half_space, counter_body, friction, wear, loading, numerics, output: tables of the scene.

    Without a base the tables are the scene; on a base they are laid key by key, as ``set`` is. Files that a scene names are relative to its
    own, or to the working directory where it has none. Numbers are in SI units; texts may carry theirs.

    >>> scene = Scene(
    ...     indenter={"paraboloid.radius": "10 mm"},
    ...     half_space={"grading": 0, "modulus": "210 GPa", "poisson_ratio": 0.3},
    ...     friction={"coulomb.coefficient": 0.7},
    ...     wear={"archard.coefficient": "1e-8 1/MPa"},
    ...     loading={"initial_force": "10 N", "stick_ratio": 0.7, "tau": 30},
    ... )

    Raises:
        SceneError: the first thing that is wrong, shown at its line, with its key.
    """

    def __init__(
        self,
        base: Source | None = None,
        *,
        set: Table | None = None,
        title: str | None = None,
        indenter: Table | None = None,
        half_space: Table | None = None,
        counter_body: Table | None = None,
        friction: Table | None = None,
        wear: Table | None = None,
        loading: Table | None = None,
        numerics: Table | None = None,
        output: Table | None = None,
    ) -> None:
        tables = {
            "title": title,
            "indenter": indenter,
            "half_space": half_space,
            "counter_body": counter_body,
            "friction": friction,
            "wear": wear,
            "loading": loading,
            "numerics": numerics,
            "output": output,
        }
        laid_over = {name: table for name, table in tables.items() if table is not None}
        if base is None:
            self._native = _native.Scene(laid_over, set, None)
        else:
            settings = _flat(laid_over) | dict(set or {})
            text, folder = (base.toml, base._native.folder) if isinstance(base, Scene) else (base, None)
            self._native = _native.Scene(text, settings, folder)

    @property
    def toml(self) -> str:
        """The scene as TOML text."""
        return self._native.toml

    @property
    def warnings(self) -> list[str]:
        """What is allowed but deserves a word, one sentence each."""
        return self._native.warnings

    def __repr__(self) -> str:
        return f"<fretwear.Scene\n{self.toml.strip()}\n>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self.toml == other.toml and self._native.folder == other._native.folder

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self.toml, self._native.folder)


def _restored(toml: str, folder: str) -> Scene:
    scene = Scene.__new__(Scene)
    scene._native = _native.Scene(toml, None, folder)
    return scene


def _flat(tables: Mapping[str, Any], path: str = "") -> dict[str, Any]:
    """Tables in tables as dotted keys."""
    flat: dict[str, Any] = {}
    for key, value in tables.items():
        if isinstance(value, Mapping):
            flat |= _flat(value, f"{path}{key}.")
        elif value is not None:
            flat[path + key] = value
    return flat


Source: TypeAlias = str | os.PathLike[str] | Table | Scene
"""What a scene is given as."""
