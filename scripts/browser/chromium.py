"""A headless Chromium that a script drives through a pair of pipes, and a server of `airlight serve` for it."""
import base64
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
# Both panes show what was asked for last, as whole pictures.
AT_REST = ("window.airlight && ['left', 'right'].every(s => { const w = airlight.work[s]; return !w.busy && !w.again && w.still && "
           "(w.failed || w.head && (w.head.refused || airlight.stage.pictures[s].width === airlight.state.film)); })")


class Browser:
    """A page of a browser that is driven through a pair of pipes: JSON with a zero byte behind each message."""

    def __init__(self, width=1280, height=900):
        self.folder = folder = tempfile.mkdtemp()
        to_browser, self.to_browser = os.pipe()
        self.from_browser, from_browser = os.pipe()

        def before():  # the browser reads from 3 and writes to 4
            os.dup2(to_browser, 100)
            os.dup2(from_browser, 101)
            os.dup2(100, 3)
            os.dup2(101, 4)

        self.process = subprocess.Popen(  # in a group of its own, which kill() ends
            [BROWSER, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--disable-background-networking", "--remote-debugging-pipe", f"--user-data-dir={folder}/profile", "about:blank"],
            preexec_fn=before, close_fds=False, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer, self.number, self.session = b"", 0, None
        self.complaints, self.requests = [], []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.size(width, height)

    def message(self):
        while b"\0" not in self.buffer:
            piece = os.read(self.from_browser, 1 << 20)
            assert piece, "the browser ended"
            self.buffer += piece
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, **parameters):
        self.number += 1
        asked = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            asked["sessionId"] = self.session
        os.write(self.to_browser, json.dumps(asked).encode() + b"\0")
        while True:
            answer = self.message()
            if answer.get("id") == self.number:
                assert "error" not in answer, (method, answer)
                return answer["result"]
            self.note(answer)

    def note(self, event):
        method, about = event.get("method", ""), event.get("params", {})
        if method == "Network.requestWillBeSent":
            self.requests.append(about["request"]["url"])
        elif method == "Runtime.exceptionThrown":
            self.complaints.append(json.dumps(about)[:600])
        elif method == "Runtime.consoleAPICalled" and about["type"] in ("error", "warning", "assert"):
            self.complaints.append(json.dumps(about["args"])[:600])
        elif method == "Log.entryAdded" and about["entry"]["level"] in ("error", "warning") and \
                "getImageData" not in about["entry"]["text"]:  # which these tests call, not the page
            self.complaints.append(json.dumps(about["entry"])[:600])

    def run(self, script):
        result = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    def wait(self, condition, seconds=120):
        end = time.time() + seconds
        while not self.run(f"Boolean({condition})"):
            assert time.time() < end, f"{condition}; {self.run('document.body.innerText')[:800]}; {self.complaints}"
            time.sleep(0.05)

    def size(self, width, height, touch=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=touch)

    def mouse(self, kind, x, y, button="left", **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, clickCount=1, **more)

    def drag(self, start, end, steps=6, button="left"):
        self.mouse("mouseMoved", *start, button="none")
        self.mouse("mousePressed", *start, button=button)
        for i in range(1, steps + 1):
            self.mouse("mouseMoved", *[a + (b - a) * i / steps for a, b in zip(start, end)], button=button)
            time.sleep(0.03)
        self.mouse("mouseReleased", *end, button=button)

    def key(self, key, text=""):
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, text=text)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def choose(self, element, value):
        """Gives a menu, slider or field a value, as a person does. `element`: a selector."""
        self.run(f"(() => {{ const e = document.querySelector({json.dumps(element)}); e.value = {json.dumps(value)}; "
                 "e.dispatchEvent(new Event('input')); })()")

    def click(self, element):
        self.run(f"document.querySelector({json.dumps(element)}).click()")

    def rest(self):
        time.sleep(0.3)  # longer than the page waits until it takes something for resting
        self.wait(AT_REST)

    def on_canvas(self, u, v):
        """The place on the page of a point of the canvas, in parts of its width and height."""
        return self.run("(() => { const b = document.getElementById('canvas').getBoundingClientRect(); "
                        f"return [b.x + {u} * b.width, b.y + {v} * b.height]; }})()")

    def light_handle(self, number=0):
        """The place on the page of the circle that moves a light."""
        return self.run(
            "import('./camera.js').then(c => { const s = airlight.stage, "
            f"p = c.project(s.camera, s.aspect, s.handles[{number}].position); "
            "const r = s.panels()[0].rect, b = s.canvas.getBoundingClientRect(); "
            "return [b.x + (r.x + p.u * r.width) * b.width / s.canvas.width, "
            "b.y + (r.y + p.v * r.height) * b.height / s.canvas.height]; })")

    def picture_of_page(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.captureScreenshot")["data"]))

    def close(self):
        self.process.terminate()
        self.end()

    def kill(self):
        """As a browser that crashes: nothing is said to the server."""
        os.killpg(self.process.pid, signal.SIGKILL)
        self.end()

    def end(self):
        self.process.wait(20)
        shutil.rmtree(self.folder, ignore_errors=True)
        os.close(self.to_browser)
        os.close(self.from_browser)


class Server:
    """`airlight serve` with these words, on a port of its own, until close()."""

    def __init__(self, program, words):
        self.process = subprocess.Popen([program, "serve", *words, "--port", "0"], cwd=SOURCE, stdout=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith("http://"), "the server did not start"

    def close(self):
        self.process.send_signal(signal.SIGINT)
        code = self.process.wait(20)
        assert code == 0, code
