"""How numba compiles a kernel; this file is imported when a kernel is first called.

All that atmosbox takes of numba and llvmlite beyond their documented interface stands here. A new release of numba may
change any of it; a weekly job tries the newest. Gains were measured with numba 0.68: the time to compile `temperature`,
`lifting-dry` and `evaporation`, and the pace of 2,000 to 50,000 molecules.

===================  ==================================================  ==============================================
part                 what it gains                                       what to do when it breaks
===================  ==================================================  ==============================================
`_KeptKernels`       code that another user or a bad disk has changed    set ``cache=True`` and warn of foreign folders
                     is not run; processes do not compile the same
                     kernel at once
`_SetOfModes`        what a scene leaves out is not compiled             give each kernel its flags as closed-over names
`_of_plain_types`    one version for all whole numbers and for all       leave it out: more versions are compiled
                     modes that a kernel does not read
no wrappers          compiling takes a sixth less                        leave out the two options
`by_reference`       compiling takes up to an eighth less                return the NamedTuple itself
`prefetch`           the pace of 50,000 molecules is 5 to 10 % higher    let it do nothing
`screen_of`          the pace is 1.3 to 1.6 times as high                compile `rows.screen` as a loop
`lowest_bit`         one instruction in place of a loop                  shift and count
`LlvmText`           the kernels of the lab page                         only ``tools/wasm.py`` needs it
===================  ==================================================  ==============================================
"""

import contextlib
import dis
import functools
import hashlib
import inspect
import pickle
import sys
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import llvmlite.ir as ir
import numba
from numba.core import caching, cgutils, codegen, compiler, config, ir_utils, types
from numba.core.compiler_lock import global_compiler_lock
from numba.core.compiler_machinery import FunctionPass, register_pass
from numba.core.imputils import lower_getattr_generic
from numba.core.ir import Arg, Assign, Const, Expr, FreeVar, Global
from numba.core.registry import cpu_target
from numba.core.serialize import dumps
from numba.core.typeconv import Conversion
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.core.untyped_passes import RewriteSemanticConstants
from numba.extending import NativeValue, intrinsic, lower_cast, models, register_model, typeof_impl, unbox

from atmosbox.engine.core.kernel_cache import announce, cache_folder, excused, keep, own_content, own_folder
from atmosbox.engine.core.state import Modes

if sys.platform != "win32":
    import fcntl

prange = numba.prange
"""The ``range`` of a loop whose iterations a ``parallel`` kernel shares among threads."""

# No "fastmath" option, not even the fusing of products and sums, which only some processors have: results are the
# same to the last bit on all processors.
_SHARED: dict[str, Any] = {"error_model": "numpy"}
_CACHE = cache_folder()
_TRIES, _PAUSE = 2400, 0.05  # together the longest compilation [seconds]
_CHECK = hashlib.sha256().digest_size  # bytes


class _KeptKernels(caching.FunctionCache):  # type: ignore[misc]
    """The machine code of a kernel on disk: a file with a checksum for each version of it.

    numba would run what any user has written to the folder, and machine code in which the disk has changed a bit. Here
    one process compiles what is not there while the others wait. The name of the folder holds the digest of all
    sources, so no file needs a time stamp.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._py_func = function
        self._folder = own_folder(_CACHE / function.__module__)  # type: ignore[operator]
        self._lock: Any = None

    @property
    def cache_path(self) -> str:
        """The folder, for numba's statistics."""
        return str(self._folder)

    def _path(self, key: Any) -> Path:
        """Return the path of the file of a version."""
        digest = hashlib.sha256(repr(key).encode()).hexdigest()[:16]
        return self._folder / f"{self._py_func.__name__}.{digest}.nbc"

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the machine code for some types, or None if it must be compiled; then announce the compilation."""
        target_context.refresh()
        key = self._index_key(sig, target_context.codegen())
        found = self._kept(key, target_context)
        if found is None and self._waits(self._path(key).with_suffix(".lock")):
            found = self._kept(key, target_context)
        if found is None:
            announce(self._py_func.__qualname__, True)
        else:
            self._let_others_go_on()
        return found

    def _kept(self, key: Any, target_context: Any) -> Any:
        """Return what is on disk, or None if it is missing, damaged or not ours: a damaged file may raise any error."""
        with excused():
            content = own_content(self._path(key))
            if hashlib.sha256(content[_CHECK:]).digest() == content[:_CHECK]:
                known, data = pickle.loads(content[_CHECK:])
                return compiler.CompileResult._rebuild(target_context, *data) if known == key else None
        return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the machine code for some types, if it can be written."""
        key = self._index_key(sig, data.codegen)
        content = dumps((key, data._reduce()))
        with excused():
            keep(self._path(key), hashlib.sha256(content).digest() + content)
        self._let_others_go_on()
        announce(self._py_func.__qualname__, False)

    def _waits(self, path: Path) -> bool:
        """Take the right to compile; return whether another process had it until now. It ends with a process."""
        self._let_others_go_on()
        if sys.platform != "win32":
            with excused():
                self._lock = path.open("wb")
                for tries in range(_TRIES):
                    with contextlib.suppress(BlockingIOError):
                        fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                        return tries > 0
                    time.sleep(_PAUSE)
        return False

    def _let_others_go_on(self) -> None:
        """Give up the right to compile."""
        if self._lock:
            self._lock.close()


# ---------------------------------------------------------------- flags that are known before a kernel is compiled


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


def _for_flags_read(function: Callable[..., Any], kind: Any) -> Any:
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


class _KernelCompiler(compiler.Compiler):  # type: ignore[misc]
    """numba's compiler, with `_WriteOutModes` before it removes branches that are never taken."""

    def define_pipelines(self) -> list[Any]:
        """Return the passes that a function goes through."""
        pipelines: list[Any] = super().define_pipelines()
        for pipeline in pipelines:
            pipeline.add_pass_after(_WriteOutModes, RewriteSemanticConstants)
            pipeline.finalize()
        return pipelines


# ---------------------------------------------------------------- compiling


def compiled(
    function: Callable[..., Any], *, entry: bool, early: bool, allocates: bool, parallel: bool, kept: bool = True
) -> Any:
    """Return a function compiled by numba, for the types of the arguments of each call: see `jit.kernel`.

    Python can call only an entry, and an entry can be ``kept`` on disk. For all others numba leaves out the wrappers
    through which Python and C would call them, which take a fifth of the compilation time.
    """
    options = _SHARED | {"_nrt": allocates, "parallel": parallel, "pipeline_class": _KernelCompiler}
    if early:
        return numba.njit(inline="always", **options)(function)
    options["no_cfunc_wrapper"] = True
    if not entry:
        return _of_plain_types(numba.njit(forceinline=True, no_cpython_wrapper=True, **options)(function))
    made = numba.njit(nogil=True, **options)(function)
    if kept and _CACHE is not None:
        with excused():
            made._cache = _KeptKernels(function)
    return made


def _of_plain_types(made: Any) -> Any:
    """Have a function compiled once for all whole numbers, not once for each constant in the source.

    The code is inlined, and the optimiser adapts it to each constant afterwards. Of the modes, the function gets only
    the flags that it reads, so that one version serves all boxes that differ in other flags.
    """
    template = made.get_call_template

    def plain(arguments: Any, keywords: Any) -> Any:
        plainest = (_for_flags_read(made.py_func, types.unliteral(each)) for each in arguments)  # type: ignore[attr-defined]
        return template(tuple(plainest), keywords)

    made.get_call_template = plain
    return made


def type_of(thing: Any) -> Any:
    """Return the numba type of a compiled function, for the code of other kernels."""
    cpu_target.typing_context.refresh()  # intrinsics of ours may have been imported since
    return cpu_target.typing_context.resolve_value_type(thing)


def use_threads(number: int) -> None:
    """Set the number of threads of parallel kernels, at most as many as this machine has."""
    numba.set_num_threads(min(number, config.NUMBA_NUM_THREADS))


# ---------------------------------------------------------------- boxes by reference, single instructions

_NAMED = (types.containers.NamedTuple, types.containers.NamedUniTuple)


class Reference(types.Type):
    """The numba type of a NamedTuple that kernels pass on by its address, not value by value."""

    def __init__(self, bundle: Any) -> None:
        self.bundle = bundle
        super().__init__(name=f"reference({bundle})")


@register_model(Reference)
class _ReferenceModel(models.PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager: Any, kind: Reference) -> None:
        super().__init__(manager, kind, manager.lookup(kind.bundle).get_value_type().as_pointer())


@infer_getattr
class _FieldsOfReference(AttributeTemplate):  # type: ignore[misc]
    key = Reference

    def generic_resolve(self, kind: Reference, name: str) -> Any:
        if name not in kind.bundle.fields:
            return None
        field = kind.bundle.types[kind.bundle.fields.index(name)]
        return Reference(field) if isinstance(field, _NAMED) else field


@lower_getattr_generic(Reference)
def _field_of_reference(context: Any, builder: Any, kind: Reference, value: Any, name: str) -> Any:
    index = kind.bundle.fields.index(name)
    place = cgutils.gep_inbounds(builder, value, 0, index)
    return place if isinstance(kind.bundle.types[index], _NAMED) else builder.load(place)


@intrinsic
def by_reference(typing_context, bundle):
    """Return a NamedTuple as a reference to it: see `jit.by_reference`."""
    signature = Reference(bundle)(bundle)

    def generate(context, builder, signature, arguments):
        return cgutils.alloca_once_value(builder, arguments[0])

    return signature, generate


@intrinsic
def prefetch(typing_context, array, index):
    """Ask the processor to bring ``array[index]`` (first axis) into its cache."""
    signature = types.void(array, types.int64)

    def generate(context, builder, signature, arguments):
        values = context.make_array(signature.args[0])(context, builder, arguments[0])
        offset = builder.mul(arguments[1], builder.extract_value(values.strides, 0))
        place = cgutils.pointer_add(builder, values.data, offset, ir.IntType(8).as_pointer())
        i32 = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [place.type, i32, i32, i32])
        function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0")
        builder.call(function, [place, i32(0), i32(3), i32(1)])
        return context.get_dummy_value()

    return signature, generate


@intrinsic
def lowest_bit(typing_context, bits):
    """Return the number of the lowest bit that is set; there must be one."""
    signature = types.int64(types.int64)

    def generate(context, builder, signature, arguments):
        return builder.cttz(arguments[0], ir.Constant(ir.IntType(1), 1))

    return signature, generate


def screen_of(size, tiny):
    """Return `rows.screen` in vector instructions, for ``size`` copies at once."""

    @intrinsic
    def screen(typing_context, values, first, mixed, place, velocity, since, slack, within):
        single = types.float32
        signature = types.int64(
            values, types.int64, types.boolean, types.UniTuple(single, 3), types.UniTuple(single, 3), single,
            types.UniTuple(single, 3), single,
        )  # fmt: skip

        def generate(context, builder, signature, arguments):
            array = context.make_array(signature.args[0])(context, builder, arguments[0])
            vector = ir.VectorType(ir.FloatType(), size)
            nothing = ir.Constant(vector, ir.Undefined)
            first = ir.Constant(ir.VectorType(ir.IntType(32), size), [0] * size)
            zero = ir.Constant(vector, [0.0] * size)
            fused = cgutils.get_or_insert_function(
                builder.module, ir.FunctionType(vector, [vector] * 3), f"llvm.fmuladd.v{size}f32"
            )

            def spread(value):
                one = builder.insert_element(nothing, value, ir.Constant(ir.IntType(32), 0))
                return builder.shuffle_vector(one, nothing, first)

            def part(which, k):
                return spread(builder.extract_value(arguments[which], k))

            def load(k):
                place = builder.gep(array.data, [builder.add(arguments[1], ir.Constant(ir.IntType(64), k * size))])
                value = builder.load(builder.bitcast(place, vector.as_pointer()))
                value.align = 4
                return value

            def product(a, b, start=None):
                total = builder.fmul(a[0], b[0]) if start is None else builder.call(fused, [a[0], b[0], start])
                for k in (1, 2):
                    total = builder.call(fused, [a[k], b[k], total])
                return total

            since, within = spread(arguments[5]), spread(arguments[7])
            speed = [load(3 + k) for k in range(3)]
            r = [builder.call(fused, [speed[k], since, builder.fsub(load(k), part(3, k))]) for k in range(3)]
            v = [builder.fsub(speed[k], part(4, k)) for k in range(3)]
            reach = part(6, 0)
            reach = builder.select(arguments[2], builder.fadd(reach, load(6)), reach)
            square = builder.call(fused, [reach, reach, part(6, 1)])
            b, a, c = product(r, v), product(v, v), product(r, r, builder.fneg(square))
            granted = ir.Constant(vector, [tiny] * size)
            # each comparison is also true for NaN
            near = builder.fcmp_unordered("<=", builder.fmul(a, c), builder.call(fused, [b, b, granted]))
            approach = builder.fcmp_unordered("<", b, part(6, 2))
            turn = builder.call(fused, [a, within, b])
            soon = builder.or_(
                builder.fcmp_unordered(">", turn, zero),
                builder.fcmp_unordered("<", builder.call(fused, [within, builder.fadd(b, turn), c]), zero),
            )
            found = builder.and_(builder.and_(near, approach), soon)
            return builder.zext(builder.bitcast(found, ir.IntType(size)), ir.IntType(64))

        return signature, generate

    return screen


# ---------------------------------------------------------------- code for another machine


class LlvmText:
    """A context in which numba writes the LLVM code of kernels, but neither optimises it nor makes machine code.

    Code from which numba has made machine code is specific to this machine and must not be compiled for another one.
    So boxes are built in another process, and no kernel can be called within this context.
    """

    def __init__(self) -> None:
        self._text: dict[str, str] = {}
        self._usual: list[tuple[type, str, object]] = []

    def __enter__(self) -> "LlvmText":
        def keep(library: Any) -> None:
            self._text[library.name] = str(library._final_module)

        nothing = {
            (codegen.CPUCodeLibrary, "_optimize_functions"): lambda library, module: None,
            (codegen.CPUCodeLibrary, "_optimize_final_module"): keep,
            (codegen.JITCPUCodegen, "_add_module"): lambda made, module: None,
            (codegen.JITCPUCodegen, "set_env"): lambda made, name, env: None,
            (codegen.JITCodeLibrary, "_finalize_specific"): lambda library: None,
            (codegen.JITCodeLibrary, "get_pointer_to_function"): lambda library, name: 1,
        }
        for (owner, name), instead in nothing.items():
            self._usual.append((owner, name, getattr(owner, name)))  # fails if a new numba lacks this method
            setattr(owner, name, instead)
        return self

    def __exit__(self, *_: object) -> None:
        for owner, name, usual in self._usual:
            setattr(owner, name, usual)

    def of(self, kernel: Any, kinds: Any) -> tuple[str, str]:
        """Return the code of a kernel for some types of arguments, with all functions that it calls, and its name."""
        flags = compiler.Flags()
        flags.no_cpython_wrapper = True
        flags.no_cfunc_wrapper = True
        flags.nrt = False
        flags.error_model = "numpy"
        contexts = cpu_target.typing_context, cpu_target.target_context
        for each in contexts:
            each.refresh()
        made = compiler.compile_extra(*contexts, kernel.py_func, kinds, None, flags, {}, pipeline_class=_KernelCompiler)
        with global_compiler_lock:
            made.library._ensure_finalized()
        return self._text[made.library.name], made.fndesc.llvm_func_name
