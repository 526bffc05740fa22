"""What runs and studies come to: labelled arrays, figures, a file."""

from __future__ import annotations

import builtins
import html
import json
import os
import tempfile
import uuid
from functools import cached_property
from typing import TYPE_CHECKING, Any

from . import _native

if TYPE_CHECKING:
    import numpy as np
    import pandas
    import xarray
    from numpy.typing import NDArray

    Numbers = NDArray[np.float64]


class Results:
    """Labelled arrays of a run or a study.

    A variable is an attribute, ``results.wear_volume``, or an entry, ``results["loops/displacement"]``: a NumPy array that cannot be written to.
    """

    def __init__(self, native: _native.Results) -> None:
        self._native = native
        self._read: dict[str, NDArray[Any]] = {}

    @property
    def kind(self) -> str:
        """What they are of: ``run``, ``sweep``, ``map``, ``universality``, ``tradeoff`` or ``calibration``."""
        return self._native.format.removeprefix("fretwear-")

    @property
    def path(self) -> str | None:
        """The file they were read from."""
        return self._native.path

    @cached_property
    def attrs(self) -> dict[str, Any]:
        """What is said of all: title, the text of the scene or study, versions."""
        return self._native.attributes("")

    def variables(self, group: str = "") -> list[str]:
        """Names of the variables, or of those of a group."""
        return self._native.names(group)

    def groups(self, group: str = "") -> list[str]:
        """Names of the groups, or of those in a group."""
        return self._native.groups(group)

    def units(self, name: str) -> str:
        """Units of a variable, as UDUNITS spells them; "1" for pure numbers and words."""
        return str(self._native.labels(name)[1]["units"])

    def long_name(self, name: str) -> str:
        """Meaning of a variable."""
        return str(self._native.labels(name)[1]["long_name"])

    def attributes(self, name: str) -> dict[str, Any]:
        """What is said of a variable, units and meaning among it."""
        return self._native.labels(name)[1]

    def dims(self, name: str) -> tuple[str, ...]:
        """Dimensions of a variable."""
        return tuple(self._native.labels(name)[0])

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self._read:
            import numpy as np

            kind, shape, values = self._native.values(name)
            made = np.array(values, dtype=object) if kind == "O" else np.frombuffer(values, dtype=kind)
            made = made.reshape(shape)
            made.flags.writeable = False
            self._read[name] = made
        return self._read[name]

    def __getattr__(self, name: str) -> NDArray[Any]:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError:
            known = ", ".join(self.variables())
            raise AttributeError(f"there is no {name!r}; there are {known}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.variables()]

    def to_xarray(self, group: str = "") -> xarray.Dataset:
        """All variables, or those of a group, with dimensions, units and meaning."""
        import xarray

        prefix = f"{group}/" if group else ""
        variables, coordinates = {}, set[str]()
        for name in self.variables(group):
            dims, attrs = self._native.labels(prefix + name)
            coordinates |= set(str(attrs.pop("coordinates", "")).split())
            attrs.pop("_FillValue", None)
            variables[name] = (dims, self[prefix + name], attrs)
        made = xarray.Dataset(variables, attrs=self._native.attributes(group))
        return made.set_coords([name for name in coordinates if name in made])

    def to_pandas(self, table: str | None = None) -> pandas.DataFrame:
        """All variables over the same dimensions as a table, a row for each place along them.

        Args:
            table: names of the dimensions, such as ``"time,node"``; by default the first one. Coordinates are repeated along them. The units of the
                columns are in ``attrs["units"]``.
        """
        import numpy as np
        import pandas

        names = {name: self.dims(name) for name in self.variables()}
        first = next(dims for dims in names.values() if len(dims) == 1)
        dims = tuple(table.split(",")) if table else first
        over = [name for name, own in names.items() if own == dims and own != (name,)]
        if not over:
            known = sorted({",".join(own) for own in names.values() if own})
            raise KeyError(f"no variables over {','.join(dims)}; there are {', '.join(known)}")
        said = " ".join(str(self._native.labels(name)[1].get("coordinates", "")) for name in over)
        wanted = [*dims, *(name for name in dict.fromkeys(said.split()) if name not in over), *over]
        lengths = dict(zip(dims, self[over[0]].shape))
        columns = {}
        for name in (name for name in wanted if name in names):
            own = [lengths[dim] if dim in names[name] else 1 for dim in dims]
            columns[name] = np.broadcast_to(self[name].reshape(own), list(lengths.values())).ravel().copy()
        frame = pandas.DataFrame(columns)
        frame.attrs["units"] = {name: self.units(name) for name in columns}
        return frame.set_index(list(dims))

    def save(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Writes the result file, as a whole or not at all.

        Raises:
            FileExistsError: there is one, and ``overwrite`` is not given.
            OSError: it cannot be written.
        """
        self._native.save(path, overwrite)

    @property
    def plots(self) -> list[str]:
        """The kinds of figures that fit, the most telling one first."""
        return self._native.kinds()

    def plot(self, kind: str | None = None, quantity: str | None = None) -> Any:
        """A figure: one of matplotlib's where that is installed, else an :class:`SVG`.

        Args:
            kind: one of :attr:`plots`, by default the first.
            quantity: which result of a sweep, by default the worn volume.
        """
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            return self.svg(kind, quantity)
        from ._plot import drawn

        return drawn(json.loads(self._native.panels(kind, quantity)))

    def svg(self, kind: str | None = None, quantity: str | None = None) -> SVG:
        """The figure that ``fretwear plot`` draws."""
        # On one page no two drawings may use the same names.
        return SVG(self._native.picture(kind, quantity, False, "f" + uuid.uuid4().hex).decode())

    def png(self, kind: str | None = None, quantity: str | None = None) -> builtins.bytes:
        """The same as PNG."""
        return self._native.picture(kind, quantity, True, "f")

    def __repr__(self) -> str:
        title = self.attrs.get("title")
        return f"<fretwear.{type(self).__name__} of a {self.kind}{f': {title}' if title else ''}>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{self.svg().text if self.plots else ''}"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._native.bytes(),)


class Run(Results):
    """What a run came to: snapshots from its start to its end. SI units throughout.

    Arrays over ``time`` have one value for each snapshot, those over ``time, node`` one row; the first snapshot is the unworn contact.
    """

    if TYPE_CHECKING:
        time: NDArray[np.int64]
        """index of the snapshot"""
        node: NDArray[np.int64]
        """index of the node"""
        cycles: Numbers
        """number of fretting cycles, shape (time,)"""
        tau: Numbers
        """dimensionless time, shape (time,)"""
        wear_volume: Numbers
        """worn volume, m³, shape (time,)"""
        contact_radius: Numbers
        """contact radius, m, shape (time,)"""
        stick_radius: Numbers
        """radius of the stick zone per cycle, m, shape (time,)"""
        permanent_stick_radius: Numbers
        """radius within which nothing has slipped so far, m, shape (time,)"""
        indentation: Numbers
        """largest indentation depth, m, shape (time,)"""
        normal_force: Numbers
        """normal force at the largest indentation, N, shape (time,)"""
        dissipated_energy: Numbers
        """energy dissipated by friction since the start, J, shape (time,)"""
        cycle_energy: Numbers
        """energy dissipated by friction in one cycle, J, shape (time,)"""
        tangential_force: Numbers
        """largest tangential force along one fretting loop, N, shape (time,)"""
        energy_ratio: Numbers
        """energy of the fretting loop over 4 Q* δ*, shape (time,)"""
        sliding_ratio: Numbers
        """width of the fretting loop at no force over the stroke, shape (time,)"""
        fretting_regime: NDArray[np.int32]
        """fretting regime of the run so far: mixed where some cycles were in gross slip and some were not, shape (time,)"""
        regime: NDArray[np.int32]
        """what the oscillation does to the contact, shape (time,); ``attributes("regime")`` tells the words"""
        radius: Numbers
        """distance from the axis, m, shape (node,)"""
        profile: Numbers
        """worn profile, m, shape (time, node)"""
        wear_depth: Numbers
        """wear depth, m, shape (time, node)"""
        pressure: Numbers
        """contact pressure, Pa, shape (time, node)"""
        slip: Numbers
        """slip amplitude, m, shape (time, node)"""
        limit_profile: Numbers
        """profile in the limit of many cycles, m, shape (node,), where there is a closed form"""
        limit_wear_depth: Numbers
        """wear depth in the limit of many cycles, m, shape (node,), where there is a closed form"""

    @cached_property
    def summary(self) -> dict[str, Any]:
        """What the run came to, with the keys of ``fretwear run --json``; ``output`` is the file that it was read from, or None."""
        summary: dict[str, Any] = json.loads(self._native.summary() or "{}")
        return summary | {"output": self.path}

    @property
    def complete(self) -> bool:
        """Whether it reached its end, and was not stopped before."""
        return bool(self.summary["stop_reason"] != "interrupted")

    @property
    def scene(self) -> str:
        """The scene as TOML text."""
        return str(self.attrs["scene"])

    def _repr_html_(self) -> str:
        shown = ("stop_reason", "cycles", "wear_volume", "wear_volume_limit", "contact_radius", "limit_distance_relative", "error_estimate")
        row = "<tr><th style='text-align:left'>{}</th><td>{}</td></tr>"
        rows = "".join(row.format(key, html.escape(_short(self.summary[key]))) for key in shown)
        return f"{super()._repr_html_()}<table>{rows}</table>"


class Calibration(Results):
    """What a calibration found: arrays over ``parameter`` and over ``value``, the measured ones. SI units throughout."""

    if TYPE_CHECKING:
        key: NDArray[np.object_]
        """keys of the scene, shape (parameter,)"""
        estimate: Numbers
        """values at which the misfit is least, shape (parameter,)"""
        lower: Numbers
        """lower ends of the intervals of 95 %, not a number where the data tell none, shape (parameter,)"""
        upper: Numbers
        """upper ends of the intervals of 95 %, not a number where the data tell none, shape (parameter,)"""
        correlation: Numbers
        """correlation of the estimates, shape (parameter, other_parameter)"""
        measurement: Numbers
        """measured values, shape (value,)"""
        prediction: Numbers
        """what is predicted of them, shape (value,)"""
        residual: Numbers
        """their differences over the deviations, shape (value,)"""

    def __init__(self, native: _native.Results, summary: dict[str, Any]) -> None:
        super().__init__(native)
        self.summary = summary
        """What was found, with the keys of ``fretwear calibrate --json``."""

    @property
    def parameters(self) -> dict[str, dict[str, Any]]:
        """What was found of each key: ``estimate``, ``lower``, ``upper``, ``unit``, ``identifiable``."""
        return {found["key"]: found for found in self.summary["parameters"]}

    def _repr_html_(self) -> str:
        row = "<tr><th style='text-align:left'>{}</th><td>{}</td><td>{} to {}</td><td>{}</td></tr>"
        found = (
            [html.escape(it["key"]), *(_short(it[name]) for name in ("estimate", "lower", "upper")), html.escape(it["unit"])]
            for it in self.summary["parameters"]
        )
        return f"{super()._repr_html_()}<table>{''.join(row.format(*cells) for cells in found)}</table>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored_calibration, (self._native.bytes(), self.summary)


class SVG:
    """A drawing that notebooks show."""

    def __init__(self, text: str) -> None:
        self.text = text

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the drawing."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.text)

    def _repr_svg_(self) -> str:
        return self.text


def opened(native: _native.Results) -> Results:
    """The results of the library as those of the package."""
    return (Run if native.format == "fretwear-run" else Results)(native)


def _read(content: bytes) -> _native.Results:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "results.h5")
        with open(path, "wb") as file:
            file.write(content)
        return _native.open(path, False)


def _restored(content: bytes) -> Results:
    return opened(_read(content))


def _restored_calibration(content: bytes, summary: dict[str, Any]) -> Calibration:
    return Calibration(_read(content), summary)


def _short(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
