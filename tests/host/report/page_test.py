"""The page of reports in a browser: what it says, draws, prints, and refuses.

usage: page_test.py TEMPLATE [--fault NAME] [--report FILE]

TEMPLATE is report.html as it is embedded. --fault breaks the page, which the test has to notice: legend puts a row at
the wrong end, markup takes a name as markup, and order exchanges two arrays of the geometry. --report tests a report
that the program wrote in place of those of page_fixture.py.
"""

import argparse
import json
import random
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import page_fixture as fixture
from browser import Browser

LARGEST_TEMPLATE = 1_000_000
# A title that would run a script where it were taken as markup.
HOSTILE = "<img src=x onerror=\"document.title='broken'\">.ply"
# What a fault replaces in the script; "order" is one of the geometry.
FAULTS = {"legend": (r"\.unshift\(\{name:", ".push({name:"),
          "markup": (r"document\.title=`\$\{(\w+)\.title\}: emax report`",
                     r'\g<0>,document.body.insertAdjacentHTML("beforeend",\1.title)'),
          "order": None}
checked = 0


def holds(condition, complaint):
    global checked
    if not condition:
        sys.exit(f"page: {complaint}")
    checked += 1


def equal(found, expected, what):
    holds(found == expected, f"{what}: {found!r} in place of {expected!r}")


class Pages:
    """Writes reports into a folder."""

    def __init__(self, template, folder):
        self.template, self.folder = template, Path(folder)

    def write(self, name, data, geometry):
        path = self.folder / f"{name}.html"
        path.write_text(fixture.page_of(self.template, data, geometry))
        return path


def says_the_answer(browser, data):
    verdict = browser.text("#verdict")
    holds(data["verdict"]["text"].split(":")[0] in verdict, f"the verdict is {verdict!r}")
    equal(browser.text("#epsilon data"), "0.8 mm", "the tolerance")
    equal(browser.text("#e_max data"), "1 mm", "e_max")
    equal(browser.text("#triangles data"), "440", "triangles")
    equal(browser.text("#points data"), "20,000", "points")
    equal(browser.js("return document.querySelector('#e_max data').value"), repr(data["e_max"]).removesuffix(".0"), "the exact e_max")
    for selector, text in (("#provenance", "3f" * 32), ("#provenance", "emax 0.4.0"), ("#provenance", "gp3"),
                           ("#facts", "1 component, closed, genus 0"), ("#certificate", "emax verify part.ply.certificate.json"),
                           ("#certificate pre.text", '"bound": 0.8'), ("#left-out", "of class 7"), ("#left-out", "755 points"),
                           ("#times", "reconstruction"), ("#search", "24 evaluations")):
        holds(text in browser.text(selector), f"{selector} does not say {text}")
    equal(browser.js("return [...document.querySelectorAll('h1')].length"), 1, "headings of the first order")
    equal(browser.js("return [...document.querySelectorAll('button, input, select')].filter((e) => !e.labels?.length && !e.textContent.trim() && !e.ariaLabel).length"),
          0, "controls without a name")


def shows_the_distribution(browser, data):
    rows = browser.js("return [...document.querySelectorAll('#legend tbody tr')].map((row) => [...row.cells].slice(1).map((cell) => cell.textContent))")
    equal(len(rows), 12, "bands of the legend")
    equal(rows[0], ["above +0.8", "< 0.01 %"], "the uppermost band")
    equal(rows[-1][0], "below −0.8", "the lowest band")
    bins = data["histogram"]["counts"]
    share = 100 * sum(bins[-4:]) / data["points"]
    equal(rows[1], ["+0.64 to +0.8", f"{share:.2f} %"], "the highest band within ε")
    ends = browser.js("return [...document.querySelectorAll('#legend .swatch')].map((s) => getComputedStyle(s).backgroundImage + getComputedStyle(s).backgroundColor)")
    colours = lambda text: [list(map(int, m)) for m in re.findall(r"rgb\((\d+), (\d+), (\d+)\)", text)]
    equal(colours(ends[0])[-1], fixture.COLOURS["above"], "the colour above the tolerance")
    equal(colours(ends[1])[-1], fixture.COLOURS["stops"][-1], "the legend's upper end")
    equal(colours(ends[-2])[0], fixture.COLOURS["stops"][0], "the legend's lower end")
    equal(colours(ends[-1])[-1], fixture.COLOURS["below"], "the colour below the tolerance")
    bars = browser.js("return [...document.querySelectorAll('#distribution rect.bar')].map((bar) => bar.textContent)")
    equal(len(bars), fixture.HISTOGRAM_BINS + 1, "bars of the histogram")
    holds(f": {bins[0]:,} points" in bars[0], f"the first bar says {bars[0]!r}, not {bins[0]} points")
    holds("19,999 (> 99.99 %)" in browser.text("#distribution"), "the statistics do not say how many are within ε")


def draws_the_model(browser, data):
    """The pixels of known places have the colours of their deviations; switches change what is drawn."""
    browser.click("#look-front")
    browser.click("#show-edges")
    front = browser.pixels()
    holds(front["seen"] > 30_000, f"only {front['seen']} pixels are drawn")
    holds(front["red"] > 1500 and front["blue"] > 1500, f"red and blue are missing: {front}")
    # In front, where nothing hides the point, and with a deviation of a sure colour.
    sure = [(position, deviation) for position, deviation in POINTS
            if position[1] - fixture.CENTRE[1] < -0.8 * fixture.RADIUS and abs(deviation) > 0.5 * fixture.EPSILON]
    chosen = random.Random(20).sample(sure, 100)
    colours = browser.colours_at([position for position, _ in chosen])
    for (position, deviation), (r, g, b, a) in zip(chosen, colours, strict=True):
        holds(a == 255 and (r > b) == (deviation > 0), f"the point at {position} of deviation {deviation} has the colour {(r, g, b, a)}")

    browser.js("window.emax_view.zoom_by(0.5)")  # the point that is left out lies outside of the sphere
    for switch in ("#show-points", "#show-faces", "#show-excluded"):
        before = browser.pixels()["hash"]
        browser.click(switch)
        holds(browser.pixels()["hash"] != before, f"{switch} changes nothing")
        browser.click(switch)
        equal(browser.pixels()["hash"], before, f"the picture after {switch} twice")
    browser.click("#look-front")
    browser.click("#show-points")
    plain = browser.pixels()
    holds(plain["red"] + plain["blue"] < 300, f"plain triangles have colours: {plain}")
    browser.choose("#colour-mesh", "worst")
    coloured = browser.pixels()
    holds(coloured["red"] > 1000 and coloured["blue"] > 1000, f"triangles have no colours: {coloured}")
    browser.click("#show-points")
    browser.choose("#colour-mesh", "plain")

    browser.choose("#colour-scale", "go")
    equal(browser.js("return document.querySelectorAll('#legend tbody tr').length"), 3, "rows of the legend of go and no-go")
    equal(browser.pixels()["red"], 0, "red pixels under go and no-go")
    browser.choose("#colour-scale", "")
    whole = browser.pixels()["seen"]
    browser.choose("#section-axis", "0")
    browser.choose("#section-place", "0.5")
    half = browser.pixels()["seen"]
    holds(0.4 * whole < half < 0.65 * whole, f"the section leaves {half} of {whole} pixels")
    said = browser.text("#model output")
    holds(abs(float(said.removeprefix("x = ").removesuffix(" mm")) - fixture.CENTRE[0]) < 0.1, f"the section is said to be at {said!r}")
    browser.choose("#section-axis", "")
    seen = set()
    for side in ("front", "back", "left", "right", "top", "bottom", "isometric"):
        browser.click(f"#look-{side}")
        seen.add(browser.pixels()["hash"])
    equal(len(seen), 7, "different views")


def leads_to_points(browser, data):
    target = "const v = window.emax_view; return v.controls.target.toArray().map((value, i) => value + v.shape.origin[i])"
    browser.js("window.emax_view.look('back')")
    worst = data["worst"][0]
    browser.click("#worst .goto")
    away = lambda: max(abs(t - p) for t, p in zip(browser.js(target), worst["position"]))
    end = time.monotonic() + 20
    while away() > 1e-3 and time.monotonic() < end:
        time.sleep(0.05)
    holds(away() < 1e-3, f"the camera is {away()} away from the worst point")
    holds(browser.pixels()["amber"] > 3, "the worst point is not seen in the colour of what exceeds the tolerance")
    said = browser.text("#said")
    holds("Point 6,666: deviation +1 mm" in said, f"it is said: {said!r}")
    # A click on the marked point, in the middle of the view, says the same deviation.
    box = browser.js("const b = window.emax_view.canvas.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]")
    for kind in ("mousePressed", "mouseReleased"):
        browser.devtools("Input.dispatchMouseEvent", type=kind, x=box[0], y=box[1], button="left", clickCount=1)
    browser.until("return document.querySelector('#said').textContent.startsWith('Point: ')", "a click says nothing")
    holds("deviation +1 mm" in browser.text("#said"), f"a click says {browser.text('#said')!r}")
    # The click gave the view the focus: now it takes fingers, and its keys turn and zoom.
    equal(browser.js("return [document.activeElement.id, window.emax_view.canvas.style.touchAction]"), ["view", "none"], "after a click")
    before = browser.js("return window.emax_view.camera.position.toArray()")
    for key in ("ArrowLeft", "Escape"):
        browser.devtools("Input.dispatchKeyEvent", type="keyDown", key=key)
    holds(browser.js("return window.emax_view.camera.position.toArray()") != before, "an arrow key does not turn the view")
    equal(browser.js("return [document.activeElement.id, window.emax_view.canvas.style.touchAction]"), ["", "auto"], "after Escape")


def rests(browser):
    """Nothing is drawn without a reason."""
    browser.js("window.drawn = 0; const draw = window.emax_view.renderer.render; window.emax_view.renderer.render = function (...a) { ++window.drawn; return draw.apply(this, a); }")
    time.sleep(0.6)  # the picture for paper is kept after a rest
    browser.js("window.drawn = 0")
    time.sleep(0.5)
    equal(browser.js("return window.drawn"), 0, "pictures drawn at rest")


def fits_every_width(browser, path):
    for width in (1440, 800, 360):
        browser.open(path, width)
        equal(browser.js("return document.documentElement.scrollWidth"), width, f"the width of the page at {width}")
        beyond = browser.js("""return [...document.querySelectorAll('main *, header *')].filter((e) => {
            const box = e.getBoundingClientRect();
            return box.width > 1 && box.right > innerWidth + 1 && !e.closest('.scroll, .hidden');
          }).map((e) => e.outerHTML.slice(0, 80))""")
        equal(beyond, [], f"elements beyond the edge at {width}")


def leaves_the_page_to_fingers(browser, path):
    """A finger on the view scrolls the page; after a tap it turns the view."""
    browser.open(path, 360, 740)
    browser.devtools("Emulation.setTouchEmulationEnabled", enabled=True)
    hint = "return getComputedStyle(document.querySelector('.hint')).display"
    state = "return [scrollY, window.emax_view.camera.position.toArray()]"
    middle = """window.emax_view.stage.scrollIntoView({ block: 'center' });
        const b = window.emax_view.canvas.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]"""

    def drag():
        x, y = browser.js(middle)
        before = browser.js(state)
        browser.touch([(x + 3 * i, y - 10 * i) for i in range(12)])
        after = browser.js(state)
        return after[0] - before[0], after[1] != before[1]

    equal(browser.js(hint), "block", "the hint for fingers")
    scrolled, turned = drag()
    holds(scrolled > 40 and not turned, f"before a tap a finger scrolls by {scrolled}; it turns the view: {turned}")
    x, y = browser.js(middle)
    browser.touch([(x, y)])
    browser.until("return document.activeElement.id === 'view'", "a tap does not reach the view")
    equal(browser.js(hint), "none", "the hint after a tap")
    scrolled, turned = drag()
    holds(scrolled == 0 and turned, f"after a tap a finger scrolls by {scrolled}; it turns the view: {turned}")
    browser.devtools("Emulation.setTouchEmulationEnabled", enabled=False)


def prints(browser, folder):
    file = folder / "report.pdf"
    file.write_bytes(browser.pdf())
    text = subprocess.run(["pdftotext", "-layout", file, "-"], capture_output=True, text=True, check=True).stdout
    pages = text.count("\f")
    holds(2 <= pages <= 8, f"the report has {pages} pages on paper")
    for shown in ("Exceeds the tolerance", "Worst points", "15,055", "3f3f3f3f", '"bound": 0.8', "Where the time went", "above +0.8"):
        holds(shown in text, f"the paper does not show {shown}")
    for hidden in ("Isometric", "Drag to turn", "Other side"):
        holds(hidden not in text, f"the paper shows the control {hidden}")
    images = subprocess.run(["pdfimages", "-list", file], capture_output=True, text=True, check=True).stdout
    widths = [int(line.split()[3]) for line in images.splitlines()[2:]]
    holds(any(width > 400 for width in widths), f"the view is not on paper: images of the widths {widths}")


def keeps_the_picture(browser, path, sentence):
    """No view, a sentence, the picture and the numbers."""
    browser.open(path)
    notice = browser.text("[role=alert]") or ""
    holds(sentence in notice, f"{path.name}: the notice is {notice!r}, not {sentence!r}")
    holds(browser.js("return document.querySelector('#emax-picture').getBoundingClientRect().width > 50"), f"{path.name}: the picture is gone")
    equal(browser.js("return document.querySelectorAll('canvas').length"), 0, f"{path.name}: canvases")


def refuses_damage(browser, pages, data, geometry):
    whole = fixture.page_of(pages.template, data, geometry)
    coded = re.search(r'id="emax-geometry">([^<]*)', whole)[1]
    middle = len(coded) // 2
    damaged = {
        "longer": geometry + b"\0" * 8, "shorter": geometry[:-8], "changed": coded[:middle] + ("A" if coded[middle] != "A" else "B") + coded[middle + 1:],
        "cut": coded[:middle // 4 * 4], "no-base64": "%%%", "empty": "",
        "index": geometry[:-4 * len(TRIANGLES) - 4] + b"\xff\xff\xff\xff" + geometry[-4 * len(TRIANGLES):]}
    for name, bytes_ in damaged.items():
        keeps_the_picture(browser, pages.write(name, data, bytes_), "The geometry of this report cannot be read")
        equal(browser.text("#triangles data"), "440", f"{name}: triangles")
    keeps_the_picture(browser, pages.write("counts", {**data, "geometry": {**data["geometry"], "points": 10 ** 15}}, geometry), "cannot be read")
    for name, text in (("no-json", "{"), ("other-schema", '{"schema": "emax-report-2"}')):
        keeps_the_picture(browser, pages.write(name, text, geometry), "The data of this report are damaged")


def keeps_text_text(browser, pages, data, geometry):
    names = {"title": HOSTILE, "unit": None, "facts": [{"name": HOSTILE, "text": HOSTILE}], "provenance": [{"name": "cloud", "file": HOSTILE, "sha256": None}],
             "certificate": {"file": HOSTILE, "text": HOSTILE, "verify": HOSTILE}, "left_out": [{"reason": HOSTILE, "points": 1}],
             "verdict": {"within": None, "text": HOSTILE}, "checks": [{"claim": HOSTILE, "holds": True, "text": HOSTILE}],
             "epsilon": None, "back": None, "search": None, "curve": None, "times": []}
    browser.open(pages.write("hostile", {**data, **names}, geometry))
    equal(browser.text("#title"), HOSTILE, "the title")
    equal(browser.js("return document.title"), f"{HOSTILE}: emax report", "the title of the window")
    equal(browser.js("return document.querySelectorAll('img[src=x]').length"), 0, "elements made of a name")
    equal(browser.js("return [...document.querySelectorAll('#search, #curve, #times, #epsilon, #back')].length"), 0, "sections without data")
    equal(browser.errors(), [], "errors of the browser")


def shows_distances_without_sign(browser, pages):
    data, geometry = fixture.sphere_report(3000, signed=False)
    browser.open(pages.write("unsigned", {**data, "verdict": {"within": True, "text": "Within tolerance: every point"}}, geometry))
    first = browser.js("return document.querySelector('#legend tbody').textContent")
    holds("−" not in first and "above 0.8" in first, f"the legend of distances says {first!r}")
    holds(browser.pixels()["seen"] > 30_000, "distances are not drawn")
    equal(browser.errors(), [], "errors of the browser")


def loads_many_points(browser, pages):
    """A hundred thousand points and a mesh load and draw within seconds, on a processor that draws in software."""
    data, geometry = fixture.sphere_report(100_000)
    path = pages.write("many", data, geometry)
    holds(path.stat().st_size <= 1_000_000 + 12 * (100_000 + 222), f"the page of many points has {path.stat().st_size} bytes")
    begin = time.monotonic()
    browser.open(path)
    took = time.monotonic() - begin
    holds(took < 20, f"many points take {took:.1f} s")


def broken(template, fault):
    """The template with a fault in its script."""
    if FAULTS.get(fault) is None:
        return template
    changed, times = re.subn(*FAULTS[fault], template)
    if times != 1:
        sys.exit(f"page: the fault {fault} finds its place {times} times")
    return changed


def test_report(browser, path):
    """What holds for every report with points and a view."""
    data = json.loads(re.search(r'id="emax-data">([^<]*)', path.read_text())[1])
    browser.open(path)
    equal(browser.text("#verdict").replace("✓", "").replace("✗", ""), data["verdict"]["text"], "the verdict")
    equal(browser.text("#triangles data"), f"{data['triangles']:,}", "triangles")
    seen = browser.pixels()["seen"]
    holds(seen > 10_000, f"only {seen} pixels are drawn")
    total = sum(data["histogram"]["counts"]) + data["histogram"]["below"] + data["histogram"]["above"]
    equal(total, data["statistics"]["count"], "points of the histogram")
    browser.click("#worst .goto")
    browser.until("""const v = window.emax_view;
        const p = JSON.parse(document.getElementById('emax-data').textContent).worst[0].position;
        return v.controls.target.toArray().every((value, i) => Math.abs(value + v.shape.origin[i] - p[i]) < 1e-5 * v.radius)""",
                  "the view does not lead to the worst point")
    equal(browser.js("return document.documentElement.scrollWidth <= innerWidth"), True, "the page fits")
    equal(browser.errors(), [], "errors of the browser")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("template", type=Path)
    parser.add_argument("--fault", choices=sorted(FAULTS))
    parser.add_argument("--report", type=Path)
    given = parser.parse_args()
    if given.report:
        with Browser() as browser:
            test_report(browser, given.report)
        print(f"page: {checked} checks hold")
        return
    template = given.template.read_text()
    holds(len(template.encode()) < LARGEST_TEMPLATE, f"the template has {len(template.encode())} bytes")
    holds("SPDX-License-Identifier: MIT" in template and "Permission is hereby granted" in template, "the licence of three.js is not in the page")
    holds(not re.search(r"""(src|href)=["']?(https?:)?//""", template), "the page names another host")

    data, geometry = fixture.sphere_report()
    if given.fault == "order":  # z before y
        n = 2 * data["points"]
        geometry = geometry[:n] + geometry[2 * n:3 * n] + geometry[n:2 * n] + geometry[3 * n:]
    with tempfile.TemporaryDirectory() as name, Browser() as browser:
        pages = Pages(broken(template, given.fault), name)
        path = pages.write("sphere", data, geometry)
        browser.open(path)
        says_the_answer(browser, data)
        shows_the_distribution(browser, data)
        draws_the_model(browser, data)
        leads_to_points(browser, data)
        rests(browser)
        prints(browser, Path(name))
        equal(browser.errors(), [], "errors of the browser")
        keeps_text_text(browser, pages, data, geometry)
        shows_distances_without_sign(browser, pages)
        fits_every_width(browser, path)
        leaves_the_page_to_fingers(browser, path)
        loads_many_points(browser, pages)
        refuses_damage(browser, pages, data, geometry)
        with Browser(webgl=False) as plain:
            keeps_the_picture(plain, path, "shows no WebGL")
            equal(plain.text("#triangles data"), "440", "triangles without WebGL")
            holds(plain.text("#worst tbody td").strip() == "6,666", "the worst points without WebGL")
    print(f"page: {checked} checks hold")


POINTS = fixture.sphere_points(20_000)
TRIANGLES = fixture.sphere_mesh(12, 20)[1]
main()
