"""The flags of a set of modes as constants, known to numba before it compiles anything.

`Modes` is a type of its own for each set of flags, so that a kernel which is given one is compiled for just that set.
"""

from typing import Any

from numba.core import ir_utils, types
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import FunctionPass, register_pass
from numba.core.ir import Arg, Assign, Const, Expr, FreeVar, Global
from numba.core.untyped_passes import RewriteSemanticConstants
from numba.extending import NativeValue, models, register_model, typeof_impl, unbox

from atmosbox.engine.core.state import Modes

__all__ = ["KernelCompiler"]


class _SetOfModes(types.Dummy):
    """The type of one set of `Modes`: every flag of it is known before a kernel is compiled."""

    def __init__(self, modes: Modes) -> None:
        self.modes = modes
        super().__init__(name=repr(modes))


@typeof_impl.register(Modes)
def _type_of_modes(modes: Modes, _: Any) -> _SetOfModes:
    return _SetOfModes(modes)


register_model(_SetOfModes)(models.OpaqueModel)


@unbox(_SetOfModes)
def _unbox_modes(kind: Any, _: Any, passed: Any) -> NativeValue:
    return NativeValue(passed.context.get_dummy_value())


@register_pass(mutates_CFG=False, analysis_only=False)
class _WriteOutModes(FunctionPass):  # type: ignore[misc]
    """Writes each flag of the modes into the code as the constant that it is.

    The branches of features that a scene leaves out are then dropped before anything is compiled; left to the
    optimiser, which sees the constants only after everything has been inlined, they take most of its time.
    """

    _name = "write_out_modes"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        """Go through the code of a function whose arguments have the types ``state.args``."""
        code = state.func_ir
        for block in code.blocks.values():
            for line in block.find_insts(Assign):
                if isinstance(line.value, Expr) and line.value.op == "getattr":
                    source = ir_utils.guard(ir_utils.get_definition, code, line.value.value)
                    modes = None
                    if isinstance(source, Arg):
                        modes = getattr(state.args[source.index], "modes", None)
                    elif isinstance(source, FreeVar | Global) and isinstance(source.value, Modes):
                        modes = source.value
                    if modes is not None:
                        known = Const(getattr(modes, line.value.attr), line.loc)
                        definitions = code._definitions[line.target.name]
                        definitions[definitions.index(line.value)] = known
                        line.value = known
        return True


class KernelCompiler(Compiler):  # type: ignore[misc]
    """numba's compiler, with `_WriteOutModes` before it looks for branches that are never taken."""

    def define_pipelines(self) -> list[Any]:
        """Return the passes that a function goes through."""
        pipelines: list[Any] = super().define_pipelines()
        for pipeline in pipelines:
            pipeline.add_pass_after(_WriteOutModes, RewriteSemanticConstants)
            pipeline.finalize()
        return pipelines
