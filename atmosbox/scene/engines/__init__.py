"""Which engine advances the molecules, and with which options.

An engine is chosen by its name, and its options by their values after a colon, as in
``stepped:delta=0.02,motion=euler``. The same words stand on the command line, in a settings file and in
the output.
"""

from atmosbox.scene.engines.declared import ENGINES, Engine
from atmosbox.scene.engines.engine_choice import EXACT, FEW, EngineChoice, choose, names, suited, used

__all__ = ["ENGINES", "EXACT", "FEW", "Engine", "EngineChoice", "choose", "names", "suited", "used"]
