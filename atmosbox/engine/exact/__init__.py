"""The exact engine: from event to event. Read from top to bottom.

`row_cells`    how many cells there are, where their rows hold copies of trajectories
`cells`        which molecules can meet
`calendar`     what happens next
`encounter`    what a contact or a wall hit does
`glance`       eight molecules at once: who of them can be met at all
`lanes`        the same in vector instructions
`rows`         what the rows of cells hold
`search`       whom a molecule meets next
`prediction`   what lies ahead of a molecule
`membership`   who stands in which cells
`crossing`     from cell to cell, where rows are lists of names
`turning`      the piston of a lift turns between events
`exact`        the loop over events
`epoch`        how all clocks are set back, so that they always read small numbers
`stall`        when time can go no further
`parcelset`    the box, advanced exactly
`reference`    the same model, slow and simple: the tests compare with it
"""
