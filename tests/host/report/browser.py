"""A headless Chromium that draws WebGL in software, for the test of the page of reports."""

import base64
import time

from selenium import webdriver
from selenium.webdriver.chrome.service import Service

WAIT_S = 60
# Draws the view and reads it: view, width, height, and data with four bytes a pixel.
DRAWN = """
    const view = window.emax_view;
    view.draw();
    const { width, height } = view.canvas;
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [width, height];
    const to = copy.getContext('2d', { willReadFrequently: true });
    to.drawImage(view.canvas, 0, 0);
    const data = to.getImageData(0, 0, width, height).data;"""


class Browser:
    """Opens pages from disk; closes with the block."""

    def __init__(self, webgl=True):
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        # The sandbox needs rights that root in a container does not have; pages are our own.
        arguments = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars"]
        arguments += ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if webgl else ["--disable-3d-apis"]
        for argument in arguments:
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.driver.quit()

    def js(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def devtools(self, command, **parameters):
        return self.driver.execute_cdp_cmd(command, parameters)

    def open(self, path, width=1280, height=900):
        """Opens the page and waits until it says that it is complete, or shows a notice."""
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        self.driver.get(path.resolve().as_uri())
        self.until("return Boolean(document.documentElement.dataset.ready || document.querySelector('[role=alert]'))",
                   f"{path.name}: the page does not finish")

    def until(self, script, complaint):
        end = time.monotonic() + WAIT_S
        while not self.js(script):
            if time.monotonic() > end:
                raise AssertionError(complaint)
            time.sleep(0.05)

    def errors(self):
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def text(self, selector):
        return self.js("return document.querySelector(arguments[0])?.textContent ?? null", selector)

    def click(self, selector):
        self.js("document.querySelector(arguments[0]).click()", selector)

    def choose(self, selector, value):
        self.js("""const found = document.querySelector(arguments[0]);
                   found.value = arguments[1];
                   found.dispatchEvent(new Event(found.type === 'range' ? 'input' : 'change'))""", selector, value)

    def touch(self, places):
        """A finger goes down at the first place, over the others, and up."""
        for kind, place in [("touchStart", places[0]), *(("touchMove", place) for place in places[1:])]:
            self.devtools("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": place[0], "y": place[1]}])
            time.sleep(0.02)  # as fast as a finger; a browser decides in time whether it scrolls
        self.devtools("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        time.sleep(0.2)

    def pixels(self):
        """Numbers of the drawn view: { seen, red, blue, amber, hash } of its opaque pixels."""
        return self.js(DRAWN + """
            const count = { seen: 0, red: 0, blue: 0, amber: 0, hash: 0 };
            for (let i = 0; i < data.length; i += 4) {
              const [r, g, b, a] = [data[i], data[i + 1], data[i + 2], data[i + 3]];
              if (a < 128) continue;
              ++count.seen;
              if (r > 1.5 * b && r > 1.5 * g) ++count.red;
              if (b > 1.5 * r) ++count.blue;
              if (r > 240 && Math.abs(g - 176) < 8 && b < 20) ++count.amber;
              count.hash = (Math.imul(count.hash, 31) + r + 256 * g + 65536 * b + i) | 0;
            }
            return count;""")

    def colours_at(self, positions):
        """[(r, g, b, a)] of the drawn view at positions of the cloud."""
        return self.js(DRAWN + """
            return arguments[0].map((position) => {
              const seen = view.centre.clone().set(...position.map((value, i) => value - view.shape.origin[i])).project(view.camera);
              const [x, y] = [(seen.x + 1) / 2 * width, (1 - seen.y) / 2 * height].map(Math.floor);
              return [...data.subarray(4 * (y * width + x), 4 * (y * width + x) + 4)];
            });""", positions)

    def pdf(self):
        answer = self.devtools("Page.printToPDF", printBackground=True, preferCSSPageSize=True)
        return base64.b64decode(answer["data"])
