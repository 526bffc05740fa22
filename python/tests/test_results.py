"""What the package gives is what the command gives."""

import json
import os
import pathlib
import pickle
import subprocess
import sys

import numpy as np
import pytest

import fretwear

DATA = pathlib.Path(__file__).parents[2] / "data"
BALL = DATA / "scenes" / "paraboloid.toml"
# The one that came with the package, or another that was built from the same sources.
COMMAND = os.environ.get("FRETWEAR_COMMAND", str(pathlib.Path(sys.executable).with_name("fretwear")))
MEASURED_TIME = {"wall_seconds"}


def command(*arguments, code=0):
    done = subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    return done.stdout


def same(one, other):
    """To the bit, not-a-numbers included."""
    return one.shape == other.shape and (one.tobytes() == other.tobytes() or list(one.flat) == list(other.flat))


def all_variables(results, group=""):
    for name in results.variables(group):
        yield f"{group}/{name}".lstrip("/")
    for inner in results.groups(group):
        yield from all_variables(results, f"{group}/{inner}".lstrip("/"))


@pytest.fixture(scope="module")
def run():
    return fretwear.run(BALL)


@pytest.mark.parametrize("scene", sorted(path.stem for path in (DATA / "scenes").glob("*.toml")))
def test_a_run_is_that_of_the_command_to_the_bit(scene, tmp_path):
    h5py = pytest.importorskip("h5py")
    path = DATA / "scenes" / f"{scene}.toml"
    # Some take half a minute on as many springs as they ask for.
    few = scene not in ("paraboloid", "graded_ceramic", "waviness")
    stored = json.loads(command("run", path, "-o", tmp_path / "run.h5", "--json", *(["--set", "numerics.springs=24"] if few else [])))
    run = fretwear.run(path, set={"numerics.springs": 24} if few else None)
    names = list(all_variables(run))
    # h5py brings another HDF5 into this process.
    with h5py.File(tmp_path / "run.h5") as file:
        found = []
        file.visititems(lambda name, it: found.append(name) if isinstance(it, h5py.Dataset) else None)
        assert sorted(found) == sorted(names)
        for name in set(names) - {"checkpoint/wall_seconds"}:
            values = file[name][()]
            assert same(run[name], np.asarray(values)), name
            assert run.units(name) == file[name].attrs["units"] and run.long_name(name) == file[name].attrs["long_name"]
    assert run.summary.keys() == stored.keys() and run.summary["output"] is None
    for key in stored.keys() - MEASURED_TIME - {"output"}:
        assert run.summary[key] == stored[key], key
    opened = fretwear.open(tmp_path / "run.h5")
    assert opened.summary == stored and opened.path == str(tmp_path / "run.h5")


def test_a_saved_run_is_a_result_file_and_is_not_overwritten_unasked(run, tmp_path):
    run.save(tmp_path / "run.h5")
    assert '"complete": true' in command("info", tmp_path / "run.h5", "--json")
    with pytest.raises(FileExistsError, match="run.h5"):
        run.save(tmp_path / "run.h5")
    run.save(tmp_path / "run.h5", overwrite=True)
    assert same(fretwear.open(tmp_path / "run.h5").wear_depth, run.wear_depth)


def test_the_annotated_variables_are_those_of_a_run(run):
    stub = (pathlib.Path(fretwear.__file__).parent / "_results.py").read_text()
    for name in run.variables():
        assert f"        {name}: " in stub, f"{name} is not annotated"
        said = stub.split(f"        {name}: ")[1].split('"""')[1]
        units = {"m3": "m³"}.get(run.units(name), run.units(name))
        assert said.startswith(run.long_name(name)) and (units == "1" or units in said), name


def test_limit_and_check_have_the_keys_and_numbers_of_the_commands():
    at = [0.0, 8e-5]
    stored = json.loads(command("limit", BALL, "--json", "--at", "0,8e-5"))
    found = fretwear.limit(BALL, at=at)
    assert {name: list(values) for name, values in found.pop("profile").items()} == stored.pop("profile")
    assert found == stored
    assert fretwear.check(BALL) == json.loads(command("check", BALL, "--json"))
    changed = fretwear.check(BALL, set={"loading.amplitude": "0.2 um"})
    assert changed["amplitude"] == 2e-7


def test_text_dictionary_and_scene_are_the_same_as_the_file(run):
    tomllib = pytest.importorskip("tomllib")
    text = BALL.read_text()
    for scene in (text, tomllib.loads(text), fretwear.Scene(BALL), fretwear.Scene(tomllib.loads(text))):
        assert same(fretwear.run(scene).wear_depth, run.wear_depth)


def test_a_scene_is_built_from_tables_dotted_keys_and_numpy_numbers():
    parts = dict(
        indenter={"paraboloid": {"radius": "10 mm"}},
        half_space={"grading": np.float64(0), "modulus": 210e9, "poisson_ratio": 0.3},
        friction={"coulomb.coefficient": 0.7},
        wear={"archard.coefficient": "1e-8 1/MPa"},
        loading={"initial_force": "10 N", "stick_ratio": 0.7, "cycles": np.int64(1000)},
        output={"at_cycles": np.array([10.0, 100.0])},
    )
    scene = fretwear.Scene(**parts)
    assert list(fretwear.run(scene).cycles) == [0, 10, 100, 1000]
    # What excludes a key is left out; laid over a base, tables count key by key.
    assert fretwear.check(scene, set={"loading.amplitude": "0.1 um"})["amplitude"] == 1e-7
    assert fretwear.check(fretwear.Scene(scene, loading={"tau": 2}))["tau"] == 2
    assert pickle.loads(pickle.dumps(scene)) == scene


def test_files_that_a_scene_names_are_found_after_pickling(tmp_path, monkeypatch):
    scene = fretwear.Scene(DATA / "scenes" / "measured_profile.toml")
    monkeypatch.chdir(tmp_path)
    assert fretwear.check(pickle.loads(pickle.dumps(scene))) == fretwear.check(DATA / "scenes" / "measured_profile.toml")


def test_results_cannot_be_changed_by_accident(run):
    with pytest.raises(ValueError):
        run.wear_volume[0] = 1.0
    with pytest.raises(AttributeError, match="wear_volume"):
        run.wear_volumes


def test_runs_and_studies_survive_pickling(run, tmp_path):
    again = pickle.loads(pickle.dumps(run))
    assert type(again) is fretwear.Run and again.summary == run.summary
    for name in all_variables(run):
        assert same(again[name], run[name]), name
    swept = fretwear.sweep(DATA / "studies" / "friction.toml")
    again = pickle.loads(pickle.dumps(swept))
    assert again.kind == "sweep" and same(again.wear_volume, swept.wear_volume)
    again.save(tmp_path / "sweep.h5")
    assert same(fretwear.open(tmp_path / "sweep.h5").wear_volume, swept.wear_volume)


def test_a_sweep_is_that_of_the_command(tmp_path):
    command("sweep", DATA / "studies" / "friction.toml", "-o", tmp_path / "one", "--quiet")
    (file,) = (tmp_path / "one").glob("*.h5")
    stored = fretwear.open(file)
    swept = fretwear.sweep(DATA / "studies" / "friction.toml", output=tmp_path / "two")
    assert swept.path is not None and stored.variables() == swept.variables()
    for name in set(stored.variables()) - MEASURED_TIME:
        assert same(stored[name], swept[name]), name
    tomllib = pytest.importorskip("tomllib")
    study = tomllib.loads((DATA / "studies" / "friction.toml").read_text())
    study["scene"] = tomllib.loads(BALL.read_text())
    assert same(fretwear.sweep(study).wear_volume, swept.wear_volume)
    # A kept run and a single one: the same numbers.
    row = swept.to_pandas().iloc[0]
    keys = {"friction.coulomb.coefficient": row["input_friction_coulomb_coefficient"], "loading.amplitude": row["input_loading_amplitude"]}
    assert fretwear.run(BALL, set=keys).summary["wear_volume"] == row["wear_volume"]


def test_many_runs_are_those_of_one_each_and_in_their_order():
    scenes = [fretwear.Scene(BALL, loading={"tau": tau}) for tau in (3.0, 1.0, 2.0, 0.5)]
    for threads in (None, 1, 2):
        for one, run in zip(scenes, fretwear.run_many(scenes, threads=threads)):
            assert same(run.wear_depth, fretwear.run(one).wear_depth)
    assert fretwear.run_many([]) == []


def test_xarray_is_what_it_reads_from_the_file(run, tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    run.save(tmp_path / "run.h5")
    with xarray.open_dataset(tmp_path / "run.h5", engine="h5netcdf") as stored:
        made = run.to_xarray()
        xarray.testing.assert_equal(made, stored)
        for name in stored.variables:
            assert made[name].attrs["units"] == stored[name].attrs["units"], name
    assert run.to_xarray("loops").displacement.dims == ("time", "point")


def test_tables_have_units_and_are_those_of_export(run, tmp_path):
    pandas = pytest.importorskip("pandas")
    run.save(tmp_path / "run.h5")
    for table in ("time", "time,node"):
        frame = run.to_pandas(table).reset_index()
        path = tmp_path / f"{table}.csv"
        command("export", tmp_path / "run.h5", "--table", table, "-o", path)
        stored = pandas.read_csv(path)
        for column in stored.columns:
            name = column.split(" [")[0]
            # Words are numbers in the arrays.
            if stored[column].dtype == float:
                np.testing.assert_array_equal(frame[name].to_numpy(), stored[column].to_numpy())
    assert run.to_pandas().attrs["units"]["wear_volume"] == "m3"
    with pytest.raises(KeyError, match="time,node"):
        run.to_pandas("nodes")


def test_every_kind_of_figure_is_drawn(run):
    for kind in run.plots:
        assert run.svg(kind).text.startswith("<svg") and run.png(kind)[:4] == b"\x89PNG"
        pytest.importorskip("matplotlib").use("Agg")
        figure = run.plot(kind)
        figure.canvas.draw()
        assert figure.get_suptitle() and len(figure.subfigs) >= 1
    assert "<svg" in run._repr_html_() and "wear_volume" in run._repr_html_()
    with pytest.raises(fretwear.SceneError, match="profile"):
        run.plot("nonsense")
    assert fretwear.sweep(DATA / "studies" / "friction.toml").svg().text.startswith("<svg")
