"""A scene that runs in a web page: the engine's kernels as WebAssembly, and the page around them.

Read in this order: `kernels` (what is measured and seen; how time passes stands in the engine); `bench`
(a box as the arrays that they work on; of molecules that attract each other, `well_bench`) and `work` (what is called
with what); `memory_image` (where it stands in the memory of a module) and `wasm_module` (the modules, which
``tools/wasm.py`` makes); `theory_table` and `lab_plan` (what the page is told), `lab_start` (other numbers of
molecules), `lab_file`.
"""

from atmosbox.lab.lab_file import save_lab

__all__ = ["save_lab"]
