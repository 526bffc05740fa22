"""Calibrations from Python are those of the command."""

import json
import math
import pickle

import numpy as np
import pytest

import fretwear
from test_results import DATA, MEASURED_TIME, command

PUBLISHED = DATA / "calibration" / "ti6al4v_5hz.toml"
ALPHA = "wear.dissipated-energy.coefficient"


def test_a_calibration_is_that_of_the_command(tmp_path):
    told = json.loads(command("calibrate", PUBLISHED, "-o", tmp_path / "command", "--json"))
    found = fretwear.calibrate(PUBLISHED, output=tmp_path / "python")
    own = {name: value for name, value in found.summary.items() if name not in MEASURED_TIME | {"files"}}
    assert own == {name: told[name] for name in own}
    # van Peteghem, Fouvry, Petit, Wear 271 (2011) 1535: 97,429 µm³/J.
    assert math.isclose(found.parameters[ALPHA]["estimate"], 97.429e-15, rel_tol=1e-4)
    assert list(found.estimate) == [found.parameters[ALPHA]["estimate"]] and list(found.key) == [ALPHA]
    stored = fretwear.open(tmp_path / "command" / "calibration.h5")
    assert np.array_equal(stored.residual, found.residual) and found.kind == "calibration"


def test_in_memory_it_needs_no_directory_and_pickles(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    energies = np.array([1.0, 2.0, 4.0, 8.0])
    volumes = 1e-13 * energies * [1.02, 0.99, 1.01, 0.98]
    rows = "".join(f"{energy},{volume}\n" for energy, volume in zip(energies, volumes))
    (tmp_path / "measured.csv").write_text("E [J],V [m^3]\n" + rows)
    found = fretwear.calibrate(
        {
            "unknowns": [{"key": ALPHA, "from": "1e-15 1/Pa", "to": "1e-11 1/Pa"}],
            "data": [{"file": "measured.csv", "dissipated_energy": "E [J]", "wear_volume": "V [m^3]"}],
        }
    )
    assert found.summary["files"] == [] and sorted(tmp_path.iterdir()) == [tmp_path / "measured.csv"]
    assert found.lower[0] < found.estimate[0] < found.upper[0]
    again = pickle.loads(pickle.dumps(found))
    assert isinstance(again, fretwear.Calibration) and again.summary == found.summary
    assert ALPHA in again._repr_html_()


def test_what_is_wrong_is_said_with_its_key(tmp_path):
    with pytest.raises(fretwear.SceneError, match="wear.archard.coeficient"):
        fretwear.calibrate({"unknowns": [{"key": "wear.archard.coeficient", "from": 1, "to": 2}], "data": []})
    with pytest.raises(OSError):
        fretwear.calibrate(tmp_path / "missing.toml")
    output = tmp_path / "twice"
    fretwear.calibrate(PUBLISHED, output=output)
    with pytest.raises(FileExistsError):
        fretwear.calibrate(PUBLISHED, output=output)
    fretwear.calibrate(PUBLISHED, output=output, overwrite=True)


def test_a_scene_of_a_dictionary_is_calibrated_and_another_foretold(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scene = {
        "indenter": {"paraboloid": {"radius": "10 mm"}},
        "half_space": {"grading": 0, "modulus": "105 GPa", "poisson_ratio": 0.3},
        "friction": {"coulomb": {"coefficient": 0.7}},
        "wear": {"archard": {"coefficient": 1e-14}},
        "loading": {"initial_force": 10, "amplitude": "0.325 um", "cycles": 1e4},
    }
    run = fretwear.run({**scene, "output": {"at_cycles": [2e3, 5e3, 1e4]}})
    factors = [1.01, 0.99, 1.0]
    rows = "".join(f"{n},{v * f}\n" for n, v, f in zip(run.cycles[1:], run.wear_volume[1:], factors))
    (tmp_path / "v.csv").write_text("N,V\n" + rows)
    found = fretwear.calibrate(
        {
            "scene": scene,
            "unknowns": [{"key": "wear.archard.coefficient", "from": 1e-17, "to": 1e-11}],
            "data": [{"file": "v.csv", "cycles": "N", "wear_volume": "V", "relative_deviation": 0.01}],
        },
        predict=scene,
        draws=40,
    )
    volume = next(it for it in found.summary["forecast"]["results"] if it["name"] == "wear_volume")
    assert volume["lower"] < run.wear_volume[-1] < volume["upper"]
    assert found.lower[0] < 1e-14 < found.upper[0]
