#!/usr/bin/env python3
"""serve_test.py [PROGRAM]: the page of `airlight serve` in a headless Chromium: pictures, dragging, settings, refusals, keys, widths,
running simulations."""
import array
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.dont_write_bytecode = True
sys.path.insert(0, f"{SOURCE}/scripts/browser")
from chromium import AT_REST, BROWSER, Browser, Server  # noqa: E402

PROGRAM = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else f"{SOURCE}/build/release/airlight"
SCENES = [f"experiments/scenes/common/{name}.toml" for name in ("lamp_in_patches", "lamp_and_boxes")]
FLOW = ["experiments/scenes/common/plume_sun.toml", "--flow", "experiments/flows/plume.toml", "--set", "n=20"]


def bytes_of_png(path):
    """Of an 8-bit RGB picture without interlacing."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed = 8, b""
    while at < len(data):
        length, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        if kind == b"IHDR":
            width, height = (int.from_bytes(data[at + 8 + i:at + 12 + i], "big") for i in (0, 4))
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, stride, before, result = zlib.decompress(packed), 3 * width, [0] * (3 * width), []
    for y in range(height):
        filtered, row = raw[y * (stride + 1)], list(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = row[i - 3] if i >= 3 else 0, before[i], before[i - 3] if i >= 3 else 0
            paeth = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[filtered]) & 255
        result += row
        before = row
    return result


class Page(unittest.TestCase):
    """A server and a browser for all tests of a class."""
    words = None

    @classmethod
    def setUpClass(cls):
        if cls.words is None:
            raise unittest.SkipTest("no tests of its own")
        cls.folder = tempfile.mkdtemp()
        cls.server = Server(PROGRAM, cls.words)
        cls.address = cls.server.address
        cls.browser = Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.server.close()
        shutil.rmtree(cls.folder, ignore_errors=True)

    def setUp(self):
        self.browser.complaints.clear()
        self.browser.requests.clear()
        self.open()

    def tearDown(self):
        self.assertEqual(self.browser.complaints, [])
        for url in self.browser.requests:
            self.assertTrue(url.startswith((self.address, "data:")), url)

    def open(self, rest=""):
        self.browser.call("Page.navigate", url="about:blank")
        self.browser.call("Page.navigate", url=self.address + rest)
        self.browser.wait(AT_REST)

    def rest(self):
        self.browser.rest()

    def picture(self, side):
        return self.browser.run(f"Array.from(airlight.stage.pictures.{side}.values)")

    def rendered(self, options, words=()):
        """The film that the command line gives, as the values of its rows from the top."""
        exr, pfm = f"{self.folder}/one.exr", f"{self.folder}/one.pfm"
        subprocess.run([PROGRAM, *options, "--out", exr, *words], cwd=SOURCE, check=True, capture_output=True)
        subprocess.run([PROGRAM, "convert", exr, pfm], cwd=SOURCE, check=True, capture_output=True)
        with open(pfm, "rb") as file:
            assert file.readline().strip() == b"PF"
            width, height = map(int, file.readline().split())
            assert float(file.readline()) < 0
            values = array.array("f", file.read())
        rows = [values[3 * width * y:3 * width * (y + 1)] for y in reversed(range(height))]  # a PFM begins at the bottom
        return [value for row in rows for value in row]

    def assert_alike(self, found, expected):
        self.assertEqual(len(found), len(expected))
        scale = max(map(abs, expected))
        self.assertLess(max(abs(a - b) for a, b in zip(found, expected)) / scale, 1e-3)

    def middle(self):
        return self.browser.on_canvas(0.25, 0.7)

    def focus(self):
        self.browser.run("document.getElementById('canvas').focus()")


class Compare(Page):
    words = SCENES

    def test_both_panes_show_what_render_writes(self):
        for side in ("left", "right"):
            method = self.browser.run(f"airlight.state.panes.{side}.method")
            expected = self.rendered(["render", SCENES[0], "--method", method, "--override", "film.width=320", "--override", "film.height=240"])
            self.assert_alike(self.picture(side), expected)
        self.browser.wait("document.querySelector('.report .error').textContent.match(/error (below noise, at most )?[0-9.e+-]+ %/)", 200)

    def test_the_copied_command_gives_the_picture_after_a_drag(self):
        before = self.picture("left")
        x, y = self.middle()
        self.browser.drag((x, y), (x + 80, y - 30))
        self.rest()
        after = self.picture("left")
        self.assertNotEqual(before, after)
        self.browser.run("document.getElementById('copy-left').click()")
        command = self.browser.run("document.getElementById('text-shown').value")
        self.browser.run("document.getElementById('text').close()")
        self.assertIn("camera.position", command)
        words = shlex.split(command)
        self.assertEqual(words[0], "airlight")
        self.assert_alike(after, self.rendered(words[1:words.index("--out")]))

    def test_coarse_frames_while_it_moves(self):
        x, y = self.middle()
        self.browser.mouse("mousePressed", x, y)
        self.browser.mouse("mouseMoved", x + 40, y)
        self.browser.wait("airlight.stage.pictures.left.width === 160", 20)
        self.browser.mouse("mouseReleased", x + 40, y)
        self.rest()
        self.assertEqual(self.browser.run("airlight.stage.pictures.left.width"), 320)
        latency = self.browser.run("airlight.work.left.latency")
        self.assertGreater(latency["render"], 0)

    def test_a_light_is_dragged_by_its_handle(self):
        place = self.browser.light_handle()
        before = self.picture("right")
        self.browser.drag(place, (place[0] + 70, place[1] + 20))
        self.rest()
        self.assertIn("light.0.position", self.browser.run("Object.keys(airlight.state.values)"))
        self.assertNotIn("camera.position", self.browser.run("Object.keys(airlight.state.values)"))
        self.assertNotEqual(before, self.picture("right"))

    def test_a_setting_changes_the_frame_and_can_be_refused(self):
        before = self.picture("left")
        set_field = ("(() => {{ const row = document.querySelector('details[data-side=\"left\"] [data-setting=\"{}\"]'); "
                     "const field = row.querySelector('select, input[type=number]'); field.value = '{}'; "
                     "field.dispatchEvent(new Event('input')); return !field.disabled; }})()")
        self.assertTrue(self.browser.run(set_field.format("variant", "paper")))
        self.rest()
        self.assertNotEqual(before, self.picture("left"))
        refused = self.browser.run("[...document.querySelector('details[data-side=\"left\"] select.method').options]"
                                   ".filter(o => o.disabled).map(o => o.textContent)")
        self.assertTrue(any(text.startswith("legendre_fluids: ") and "expected legendre" in text for text in refused), refused)

    def test_a_method_and_itself_differ_by_nothing(self):
        self.browser.run("(() => { const m = document.querySelector('details[data-side=\"right\"] select.method'); "
                         "m.value = airlight.state.panes.left.method; m.dispatchEvent(new Event('input')); })()")
        self.rest()
        self.assertEqual(self.picture("left"), self.picture("right"))
        self.focus()
        self.browser.key("4", "4")
        self.assertEqual(self.browser.run("airlight.state.view.mode"), "difference")
        brightest = ("(() => { const l = airlight.stage.layers.difference.canvas, d = l.getContext('2d').getImageData(0, 0, l.width, l.height).data;"
                     " let m = 0; for (let i = 0; i < d.length; ++i) if (i % 4 < 3) m = Math.max(m, d[i]); return m; })()")
        self.assertEqual(self.browser.run(brightest), 0)
        self.browser.run("(() => { const m = document.querySelector('details[data-side=\"right\"] select.method'); "
                         "m.value = 'ray_marcher'; m.dispatchEvent(new Event('input')); })()")
        self.rest()
        self.assertGreater(self.browser.run(brightest), 0)

    def test_keys(self):
        self.focus()
        camera = self.browser.run("airlight.stage.camera.position")
        self.browser.key("ArrowLeft")
        turned = self.browser.run("airlight.stage.camera.position")
        self.assertNotEqual(camera, turned)
        self.browser.key("w", "w")
        self.assertNotEqual(turned, self.browser.run("airlight.stage.camera.position"))
        self.browser.key("r", "r")
        self.assertEqual(camera, self.browser.run("airlight.stage.camera.position"))
        exposure = self.browser.run("airlight.state.view.exposure")
        self.browser.key("+", "+")
        self.assertEqual(self.browser.run("airlight.state.view.exposure"), exposure + 0.25)
        self.browser.key("2", "2")
        self.assertEqual(self.browser.run("airlight.state.view.mode"), "side by side")
        self.rest()
        self.browser.key(" ", " ")
        self.browser.key(" ", " ")
        self.assertEqual(self.browser.run("[airlight.state.view.mode, airlight.state.view.showA]"), ["flip", False])
        self.browser.key("h", "h")
        self.assertTrue(self.browser.run("document.getElementById('text').open"))
        self.assertEqual(self.browser.run("[...document.querySelectorAll('input, select, textarea')].filter(e => "
                                          "!e.labels.length && !e.getAttribute('aria-label')).length"), 0)

    def test_a_link_shows_the_same_and_scenes_change(self):
        self.browser.run("(() => { const m = document.getElementById('scene'); m.value = 1; m.dispatchEvent(new Event('input')); })()")
        self.rest()
        self.focus()
        self.browser.key("ArrowUp")
        self.rest()
        left, link = self.picture("left"), self.browser.run("location.hash")
        self.open(link)
        self.assertEqual(left, self.picture("left"))
        self.assertEqual(self.browser.run("airlight.state.scene"), 1)

    def test_texts_read_back(self):
        self.focus()
        self.browser.key("ArrowUp")
        self.rest()
        self.browser.run("document.getElementById('copy-scene').click()")
        self.browser.wait("document.getElementById('text').open")
        scene = self.browser.run("document.getElementById('text-shown').value")
        root = f"{self.folder}/project"
        shutil.copytree(f"{SOURCE}/experiments/scenes", f"{root}/experiments/scenes", dirs_exist_ok=True)
        copy = f"{root}/{os.path.dirname(SCENES[0])}/copy.toml"
        with open(copy, "w", encoding="utf-8") as file:
            file.write(scene)
        method = self.browser.run("airlight.state.panes.left.method")
        film = ["--override", "film.width=320", "--override", "film.height=240"]
        self.assert_alike(self.picture("left"), self.rendered(["render", copy, "--method", method, *film]))
        self.browser.run("document.getElementById('text').close(); document.getElementById('copy-experiment').click()")
        experiment = self.browser.run("document.getElementById('text-shown').value")
        os.makedirs(f"{root}/experiments/mine", exist_ok=True)
        for name, text in (("README.md", ""), ("mine/one.toml", experiment.replace("samples = 256", "samples = 64"))):
            with open(f"{root}/experiments/{name}", "w", encoding="utf-8") as file:
                file.write(text)
        done = subprocess.run([PROGRAM, "experiment", "run", "mine/one", "--root", root], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_tones_are_those_of_png(self):
        method = self.browser.run("airlight.state.panes.left.method")
        film = ["--override", "film.width=320", "--override", "film.height=240", "--exposure", "1.5"]
        self.browser.run("(() => { const e = document.getElementById('exposure'); e.value = 1.5; e.dispatchEvent(new Event('input')); })()")
        for tone in ("clamp", "aces", "agx"):
            png = f"{self.folder}/{tone}.png"
            self.rendered(["render", SCENES[0], "--method", method, "--png", png, "--tone", tone, *film])
            shown = self.browser.run(
                f"(() => {{ const t = document.getElementById('tone'); t.value = '{tone}'; t.dispatchEvent(new Event('input')); "
                "const l = airlight.stage.painted('left'), d = l.getContext('2d').getImageData(0, 0, l.width, l.height).data; "
                "return Array.from(d).filter((x, i) => i % 4 < 3); })()")
            expected = bytes_of_png(png)
            self.assertEqual(len(shown), len(expected))
            self.assertLessEqual(max(abs(a - b) for a, b in zip(shown, expected)), 1, tone)

    def test_a_narrow_page(self):
        self.browser.size(390, 844, touch=True)
        try:
            self.open()
            self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), 390)
            before = self.browser.run("airlight.stage.camera.position")
            x, y = self.middle()
            self.browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
            touch = lambda kind, *points: self.browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": a, "y": b} for a, b in points])
            touch("touchStart", (x, y))
            touch("touchMove", (x + 30, y + 10))
            touch("touchEnd")
            turned = self.browser.run("airlight.stage.camera.position")
            self.assertNotEqual(before, turned)
            touch("touchStart", (x, y), (x + 60, y))
            touch("touchMove", (x, y), (x + 90, y))
            touch("touchEnd")
            self.assertNotEqual(turned, self.browser.run("airlight.stage.camera.position"))
            self.rest()
        finally:
            self.browser.call("Emulation.setTouchEmulationEnabled", enabled=False)
            self.browser.size(1280, 900)


class Simulate(Page):
    words = FLOW

    def setUp(self):
        self.browser.complaints.clear()
        self.browser.requests.clear()
        self.browser.call("Page.navigate", url="about:blank")
        self.browser.call("Page.navigate", url=self.address)
        self.browser.wait("window.airlight && airlight.flow.now && airlight.stage.pictures.left")
        self.browser.run("airlight.flow.now.playing || document.getElementById('flow-play').click()")
        self.browser.wait("airlight.flow.now.playing")

    def pause(self):
        self.browser.click("#flow-play")
        self.browser.wait("!airlight.flow.now.playing")
        self.rest()

    def test_play_moves_time_and_pause_stops_it(self):
        time_now = "airlight.flow.now.time"
        before = self.browser.run(time_now)
        self.browser.wait(f"{time_now} > {before} + 0.2")
        self.pause()
        stopped, picture = self.browser.run(time_now), self.picture("left")
        time.sleep(0.7)
        self.assertEqual(self.browser.run(time_now), stopped)
        self.assertEqual(self.picture("left"), picture)
        self.assertEqual(self.browser.run("airlight.work.left.head.smoke_time"), stopped)
        self.browser.run("[...document.querySelectorAll('#flow button')].find(b => b.textContent === 'step').click()")
        self.browser.wait(f"{time_now} > {stopped}")
        self.rest()
        self.assertNotEqual(self.picture("left"), picture)

    def test_a_stroke_changes_the_smoke_and_can_be_taken_away(self):
        self.browser.wait("airlight.flow.now.time > 0.5")
        self.pause()
        before, camera = self.picture("left"), self.browser.run("airlight.stage.camera.position")
        self.focus()
        self.browser.key("t", "t")
        self.browser.drag(self.browser.on_canvas(0.2, 0.55), self.browser.on_canvas(0.4, 0.3))
        self.assertEqual(self.browser.run("airlight.stage.camera.position"), camera)
        self.assertEqual(self.picture("left"), before)
        self.browser.key("p", "p")
        self.browser.wait("airlight.flow.now.strokes > 0")
        self.browser.wait("airlight.flow.now.time > 1")
        self.pause()
        self.assertNotEqual(self.picture("left"), before)
        self.browser.run("[...document.querySelectorAll('#flow button')].find(b => b.textContent === 'copy as script').click()")
        self.browser.wait("document.getElementById('text').open")
        script = self.browser.run("document.getElementById('text-shown').value")
        self.browser.run("document.getElementById('text').close()")
        self.assertEqual(script.count("[[force]]"), self.browser.run("airlight.flow.now.strokes"))
        self.assertIn("airlight simulate stirred.toml --method stable_fluids --set n=20", script)
        self.browser.run("[...document.querySelectorAll('#flow button')].find(b => b.textContent === 'reset').click()")
        self.browser.wait("airlight.flow.now.strokes === 0 && airlight.flow.now.steps < 5")
        self.browser.key("t", "t")

    def test_a_browser_that_is_killed_stops_the_simulation(self):
        def processor_seconds():
            with open(f"/proc/{self.server.process.pid}/stat", encoding="ascii") as file:
                fields = file.read().rsplit(")", 1)[1].split()
            return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

        other = Browser()
        other.call("Page.navigate", url=self.address)
        other.wait("window.airlight && airlight.flow.now && airlight.stage.pictures.left")
        self.browser.call("Page.navigate", url="about:blank")
        other.choose("#flow-pace", "0")
        before, start = other.run("airlight.flow.now.steps"), processor_seconds()
        time.sleep(1)
        self.assertGreater(other.run("airlight.flow.now.steps"), before)
        self.assertGreater(processor_seconds() - start, 0.1)
        other.kill()
        time.sleep(1)
        start = processor_seconds()
        time.sleep(1)
        self.assertLess(processor_seconds() - start, 0.05)


if __name__ == "__main__":
    if not BROWSER:
        print("test skipped: there is no chromium")
        sys.exit(0)
    unittest.main(verbosity=2)
