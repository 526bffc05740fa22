"""Fretting wear of elastically graded media, from the first cycle to the limiting shape.

    import fretwear
    run = fretwear.run("ball.toml", set={"loading.amplitude": "0.3 um"})
    print(run.cycles, run.wear_volume)                    # NumPy arrays; m³

A scene is the path of a TOML file, TOML text, a dictionary, or a :class:`Scene`. Numbers are in SI units; texts may carry theirs, such as "10 mm".
"""

from ._api import calibrate, check, limit, open, run, run_many, sweep
from ._errors import RunError, SceneError
from ._native import __version__
from ._results import Calibration, Results, Run
from ._scene import Scene

__all__ = [
    "Calibration",
    "Results",
    "Run",
    "RunError",
    "Scene",
    "SceneError",
    "__version__",
    "calibrate",
    "check",
    "limit",
    "open",
    "run",
    "run_many",
    "sweep",
]
