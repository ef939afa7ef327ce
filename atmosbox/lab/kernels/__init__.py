"""The kernels that a page calls: the engine, how molecules start, instruments, and pictures.

Nothing here is called from Python; ``tools/wasm.py`` compiles it to WebAssembly. Read `kernel_table` first, which
lists the kernels that a page calls, then `readings`, the variables that it measures, `sums`, what is summed over the
molecules, `gauging`, `averaging` and `picture`; `hygrometer`, `flowing`, `two_gases` and `clustering` measure what only
some scenes show.
"""
