"""Draws docs/worn_profile.svg: python3 docs/worn_profile.py RUN.h5 FIGURE, with numpy, h5py and matplotlib.

RUN.h5 is the result of `cargo run --release -- run data/scenes/paraboloid.toml`.
"""

import sys

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import LogNorm

plt.rcParams["svg.hashsalt"] = "fretwear"  # the same file from the same run

path, figure = sys.argv[1:3]
with h5py.File(path) as run:
    radius = 1e6 * run["radius"][:]
    depth = 1e9 * run["wear_depth"][:]
    cycles = run["cycles"][:]
    limit = 1e9 * run["limit_wear_depth"][:]
    profile = 1e9 * run["profile"][:]
    stick = 1e6 * run["stick_radius"][0]

limit_profile = profile[0] + limit
wanted = [1e4, 3e4, 6e4, 1e5, 1.8e5, 3.2e5]
rows = sorted({int(np.argmin(np.abs(np.log(np.maximum(cycles, 1) / n)))) for n in wanted})
colours = plt.get_cmap("viridis_r")
norm = LogNorm(0.5 * cycles[rows[0]], 1.4 * cycles[rows[-1]])

plot, (top, bottom) = plt.subplots(2, 1, figsize=(6.4, 6.4), sharex=True, layout="constrained")
for axes, values, first, last in [(top, profile, profile[0], limit_profile), (bottom, depth, depth[0], limit)]:
    axes.plot(radius, first, color="0.55", linestyle=":", linewidth=1.6, label="unworn")
    for row in rows:
        axes.plot(radius, values[row], color=colours(norm(cycles[row])), linewidth=1.6)
    axes.plot(radius, last, "k--", linewidth=1.6, label="limit, closed form")
    axes.axvline(stick, color="0.75", linewidth=0.8, zorder=0)
    axes.set_xlim(stick - 2, radius[-1] + 1)
top.set_ylabel("profile $f$, nm")
bottom.set_ylabel("wear depth $w$, nm")
bottom.set_xlabel("radius $r$, µm")
bottom.annotate("edge of stick", (stick, 0.05), (stick + 0.3, 0.97), xycoords=("data", "axes fraction"),
                textcoords=("data", "axes fraction"), rotation=90, va="top", fontsize=8, color="0.4")
top.legend(frameon=False, loc="upper left")
bar = plot.colorbar(plt.cm.ScalarMappable(norm, colours), ax=[top, bottom], label="cycles")
for row in rows:
    bar.ax.axhline(cycles[row], color="white", linewidth=1)
plot.savefig(figure, metadata={"Date": None} if figure.endswith(".svg") else None, dpi=110)
