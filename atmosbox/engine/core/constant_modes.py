"""The flags of a set of modes as constants that numba knows before it compiles a kernel.

Each set of flags is a numba type of its own, so that a kernel which is given `Modes` is compiled for just that set.
A kernel that other kernels call is compiled for the flags that it reads alone: boxes that differ only in other flags
share it.
"""

import dis
import functools
import inspect
from collections.abc import Callable
from itertools import pairwise
from typing import Any

from numba.core import ir_utils, types
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import FunctionPass, register_pass
from numba.core.ir import Arg, Assign, Const, Expr, FreeVar, Global
from numba.core.typeconv import Conversion
from numba.core.untyped_passes import RewriteSemanticConstants
from numba.extending import NativeValue, lower_cast, models, register_model, typeof_impl, unbox

from atmosbox.engine.core.state import Modes

__all__ = ["KernelCompiler", "for_flags_read"]


class _SetOfModes(types.Dummy):
    """The numba type of one set of `Modes`: all its flags are known before a kernel is compiled."""

    def __init__(self, modes: Modes) -> None:
        self.modes = modes
        super().__init__(name=repr(modes))

    def can_convert_to(self, _: Any, other: Any) -> Any:
        """Tell numba that a kernel may be given more flags than it reads."""
        return Conversion.safe if isinstance(other, _SetOfModes) else None


@typeof_impl.register(Modes)
def _type_of_modes(modes: Modes, _: Any) -> _SetOfModes:
    return _SetOfModes(modes)


register_model(_SetOfModes)(models.OpaqueModel)


@unbox(_SetOfModes)
def _unbox_modes(kind: Any, _: Any, passed: Any) -> NativeValue:
    return NativeValue(passed.context.get_dummy_value())


@lower_cast(_SetOfModes, _SetOfModes)
def _leave_out_flags(_context: Any, _builder: Any, _from: Any, _to: Any, value: Any) -> Any:
    return value  # a set of modes takes no memory in compiled code


@functools.cache
def _flags_read(function: Callable[..., Any]) -> frozenset[str]:
    """Return the flags that a kernel reads, itself or in the kernels that it calls."""
    flags = set()
    # an attribute that is loaded just after the modes; some versions of Python load two names at once
    for before, line in pairwise(dis.get_instructions(function)):
        loaded = before.argval if isinstance(before.argval, tuple) else (before.argval,)
        if line.opname == "LOAD_ATTR" and loaded[-1:] == ("modes",):
            flags.add(line.argval)
    # and the flags that the kernels read which it calls
    seen = inspect.getclosurevars(function)
    for named in (*seen.globals.values(), *seen.nonlocals.values()):
        called = getattr(named, "py_func", None)
        if called is not None:
            flags |= _flags_read(called)
    return frozenset(flags)


def for_flags_read(function: Callable[..., Any], kind: Any) -> Any:
    """Return the type for which a kernel is compiled when its argument has the type ``kind``."""
    if not isinstance(kind, _SetOfModes):
        return kind
    return _SetOfModes(kind.modes.without(*set(Modes._fields) - _flags_read(function)))


@register_pass(mutates_CFG=False, analysis_only=False)
class _WriteOutModes(FunctionPass):  # type: ignore[misc]
    """Replaces each flag of the modes in the code by its constant value.

    The branches of features that a scene does not use are then dropped before anything is compiled. If they were left
    to the optimiser, which sees the constants only after everything has been inlined, it would spend most of its time
    on them.
    """

    _name = "write_out_modes"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        """Replace the flags in the code of a function whose arguments have the types ``state.args``."""
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
                        flag = getattr(modes, line.value.attr)
                        if flag is None:
                            raise AttributeError(f"{line.loc}: {line.value.attr} is one of the modes this does without")
                        known = Const(flag, line.loc)
                        definitions = code._definitions[line.target.name]
                        definitions[definitions.index(line.value)] = known
                        line.value = known
        return True


class KernelCompiler(Compiler):  # type: ignore[misc]
    """numba's compiler, with `_WriteOutModes` before it removes branches that are never taken."""

    def define_pipelines(self) -> list[Any]:
        """Return the passes that a function goes through."""
        pipelines: list[Any] = super().define_pipelines()
        for pipeline in pipelines:
            pipeline.add_pass_after(_WriteOutModes, RewriteSemanticConstants)
            pipeline.finalize()
        return pipelines
