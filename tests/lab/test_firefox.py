"""The page in Firefox: another compiler of WebAssembly gives the same bytes."""

import pytest

from atmosbox.lab import save_lab
from atmosbox.lab.wasm_module import SCENES
from atmosbox.simulation.preparation import build, prepare
from tests.lab.firefox import Firefox, firefox_command
from tests.lab.test_browser import advance, state_of

SMALL = {
    "temperature": ({"molecules": 150}, 20),
    "lifting-dry": ({"molecules": 300, "ascent": 30}, 40),
    "evaporation": ({"molecules": 200, "pool": 60}, 20),
}
WHEN_IT_IS = "new Promise(done => {{ const look = () => {0} ? done({0}) : setTimeout(look, 50); look(); }})"
ASK = "document.dispatchEvent(new CustomEvent('ask', {{detail: {0}}}))"


@pytest.fixture(scope="module")
def firefox(tmp_path_factory):
    """A Firefox on a screen."""
    if firefox_command() is None:
        pytest.skip("no Firefox with a screen: install firefox-esr and xvfb, or name one in ATMOSBOX_FIREFOX")
    shown = Firefox(tmp_path_factory.mktemp("firefox"))
    yield shown
    shown.close()


@pytest.mark.parametrize("scene", SMALL)
def test_firefox_has_the_same_bytes_as_python(firefox, tmp_path, scene):
    settings, frames = SMALL[scene]
    prepared = prepare(scene, SCENES[scene] | settings, engine="exact")
    firefox.open(save_lab(prepared, tmp_path / "lab.html", others=False))
    firefox.evaluate(WHEN_IT_IS.format("document.body.dataset.ready"))
    firefox.evaluate(ASK.format(f"{{type: 'frames', value: {frames}}}"))
    firefox.evaluate(ASK.format("{type: 'digest'}"))
    found = firefox.evaluate(WHEN_IT_IS.format("document.body.dataset.digest"))
    setup = build(prepared)
    advance(setup, frames)
    assert setup.parcel.contacts > 200
    assert found == state_of(setup.parcel)
    assert not firefox.faults
