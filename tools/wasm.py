"""Compile the kernels of the lab to WebAssembly: one module for each set of modes that the shipped scenes need.

    python tools/wasm.py            # all of them, into atmosbox/lab/modules/
    python tools/wasm.py --check    # name the stale modules, and fail if there are any

numba compiles the kernels to LLVM code for the processor on which it runs. This program takes that code before it is
optimised, gives it the data layout of a machine with 32-bit addresses, and adds a function for each kernel that reads
the arguments from a block of memory. LLVM compiles the result to WebAssembly, and the linker of ``ziglang`` makes a
module that imports only memory. ``pip install "atmosbox[lab-build]"`` installs the linker, which only this script
needs.
"""

import argparse
import gzip
import importlib
import multiprocessing
import re
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import llvmlite.binding as llvm
import numba

from atmosbox.engine.core.compiler import LlvmText
from atmosbox.engine.core.state import Modes
from atmosbox.lab.box import lab_box
from atmosbox.lab.kernels.kernel_table import kernels
from atmosbox.lab.memory_image import arguments
from atmosbox.lab.wasm_module import BESIDE, FOLDER, SCENES, source_stamp, stamp_of
from atmosbox.simulation.preparation import prepare

TRIPLE = "wasm32-unknown-unknown"
FEATURES = "+bulk-memory,+sign-ext,+nontrapping-fptoint,+mutable-globals,+multivalue,+simd128"
STACK = 65_536
APART = ("settle", "hit", "meet", "_touch", "_emit")
"""Kernels that stay functions of their own and are not merged into the loop over events: without a mist, the first.

In a function of more than 8,192 values Chromium's compiler uses a simpler way to assign the processor's registers: with
these kernels inside, the loop of an ascent is such a function and takes a sixth to a quarter longer.
"""


def machine() -> llvm.TargetMachine:
    """Return LLVM's target machine for WebAssembly."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    return llvm.Target.from_triple(TRIPLE).create_target_machine(cpu="generic", features=FEATURES, opt=3)


def object_of(text: str, native: str, export: str, target: llvm.TargetMachine, alone: tuple[str, ...]) -> bytes:
    """Return one kernel as an object file: a function that takes the address of its arguments."""
    text = re.sub(r'target triple = ".*"', f'target triple = "{TRIPLE}"', text)
    text = re.sub(r'target datalayout = ".*"', f'target datalayout = "{target.target_data}"', text)
    text = re.sub(r'"target-(cpu|features)"="[^"]*"', "", text)
    text = with_root(apart(text, alone) if export == "pass_time" else text) + door(text, native, export)
    module = llvm.parse_assembly(text)
    for function in module.functions:
        if not function.is_declaration:
            function.linkage = "external" if function.name == export else "internal"
    for variable in module.global_variables:
        if not variable.is_declaration:
            variable.linkage = "internal"
    module.verify()
    options = llvm.create_pipeline_tuning_options(speed_level=3)
    options.loop_vectorization = options.slp_vectorization = False
    # without it, lifting takes 5 % longer; the other kernels take as long, and the modules are 5 % smaller
    options.loop_unrolling = export == "pass_time"
    builder = llvm.create_pass_builder(target, options)
    builder.getModulePassManager().run(module, builder)
    return target.emit_object(module)


def apart(text: str, alone: tuple[str, ...]) -> str:
    """Return code in which some kernels are not merged into those that call them; each of them must be in it."""
    for name in alone:  # in a compiled name the length of each part precedes it
        head = rf'^(define [^@]*@"?[^"(]*[a-z_]{len(name)}{name}B.*\))[^()]*\{{$'
        text, found = re.subn(head, r"\1 noinline {", text, flags=re.M)
        if not found:
            raise SystemExit(f"no kernel is called {name}: put APART right")
    return text


def with_root(text: str) -> str:
    """Return code in which the square root is an instruction and not a call of a function."""
    root = (
        "define internal double @sqrt(double %x) alwaysinline {\n"
        "  %r = call double @llvm.sqrt.f64(double %x)\n  ret double %r\n}"
    )
    text, found = re.subn(r"^declare double @sqrt\(double[^)]*\).*$", root, text, flags=re.M)
    missing = found and "declare double @llvm.sqrt.f64" not in text
    return text + ("\ndeclare double @llvm.sqrt.f64(double)\n" if missing else "")


def door(text: str, native: str, export: str) -> str:
    """Return a function that calls a kernel with the arguments in a block of memory: see `memory_image`."""
    head = re.search(rf'^define [^@]*@"?{re.escape(native)}"?\((.*?)\)[^()]*\{{?$', text, re.M)
    kinds = [each.strip().split()[0] for each in re.findall(r"(?:\([^()]*\)|[^,()])+", head.group(1))]
    lines, call = [], []
    for k, kind in enumerate(kinds):
        # the first two arguments are the address of the result, and one for an exception, which never occurs
        offset = (0, 128)[k] if k < 2 else 256 + 8 * (k - 2)
        lines.append(f"  %p{k} = getelementptr i8, ptr %block, i32 {offset}")
        if k >= 2:
            lines.append(f"  %v{k} = load {kind}, ptr %p{k}")
        call.append(f"ptr %p{k}" if k < 2 else f"{kind} %v{k}")
    body = "\n".join([*lines, f'  %r = call i32 @"{native}"({", ".join(call)})', "  ret i32 %r"])
    return f"\ndefine i32 @{export}(ptr %block) {{\n{body}\n}}\n"


def link(objects: dict[str, bytes]) -> bytes:
    """Return the module that exports these functions and the address at which its own memory ends."""
    zig = Path(importlib.import_module("ziglang").__file__).parent / "zig"
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for name, content in objects.items():
            files.append(Path(folder) / f"{name}.o")
            files[-1].write_bytes(content)
        made = Path(folder) / "made.wasm"
        options = ["--no-entry", "--import-memory", "--stack-first", "-z", f"stack-size={STACK}", "--strip-all"]
        exports = [f"--export={name}" for name in (*objects, "__heap_base")]
        command = [zig, "wasm-ld", *options, "--gc-sections", *exports, *files, "-o", made]
        done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(done.stderr)
        return made.read_bytes()


def needed(scenes: list[str]) -> dict[str, tuple[Modes, bool, dict[str, tuple]]]:
    """Return the modules that some scenes need, by name: the modes, whether there are wells, the types of arguments."""
    found = {}
    boxes = [(scene, SCENES[scene]) for scene in scenes]
    for scene, settings in [*boxes, *(each for each in BESIDE if each[0] in scenes)]:
        box = lab_box(prepare(scene, settings, engine="exact"))
        types = {name: tuple(map(numba.typeof, given.values())) for name, given in arguments(box).items()}
        found[box.module] = box.modes, box.attracts, types
    return found


def module_of(modes: Modes, wells: bool, types: dict[str, tuple]) -> bytes:
    """Return the module for one set of modes."""
    target = machine()
    alone = APART if modes.phases and not modes.drops else APART[:1]
    with LlvmText() as source:
        works = kernels(modes, wells=wells)
        return link({name: object_of(*source.of(works[name], types[name]), name, target, alone) for name in types})


def main() -> None:
    """Compile the modules of some scenes, or of all; or name the stale modules."""
    asked = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    asked.add_argument("--check", action="store_true", help="only say which modules are stale")
    asked.add_argument(
        "scenes", nargs="*", default=[*SCENES], help="only those that these scenes need; others stay as they are"
    )
    options = asked.parse_args()
    stamp = source_stamp()
    if options.check:
        stale = [path.name for path in FOLDER.glob("*.wasm.gz") if stamp_of(path.read_bytes()) != stamp]
        sys.exit(f"stale: {', '.join(stale)}; run python tools/wasm.py" if stale else 0)
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as apart:
        wanted = apart.submit(needed, options.scenes).result()
    FOLDER.mkdir(exist_ok=True)
    if options.scenes == [*SCENES]:
        for path in FOLDER.glob("*.wasm.gz"):
            if path.name.removesuffix(".wasm.gz") not in wanted:
                path.unlink()
    for name, (modes, wells, types) in wanted.items():
        begun = time.perf_counter()
        content = module_of(modes, wells, types)
        path = FOLDER / f"{name}.wasm.gz"
        path.write_bytes(gzip.compress(content + stamped(stamp), 9, mtime=0))
        size = path.stat().st_size / 1000
        print(f"{name}: {len(content) / 1000:.0f} kB, {size:.0f} kB in the wheel, {time.perf_counter() - begun:.0f} s")


def stamped(stamp: str) -> bytes:
    """Return a custom section of a module that holds the stamp of its sources."""
    name = b"sources"
    body = bytes([len(name)]) + name + stamp.encode()
    return bytes([0, len(body)]) + body


if __name__ == "__main__":
    main()
