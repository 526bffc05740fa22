"""What runs deliver, and how far off they are: every kind of scene at an accuracy, beside runs of two and four times the springs by hand.

    python3 benches/delivered.py target/release/fretwear [ACCURACY] ["KIND;..."]

A row: kind, springs, worn volume in a0² d, estimated error, exit code, volumes at two and four times the springs (tolerance a tenth, 768 substeps),
and the miss of the first from the last, relative to the limit's volume or, where there is none, to the run's own.
It ends with exit code 1 if a run that ended with exit code 0 misses by more than its accuracy.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

BINARY = str(pathlib.Path(sys.argv[1]).resolve())
ACCURACY = float(sys.argv[2]) if len(sys.argv) > 2 else 1e-4
KINDS = sys.argv[3].split(";") if len(sys.argv) > 3 else None
MOST_SPRINGS = 480
# 2 c_T a0 of the base scene, N/m.
STIFFNESS = 2 * 2e11 * 2 / 3 * 1e-3
FRICTION = "[friction.coulomb]\ncoefficient = 0.5\n"
WEAR = "[wear.archard]\ncoefficient = 1.667e-13\n"


def scene(
    numerics,
    load="indentation = 1e-6",
    amplitude="stick_ratio = 0.7",
    tau=3,
    grading=0,
    friction=FRICTION,
    wear=WEAR,
    more="",
    indenter="[indenter.paraboloid]\nradius = 1.0\n",
):
    return (
        f"{indenter}[half_space]\ngrading = {grading}\nnormal_stiffness = 2e11\nstiffness_ratio = 0.6666666666666666\n"
        f"{friction}{wear}[loading]\n{load}\n{amplitude}\ntau = {tau}\n{more}\n[numerics]\n{numerics}\n[output]\nsnapshots = 12\n"
    )


def blocks(*rows):
    return "".join(
        f"[[loading.blocks]]\ntau = {tau}\namplitude_factor = {amplitude}\nindentation_factor = {depth}\n" for tau, amplitude, depth in rows
    )


def history(law, factor):
    return f"[{law}.history]\nfinal_factor = {factor}\ntau = 1.5\n"


FORCE = "normal_force = 266.6666666666667"
SLIDING = "amplitude_ratio = 2.0"
SCENES = {
    "plain": {},
    "normal force held": {"load": FORCE},
    "normal force held, τ = 10": {"load": FORCE, "tau": 10},
    "tangential force held": {"more": 'tangential_control = "force"'},
    "rig, half the contact's stiffness": {"more": f"rig_stiffness = {0.5 * STIFFNESS}"},
    "rig, twice": {"more": f"rig_stiffness = {2 * STIFFNESS}"},
    "rising friction": {"friction": FRICTION + history("friction", 2.0)},
    "falling friction": {"friction": FRICTION + history("friction", 0.8)},
    "rig and rising friction": {"friction": FRICTION + history("friction", 1.3), "more": f"rig_stiffness = {2 * STIFFNESS}"},
    "blocks that shrink": {"more": blocks((1, 1, 1), (1, 0.5, 1))},
    "blocks that grow": {"more": blocks((1, 1, 1), (1, 1.3, 1))},
    "blocks repeated": {"more": "repeat = true\n" + blocks((0.5, 1, 1), (0.5, 0.5, 1))},
    "block 1.2 times as deep, repeated": {"more": "repeat = true\n" + blocks((1, 1, 1), (1, 1, 1.2))},
    "normal oscillation, ratio 2": {"more": "[loading.normal_oscillation]\namplitude_ratio = 0.1\nfrequency_ratio = 2\nphase = 1.0\n"},
    "normal oscillation, out of phase": {"more": "[loading.normal_oscillation]\namplitude_ratio = 0.1\nfrequency_ratio = 1\nphase = 1.5707963\n"},
    "out of phase, load-dependent friction": {
        "friction": "[friction.load-dependent]\ncoefficient = 0.5\nexponent = 0.3\n",
        "more": "[loading.normal_oscillation]\namplitude_ratio = 0.1\nfrequency_ratio = 1\nphase = 1.5707963\n",
    },
    "orbit": {"more": "[loading.orbit]\ntransverse_ratio = 0.6\n"},
    "load-dependent friction": {"friction": "[friction.load-dependent]\ncoefficient = 0.5\nexponent = 0.3\n"},
    "static and kinetic friction": {"friction": "[friction.static-kinetic]\nstatic_coefficient = 0.5\nkinetic_coefficient = 0.4\n"},
    "threshold": {"wear": "[wear.threshold]\ncoefficient = 1.667e-13\npressure = 1e7\n"},
    "non-local": {"wear": "[wear.non-local]\ncoefficient = 1.667e-13\nlength = 1e-4\n"},
    "p^1.5 s^0.5": {"wear": "[wear.power-law]\ncoefficient = 1e-22\npressure_exponent = 1.5\nslip_exponent = 0.5\n"},
    "wear that falls": {"wear": WEAR + history("wear", 0.2)},
    "gross slip": {"amplitude": SLIDING, "tau": 1},
    "gross slip, normal force held": {"amplitude": SLIDING, "tau": 1, "load": FORCE},
}


def run(folder, text, seconds):
    (folder / "s.toml").write_text(text)
    try:
        command = [BINARY, "run", "s.toml", "--json", "--force"]
        ended = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return {}, "none in time", ""
    return json.loads(ended.stdout or "{}"), ended.returncode, ended.stderr


def springs_of(folder):
    found = subprocess.run([BINARY, "info", "s.h5", "--json"], cwd=folder, capture_output=True, text=True)
    return json.loads(found.stdout)["nodes"]


def main():
    wrong = 0
    print("| scene | springs | volume | estimate | exit | at twice | at four times | miss | seconds |\n|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for kind, keys in SCENES.items():
            if KINDS and kind not in KINDS:
                continue
            found, code, said = run(folder, scene(f"accuracy = {ACCURACY}", **keys), 300)
            if "wear_volume" not in found:
                print(f"| {kind} | | | | {code} | | | | {said.splitlines()[-1:]}", flush=True)
                continue
            springs = springs_of(folder)
            finer = []
            for factor in (2, 4):
                numerics = f"springs = {min(factor * springs, MOST_SPRINGS)}\ntolerance = {0.03 * ACCURACY}\n"
                finer.append(run(folder, scene(numerics + "substeps = 768", **keys), 200)[0].get("wear_volume"))
            best = next((volume for volume in reversed(finer) if volume), None)
            scale = found["wear_volume_limit"] or found["wear_volume"]
            miss = abs(found["wear_volume"] - best) / scale if best else float("nan")
            bad = code == 0 and not miss <= ACCURACY
            wrong += bad
            shown = [f"{volume * 1e12:.7f}" if volume else "none in time" for volume in finer]
            print(
                f"| {kind} | {springs} | {found['wear_volume'] * 1e12:.7f} | {found['error_estimate']:.1e} | {code} | {shown[0]} | {shown[1]} "
                f"| {miss:.1e}{' WRONG' if bad else ''} | {found['wall_seconds']:.1f} |",
                flush=True,
            )
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
