#!/usr/bin/env python3
"""The report page over all committed results: small, headline first, every experiment in it, nothing from outside."""
import base64
import csv
import glob
import html.parser
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
VOID = {"meta", "link", "img", "input", "br"}


class Page(html.parser.HTMLParser):
    """Elements in their order, the packed contents of rows, and the text of summaries."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.packed, self.open = [], {}, []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(self.elements[-1])

    def handle_endtag(self, tag):
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data):
        if self.open and self.open[-1][1].get("class") == "packed":
            anchor = [a["id"] for tag, a in self.elements if tag == "summary" and "id" in a][-1]
            self.packed[anchor] = data

    def content(self, anchor):
        return json.loads(zlib.decompress(base64.b64decode(self.packed[anchor])))


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            out = f"{folder}/index.html"
            done = subprocess.run([sys.executable, f"{SOURCE}/scripts/report", "--results", f"{SOURCE}/results", "--out", out,
                                   "--program", f"{folder}/none"], capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            with open(out, encoding="utf-8") as stream:
                cls.text = stream.read()
        cls.page = Page(cls.text)
        cls.records = [os.path.dirname(f) for f in sorted(glob.glob(f"{SOURCE}/results/**/run.json", recursive=True))]

    def test_it_is_small(self):
        self.assertLess(len(self.page.elements), 15 * len(self.records) + 1000)
        self.assertLess(len(self.text), 8e6)

    def test_every_record_has_a_row_with_its_tables_plots_and_gates(self):
        self.assertGreater(len(self.records), 150)
        for folder in self.records:
            name = os.path.relpath(folder, f"{SOURCE}/results")
            with open(f"{folder}/run.json", encoding="utf-8") as stream:
                run = json.load(stream)
            content = self.page.content(name.replace("/", "-"))
            self.assertEqual(len(content["gates"]), len(run["gates"]), name)
            self.assertEqual(len(content["plots"]), sum(os.path.exists(f"{folder}/{p['file']}") for p in run["plots"]), name)
            for (_, rows), table in zip(content["tables"], run["tables"], strict=True):
                self.assertGreater(len(rows), 1, name)
                if not os.path.exists(f"{folder}/{table['file']}"):  # some large ones are committed as table.md alone
                    continue
                with open(f"{folder}/{table['file']}", newline="", encoding="utf-8") as stream:
                    self.assertEqual(len(rows), len(list(csv.reader(stream))), name)
            if run["profile"]:
                self.assertIn(f"profile {run['profile']}", content["sized"], name)

    @unittest.skipUnless(shutil.which("node"), "there is no node")
    def test_tables_and_plots_can_be_saved_as_csv_and_latex(self):
        with open(f"{SOURCE}/scripts/report_page/export.js", encoding="utf-8") as stream:
            script = stream.read() + """
console.log(csvText([["a,b", 'c"d'], ["#1", "2"]]));
console.log(latexTable("A_b", [["x", "y"], ["1 %", "<2>"]]));
console.log(latexPlot("error against steps [1]: fog", "# curve,x,x_low,x_high,y,y_low,y_high,floor\\n" +
  '"a, b",1,1,1,0.5,0.4,0.6,0\\n"a, b",10,10,10,0.25,0.2,0.3,0\\n\\n\\n"a, b",20,20,20,0.125,0.125,0.125,0\\n\\n\\n'));"""
        done = subprocess.run(["node", "-"], input=script, capture_output=True, text=True)
        self.assertEqual(done.stderr, "")
        self.assertEqual(done.stdout, r"""
"a,b","c""d"
"#1",2

% \usepackage{booktabs}
\begin{table}
\centering
\caption{A\_b}
\begin{tabular}{ll}
\toprule
x & y \\
\midrule
1 \% & \textless{}2\textgreater{} \\
\bottomrule
\end{tabular}
\end{table}

% \usepackage{pgfplots} \pgfplotsset{compat=1.18}
\begin{tikzpicture}
\begin{axis}[title={error against steps {[}1{]}: fog}, xlabel={steps {[}1{]}}, ylabel={error},
  xmode=log, ymode=normal, legend pos=outer north east]
\addplot coordinates {(1,0.5) (10,0.25)};
\addlegendentry{a, b}
\addplot[only marks, mark=triangle, mark options={rotate=180}, forget plot] coordinates {(20,0.125)};  % below noise: upper bounds
\end{axis}
\end{tikzpicture}

""".lstrip())

    def test_the_headline_comes_first(self):
        sections = [a["id"] for tag, a in self.page.elements if tag == "section" and "id" in a]
        self.assertEqual(sections, ["headline", "common", "index"])
        articles = [i for i, (tag, _) in enumerate(self.page.elements) if tag == "article"]
        self.assertEqual(len(articles), 5)
        for begin, end in zip(articles, articles[1:] + [articles[-1] + 40]):
            kinds = [a["src"].split(";")[0] for tag, a in self.page.elements[begin:end] if tag == "img"]
            self.assertEqual(kinds, ["data:image/png", "data:image/svg+xml"])
        with open(f"{SOURCE}/README.md", encoding="utf-8") as stream:
            for line in stream:
                if line.startswith("| [") and line.count("|") == 5:
                    self.assertIn(line.split("|")[3].strip(), self.text)

    def test_a_software_renderer_is_no_gpu(self):
        content = self.page.content("shadow_planes-table1_table2")
        cells = [cell for _, rows in content["tables"] for row in rows for cell in row]
        self.assertTrue(any("llvmpipe (CPU)" in cell for cell in cells))
        self.assertFalse(any("GPU" in cell for cell in cells))
        device = self.page.content("gpu-h100-shadow_planes-table1_table2")
        self.assertIn("NVIDIA H100", device["sized"])
        self.assertTrue(any("GPU" in cell for _, rows in device["tables"] for row in rows for cell in row))

    def test_pictures_are_there_and_nothing_comes_from_outside(self):
        for anchor in self.page.packed:
            for image in self.page.content(anchor)["images"]:
                self.assertTrue(os.path.exists(f"{SOURCE}/results/gallery/{os.path.basename(image)}"), image)
        for tag, attributes in self.page.elements:
            for name in ("src", "href"):
                self.assertRegex(attributes.get(name, "#"), r"^(#|data:)", tag)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
