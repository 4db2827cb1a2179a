#!/usr/bin/env python3
"""report.html and compare.html as a reader sees them: report_test.py PROGRAM SOURCE_DIR WORK_DIR"""
import json
import math
import os
import shutil
import subprocess
import sys

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By

from report_browser import (DESKTOP, PHONE, Failure, browser, expect, expect_no_overflow, expect_pan_and_zoom,
                            expect_panels, expect_quiet, open_page, take_picture, wait_until)

RUN_PANELS = ("map", "constraints", "objective", "uncertainty", "scores", "growth", "stages", "metrics", "settings",
              "messages")
LANDMARK_PANELS = ("map", "objective", "uncertainty", "associations", "stages", "metrics", "settings", "messages")
COMPARISON_PANELS = ("map", "differences", "table-1", "table-2", "table-3", "table-4")


def rows(driver, panel):
    return driver.find_elements(By.CSS_SELECTOR, f"#{panel} tbody tr")


def check_report(file, folder):
    with browser(DESKTOP) as driver:
        open_page(driver, file)
        expect_panels(driver, RUN_PANELS)
        expect_pan_and_zoom(driver)
        check_path_colours(driver)
        check_layers(driver)
        check_constraints(driver)
        check_search(driver)
        take_picture(driver, os.path.join(folder, "report.png"))
        expect_quiet(driver)
    with browser(PHONE, dark=True) as driver:
        open_page(driver, file)
        expect_no_overflow(driver)
        expect_panels(driver, RUN_PANELS)
        take_picture(driver, os.path.join(folder, "report_phone.png"))
        expect_quiet(driver)


def check_path_colours(driver):
    legend = driver.find_element(By.CSS_SELECTOR, "#map .legend")
    by_time = legend.text
    driver.find_element(By.CSS_SELECTOR, "#map select option[value=uncertainty]").click()
    expect(legend.text != by_time and "σ" in legend.text, f"the legend is still {legend.text}")


def check_layers(driver):
    """Each box hides a layer and shows it again."""
    drawn = "return document.querySelector('.map canvas').toDataURL()"
    picture = "return document.querySelectorAll('.leaflet-image-layer').length"
    boxes = {label.text.strip(): label for label in driver.find_elements(By.CSS_SELECTOR, "#map .controls label")}
    boxes["map"].click()
    expect(driver.execute_script(picture) == 0, "the map picture is still there")
    boxes["map"].click()
    expect(driver.execute_script(picture) == 1, "the map picture is gone")
    for name in ("path", "outlines", "frames"):
        before = driver.execute_script(drawn)
        boxes[name].click()
        wait_until(lambda: driver.execute_script(drawn) != before, f"box '{name}' changes the map")


def first_column(driver):
    return driver.execute_script(
        "return [...document.querySelectorAll('#constraints tbody td:first-child')].map((td) => Number(td.textContent))")


def check_constraints(driver):
    """Filters count right, headings sort, and a row marks its submaps on the map."""
    boxes = {label.text.split()[0]: label for label in driver.find_elements(By.CSS_SELECTOR, "#constraints .controls label")}
    counts = {kind: int(label.text.split("(")[1].rstrip(")")) for kind, label in boxes.items()}
    for label in boxes.values():
        box = label.find_element(By.TAG_NAME, "input")
        if not box.is_selected():
            label.click()
    expect(len(rows(driver, "constraints")) == min(sum(counts.values()), 100), "not every constraint is listed")
    expect(counts["chain"] > 0, "there is no chain of submaps")
    heading = driver.find_element(By.CSS_SELECTOR, "#constraints th:first-child button")
    heading.click()
    down = first_column(driver)
    heading.click()
    up = first_column(driver)
    expect(down == sorted(down, reverse=True) and up == sorted(up) and up != down, "headings do not sort")
    before = driver.execute_script("return document.querySelector('.map canvas').toDataURL()")
    ActionChains(driver).move_to_element(rows(driver, "constraints")[0]).click().perform()
    wait_until(lambda: driver.execute_script("return document.querySelector('.map canvas').toDataURL()") != before,
               "a row marks its submaps on the map")


def check_search(driver):
    field = driver.find_element(By.CSS_SELECTOR, "#settings input[type=search]")
    total = len(rows(driver, "settings"))
    field.send_keys("joining.chain")
    expect(0 < len(rows(driver, "settings")) < total, "searching the settings does nothing")
    expect("joining.chain" in rows(driver, "settings")[0].text, "the wrong setting is found")


def check_hostile_setting(file):
    """A value that looks like markup is text like any other."""
    with browser(DESKTOP) as driver:
        open_page(driver, file)
        field = driver.find_element(By.CSS_SELECTOR, "#settings input[type=search]")
        field.send_keys("sensor_labels")
        expect("</script><b>x" in rows(driver, "settings")[0].text, rows(driver, "settings")[0].text)
        expect_quiet(driver)


def check_landmark_report(file, folder):
    with browser(DESKTOP) as driver:
        open_page(driver, file)
        expect_panels(driver, LANDMARK_PANELS)
        expect_pan_and_zoom(driver)
        take_picture(driver, os.path.join(folder, "landmarks.png"))
        expect_quiet(driver)


def check_comparison(file, folder):
    with browser(DESKTOP, dark=True) as driver:
        open_page(driver, file)
        expect_panels(driver, COMPARISON_PANELS)
        expect_pan_and_zoom(driver)
        clip = "return [...document.querySelectorAll('.leaflet-left-pane, .leaflet-right-pane')].map((p) => p.style.clip)"
        before = driver.execute_script(clip)
        driver.execute_script("""const slider = document.querySelector('.split');
          slider.value = 200; slider.dispatchEvent(new Event('input'));""")
        after = driver.execute_script(clip)
        expect(len(before) == 2 and before[0] != after[0] and before[1] != after[1], f"the slider does nothing: {after}")
        expect(len(driver.find_elements(By.CSS_SELECTOR, ".leaflet-image-layer")) == 2, "there are not two maps")
        driver.find_elements(By.CSS_SELECTOR, "#map select")[1].find_element(By.CSS_SELECTOR, "option:last-child").click()
        take_picture(driver, os.path.join(folder, "compare.png"))
        expect_quiet(driver)
    with browser(PHONE) as driver:
        open_page(driver, file)
        expect_no_overflow(driver)
        expect_panels(driver, COMPARISON_PANELS)
        expect_quiet(driver)


def main():
    program, source, work = sys.argv[1:]
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)

    def run(*arguments):
        subprocess.run([program, *arguments, "--quiet"], check=True, timeout=240)

    def path(name):
        return os.path.join(work, name)

    log = os.path.join(source, "rawlogs", "room.rawlog")
    run("map", log, "-o", path("room"), "--set", "submaps.max_distance=4")
    check_report(path("room/report.html"), work)
    run("join", path("room/submaps.rawlog"), "-o", path("hostile"), "--set", "joining.chain=", "--set",
        "reader.sensor_labels=</script><b>x")
    check_hostile_setting(path("hostile/report.html"))
    with open(path("landmarks.txt"), "w", encoding="utf-8") as text:
        text.write(landmark_submaps())
    run("join", path("landmarks.txt"), "-o", path("landmarks"))
    check_landmark_report(path("landmarks/report.html"), work)
    run("compare", path("room"), path("hostile"), "-o", path("comparison"))
    check_comparison(path("comparison/compare.html"), work)
    print(json.dumps({"pictures": work}))


def landmark_submaps(sides=8, side_m=10):
    """A drive round a polygon with a landmark at each corner; each submap sees three of them."""
    turn = 2 * math.pi / sides
    text = ""
    for k in range(sides):
        state = [(0, side_m), (0, 0), (0, turn)]
        for corner in range(3):
            beyond = corner - 1
            x = 0 if corner == 0 else side_m * (1 + beyond * math.cos(turn))
            y = side_m * math.sin(turn) if corner == 2 else 0
            state += [(1 + (k + corner) % sides, x), (1 + (k + corner) % sides, y)]
        text += f"MAP {k + 1} {len(state)}\n"
        text += "".join(f"{name} {value!r}\n" for name, value in state)
        text += "".join(" ".join("1e-4" if i == j else "0" for j in range(i + 1)) + "\n" for i in range(len(state)))
    return text


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"FAILED: {failure}")
