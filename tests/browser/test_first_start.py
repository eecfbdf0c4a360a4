"""The explorer with nothing compiled: the page is there at once, and each figure when its kernels are."""

import os
import re
import signal
import subprocess
import sys

import psutil
import pytest

WAITS = "name => Boolean(document.getElementById(name).dataset.waits)"
NO_LONGER = "name => document.getElementById(name).dataset.waits === ''"


@pytest.fixture
def cold(tmp_path):
    """Run an explorer that finds no machine code."""
    command = [sys.executable, "-m", "rocking", "explore", "--port", "0", "--no-browser"]
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path), "ROCKING_FORCE_JIT": "1"}
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        yield process, process.stdout.readline().split()[0]
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=20)[1]
    assert (process.returncode, errors) == (0, "")
    for each in psutil.process_iter(["cmdline"]):  # the builders, which would go on for a minute
        if any(str(tmp_path) in word for word in each.info["cmdline"] or ()):
            each.kill()


def opened(browser, address):
    """Return a page that is there and waits for its machine code."""
    page = browser.new_context(viewport={"width": 1280, "height": 820}, bypass_csp=True).new_page()
    page.set_default_timeout(300_000)
    page.goto(address)
    page.wait_for_selector("body[data-ready]")
    return page


@pytest.mark.long
def test_figures_of_both_pages_appear_one_after_another(cold, browser):
    """Both are opened together: what the second needs takes minutes more if all is compiled again."""
    page, second = opened(browser, cold[1]), opened(browser, cold[1].replace("?", "ground-motion?"))
    second.wait_for_function(WAITS, arg="map")
    assert second.inner_text("#kind") == "Compiling …"
    assert second.inner_text("#pga") == "PGA 0.532 g"
    page.wait_for_function(WAITS, arg="history")
    assert re.fullmatch(r"Compiling, once for this machine: \d+ %", page.inner_text("#progress"))
    assert page.inner_text("#kind") == "Compiling …"
    page.wait_for_function(NO_LONGER, arg="history")
    assert page.evaluate(WAITS, "map")
    assert page.evaluate("film.time.length") > 9
    page.wait_for_selector("#verdict:not(.stale)")
    assert page.inner_text("#kind") == "periodic"
    page.wait_for_function("document.body.dataset.map === 'done'")
    page.wait_for_function(NO_LONGER, arg="basin")
    page.wait_for_function("document.getElementById('progress').textContent === ''")
    page.wait_for_function("!Object.keys(models).some(name => document.getElementById(name).dataset.waits)")
    second.wait_for_selector("#verdict:not(.stale)")
    assert second.inner_text("#kind") == "rocks and stands"
    second.wait_for_function("document.body.dataset.map === 'done'")


@pytest.mark.long
def test_control_c_ends_an_explorer_that_waits_for_kernels(cold, browser):
    """The fixture sends it and expects the end soon."""
    page = browser.new_context(bypass_csp=True).new_page()
    page.goto(cold[1])
    page.wait_for_selector("body[data-ready]")
    page.wait_for_function(WAITS, arg="map")
