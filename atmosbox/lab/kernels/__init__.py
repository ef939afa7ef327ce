"""What a page calls of the engine, and what Python does between two such calls: all of it compiled.

Nothing here is called from Python; ``tools/wasm.py`` makes WebAssembly of it. Read `passing` first, then `gauging`,
`averaging`, `height_profile` and `sight`; `attracting` and `clustering` are what molecules that attract each other need
instead; `kernel_table` names what a page calls.
"""
