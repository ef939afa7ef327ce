"""A simulation: a scene prepared, advanced, recorded and verified.

`accuracy`      how accurate a run will be: the measured table, and the cheapest way that meets a wish
`preparation`   a scene made ready to run: its settings, its engine, its box
`compilation`   what a first run waits for: told, remembered, and done in advance
`recording`     a run in progress: what is sampled frame by frame
`restart`       the state of a run inside its file, from which it goes on
`verification`  whether the energy ledger closes, and whether the run agrees with theory
`runner`        all of it, from the name of a scene to its dataset
"""
