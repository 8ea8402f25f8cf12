"""Results and films of airlight in numpy and pandas.

load_results() reads the figures of finished experiments, load_film() the layers of a film, and render() makes a film. They run the
program `airlight`. It is the one that program= or the variable AIRLIGHT_PROGRAM names, else the one on PATH."""
import dataclasses
import io
import os
import pathlib
import shutil
import subprocess
import tempfile

import numpy
import pandas

__all__ = ["AirlightError", "Film", "load_film", "load_results", "render"]


class AirlightError(RuntimeError):
    """The program refused its input. The message is the program's own."""


@dataclasses.dataclass
class Film:
    layers: dict  # name: array of height x width x 3, linear RGB, row 0 at the top; "mean" is the whole picture
    header: dict  # "renderer", "settings", "scene", "samples", ...: how the film was made

    @property
    def mean(self):
        return self.layers["mean"]


def _run(program, words, folder=None):
    found = program or os.environ.get("AIRLIGHT_PROGRAM") or shutil.which("airlight")
    if not found:
        raise FileNotFoundError("no program: put `airlight` on PATH, name it with program=, or set AIRLIGHT_PROGRAM")
    done = subprocess.run([os.path.abspath(found), *words], capture_output=True, text=True, cwd=folder)
    if done.returncode != 0:
        raise AirlightError(done.stderr.strip())
    return done.stdout


def load_results(*names, metrics=(), profile=None, root=None, results=None, program=None):
    """A table with a line for each figure, as `airlight results` prints it.

    names    experiments ("group/name") or groups; all where none is given
    metrics  only these figures: "rel_l2", "seconds", "counter.rays", ...
    profile  "quick" or "paper"; both where none is given
    root     folder of the project; results: folder of the records"""
    words = ["results", *names, "--format", "csv"]
    for option, value in (("--profile", profile), ("--root", root), ("--results", results)):
        words += [option, str(value)] if value is not None else []
    for metric in metrics:
        words += ["--metric", metric]
    # A setting is text, also where it looks like a number; a scene may be called "NA".
    text = _run(program, words)
    settings = [name for name in text.split("\n", 1)[0].split(",") if name.startswith("setting")]
    texts = ["experiment", "profile", "commit", "machine", "device", "film", "scene", "method", "renderer", "layer", "metric", "note"]
    return pandas.read_csv(io.StringIO(text), dtype=dict.fromkeys(texts + settings, str), keep_default_na=False,
                           na_values={name: [""] for name in ("parameter", "value", "low", "high", "noise_floor", "below_noise")})


def load_film(path):
    """The film of an OpenEXR file that airlight wrote."""
    try:
        import OpenEXR
        read = OpenEXR.File
    except (ImportError, AttributeError):
        raise ImportError("load_film and render need the Python module OpenEXR 3.3 or newer: pip install OpenEXR") from None
    file = read(str(path))
    layers = {"mean" if name == "RGB" else name: numpy.asarray(channel.pixels) for name, channel in file.channels().items()}
    prefix = "airlight."
    return Film(layers, {name[len(prefix):]: value for name, value in file.header().items() if name.startswith(prefix)})


def render(scene, method, settings=None, overrides=None, program=None):
    """The film of a scene file, rendered with a method. `airlight explain SCENE` lists the methods that can render it.

    settings   settings of the method, {"K": 12}; overrides: values of the scene file, {"film.width": 96}"""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "film.exr"
        words = ["render", str(scene), "--method", method, "--out", str(out)]
        for option, pairs in (("--set", settings), ("--override", overrides)):
            for name, value in (pairs or {}).items():
                words += [option, f"{name}={str(value).lower() if isinstance(value, bool) else value}"]
        _run(program, words)
        return load_film(out)
