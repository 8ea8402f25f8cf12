#!/usr/bin/env python3
"""Would a gate object if the error of a method doubled?

doubled_error.py [ROOT] [--profile quick|paper] [--gates] [--in-tests]

Reads the gates of experiments/*/*.toml, the bounds by row beside them and the rows of results/*/*/run.json, and doubles every error that a gate bounds
(four times where it is a square); its interval stays as wide as it was, so an error in the noise of its reference is not
found. Prints for every renderer and variant how many of its rows are gated, how many gates
would object, and the one nearest to objecting. Exit code 1 if some renderer and variant has no gate that would, 2 for
files that cannot be read. What an error is compared with is the experiment's reference: against another method it is the
difference of the two.
"""
import argparse
import csv
import json
import math
import os
import sys
import tomllib

SQUARES = {"rel_l2_squared", "rel_mse"}
# Not errors: a method twice as wrong has other counters, times and objections, in no known proportion.
NO_ERRORS = {"seconds", "prepare_seconds", "objections", "largest_z", "detectable_bias"}
TIMES = ("ms_", "frames_per_second")  # of probes that measure nothing else: their rows have no error to double


def base(metric):
    metric = metric.removeprefix("foreground.")
    return metric[:-2] if metric[-2:] in (".r", ".g", ".b") else metric


def variant(row):
    """What a table calls a method: the renderer, and its setting `variant` where it has one."""
    settings = dict(s.split("=", 1) for s in row["settings"].split() if "=" in s)
    return row["renderer"] + (f" {settings['variant']}" if "variant" in settings else "")


def text_of(value):
    return f"{value:g}" if isinstance(value, float) else str(value).lower() if isinstance(value, bool) else str(value)


def belongs(gate, row):
    if gate.get("by_row"):
        return all(row[key] == gate[key] for key in ("scene", "method", "setting", "device"))
    scene = gate.get("scene", "")
    return ((not scene or row["scene"] == scene or row["scene"].startswith(scene + " "))
            and ("method" not in gate or row["method"] == gate["method"])
            and ("setting" not in gate or row["setting"] == text_of(gate["setting"])))


def gates_of(experiment, bounds):
    """Gates with a bound, and the bounds by row, which hold for profile quick."""
    gates = [g for g in experiment.get("gate", []) if "at_most" in g or "at_least" in g]
    if not os.path.exists(bounds):
        return gates
    with open(bounds, newline="") as f:
        for line in csv.DictReader(f):
            for end in ("at_least", "at_most"):
                if line[end]:
                    gates.append({**{k: line[k] for k in ("scene", "method", "setting", "metric", "device")},
                                  "by_row": True, end: float(line[end])})
    return gates


def doubled(row, gate):
    """(ratio of bound to doubled figure, would it object), or None where the gate bounds no error."""
    name, bound = base(gate["metric"]), gate.get("at_most", gate.get("at_least"))
    if name in NO_ERRORS or gate["metric"].startswith("counter."):
        return None
    upper = "at_most" in gate
    # A lower bound asks for an error to be reproduced, and so does an upper one below 0; a bias may grow either way.
    if (bound < 0) == upper and bound != 0 or (bound == 0 and not upper):
        return None
    for m in row["errors"]:
        if m["metric"] != gate["metric"] or m["value"] is None:
            continue
        value = (4 if name in SQUARES else 2) * m["value"]
        sure = value - (m["value"] - m["low"]) if upper else value + (m["high"] - m["value"])
        grows = value > 0 if upper else value < 0
        return (bound / value if grows else math.inf), (sure > bound if upper else sure < bound)
    return None


def main():
    p = argparse.ArgumentParser()
    p.add_argument("root", nargs="?", default=".")
    p.add_argument("--profile", default="quick", choices=("quick", "paper"))
    p.add_argument("--gates", action="store_true", help="every gate that would object")
    p.add_argument("--in-tests", action="store_true", help="only gates that scripts/test judges")
    a = p.parse_args()
    found = {}
    folder = os.path.join(a.root, "experiments")
    for group in sorted(os.listdir(folder)):
        if group in ("scenes", "data") or not os.path.isdir(os.path.join(folder, group)):
            continue
        for file in sorted(os.listdir(os.path.join(folder, group))):
            if not file.endswith(".toml"):
                continue
            with open(os.path.join(folder, group, file), "rb") as f:
                experiment = tomllib.load(f)
            name = f"{group}/{file[:-5]}"
            record = os.path.join(a.root, "results", name + (".paper" if a.profile == "paper" else ""), "run.json")
            if not os.path.exists(record) or (a.in_tests and not experiment.get("in_tests")):
                continue
            with open(record) as f:
                rows = [r for r in json.load(f)["rows"] if r["runs"]]
            quick = os.path.join(folder, group, file[:-5] + ".bounds.csv")
            gates = gates_of(experiment, quick if a.profile == "quick" else "")
            for row in rows:
                if row["errors"] and all(m["metric"].startswith(TIMES) for m in row["errors"]):
                    continue
                entry = found.setdefault(variant(row), {"rows": 0, "gated": 0, "objects": [], "nearest": None})
                entry["rows"] += 1
                results = [(doubled(row, g), g) for g in gates if belongs(g, row)]
                results = [(r, g) for r, g in results if r]
                entry["gated"] += bool(results)
                for (ratio, objects), gate in results:
                    what = f"{name}: {row['scene']}, {row['method']} {row['setting']}: {gate['metric']}".replace(" :", ":")
                    if objects:
                        entry["objects"].append(what)
                    if entry["nearest"] is None or ratio < entry["nearest"][0]:
                        entry["nearest"] = (ratio, what)
    if not found:
        raise OSError(f"{a.root}: no results of profile {a.profile}")
    print(f"{'renderer, variant':34} {'rows':>5} {'gated':>5} {'objecting':>9}  nearest (bound / doubled error)")
    for name, e in sorted(found.items()):
        nearest = f"{e['nearest'][0]:.3g} {e['nearest'][1]}" if e["nearest"] else "no gate on an error"
        print(f"{name:34} {e['rows']:5} {e['gated']:5} {len(e['objects']):9}  {nearest}")
        if a.gates:
            for what in e["objects"]:
                print(f"    {what}")
    silent = sorted(name for name, e in found.items() if not e["objects"])
    if silent:
        print("no gate would object to a doubled error of: " + ", ".join(silent))
    return 1 if silent else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, ValueError, KeyError) as reason:
        print(f"doubled_error: {reason}", file=sys.stderr)
        sys.exit(2)
