"""Rows of the tables on which all methods meet, read for the two pages that show them: scripts/common and scripts/report."""
import csv
import json
import os

BUDGETS = [(0.004, "4 ms"), (0.016, "16 ms"), (0.1, "100 ms"), (1.0, "1 s")]
MOVES = {"camera_seconds": "the camera moves", "lights_seconds": "lights move", "media_seconds": "the medium moves",
         "nothing": "everything is new"}
METRICS = {"rel_l2": "relative L2", "rmse": "RMS", "bias": "bias", "p99": "99th percentile", "flip": "FLIP"}
DIGITS = 2
USELESS = 0.9  # relative L2 of what is no picture of the scene: a black one has 1
CONVERTED = ", converted"


class Fault(Exception):
    pass


def method_of(name):
    """The method that a row's name means: what follows a colon is a setting, and a converted medium is another input."""
    return name.removesuffix(CONVERTED).partition(": ")[0]


class Measure:
    """A figure with its 95 % interval. The noise of the reference is taken out of it, and is what the interval is made of."""

    def __init__(self, line, name):
        self.value, self.low, self.high = (float(line[name + suffix]) for suffix in ("", "_low", "_high"))

    def hidden(self):
        """Does the noise of the reference hide it? Then the interval reaches 0."""
        return self.low <= 0 <= self.high and self.low < self.high

    def most(self):
        return max(abs(self.low), abs(self.high))


class Row:
    """A line of a table: figures and times of a method at one setting in one scene, or why there are none."""

    def __init__(self, line):
        number = lambda name: float(line[name]) if line.get(name) else None
        self.scene, self.note, self.row = line["scene"], line["note"], line["method"]
        self.label = " ".join(word for word in (line["method"], line["setting"]) if word)  # as the pictures are called
        self.converted = line["method"].endswith(CONVERTED)
        self.method = method_of(line["method"])
        variant = line["method"].removesuffix(CONVERTED).partition(": ")[2]
        self.setting = " ".join(word for word in (variant, line["setting"]) if word)
        self.settings = line["settings"]
        self.left_out = line.get("left_out", "")
        self.anew = []  # what may move so that the next frame prepares everything again
        self.measures = {name: Measure(line, name) for name in METRICS if line.get(name)}
        self.error = self.measures.get("rel_l2")
        self.times = {key: number(key) for key in MOVES if key != "nothing"}
        seconds, prepared, converted = number("seconds"), number("prepare_seconds"), number("counter.conversion_seconds")
        self.times["nothing"] = seconds and seconds + prepared + (converted or 0)

    def key(self):
        return self.scene, self.row, self.setting, self.settings

    def least(self):
        """The error; where noise hides it, the upper end of its interval: more is not known."""
        return self.error.most() if self.error.hidden() else self.error.value

    def beats(self, other, moves):
        """It is faster and closer."""
        return self.times[moves] < other.times[moves] and self.least() <= other.least()


def path_of(results, name, file):
    return os.path.join(results, "common", name, file)


def read_rows(results, name):
    path = path_of(results, name, "table.csv")
    if not os.path.exists(path):
        raise Fault(f"{path} is not there: airlight experiment run common")
    with open(path, newline="", encoding="utf-8") as file:
        return [Row(line) for line in csv.DictReader(file)]


def read(results, name):
    """The rows, and the record of the run that made them."""
    rows = read_rows(results, name)
    with open(path_of(results, name, "run.json"), encoding="utf-8") as file:
        run = json.load(file)
    for row, record in zip(rows, run["rows"], strict=True):
        row.anew = [f"{what}_seconds" for what, after in record.get("moved", {}).items() if after["anew"]]
    return rows, run


def device_of(run):
    """What computed it, by its name: a software renderer is a processor."""
    device = next((row["device"] for row in run["rows"] if row["device"]), "")
    if "llvmpipe" in device:
        return "llvmpipe, a software renderer on the CPU"
    return device.split(" (")[0]


def unique(values):
    return list(dict.fromkeys(values))


def percent(value):
    value *= 100
    return f"{value:.0f} %" if abs(value) >= 10 else f"{value:.{DIGITS}g} %"


def text(measure):
    """The figure, or what it is below."""
    return f"< {percent(measure.most())}" if measure.hidden() else percent(measure.value)


def milliseconds(seconds):
    value = 1e3 * seconds
    return f"{value:,.0f} ms" if value >= 100 else f"{value:.{DIGITS}g} ms"


def front(rows, moves):
    """Rows that no other row of the scene beats. Who draws next to nothing is not among them: its error is 1."""
    timed = [r for r in rows if r.times[moves] is not None and r.error is not None and r.error.value < USELESS]
    return [r for r in timed if not any(o.beats(r, moves) for o in timed)]


def fragment(results):
    """The tables for a browser: what common.js shows, as JSON in a section of a page. Empty where the experiment has not run."""
    sets, timed = [], {}
    for name, words in (("all_orders", "all orders of scattering"), ("one_order", "light scattered once"),
                        ("device.paper", "all orders, on the device"), ("all_orders.paper", "all orders, profile paper"),
                        ("one_order.paper", "once, profile paper")):
        try:
            rows, run = read(results, name)
        except Fault:
            continue
        if not device_of(run):
            for row in rows:  # those of one order are timed as renders alone; the frames are the same
                row.times.update({moves: t for moves, t in timed.get(row.key(), {}).items() if row.times[moves] is None})
                timed[row.key()] = row.times
        scenes, methods = unique(r.scene for r in rows), unique(r.method for r in rows)
        film = next(row["film"] for row in run["rows"])
        sets.append({
            "name": name, "words": words, "film": f"{film[0]} x {film[1]}", "scenes": scenes, "methods": methods,
            "machine": device_of(run) or f'{run["machine"]["cpu"]}, {run["machine"]["threads"]} threads',
            "commit": f'measured at commit {run["commit"]}',
            "rows": [{"s": scenes.index(r.scene), "m": methods.index(r.method), "set": r.setting, "label": r.label,
                      "all": r.settings, "c": r.converted,
                      "v": {k: [m.value, m.low, m.high] for k, m in r.measures.items()},
                      "t": {k: t for k, t in r.times.items() if t is not None}, "anew": r.anew, "lacks": r.left_out,
                      "note": r.note} for r in rows]})
    if not sets:
        return ""
    data = json.dumps({"sets": sets, "metrics": METRICS, "moves": MOVES, "budgets": BUDGETS, "useless": USELESS}).replace("</", "<\\/")
    return f'<section id=common><script type="application/json" class=common-rows>{data}</script></section>'
