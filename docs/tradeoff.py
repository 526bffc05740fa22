"""Draws docs/tradeoff.svg or docs/tradeoff_kinds.svg and writes its tables: python3 docs/tradeoff.py FILE ... FIGURE, with numpy, h5py and matplotlib.

Each file is the tradeoff.h5 of `fretwear tradeoff data/tradeoff/NAME.toml -o DIR`, a row of the figure. Tables of the fronts against wall time go to stdout in
Markdown, as they stand in docs/tradeoff.md.
"""

import sys
import textwrap

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

plt.rcParams["svg.hashsalt"] = "fretwear"  # the same file from the same measurement

*paths, figure = sys.argv[1:]
# The profile is compared at the radii of each run's own file.
OWN = {"volume": "volume", "profile": "node"}
COLOURS = {"implicit": "tab:blue", "cycle-jump": "tab:orange", "every-cycle": "tab:green"}
ERRORS = [("volume", "error of the worn volume"), ("profile", "error of the profile")]
KINDS = {("volume", "time"): "volume, time", ("profile", "time"): "profile, time",
         ("volume", "evaluations"): "volume, evaluations", ("profile", "evaluations"): "profile, evaluations"}


def read(path):
    with h5py.File(path) as file:
        data = {name: file[name][:] for name in file if file[name].dtype.kind == "f"}
        data |= {name: file[name].asstr()[:] for name in ["stepper", "cycle", "status", "reason"]}
        data["title"] = file.attrs["title"]
        data["reference"] = [file.attrs[f"reference_{name}"] for name in ["springs", "tolerance", "uncertainty"]]
    return data


def draw(axes, data, error, cost):
    by_hand = np.isnan(data["accuracy"])
    x, y = data[cost], data[f"{OWN[error]}_error_max"]
    kind = "time" if cost == "wall_seconds" else "evaluations"
    for stepper, colour in COLOURS.items():
        for cycle, marker in [("closed-form", "o"), ("resolved", "x")]:
            chosen = by_hand & (data["stepper"] == stepper) & (data["cycle"] == cycle) & np.isfinite(y)
            axes.loglog(x[chosen], y[chosen], marker, color=colour, markersize=3, alpha=0.5, rasterized=np.count_nonzero(chosen) > 30)
    front = np.flatnonzero(data[f"front_{error}_{kind}"] == 1)
    front = front[np.argsort(x[front])]
    axes.step(x[front], y[front], where="post", color="k", linewidth=1)
    chosen = ~by_hand & np.isfinite(y)
    axes.loglog(x[chosen], y[chosen], "D", color="tab:red", markersize=5)
    for at in np.flatnonzero(chosen):
        axes.annotate(f"{data['accuracy'][at]:.0e}".replace("e-0", "e-"), (x[at], y[at]), xytext=(4, 3),
                      textcoords="offset points", fontsize=6, color="tab:red")
    # Below this the reference itself is not surer.
    axes.axhline(float(data["reference"][2].split(",")[error == "profile"]), color="0.7", linestyle=":", linewidth=1)
    axes.grid(True, which="major", color="0.92")


def table(data):
    print(f"\n### {data['title']}\n")
    springs, *pairs = data["reference"]
    tolerance, uncertainty = [[float(word) for word in pair.split(",")] for pair in pairs]
    print(f"References: {springs} springs, tolerances {tolerance[0]:.1e}, {tolerance[1]:.1e}; uncertain by {uncertainty[0]:.1e} "
          f"(volume), {uncertainty[1]:.1e} (profile).\n")
    print("| stepper, cycle | springs | tolerance | wall time | with file | evaluations | volume error | profile error | front |")
    print("|---|---|---|---|---|---|---|---|---|")
    fronts = {kind: data["front_" + "_".join(kind)] == 1 for kind in KINDS}
    shown = np.flatnonzero(fronts["volume", "time"] | fronts["profile", "time"])
    chosen = np.flatnonzero(~np.isnan(data["accuracy"]) & (data["status"] == "done"))
    for at in [*shown[np.argsort(data["wall_seconds"][shown])], *chosen]:
        error = lambda name: ("<" if data[f"{OWN[name]}_error_max_bounded"][at] else "") + f"{data[f'{OWN[name]}_error_max'][at]:.1e}"
        if at in chosen:
            over = [data[f"chosen_{name}_time"][at] for name in ["volume", "profile"]]
            words = [f"{ratio:.2f}" if np.isfinite(ratio) else "beyond" for ratio in over]
            place = f"accuracy {data['accuracy'][at]:.0e}: {words[0]} (volume), {words[1]} (profile)"
        else:
            place = "; ".join(KINDS[kind] for kind in KINDS if fronts[kind][at])
        print(f"| {data['stepper'][at]}, {data['cycle'][at]} | {data['springs'][at]:.0f} | {data['tolerance'][at]:.0e} | "
              f"{1e3 * data['wall_seconds'][at]:.1f} ms | {1e3 * data['wall_seconds_file'][at]:.1f} ms | "
              f"{data['rate_evaluations'][at]:.0f} | {error('volume')} | {error('profile')} | {place} |")


scenes = [read(path) for path in paths]
COLUMNS = [(error, cost) for cost in ["wall_seconds", "rate_evaluations"] for error, _ in ERRORS]
plot, grid = plt.subplots(len(scenes), len(COLUMNS), figsize=(12.5, (3.1 if len(scenes) < 5 else 2.3) * len(scenes)), layout="constrained", squeeze=False,
                          sharex="col", sharey=True)
for row, data in zip(grid, scenes):
    for axes, (error, cost) in zip(row, COLUMNS):
        draw(axes, data, error, cost)
    row[0].set_ylabel("\n".join(textwrap.wrap(data["title"], 34)) + "\nlargest error over the snapshots", fontsize=7)
    table(data)
for axes, (error, cost) in zip(grid[0], COLUMNS):
    axes.set_title(dict(ERRORS)[error], fontsize=9)
for axes, (error, cost) in zip(grid[-1], COLUMNS):
    axes.set_xlabel("wall time, s" if cost == "wall_seconds" else "rate evaluations")
grid[0, 0].set_ylim(top=min(grid[0, 0].get_ylim()[1], 3))  # beyond, a run by hand came to nothing
handles = [plt.Line2D([], [], marker="o", linestyle="", color=colour, label=stepper) for stepper, colour in COLOURS.items()]
handles += [plt.Line2D([], [], marker="x", linestyle="", color="0.4", label="resolved cycle"),
            plt.Line2D([], [], color="k", label="front"),
            plt.Line2D([], [], marker="D", linestyle="", color="tab:red", label="accuracy = ..."),
            plt.Line2D([], [], color="0.7", linestyle=":", label="uncertainty of the reference")]
plot.legend(handles=handles, loc="outside upper center", ncols=len(handles), frameon=False, fontsize=8)
plot.savefig(figure, metadata={"Date": None} if figure.endswith(".svg") else None, dpi=100)
