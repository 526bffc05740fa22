"""What one does with scenes."""

from __future__ import annotations

import json
import os
import tempfile
import warnings
from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager, nullcontext
from typing import Any, Literal, overload

from . import _native
from ._errors import RunError, SceneError
from ._results import Calibration, Results, Run, opened
from ._scene import Scene, Source, Table


def _scene(scene: Source, set: Table | None) -> Scene:
    made = scene if isinstance(scene, Scene) and set is None else Scene(scene, set=set)
    for warning in made.warnings:
        warnings.warn(warning, stacklevel=3)
    return made


def run(scene: Source, set: Table | None = None, progress: bool = False) -> Run:
    """Simulates a scene from its first cycle to its end, in memory.

    Args:
        scene: a path, TOML text, a dictionary, or a :class:`Scene`.
        set: values of dotted keys, such as ``{"loading.amplitude": "2 um"}``; what excludes such a key is left out.
        progress: whether a bar of tqdm shows how far it is.

    Ctrl-C stops it at the next step; what there is by then is given back, with ``stop_reason`` "interrupted". Other threads of Python go on.

    Raises:
        SceneError: the scene cannot be used; ``key`` and ``message`` say why.
        RunError: the run cannot go on from some moment.
    """
    (made,) = _run([_scene(scene, set)], None, progress)
    assert isinstance(made, Run)
    return made


@overload
def run_many(
    scenes: Iterable[Source], threads: int | None = None, progress: bool = False, return_errors: Literal[False] = False
) -> list[Run]: ...
@overload
def run_many(
    scenes: Iterable[Source], threads: int | None = None, progress: bool = False, *, return_errors: Literal[True]
) -> list[Run | SceneError | RunError]: ...
def run_many(
    scenes: Iterable[Source], threads: int | None = None, progress: bool = False, return_errors: bool = False
) -> Sequence[Run | SceneError | RunError]:
    """Simulates scenes, several at a time; the runs in the order of the scenes.

    Args:
        scenes: as for :func:`run`; all are checked before the first is run.
        threads: each of which runs one scene at a time; at most, and by default, one for each core.
        progress: whether a bar of tqdm shows how many are done.
        return_errors: whether a run that fails leaves its exception in its place, instead of raising the first one when all are done.

    Ctrl-C stops them; the runs that were begun are given back, the last of them interrupted, so that the list is shorter.
    """
    return _run([_scene(scene, None) for scene in scenes], threads, progress, return_errors)


def _run(scenes: list[Scene], threads: int | None, progress: bool, return_errors: bool = False) -> list[Any]:
    with _bar(progress) as shown:
        ended, stopped = _native.run([scene._native for scene in scenes], threads, shown)
    if stopped and not ended and scenes:
        raise KeyboardInterrupt
    if stopped:
        warnings.warn(f"stopped by Ctrl-C; {len(ended)} of {len(scenes)} scenes were begun", RuntimeWarning, stacklevel=3)
    failed = [end for end in ended if isinstance(end, Exception)]
    if failed and not return_errors:
        raise failed[0]
    for end in ended:
        for word in [] if isinstance(end, Exception) else end.warnings():
            warnings.warn(word, RuntimeWarning, stacklevel=3)
    return [end if isinstance(end, Exception) else Run(end) for end in ended]


def limit(scene: Source, set: Table | None = None, at: Sequence[float] | None = None) -> dict[str, Any]:
    """The closed form of a scene, without stepping in time: a dictionary with the keys of ``fretwear limit --json``, SI units.

    Args:
        scene, set: as for :func:`run`.
        at: radii at which the profile is wanted, m; by default some 200 from 0 to beyond the contact.

    Lists of the profile are NumPy arrays. What has no meaning, as under full sliding, is None.

    Raises:
        SceneError: the scene cannot be used.
    """
    import numpy as np

    found: dict[str, Any] = json.loads(_native.limit(_scene(scene, set)._native, None if at is None else [float(r) for r in at]))
    profile = found["profile"]
    found["profile"] = {name: None if values is None else np.array(values) for name, values in profile.items()}
    return found


def check(scene: Source, set: Table | None = None) -> dict[str, Any]:
    """What follows from a scene, without running it: a dictionary with the keys of ``fretwear check --json``, SI units.

    Raises:
        SceneError: the scene cannot be run.
    """
    made = scene if isinstance(scene, Scene) and set is None else Scene(scene, set=set)
    found: dict[str, Any] = json.loads(_native.check(made._native))
    return found


def sweep(
    study: str | os.PathLike[str] | Table,
    output: str | os.PathLike[str] | None = None,
    threads: int | None = None,
    checkpoint_interval: float = 30.0,
    progress: bool = False,
) -> Results:
    """Runs the scenes of a study; the table of their inputs and results.

    Args:
        study: a path, TOML text, or a dictionary, whose ``scene`` is a path or a dictionary as well.
        output: the directory of the results. What is there already is not run again. By default everything stays in memory.
        threads: each of which runs one scene at a time; at most, and by default, one for each core.
        checkpoint_interval: seconds between checkpoints.
        progress: whether a bar of tqdm shows how many are done.

    Scenes that fail are rows whose ``status`` says so.

    Raises:
        SceneError: the study, or one of its scenes, cannot be used.
        KeyboardInterrupt: it was stopped; rows are kept in ``output``, and the same call goes on.
    """
    place: AbstractContextManager[Any] = tempfile.TemporaryDirectory() if output is None else nullcontext(output)
    with place as folder, _bar(progress) as shown:
        report = json.loads(_native.sweep(study, folder, threads, checkpoint_interval, shown))
        return opened(_native.open(report["output"], output is not None))


def calibrate(
    calibration: str | os.PathLike[str] | Table,
    output: str | os.PathLike[str] | None = None,
    overwrite: bool = False,
    predict: str | os.PathLike[str] | Table | None = None,
    draws: int = 200,
) -> Calibration:
    """Finds keys of a scene from measurements, each with its interval of 95 %.

    Args:
        calibration: a path, TOML text, or a dictionary, whose scene may be a dictionary as well. Files that a text or a dictionary names are
            relative to the working directory.
        output: the directory of the files that ``fretwear calibrate`` writes. By default everything stays in memory.
        overwrite: whether files of an earlier calibration there may be replaced.
        predict: a scene that is foretold, a path, TOML text or a dictionary: ``summary["forecast"]`` then has all its results with the
            intervals that hold 95 % of them.
        draws: with how many draws of the unknowns that scene is run, at most 512.

    Raises:
        SceneError: the calibration, a scene, or a file of measurements cannot be used; the message names the line and the cure.
        RunError: the model predicts the data nowhere between the bounds.
        KeyboardInterrupt: it was stopped; the same call with an output goes on from there.
    """
    place: AbstractContextManager[Any] = tempfile.TemporaryDirectory() if output is None else nullcontext(output)
    with place as folder:
        found = json.loads(_native.calibrate(calibration, folder, overwrite, predict, draws))
        arrays = _native.open(found["files"][0], output is not None)
    if output is None:
        found["files"] = []
    for warning in found["warnings"]:
        warnings.warn(warning, RuntimeWarning, stacklevel=2)
    return Calibration(arrays, found)


def open(path: str | os.PathLike[str]) -> Results:
    """Opens a result file of any kind: a :class:`Run`, or :class:`Results` of a study.

    Raises:
        FileNotFoundError: there is none.
        OSError: it is damaged, or of another program.
    """
    return opened(_native.open(path, True))


class _Bar:
    """A bar of tqdm, filled from another thread's counts."""

    def __init__(self) -> None:
        from tqdm.auto import tqdm

        self.bar = tqdm(total=1.0, bar_format="{l_bar}{bar}| {elapsed}<{remaining}")

    def __enter__(self) -> Callable[[float, float], None]:
        return self.show

    def show(self, done: float, total: float) -> None:
        self.bar.total = total
        self.bar.n = done
        self.bar.refresh()

    def __exit__(self, *_: object) -> None:
        self.bar.close()


def _bar(wanted: bool) -> AbstractContextManager[Callable[[float, float], object] | None]:
    if wanted:
        try:
            return _Bar()
        except ImportError:
            warnings.warn("progress is shown by tqdm, which is not installed", stacklevel=4)
    return nullcontext()
