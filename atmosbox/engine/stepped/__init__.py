"""The time-stepped engine, the way of the applets: all molecules move, then those that overlap collide.

`flight`           a step of free flight, and what walls do
`stepped`          the search for overlapping pairs, their collisions, and one time step after the other
`stepped_parcel`   the box, advanced in time steps
"""
