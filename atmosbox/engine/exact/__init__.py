"""The exact, event-driven engine. docs/engine.md tells where to begin.

`row_cells`    sizes and numbers of cells whose rows hold copies of trajectories
`cells`        which molecules can meet
`calendar`     which event is the next one
`encounter`    the change of velocity at a contact or a wall hit
`rows`         the contents of the rows of cells, and a quick test of eight members at once
`search`       the search for a molecule's next contact
`prediction`   the next events of a molecule: contact, cell boundary, wall
`membership`   which molecules are in which cells
`crossing`     from cell to cell, where rows are lists of molecules
`turning`      the piston of a lift gets new velocities between events
`exact`        the loop over events
`layout`       the present cells of a box, and how they change
`advance`      the loop, and what happens between its stops: in Python and in the page
`stall`        why time can go no further
`parcelset`    the box, advanced exactly
`reference`    the same model, slow and simple: the tests compare with it
"""
