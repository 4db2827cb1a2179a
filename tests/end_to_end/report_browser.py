"""Opens pages of submap-slam in headless Chromium as a reader would.

Every check asks the page itself: what it shows, what it logged, what it asked the network for."""
import base64
import contextlib
import json
import os
import sys
import time

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.by import By

DESKTOP, PHONE = (1400, 900), (390, 844)


class Failure(Exception):
    pass


def expect(condition, text):
    if not condition:
        raise Failure(text)


def wait_until(condition, text, timeout_s=60):
    end = time.monotonic() + timeout_s
    while not condition():
        expect(time.monotonic() < end, f"waited in vain: {text}")
        time.sleep(0.05)


@contextlib.contextmanager
def browser(size, dark=False):
    width, height = size
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    try:
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                               {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600})
        driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]})
        yield driver
    finally:
        driver.quit()


def open_page(driver, file):
    driver.get(f"file://{file}")
    wait_until(lambda: driver.find_elements(By.CSS_SELECTOR, ".map canvas, .chart canvas"), "map or charts are drawn")


def expect_quiet(driver):
    """Nothing in the console, and no request but for the page and what is inside of it."""
    log = [entry["message"] for entry in driver.get_log("browser")]
    expect(not log, f"the console says: {log}")
    for entry in driver.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            url = message["params"]["request"]["url"]
            expect(url.startswith(("file:///", "data:")), f"asked the network for {url[:100]}")


def expect_panels(driver, ids):
    """Each panel has a heading, a sentence, and something to see: a drawn chart, a map, a table or a text."""
    shown = {panel.get_attribute("id"): panel for panel in driver.find_elements(By.CSS_SELECTOR, ".panel")}
    expect(list(shown) == list(ids), f"panels are {list(shown)}, expected {list(ids)}")
    for name, panel in shown.items():
        expect(panel.find_element(By.TAG_NAME, "h2").text and panel.find_element(By.CSS_SELECTOR, ".how").text,
               f"panel {name} has no heading or no sentence")
        expect(driver.execute_script(SHOWS_SOMETHING, panel), f"panel {name} shows nothing")


SHOWS_SOMETHING = """
const panel = arguments[0];
const drawn = (canvas) => canvas.width > 0 &&
  canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.some((value) => value > 0);
const charts = [...panel.querySelectorAll('.chart')];
const visible = (node) => node.getBoundingClientRect().height > 0;
if (charts.length > 0) return charts.every((chart) => [...chart.querySelectorAll('canvas')].some(drawn));
if (panel.querySelector('.map')) return [...panel.querySelectorAll('.map canvas')].some(drawn);
const texts = [...panel.querySelectorAll('tbody tr, pre, .note, li')];
return texts.some((node) => visible(node) && node.textContent.trim().length > 0);
"""


def expect_no_overflow(driver):
    width, window = driver.execute_script("return [document.documentElement.scrollWidth, window.innerWidth]")
    expect(width <= window, f"the page is {width} px wide in a window of {window} px")


def map_place(driver):
    """Where the map's contents are on the screen: changes with every move and zoom."""
    return driver.execute_script("""
      const pane = document.querySelector('.leaflet-map-pane').getBoundingClientRect();
      const image = document.querySelector('.leaflet-image-layer');
      const size = image ? image.getBoundingClientRect().width : 0;
      const scale = document.querySelector('.leaflet-control-scale-line').textContent + '/' +
        document.querySelector('.leaflet-control-scale-line').style.width;
      return {x: pane.x, y: pane.y, size, scale};""")


def expect_pan_and_zoom(driver):
    box = driver.find_element(By.CSS_SELECTOR, ".map")
    driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", box)
    before = map_place(driver)
    ActionChains(driver).drag_and_drop_by_offset(box, 80, 50).perform()
    wait_until(lambda: map_place(driver)["x"] != before["x"], "dragging moves the map")
    moved = map_place(driver)
    expect(moved["y"] != before["y"], "dragging moves the map up and down")
    ActionChains(driver).scroll_from_origin(ScrollOrigin.from_element(box), 0, -300).perform()
    wait_until(lambda: map_place(driver)["scale"] != moved["scale"], "the wheel zooms")
    driver.execute_script("document.querySelector('.leaflet-control-zoom-out').click()")
    return before


def take_picture(driver, file):
    size = driver.execute_script("return [document.documentElement.scrollWidth, document.documentElement.scrollHeight]")
    picture = driver.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True, "clip": {
        "x": 0, "y": 0, "width": size[0], "height": min(size[1], 12000), "scale": 1}})
    data = base64.b64decode(picture["data"])
    expect(data[1:4] == b"PNG" and len(data) > 5000, "the screenshot is empty")
    with open(file, "wb") as out:
        out.write(data)


def main():
    """report_browser.py PAGE PICTURE WIDTH HEIGHT: a picture of the top of a page."""
    page, picture, width, height = sys.argv[1:]
    with browser((int(width), int(height))) as driver:
        open_page(driver, os.path.abspath(page))
        time.sleep(0.5)  # maps fade in
        driver.save_screenshot(picture)


if __name__ == "__main__":
    main()
