"""The kernels that a page calls: the engine, how molecules start, instruments, and pictures.

Nothing here is called from Python; ``tools/wasm.py`` compiles it to WebAssembly. Read `passing` first, then `gauging`,
`averaging`, `height_profile` and `picture`; `attracting` and `clustering` replace some of them for molecules that
attract each other; `kernel_table` lists the kernels that a page calls.
"""
