"""A scene that runs in a web page: the engine's kernels as WebAssembly, and the page around them.

Read in this order: `kernels` (functions that measure and draw; the functions that move molecules are in the engine);
`box` (a box as the arrays that the kernels work on, `gauges` for its instruments, `start_plan` for how molecules
start); `memory_image` (the layout of a module's memory, and the arguments of each kernel) and `wasm_module` (the
modules, which ``tools/wasm.py`` makes); `stage`, `theory_table` and `plan` (data for the page), `page_file` (the
HTML file, with the boxes of other settings that it offers).
"""

from atmosbox.lab.page_file import save_lab

__all__ = ["save_lab"]
