"""Times the published route to fretting wear against this program: python3 benches/published_route.py [--quick | --processes], with numpy, scipy, h5py.

Needs the binary: cargo build --release. Prints the tables of docs/published_route.md in a quarter of an hour, with --quick the coarser half in a minute. With
--processes SciPy's BDF with the analytic Jacobian and this program are set side by side on as many springs, each as a whole process.

The published route (Dimaki, Dmitriev, Chai, Popov 2014; Benad 2018; Li, Forsbach, Benad 2019; Willert 2021) keeps the worn profile f on
radial nodes. Every cycle goes from f to the equivalent profile g by Eq. (19), to the contact radius by g(a) = d, to the pressure by
Eq. (21), to the slip amplitude, and adds 4 k_w p s to f. Here it is for a paraboloid on a homogeneous half-space, k = 0 and c/a0 = 0.7, in the
units of the contact: radii in a0, depths in d, time τ, so that dw/dτ = p s. What would slow it down without need is left out:

* Both transforms are matrices, assembled once by product integration: the profiles are linear in r² from node to node, which is exact
  for the unworn paraboloid, and the kernels are integrated exactly. The edge of stick is a node.
* The contact edge lies within its cell, where the compression falls to zero, and the pressure takes that into account.
* Slip is s = f - f_c, f_c the free surface of the stick zone in closed form: no third transform.

Two grids: "whole profile" is uniform in r from 0 to beyond the contact, as published; "annulus" has its nodes beyond c alone, graded to c, and adds
the wear's part of g to the exact g of the unworn profile, which is cheaper and more accurate.
"""

import argparse
import os
import resource

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as fretwear, which computes a run on one thread

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np
from scipy.integrate import solve_ivp

STICK = 0.7  # c/a0
OUTER = 1.2  # end of the grid, in a0; the contact grows to 1.14
END = 30.0
TIMES = np.array([1.0, 3.0, 10.0, END])
CYCLES = 880_000  # at the wear of data/scenes/paraboloid.toml
BOUNDARY_ELEMENTS = np.array([0.0268731, 0.0830288, 0.213381, 0.235817])  # worn volume over a0² d at TIMES, without the method of dimensionality reduction

BINARY = Path(__file__).resolve().parent.parent / "target/release/fretwear"
SCENE = f"""
[indenter.paraboloid]
radius = "10 mm"
[half_space]
grading = 0
normal_stiffness = 1e9
stiffness_ratio = 1
[friction.coulomb]
coefficient = 0.5
[wear.archard]
coefficient = "{1.5e-6 / CYCLES} 1/Pa"
[loading]
indentation = "1 um"
stick_ratio = {STICK}
cycles = {CYCLES}
[output]
at_tau = [1, 3, 10]
[numerics]
"""
SCENE_VOLUME = 1e-4**2 * 1e-6  # a0² d, m³


def root(square):
    """Square root of what may be negative by position: nothing there."""
    return np.sqrt(np.maximum(square, 0.0))


def free_surface(r):
    """Surface left by the paraboloid pressed until its contact radius is c: Eq. (20) with g = x² cut at c²."""
    c = STICK
    inner = 0.5 * r**2 * np.arcsin(c / r) - 0.5 * c * np.sqrt(r**2 - c**2)
    return 2 / np.pi * (inner + c**2 * (0.5 * np.pi - np.arcsin(c / r)))


class Route:
    """The right-hand side dw/dτ = p s on nodes beyond c, with the matrices of both transforms."""

    def __init__(self, cells, annulus):
        if annulus:
            self.nodes = STICK + (OUTER - STICK) * np.linspace(0, 1, cells + 1) ** 2
            self.first = 1
        else:
            inner = round(cells * STICK / OUTER)
            self.nodes = STICK / inner * np.arange(cells + 1)
            self.first = inner + 1
        r = self.nodes
        self.edge_from = int(np.searchsorted(r, 1.0 + 1e-9))
        t = self.square = r**2
        width = np.diff(t)
        # Eq. (19) and Eq. (21), row by row over the cells, then by nodes.
        cell = 2 * r[:, None] * (root(t[:, None] - t[:-1]) - root(t[:, None] - t[1:])) / width
        self.to_springs = self.by_nodes(cell)
        cell = 2 / np.pi * (root(t[1:] - t[:, None]) - root(t[:-1] - t[:, None])) / width
        self.to_pressure = -self.by_nodes(cell)  # of the compression q = d - g
        self.unworn = 0.5 * t
        self.unworn_springs = t
        self.annulus = annulus
        self.slip_unworn = np.zeros_like(r)
        beyond = slice(self.first, None)
        self.slip_unworn[beyond] = self.unworn[beyond] - free_surface(r[beyond])

    @staticmethod
    def by_nodes(cell):
        matrix = np.zeros((cell.shape[0], cell.shape[0]))
        matrix[:, 1:] += cell
        matrix[:, :-1] -= cell
        return matrix

    def pressure(self, wear):
        """Pressure on the nodes; the last node in contact, the compression there and at the next."""
        if self.annulus:
            springs = self.unworn_springs + self.to_springs @ wear
        else:
            springs = self.to_springs @ (self.unworn + wear)
        compression = 1.0 - springs
        # The contact only grows: its edge is sought from a0 on.
        last = self.edge_from + int(np.argmax(compression[self.edge_from :] <= 0.0)) - 1
        compression[last + 1 :] = 0.0
        pressure = self.to_pressure @ compression
        # In the last cell the compression falls to zero at the contact edge, not at the cell's end.
        t, q = self.square, compression[last]
        next_q = 1.0 - springs[last + 1]
        full = t[last + 1] - t[last]
        part = full * q / (q - next_q) if q > 0 else full
        inner = t[: last + 1]
        near = np.sqrt(t[last] - inner)
        pressure[: last + 1] += (2 / np.pi * q) * (
            (np.sqrt(t[last] + part - inner) - near) / part - (np.sqrt(t[last + 1] - inner) - near) / full
        )
        pressure[last + 1 :] = 0.0
        return pressure, last, q, next_q

    def rate(self, wear):
        """dw/dτ on the nodes."""
        return self.pressure(wear)[0] * (self.slip_unworn + wear)

    def jacobian(self, wear):
        """Analytic, the moving contact edge included."""
        pressure, last, q, next_q = self.pressure(wear)
        span = slice(self.first, last + 1)
        inner = self.square[span]
        by_compression = np.zeros((last + 1 - self.first, last + 2))
        by_compression[:, span] = self.to_pressure[span, span]
        full = self.square[last + 1] - self.square[last]
        near = np.sqrt(self.square[last] - inner)
        if q > 0:
            part = full * q / (q - next_q)
            edge = np.sqrt(self.square[last] + part - inner)
            mean = (edge - near) / part
            by_part = 0.5 / (part * edge) - mean / part
            whole = (np.sqrt(self.square[last + 1] - inner) - near) / full
            by_compression[:, last] += 2 / np.pi * (mean - whole - q * by_part * full * next_q / (q - next_q) ** 2)
            by_compression[:, last + 1] += 2 / np.pi * q * by_part * full * q / (q - next_q) ** 2
        matrix = np.zeros((len(wear), len(wear)))
        matrix[span] = -(self.slip_unworn + wear)[span, None] * (by_compression @ self.to_springs[: last + 2])
        matrix[np.diag_indices_from(matrix)] += pressure
        return matrix[self.first :, self.first :]

    def volume(self, wear):
        """Worn volume over a0² d; π ∫ w dr²."""
        return np.pi * float(np.sum(0.5 * (wear[1:] + wear[:-1]) * np.diff(self.square)))

    def start(self):
        return np.zeros_like(self.nodes)

    def cycles(self, per_update, most_seconds=np.inf):
        """Explicit updates; the volumes at TIMES, or as many as there was time for, and the part of the cycles done."""
        step = END / CYCLES * per_update
        updates = round(END / step)
        wanted = {max(1, round(updates * tau / END)): tau for tau in TIMES}
        wear, volumes, begin = self.start(), [], time.perf_counter()
        for update in range(1, updates + 1):
            wear = wear + step * self.rate(wear)
            if update in wanted:
                volumes.append(self.volume(wear))
            if update % 256 == 0 and time.perf_counter() - begin > most_seconds:
                break
        return np.array(volumes), update / updates

    def bdf(self, tolerance, analytic):
        """Volumes at TIMES by SciPy's BDF on the nodes beyond c."""

        def full(inner):
            wear = self.start()
            wear[self.first :] = inner
            return wear

        def rate(_, inner):
            wear = full(inner)
            rates = self.rate(wear)
            # Zero beyond the contact, as is the wear; without some slope there SciPy's difference quotients overflow.
            rates[rates == 0.0] = -wear[rates == 0.0]
            return rates[self.first :]

        solution = solve_ivp(
            rate,
            (0.0, END),
            self.start()[self.first :],
            method="BDF",
            t_eval=TIMES,
            rtol=tolerance,
            atol=0.01 * tolerance,
            jac=(lambda _, y: self.jacobian(full(y))) if analytic else None,
        )
        return np.array([self.volume(full(y)) for y in solution.y.T])


def fretwear(numerics, repeats):
    """Volumes at TIMES and the seconds of a whole process, its start and its file included: the median of several."""
    with tempfile.TemporaryDirectory() as folder:
        scene, result = Path(folder, "scene.toml"), Path(folder, "scene.h5")
        scene.write_text(SCENE + numerics)
        seconds = []
        for _ in range(repeats):
            begin = time.perf_counter()
            subprocess.run([BINARY, "run", scene, "-o", result, "--force", "--quiet"], check=True, stdout=subprocess.DEVNULL)
            seconds.append(time.perf_counter() - begin)
        with h5py.File(result) as run:
            at = [int(np.argmin(np.abs(run["tau"][:] - tau))) for tau in TIMES]
            assert np.allclose(run["tau"][:][at], TIMES)
            return run["wear_volume"][:][at] / SCENE_VOLUME, statistics.median(seconds)


def timed(action):
    begin = time.perf_counter()
    value = action()
    return value, time.perf_counter() - begin


class Comparison:
    def __init__(self, repeats):
        self.reference, _ = fretwear("springs = 120\ntolerance = 1e-8\n", 1)
        finer, _ = fretwear("springs = 240\ntolerance = 1e-8\n", 1)
        print("Reference (120 springs, tolerance 1e-8):", *(f"{v:.9f}" for v in self.reference))
        print(f"It differs from 240 springs by {self.error(finer):.1e}, from boundary elements by {self.error(BOUNDARY_ELEMENTS):.1e}.")
        hello = statistics.median(timed(lambda: subprocess.run([BINARY, "--version"], stdout=subprocess.DEVNULL))[1] for _ in range(repeats))
        python = [sys.executable, "-c", "import numpy, scipy.integrate"]
        start = statistics.median(timed(lambda: subprocess.run(python))[1] for _ in range(3))
        print(f"`fretwear --version` takes {1e3 * hello:.1f} ms; importing NumPy and SciPy, not counted below, {start:.2f} s.\n")
        print("| fretwear | error | ms |\n|---|---|---|")
        self.ladder = []
        for numerics in [f"accuracy = {a}\n" for a in ["1e-2", "1e-3", "1e-4"]] + [
            f"springs = {n}\ntolerance = {t}\n" for n, t in [(8, "1e-2"), (12, "1e-2"), (16, "1e-2"), (16, "1e-3"), (24, "1e-3"), (24, "1e-4"), (32, "1e-4")]
        ]:
            volumes, seconds = fretwear(numerics, repeats)
            self.ladder.append((self.error(volumes), seconds))
            print(f"| {numerics.strip().replace(chr(10), ', ')} | {self.error(volumes):.1e} | {1e3 * seconds:.1f} |")
        print("\n| method | grid | N | error | s | fretwear at that error or below, ms | ratio |\n|---|---|---|---|---|---|---|", flush=True)

    def error(self, volumes):
        """Largest error over TIMES, relative to the volume at the end."""
        if len(volumes) != len(TIMES) or not np.all(np.isfinite(volumes)):
            return np.inf
        return float(np.max(np.abs(volumes - self.reference)) / self.reference[-1])

    def row(self, method, grid, cells, error, seconds, mark=""):
        cheapest = min((s for e, s in self.ladder if e <= error), default=np.nan)
        ratio = f"{seconds / cheapest:.0f}" if seconds > 10 * cheapest else f"{seconds / cheapest:.1f}"
        print(f"| {method} | {grid} | {cells} | {error:.1e} | {seconds:.3g}{mark} | {1e3 * cheapest:.1f} | {ratio} |", flush=True)


def processes():
    """Whole processes on as many springs at one tolerance: SciPy's BDF on the annulus, to which the analytic Jacobian is given, and this program."""
    reference, _ = fretwear("springs = 120\ntolerance = 1e-8\n", 1)
    error = lambda volumes: float(np.max(np.abs(np.array(volumes) - reference)) / reference[-1])

    def processor(command, runs):
        """Seconds of the processor, the least of several runs: other programs do not show in it, nor does waiting for the disk."""
        seconds = []
        for _ in range(runs):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run(command, check=True, capture_output=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            seconds.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        return min(seconds)

    start = processor([sys.executable, "-c", "import numpy, scipy.integrate, h5py"], 5)
    print("| springs | tolerance | SciPy's BDF: error | processor s | without its start | fretwear: error | processor s | ratio | without SciPy's start |\n|---|---|---|---|---|---|---|---|---|")
    for cells in [25, 50, 100, 200, 400]:
        for tolerance in ["1e-3", "1e-4"]:
            command = [sys.executable, __file__, "--one", str(cells), tolerance]
            volumes = [float(word) for word in subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()]
            route = processor(command, 3)
            numerics = f"springs = {cells}\ntolerance = {tolerance}\n"
            own, _ = fretwear(numerics, 1)
            with tempfile.TemporaryDirectory() as folder:
                scene = Path(folder, "scene.toml")
                scene.write_text(SCENE + numerics)
                seconds = processor([BINARY, "run", scene, "-o", Path(folder, "scene.h5"), "--force", "--quiet"], 9)
            print(f"| {cells} | {tolerance} | {error(volumes):.1e} | {route:.2f} | {route - start:.2f} | {error(own):.1e} | {seconds:.4f} | {route / seconds:.0f} | "
                  f"{(route - start) / seconds:.1f} |", flush=True)


def main():
    global BINARY
    np.seterr(all="ignore")  # an unstable run is one of the things shown
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--processes", action="store_true")
    parser.add_argument("--program", type=Path, default=BINARY, help="another build of fretwear, such as one with HDF5 linked in")
    parser.add_argument("--one", nargs=2, metavar=("SPRINGS", "TOLERANCE"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    BINARY = arguments.program.resolve()
    if arguments.one:
        cells, tolerance = arguments.one
        print(*Route(int(cells), True).bdf(float(tolerance), True))
        return
    if arguments.processes:
        processes()
        return
    quick = arguments.quick
    sizes = [100, 200] if quick else [100, 200, 400, 800]
    patience = 5.0 if quick else 30.0
    comparison = Comparison(3 if quick else 9)
    for grid, annulus in [("whole profile", False), ("annulus", True)]:
        for cells in sizes:
            route, assembly = timed(lambda: Route(cells, annulus))
            # Cycles per update: the most that leave the error what it is, and the most that are stable, as far as these differ.
            tried = []
            for jump in [30, 100, 300, 1000, 3000, 10000]:
                (volumes, _), seconds = timed(lambda: route.cycles(jump))
                tried.append((jump, comparison.error(volumes), seconds))
                if tried[-1][1] > 0.1:
                    break
            finest = tried[0][1]
            (volumes, part), seconds = timed(lambda: route.cycles(1, patience))
            mark = "" if part == 1 else f" (extrapolated from {100 * part:.0f} % of the cycles)"
            error = comparison.error(volumes) if part == 1 else finest
            comparison.row("every cycle", grid, cells, error, assembly + seconds / part, mark)
            useful = [it for it in tried if it[1] <= 1.2 * finest]
            stable = [it for it in tried if it[1] <= 0.1]
            for jump, error, seconds in sorted({useful[-1], stable[-1]}):
                comparison.row(f"{jump} cycles per update", grid, cells, error, assembly + seconds)
            for analytic in [False, True]:
                tolerances = [1e-3] if cells > 400 and not analytic else [1e-3, 1e-4]
                rows = [(comparison.error(v), s) for v, s in (timed(lambda t=t: route.bdf(t, analytic)) for t in tolerances)]
                least = min(error for error, _ in rows)
                error, seconds = min((it for it in rows if it[0] <= 1.2 * least), key=lambda it: it[1])
                comparison.row("BDF, analytic Jacobian" if analytic else "BDF", grid, cells, error, assembly + seconds)


if __name__ == "__main__":
    main()
