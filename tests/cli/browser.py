"""Chromium without a window, driven through its DevTools pipe: enough to open a page and ask it.

usage: browser.py PAGE.html "#witness=3" PICTURE.png    a screenshot of a page of `selvage verify --html` or `view`
"""
import base64
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time


class Browser:
    """SwiftShader draws, so that no graphics card is needed. `problems` collects what the console complains about."""

    ARGUMENTS = (
        "--headless=new --no-sandbox --remote-debugging-pipe --use-angle=swiftshader --enable-unsafe-swiftshader "
        "--force-prefers-reduced-motion --no-first-run --disable-extensions "
        "--disable-background-networking --hide-scrollbars"
    ).split()

    def __init__(self, program, width=1400, height=1000):
        self.problems, self.size = [], (width, height)
        self.profile = tempfile.mkdtemp()
        commands_out, self.commands = os.pipe()
        self.answers, answers_in = os.pipe()

        def hand_over():  # the browser reads descriptor 3 and writes 4; first away from what is there
            moved = os.dup2(commands_out, 20), os.dup2(answers_in, 21)
            os.dup2(moved[0], 3), os.dup2(moved[1], 4)

        self.process = subprocess.Popen(
            [program, *self.ARGUMENTS, "--user-data-dir=" + self.profile, "about:blank"],
            preexec_fn=hand_over, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env={**os.environ, "HOME": self.profile},
        )
        os.close(commands_out), os.close(answers_in)
        self.buffer, self.number, self.session = b"", 0, None
        target = next(t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(domain + ".enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def close(self):
        self.process.kill()
        self.process.wait()
        os.close(self.commands), os.close(self.answers)
        shutil.rmtree(self.profile, ignore_errors=True)

    def read(self):
        while b"\0" not in self.buffer:
            chunk = os.read(self.answers, 1 << 20)
            if not chunk:
                raise RuntimeError("the browser has ended")
            self.buffer += chunk
        line, self.buffer = self.buffer.split(b"\0", 1)
        message = json.loads(line)
        method, parameters = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.problems.append(details.get("exception", {}).get("description", details["text"]))
        if method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
            self.problems.append(" ".join(str(a.get("value", a.get("description"))) for a in parameters["args"]))
        if method == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
            self.problems.append(parameters["entry"]["text"])
        return message

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.commands, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.read()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def ask(self, expression):
        """The value of a JavaScript expression in the page; a promise is awaited."""
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"]["exception"].get("description"))
        return result["result"].get("value")

    def wait_for(self, condition, seconds=60):
        end = time.monotonic() + seconds
        while not self.ask(condition):
            if self.problems or time.monotonic() > end:
                raise RuntimeError(f"not true: {condition}; {self.problems}")
            time.sleep(0.05)

    def open(self, address, shown):
        """Returns when the 3D view shows what `shown` names (data-shown)."""
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", url=address)
        self.wait_for(f"document.querySelector('.view')?.dataset.shown === {json.dumps(shown)}")
        self.settle()

    def settle(self):
        """Until two animation frames have been drawn."""
        self.ask("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(() => done(1)))))")

    def press(self, key):
        for kind in ("keyDown", "keyUp"):
            text = {"text": key} if len(key) == 1 and kind == "keyDown" else {}
            self.call("Input.dispatchKeyEvent", type=kind, key=key, **text)

    def picture(self, file, clip=None, scale=1):
        """A screenshot as PNG; clip: the CSS selector of an element, or all that the window shows."""
        options = {"clip": {"x": 0, "y": 0, "width": self.size[0], "height": self.size[1], "scale": scale}}
        if clip:
            box = self.ask(f"(() => {{ const b = document.querySelector({json.dumps(clip)}).getBoundingClientRect();"
                           " return {x: b.x + scrollX, y: b.y + scrollY, width: b.width, height: b.height}; })()")
            options = {"clip": {**box, "scale": scale}, "captureBeyondViewport": True}
        with open(file, "wb") as out:
            out.write(base64.b64decode(self.call("Page.captureScreenshot", format="png", **options)["data"]))


if __name__ == "__main__":
    page, place, picture = sys.argv[1:]
    chromium = Browser("chromium", 1360, 980)
    try:
        chromium.open(pathlib.Path(page).resolve().as_uri() + place, place)
        chromium.picture(picture, scale=0.7)
    finally:
        chromium.close()
    sys.exit("\n".join(chromium.problems) or 0)
