"""What is wrong is said, with its key."""

import pickle

import pytest

import fretwear

from test_results import BALL, DATA


@pytest.mark.parametrize(
    "change, key",
    [
        ({"half_space.grading": 1.5}, "half_space.grading"),
        ({"loading.amplitude": "2 kg"}, "loading.amplitude"),
        ({"numerics.stepper": "fast"}, "numerics.stepper"),
        ({"loading.amplitude": float("nan")}, "loading.amplitude"),
        ({"loading.cycles": [1, 2]}, "loading.cycles"),
    ],
)
def test_a_bad_value_names_its_key_and_shows_its_place(change, key):
    with pytest.raises(fretwear.SceneError) as caught:
        fretwear.run(BALL, set=change)
    assert caught.value.key == key and "^" in caught.value.message and key in str(caught.value)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.key, again.message) == (key, caught.value.message)


def test_what_cannot_be_toml_names_its_key():
    for value in (object(), 2**80, {1, 2}):
        with pytest.raises((fretwear.SceneError, TypeError)) as caught:
            fretwear.check(BALL, set={"loading.cycles": value})
        assert "loading.cycles" in str(caught.value)


def test_an_unknown_key_names_the_one_that_was_meant():
    with pytest.raises(fretwear.SceneError, match="did you mean") as caught:
        fretwear.run(BALL.read_text().replace("modulus", "modulos", 1))
    assert caught.value.key is not None and caught.value.key.endswith("modulos")


def test_a_refusal_of_the_physics_is_shown_at_its_line():
    with pytest.raises(fretwear.SceneError) as caught:
        fretwear.run(BALL, set={"loading.amplitude": 0.0})
    assert caught.value.key == "loading.amplitude"


def test_missing_foreign_and_damaged_files_are_os_errors(tmp_path):
    with pytest.raises(FileNotFoundError, match="none.toml"):
        fretwear.run(tmp_path / "none.toml")
    with pytest.raises(FileNotFoundError, match="none.h5"):
        fretwear.open(tmp_path / "none.h5")
    with pytest.raises(OSError, match="paraboloid.toml"):
        fretwear.open(BALL)
    fretwear.run(BALL).save(tmp_path / "run.h5")
    content = bytearray((tmp_path / "run.h5").read_bytes())
    content[1000] ^= 1
    (tmp_path / "run.h5").write_bytes(content)
    with pytest.raises(OSError, match="damaged"):
        fretwear.open(tmp_path / "run.h5")


def test_a_study_that_cannot_be_used_runs_nothing(tmp_path):
    with pytest.raises(fretwear.SceneError, match="friction"):
        fretwear.sweep({"scene": str(BALL), "axes": [{"key": "friction.coulomb.coefficient", "values": [-1, 0.5]}]}, output=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_run_of_many_that_fails_is_raised_or_given_back():
    # Nothing slips, so there is nothing to run.
    bad = fretwear.Scene(BALL, set={"loading.amplitude": 1e-300})
    with pytest.raises((fretwear.SceneError, fretwear.RunError)):
        fretwear.run_many([BALL, bad])
    good, failed = fretwear.run_many([BALL, bad], return_errors=True)
    assert isinstance(good, fretwear.Run) and isinstance(failed, (fretwear.SceneError, fretwear.RunError))


def test_warnings_are_warnings():
    with pytest.warns(UserWarning, match="limit"):
        fretwear.run(DATA / "scenes" / "orbit.toml", set={"numerics.springs": 24})
