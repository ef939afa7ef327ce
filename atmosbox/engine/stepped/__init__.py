"""The time-stepped engine: all molecules move, then those that overlap collide.

`window`           a test of eight neighbours at once
`neighbourhood`    the search for molecules that overlap
`filing`           molecules sorted by cell
`gridding`         the division of the box into cells
`flight`           a step of free flight
`bounce`           a step of molecules that come near walls
`stepped`          one time step
`stepped_start`    checks of the start: time step and overlaps
`stepped_parcel`   the box, advanced in time steps
"""
