"""The headline and the index of the report page: HTML of what the records and the pages of the project say."""
import base64
import collections
import csv
import html
import json
import os
import re
import zlib

import papers

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
COMMITTED = os.path.join(ROOT, "results")
JOINT = " \u00b7 "
VERDICTS = papers.read(ROOT, "README.md", papers.verdicts)
ENTRIES = papers.read(ROOT, "results/README.md", papers.entries)


def read_text(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def unique(values):
    return list(dict.fromkeys(values))


def sized(run):
    """Film sizes; processor and devices."""
    films = unique(f"{row['film'][0]} x {row['film'][1]}" for row in run.get("rows", []) if row.get("film", [0, 0])[0])
    machine = run.get("machine", {})
    devices = unique(row["device"] for row in run.get("rows", []) if row.get("device"))
    # llvmpipe draws on the processor, so a reader must not take it for a GPU.
    names = unique("llvmpipe (CPU)" if d.startswith("llvmpipe") else re.split("[/,(]", d)[0].strip() for d in devices)
    cpu = [f"{machine['cpu']}, {machine['threads']} threads"] if "cpu" in machine else []
    return ", ".join(films) + " pixels" if films else "no film", cpu + names


def data_uri(kind, path):
    with open(path, "rb") as file:
        return f"data:{kind};base64,{base64.b64encode(file.read()).decode()}"


def chip(text, kind=""):
    return f'<span class="chip {kind}">{html.escape(text)}</span>' if text else ""


def row_html(anchor, group, labels, title, name, chips, find, content, flags="", pictures=""):
    """A folded row. Its contents are packed, and page.js unpacks them when the reader opens the row."""
    packed = base64.b64encode(zlib.compress(json.dumps(content, separators=(",", ":")).encode())).decode()
    return (f'<details class="entry {flags}" data-group="{html.escape(group)}" data-find="{html.escape(find.lower())}">'
            f'<summary id="{anchor}"><b>{html.escape("; ".join(labels[:2]) + (" and more" if len(labels) > 2 else ""))}</b>'
            f'<span>{html.escape(title)} <code>{html.escape(name)}</code></span><span class=chips>{"".join(chips)}</span></summary>'
            f'<script type="text/plain" class=packed>{packed}</script>{pictures}</details>')


def content_of(entries, gallery):
    """What results/README.md says, and the committed pictures."""
    texts = [(e.label[:1].upper() + e.label[1:], papers.paragraph(e.text).replace("\n", "<br>")) for e in entries]
    return {"text": [f"<b>{html.escape(label)}.</b> {text}" for label, text in texts],
            "images": [f"{gallery}/{picture}" for picture in unique(p for e in entries for p in e.pictures)]}


def tables_of(folder, run):
    """Title and rows of each table. Some records are committed with table.md alone, which holds the tables in the same order."""
    page, tables = os.path.join(folder, "table.md"), run.get("tables", [])
    blocks = re.findall(r"(?:^\|.*\n)+", read_text(page), re.M) if os.path.exists(page) else []
    for i, table in enumerate(tables):
        path = os.path.join(folder, table["file"])
        if os.path.exists(path):
            with open(path, newline="", encoding="utf-8") as file:
                yield table.get("title", table["file"]), list(csv.reader(file))
        elif len(blocks) == len(tables):
            lines = [line for line in blocks[i].splitlines() if not line.startswith("|---")]
            yield table.get("title", table["file"]), [papers.cells(line) for line in lines]


def data_of(plot):
    """The numbers behind a plot, where they are kept beside it."""
    path = plot.removesuffix(".svg") + ".csv"
    return read_text(path) if os.path.exists(path) else ""


class Record:
    """A run.json: its row of the index."""

    def __init__(self, folder, name, run, pictures):
        self.folder, self.name, self.run, self.pictures = folder, name, run, pictures
        self.experiment = run.get("experiment", name)
        group, _, rest = self.experiment.partition("/")
        self.headline = group == "headline"
        self.group = rest if self.headline else group
        self.entries = [e for e in ENTRIES if name in e.names or self.experiment in {n.removesuffix(".paper") for n in e.names}]

    def key(self):
        place = -1 if self.headline else ENTRIES.index(self.entries[0]) if self.entries else len(ENTRIES)
        return self.group, place, self.name

    def html(self, gallery):
        run, (film, devices) = self.run, sized(self.run)
        # Methods that ran on llvmpipe alone carry its name in place of "GPU".
        software = "llvmpipe (CPU)" in devices and len(devices) <= 2
        say = lambda text: re.sub(r"\bGPU\b", "llvmpipe (CPU)", text) if software else text
        profile = f"profile {run['profile']}" if run.get("profile") else ""
        gates = run.get("gates", [])
        kinds = ["skipped" if g.get("skipped") else "ok" if g.get("passed") else "failed" for g in gates]
        plots = [(plot.get("title", ""), os.path.join(self.folder, plot["file"])) for plot in run.get("plots", [])]
        content = content_of(self.entries, gallery) | {
            "about": run.get("about", ""), "sized": JOINT.join(filter(None, [film, *devices, profile])),
            "tables": [[title, [[say(cell) for cell in row] for row in rows]] for title, rows in tables_of(self.folder, run)],
            "plots": [[title, read_text(path), data_of(path)] for title, path in plots if os.path.exists(path)],
            "gates": [[kind, say(str(gate.get("text") or gate.get("name")))] for kind, gate in zip(kinds, gates)],
            "record": {k: v for k, v in run.items() if k not in ("pictures", "plots", "tables", "gates", "about", "title", "rows")}}
        failed, passed = kinds.count("failed"), kinds.count("ok")
        refused = sum(row.get("note", "").startswith("not supported") for row in run.get("rows", []))
        chips = [chip(verdict) for verdict in unique(e.verdict for e in self.entries)]
        chips += [chip(text) for text in [profile, film, *devices[1:]]]
        chips += [chip(f"{failed} of {len(gates)} gates failed", "bad") if failed else chip(f"{passed} gates passed" if passed else ""),
                  chip(f"{refused} not supported" if refused else "")]
        labels = ["headline"] * self.headline + unique(e.label for e in self.entries if e.label not in e.names)
        find = [self.name, *(run.get(key, "") for key in ("title", "about", "paper")), *(f"{e.label} {e.text}" for e in self.entries)]
        return row_html(self.name.replace("/", "-"), self.group, labels, run.get("title") or self.name, self.name, chips, " ".join(find),
                        content, "failed " * bool(failed) + "refused" * bool(refused), self.pictures)


def headline_html(results):
    """A picture, a plot and the verdict for each paper, from the results or else from the committed ones."""
    parts = []
    for group, words in VERDICTS:
        words = {name: html.escape(text) for name, text in words.items()}
        folders = [os.path.join(base, "headline", group) for base in (results, COMMITTED)]
        folder = next((f for f in folders if os.path.exists(f"{f}/run.json")), None)
        run = json.loads(read_text(f"{folder}/run.json")) if folder else {}
        figure = re.search(r"Figure (\d+)", run.get("paper", ""))
        files = [("image/png", f"{COMMITTED}/gallery/{group}_fig{figure.group(1)}.png", run["paper"])] if figure else []
        files += [("image/svg+xml", os.path.join(folder, plot["file"]), "error against time") for plot in run.get("plots", [])[:1]]
        images = [f'<img src="{data_uri(kind, path)}" alt="{words["Paper"]}: {html.escape(text)}">'
                  for kind, path, text in files if os.path.exists(path)]
        short = [re.sub(r"(holds only where).*", r"\1 noted", e.verdict.split(":")[0]) for e in ENTRIES if e.group == group]
        counts = collections.Counter(short)
        claims = ", ".join(f"{count} {verdict}" for verdict, count in counts.most_common() if verdict)
        film, devices = sized(run)
        (_, paper), (_, subject), *judged = words.items()
        verdict = " ".join(f'<span><b>{name}{"" if name.endswith("?") else ":"}</b> {text}</span>' for name, text in judged)
        parts.append(f'<article><h3>{paper} <small>{subject}</small></h3><p class=verdict>{verdict}</p>'
                     f'<div class=pair>{"".join(images)}</div>'
                     f'<p class=about>{html.escape(f"Claims of the paper: {claims}. " if claims else "")}'
                     f'Plot: {html.escape(JOINT.join([film, *devices]))}. '
                     f'<a href="#index" data-show="{group}">Every figure of this paper</a></p></article>')
    return "".join(parts)


def index_html(runs, gallery):
    """Every figure of the papers and every record, a group for each paper or reference. `runs`: arguments of Record."""
    records = [Record(*run) for run in runs]
    groups = {group: words["Paper"] for group, words in VERDICTS}
    for one in ENTRIES:
        groups.setdefault(one.group, one.chapter)
    for one in records:
        groups.setdefault(one.group, one.group.replace("_", " ").capitalize())
    rows = [(record.key(), record.html(gallery)) for record in records]
    shown = {id(e) for record in records for e in record.entries}
    for i, e in enumerate(ENTRIES):
        if id(e) not in shown:
            title = "no experiment needed" if "none needed" in e.text else papers.words(e.text).split(". ")[0]
            rows.append(((e.group, i, ""), row_html(f"entry-{i}", e.group, [e.label], title, "",
                                                    [chip(e.verdict), chip("no record here" if e.names else "")],
                                                    f"{e.label} {e.text}", content_of([e], gallery))))
    rows.sort()
    sections = "".join(f'<section><h3>{html.escape(title)}</h3>{"".join(row for key, row in rows if key[0] == group)}</section>'
                       for group, title in groups.items())
    choices = "".join(f'<option value="{html.escape(group)}">{html.escape(title)}</option>' for group, title in groups.items())
    return f"""<section id=index><h2>Figure by figure</h2>
<p class=about>Open a row to see what the paper says, what was measured, and tables, plots and gates. A gate is a bound that CI checks.</p>
<form class=filters><input type=search name=find placeholder="Search: a figure, a method, a word" aria-label="search">
<select name=group aria-label="paper"><option value="">all papers</option>{choices}</select>
<label><input type=checkbox name=failed> failed gates</label>
<label><input type=checkbox name=refused> not supported</label> <output></output></form>
{sections}</section>"""
