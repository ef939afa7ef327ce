"""The time-stepped engine: all move, then those that overlap collide.

`window`           eight neighbours are compared at once
`neighbourhood`    which molecules overlap
`filing`           molecules sorted by cell
`gridding`         how the box is cut into cells
`flight`           a step of free flight
`bounce`           a step of those that come near walls
`stepped`          one time step
`stepped_start`    what a start in time steps must be
`stepped_parcel`   the box, advanced in time steps
"""
