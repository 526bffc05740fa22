"""Draws docs/universality.svg: python3 docs/universality.py DIR/universality.h5 FIGURE, with numpy, h5py and matplotlib.

DIR is the result of `cargo run --release -- universality data/studies/universality.toml -o DIR`.
"""

import sys

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

plt.rcParams["svg.hashsalt"] = "fretwear"  # the same file from the same run

path, figure = sys.argv[1:3]
with h5py.File(path) as study:
    words = {name: study[name].asstr()[:] for name in ["name", "predicted"]}
    position = study["position"][:]
    depth, limit = study["profile_wear_depth"][:], study["profile_limit"][:]
    distance = study["distance"][:]
    within, outside = float(study.attrs["tolerance_within"]), float(study.attrs["tolerance_outside"])

inside = np.flatnonzero(words["predicted"] == "within")
controls = np.flatnonzero(words["predicted"] == "outside")
controls = controls[np.argsort(distance[controls])]
colours = plt.get_cmap("tab20")

plot, (left, right, bottom) = plt.subplots(1, 3, figsize=(11.5, 4.6), layout="constrained",
                                           gridspec_kw={"width_ratios": [1, 1, 1.15]})
for case in inside:
    left.plot(limit[case][::5], depth[case][::5], ".", color="tab:blue", alpha=0.4, markersize=4, rasterized=True)
left.set_title(f"{len(inside)} cases predicted within")
for number, case in enumerate(controls):
    right.plot(limit[case], depth[case], color=colours(number % 20), linewidth=1.5)
right.set_title(f"{len(controls)} controls predicted outside")
for axes in (left, right):
    axes.plot([0, 1], [0, 1], "k--", linewidth=1, label="Eq. (9)")
    axes.set_xlabel("depth of the limit $w_\\infty$ / max $w_\\infty$")
    axes.legend(frameon=False, loc="upper left")
    axes.set_xlim(0, 1)
left.set_ylabel("final depth $w$ / max $w_\\infty$")

FLOOR = 1e-16
bottom.semilogx(np.sort(np.maximum(distance[inside], FLOOR)), np.linspace(0, 1, len(inside)), ".", color="tab:blue")
for number, case in enumerate(controls):
    height = number / (len(controls) - 1)
    bottom.semilogx(distance[case], height, "s", color=colours(number % 20), markersize=5)
    bottom.annotate(words["name"][case], (distance[case], height), xytext=(-6, 0), textcoords="offset points",
                    ha="right", va="center", fontsize=7)
for edge, word in [(within, "within"), (outside, "outside")]:
    bottom.axvline(edge, color="0.6", linestyle=":")
    bottom.annotate(word, (edge, 1.06), ha="center", fontsize=8, color="0.4", annotation_clip=False)
bottom.set_ylim(-0.05, 1.12)
bottom.set_yticks([])
bottom.set_xlabel("distance from the limit")
bottom.set_title("distances, in order")
plot.savefig(figure, metadata={"Date": None} if figure.endswith(".svg") else None, dpi=100)
