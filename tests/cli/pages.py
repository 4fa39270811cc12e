"""The pages of `selvage verify --html`, `view` and `fuzz --plugin` in a browser without a window: what they show, and draw.

usage: pages.py PROGRAM PLUGIN [FOLDER]    PLUGIN misses contacts; FOLDER keeps the pages and screenshots
Exit code 77 (skipped) where there is no Chromium.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib

program, plugin = sys.argv[1:3]
chromium = shutil.which("chromium")
if chromium is None:
    print("skipped: no chromium (packages-browser.txt names the Debian package)")
    sys.exit(77)

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser

PAIR_COLOURS = ((213, 94, 0), (0, 114, 178))  # page/assets/pair.js, light; a vertex is a dot of 177 pixels


def read_png(file):
    """Rows of (red, green, blue): the colour types and filters that Chromium writes."""
    data = pathlib.Path(file).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, pixels = 8, b""
    while at < len(data):
        length, kind = int.from_bytes(data[at : at + 4], "big"), data[at + 4 : at + 8]
        chunk = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height = int.from_bytes(chunk[:4], "big"), int.from_bytes(chunk[4:8], "big")
            size = {2: 3, 6: 4}[chunk[9]]
        if kind == b"IDAT":
            pixels += chunk
        at += 12 + length
    raw, rows, stride = zlib.decompress(pixels), [], width * size
    before = bytearray(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for i in range(stride):
            left, up, corner = (row[i - size] if i >= size else 0), before[i], (before[i - size] if i >= size else 0)
            if kind == 1:
                row[i] = (row[i] + left) & 255
            elif kind == 2:
                row[i] = (row[i] + up) & 255
            elif kind == 3:
                row[i] = (row[i] + (left + up) // 2) & 255
            elif kind == 4:
                guess = left + up - corner
                distances = (abs(guess - left), abs(guess - up), abs(guess - corner))
                row[i] = (row[i] + (left, up, corner)[distances.index(min(distances))]) & 255
        before = row
        rows.append([tuple(row[i : i + 3]) for i in range(0, stride, size)])
    return rows


def count_of(rows, colour):
    """Pixels of this colour, up to rounding."""
    return sum(1 for row in rows for pixel in row if max(abs(a - b) for a, b in zip(pixel, colour)) <= 2)


def write_sheets(folder):
    """A square sheet, and above it a triangle that goes through it between frames 1 and 2 and stays in it in frame 3."""
    side, names = 12, []
    for frame, height in enumerate((1.0, 0.5, -0.5, 0.0)):
        lines = [f"v {x / side - 0.5} {y / side - 0.5} 0" for y in range(side + 1) for x in range(side + 1)]
        lines += [f"v {x} {y} {z + height}" for x, y, z in ((0, 0, 0.02), (0.2, 0.05, -0.05), (0.05, 0.2, 0.05))]
        for y in range(side):
            for x in range(side):
                a = y * (side + 1) + x + 1
                lines += [f"f {a} {a + 1} {a + side + 2}", f"f {a} {a + side + 2} {a + side + 1}"]
        n = (side + 1) ** 2
        lines.append(f"f {n + 1} {n + 2} {n + 3}")
        names.append(os.path.join(folder, f"sheet {frame}.obj"))
        pathlib.Path(names[-1]).write_text("\n".join(lines) + "\n", encoding="ascii")
    return names


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory() if len(sys.argv) < 4 else None
        cls.folder = cls.kept.name if cls.kept else sys.argv[3]
        os.makedirs(cls.folder, exist_ok=True)
        cls.sheets = write_sheets(cls.folder)
        cls.browser = Browser(chromium, 1200, 800)
        cls.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "light"}])

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        if cls.kept:
            cls.kept.cleanup()

    def tearDown(self):
        self.assertEqual(self.browser.problems, [], "what the console says")

    def page(self, name, expected, *command):
        file = os.path.join(self.folder, name)
        run = subprocess.run([program, *command, file], stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
        self.assertEqual(run.returncode, expected, run.stderr)
        return pathlib.Path(file).as_uri()

    def screenshot(self, name, clip="canvas"):
        file = os.path.join(self.folder, name)
        self.browser.picture(file, clip)
        return read_png(file)

    def count(self, selector):
        return self.browser.ask(f"document.querySelectorAll({selector!r}).length")

    def text(self, selector):
        return self.browser.ask(f"document.querySelector({selector!r}).textContent")

    def camera(self):
        return self.browser.ask("document.querySelector('.view').dataset.camera")

    def scrub(self, value):
        self.browser.ask(f"(slider => {{ slider.value = {value}; slider.dispatchEvent(new Event('input')); }})"
                         "(document.querySelector('#scrub input'))")
        self.browser.settle()

    def go(self, hash):
        self.browser.ask(f"location.hash = {hash!r}")
        self.browser.wait_for(f"document.querySelector('.view').dataset.shown === {hash!r}")
        self.browser.settle()

    def assert_meshes(self, bits):
        """Every mesh of the page is the OBJ of its frame, within half a step of its grid."""
        for frame, name in enumerate(self.sheets):
            lines = [line.split() for line in pathlib.Path(name).read_text(encoding="ascii").splitlines()]
            points = [[float(x) for x in line[1:]] for line in lines if line[0] == "v"]
            faces = [int(k) - 1 for line in lines if line[0] == "f" for k in line[1:]]
            shown = self.browser.ask(
                f"(async () => {{ const source = new SceneSource(), mesh = await source.mesh({frame});"
                f" const exact = {points}.map(p => source.toView(p)).flat();"
                " return [[...mesh.triangles], Math.max(...mesh.positions.map((x, k) => Math.abs(x - exact[k])))]; })()")
            self.assertEqual(shown[0], faces)
            self.assertLessEqual(shown[1], 2.0 ** -(bits + 1) + 2.0**-24, "half a step, and single precision")

    def test_violated(self):
        page = self.page("violated.html", 1, "verify", "--motion", *self.sheets, "--html")
        browser = self.browser
        browser.open(page + "#frame=0", "#frame=0")
        self.assertEqual(self.text("#verdict"), "violated")
        self.assertEqual(self.count("#timeline button"), 4)
        self.assertEqual(browser.ask("[...document.querySelectorAll('#timeline button')].map(b => b.className)"),
                         ["clean", "violated", "violated", "violated"])
        rows = self.count("#witnesses > tbody > tr")
        self.assertEqual(rows, browser.ask("JSON.parse(document.getElementById('report').textContent).violations.length"))
        self.assertGreater(rows, 3)
        self.assert_meshes(20)
        self.assertEqual(browser.ask("performance.getEntriesByType('resource').length"), 0, "nothing is loaded")

        whole, camera = self.screenshot("frame.png"), self.camera()
        colours = {pixel for row in whole for pixel in row}
        self.assertGreater(len(colours), 50, "the canvas is not blank")
        for colour in PAIR_COLOURS:
            self.assertLess(count_of(whole, colour), 20, "a frame has no pair")

        self.go("#witness=1")
        self.assertNotEqual(self.camera(), camera, "the view flies to the witness")
        self.assertEqual(self.count("#witnesses tr[aria-current]"), 1)
        self.assertFalse(browser.ask("document.getElementById('scrub').hidden"))
        first = self.screenshot("witness.png")
        for colour in PAIR_COLOURS:
            self.assertGreater(count_of(first, colour), 100, "both features are drawn")

        self.scrub(1)
        self.assertEqual(self.text("#scrub output"), "t = 1.0000")
        self.assertNotEqual(self.screenshot("witness-end.png"), first, "the motion can be scrubbed")

        browser.press("n")
        browser.wait_for("document.querySelector('.view').dataset.shown === '#witness=2'")
        self.assertIn("Witness 2 of", self.text("#witness-title"))
        camera = self.camera()
        browser.ask("document.querySelector('canvas').focus()")
        browser.press("ArrowLeft")
        browser.settle()
        self.assertNotEqual(self.camera(), camera, "arrow keys turn the view")
        browser.ask("document.querySelector('#timeline button').click()")
        browser.wait_for("document.querySelector('.view').dataset.shown === '#frame=0'")
        self.screenshot("violated.png", "body")

    def test_frame_witness(self):
        page = self.page("frame.html", 1, "verify", self.sheets[3], "--html")
        self.browser.open(page + "#witness=1", "#witness=1")
        self.assertTrue(self.browser.ask("document.getElementById('scrub').hidden"), "a frame has no motion")
        picture = self.screenshot("overlap.png")
        for colour in PAIR_COLOURS:
            self.assertGreater(count_of(picture, colour), 50)

    def test_clean(self):
        page = self.page("clean.html", 0, "verify", *self.sheets[:2], "--motion", "--html")
        self.browser.open(page + "#frame=1", "#frame=1")
        self.assertEqual(self.text("#verdict"), "clean")
        self.assertEqual(self.count("#witnesses tr"), 0)
        self.assertEqual(self.count("#timeline button.clean"), 2)

    def test_without_meshes(self):
        page = self.page("pairs.html", 1, "verify", *self.sheets[1:3], "--motion", "--html-mb", "0", "--html")
        self.browser.open(page + "#witness=1", "#witness=1")
        self.assertIn("not in this page", self.text(".message"))
        picture = self.screenshot("pair.png")
        for colour in PAIR_COLOURS:
            self.assertGreater(count_of(picture, colour), 50)
        self.scrub(self.browser.ask("Number(document.querySelector('#scrub input').value) + 0.1"))
        self.assertNotEqual(self.screenshot("pair-later.png"), picture, "the pair moves")

    def test_player(self):
        page = self.page("player.html", 0, "view", *self.sheets, "-o")
        self.browser.open(page, "#frame=0")
        self.assert_meshes(16)
        first = self.screenshot("player-0.png")
        self.go("#frame=2")
        self.assertIn("frame 2", self.text("#scrub output"))
        self.assertNotEqual(self.screenshot("player-2.png"), first)
        self.assertGreater(len({pixel for row in first for pixel in row}), 50)
        self.browser.press(".")
        self.browser.wait_for("document.querySelector('.view').dataset.shown === '#frame=3'")
        self.browser.press(" ")
        self.browser.wait_for("document.querySelector('.view').dataset.shown !== '#frame=3'")
        self.assertEqual(self.text("[data-do=play]"), "Pause")

    def test_player_of_one_frame(self):
        page = self.page("still.html", 0, "view", self.sheets[2], "-o")
        self.browser.open(page, "#frame=0")
        still = self.screenshot("still.png")
        self.browser.press(" ")
        self.browser.settle()
        self.assertEqual(self.text("[data-do=play]"), "Play", "there is nothing to play")
        self.assertEqual(self.screenshot("still-played.png"), still)

    def test_conformance(self):
        artifacts = os.path.join(self.folder, "artifacts")
        run = subprocess.run([program, "fuzz", "--plugin", plugin, "--cases", "1", "--jobs", "1", "--artifacts", artifacts],
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
        self.assertEqual(run.returncode, 1, run.stderr)
        browser = self.browser
        browser.call("Page.navigate", url=pathlib.Path(artifacts, "conformance.html").as_uri())
        browser.wait_for("document.readyState === 'complete' && document.querySelector('#classes') !== null")
        self.assertIn("does not conform", self.text("#verdict"))
        self.assertEqual(browser.ask("performance.getEntriesByType('resource').length"), 0, "nothing is loaded")
        self.assertLessEqual(browser.ask("document.documentElement.scrollWidth"), 1200, "all of it fits into the window")
        target = browser.ask("(link => { link.click(); return link.hash; })(document.querySelector('#classes a'))")
        browser.wait_for(f"document.querySelector({target!r}).closest('details').open")
        self.screenshot("conformance.png", "body")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
