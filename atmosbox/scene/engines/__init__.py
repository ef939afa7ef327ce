"""Which engine lets time pass, and with which options: declared once, checked once.

An engine is asked for by its name, and where it has options by their values behind a colon, as in
``stepped:delta=0.02,motion=euler``. The same words stand on the command line, in a settings file and in
the output.
"""

from atmosbox.scene.engines.declared import ENGINES, Engine
from atmosbox.scene.engines.engine_choice import EXACT, EngineChoice, choose, names, used

__all__ = ["ENGINES", "EXACT", "Engine", "EngineChoice", "choose", "names", "used"]
