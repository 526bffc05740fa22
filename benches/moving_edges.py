"""Edges of stick that move, judged on scenes of which no test was made: what runs at an accuracy deliver, and the order with which the volume converges.

    python3 benches/moving_edges.py target/release/fretwear [ACCURACY] ["SCENE;..."]
    python3 benches/moving_edges.py target/release/fretwear ACCURACY references

A row: scene, springs, by how much volume and edge of stick miss those on 480 springs by hand (at a thirtieth of the tolerance), estimate,
exit code, and the order of the volume over 60, 120, 240 and 480 springs at that tolerance. Volumes are over the limit's or, where there is none, the run's
own; the edge is over the contact radius. Where 480 springs come to no end, 240 are the last. It ends with exit code 1 if a run that ended with exit code 0
misses by more than its accuracy, or an order is below two.

`references` judges runs by data/reference/moving_edges.csv instead, which another code made: the volume relative to the last of its case, and the edge over the first contact radius.
Where an edge jumps at the moment of a row, that row has the one before.
"""

import csv
import math
import pathlib
import sys
import tempfile

from delivered import ACCURACY, FRICTION, KINDS, blocks, history, run, scene, springs_of

SPRINGS = (60, 120, 240, 480)
# Depth 1 µm and radii of about 1 mm, but for the sphere, a quarter of whose radius is pressed in.
INDENTERS = {
    "paraboloid": ("[indenter.paraboloid]\nradius = 0.5\n", 1e-6, 1e-3, 2),
    "cone": ("[indenter.cone]\nslope = 1e-3\n", 1e-6, 1e-3, 1),
    "n = 4": ("[indenter.power-law]\ncoefficient = 1e6\nexponent = 4\n", 1e-6, 1e-3, 4),
    "sphere": ("[indenter.sphere]\nradius = 2e-3\n", 5e-4, 1e-3, 2),
}


def control_of(name, factor, grading, radius, depth, n):
    """Keys of a scene that say what is held, for the first contact radius and the exponent of a profile."""
    # Force of a flat punch over the normal stiffness of the springs and the depth.
    punch = 2 * radius ** (1 + grading) / (1 + grading)
    return {
        "normal force": {"load": f"normal_force = {2e11 * punch * depth * n / (n + 1 + grading)}"},
        "friction": {"friction": FRICTION + history("friction", factor)},
        "tangential force": {"more": 'tangential_control = "force"'},
        "rig": {"more": f"rig_stiffness = {factor * 2e11 * 2 / 3 * punch}"},
    }[name]


def of(indenter, grading, stick_ratio, tau, control, factor):
    text, depth, radius, n = INDENTERS[indenter]
    steps = {"more": blocks((0.3 * tau, 1, 1), (1, factor, 1))}
    keys = steps if control == "blocks" else control_of(control, factor, grading, radius, depth, n)
    return {"load": f"indentation = {depth}", "grading": grading, "tau": tau, "amplitude": f"stick_ratio = {stick_ratio}", "indenter": text} | keys


def rows():
    with open(pathlib.Path(__file__).with_suffix(".csv"), newline="", encoding="utf-8") as file:
        return [
            (row["indenter"], float(row["k"]), float(row["c/a0"]), float(row["tau"]), row["control"], float(row["factor"])) for row in csv.DictReader(file)
        ]


def title(indenter, grading, stick_ratio, tau, control, factor):
    return f"{control}{'' if factor == 1 else f' × {factor:g}'}, {indenter}, k = {grading:g}, c/a0 = {stick_ratio:g}, τ = {tau:g}"


# Cases of data/reference/moving_edges.csv: what is held and its factor; blocks by duration, τ, and amplitude factor.
CASES = {
    "A": ("normal force held", ("normal force", 1), ()),
    "C": ("tangential force held", ("tangential force", 1), ()),
    "D-2": ("rig of twice the contact's stiffness", ("rig", 2), ()),
    "J1": ("amplitude halved at τ = 1", None, ((1, 1, 1), (1e3, 0.5, 1))),
    "E": ("amplitude halved for 1 < τ < 3", None, ((1, 1, 1), (2, 0.5, 1), (1e3, 1, 1))),
}


def references():
    """Prints the rows of another code's table beside what runs deliver; how many miss by more than the accuracy without a word."""
    depth, wrong = 1e-6, 0
    table = pathlib.Path(__file__).parent.parent / "data/reference/moving_edges.csv"
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    print("| case | k | τ | volume misses | of the table | edge misses | estimate | exit |\n|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        for row in rows:
            grading, tau, volume = float(row["k"]), float(row["tau"]), float(row["V/(a0^2 d0)"])
            name, control, steps = CASES[row["case"]]
            # Of the paraboloid of `scene`.
            radius = math.sqrt(depth * (1 + grading))
            keys = control_of(*control, grading, radius, depth, 2) if control else {"more": blocks(*steps)}
            found, code, said = run(folder, scene(f"accuracy = {ACCURACY}", grading=grading, tau=tau, **keys), 300)
            if "wear_volume" not in found:
                print(f"| {name} | {grading:g} | {tau:g} | | | | | {code} {said.splitlines()[-1:]} |", flush=True)
                continue
            last = max(float(it["V/(a0^2 d0)"]) for it in rows if it["case"] == row["case"] and it["k"] == row["k"])
            misses = abs(found["wear_volume"] / (radius**2 * depth) - volume) / last
            uncertain = float(row["V_err"]) / last
            # The edge jumps at the ends of blocks.
            jumps = tau in [sum(duration for duration, *_ in steps[:end]) for end in range(1, len(steps))]
            edge = 0 if jumps else abs(found["stick_radius"] / radius - float(row["c/a0 now"]))
            bad = code == 0 and not (misses <= ACCURACY + uncertain and edge <= 10 * ACCURACY)
            wrong += bad
            print(
                f"| {name} | {grading:g} | {tau:g} | {misses:.1e} | {uncertain:.1e} | {'jumps' if jumps else f'{edge:.1e}'} "
                f"| {found['error_estimate']:.1e} | {code}{' WRONG' if bad else ''} |",
                flush=True,
            )
    return wrong


def main():
    if KINDS == ["references"]:
        sys.exit(1 if references() else 0)
    wrong = 0
    print("| scene | springs | volume misses | edge misses | estimate | exit | order | seconds |\n|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for row in rows():
            if KINDS and title(*row) not in KINDS:
                continue
            keys = of(*row)
            found, code, said = run(folder, scene(f"accuracy = {ACCURACY}", **keys), 300)
            if "wear_volume" not in found:
                print(f"| {title(*row)} | | | | | {code} | | {said.splitlines()[-1:]} |", flush=True)
                continue
            springs = springs_of(folder)

            def by_hand(count, keys=keys):
                return run(folder, scene(f"springs = {count}\ntolerance = {0.01 * ACCURACY}\n", **keys), 200)[0]

            finer = [it for it in map(by_hand, SPRINGS) if it]
            best = finer[-1]
            changes = [abs(a["wear_volume"] - b["wear_volume"]) for a, b in zip(finer, finer[1:])]
            order = math.log2(changes[0] / changes[-1]) / (len(changes) - 1)
            scale = found["wear_volume_limit"] or found["wear_volume"]
            volume = abs(found["wear_volume"] - best["wear_volume"]) / scale
            edge = abs(found["stick_radius"] - best["stick_radius"]) / found["contact_radius"]
            bad = code == 0 and not max(volume, edge) <= ACCURACY or not order >= 2
            wrong += bad
            print(
                f"| {title(*row)} | {springs} | {volume:.1e} | {edge:.1e} | {found['error_estimate']:.1e} | {code} | {order:.1f}{' WRONG' if bad else ''} "
                f"| {found['wall_seconds']:.1f} |",
                f" {[f'{change / scale:.1e}' for change in changes]}" if bad else "",
                flush=True,
            )
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
