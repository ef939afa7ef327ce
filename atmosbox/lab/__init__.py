"""A scene that runs in a web page: the engine's kernels as WebAssembly, and the page around them.

Read in this order: `kernels` (functions that measure and draw; the functions that move molecules are in the engine);
`lab_box` (a box as the arrays that the kernels work on; `well_lab_box` for molecules that attract each other,
`start_plan` for how they start) and `work` (the arguments of each kernel); `memory_image` (the layout of a module's
memory) and `wasm_module` (the modules, which ``tools/wasm.py`` makes); `theory_table` and `lab_plan` (data for the
page), `lab_start` (other numbers of molecules), `lab_file` (the HTML file).
"""

from atmosbox.lab.page_file import save_lab

__all__ = ["save_lab"]
