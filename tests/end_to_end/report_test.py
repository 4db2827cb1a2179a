#!/usr/bin/env python3
"""report.html, compare.html and experiment.html as a reader sees them: report_test.py PROGRAM SOURCE_DIR WORK_DIR"""
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
EXPERIMENT_PANELS = ("failed", "table", "plot-errors", "plot-seeds", "plot-missing", "plot-never", "plot-paths-0", "cells",
                     "made")
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


EXPERIMENT = """[experiment]
title = </script><b>Sight and hearing
data = hall
settings = odometry, chain, deaf
seeds = 1, 18446744073709551615
columns = mae_m, submaps
[data hall]
world = non_convex
simulation.beams = 90
simulation.max_scans = 40
[setting odometry]
baseline = odometry
[setting chain]
joining.chain =
[setting deaf]
reader.sensor_labels = SONAR
[plot errors]
title = Error of the poses
y = mae_m
[plot seeds]
x = seed
y = mae_m
kind = lines
[plot missing]
y = gps_rmse_m
[plot never]
x = time
y = ci_frames
kind = lines
[plot paths]
kind = path
"""


def check_experiment(file, folder):
    """Tables, plots, errors of failed cells, and how all was made."""
    with browser(DESKTOP) as driver:
        open_page(driver, file)
        expect_panels(driver, EXPERIMENT_PANELS)
        title = driver.find_element(By.TAG_NAME, "h1").text
        expect(title == "</script><b>Sight and hearing", f"the title is {title}")
        check_experiment_tables(driver)
        check_bars(driver)
        take_picture(driver, os.path.join(folder, "experiment.png"))
        expect_quiet(driver)
    with browser(PHONE, dark=True) as driver:
        open_page(driver, file)
        expect_no_overflow(driver)
        expect_panels(driver, EXPERIMENT_PANELS)
        take_picture(driver, os.path.join(folder, "experiment_phone.png"))
        expect_quiet(driver)


def check_experiment_tables(driver):
    results, cells = rows(driver, "table"), rows(driver, "cells")
    expect(len(results) == 3 and len(cells) == 6, f"{len(results)} rows and {len(cells)} cells")
    expect("±" in results[1].text and "±" not in results[2].text, f"means are wrong: {[r.text for r in results]}")
    expect(cells[1].text.split()[2] == "18446744073709551615", f"the seed is rounded: {cells[1].text}")
    expect("SONAR" in cells[4].text and "SONAR" not in cells[2].text, "errors are not with their cells")
    failures = driver.find_elements(By.CSS_SELECTOR, "#failed li")
    expect(len(failures) == 2 and "hall, deaf, seed 1: " in failures[0].text, "failures are not listed")
    driver.find_element(By.CSS_SELECTOR, "#table th:nth-child(4) button").click()
    first = rows(driver, "table")[0].text
    expect("odometry" in first, f"sorting by the error puts {first} first")
    made = driver.find_element(By.ID, "made").text
    for text in ("submap-slam", "build", "MRPT", "[setting deaf]", "18446744073709551615"):
        expect(text in made, f"'{text}' is not in how it was made")


def check_bars(driver):
    """Where odometry has its bar there is colour, where the deaf setting would have one there is none."""
    shares = driver.execute_script("""
      const canvas = document.querySelector('#plot-errors canvas'), box = document.querySelector('#plot-errors .u-over');
      const scale = canvas.width / canvas.getBoundingClientRect().width, at = box.getBoundingClientRect();
      const left = (at.x - canvas.getBoundingClientRect().x) * scale, top = (at.y - canvas.getBoundingClientRect().y) * scale;
      const copy = Object.assign(document.createElement('canvas'), {width: canvas.width, height: canvas.height})
        .getContext('2d', {willReadFrequently: true});
      copy.drawImage(canvas, 0, 0);
      return [0, 1, 2].map((place) => {
        const width = at.width * scale / 3, seen = copy.getImageData(
          left + (place + 0.3) * width, top, 0.4 * width, at.height * scale).data;
        let coloured = 0;
        for (let i = 0; i < seen.length; i += 4) if (seen[i + 3] > 0 && seen[i + 2] - seen[i] > 60) ++coloured;
        return coloured / (seen.length / 4);
      });""")
    expect(shares[0] > shares[1] > 0 and shares[0] > 0.3 and shares[2] == 0, f"bars fill {shares} of their places")


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
    with open(path("experiment.ini"), "w", encoding="utf-8") as text:
        text.write(EXPERIMENT)
    status = subprocess.run([program, "experiment", path("experiment.ini"), "-o", path("experiment"), "--quiet"],
                            stderr=subprocess.DEVNULL, timeout=240).returncode
    expect(status == 1, f"an experiment with failed cells ends with {status}")
    check_experiment(path("experiment/experiment.html"), work)
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
