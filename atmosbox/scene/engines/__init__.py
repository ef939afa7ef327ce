"""The engine that advances the molecules, and its options.

An engine is chosen by its name, and its options by their values after a colon, as in
``stepped:delta=0.02,motion=euler``. The command line, a settings file and the output all use this form.
"""

from atmosbox.scene.engines.declared import ENGINES, Engine
from atmosbox.scene.engines.engine_choice import EXACT, FEW, EngineChoice, choose, names, suited, used

__all__ = ["ENGINES", "EXACT", "FEW", "Engine", "EngineChoice", "choose", "names", "suited", "used"]
