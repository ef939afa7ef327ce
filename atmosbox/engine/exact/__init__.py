"""The exact engine: from event to event. Read from top to bottom.

`cells`        which molecules can meet
`calendar`     what happens next
`prediction`   what lies ahead of a molecule
`encounter`    what a contact or a wall hit does
`crossing`     from cell to cell
`turning`      the piston of a lift turns between events
`exact`        the loop over events
`stall`        when time can go no further
`parcelset`    the box, advanced exactly
`reference`    the same model, slow and simple: the tests compare with it
"""
