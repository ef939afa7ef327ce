"""The tiers of the suite, and the fixtures that all tests share.

unmarked
    Everything that guards the code, a few minutes in all: ``python -m pytest``. Each physical law is held to
    the accuracy that its own sampling allows, with fixed seeds.
``@pytest.mark.nightly``
    Long statistical tests with smaller error bars, the site, pages of every scene at every size, copies of the package.
    They are left out unless asked for: ``--nightly`` runs them with the rest, ``-m nightly`` alone, and a test named by
    its node id (``file.py::test_name``) runs in any case.
``@pytest.mark.soak``
    Runs of an hour, by hand: ``-m soak``. ``--soak 0.001`` makes them a thousandth as long, ``--soak-report FILE``
    writes their results to a file, line by line.

``--fuzz 100`` tries a hundred times as many random examples in the tests with hypothesis, other ones each time; with
``--soak-report FILE`` it writes how many there were.

Timings are never tests; they live in ``benchmarks/``. Every warning is an error.
"""

import functools
import gc
import json
import os
import shutil
import signal
import sys
import time

import pytest
from hypothesis import settings

os.environ.setdefault("MPLBACKEND", "agg")
# One thread, as for the command line: threads of linear algebra wait for each other, and the workers have the cores.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# Python looks less often than usual for objects that refer to each other and to which nothing else refers: to compile a
# kernel takes a twentieth less.
gc.set_threshold(100_000, 50, 100)

# No deadline, since a kernel's first call compiles it; and no random seed, so that two runs test the same.
settings.register_profile("atmosbox", deadline=None, derandomize=True)
settings.load_profile("atmosbox")


def pytest_addoption(parser):
    parser.addoption("--nightly", action="store_true", help="also run the long tests")
    parser.addoption("--soak", type=float, default=1.0, help="length of the soak tests, as a share of the full one")
    parser.addoption("--soak-report", default=None, help="file to which soak and fuzz add figures, line by line")
    parser.addoption("--fuzz", type=int, default=1, help="how many times as many examples hypothesis tries")


def pytest_collection_modifyitems(config, items):
    named = any("::" in argument for argument in config.args)
    more = config.getoption("--fuzz")
    if more > 1:
        # once each, also where several items are cases of one function
        for test in {getattr(item, "obj", None) for item in items}:
            test = getattr(test, "__func__", test)
            stated = getattr(test, "_hypothesis_internal_use_settings", None)
            if stated is not None:
                test._hypothesis_internal_use_settings = settings(
                    stated, max_examples=more * stated.max_examples, derandomize=False
                )
    if config.getoption("-m") or named:
        return
    wanted = {"soak"} if config.getoption("--nightly") else {"soak", "nightly"}
    left_out = [item for item in items if any(item.get_closest_marker(tier) for tier in wanted)]
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if item not in left_out]


def pytest_collection_finish(session):
    """Exempt all objects loaded so far from the garbage collector, which would check them hundreds of times."""
    gc.collect()
    gc.freeze()


def pytest_sessionfinish(session):
    if hasattr(session.config, "workeroutput"):
        unlisted(session.config)
        session.config.workeroutput["modes"] = sorted(_used)
    report = session.config.getoption("--soak-report")
    if report and "tests.fuzz_case" in sys.modules:
        said = {"fuzz": dict(sys.modules["tests.fuzz_case"].CASES), "cpu_seconds": round(time.process_time(), 1)}
        with open(report, "a", encoding="utf-8") as file:
            file.write(json.dumps(said) + "\n")


COMPILING = (
    "test_sheet", "test_engines", "test_extremes", "test_same_run", "test_stepped", "test_wells", "test_parcelset",
    "test_attraction_scene", "test_square_well",
)  # fmt: skip
"""Files that compile most kernels: the second kernel of an engine takes half as long in the process of the first."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """Give all tests of a file to one worker, which share the run of a fixture, and so those of all `COMPILING`."""
    from xdist.scheduler import LoadFileScheduling

    class ByKernels(LoadFileScheduling):
        def _split_scope(self, nodeid):
            file = super()._split_scope(nodeid)
            return "compiling" if os.path.basename(file)[:-3] in COMPILING else file

    return ByKernels(config, log) if config.getoption("dist") == "load" else None


MODES = {
    "contacts rows": "equal molecules between walls, and in a plane: the scene temperature",
    "contacts mixed rows": "molecules of several kinds: elastic-collisions",
    "contacts periodic rows": "a periodic box: diffusion of gases alike",
    "contacts gravity rows": "gravity between walls: convection",
    "contacts gravity periodic rows": "a column: atmosphere",
    "contacts rotation piston ascends rows": "air that rises: lifting-dry",
    "contacts rotation mixed phases rows": "a mist: condensation",
    "contacts rotation mixed piston phases ascends rows": "a cloud that rises: lifting-moist, mountains",
    "contacts rotation mixed piston phases pool ascends rows": "a pool under a piston: evaporation",
    "contacts rotation mixed phases drops=2 rows": "drops: nuclei",
    "contacts gravity piston rows": "a piston that a driver moves",
    "contacts gravity rotation mixed periodic piston rows": "all features that go together",
    "contacts rotation mixed spanning periodic images": "spheres larger than cells, in a box that is hardly larger",
}
"""The sets of modes of the exact engine whose kernels unmarked tests compile; each takes five to twenty seconds.

A test of another box uses one of these (gravity so weak, or masses so close, that nothing changes), or is marked
nightly. A session that used others names them at its end.
"""
_kernels, _used = {}, set()


def pytest_sessionstart(session):
    """Note the kernels of every set of modes."""
    from atmosbox.engine.exact import parcelset
    from atmosbox.engine.liquid import drop, moist

    def noting(specialise):
        def kernels(modes):
            made = specialise(modes)
            flags = (name if value is True else f"{name}={value}" for name, value in modes._asdict().items() if value)
            _kernels[specialise, " ".join(flags)] = made[1]
            return made

        return kernels

    for module in (parcelset, moist, drop):
        module.specialise = noting(module.specialise)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node, error):
    """Collect what a worker has used."""
    _used.update(getattr(node, "workeroutput", {}).get("modes", ()))


def unlisted(config):
    """Return the sets of modes that unmarked tests have used and that are not in the table."""
    _used.update(name for (_, name), kernel in _kernels.items() if getattr(kernel, "signatures", ()))
    asked = config.getoption("-m") or config.getoption("--nightly") or any("::" in each for each in config.args)
    return [] if asked else sorted(_used - set(MODES))


def pytest_terminal_summary(terminalreporter, config):
    """Name what has to be listed, or marked nightly."""
    for name in unlisted(config):
        said = name or "points that do not rotate"
        terminalreporter.write_line(f"not among the sets of modes in tests/conftest.py: {said}")


BROWSER_FLAGS = [
    "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking", "--disable-sync",
    "--disable-component-update", "--disable-quic", "--enable-unsafe-swiftshader", "--use-gl=angle",
    "--use-angle=swiftshader",
]  # fmt: skip
BROWSERS = ("chromium", "chromium-browser", "google-chrome")


def name_of_browser():
    """Return the browser that `ATMOSBOX_BROWSER` names, else one of this computer; None if there is none."""
    wanted = os.environ.get("ATMOSBOX_BROWSER")
    return wanted or next((found for name in BROWSERS if (found := shutil.which(name))), None)


@pytest.fixture(scope="session", autouse=True)
def interruptible():
    """Let SIGINT and SIGHUP reach this process and those it starts, also if whoever started the suite has them ignored.

    A shell without job control, or nohup, starts what it leaves in the background so.
    """
    for name, usual in (("SIGINT", signal.default_int_handler), ("SIGHUP", signal.SIG_DFL)):
        number = getattr(signal, name, None)  # Windows has no SIGHUP
        if number is not None and signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, usual)


@pytest.fixture(scope="session")
def browser():
    """A Chromium without a window, for all tests.

    Without a browser they are skipped; where `ATMOSBOX_BROWSER` names one, as `.ci/run` does, it must be there.
    """
    path = name_of_browser()
    if path is None:
        pytest.skip("no browser: install chromium (apt-get install chromium), or name one in ATMOSBOX_BROWSER")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=path, args=BROWSER_FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture(scope="module")
def new_tab(browser):
    """A function that opens a tab of some size, with the options of a browser's context."""
    opened = []

    def make(size=(1280, 720), **options):
        opened.append(browser.new_context(viewport={"width": size[0], "height": size[1]}, **options))
        return opened[-1].new_page()

    yield make
    for context in opened:
        context.close()


@pytest.fixture(scope="module")
def usual_tab(new_tab):
    """The tab in which a file shows one page after the other: to start a tab takes longer than to load a page."""
    return new_tab()


SMALL_RUNS = {
    "temperature": {"molecules": 60, "duration": 2.0},
    "lifting-dry": {"molecules": 60, "ascent": 20.0},
    "atmosphere": {"molecules": 80},
    "elastic-collisions": {"molecules": 20, "duration": 3.0},
}


@pytest.fixture(scope="session")
def small_run():
    """A function that makes a short run of a scene with its molecules, once for all tests; a test gets its own copy."""

    @functools.cache
    def made(scene):
        import atmosbox

        return atmosbox.run(scene, save_molecules=True, **SMALL_RUNS[scene])

    return lambda scene: made(scene).copy(deep=True)


@pytest.fixture(scope="module")
def runs(small_run):
    """All short runs, by scene."""
    return {scene: small_run(scene) for scene in SMALL_RUNS}
