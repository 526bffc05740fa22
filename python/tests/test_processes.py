"""Signals, threads, processes, and other packages in the same process."""

import concurrent.futures
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

import fretwear

from test_results import BALL, same

# Some ten thousand million cycles, one by one.
ENDLESS = {"numerics.stepper": "every-cycle", "loading.cycles": 1e9, "numerics.springs": 24}


def amplitudes(count):
    """A study of as many scenes."""
    return {"scene": str(BALL), "axes": [{"key": "loading.amplitude_ratio", "from": 0.1, "to": 0.9, "count": count}]}


def interrupted_after(seconds, work):
    """What comes of work that Ctrl-C interrupts, and how long it went on."""
    sent = []

    def send():
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(seconds, send)
    timer.start()
    try:
        return work(), time.perf_counter() - sent[0]
    finally:
        timer.join()
        # What Python does on a signal that has just come is done here at the latest.
        time.sleep(0.01)


def test_ctrl_c_stops_a_run_within_a_tenth_of_a_second_and_gives_what_is_there(tmp_path):
    with pytest.warns(RuntimeWarning, match="Ctrl-C"):
        run, took = interrupted_after(0.3, lambda: fretwear.run(BALL, set=ENDLESS))
    assert took < 0.1
    assert not run.complete and run.summary["stop_reason"] == "interrupted" and run.summary["cycles"] > 10
    # It can be saved, opened, and gone on with.
    run.save(tmp_path / "run.h5")
    again = fretwear.open(tmp_path / "run.h5")
    assert again.summary["cycles"] == run.summary["cycles"] and not again.complete


def test_ctrl_c_stops_many_runs_and_gives_those_that_were_begun():
    scenes = [BALL] * 3 + [fretwear.Scene(BALL, set=ENDLESS)] * 10
    with pytest.warns(RuntimeWarning, match="of 13 scenes"):
        runs, took = interrupted_after(0.5, lambda: fretwear.run_many(scenes, threads=2))
    assert took < 0.1 and 3 < len(runs) < 13
    assert [run.complete for run in runs[:3]] == [True] * 3 and not runs[-1].complete


def test_ctrl_c_stops_a_sweep_that_then_goes_on(tmp_path):
    study = amplitudes(2000)
    with pytest.raises(KeyboardInterrupt):
        interrupted_after(0.3, lambda: fretwear.sweep(study, output=tmp_path))
    swept = fretwear.sweep(study, output=tmp_path)
    assert len(swept["wear_volume"]) == 2000


def test_ctrl_c_is_never_lost_however_near_the_end_it_comes(tmp_path):
    study = amplitudes(100)
    started = time.perf_counter()
    fretwear.sweep(study, output=tmp_path / "whole")
    took = time.perf_counter() - started
    for number in range(20):
        with pytest.raises(KeyboardInterrupt):
            interrupted_after((0.5 + number / 20) * took, lambda: fretwear.sweep(study, output=tmp_path / str(number)))


def test_other_threads_of_python_go_on_meanwhile():
    count = 0
    done = threading.Event()

    def counting():
        nonlocal count
        while not done.is_set():
            count += 1
            time.sleep(0.001)

    thread = threading.Thread(target=counting)
    thread.start()
    fretwear.run(BALL, set={"numerics.stepper": "every-cycle", "loading.cycles": 5000, "numerics.springs": 24})
    seen = count
    done.set()
    thread.join()
    assert seen > 5


def test_progress_is_shown_and_what_it_raises_stops_the_run():
    pytest.importorskip("tqdm")
    run = fretwear.run(BALL, progress=True)
    assert run.complete
    seen = []
    from fretwear import _native

    def show(done, total):
        seen.append(done / total)
        if done > 0:
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        _native.run([fretwear.Scene(BALL, set=ENDLESS)._native], None, show)
    assert seen and all(0 <= part <= 1 for part in seen)


def wear(tau):
    return fretwear.run(fretwear.Scene(BALL, loading={"tau": tau}))


@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_processes_run_scenes_whichever_way_they_are_made(method):
    here = wear(2.0)
    # The threads of this process are not there in one that was forked off.
    fretwear.run_many([BALL] * 4)
    context = multiprocessing.get_context(method)
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        there = list(pool.map(wear, [2.0, 1.0], timeout=60))
    assert same(there[0].wear_depth, here.wear_depth)


def test_threads_of_python_run_scenes():
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        runs = list(pool.map(wear, [2.0, 1.0, 2.0, 1.0]))
    assert same(runs[0].wear_depth, runs[2].wear_depth)


def test_joblib_and_dask_carry_runs():
    joblib = pytest.importorskip("joblib")
    distributed = pytest.importorskip("distributed")
    here = wear(2.0)
    runs = joblib.Parallel(n_jobs=2)(joblib.delayed(wear)(tau) for tau in (2.0, 1.0))
    assert same(runs[0].wear_depth, here.wear_depth)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        # Modules beside a test are not on the path of the workers.
        futures = client.map(lambda scene: __import__("fretwear").run(scene), [fretwear.Scene(BALL, loading={"tau": tau}) for tau in (2.0, 1.0)])
        runs = client.gather(futures)
    assert same(runs[0].wear_depth, here.wear_depth)


def test_h5py_reads_and_writes_in_the_same_process(tmp_path):
    h5py = pytest.importorskip("h5py")
    run = fretwear.run(BALL)
    for count in range(5):
        path = tmp_path / f"run{count}.h5"
        run.save(path)
        with h5py.File(path) as file, h5py.File(tmp_path / f"copy{count}.h5", "w") as copy:
            copy["wear_depth"] = file["wear_depth"][()] * 2
            assert same(fretwear.open(path).wear_depth, run.wear_depth)


def test_the_command_stops_with_a_checkpoint_on_ctrl_c(tmp_path):
    arguments = [sys.executable, "-m", "fretwear", "run", str(BALL), "-o", str(tmp_path / "run.h5"), "--quiet"]
    settings = [part for key, value in ENDLESS.items() for part in ("--set", f"{key}={value}")]
    process = subprocess.Popen([*arguments, *settings])
    time.sleep(1.5)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=20) == 75
    assert not fretwear.open(tmp_path / "run.h5").complete


def test_the_package_is_imported_without_numpy():
    code = "import sys, fretwear; assert 'numpy' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_types_are_those_that_mypy_asks_for(tmp_path):
    pytest.importorskip("mypy")
    use = tmp_path / "use.py"
    use.write_text(
        "import fretwear\n"
        "run: fretwear.Run = fretwear.run('ball.toml', set={'loading.amplitude': '2 um'})\n"
        "volume: float = float(run.wear_volume[-1])\n"
        "runs: list[fretwear.Run] = fretwear.run_many(['a.toml', {'title': 'b'}])\n"
        "either = fretwear.run_many(['a.toml'], return_errors=True)\n"
        "wrong: int = fretwear.limit('ball.toml')  # type: ignore[assignment]\n"
    )
    for part in (["--package", "fretwear"], [str(use)]):
        done = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", *part],
            capture_output=True,
            text=True,
            cwd=tmp_path,
        )
        assert done.returncode == 0, done.stdout + done.stderr
