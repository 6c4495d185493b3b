"""Opens the report of a part in a real browser and uses it as a reader would.

usage: report_in_browser.py --command SCAN2FEA --scan SCAN.ply [--pictures FOLDER]
Prints what is wrong, one line each; exit status 1 if anything is, 77 where Chromium or Selenium is not installed.
"""
import argparse
import base64
import json
import math
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

from expectations import expect, wrong

try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select, WebDriverWait
except ImportError:
    print("python3-selenium is not installed")
    sys.exit(77)
chromium, driver_program = shutil.which("chromium"), shutil.which("chromedriver")
if not chromium or not driver_program:
    print("chromium and chromium-driver are not installed")
    sys.exit(77)


def browser(width=1280, height=900, dark=False, scripts=True):
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for flag in ("--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
                 "--enable-unsafe-swiftshader", "--hide-scrollbars", "--disable-dev-shm-usage",
                 f"--window-size={width},{height}"):
        options.add_argument(flag)
    if not scripts:
        options.add_experimental_option("prefs", {"profile.managed_default_content_settings.javascript": 2})
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(service=webdriver.chrome.service.Service(driver_program), options=options)
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [
        {"name": "prefers-color-scheme", "value": "dark" if dark else "light"},
        {"name": "prefers-reduced-motion", "value": "reduce"}]})
    return driver


class Page:
    def __init__(self, file, pictures, **how):
        self.driver, self.pictures = browser(**how), pictures
        self.driver.set_script_timeout(60)
        self.driver.get("file://" + file)

    def wait(self, condition, what, seconds=60):
        try:
            WebDriverWait(self.driver, seconds, 0.1).until(lambda _: condition())
        except Exception:
            expect(False, what)

    def ready(self):
        self.wait(lambda: self.root("ready") is not None, "the page becomes interactive")

    def root(self, name):
        return self.driver.execute_script(f"return document.documentElement.dataset.{name} || null")

    def get(self, name):
        return self.driver.find_element(By.ID, name)

    def canvas(self, name):
        return self.driver.execute_script(f"return document.getElementById('canvas').dataset.{name}")

    def picked(self):
        return self.get("picked").text

    def click(self, element):
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
        element.click()

    # The colours of the view, as a browser shows them, in a coarse grid.
    def seen(self):
        time.sleep(0.4)
        return self.get("canvas").screenshot_as_base64

    def picture(self, name, whole=False):
        if not self.pictures:
            return
        time.sleep(0.5)
        if whole:
            size = self.driver.execute_script("return [document.documentElement.clientWidth, document.documentElement.scrollHeight]")
            shot = self.driver.execute_cdp_cmd("Page.captureScreenshot", {
                "captureBeyondViewport": True, "clip": {"x": 0, "y": 0, "width": size[0], "height": size[1], "scale": 1}})
            with open(os.path.join(self.pictures, name), "wb") as file:
                file.write(base64.b64decode(shot["data"]))
        else:
            self.driver.save_screenshot(os.path.join(self.pictures, name))

    def close(self):
        for entry in self.driver.get_log("browser"):
            expect(entry["level"] not in ("SEVERE", "WARNING"), "the console is silent: " + entry["message"])
        self.driver.quit()


def use_view(page, checked):
    driver = page.driver
    page.ready()
    canvas = page.get("canvas")
    before, first = page.canvas("direction"), page.seen()
    page.click(canvas)
    ActionChains(driver).move_to_element(canvas).click_and_hold().move_by_offset(120, 40).release().perform()
    page.wait(lambda: page.canvas("direction") != before, "dragging turns the model")
    expect(page.seen() != first, "a turned model looks different")
    before = page.canvas("direction")
    canvas.send_keys(Keys.ARROW_LEFT)
    page.wait(lambda: page.canvas("direction") != before, "an arrow key turns the model")
    zoom = float(page.canvas("zoom"))
    canvas.send_keys("+")
    page.wait(lambda: float(page.canvas("zoom")) > zoom, "the plus key zooms")
    canvas.send_keys(Keys.HOME)

    uncut = page.seen()
    page.click(page.get("cut"))
    page.wait(lambda: int(page.canvas("cutTetrahedra")) > 0, "the cut shows tetrahedra")
    cut, count = page.seen(), page.canvas("cutTetrahedra")
    expect(cut != uncut, "a cut model looks different")
    canvas.send_keys("]", "]", "]")
    page.wait(lambda: page.canvas("cutTetrahedra") != count, "a key moves the cut")
    page.picture("cut.png")
    expect(page.seen() != cut, "a moved cut looks different")
    page.click(page.get("cut"))

    looks = {}
    for option in [o.get_attribute("value") for o in Select(page.get("colour")).options]:
        Select(page.get("colour")).select_by_value(option)
        looks[option] = page.seen()
    expect(len(set(looks.values())) > len(looks) - 2, f"colourings look different: {list(looks)}")
    Select(page.get("colour")).select_by_value("triangles.deviation")
    for part in ("both", "blend", "reference", "result"):
        page.click(driver.find_element(By.CSS_SELECTOR, f"input[name=part][value={part}]"))
        looks[part] = page.seen()
        page.picture(part + ".png")
    expect(len({looks[p] for p in ("both", "blend", "result")}) == 3, "side by side and blended look different")
    low = page.get("scale-high")
    low.clear()
    low.send_keys("0.001", Keys.TAB)
    expect(page.seen() != looks["result"], "another scale looks different")
    shown = page.seen()
    for wrong_scale in ("-1", ""):  # below the other end, and none
        low.clear()
        low.send_keys(wrong_scale, Keys.TAB)
        expect("still" in page.get("scale-wrong").text, f"a scale that is none is told: '{wrong_scale}'")
        expect(page.seen() == shown, "and the one that is shown stays")
    page.click(page.get("scale-reset"))
    expect(page.get("scale-wrong").text == "", "and forgotten")
    bar = driver.execute_script("""const box = document.querySelector('#legend svg').getBoundingClientRect();
      return [...document.querySelectorAll('#legend text')].map((t) => t.getBoundingClientRect()).every((t) => t.left >= box.left && t.right <= box.right)""")
    expect(bar, "no number of the colour bar is cut off")
    farthest = driver.find_element(By.CSS_SELECTOR, "button[data-show^=farthest]")
    page.click(farthest)
    part = driver.execute_script("return document.querySelector('input[name=part]:checked').value")
    expect(part == ("both" if farthest.get_attribute("data-show") == "farthest-of-reference" else "result"),
           f"the farthest place is shown on the one that it is a point of: {part}")
    expect("farthest" in page.picked(), f"and told: {page.picked()}")
    page.click(driver.find_element(By.CSS_SELECTOR, "input[name=part][value=result]"))
    page.click(page.get("clear"))

    bars = [b for b in driver.find_elements(By.CSS_SELECTOR, "[data-measure='tetrahedra.scaled_jacobian'] .bar")]
    histogram = next(h for h in checked["histograms"] if h["measure"] == "scaled_jacobian")
    bar = max(range(len(bars)), key=lambda i: histogram["counts"][i])
    driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", bars[bar])
    bars[bar].send_keys(Keys.ENTER)
    expect(f"{histogram['counts'][bar]} tetrahedra" in page.picked(), f"a bar tells its elements: {page.picked()}")
    expect(f"{histogram['counts'][bar]:,} are shown" in page.picked(), f"all elements of a bar are shown: {page.picked()}")
    page.picture("bar.png")

    worst = checked["worst_elements"]["elements"][0]
    page.click(driver.find_element(By.CSS_SELECTOR, "tr[data-worst='0'] button"))
    page.wait(lambda: page.canvas("element") is not None, "the worst element is chosen")
    expect(page.canvas("element") == str(worst["element"]), f"the worst element is {worst['element']}, not {page.canvas('element')}")
    expect(f"Element {worst['element']}:" in page.picked(), f"the page tells the number: {page.picked()}")
    page.picture("worst.png")
    page.click(page.get("clear"))


# Each figure on the page is that of `check`, and what is read is a rounding of it.
def compare_figures(page, checked):
    found = 0
    for name, value, text in page.driver.execute_script(
            "return [...document.querySelectorAll('data[data-figure]')].map(d => [d.dataset.figure, d.value, d.textContent])"):
        expected = checked
        for key in name.split("."):
            expected = expected[key] if isinstance(expected, dict) else None
        expect(json.loads(value) == expected, f"{name} is {expected} by check, {value} on the page")
        if isinstance(expected, float):
            shown = float(text.replace("\u2009", "").removesuffix("\u00a0%"))
            rounding = 1e-6 if name.endswith("_difference_pct") else 1e-12
            expect(math.isclose(shown, expected, rel_tol=6e-3, abs_tol=rounding), f"{name} reads {text}, is {expected}")
        found += 1
    expect(found > 25, f"the page has figures, {found}")


def fits(page, what):
    wide = page.driver.execute_script("return [document.documentElement.scrollWidth, window.innerWidth]")
    expect(wide[0] <= wide[1], f"{what}: nothing is wider than the window, {wide}")
    cut = page.driver.execute_script("""return [...document.querySelectorAll('.scroll')]
      .filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.textContent.slice(0, 40));""")
    expect(not cut, f"{what}: no table is cut: {cut}")


def contrast_of(page, what):
    ratios = page.driver.execute_script("""
      const light = (c) => { const v = c.match(/[\\d.]+/g).slice(0, 3).map((x) => x / 255)
        .map((x) => (x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4)); return 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]; };
      const ground = light(getComputedStyle(document.body).backgroundColor);
      return [...document.querySelectorAll('p, td, th, dd, dt, a, h2, label, button, legend, caption')].filter((e) => e.offsetParent).map((e) => {
        const ink = light(getComputedStyle(e).color);
        return [(Math.max(ink, ground) + 0.05) / (Math.min(ink, ground) + 0.05), e.textContent.slice(0, 30)]; });""")
    for ratio, text in ratios:
        expect(ratio >= 4.5, f"{what}: contrast of '{text}' is {ratio:.1f}")


def labels_of(page):
    nameless = page.driver.execute_script("""
      return [...document.querySelectorAll('input, select, button, img, canvas, svg[role]')]
        .filter((e) => !(e.labels && e.labels.length) && !e.getAttribute('aria-label') && !e.alt && !e.textContent.trim())
        .map((e) => e.outerHTML.slice(0, 60));""")
    expect(not nameless, f"everything has a name: {nameless}")


def print_page(page, folder):
    pdf = page.driver.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True, "printBackground": True})
    data = base64.b64decode(pdf["data"])
    expect(data.startswith(b"%PDF"), "the page prints")
    expect(b"/MediaBox [0 0 594" in data or b"/MediaBox [0 0 595" in data, "on A4")
    if page.pictures:
        with open(os.path.join(page.pictures, "report.pdf"), "wb") as file:
            file.write(data)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--command", required=True)
    parser.add_argument("--scan", required=True)
    parser.add_argument("--pictures")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        scan, part, report = (os.path.join(folder, name) for name in ("scan.ply", "part.inp", "report"))
        shutil.copy(arguments.scan, scan)
        subprocess.run([arguments.command, "run", scan, "-o", part, "--faces", "3000", "--unit", "mm", "--report",
                        report, "--set", "foot=z<3mm", "--quiet", "--require", "edge_ratio.mean<=1.5"], check=True)
        first = open(part, "rb").read()
        checked = json.loads(subprocess.run(
            [arguments.command, "check", part, "--reference", scan, "--json", "-", "--quiet"], check=True,
            capture_output=True, text=True).stdout)

        again = json.load(open(os.path.join(report, "report.json")))["command"]
        os.remove(part)
        shutil.move(report, report + "-before")
        subprocess.run(" ".join(map(shlex.quote, [arguments.command] + again["arguments"][1:])), shell=True,
                       cwd=again["folder"], check=True)
        expect(open(part, "rb").read() == first, "the report's command makes the same bytes")

        page_file = os.path.join(report, "report.html")
        text = open(page_file, encoding="utf-8").read()
        for outside in ('src="http', 'href="http', "url(http", "@import"):
            expect(outside not in text, f"the page needs nothing from outside: {outside}")
        for width, height, dark in ((1280, 900, False), (1280, 900, True), (400, 800, False), (400, 800, True)):
            what = f"{width} px, {'dark' if dark else 'light'}"
            page = Page(page_file, arguments.pictures, width=width, height=height, dark=dark)
            if (width, dark) == (1280, False):
                use_view(page, checked)
                compare_figures(page, checked)
                labels_of(page)
                print_page(page, folder)
            page.ready()
            fits(page, what)
            contrast_of(page, what)
            page.picture(f"page-{width}-{'dark' if dark else 'light'}.png", whole=True)
            page.close()
        page = Page(page_file, arguments.pictures, scripts=False)
        expect(page.driver.find_element(By.CSS_SELECTOR, ".stills img").is_displayed(), "without scripts there are pictures")
        page.picture("page-no-scripts.png", whole=True)
        page.close()
    sys.exit(1 if wrong else 0)


main()
