"""What a page does beside letting time pass, which is `atmosbox.engine.exact.passing`: it measures, averages and looks.

Nothing here is called from Python; ``tools/wasm.py`` makes WebAssembly of it. Read `gauging` first, then `averaging`,
`height_profile` and `sight`; `kernel_table` names what a page calls.
"""
