"""Whether scenes in which several features meet keep to the accuracy asked for: random ones, of ordinary sizes, beside finer runs of themselves.

    python3 benches/together.py target/release/fretwear [FIRST..LAST] [ACCURACY ...]

A scene is a function of its number: indenter, grading, laws of friction and wear, control, regime, mode, start of wear and duration are drawn together. Each is run at
the accuracies (1e-2 and 1e-3 if none are given) and judged by a run at a tenth of the smallest, if that tells an error below a third of what it judges.
Errors are of the worn volume, relative to the limit's or, where there is none, to its own. It prints whatever is not met, then counts, and ends with exit code 1
if a run missed both what was asked for and what it told.
"""

import collections
import json
import pathlib
import random
import subprocess
import sys
import tempfile

BINARY = str(pathlib.Path(sys.argv[1]).resolve())
FIRST, LAST = (int(number) for number in (sys.argv[2] if len(sys.argv) > 2 else "0..100").split(".."))
ACCURACIES = [float(accuracy) for accuracy in sys.argv[3:]] or [1e-2, 1e-3]
PATIENCE = 120  # s

DEPTH = 1e-6  # m
RADIUS = 1e-3  # of the contact, m, about
RATIO = 2 / 3  # of stiffnesses
WEAR = 1.667e-13  # 1/Pa
INDENTERS = {
    "paraboloid": "[indenter.paraboloid]\nradius = 1.0\n",
    "cone": "[indenter.cone]\nslope = 1e-3\n",
    "n = 4": "[indenter.power-law]\ncoefficient = 1e6\nexponent = 4\n",
}
COULOMB = "[friction.coulomb]\ncoefficient = 0.5\n"


def friction_laws(draw):
    return {
        "Coulomb": COULOMB,
        "static and kinetic": f"[friction.static-kinetic]\nstatic_coefficient = 0.5\nkinetic_coefficient = {draw.choice([0.4, 0.45])}\n",
        "load-dependent": f"[friction.load-dependent]\ncoefficient = 0.5\nexponent = {draw.choice([-0.1, 0.2])}\n",
        "history": f"{COULOMB}[friction.history]\nfinal_factor = {draw.choice([0.8, 1.2, 1.5])}\ntau = 1\n",
        "wear-dependent": f"[friction.wear-dependent]\nfirst_coefficient = 0.5\nlast_coefficient = {draw.choice([0.45, 0.6])}\nenergy_density = 1e3\n",
    }


def wear_laws(draw, pressure):
    slip = 1e-7
    return {
        "Archard": f"[wear.archard]\ncoefficient = {WEAR}\n",
        "energy": f"[wear.dissipated-energy]\ncoefficient = {2 * WEAR}\n",
        "p^1.3 s": f"[wear.power-law]\ncoefficient = {WEAR * pressure**-0.3}\npressure_exponent = 1.3\nslip_exponent = 1\n",
        "p^0.7 s^0.7": f"[wear.power-law]\ncoefficient = {WEAR * (pressure * slip) ** 0.3}\npressure_exponent = 0.7\nslip_exponent = 0.7\n",
        "threshold": f"[wear.threshold]\ncoefficient = {WEAR}\npressure = {pressure * draw.choice([0.02, 0.1])}\n",
        "non-local": f"[wear.non-local]\ncoefficient = {WEAR}\nlength = {RADIUS * draw.choice([0.03, 0.1])}\n",
        "friction power": f'[wear.friction-power]\ncoefficient = {2 * WEAR}\nexponent = -0.2\nscope = "local"\n',
    }


def modes(draw, tau):
    def blocks(each, factor):
        return f"[[loading.blocks]]\ntau = {each}\n[[loading.blocks]]\ntau = {each}\namplitude_factor = {factor}\n"

    return {
        "to and fro": "",
        "oscillation": f"[loading.normal_oscillation]\namplitude_ratio = 0.1\nfrequency_ratio = {draw.choice([1, 2])}\nphase = 1.0\n",
        "orbit": "[loading.orbit]\ntransverse_ratio = 0.6\n",
        "growing": blocks(tau / 2, 1.2),
        "shrinking": blocks(tau / 2, 0.7),
        "repeated": "repeat = true\n" + blocks(tau / 6, 0.7),
    }


def scene(number):
    """What a scene is, in words, and its text up to the numerics."""
    draw = random.Random(number)
    grading = draw.choice([0, 0, 0.2, 0.5, 0.8, -0.2, -0.4])
    indenter = draw.choice(["paraboloid", "paraboloid", "cone", "n = 4"])
    control = draw.choice(["indentation", "indentation", "normal force", "tangential force", "both forces", "rig", "rig, normal force"])
    slides = draw.random() < 0.2 and "tangential" not in control and control != "both forces"
    tau = draw.choice([0.3, 1, 3, 10])
    stiffness = 2e11 * RADIUS**-grading
    pressure = stiffness * RADIUS ** (grading - 1) * DEPTH
    keys = [f"tau = {tau}", f"amplitude_ratio = {draw.choice([1.2, 2, 4])}" if slides else f"stick_ratio = {draw.choice([0.3, 0.5, 0.7, 0.85])}"]
    held = "normal" in control or control == "both forces"
    keys.append(f"normal_force = {3 * pressure * RADIUS**2}" if held else f"indentation = {DEPTH}")
    if control in ("tangential force", "both forces"):
        keys.append('tangential_control = "force"')
    if "rig" in control:
        keys.append(f"rig_stiffness = {RATIO * pressure * RADIUS**2 / DEPTH * draw.choice([1, 3, 10])}")
    if draw.random() < 0.15:
        keys.append('wear_from = "first-cycle"')
    laws = [friction_laws(draw), wear_laws(draw, pressure), modes(draw, tau)]
    friction, wear, mode = (draw.choice(sorted(law)) for law in laws)
    if wear == "friction power":
        keys.append("frequency = 10")
    said = f"k = {grading}, {indenter}, {control}, {'gross slip' if slides else 'partial slip'}, {friction}, {wear}, {mode}, τ = {tau}"
    text = (
        f"{INDENTERS[indenter]}[half_space]\ngrading = {grading}\nnormal_stiffness = {stiffness}\nstiffness_ratio = {RATIO}\n{laws[0][friction]}{laws[1][wear]}"
        f"[loading]\n" + "\n".join(keys) + f"\n{laws[2][mode]}[output]\nsnapshots = 6\n[numerics]\n"
    )
    return said, text


def run(text, accuracy):
    """The results of a run, or none, its exit code, and its error."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "scene.toml")
        path.write_text(f"{text}accuracy = {accuracy}\n")
        command = [BINARY, "run", path, "-o", path.with_suffix(".h5"), "--json", "--quiet"]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            return None, "late", ""
        error = " ".join(done.stderr[done.stderr.find("error:") :].split())
        return (json.loads(done.stdout) if done.returncode in (0, 3) else None), done.returncode, error


def main():
    counts, missed = collections.Counter(), False
    for number in range(FIRST, LAST):
        said, text = scene(number)
        found = [run(text, accuracy) for accuracy in ACCURACIES]
        finest = run(text, 0.1 * min(ACCURACIES))[0] if any(results for results, _, _ in found) else None
        for accuracy, (results, code, error) in zip(ACCURACIES, found):
            if results is None:
                kind = {1: "ended with an error", 2: "refused"}.get(code, str(code))
                counts[accuracy, kind] += 1
                if code != 2:
                    print(f"{number} at {accuracy:g}: {said}: {kind}: {error}", flush=True)
                continue
            told = results["error_estimate"]
            counts[accuracy, "met" if told <= accuracy else "told"] += 1
            allowed = max(accuracy, told)
            judged = finest is not None and finest["error_estimate"] < allowed / 3
            off = None
            if judged:
                scale = results["wear_volume_limit"] or finest["wear_volume"]
                off = abs(results["wear_volume"] - finest["wear_volume"]) / scale
                counts[accuracy, "judged"] += 1
                counts[accuracy, "missed"] += off > allowed + finest["error_estimate"]
                missed |= off > allowed + finest["error_estimate"]
            if told > accuracy or judged and off > allowed:
                print(f"{number} at {accuracy:g}: {said}: estimate {told:.1e}, off by {off if off is None else f'{off:.1e}'}", flush=True)
    for (accuracy, kind), count in sorted(counts.items()):
        print(f"{accuracy:g} {kind}: {count}")
    sys.exit(int(missed))


main()
