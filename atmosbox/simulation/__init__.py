"""A simulation: a scene is prepared, advanced, recorded and verified.

`accuracy`       how accurate a run will be: the measured table, and the cheapest run that is accurate enough
`preparation`    a scene made ready to run: its settings, its engine, its box
`link`           a run of the page, made ready to run again from its link
`compilation`    the compilation before a first run: announced, and in advance
`expected_time`  how long a run will take
`recording`      a run in progress: what is sampled frame by frame
`restart`        the state of a run inside its file, from which it continues
`verification`   whether the energy budget is closed, and whether the run agrees with theory
`runner`         all of this, from a scene that is ready to its dataset
"""
