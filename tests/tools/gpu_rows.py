#!/usr/bin/env python3
"""tests/tools/gpu_rows.py OUT: the rows of all experiments that a GPU renders (profile quick), at 16 x 12 pixels, timed alone.

    tests/tools/gpu_rows.py build/rows
    AIRLIGHT_DUMP_SHADERS=build/shaders build/release/airlight experiment run --root build/rows
    scripts/check_shaders build/shaders

What comes of them is no result: every shader variant that the experiments use is compiled and written to build/shaders."""
import pathlib
import shutil
import sys
import tomllib

EXPERIMENTS = pathlib.Path(__file__).resolve().parent.parent.parent / "experiments"
SMALL = {"film.width": 16, "film.height": 12}


def toml(value):
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, list):
        return "[" + ", ".join(toml(v) for v in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f'"{k}" = {toml(v)}' for k, v in value.items()) + " }"
    return repr(value)


def table(head, values):
    return f"[{head}]\n" + "".join(f"{k} = {toml(v)}\n" for k, v in values.items()) + "\n"


def rows(experiment):
    methods = [m for m in experiment.get("method", []) if m.get("renderer", "").endswith("_gpu")]
    if not methods:
        return None
    text = 'title = "rows of a GPU"\nabout = "shader variants"\n\n'
    overrides = experiment.get("profile", {}).get("quick", {}).get("overrides", {})
    scenes = [s for s in experiment["scene"] if "quick" in s.get("profiles", ["quick"])]
    named = {s.get("name", pathlib.Path(s["file"]).stem) for s in scenes}
    for scene in scenes:
        file = str(EXPERIMENTS / scene["file"])
        sizes = {**overrides, **scene.get("overrides", {}), **SMALL}
        sizes = {k: v for k, v in sizes.items() if k not in scene.get("sweep", {})}
        text += table("[scene]", {**scene, "file": file, "overrides": sizes})
    text += table("profile.quick", {"budget": 0.0})
    for method in methods:
        kept = {k: v for k, v in method.items() if k != "layer"}
        if "scenes" in kept:
            kept["scenes"] = [s for s in kept["scenes"] if s in named]
        text += table("[method]", kept)
    return text


def main():
    out = pathlib.Path(sys.argv[1]) / "experiments"
    out.mkdir(parents=True, exist_ok=True)
    shutil.copy(EXPERIMENTS / "README.md", out)
    for path in sorted(EXPERIMENTS.glob("*/*.toml")):
        if path.parent.name in ("scenes", "data"):
            continue
        if text := rows(tomllib.loads(path.read_text())):
            (out / path.parent.name).mkdir(exist_ok=True)
            (out / path.parent.name / path.name).write_text(text)


if __name__ == "__main__":
    main()
