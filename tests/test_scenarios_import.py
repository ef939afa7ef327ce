"""The scenarios are found by their names, and a lecturer's own file works like them.

That an installed wheel finds them is tried by .ci/run, which builds one and runs it from another folder.
"""

import pytest

from atmosbox import scenarios
from atmosbox.errors import UnknownSceneError

OWN_SCENE = """
from dataclasses import dataclass

@dataclass
class Settings:
    molecules: int = 100

def build(settings): ...
def theory(dataset): ...

headlines = ()
panels = ()
"""


def test_an_unknown_scenario_offers_the_nearest_ones():
    for name in ("lifting-dri", "Lifting-Dry", "lifting"):
        with pytest.raises(UnknownSceneError, match=f"{name}.*lifting-dry.*atmosbox.scenes"):
            scenarios.load(name)


def test_an_edited_own_file_is_read_anew(tmp_path):
    path = tmp_path / "my_scene.py"
    for molecules in (100, 200, 300):
        path.write_text(OWN_SCENE.replace("100", str(molecules)), encoding="utf-8")
        assert scenarios.load(path).Settings().molecules == molecules
