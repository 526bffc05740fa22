"""Figures of the library in matplotlib: the same panels, axes and series."""

from __future__ import annotations

import re
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap, LogNorm, Normalize
from matplotlib.patches import PathPatch
from matplotlib.path import Path

SHAPES = {"disc": "o", "circle": "o", "square": "s", "diamond": "D", "triangle": "^", "cross": "x"}


def drawn(figure: dict[str, Any]) -> Any:
    """A figure of matplotlib."""
    heights = [row["height"] for row in figure["rows"]]
    page = plt.figure(figsize=(7.5, sum(heights) / 72 + 1), layout="constrained")
    if figure["title"]:
        page.suptitle(_mathtext(figure["title"]))
    rows = page.subfigures(len(heights), 1, height_ratios=heights, squeeze=False)
    for part, row in zip(rows.flat, figure["rows"]):
        shares = [panel["share"] for panel in row["panels"]]
        for axes, panel in zip(part.subplots(1, len(shares), width_ratios=shares, squeeze=False).flat, row["panels"]):
            _panel(axes, panel)
    if figure["notes"]:
        page.supxlabel("\n".join(map(_mathtext, figure["notes"])), fontsize="small")
    plt.close(page)
    return page


def _panel(axes: Any, panel: dict[str, Any]) -> None:
    if panel["title"]:
        axes.set_title(_mathtext(panel["title"]))
    for name in ("x", "y"):
        axis = panel[name]
        getattr(axes, f"set_{name}scale")("log" if axis["spacing"] == "logarithmic" else "linear")
        getattr(axes, f"set_{name}label")(_mathtext(axis["text"]))
        getattr(axes, f"set_{name}lim")(axis["range"])
        if not axis["ticked"]:
            getattr(axes, f"set_{name}ticks")([])
            getattr(axes, f"set_{name}ticks")([], minor=True)
    for series in panel["series"]:
        _series(axes, series)
    for label in panel["labels"]:
        right, down = label["shift"]
        axes.annotate(
            _mathtext(label["text"]),
            label["at"],
            xytext=(right, -down),
            textcoords="offset pixels",
            ha="right" if label["upwards"] else _side(label["anchor"], "left", "right"),
            va=_side(label["anchor"], "bottom", "top") if label["upwards"] else "baseline",
            rotation=90 if label["upwards"] else 0,
            color=label["colour"],
            fontsize="small",
            annotation_clip=False,
        )
    if any(series["in_legend"] for series in panel["series"]):
        axes.legend(fontsize="small")
    if panel["bar"]:
        bar = panel["bar"]
        norm = (LogNorm if bar["axis"]["spacing"] == "logarithmic" else Normalize)(*bar["axis"]["range"])
        shown = plt.cm.ScalarMappable(norm, ListedColormap(bar["colours"]))
        axes.figure.colorbar(shown, ax=axes, label=_mathtext(bar["axis"]["text"]))


def _side(anchor: float, first: str, last: str) -> str:
    return first if anchor < 0.25 else last if anchor > 0.75 else "center"


def _series(axes: Any, series: dict[str, Any]) -> None:
    points = np.array(series["points"], dtype=float).reshape(-1, 2)
    style, colour = series["style"], series["colour"]
    label = _mathtext(series["name"]) if series["in_legend"] else None
    if "line" in style:
        axes.plot(*points.T, style["line"], color=colour, lw=0.75 * style["width"], label=label)
    elif "points" in style:
        face = "none" if style["points"] == "circle" else colour
        axes.plot(*points.T, SHAPES[style["points"]], color=colour, mfc=face, ms=1.5 * style["radius"], label=label)
    else:
        gaps = np.flatnonzero(np.isnan(points).any(axis=1))
        rings = [ring[~np.isnan(ring).any(axis=1)] for ring in np.split(points, gaps)]
        paths = [Path(np.vstack([ring, ring[:1]]), closed=True) for ring in rings if len(ring)]
        if paths:
            hatched = style.get("hatched", False)
            look = {"facecolor": "white", "edgecolor": colour, "hatch": "//"} if hatched else {"facecolor": colour, "edgecolor": "none"}
            axes.add_patch(PathPatch(Path.make_compound_path(*paths), alpha=style["region"], label=label, lw=0, **look))


def _mathtext(text: str) -> str:
    """The library's markup, `*a*_{0}` and `10^{3}`, as that of matplotlib."""
    parts = re.split(r"(\\.|\*[^*]+\*|[_^]\{[^}]*\})", text)
    made = ""
    for part in parts:
        if part.startswith("\\") and len(part) == 2:
            made += "\\$" if part[1] == "$" else part[1]
        elif part.startswith("*") and len(part) > 1:
            made += f"${part[1:-1]}$"
        elif part[:2] in ("_{", "^{"):
            inside = part[2:-1].replace("*", "")
            made = f"{made[:-1]}{part[0]}{{{inside}}}$" if made.endswith("$") else f"{made}${{}}{part[0]}{{{inside}}}$"
        else:
            made += part.replace("$", "\\$")
    return made
