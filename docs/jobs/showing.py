"""What a class is shown: the page of a run, as a browser draws it, and two runs in one figure."""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from jobs.registry import Findings, job

import atmosbox
from atmosbox.page import save
from atmosbox.plot.compare import compared, drawn, naming
from atmosbox.text.report import comparison_lines

WIDTH, HEIGHT = 1280, 720
FLAGS = "--no-sandbox --disable-gpu --disable-background-networking --enable-unsafe-swiftshader --use-angle=swiftshader"


@job("compared")
def warm_and_cold(found: Findings) -> None:
    """Lift warm and cold air."""
    files = ["cold.nc", "warm.nc"]
    runs = [atmosbox.run("lifting-dry", temperature=f"{celsius} degC") for celsius in (5, 25)]
    names = naming(runs, [Path(file).stem for file in files])
    table = "\n".join(comparison_lines(files, names, compared(runs), 100))
    found.text(f"```console\n$ atmosbox compare cold.nc warm.nc\n{table}\n```")
    found.figure(drawn(runs, names, "notes"), "compared", 115)


def browser_of(playwright):
    """Return a browser without a window."""
    named = (os.environ.get("ATMOSBOX_BROWSER"), shutil.which("chromium"), shutil.which("google-chrome"))
    return playwright.chromium.launch(executable_path=next(filter(None, named), None), args=FLAGS.split())


@job("lab")
def lab(found: Findings) -> None:
    """Open a box that runs, turn its walls from 30 to 10 degrees, and look at it some seconds later."""
    from playwright.sync_api import sync_playwright

    # so many that there is a hygrometer at 10 degrees, too
    many = ["--set", "molecules=6000", "--set", "pool=1200"]
    words = [sys.executable, "-m", "atmosbox", "live", "evaporation", *many, "--no-browser", "--quiet"]
    with (
        tempfile.TemporaryDirectory() as folder,
        sync_playwright() as playwright,
        subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, text=True) as served,
    ):
        browser = browser_of(playwright)
        shown = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT}, locale="en-GB")
        shown.goto(served.stdout.readline().strip())
        shown.wait_for_selector("body[data-playing=true]", timeout=120_000)
        shown.wait_for_timeout(15_000)
        slider = shown.get_by_role("slider", name="temperature").first
        slider.fill("10")
        slider.dispatch_event("change")
        shown.wait_for_timeout(15_000)
        found.picture(shown.screenshot(), "live")
        browser.close()
        served.terminate()


@job("page")
def page(found: Findings) -> None:
    """Open the page of a run in a browser, two thirds through."""
    from playwright.sync_api import sync_playwright

    run = atmosbox.run("condensation", save_molecules=True, molecules=1500, drops=6, humidity=400, duration="60 ns")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        file = save([run], Path(folder, "page.html"))
        browser = browser_of(playwright)
        shown = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT}, reduced_motion="reduce")
        shown.goto(file.as_uri())
        shown.wait_for_selector("body[data-ready]")
        shown.locator("input[type=range]").first.fill("170")
        shown.get_by_role("button", name="Kind").click()
        shown.wait_for_timeout(1500)
        found.picture(shown.screenshot(), "page")
        browser.close()
