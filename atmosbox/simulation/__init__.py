"""A simulation: a scene is prepared, advanced, recorded and verified.

`accuracy`      how accurate a run will be: the measured table, and the cheapest run that is accurate enough
`preparation`   a scene made ready to run: its settings, its engine, its box
`compilation`   the compilation before a first run: its progress, its expected time, in advance
`recording`     a run in progress: what is sampled frame by frame
`restart`       the state of a run inside its file, from which it continues
`verification`  whether the energy budget is closed, and whether the run agrees with theory
`runner`        all of this, from the name of a scene to its dataset
"""
